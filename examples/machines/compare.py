"""Machines that were built, beside what the tool proposes for what they do (docs/machines.md).

    python examples/machines/compare.py

A machine that stands is asked for twice: with its own motor, without a gear and with its wheels
where they are, and with everything that the catalogue has.
"""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from math import isnan, nan, pi
from pathlib import Path
from tempfile import TemporaryDirectory
from types import MappingProxyType

from ocs_design import Infeasible, OcsDesign, design_ocs, read_specification
from ocs_design.device.layout import LayoutName
from ocs_design.device.records.flights import ValidationRecord
from ocs_design.requirement.device_sections import MotorSection
from ocs_design.requirement.specification import Specification
from ocs_design.requirement.vocabulary import AUTO

HERE = Path(__file__).parent
WIDTH = 23


def as_stated(stated: Specification) -> Specification:
    """The same."""
    return stated


def with_any_motor(stated: Specification) -> Specification:
    """The same with the whole catalogue, motors that are not known whole among it."""
    return replace(
        stated,
        flywheel=replace(stated.flywheel, material=AUTO),
        motor=MotorSection(name=AUTO, gear=AUTO, any=True),
    )


def hardest_slews(stated: Specification) -> Specification:
    """The same with a satellite's stress cases alone, the last of each axis."""
    turn = stated.requirement.turn
    assert turn is not None, "the specification states slews"
    return replace(stated, requirement=replace(stated.requirement, turn=turn[-3:]))


def as_pyramid(stated: Specification) -> Specification:
    """The same with four wheels."""
    stated = hardest_slews(stated)
    return replace(stated, ocs=replace(stated.ocs, layout=LayoutName.PYRAMID.value))


def on_edge(stated: Specification) -> Specification:
    """The same with all axes fore and aft, for a push from the side alone."""
    return replace(stated, ocs=replace(stated.ocs, alpha=pi / 2.0))


Asked = Mapping[str, Callable[[Specification], Specification]]

ASKED: Asked = MappingProxyType({"same motor": as_stated, "any motor": with_any_motor})


@dataclass(frozen=True)
class Built:
    """A machine as its makers published it; docs/machines.md has the sources.

    Attributes:
        title: machine and maneuver. specification: beside this file.
        spin_inertia: of one wheel [kg m^2]. wheel_mass: [kg].
        radius: of a wheel [mm], as far as it is known, for people.
        motor: its name. motor_mass: [kg]; None: not known.
        torque: limit of a wheel [N m]. speed: highest of a wheel [rad/s].
        whole: mass of a wheel with its motor, where it is known as one [kg].
        asked: what the tool is asked for, by the heading of its column.
    """

    title: str
    specification: str
    spin_inertia: float
    wheel_mass: float
    radius: str
    motor: str
    motor_mass: float | None
    torque: float
    speed: float = nan
    whole: float | None = None
    asked: Asked = field(default_factory=lambda: ASKED)

    @property
    def module_mass(self) -> str:
        """Of wheel and motor [g], for people; the rotor is counted twice if the wheel has it."""
        if self.whole is not None:
            return f"{self.whole * 1e3:.0f}"
        if self.motor_mass is None:
            return "-"
        return f"up to {(self.wheel_mass + self.motor_mass) * 1e3:.0f}"


MACHINES = (
    Built(
        title="Wheelbot v2.5, up from 36 deg",
        specification="wheelbot",
        spin_inertia=5.03e-4,
        wheel_mass=0.3,
        radius="53",
        motor="MN6007 KV160",
        motor_mass=0.180,
        torque=1.07,
    ),
    Built(
        title="Mini Wheelbot, up from 30 deg",
        specification="mini_wheelbot",
        spin_inertia=1.0e-4,
        wheel_mass=0.129,
        radius="32",
        motor="MN4006 KV380",
        motor_mass=0.068,
        torque=0.5,
    ),
    Built(
        title="Aalborg Cubli, catch from 9.7 deg",
        specification="aalborg_cubli",
        spin_inertia=6.01e-4,
        wheel_mass=0.222,
        radius="over 52",
        motor="EC 45 flat 50 W",
        motor_mass=None,
        torque=0.134,
    ),
    Built(
        title="REx Hopper, catch from 13 deg",
        specification="rex_hopper",
        spin_inertia=6.60959e-3,
        wheel_mass=0.78203,
        radius="over 92",
        motor="R100 KV90",
        motor_mass=0.731,
        torque=11.24,
    ),
    Built(
        title="REx Hopper in the air, 26.6 deg about each axis; built: its wheel for yaw",
        specification="rex_hopper_flight",
        spin_inertia=8.2888e-4,
        wheel_mass=0.329528,
        radius="over 50",
        motor="R80 KV110",
        motor_mass=0.354,
        torque=4.0,
        asked=MappingProxyType({"same motor": as_stated}),
    ),
    Built(
        title="Satellite of 50 kg, 45 deg in 10 s about each axis",
        specification="satellite",
        spin_inertia=1.364e-3,
        wheel_mass=nan,
        radius="-",
        motor="-",
        motor_mass=None,
        torque=0.1,
        speed=7000.0 * pi / 30.0,
        whole=0.9,
        asked=MappingProxyType({"orthogonal": hardest_slews, "pyramid": as_pyramid}),
    ),
    Built(
        title="A person's backpack, pushed from the side",
        specification="backpack",
        spin_inertia=nan,
        wheel_mass=nan,
        radius="-",
        motor="-",
        motor_mass=None,
        torque=nan,
        asked=MappingProxyType({"as stated": as_stated, "for the side alone": on_edge}),
    ),
)


def lightest(stated: Specification) -> OcsDesign | Infeasible:
    """The lightest device for what is stated, planned and flown, or why there is none.

    Nothing is kept for robots that are built otherwise.
    """
    nominal = replace(stated, requirement=replace(stated.requirement, reliability=0.5))
    with TemporaryDirectory() as folder:
        try:
            return design_ocs(nominal, out=Path(folder) / "ocs").design
        except Infeasible as refused:
            return refused


def rows(built: Built) -> Iterator[tuple[str, ...]]:
    """The lines of a machine's table, each with what it is of."""
    stated = read_specification(HERE / f"{built.specification}.toml")
    answers = {name: lightest(change(stated)) for name, change in built.asked.items()}
    designs = [answer for answer in answers.values() if isinstance(answer, OcsDesign)]
    yield "", "built", *(name for name, answer in answers.items() if isinstance(answer, OcsDesign))
    wheels = [design.ocs.flywheel for design in designs]
    yield "wheels", "", *(str(len(design.ocs.modules)) for design in designs)
    yield (
        "motor",
        built.motor,
        *(design.ocs.motor.name.removeprefix("Antigravity ") for design in designs),
    )
    yield "rim of", "", *(wheel.material for wheel in wheels)
    yield _line("spin inertia, g m2", 1e3, 3, built.spin_inertia, [w.spin_inertia for w in wheels])
    yield _line("wheel, g", 1e3, 0, built.wheel_mass, [wheel.mass for wheel in wheels])
    yield "outer radius, mm", built.radius, *(f"{w.outer_radius * 1e3:.0f}" for w in wheels)
    limits = [design.ocs.motor.torque_limit or nan for design in designs]
    yield _line("torque limit, N m", 1.0, 2, built.torque, limits)
    flown = [[run for run in design.validation if run.ocs] for design in designs]
    yield "flown", "", *(f"{sum(r.passed is True for r in runs)} of {len(runs)}" for runs in flown)
    tops = [max(_top_speed(run) for run in runs) for runs in flown]
    yield _line("wheel speed, rpm", 30.0 / pi, 0, built.speed, tops)
    modules = [design.ocs.mass_total / len(design.ocs.modules) for design in designs]
    yield "one module, g", built.module_mass, *(f"{mass * 1e3:.0f}" for mass in modules)
    for name, answer in answers.items():
        if isinstance(answer, Infeasible):
            yield (f"{name}: {answer.message}",)


def _top_speed(run: ValidationRecord) -> float:
    """Highest wheel speed of a flight [rad/s]."""
    return float(run.metrics["peak_wheel_speed"] or 0.0)


def _line(
    label: str, scale: float, digits: int, built: float, found: list[float]
) -> tuple[str, ...]:
    cells = ("-" if isnan(value) else f"{value * scale:.{digits}f}" for value in (built, *found))
    return label, *cells


def main() -> None:
    """Print one table a machine."""
    for built in MACHINES:
        print(f"{built.title}\n")
        for label, *cells in rows(built):
            print(f"{label:19}" + "".join(f"{cell:>{WIDTH}}" for cell in cells))
        print(flush=True)


if __name__ == "__main__":
    main()
