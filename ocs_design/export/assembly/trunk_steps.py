"""Steps on the trunk: what is drilled, what the feet stand on, and how they are turned."""

from collections.abc import Iterator, Sequence

import numpy as np

from ocs_design.common.units import format_quantity
from ocs_design.device.layout import PAIR
from ocs_design.export.assembly.content import Assembly, places
from ocs_design.export.device_parts import foot_holes, pedestal_holes, pedestal_kinds, printed_foot
from ocs_design.parts.foot import LONG_MARKS
from ocs_design.parts.module import part_name
from ocs_design.parts.pedestal import SEAT_SCREWS
from ocs_design.parts.printed import WALL


def on_the_trunk(assembly: Assembly) -> Iterator[str]:
    """How trunk, plate, mast, feet and pedestals come together."""
    foot = printed_foot(assembly.device)
    standing = foot_holes(assembly.device)
    drilled = [
        f"{part_name('foot', module)} {' and '.join(places(ends))}"
        for module, ends in standing.items()
    ]
    holes = pedestal_holes(assembly.device)
    drilled += [
        f"{part_name('pedestal', module)} {', '.join(places(ends))}"
        for module, ends in holes.items()
    ]
    heights = [
        *(
            float(module.position[2]) - foot.wheel_height
            for module in assembly.device.modules
            if module.name not in holes
        ),
        *(each.position[2] for each in assembly.device.pedestals),
    ]
    stand = " and ".join(dict.fromkeys(f"{1e3 * height:.1f}" for height in heights))
    motor, plate = assembly.device.motor, assembly.device.plate
    mass = assembly.device.flywheel.mass + assembly.device.carrier.mass - motor.controller_mass
    yield (
        f"Weigh the module with all its screws, without its controller: {1e3 * mass:.0f} g. If "
        "it is 2 % off, weigh its parts against cad/bill_of_materials.csv."
    )
    if assembly.device.layout == PAIR:
        yield (
            "Both modules are of the same parts. On the robot the right one is turned by half "
            "a turn about the vertical, so that both motors are on the inner side."
        )
    else:
        yield "All modules are of the same parts, each turned as its wheel's axis points."
    frame = "in mm forward and to the left of the frame that the design is in (`robot.trunk` of"
    what = "feet and pedestals" if standing and holes else "pedestals" if holes else "the feet"
    places_of = f"{'; '.join(drilled)}; {what} stand at z = {stand} mm"
    if plate is None:
        yield (
            "Drill the trunk by cad/drilling.pdf, printed at 100 %; it says how deep. Places, "
            f"{frame} design.json): "
            f"{places_of}."
        )
    else:
        cut = (
            f"Make the plate{assembly.number('plate')} to cad/plate.pdf (`export --formats dxf` "
            f"writes its outline for a cutter), with holes of "
            f"{1e3 * plate.screw.clearance_hole:g} mm for the trunk's screws, and threads "
            f"{plate.foot_thread} for the feet, which are, "
            f"{frame} design.json), at {places_of}. Drill and tap the trunk"
        )
        if plate.mast is None:
            yield (
                f"{cut} {plate.thread} where its other {len(plate.trunk)} holes come to lie "
                "(cad/drilling.pdf, printed at 100 %, which says how deep)."
            )
        else:
            yield (
                f"{cut}'s back {plate.thread} by cad/drilling.pdf, printed at 100 %. Whether "
                "its wall bears them is not looked at: put a plate behind it where it is thin."
            )
            mast, ends = plate.mast, [f"{1e3 * z:.1f}" for z in plate.heights]
            yield (
                f"Weld the mast{assembly.number('mast')} to cad/plate.pdf, of square tube "
                f"{1e3 * mast.side:.0f} x {1e3 * mast.wall:.0f} mm: an upright of "
                f"{1e3 * (mast.high - mast.low):.1f} mm, an arm of "
                f"{1e3 * (mast.back + plate.neck):.1f} mm whose top is "
                f"{' and '.join(ends)} mm above the lowest plate, and a plate on each arm. "
                f"Drill it {1e3 * plate.screw.clearance_hole:.1f} mm through both walls, with "
                f"a sleeve of {1e3 * mast.bore:.1f} mm between them around each screw."
            )
        origin = plate.position[:2] if plate.mast is None else plate.position[1:]
        sleeves = [
            f"{1e3 * length:.2f} mm at ({1e3 * (origin[0] + x):.1f}, {1e3 * (origin[1] + y):.1f})"
            for (x, y), length in zip(plate.trunk, plate.sleeves, strict=True)
            if length > 0.0
        ]
        if sleeves:
            yield f"Under its holes stand sleeves{assembly.number('sleeves')}: " + (
                ", ".join(sleeves) + ". File them to the trunk where it slopes under them."
            )
        yield from (
            assembly.screwed(each)
            for each in assembly.late
            if each.startswith(("plate on", "mast on"))
        )
    yield from _on_pedestals(assembly)
    if standing:
        yield _turned(assembly, list(standing))


def _turned(assembly: Assembly, standing: Sequence[str]) -> str:
    """How the feet of these modules are turned to the incidence by their scales."""
    foot = printed_foot(assembly.device)
    screws, found = next(
        each
        for each in assembly.screws.items()
        if each[0].startswith("foot on") and each[0] != SEAT_SCREWS.purpose
    )
    modules = [each for each in assembly.device.modules if each.name in standing]
    # Each axis's own, from the lateral direction: those of a ring's modules differ.
    angles = {
        module.name: format_quantity(float(np.arctan2(*np.abs(module.axis[:2]))), "deg")
        for module in modules
    }
    alike = len(set(angles.values())) == 1
    each_own = (f"{value} ({name})" for name, value in angles.items())
    scale = next(iter(angles.values())) if alike else ", ".join(each_own)
    # Away from its motor.
    outward = {
        module.name: float(np.arctan2(module.frame[1, 1], module.frame[0, 1])) for module in modules
    }
    looks = ", ".join(
        f"{format_quantity(abs(angle), 'deg')} to the {'left' if angle > 0.0 else 'right'} of "
        f"forward ({name})"
        for name, angle in outward.items()
    )
    long, degree = 360.0 / LONG_MARKS, 1e3 * np.radians(foot.base_radius - WALL)
    held, plate = found.fastening, assembly.device.plate
    into = "the threads of the plate" if plate else "threads, inserts or nuts of the trunk"
    return (
        f"The scale's 0 is the long mark square to the wheel's axis; marks are {long / 3.0:g} "
        f"deg apart, long ones {long:g}, and a degree is {degree:.2g} mm at their ends. Scribe "
        "a line forward through the middle of each foot, turn the foot until it meets "
        f"the scale at {scale}, its lid looking {looks}, and tighten {held.count} x "
        f"{held.designation}{assembly.number(screws)} with {found.torque:.2g} N m each, into "
        f"{into}."
    )


def _on_pedestals(assembly: Assembly) -> Iterator[str]:
    """How pedestals come on the trunk, and the feet that lean on them."""
    for name, kind in pedestal_kinds(assembly.device).items():
        one = kind[0]
        turned = ", ".join(
            f"{format_quantity(each.heading, 'deg', digits=3)} ({each.module})" for each in kind
        )
        yield (
            f"Print {len(kind)} x {name}{assembly.number(name)} (cad/{name}.stl) in PETG on its "
            "side, of solid layers, as strong as it is computed; tap the 2 holes of its seat "
            f"{one.base_screws.screw.name}. Its seat's far end points, from forward to the "
            f"left, to {turned}. It goes on the trunk before the foot is on it. "
            + assembly.screwed(f"{name.replace('_', ' ')} on trunk")
        )
    if assembly.device.pedestals:
        name = SEAT_SCREWS.purpose
        middles = " and ".join(
            f"{1e3 * kind[0].middle:.1f} mm" for kind in pedestal_kinds(assembly.device).values()
        )
        yield (
            f"Scribe a line across each seat, {middles} up from its low end, put the foot's "
            "middle on it with the wheel's axis along the seat, and turn the foot until the "
            f"line meets the scale at 0 deg. {assembly.screwed(name)}"
        )
