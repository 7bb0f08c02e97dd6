"""The story of a design in the terminal: what was read, asked, found, proved and written."""

from collections.abc import Iterable

import numpy as np
from rich.console import Console
from rich.text import Text

from ocs_design.design_file import MarginRecord, OcsDesign
from ocs_design.report.coupling import coupling_notes
from ocs_design.report.device import print_device
from ocs_design.report.doubts import doubts
from ocs_design.report.flights import print_flights
from ocs_design.report.landings import landing_remarks
from ocs_design.report.layout import (
    columns,
    facts,
    heading,
    items,
    note,
    print_warnings,
    show,
)
from ocs_design.report.margins import print_margins
from ocs_design.report.prices import COLUMNS, price_cells, price_notes
from ocs_design.report.quantities import (
    degrees,
    millimetres,
    rpm,
    tenths,
)
from ocs_design.report.selection import print_selection
from ocs_design.robot_record import RobotRecord
from ocs_design.selection_record import SelectionRecord
from ocs_design.sizing.margins.margin import Margin

TURNS = (
    "Turns are sized for constant torque one way and then the other, a peak rate of 2 theta / T: "
    "the least torque that does it. More torque may do with up to half the wheel: the flights tell."
)

DRIVEN = (
    "Momenta are those of constant torque one way and then the other; spin inertia is what the "
    "chosen drive needs, which may hold its speed longer and leave less in the wheels."
)

ROUNDING = 1e-9
"""Of the largest moment of inertia: a product below this is what rounding leaves of zero."""


def print_design(console: Console, design: OcsDesign) -> None:
    """The whole report of `size`."""
    print_robot(console, design.robot)
    _print_requirement(console, design)
    if design.selection is not None:
        print_selection(console, design.selection)
    print_device(console, design)
    _print_limits(console, design)
    _print_margins(console, design)
    print_flights(console, design)
    items(console, landing_remarks(design), style="yellow")


def print_solution(console: Console, design: OcsDesign) -> None:
    """Joint by joint, and how the optimum was found."""
    if design.robot.posture:
        print_joints(console, design.robot)
    sizing, chosen = design.sizing, design.selection is not None
    gap = () if chosen else (("relative duality gap", f"{sizing.gap:.1e}"),)
    heading(console, "Solution")
    facts(
        console,
        [
            ("status", sizing.status),
            ("method", sizing.method),
            ("objective", f"{sizing.objective!r} kg, {'both modules' if chosen else 'one rim'}"),
            *gap,
            ("fixed point", f"residual {sizing.residual:.1e} after {sizing.iterations} iterations"),
            *((f"price of {name}", f"{price!r}") for name, price in sizing.shadow_prices.items()),
        ],
    )


def print_joints(console: Console, robot: RobotRecord) -> None:
    """Value of every joint in the nominal posture."""
    heading(console, f"Joints at {robot.posture_name}")
    table = columns("joint", "rad or m", "deg")
    for name, value in robot.posture.items():
        table.add_row(Text(name), f"{value:.4f}", degrees(value).removesuffix(" deg"))
    show(console, table)


def print_robot(console: Console, robot: RobotRecord, more: Iterable[tuple[str, str]] = ()) -> None:
    """What was read: mass, trunk, posture, locked inertia, and more of it; then the warnings."""
    heading(console, f"Robot: {robot.name}")
    facts(console, [*robot_facts(robot), *more])
    print_warnings(console, robot.warnings)


def robot_facts(robot: RobotRecord) -> list[tuple[str, str]]:
    """Names and values."""
    trunk = robot.trunk
    if robot.floating_base != trunk:
        trunk += f" (floating base: {robot.floating_base})"
    posture = robot.posture_name
    if robot.standing_height is not None:
        posture += f", trunk {millimetres(robot.standing_height, 0)} over the feet"
    com = ", ".join(map(tenths, robot.com))
    diagonal = "  ".join(f"{robot.inertia[i][i]:.4g}" for i in range(3))
    least = ROUNDING * max(robot.inertia[i][i] for i in range(3))
    products = "  ".join(
        f"{value:.2g}" if abs(value) > least else "0"
        for value in (robot.inertia[i][j] for i, j in ((0, 1), (0, 2), (1, 2)))
    )
    return [
        ("mass", f"{robot.mass:.4g} kg"),
        ("trunk", trunk),
        ("posture", posture),
        ("centre of mass", f"{com} mm in the trunk frame"),
        ("locked inertia", f"{diagonal} kg m2 (xx yy zz about the CoM)"),
        ("products", f"{products} kg m2 (xy xz yz)"),
    ]


def _print_requirement(console: Console, design: OcsDesign) -> None:
    requirement = design.requirement
    heading(console, f"Requirement: wheels of at most {rpm(requirement.wheel_speed_max)}")
    table = columns(
        "asked by",
        "alpha\ndeg",
        "roll\nmN m s",
        "pitch\nmN m s",
        "spin inertia\nkg m2",
        "least torque\nN m",
    )
    for demand in requirement.demands:
        table.add_row(
            Text(demand.source),
            f"{np.degrees(demand.incidence):.1f}",
            f"{1e3 * demand.roll_momentum:.1f}",
            f"{1e3 * demand.pitch_momentum:.1f}",
            f"{demand.spin_inertia:.3e}",
            f"{demand.torque:.3f}" if demand.torque else "-",
        )
    if requirement.spin_inertia_by_hand is not None:
        table.add_row("stated", "", "", "", f"{requirement.spin_inertia_by_hand:.3e}", "-")
    show(console, table)
    note(console, TURNS if design.selection is None else DRIVEN)
    items(console, doubts(design), style="yellow")
    items(console, coupling_notes(design))
    if requirement.assumptions:
        heading(console, "Assumed, because nothing else was stated")
        items(console, requirement.assumptions)


def _print_limits(console: Console, design: OcsDesign) -> None:
    sizing, selection = design.sizing, design.selection
    if selection is not None and selection.prices:
        _print_prices(console, selection)
        return
    heading(console, "What binds")
    if not sizing.binding:
        note(console, "Nothing: the rim lies inside all limits.")
        return
    table = columns("limit", "worth for one rim")
    for name in sizing.binding:
        table.add_row(name, price_text(name, sizing.shadow_prices.get(name)))
    show(console, table)


def _print_prices(console: Console, selection: SelectionRecord) -> None:
    binding = ", ".join(selection.binding) or "nothing"
    heading(console, f"What binds: {binding}; and what more would buy")
    table = columns(*COLUMNS)
    for price in selection.prices:
        table.add_row(*map(Text, price_cells(price)))
    show(console, table)
    note(console, " ".join(price_notes(selection)))


def price_text(name: str, price: float | None) -> str:
    """A shadow price per unit that an engineer would change: kg per m is g per mm."""
    if price is None:
        return "-"
    if name in {"r_max", "r_min", "h_max", "h_min", "wall_min"}:
        return f"{price:+.2f} g per mm more"
    if name == "hoop_stress":
        return f"{price * 1e9:+.2f} g per MPa more"
    return f"{price:+.3g} kg per unit more"


def _print_margins(console: Console, design: OcsDesign) -> None:
    print_margins(console, recorded_margins(design))
    if design.ocs.flywheel.stress_margin is None:
        material = design.ocs.flywheel.material
        note(console, f"Stress is NOT checked: no strength of {material} is known.", style="yellow")


def recorded_margins(design: OcsDesign) -> list[Margin]:
    """Every margin of a design."""
    return [_margin(record) for record in design.margins]


def _margin(record: MarginRecord) -> Margin:
    return Margin(
        record.name, record.demand, record.capacity, record.unit, record.note, record.maneuver
    )
