"""Machines that were built, beside what the tool proposes for what they do (docs/machines.md).

    python examples/machines/compare.py

Each machine is asked for twice: with its own motor, without a gear and with its wheels where they
are, and with everything that the catalogue has.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from math import degrees, pi, radians, sqrt
from pathlib import Path

from ocs_design.requirement.choices import motor_choice
from ocs_design.requirement.reading import read_specification
from ocs_design.requirement.resolving import read_specified_robot, resolve
from ocs_design.requirement.specification import AUTO, MotorSection, Specification
from ocs_design.robot.meshes import size
from ocs_design.sizing.placement import place_at, place_on_top
from ocs_design.sizing.selection.problem import SelectionProblem
from ocs_design.sizing.selection.result import Candidate
from ocs_design.sizing.selection.select import select

HERE = Path(__file__).parent
WIDTH = 23


@dataclass(frozen=True)
class Built:
    """A machine as its makers published it; docs/machines.md has the sources.

    Attributes:
        title: machine and maneuver. specification: beside this file.
        spin_inertia: of one wheel [kg m^2]. wheel_mass: [kg].
        radius: of a wheel [mm], as far as it is known, for people.
        motor: its name. motor_mass: [kg]; None: not known.
        incidence: of the wheels' axes [rad].
        momentum: that one wheel takes in the maneuver [N m s].
    """

    title: str
    specification: str
    spin_inertia: float
    wheel_mass: float
    radius: str
    motor: str
    motor_mass: float | None
    incidence: float
    momentum: float

    @property
    def module_mass(self) -> str:
        """Of wheel and motor [g], for people; the rotor is counted twice if the wheel has it."""
        if self.motor_mass is None:
            return "-"
        return f"up to {(self.wheel_mass + self.motor_mass) * 1e3:.0f}"


REX_HOPPER = Built(
    title="REx Hopper, catch from 14 deg",
    specification="rex_hopper",
    spin_inertia=6.60959e-3,
    wheel_mass=0.78203,
    radius="over 92",
    motor="R100 KV90",
    motor_mass=0.731,
    incidence=pi / 4.0,
    momentum=3.0865 / sqrt(2.0),
)
MACHINES = (
    REX_HOPPER,
    replace(
        REX_HOPPER,
        title="REx Hopper, aim of 26.6 deg in flight",
        specification="rex_hopper_flight",
        momentum=2.0 * 0.094486 * radians(26.565) / 0.638 / sqrt(2.0),
    ),
    Built(
        title="Wheelbot, up from 36 deg",
        specification="wheelbot",
        spin_inertia=5.03e-4,
        wheel_mass=0.3,
        radius="53",
        motor="MN6007 KV160",
        motor_mass=0.180,
        incidence=0.0,
        momentum=0.2014,
    ),
    Built(
        title="Aalborg Cubli, catch from 9.7 deg",
        specification="aalborg_cubli",
        spin_inertia=6.01e-4,
        wheel_mass=0.222,
        radius="over 52",
        motor="EC 45 flat 50 W",
        motor_mass=None,
        incidence=0.0,
        momentum=0.0336,
    ),
)


def lightest(stated: Specification, incidence: float | None) -> Candidate:
    """The lightest device for what is stated.

    Args:
        stated: the specification; its `[motor]` names what may be chosen from.
        incidence: of the wheel axes [rad]; None: the best.
    """
    robot = read_specified_robot(stated)
    resolved = resolve(stated, robot, size(robot.tree, robot.posture, robot.trunk))
    choice = motor_choice(stated, robot)
    if choice is None:
        raise SystemExit("these machines have motors")
    where = stated.ocs.position
    problem = SelectionProblem(
        robot=robot.mass_properties,
        requirement=resolved.requirement,
        envelope=resolved.envelope,
        place=place_on_top(robot) if where is None else place_at(where),
        motors=choice.motors,
        gears=choice.gears,
        materials=choice.materials,
        supply=choice.supply,
        incidence=incidence,
        wheel_speed_max=choice.wheel_speed_max,
    )
    return select(problem).best


def with_any_motor(stated: Specification) -> Specification:
    """The same with the whole catalogue, motors that are not known whole among it."""
    return replace(
        stated,
        flywheel=replace(stated.flywheel, material=AUTO),
        motor=MotorSection(name=AUTO, gear=AUTO, any=True),
    )


def rows(built: Built) -> Iterator[tuple[str, ...]]:
    """The lines of a machine's table, each with what it is of."""
    stated = read_specification(HERE / f"{built.specification}.toml")
    same = lightest(stated, built.incidence)
    free = lightest(with_any_motor(stated), None if built.incidence else 0.0)
    both = (same, free)
    yield "", "built", "same motor", "any motor"
    yield "motor", built.motor, *(one.motor.name.removeprefix("Antigravity ") for one in both)
    yield "gear", "direct", *(_gear(one) for one in both)
    yield "rim of", "", *(one.material.name for one in both)
    yield "spin inertia, g m2", *_figures(built.spin_inertia, both, "spin_inertia", 1e3, 3)
    yield "wheel, g", *_figures(built.wheel_mass, both, "wheel_mass", 1e3, 0)
    yield "outer radius, mm", built.radius, *(f"{one.outer_radius * 1e3:.0f}" for one in both)
    yield "wheel speed, rpm", _speed(built.momentum / built.spin_inertia), *map(_peak, both)
    yield "incidence, deg", f"{degrees(built.incidence):.0f}", *map(_incidence, both)
    yield "one module, g", built.module_mass, *(f"{one.mass / 2.0 * 1e3:.0f}" for one in both)


def _figures(
    built: float, both: Sequence[Candidate], name: str, scale: float, digits: int
) -> Iterator[str]:
    for figure in (built, *(getattr(one, name) for one in both)):
        yield f"{figure * scale:.{digits}f}"


def _gear(one: Candidate) -> str:
    ratio = "" if one.gear.ratio == 1.0 else f", {one.gear.ratio:.3g}"
    return f"{one.gear.name}{ratio}"


def _peak(one: Candidate) -> str:
    return _speed(max(demand.peak_speed for demand in one.demands))


def _speed(speed: float) -> str:
    return f"{speed * 30.0 / pi:.0f}"


def _incidence(one: Candidate) -> str:
    return f"{degrees(one.incidence):.0f}"


def main() -> None:
    """Print one table a machine."""
    for built in MACHINES:
        print(f"{built.title}\n")
        for label, *cells in rows(built):
            print(f"{label:19}" + "".join(f"{cell:>{WIDTH}}" for cell in cells))
        print()


if __name__ == "__main__":
    main()
