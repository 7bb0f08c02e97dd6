"""Facts about the robot and its device: robot as read, parts to build, and their placement."""

from collections.abc import Iterator, Mapping

from ocs_design.actuation.motor import DIRECT
from ocs_design.common.units import rpm
from ocs_design.common.wording import (
    degrees,
    degrees_number,
    grams,
    inertia,
    listed,
    millimetres,
    signed,
    tenths,
)
from ocs_design.device.layout import PAIR
from ocs_design.device.records.design import OcsDesign
from ocs_design.device.records.device import Clearance, OcsRecord
from ocs_design.device.records.requirement import RobotRecord
from ocs_design.parts.bell import GLUE_GAP
from ocs_design.report.table import CellTable, Rows, columns
from ocs_design.requirement.uncertainty import Entry, spreads, uncertainty_of_texts
from ocs_design.requirement.vocabulary import CRITERIA, LIGHTEST

_NEGLIGIBLE_PRODUCT = 5e-5
"""Share of the largest moment below which a product of inertia is shown as 0 (its last digit)."""

_NEGLIGIBLE_MASS = 1e-9
"""Mass below which a part of a module is not listed [kg]."""

_NUMBER_WORDS = ("no", "one", "two", "three", "four", "five", "six")

FIRST_FACTS = {
    "mass of a module": "module",
    "carrier plate": "plate",
    "incidence alpha*": "alpha*",
    "incidence alpha": "alpha",
    "layout": "layout",
    "rim": "rim",
    "motor": "motor",
    "gear": "gear",
    "drive at the wheel": "drive",
}
"""Key facts of the device and their short names in summaries."""


def first_facts(design: OcsDesign) -> Rows:
    """Key facts of a device, by short names."""
    facts = dict(device_facts(design))
    return tuple((short, facts[name]) for name, short in FIRST_FACTS.items() if name in facts)


def robot_facts(robot: RobotRecord) -> Rows:
    """Data read of a robot: mass, trunk, posture and locked inertia."""
    trunk = robot.trunk
    if robot.floating_base != trunk:
        trunk += f" (floating base: {robot.floating_base})"
    posture = robot.posture_name
    if robot.standing_height is not None:
        posture += f", trunk {millimetres(robot.standing_height, 0)} over the feet"
    com = ", ".join(map(tenths, robot.com))
    moments = [robot.inertia[i][i] for i in range(3)]
    products = [robot.inertia[i][j] for i, j in ((0, 1), (0, 2), (1, 2))]
    negligible = _NEGLIGIBLE_PRODUCT * max(moments)
    products_text = "  ".join(
        f"{value:.2g}" if abs(value) > negligible else "0" for value in products
    )
    return (
        ("mass", f"{robot.mass:.4g} kg"),
        ("trunk", trunk),
        ("posture", posture),
        ("centre of mass", f"{com} mm in the trunk frame"),
        (
            "locked inertia",
            f"{'  '.join(f'{value:.4g}' for value in moments)} kg m2 (xx yy zz about the CoM)",
        ),
        ("products", f"{products_text} kg m2 (xy xz yz)"),
    )


def distribution_facts(reality: Mapping[str, str]) -> Rows:
    """Distributions that samples are drawn from, in practical units."""
    texts = {name: text for name, text in reality.items() if name in spreads()}
    uncertainty = uncertainty_of_texts(texts, "reality")
    # The drive that fails is sampled too, but has no key in the specification.
    others = tuple(
        (name.replace("_", " "), text) for name, text in reality.items() if name not in texts
    )
    return others + tuple(
        (name.replace("_", " "), Entry(getattr(uncertainty, name)).words(spread))
        for name, spread in spreads().items()
        if name in texts
    )


def heading_drift(drift: tuple[float, float]) -> str:
    """Yaw that accompanies roll and pitch."""
    roll, pitch = drift
    return f"{signed(roll)} rad of yaw per rad of roll, {signed(pitch)} per rad of pitch"


def device_title(design: OcsDesign) -> str:
    """Title with the number of wheels, and a note if no motors were chosen."""
    modules = len(design.ocs.modules)
    wheels = f"{_NUMBER_WORDS[modules]} flywheel{'' if modules == 1 else 's'}"
    return f"Device: {wheels}{'' if has_motor(design) else ', no motors yet'}"


def has_motor(design: OcsDesign) -> bool:
    """Whether a motor was chosen; otherwise only wheels are sized, at an assumed speed."""
    return design.ocs.motor.bus_voltage is not None


def share_of_robot(design: OcsDesign) -> str:
    """Mass of the device over that of its robot, in words."""
    return f"{design.ocs.mass_total / design.robot.mass:.1%} of the robot"


def device_facts(design: OcsDesign) -> Rows:
    """Wheel, masses, drive and place of the device."""
    ocs, motor = design.ocs, design.ocs.motor
    rows = [*_wheel_facts(ocs), *_mass_facts(design), ("motor", motor.full_name)]
    if has_motor(design):
        if motor.gear != DIRECT.name:
            loss = f"efficiency {motor.gear_efficiency:.0%}"
            rows.append(("gear", f"{motor.gear}, ratio {motor.gear_ratio:.3g}, {loss}"))
        limits = [f"{rpm(motor.top_speed)} ({motor.top_speed_reason})"]
        if motor.torque_limit is not None:
            limits.append(f"{motor.torque_limit:.3g} N m")
        rows.append(("drive at the wheel", f"at most {listed(limits)}"))
    positions = (
        f"{module.name} ({', '.join(map(tenths, module.position))})" for module in ocs.modules
    )
    rows.append(("wheels at", f"{', '.join(positions)} mm"))
    rows.append(("nearest, standing", _clearance_text(ocs.clearance)))
    if ocs.mounting is not None:
        if ocs.mounting.landing is not None:
            rows.append(("nearest, landing", _clearance_text(ocs.mounting.landing)))
        shift = ", ".join(map(tenths, ocs.mounting.com_shift))
        changes = zip(("roll", "pitch", "yaw"), ocs.mounting.inertia_change, strict=True)
        inertias = ", ".join(f"{name} {change:+.1%}" for name, change in changes)
        shifts = f"the centre of mass by {shift} mm; the inertia: {inertias}"
        rows.append(("the device shifts", shifts))
    rows.append(("heading drift", f"{heading_drift(ocs.heading_drift)} (cannot be commanded)"))
    return tuple(rows)


def _wheel_facts(ocs: OcsRecord) -> Iterator[tuple[str, str]]:
    wheel, chosen = ocs.flywheel, ocs.incidence_criterion
    robot_alone = ocs.incidence_by_criterion_robot_alone.get(chosen)
    if robot_alone is not None:
        chosen += f"; {degrees(robot_alone)} for the robot alone"
    if ocs.axes == PAIR:
        # alpha* is the optimum of a criterion; the lightest and a specified angle are not.
        is_optimum = ocs.incidence_criterion in CRITERIA and ocs.incidence_criterion != LIGHTEST
        name = "incidence alpha*" if is_optimum else "incidence alpha"
        yield name, f"{degrees(ocs.incidence, 2)} ({chosen})"
    else:
        yield "layout", layout_text(ocs)
    outer, inner, height = (
        f"{1e3 * length:.2f}" for length in (wheel.outer_radius, wheel.inner_radius, wheel.height)
    )
    yield "rim", f"R {outer}  r {inner}  h {height} mm, {wheel.material}"
    if ocs.on_bell:
        yield "ring", f"bonded around the motor's bell, {1e3 * GLUE_GAP:g} mm of epoxy"
    if wheel.web is not None:
        web, hub = wheel.web, wheel.web.hub
        sizes = f"{tenths(web.thickness)} mm, hub R {tenths(hub.radius)}  h {tenths(hub.height)} mm"
        if web.holes is not None:
            hole_diameter = tenths(2.0 * web.holes.hole_radius)
            sizes += f", {web.holes.count} holes of {hole_diameter} mm"
        yield "web", f"{sizes}, {web.material}"
    rotor = ocs.motor.rotor_inertia
    share = f", of which its rotor {inertia(rotor)}" if rotor else ""
    yield "spin inertia", f"{inertia(ocs.spin_inertia)} each{share}"
    yield "transverse inertia", f"{inertia(wheel.transverse_inertia)} each"


def _mass_facts(design: OcsDesign) -> Iterator[tuple[str, str]]:
    ocs = design.ocs
    parts = {
        "rim": ocs.flywheel.rim_mass,
        "web": 0.0 if ocs.flywheel.web is None else ocs.flywheel.web.mass,
        "motor": ocs.motor.mass,
        "gear": ocs.motor.gear_mass,
        "controller": ocs.motor.controller_mass,
    }
    parts["housing"] = ocs.carrier.mass - parts["motor"] - parts["gear"] - parts["controller"]
    factor, unit = (1e3, "g") if max(parts.values()) < 1.0 else (1.0, "kg")
    masses = (
        f"{name} {factor * mass:.{1 if unit == 'g' else 2}f}"
        for name, mass in parts.items()
        if mass > _NEGLIGIBLE_MASS
    )
    yield "mass of a module", f"{', '.join(masses)} {unit}"
    plate = ocs.plate
    if plate is not None:
        sizes = " x ".join(tenths(length) for length in plate.sizes)
        count = len(plate.rows)
        name, its = ("carrier plate", "its") if count == 1 else (f"{count} carrier plates", "their")
        on = "" if plate.mast is None else " on a mast behind the trunk"
        on += "" if plate.relief is None else ", its block shaped to it"
        yield name, f"{grams(plate.mass)} with {its} screws, {sizes} mm{on}"
    if ocs.pedestals:
        mass = grams(sum(pedestal.mass for pedestal in ocs.pedestals))
        largest = " x ".join(map(tenths, max(pedestal.sizes for pedestal in ocs.pedestals)))
        count = len(ocs.pedestals)
        name = "pedestal" if count == 1 else f"{count} pedestals"
        yield name, f"{mass} with their screws, at most {largest} mm"
    yield "total mass", f"{grams(ocs.mass_total)} ({share_of_robot(design)})"
    controllers = len(ocs.modules) * ocs.motor.controller_mass
    if controllers > _NEGLIGIBLE_MASS:
        count, controller = len(ocs.modules), grams(ocs.motor.controller_mass)
        rest = grams(ocs.mass_total - controllers)
        yield "without controllers", f"{rest} (controllers {count} x {controller})"


def _clearance_text(clearance: Clearance | None) -> str:
    if clearance is None:
        return "not checked: the robot has no geometry"
    gap = millimetres(abs(clearance.distance))
    how = f"{gap} away" if clearance.distance >= 0.0 else f"overlapping by {gap}"
    return f"{clearance.part}, {how}"


def layout_text(ocs: OcsRecord) -> str:
    """Layout of the axes, as in "pyramid at 35.3 deg"."""
    return f"{ocs.layout} at {degrees(ocs.incidence)}" if ocs.incidence else ocs.layout


def criterion_table(ocs: OcsRecord) -> CellTable:
    """Best incidence under each criterion, with the device and for the robot alone."""
    heads = columns("<incidence by criterion", "with the device [deg]", "robot alone [deg]")
    rows = []
    for name, angle in ocs.incidence_by_criterion.items():
        alone = ocs.incidence_by_criterion_robot_alone.get(name)
        alone_text = "" if alone is None else degrees_number(alone, 2)
        rows.append((name, degrees_number(angle, 2), alone_text))
    return CellTable(heads, tuple(rows))
