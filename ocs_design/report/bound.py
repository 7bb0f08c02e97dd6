"""What `bound` prints."""

import numpy as np
from rich.console import Console

from ocs_design.answers import BoundAnswer
from ocs_design.report.layout import columns, facts, heading, note, show
from ocs_design.report.quantities import degrees, inertia, rpm

NOTE = (
    "The paper prints I_r d / (d + gamma); from its own momentum follows I_r d / (gamma - d). "
    "I_r is the robot's inertia, d the change of its rate, gamma the wheel's speed. Necessary, "
    "never sufficient: torque, angle and time are not asked for here."
)


def print_bound(console: Console, answer: BoundAnswer) -> None:
    """The bound as printed in the paper and as it should be, per wheel, and its curve."""
    heading(console, f"Lower bound on the device's inertia about {answer.axis}")
    facts(
        console,
        [
            ("robot", inertia(answer.inertia)),
            ("rate change d", f"{answer.rate_change:.4g} rad/s"),
            ("wheel speed gamma", rpm(answer.wheel_speed_max)),
            ("one wheel, required", f"{answer.required:.5e} kg m2"),
            ("one wheel, as the paper prints it", f"{answer.paper:.5e} kg m2"),
            (f"each of two at {degrees(answer.incidence)}", f"{answer.spin_inertia:.5e} kg m2"),
        ],
    )
    note(console, NOTE)
    heading(console, "Required over robot's inertia: wheel speed against rate change")
    table = columns("", *(f"{rate:.3g}\nrad/s" for rate in answer.rate_changes))
    for speed, row in zip(answer.wheel_speeds, answer.curve, strict=True):
        shares = (f"{share:.2e}" if np.isfinite(share) else "-" for share in row)
        table.add_row(rpm(speed), *shares)
    show(console, table)
