"""What an optimal control problem came to."""

from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from ocs_design.arrays import FloatArray
from ocs_design.drive.line import DriveLine
from ocs_design.sizing.optimal_control.boundary import Boundary
from ocs_design.sizing.optimal_control.flight import Flight
from ocs_design.sizing.optimal_control.motion import Motion
from ocs_design.sizing.trajectory import Trajectory

VIOLATION_MAX = 1e-5
"""Of a drive's limits, relative, that a solution may show on the fine grid."""

DEFECT_MAX = 1e-4
"""Of the trunk's rate, relative to its largest, likewise."""


class Objective(StrEnum):
    """What a maneuver is best in.

    Attributes:
        EFFORT: least integral of both torques' squares [N^2 m^2 s] in the time given.
        TIME: least time [s].
    """

    EFFORT = "least effort"
    TIME = "shortest time"


@dataclass(frozen=True)
class FineGrid:
    """What an independent integration of the torques shows on a ten times finer grid.

    Attributes:
        violation: largest overstepping of the drive's limits, relative to each.
        end_tilt: angle between where the vertical ends and where it should [rad].
        end_rate: of the trunk about roll and pitch in the end [rad/s].
        defect: largest difference to the program's own rate, over the largest rate.
    """

    violation: float
    end_tilt: float
    end_rate: float
    defect: float


@dataclass(frozen=True, eq=False)
class ManeuverSolution:
    """One maneuver in 3-D.

    Attributes:
        name: of the maneuver. objective: what was minimised.
        solved: whether IPOPT found a local optimum; all below means nothing else.
        status: IPOPT's own word. iterations: taken.
        value: of the objective. duration: of the turn [s].
        violation: largest, of the program's constraints, scaled.
        fine: see `FineGrid`.
        trajectory: from the start of the turn, which is the end of a push.
    """

    name: str
    objective: Objective
    solved: bool
    status: str
    iterations: int
    value: float
    duration: float
    violation: float
    fine: FineGrid
    trajectory: Trajectory

    @property
    def sound(self) -> bool:
        """Whether IPOPT solved it and the fine grid bears it out."""
        return not self.failure

    @property
    def failure(self) -> str:
        """What is wrong with it, in a few words; empty if nothing is."""
        return failure(self.status, self.fine, solved=self.solved)


def failure(status: str, fine: FineGrid, *, solved: bool) -> str:
    """What is wrong with a solution, in a few words; empty if nothing is."""
    if not solved:
        return f"IPOPT: {status}"
    if fine.violation > VIOLATION_MAX:
        return f"the finer grid oversteps a limit by {fine.violation:.1e}"
    if fine.defect > DEFECT_MAX:
        return f"an integration of its torques differs by {fine.defect:.1e}"
    return ""


def fine_grid(flight: Flight, motion: Motion, line: DriveLine, asked: Boundary) -> FineGrid:
    """Compare the flight with what was asked, allowed, and claimed."""
    claimed = motion.state_at(flight.time)[3:6].T
    largest = float(np.abs(claimed).max())
    tilt = np.linalg.norm(np.cross(flight.vertical[-1], asked.final_vertical))
    return FineGrid(
        violation=limit_violation(flight.wheel_speed, flight.wheel_torque, line),
        end_tilt=float(np.arctan2(tilt, flight.vertical[-1] @ asked.final_vertical)),
        end_rate=float(np.linalg.norm(flight.rate[-1, :2])),
        defect=float(np.abs(flight.rate - claimed).max()) / largest if largest > 0.0 else 0.0,
    )


def limit_violation(speed: FloatArray, torque: FloatArray, line: DriveLine) -> float:
    """Largest overstepping of current limit, voltage line and speed, relative; 0 if none."""
    slope = line.no_load_speed / line.stall_torque
    return float(
        np.max(
            [
                np.abs(torque).max() / line.torque_limit - 1.0,
                np.abs(speed + slope * torque).max() / line.no_load_speed - 1.0,
                np.abs(speed).max() / line.speed_max - 1.0,
                0.0,
            ]
        )
    )


def trajectory_of(flight: Flight, axis: FloatArray, note: str = "") -> Trajectory:
    """As the validation tracks it."""
    return Trajectory(
        time=flight.time,
        vertical=flight.vertical,
        rate=flight.rate,
        acceleration=flight.acceleration,
        wheel_speed=flight.wheel_speed,
        wheel_torque=flight.wheel_torque,
        turned=flight.swept @ axis,
        note=note,
    )
