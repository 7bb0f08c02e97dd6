"""What the validation tracks: the maneuver of least effort, with its feed-forward torque."""

from dataclasses import dataclass, replace

from ocs_design.drive.line import RESERVE, DriveLine
from ocs_design.requirement.maneuver import Maneuver, Unforeseen
from ocs_design.sizing.gyrostat import Gyrostat
from ocs_design.sizing.optimal_control.boundary import boundary
from ocs_design.sizing.optimal_control.solution import ManeuverSolution
from ocs_design.sizing.optimal_control.solving import solve_maneuver
from ocs_design.sizing.trajectory import Trajectory

PLANNED = (1.0 + RESERVE) / 2.0
"""Share of voltage and current that a plan may use. A device is sized so that its hardest maneuver
just takes `RESERVE` of them: half of the rest lets a plan be smoother than that, the other half is
left to the feedback."""

_UNFORESEEN = "a push is not known beforehand: no trajectory is planned, feedback holds the trunk"


@dataclass(frozen=True, eq=False)
class Reference:
    """A trajectory to track, or why there is none.

    Attributes:
        trajectory: its note says what `note` says; None: the validation makes do without.
        note: one sentence; empty if the trajectory leaves the feedback its reserve.
        solution: that the trajectory is from, or the last one that failed; None: not tried.
    """

    trajectory: Trajectory | None
    note: str
    solution: ManeuverSolution | None


def reference(
    gyrostat: Gyrostat, line: DriveLine, maneuver: Maneuver, standing_height: float
) -> Reference:
    """Least effort within `PLANNED` of voltage and current, else with all of both.

    Args:
        gyrostat: robot and device, at the incidence of the maneuver.
        line: of the drives, nothing held back.
        maneuver: what nobody foresees gets no reference, because it comes unforeseen.
        standing_height: of the trunk over the ground [m].
    """
    if isinstance(maneuver, Unforeseen):
        return Reference(None, _UNFORESEEN, None)
    asked = boundary(maneuver, standing_height)
    solution = solve_maneuver(gyrostat, line.reserved(PLANNED), asked)
    if solution.sound:
        return Reference(solution.trajectory, "", solution)
    solution = solve_maneuver(gyrostat, line, asked)
    if solution.sound:
        note = f"the turn takes more than {PLANNED:.1%} of the motors' voltage or current"
        return Reference(replace(solution.trajectory, note=note), note, solution)
    return Reference(None, f"no optimal turn was found ({solution.failure})", solution)
