"""The selection's problem: what is required, and the parts to choose from."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import isfinite

import numpy as np

from ocs_design.actuation.motor import Gear, Motor
from ocs_design.actuation.supply import Supply
from ocs_design.catalogue.materials import Material
from ocs_design.common.arrays import FloatArray
from ocs_design.common.errors import UsageError
from ocs_design.device.layout import PAIR, Layout
from ocs_design.parts.printed import PLATE_THICKNESS
from ocs_design.parts.rim import (
    NO_CUTS,
    SHRUNK_WEB_THICKNESS,
    WEB_THICKNESS,
    Hub,
    RimCuts,
    hub_of,
)
from ocs_design.requirement.froude import Envelope
from ocs_design.requirement.kinds import slower
from ocs_design.requirement.requirement import Requirement
from ocs_design.robot.mass import MassProperties
from ocs_design.sizing.bound.rim_problem import check_limits
from ocs_design.sizing.limits import BUS_POWER, BUS_VOLTAGE, RIM_LIMITS, TIME, WHEEL_SPEED, Limit
from ocs_design.sizing.place import Place


@dataclass(frozen=True, eq=False)
class SelectionProblem:
    """Find the lightest device that does everything that is required.

    Attributes:
        robot: without the modules, with the plate that they stand on, in B.
        requirement: what the device must do; its `wheel_speed_max` is not looked at here. A stated
            spin inertia is kept, and the motors must do with it what is required.
        envelope: room for one rim; its housing stands around it.
        place: of the modules, by outer radius and height of their housings.
        layout: of their axes.
        motors, gears, materials: to choose from; direct drive is the gear `DIRECT`.
        supply: of all motors; each of the wheels may take its share of the power.
        incidence: of a pair's wheel axes, or the angle of another layout [rad]; None: the best.
        wheel_speed_max: stated highest speed of a wheel [rad/s]; None: what the drive can do.
        web: whether wheels have a web and a hub; massless spokes otherwise.
        on_bell: whether they are rings around the bells of the motors, without web or gear.
        cuts: chamfers and balancing holes of wheels with a web; those without are plain rims.
        web_material: of web and hub; None: of one piece with the rim.
        lightenings: numbers of holes in a web to choose from, 0 a solid one.
        guard_wall: of the steel rings in the housings [m]; 0: none.
        foot_plate: thickness of the feet's plates [m].
    """

    robot: MassProperties
    requirement: Requirement
    envelope: Envelope
    place: Place
    motors: Sequence[Motor]
    gears: Sequence[Gear]
    materials: Sequence[Material]
    supply: Supply
    incidence: float | None = None
    wheel_speed_max: float | None = None
    web: bool = True
    on_bell: bool = False
    cuts: RimCuts = NO_CUTS
    web_material: Material | None = None
    lightenings: Sequence[int] = (0,)
    guard_wall: float = 0.0
    foot_plate: float = PLATE_THICKNESS
    layout: Layout = PAIR

    @property
    def web_densities(self) -> FloatArray:
        """Density of web and hub of a wheel of each material [kg/m^3]."""
        of_rims = np.array([material.density for material in self.materials])
        return (
            of_rims
            if self.web_material is None
            else np.full_like(of_rims, self.web_material.density)
        )

    @property
    def bus_voltage(self) -> float:
        """Voltage of the supply [V]."""
        return self.supply.voltage

    @property
    def web_thickness(self) -> float:
        """Thickness of their webs [m]."""
        return WEB_THICKNESS if self.web_material is None else SHRUNK_WEB_THICKNESS

    def hub(self, motor: Motor, gear: Gear, lightening: int) -> Hub | None:
        """Hub of a wheel on this motor behind this gear; None: massless spokes.

        Its web is solid where the largest rim leaves no room for so many holes.
        """
        if not self.web:
            return None
        hub = hub_of(
            motor,
            direct=gear.room is None,
            chamfer=self.cuts.chamfer,
            web_thickness=self.web_thickness,
            lightening=lightening,
        )
        wall = max(self.envelope.wall_min, self.cuts.wall_min)
        fits = hub.bore_min + wall <= self.envelope.outer_radius_max
        return hub if fits else replace(hub, lightening=0)

    def check(self) -> None:
        """Refuse a problem that cannot be solved as it is stated.

        Raises:
            UsageError: there is nothing to choose from or nothing to do, or a limit is no limit.
        """
        for name in ("motors", "gears", "materials"):
            if not getattr(self, name):
                raise UsageError(f"there are no {name} to choose from")
        asked = self.requirement
        if not any((asked.maneuvers, asked.rate_change, asked.spin_inertia)):
            raise UsageError(
                "nothing is asked of the wheels",
                hint="Ask for a rate change, for a maneuver, or for a spin inertia.",
            )
        speed = 1.0 if self.wheel_speed_max is None else self.wheel_speed_max
        for each in self.materials:
            check_limits(self.envelope, each, speed)


def limits_of(problem: SelectionProblem) -> dict[Limit, float]:
    """Values of all limits that may stand in the way [SI]."""
    speed = {} if problem.wheel_speed_max is None else {WHEEL_SPEED: problem.wheel_speed_max}
    power = {BUS_POWER: problem.supply.power} if isfinite(problem.supply.power) else {}
    return {
        **{limit: limit.value(problem.envelope) for limit in RIM_LIMITS},
        **speed,
        BUS_VOLTAGE: problem.supply.voltage,
        **power,
        TIME: 1.0,
    }


def with_limit(problem: SelectionProblem, limit: Limit, value: float) -> SelectionProblem:
    """The problem with one of its limits changed [SI]."""
    if limit is BUS_VOLTAGE:
        return replace(problem, supply=replace(problem.supply, voltage=value))
    if limit is BUS_POWER:
        # The current gives way with it, where it is the smaller limit of the two.
        supply = problem.supply
        current = max(supply.current_max, value / supply.voltage)
        return replace(problem, supply=Supply(supply.voltage, current, value))
    if limit is WHEEL_SPEED:
        return replace(problem, wheel_speed_max=value)
    if limit is TIME:
        names = {maneuver.name for maneuver in problem.requirement.maneuvers}
        return with_time(problem, value, names)
    return replace(problem, envelope=limit.replaced(problem.envelope, value))


def with_time(problem: SelectionProblem, factor: float, names: set[str]) -> SelectionProblem:
    """The problem with `factor` times the time for the maneuvers of these names."""
    requirement = problem.requirement
    maneuvers = tuple(
        slower(maneuver, factor, requirement.standing_height)
        if maneuver.name in names
        else maneuver
        for maneuver in requirement.maneuvers
    )
    return replace(problem, requirement=replace(requirement, maneuvers=maneuvers))
