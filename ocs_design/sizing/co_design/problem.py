"""What the co-design may change, what it must keep, and what it comes to."""

from dataclasses import dataclass

from ocs_design.drive.line import DriveLine
from ocs_design.sizing.optimal_control.solution import FineGrid
from ocs_design.sizing.rim_problem import RimLimits
from ocs_design.sizing.selection.problem import SelectionProblem
from ocs_design.sizing.selection.result import Candidate


@dataclass(frozen=True)
class DeviceShape:
    """The device's continuous figures.

    Attributes:
        inner_radius, outer_radius, height: of both rims [m].
        incidence: of their axes [rad].
    """

    inner_radius: float
    outer_radius: float
    height: float
    incidence: float


@dataclass(frozen=True, eq=False)
class CoDesignProblem:
    """Make a selected device lighter; its motor, gear and material stand.

    Attributes:
        selection: the problem that it was selected for.
        selected: by the closed forms.
    """

    selection: SelectionProblem
    selected: Candidate

    @property
    def limits(self) -> RimLimits:
        """Of one rim, scalars."""
        return self.selected.limits(self.selection.envelope)

    @property
    def line(self) -> DriveLine:
        """What of the drives a design may use."""
        return self.selected.line.reserved()

    @property
    def shape(self) -> DeviceShape:
        """Of the selected device."""
        chosen = self.selected
        return DeviceShape(
            chosen.inner_radius, chosen.outer_radius, chosen.height, chosen.incidence
        )


@dataclass(frozen=True)
class ManeuverCheck:
    """One maneuver of the co-design, flown again.

    Attributes:
        name: of the maneuver. fine: see `FineGrid`.
        peak_speed: of the busier wheel [rad/s]. peak_torque: of its motor at the wheel [N m].
    """

    name: str
    fine: FineGrid
    peak_speed: float
    peak_torque: float


@dataclass(frozen=True, eq=False)
class CoDesign:
    """What the co-design came to.

    Attributes:
        adopted: whether `shape` is the co-design's; otherwise the selection stands.
        note: one sentence on that.
        shape: of the device to build. mass: of both modules in all [kg].
        found_mass: of what the program ended with, adopted or not [kg].
        selected_mass: of the selection [kg].
        status: IPOPT's own word. iterations: taken. seconds: in all.
        violation: largest, of the program's constraints, scaled.
        checks: of each maneuver on the ten times finer grid.
    """

    adopted: bool
    note: str
    shape: DeviceShape
    mass: float
    found_mass: float
    selected_mass: float
    status: str
    iterations: int
    seconds: float
    violation: float
    checks: tuple[ManeuverCheck, ...]

    @property
    def gain(self) -> float:
        """Mass saved over the selection's; what was found where it is not adopted, negative too."""
        return 1.0 - self.found_mass / self.selected_mass

    @property
    def fine_violation(self) -> float:
        """Largest overstepping of a drive's limit on the fine grid, relative."""
        return max((check.fine.violation for check in self.checks), default=0.0)
