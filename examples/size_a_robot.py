"""What more room for the wheels saves: sizes Solo12 for a few rim radii, from Python.

    python examples/size_a_robot.py [ROBOT]

Only the last design, for the largest radius, is flown.
"""

import sys
from pathlib import Path

from ocs_design import Infeasible, design_ocs, specify

ROBOT = Path(__file__).with_name("solo12.urdf")
RADII = (0.02, 0.03, 0.04, 0.05)  # m


def main() -> None:
    """Size, print, and show how the last design flies."""
    robot = sys.argv[1] if len(sys.argv) > 1 else str(ROBOT)
    print("radius [mm]  one wheel [g]  what binds")
    for radius in RADII:
        specification = specify(
            robot, flywheel={"r_max": radius}, validation={"enabled": radius == RADII[-1]}
        )
        folder = Path(f"radius-{radius * 1e3:.0f}mm-ocs")
        try:
            outcome = design_ocs(specification, out=folder, force=True)
        except Infeasible as error:
            print(f"{radius * 1e3:11.0f}  {'none':>13}  {', '.join(error.binding)}")
            continue
        design = outcome.design
        mass, binding = design.ocs.flywheel.mass, ", ".join(design.sizing.binding)
        print(f"{radius * 1e3:11.0f}  {mass * 1e3:13.1f}  {binding}")
    for run in design.validation:
        print(f"{run.scenario}, {'with' if run.ocs else 'without'} the device: {run.reason}")


if __name__ == "__main__":
    main()
