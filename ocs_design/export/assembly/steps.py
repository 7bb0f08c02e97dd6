"""Assembly steps, in the order of the work."""

from collections.abc import Iterator, Sequence
from math import ceil, sqrt

import numpy as np

from ocs_design.actuation.fasteners import BoltedJoint, screw
from ocs_design.catalogue.materials import recorded_material
from ocs_design.common.units import format_quantity, significant
from ocs_design.device.bodies import joint_name
from ocs_design.device.device import Device, Module
from ocs_design.device.joints import (
    RUN_OUT,
    SHAFT_JOINT,
    balance_of,
    bonded_on_shaft,
    joints_of,
    rim_fit,
    slipping,
    unheld_moment,
)
from ocs_design.device.layout import PAIR, SIDES
from ocs_design.device.resonances import resonances_of
from ocs_design.device.solids import shaft_cut
from ocs_design.export.assembly.content import LEAST_DRILL, Assembly
from ocs_design.export.device_parts import BLOCK, foot_holes, pedestal_kinds, places, trunk_holes
from ocs_design.parts.bell import GLUE_GAP
from ocs_design.parts.carrier_plate import SHIM, TOUCH, CarrierPlate, steepest
from ocs_design.parts.foot import LONG_MARKS
from ocs_design.parts.housing import FINGER, LID_SCREWS, lid_sag
from ocs_design.parts.joints import EPOXY
from ocs_design.parts.module import part_name
from ocs_design.parts.printed import (
    CLEARANCE,
    GUARD_GAP,
    LID_SCREW,
    PANEL,
    SHOCK,
    TRUNK_SCREW,
    WASHER_ACROSS,
    WASHER_HEIGHT,
)
from ocs_design.parts.tightening import Tightened

FREE_SPAN = 10.0e-3
"""Width that a printer bridges without supports [m]: an assumption. In a round hole with a
horizontal axis, the part that overhangs by more than 45 degrees is sqrt(2) radii wide."""

KEY_LEG, KEY_ARM = 18.0e-3, 50.0e-3
"""Short leg of a hex key for M3, and lever arm on its long leg [m]: ISO 2936, 18 and 56 mm."""

LEAST_ROOM = 6.0e-3
"""Space above a head needed to insert and turn a key with a cut leg [m]: an assumption."""

HAND_STRIP = CLEARANCE - 0.5e-3
"""Thickness of the strip that must pass between rim and housing all around [m]."""

LEAST_DEGREE = 1.0
"""Change of a length difference per degree below which a ruler is no better than the scale [mm]: an
assumption."""

LARGEST_REAMER = 20.0e-3
"""Bore diameter above which it is bored instead of reamed [m]: an assumption."""

DROP = 0.03e-3
"""Diametral clearance with which a hot rim drops onto its web before it cools [m]."""


def tools(assembly: Assembly) -> Iterator[str]:
    """Tools that this design needs, without lathe, mill and printer."""
    device = assembly.device
    if assembly.screws:
        least = min(screws.torque for screws in assembly.screws.values())
        *others, last = sorted({f"{1e3 * fastening.screw.key:g}" for fastening in assembly.screws})
        keys = f"{', '.join(others)} and {last}" if others else last
        yield f"torque screwdriver from {significant(least, 1)} N m"
        yield f"hex keys of {keys} mm"
    yield from _cutters(assembly)
    web = device.flywheel.web
    if web is not None and web.hub.bore_radius > 0.0:
        bore = 2.0 * web.hub.bore_radius
        bore_tool = f"reamer of {1e3 * bore:g} mm" if bore <= LARGEST_REAMER else "bore gauge for"
        yield f"{bore_tool} H7 for the hub"
    if device.flywheel.shape.shrunk_on:
        yield "oven to shrink the rim on its web"
    hole, cuts = balance_of(device).correction.hole_radius, device.flywheel.cuts
    if assembly.top_speed is not None and cuts.holes:
        yield f"drill of {2e3 * cuts.hole_radius:.2g} mm to balance"
    elif assembly.top_speed is not None:
        small = f"drills of {2e3 * hole:.2g} mm, with spares,"
        yield f"{small if hole >= LEAST_DRILL / 2.0 else 'small grinder'} to balance"
    cut = ["the motor's shaft"] if shaft_cut(device)[1] > 0.0 else []
    for fastening, screws in assembly.screws.items():
        room = room_above(device, screws) if fastening.joint.of_foot else None
        if room is not None and LEAST_ROOM <= room <= KEY_LEG:
            cut.append(f"the short leg of a hex key of {1e3 * fastening.screw.key:g} mm")
        if fastening.shortened is not None:
            cut.append("screws")
    if cut:
        yield f"cutting disc for {' and '.join(dict.fromkeys(cut))}"
    if "lid" in assembly.numbers:
        strips = [HAND_STRIP, *filter(None, [_height_strip(assembly)])]
        yield f"strips of {' and '.join(f'{1e3 * height:.1f}' for height in strips)} mm for gaps"
    yield from ("steel rule", "dial gauge", "hand drill on a stand", "scales to 0.01 g")
    if assembly.top_speed is not None:
        yield from ("tachometer", "accelerometer that shows its amplitude, and wax, to balance")
        yield "steel box or wall for the spin test (see there)"
        if resonances_of(device):
            yield "damping tape for the sweep, if it shakes"


def _cutters(assembly: Assembly) -> Iterator[str]:
    """Drills and taps for prints, plate and trunk, with what they cut.

    If the device cannot be built as it stands, only prints are cut.
    """
    plate, printed = assembly.device.plate, "drum" in assembly.numbers
    settled = not assembly.refused
    into = {LID_SCREW.name: ["the prints' ears"]} if printed else {}
    cage = assembly.device.mount.cage if printed else None
    if cage is not None and cage.screw != LID_SCREW:
        into = {LID_SCREW.name: ["the drum's ears"], cage.screw.name: ["the cage's"]}
    if assembly.device.pedestals:
        into.setdefault(TRUNK_SCREW.name, []).append("the pedestals' seats")
    if plate is not None and settled:
        into.setdefault(plate.foot_thread, []).append("the plate")
    if printed and settled:
        thread = TRUNK_SCREW.name if plate is None else plate.thread
        into.setdefault(thread, []).append("the trunk")
    for name, where in into.items():
        drill = 1e3 * screw(name).tapping_drill
        yield f"drill of {drill:g} mm and tap {name} for {' and '.join(where)}"
    if plate is not None and settled:
        screwed = "plate" if plate.mast is None else "mast"
        yield f"drill of {1e3 * plate.screw.clearance_hole:g} mm for the {screwed}'s screws"
    if settled and unheld_moment(assembly.device, assembly.margins):
        yield "drill of 3 mm for the feet's pins"


def module_steps(assembly: Assembly) -> Iterator[str]:
    """Steps to make, assemble and test one module."""
    device = assembly.device
    if "drum" in assembly.numbers:
        hole, supports, milled = device.foot.housing.mount.pilot_radius, "no supports", ""
        cage = device.mount.cage
        parts, ears = "drum, lid and foot", f"the drum {LID_SCREW.name}"
        if cage is not None:
            parts, ears = "drum, lid, foot and cage", f"{ears} and of the cage {cage.screw.name}"
            if cage.screw == LID_SCREW:
                ears = f"drum and cage {LID_SCREW.name}"
        if sqrt(2.0) * hole > FREE_SPAN:
            supports += f" except in the hole of {2e3 * hole:.0f} mm of the standing foot"
        if device.foot_hold.heads_bear < SHOCK:
            milled = " The foot is milled instead (see Before you start)."
        yield (
            f"Print {parts} in PETG, oriented as "
            "in cad/housing.3mf, one of each, arranged by the slicer on your bed of at least "
            f"{ceil(2e3 * device.foot.housing.radius)} mm: 0.2 mm layers, "
            f"100 % infill (strength and masses assume solid parts), {supports}.{milled} Tap the "
            f"ears of {ears}."
        )
    yield from _wheel_steps(assembly)
    if "guard" in assembly.numbers:
        yield (
            f"Make the guard ring{assembly.number('guard')} to cad/guard_ring.pdf, for the bore of "
            f"the printed drum{assembly.number('drum')}, and bond it in with epoxy ({EPOXY}, or "
            f"one that is as strong at 80 °C), {1e3 * GUARD_GAP:g} mm all around, down to its "
            "floor; roughen and degrease both."
        )
    yield from _drive_steps(assembly)
    if "lid" in assembly.numbers:
        loose = (
            " Only its screws centre it: loosen them, shift it and tighten them again. Once it "
            "runs true, take them out one by one for their threadlocker."
        )
        yield (
            "Turn the wheel by hand: it is free all around, and a strip of "
            f"{1e3 * HAND_STRIP:g} mm passes between rim and housing. Check the rim's "
            f"run-out on its motor: at most {2e3 * RUN_OUT:g} mm.{_near_lid(assembly)}"
            f"{loose if balance_of(device).shifted else ''}"
        )
        yield "Balance the wheel on its motor (below): lid off, behind the spin test's wall."
        yield assembly.screwed(LID_SCREWS)
        yield "Run the spin test (below), lid on."
        mass = device.module_mass - device.motor.controller_mass
        yield (
            f"Weigh the module with all its screws, without its controller: {1e3 * mass:.0f} g. If "
            "it is 2 % off, weigh its parts against cad/bill_of_materials.csv."
        )


def _drive_steps(assembly: Assembly) -> Iterator[str]:
    """Steps to assemble motor, housing, foot and wheel."""
    device = assembly.device
    of_motor = BoltedJoint.MOTOR, BoltedJoint.MOTOR_IN_CAGE
    if "motor" in assembly.numbers and not assembly.screws_of(*of_motor):
        # The motor's threads are not known, nor, behind a gear, its hole.
        motor, off = f"motor{assembly.number('motor')}", f"within {1e3 * RUN_OUT:g} mm of the"
        yield (
            f"Fix the {motor} to plate and drum, its axis {off} middle of their hole, as described "
            "above."
            if device.motor.gear_room is None
            else f"Fix gear{assembly.number('gear')} and {motor} as described above, the gear's "
            f"output {off} wheel's axis."
        )
    # Joint of the wheel on its drive; a ring around a bell is already bonded.
    joint = None
    if "drum" in assembly.numbers and not device.on_bell:
        joint = next((margin for margin in joints_of(device) if margin.name == SHAFT_JOINT), None)
    text = {BoltedJoint.MOTOR_IN_CAGE: " Its wires come out between two posts, tied to one."}
    if joint is not None and joint.capacity is not None:
        text[BoltedJoint.WHEEL] = f" They carry the wheel by {joint.note}."
    slip = {grip.fastening: grip for grip in slipping(device)}
    for screws in assembly.screws_of(*of_motor, BoltedJoint.CAGE, BoltedJoint.WHEEL):
        joined, filled = screws.fastening, ""
        if joined in slip:
            grip = slip[joined]
            friction, in_epoxy, torque = (
                significant(value, 2)
                for value in (grip.friction, grip.filled, device.motor.torque_limit or 0.0)
            )
            filled = (
                f" Their friction may hold no more than {friction} of the motor's {torque} N m: "
                f"wax their shanks and fill their holes in the prints with epoxy ({EPOXY}), in "
                f"which they hold {in_epoxy} N m. Without it the motor turns by "
                f"{format_quantity(grip.play, 'deg', digits=2)} back and forth in their play and "
                "may work them loose."
            )
        yield f"{assembly.screwed(joined)}{filled}{text.get(joined.joint, '')}"
    if joint is not None and joint.capacity is None:
        yield f"Mount the wheel on its drive by a joint of your own: {joint.note}."
    elif joint is not None and (strip := _height_strip(assembly)) is not None:
        yield (
            f"Put the wheel on the motor's shaft: {joint.note}. Strips of "
            f"{1e3 * strip:.1f} mm between rim and floor set its height; remove them when the "
            "compound has cured."
        )


def _height_strip(assembly: Assembly) -> float | None:
    """Thickness of strips that set a wheel's height on its shaft [m]; None if it is not bonded."""
    device = assembly.device
    if not bonded_on_shaft(device):
        return None
    return CLEARANCE + (device.foot.housing.rim_height - device.flywheel.height) / 2.0


def _near_lid(assembly: Assembly) -> str:
    """Warning on the gap of the hub or its screws to the lid if a finger can close it."""
    device, housing = assembly.device, assembly.device.foot.housing
    web = device.flywheel.web
    if web is None or device.on_bell:
        return ""
    gap = housing.half_height - PANEL - web.hub.height / 2.0 - web.hub.bolt_head
    if gap >= lid_sag(housing):
        return ""
    return (
        f" The hub clears the lid by {1e3 * gap:.1f} mm, and {FINGER:g} N on the lid press it in "
        f"by {1e3 * lid_sag(housing):.1f} mm: nobody touches it while the wheel turns."
    )


def robot_steps(assembly: Assembly) -> Iterator[str]:
    """Steps to mount the modules on the robot and name their drives."""
    device = assembly.device
    if "lid" in assembly.numbers:
        yield from _trunk_steps(assembly)
    turns: dict[str, list[str]] = {"counter-clockwise": [], "clockwise": []}
    for module in device.modules:
        outward = module.frame[:, 1] @ module.axis > 0.0
        axis = ", ".join(f"{value:.3f}" for value in np.round(module.axis, 3) + 0.0)
        turns["counter-clockwise" if outward else "clockwise"].append(
            f"{joint_name(module)} (axis {axis})"
        )
    text = "; ".join(f"{way}: {', '.join(names)}" for way, names in turns.items() if names)
    yield (
        "In the controllers and in your program, give the drives the names of their joints in the "
        f"robot files. Seen from its lid, a positive torque turns the wheel {text}. "
        "Axes are in the base frame, x forward, y left, z up, and the "
        "wheel turns about them by the right-hand rule. Test each at low torque, lid on; if it "
        "turns the wrong way, swap two of the motor's three wires and recalibrate its sensor."
    )


def _wheel_steps(assembly: Assembly) -> Iterator[str]:
    """Steps to turn the wheel, and to shrink it on its web or bond it to the motor's bell."""
    device, wide = assembly.device, 2e3 * GLUE_GAP
    if device.on_bell:
        yield (
            "Measure the bell across its straight part before the ring is bored: the bore is "
            f"{wide:g} mm wider."
        )
    yield (
        "Turn the wheel to cad/wheel.pdf (`export --formats step,dxf` writes it for a shop's "
        f"machines). Rim to bore: run-out at most {1e3 * RUN_OUT:g} mm. "
        f"Weigh it: {1e3 * device.flywheel.mass:.1f} g."
    )
    wheel, web = device.flywheel, device.flywheel.web
    if web is not None and wheel.shape.shrunk_on:
        hot, fit, material = "", rim_fit(device), recorded_material(wheel.material)
        if fit is not None and material is not None and material.thermal_expansion is not None:
            grown = 2.0 * fit.most + DROP
            hotter = grown / (2.0 * wheel.inner_radius * material.thermal_expansion)
            hot = f", at least {hotter:.0f} K hotter than the web,"
        higher = (wheel.height - web.hub.height) / 2.0
        lower, thickness = "hub" if higher > 0.0 else "rim", f"{1e3 * abs(higher):.2f}"
        shim = "" if thickness == "0.00" else f", the {lower} on a shim of {thickness} mm,"
        yield (
            f"Shrink the rim{assembly.number('rim')} on the web{assembly.number('hub')}: heat it "
            f"in an oven{hot} until it drops on the web, both on a flat plate{shim} and let both "
            "cool: this centres the web in the rim."
        )
    if not device.on_bell:
        return
    yield (
        f"Print the fixture{assembly.number('ring_fixture')} in PETG, one for each ring, floor "
        "down; scrape it until bell and ring slide in, and wax it."
    )
    yield (
        "Take the bell with its shaft off the stator, as its maker's clip allows, so that no "
        f"glue gets into the motor. Roughen and degrease bell and bore. Lay the ring"
        f"{assembly.number('flywheel')} on the step of the fixture, spread epoxy ({EPOXY}, or "
        "one that is as strong at 80 °C) around the bell, and turn it down into the ring "
        f"onto the fixture's floor: {1e3 * GLUE_GAP:g} mm of glue all around. Weigh it down, turn "
        "the ring once more, and let it cure for the full time on its maker's sheet."
    )
    yield (
        "Put the bell back on its stator and turn it: run-out of the ring at most "
        f"{2e3 * RUN_OUT:g} mm, to both sides and up and down. If it runs out of true, press the "
        "bell out of the ring with a punch on its front, clean both and bond them again in a "
        "new fixture. If it runs true, fill the other edge of the gap with epoxy too."
    )


def _trunk_steps(assembly: Assembly) -> Iterator[str]:
    """Steps to assemble trunk, plate, mast, feet and pedestals."""
    device, foot, standing = assembly.device, assembly.device.foot, foot_holes(assembly.device)
    drilled = [f"{part_name('foot', of)} {' and '.join(places(at))}" for of, at in standing.items()]
    holes = {pedestal.module: pedestal.in_base(pedestal.holes) for pedestal in device.pedestals}
    drilled += [f"{part_name('pedestal', of)} {', '.join(places(at))}" for of, at in holes.items()]
    upright = (module for module in device.modules if module.name not in holes)
    heights = [float(module.position[2]) - foot.wheel_height for module in upright]
    heights += [pedestal.position[2] for pedestal in device.pedestals]
    stand = " and ".join(dict.fromkeys(f"{1e3 * height:.1f}" for height in heights))
    yield (
        "Both modules have the same parts. On the robot the right one is turned by half "
        "a turn about the vertical, so that both motors face inward."
        if device.layout == PAIR
        else "All modules have the same parts, each turned to the direction of its wheel's axis."
    )
    frame = "in mm forward and to the left of the origin of the base frame (see Before you start)"
    what = "feet and pedestals" if standing and holes else "pedestals" if holes else "the feet"
    places_of = f"{'; '.join(drilled)}; {what} stand at z = {stand} mm"
    if assembly.refused:
        yield (
            "Do not drill the trunk or cut any part that stands on it until the open points are "
            "settled: the holes may move."
        )
    elif device.plate is None:
        yield (
            "Drill the trunk by cad/drilling.pdf, printed at 100 %; it says how deep. Places, "
            f"{frame}: {places_of}."
        )
    else:
        yield from _plate_steps(assembly, device.plate, f"{frame}, at {places_of}")
    yield from _pedestal_steps(assembly)
    if standing:
        yield _turning_step(assembly, list(standing))


def _plate_steps(assembly: Assembly, plate: CarrierPlate, holes: str) -> Iterator[str]:
    """Steps to make and mount plate, mast and sleeves; `holes` describes those for the feet."""
    through = f"holes of {1e3 * plate.screw.clearance_hole:g} mm for the trunk's screws, and "
    count, numbered = len(plate.rows), assembly.number("plate")
    what, own, each_plate = f"the plate{numbered}", "its", "the plate"
    if count > 1:
        what, own, each_plate = f"the {count} plates{numbered}", "their", "each plate"
    sheets = ", which has a sheet for each kind" if len(plate.kinds) > 1 else ""
    cut = (
        f"Make {what} to cad/plate.pdf{sheets} (`export --formats dxf` writes {own} outline for a "
        f"cutter), with {through if plate.mast is None else ''}threads "
        f"{plate.foot_thread} for the feet, {holes}. Drill and tap the trunk"
    )
    if plate.mast is None:
        room = (plate.screw.clearance_hole - plate.screw.diameter) / 2.0
        yield (
            f"{cut} {plate.thread} under {own} other {len(plate.trunk)} holes "
            "(cad/drilling.pdf, printed at 100 %, which says how deep). Drill and tap one of "
            f"those under {each_plate} by the template, screw it on there, turn it to the other "
            f"crosses and spot them through it: its holes leave {1e3 * room:.2g} mm around the "
            "screws, and paper is less exact."
        )
    else:
        yield (
            f"{cut}'s back {plate.thread} by cad/drilling.pdf, printed at 100 %. Whether "
            "its wall can carry them is not checked: put a plate behind it where it is thin."
        )
        mast, (arms, tops_text, per_arm) = plate.mast, ("an arm", "its top", "it")
        if len(plate.heights) > 1:
            arms, tops_text, per_arm = f"{len(plate.heights)} arms", "their tops", "each"
        below = [f"{1e3 * (mast.high - z):.1f}" for z in plate.heights]
        tops = " and ".join("level with" if low == "0.0" else f"{low} mm below" for low in below)
        yield (
            f"Weld the mast{assembly.number('mast')} to cad/plate.pdf, of square tube "
            f"{1e3 * mast.side:.0f} x {1e3 * mast.wall:.0f} mm: an upright of "
            f"{1e3 * (mast.high - mast.low):.1f} mm, {arms} of "
            f"{1e3 * (mast.back + plate.neck):.1f} mm with {tops_text} {tops} the upright's, and a "
            f"plate on {per_arm}. "
            f"Drill it {1e3 * plate.screw.clearance_hole:.1f} mm through both walls, with "
            f"a sleeve of {1e3 * mast.bore:.1f} mm between them around each screw."
        )
        if plate.relief is not None:
            # A block shaped to the trunk is the drill jig for its holes.
            thin, thick = 1e3 * min(map(min, mast.formed)), 1e3 * mast.off
            bush = f"{1e3 * plate.screw.clearance_hole:g} x {1e3 * plate.screw.tapping_drill:g}"
            tilt = format_quantity(steepest(plate), "deg", digits=2)
            yield (
                f"Mill the block{assembly.number(BLOCK)} to cad/block.stl or block.step, {thin:.1f}"
                f" to {thick:.1f} mm thick: its front is shaped to the trunk. Weld it before the "
                "upright, its lower end level with the end of the block in cad/plate.pdf, and "
                "drill both together. Hold the mast on the trunk where the block fits: it fits in "
                f"one place, with gaps of at most {1e3 * TOUCH:g} mm. With bushes "
                f"of {bush} mm in its holes it is the jig for the trunk's, which run along the "
                f"screws, up to {tilt} off square to the trunk. Bed it in filled epoxy."
            )
    holes_of_trunk = zip(places(trunk_holes(plate)), plate.sleeves, strict=True)
    sleeves = [f"{1e3 * length:.2f} mm at {at}" for at, length in holes_of_trunk if length > 0.0]
    if sleeves:
        shims = ""
        if any(0.0 < length < SHIM for length in plate.sleeves):
            shims = f" Shim washers do for those under {1e3 * SHIM:g} mm."
        yield (
            f"Under its holes stand sleeves{assembly.number('sleeves')}: {', '.join(sleeves)}. "
            f"File them to the trunk where it slopes under them.{shims}"
        )
    yield from map(assembly.screwed, plate.fastenings)


def _turning_step(assembly: Assembly, standing: Sequence[str]) -> str:
    """Step that turns the feet of these modules to the incidence by their scales."""
    device = assembly.device
    screws, *_ = assembly.screws_of(BoltedJoint.FOOT_ON_TRUNK, BoltedJoint.FOOT_ON_PLATE)
    modules = [module for module in device.modules if module.name in standing]
    line, readings = _scribed(device, modules)
    each_own = ", ".join(f"{value} ({name})" for name, value in readings.items())
    scale = each_own if len({*readings.values()}) > 1 else readings[standing[0]]
    looks = []
    for module in modules:
        # Away from its motor.
        angle = float(np.arctan2(module.frame[1, 1], module.frame[0, 1]))
        side, turn = "left" if angle > 0.0 else "right", format_quantity(abs(angle), "deg")
        looks.append(f"{turn} to the {side} of forward ({module.name})")
    long, degree = 360.0 / LONG_MARKS, 1e3 * np.radians(device.foot.marks_radius)
    fastening, plate = screws.fastening, device.plate
    into = "the threads of the plate" if plate else "threads, inserts or nuts of the trunk"
    # Pins through the feet if friction alone does not keep them from turning.
    unheld, pinned = unheld_moment(device, assembly.margins), ""
    if unheld:
        pinned = (
            " Then drill 3 mm through the base of each foot, clear of its slots, into what it "
            "stands on, and put a pin in: in a maneuver the wheel twists its foot with up to "
            f"{significant(unheld, 2)} N m, and the friction of its screws holds "
            f"{significant(device.foot_hold.turning, 2)} N m."
        )
    return (
        f"The scale's 0 is the long mark square to the wheel's axis; marks are {long / 3.0:g} deg "
        f"apart, long ones {long:g}, and a degree is {degree:.2g} mm at their ends. {line}, and "
        f"turn the foot until that line meets the scale at {scale}, its lid looking "
        f"{', '.join(looks)}: by eye to a degree.{_marks_apart(device, modules)} Tighten "
        f"{fastening.count} x "
        f"{fastening.designation}{assembly.number(fastening)}{screws.with_washers}, with "
        f"{significant(screws.torque, 2)} N m each, into {into}."
        f"{_under_motor(assembly, screws)}{_beside_stem(assembly, screws)}{pinned}"
    )


def _mate(module: Module, modules: Sequence[Module]) -> Module | None:
    """Module mirrored across the robot's mid-plane; None if there is none."""
    mirrored = module.position * [1.0, -1.0, 1.0]
    others = (other for other in modules if other is not module)
    return next((other for other in others if np.allclose(other.position, mirrored)), None)


def _scribed(device: Device, modules: Sequence[Module]) -> tuple[str, dict[str, str]]:
    """Reference line for the feet, and its reading on the scale of each, by module name.

    A base overhangs its plate's edge, except at the arm to the other foot or to the plate's middle;
    the line is on that arm. On the trunk, if no foot is opposite, it points forward.
    """
    plate, readings = device.plate, dict[str, str]()
    ring = plate is not None and plate.arms > len(SIDES)
    mates = (_mate(module, modules) for module in modules)
    ends = [mate.position for mate in mates if mate is not None]
    if plate is not None and ring:
        ends = [np.array(plate.position)] * len(modules)
    if len(ends) < len(modules):
        # The angle of each axis from the lateral direction: in a ring they differ.
        for module in modules:
            angle = float(np.arctan2(*np.abs(module.axis[:2])))
            readings[module.name] = format_quantity(angle, "deg")
        return "First scribe a line forward on the trunk through the middle of each foot", readings
    for module, end in zip(modules, ends, strict=True):
        inward = (end - module.position)[:2]
        inward /= np.linalg.norm(inward)
        cosine = float(-module.frame[:2, 1] @ inward)
        below = "under its motor" if cosine >= 0.0 else "under its lid"
        off = format_quantity(float(np.arccos(min(1.0, abs(cosine)))), "deg")
        readings[module.name] = f"{off} from the long mark {below}"
    surface = "trunk" if plate is None else "plate"
    target = "that of the plate" if ring else "that of the foot opposite"
    return (
        f"First scribe a line on the {surface} from the middle of each foot to {target}",
        readings,
    )


def _marks_apart(device: Device, modules: Sequence[Module]) -> str:
    """Distance of the 0 marks of opposite feet, to check their angles; empty without such feet."""
    radius, distances_by_degree = device.foot.marks_radius, {}
    for module in modules:
        mate = _mate(module, modules)
        if mate is None or module.position[1] < 0.0:
            continue
        front, back = [], []
        for opposite in (module, mate):
            x, y = opposite.frame[:2, 1]
            ahead = radius * np.array([y, -x]) * (1.0 if y > 0.0 else -1.0)
            front.append(opposite.position[:2] + ahead)
            back.append(opposite.position[:2] - ahead)
        before, behind = (1e3 * np.linalg.norm(one - two) for one, two in (front, back))
        degree = 4e3 * np.radians(radius * abs(module.frame[1, 1]))
        if degree >= LEAST_DEGREE:
            distances_by_degree[f"{before:.1f} mm in front and {behind:.1f} mm behind"] = degree
    if not distances_by_degree:
        return ""
    distances, degree = " or ".join(distances_by_degree), min(distances_by_degree.values())
    return (
        " Then measure with a steel rule on both bases between the outer ends of the 0 marks of "
        f"opposite feet: {distances}. Each degree of both feet changes the difference by "
        f"{degree:.2g} mm: when it is right to 1 mm, their mean is right to {1.0 / degree:.1g} deg."
    )


def room_above(device: Device, screws: Tightened) -> float | None:
    """Least space above foot screws under motor or cage [m]; None if there are none."""
    foot, screw, rooms = device.foot, screws.fastening.screw, []
    corner = screw.key / sqrt(3.0)
    top = float(foot.base) + screw.head_height + (WASHER_HEIGHT if screws.washers else 0.0)
    for along, across in _screws_aside(device):
        overlap = max(0.0, abs(across) - corner)
        rooms += [
            foot.wheel_height + solid.up - sqrt(solid.radius**2 - overlap**2) - top
            for solid in device.drive_solids
            if solid.low < along + corner and along - corner < solid.high and overlap < solid.radius
        ]
    return min(rooms, default=None)


def _screws_aside(device: Device) -> Iterator[tuple[float, float]]:
    """Screws of all feet from the feet's middles, towards the lid and across [m]."""
    for module in device.modules:
        out = module.frame[:2, 1]
        for hole in foot_holes(device).get(module.name, ()):
            aside = np.array(hole) - module.position[:2]
            yield float(aside @ out), float(out[0] * aside[1] - out[1] * aside[0])
    if device.pedestals:
        # On a seat they are at 45 degrees to the wheel's axis, which is along it.
        off = device.foot.slot_radius / sqrt(2.0)
        yield from ((off, off), (-off, -off))


def _under_motor(assembly: Assembly, screws: Tightened) -> str:
    """How to tighten a foot screw under motor or cage; empty if there is none."""
    room = room_above(assembly.device, screws)
    if room is None:
        return ""
    if room < LEAST_ROOM:
        return (
            " One of them is under the motor, where no key reaches it: set and tighten the foot "
            "before motor, cage and housing go on it."
        )
    cut = "" if room > KEY_LEG else f", its short leg cut to {1e3 * room - 1.0:.0f} mm,"
    return (
        f" One of them is under the motor, with {1e3 * room:.0f} mm above its head: tighten it by "
        f"a hex key of {1e3 * screws.fastening.screw.key:g} mm{cut} with "
        f"{screws.torque / KEY_ARM:.1f} N at {1e3 * KEY_ARM:.0f} mm of its long leg."
    )


def _beside_stem(assembly: Assembly, tightened_screws: Tightened) -> str:
    """How a washer under the motor fits beside the foot's stem; empty if there is room for it.

    Stems are made clear of the screws' heads, and a washer at the end of a slot is wider.
    """
    foot, radius = assembly.device.foot, WASHER_ACROSS / 2.0
    rooms = [
        -along - foot.back
        for along, across in _screws_aside(assembly.device)
        if along < 0.0 and abs(across) < foot.stem + radius
    ]
    if not tightened_screws.washers or min(rooms, default=radius) >= radius:
        return ""
    return (
        " File a side of its washer flat: the foot's stem is "
        f"{1e3 * min(rooms):.1f} mm from the middle of the screw, less than a wide washer."
    )


def _pedestal_steps(assembly: Assembly) -> Iterator[str]:
    """Steps to mount the pedestals on the trunk, and the leaning feet on them."""
    kinds = pedestal_kinds(assembly.device)
    for kind in kinds:
        name, pedestal = kind.name, kind.alike[0]
        headings = ((format_quantity(at.heading, "deg", digits=3), at.module) for at in kind.alike)
        turned = ", ".join(f"{heading} ({module})" for heading, module in headings)
        yield (
            f"Print {len(kind.alike)} x {name}{assembly.number(name)} (cad/{name}.stl) in PETG on "
            "its side at 100 % infill, as its strength assumes; tap the 2 holes of its seat "
            f"{pedestal.base_screws.screw.name}. Its seat's far end points, from forward to the "
            f"left, to {turned}. Fit it to the trunk before the foot is on it. "
            + assembly.screwed(kind.screws)
        )
    if assembly.device.pedestals:
        (seated,) = assembly.screws_of(BoltedJoint.FOOT_ON_PEDESTAL)
        middles = " and ".join(f"{1e3 * kind.alike[0].middle:.1f} mm" for kind in kinds)
        yield (
            f"Scribe a line across each seat, {middles} up from its low end, put the foot's "
            "middle on it with the wheel's axis along the seat, and turn the foot until the "
            f"line meets the scale at 0 deg. {assembly.screwed(seated.fastening)}"
            f"{_under_motor(assembly, seated)}{_beside_stem(assembly, seated)}"
        )
