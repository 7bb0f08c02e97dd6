"""The text for a builder in the order of the work; pages and the report's section show the same."""

from collections.abc import Iterator
from dataclasses import dataclass
from math import sqrt

import numpy as np

from ocs_design.actuation.fasteners import IN_PLASTIC
from ocs_design.catalogue.materials import materials
from ocs_design.device.joints import SHAFT_JOINT, joints_of, rim_fit
from ocs_design.device.naming import joint_name
from ocs_design.export.assembly.content import Assembly
from ocs_design.export.assembly.trials import balance, safety, spin_test
from ocs_design.export.assembly.trunk_steps import on_the_trunk
from ocs_design.export.assembly_notes import drive_notes
from ocs_design.export.device_parts import printed_foot, wheel_geometry
from ocs_design.export.drawing.title_block import RUN_OUT
from ocs_design.export.drawing.wheel import Seat, seat
from ocs_design.export.electrics import electrics
from ocs_design.parts.bell import GLUE_GAP
from ocs_design.parts.joints import EPOXY
from ocs_design.parts.printed import CLEARANCE, LID_SCREW, WALL

FREE_SPAN = 10.0e-3
"""Width that a printer bridges without supports [m]: an assumption. Of a round hole with its axis
level, what hangs over by more than 45 degrees is sqrt(2) times its radius wide."""

DROP = 0.03e-3
"""Air on the diameter with which a hot rim drops on its web before it has cooled [m]."""


@dataclass(frozen=True)
class Chapter:
    """Sentences under a heading; in order where `numbered`."""

    title: str
    texts: tuple[str, ...]
    numbered: bool = False


def chapters(assembly: Assembly) -> tuple[Chapter, ...]:
    """All text, in the order of the work."""
    whole = (
        Chapter("Before you start", tuple(_before(assembly))),
        Chapter("Steps, for each module", tuple(_steps(assembly)), numbered=True),
        Chapter("Balance", tuple(balance(assembly))),
        Chapter("Spin test, before anything goes on the robot", tuple(spin_test(assembly)), True),
        Chapter("Wiring", tuple(electrics(assembly.device, assembly.margins).sentences())),
        Chapter("Safety", tuple(safety(assembly))),
    )
    return tuple(chapter for chapter in whole if chapter.texts)


def _before(assembly: Assembly) -> Iterator[str]:
    yield "Read the safety notes at the end before anything turns."
    notes = (*drive_notes(assembly.device), *assembly.notes)
    yield from (f"{note[:1].upper()}{note[1:]}." for note in dict.fromkeys(notes))
    if any(
        found.fastening.depth < IN_PLASTIC and "motor" in found.fastening.purpose
        for found in assembly.screws.values()
    ):
        yield (
            "Measure how deep the motor's threads are before you put screws into them: the "
            "catalogue does not know. A screw that is too long cuts into the winding; take a "
            "shorter one, or washers, so that its tip stays 0.5 mm off the bottom."
        )
    yield (
        "Tools: torque screwdriver from 0.05 N m, hex keys, taps for the threads in the prints "
        "(drill sizes are those of the holes), dial gauge, hand drill on a stand, scales to "
        "0.01 g, tachometer."
    )


def _steps(assembly: Assembly) -> Iterator[str]:
    device, wheel = assembly.device, wheel_geometry(assembly.device.flywheel)
    if "drum" in assembly.numbers:
        caged = "cage" in assembly.numbers
        hole = printed_foot(device).housing.mount.pilot_radius
        supports = "no supports"
        if sqrt(2.0) * hole > FREE_SPAN:
            supports += f" but in the hole of {2e3 * hole:.0f} mm of the standing foot"
        yield (
            f"Print drum, lid{', foot and cage' if caged else ' and foot'} in PETG as they lie "
            f"in cad/housing.3mf: 0.2 mm layers, walls of {1e3 * WALL:g} mm are solid, at "
            f"least 50 % infill in the foot, {supports}. Tap the ears of "
            f"{'drum and cage' if caged else 'the drum'} {LID_SCREW.name}."
        )
    yield (
        f"Turn the wheel to cad/wheel.pdf. Rim to bore: run-out at most {RUN_OUT:g} mm. Weigh "
        f"it: {1e3 * device.flywheel.mass:.1f} g."
    )
    if seat(wheel) is Seat.FITTED:
        yield (
            f"Shrink the rim{assembly.number('rim')} on the web{assembly.number('hub')}: heat it "
            f"in an oven{_hot(assembly)} until it drops on the web on a flat plate, and let both "
            "cool."
        )
    yield from _bonded(assembly)
    if "guard" in assembly.numbers:
        yield (
            f"Bond the guard ring{assembly.number('guard')} into the drum"
            f"{assembly.number('drum')} with epoxy, down to its floor; its seam, if it has one, "
            "is welded through."
        )
    yield from _motor(assembly)
    yield from (assembly.screwed(name) for name in assembly.screws if name not in assembly.late)
    yield from _joint(assembly)
    if "lid" in assembly.numbers:
        yield (
            "Turn the wheel by hand: it is free all around, and a strip of "
            f"{1e3 * CLEARANCE - 0.5:g} mm passes between rim and housing. Check the rim's "
            f"run-out on its motor: at most {2 * RUN_OUT:g} mm."
        )
        yield "Balance the wheel on its motor (below): lid off, behind the spin test's wall."
        yield assembly.screwed(
            next(name for name in assembly.screws if name.startswith("lid")), lid=True
        )
        yield "Run the spin test (below), lid on."
        yield from on_the_trunk(assembly)
    yield _direction(assembly)


def _bonded(assembly: Assembly) -> Iterator[str]:
    """How a ring is bonded around the bell of its motor."""
    if not assembly.device.on_bell:
        return
    gap, wide = 1e3 * GLUE_GAP, 2e3 * GLUE_GAP
    yield (
        "Measure the bell across its straight part before the ring is bored: the bore is "
        f"{wide:g} mm wider. Print the fixture{assembly.number('ring_fixture')} in PETG, one for "
        "each ring, floor down; scrape it until bell and ring slide in, and wax it."
    )
    yield (
        "Take the bell with its shaft off the stator, as its maker's clip allows, so that no "
        f"glue gets into the motor. Roughen and degrease bell and bore. Lay the ring"
        f"{assembly.number('flywheel')} on the step of the fixture, spread epoxy ({EPOXY}, or "
        "one that is as strong at 80 °C) around the bell, and turn it down into the ring "
        f"onto the fixture's floor: {gap:g} mm of glue all around. Weigh it down, turn the "
        "ring once more, and let it cure for the full time on its maker's sheet."
    )
    yield (
        "Put the bell back on its stator and turn it: run-out of the ring at most "
        f"{2 * RUN_OUT:g} mm, to both sides and up and down. If it runs out of true, press the "
        "bell out of the ring with a punch on its front, clean both and bond them again in a "
        "new fixture. If it runs true, fill the other edge of the gap with epoxy too."
    )


def _hot(assembly: Assembly) -> str:
    """How much hotter than its web a rim has to be to drop on it; empty: not known."""
    fit, wheel = rim_fit(assembly.device), assembly.device.flywheel
    material = materials().get(wheel.material)
    if fit is None or material is None or material.thermal_expansion is None:
        return ""
    grown = 2.0 * fit.most + DROP
    hotter = grown / (2.0 * wheel.inner_radius * material.thermal_expansion)
    return f", at least {hotter:.0f} K hotter than the web,"


def _motor(assembly: Assembly) -> Iterator[str]:
    """How a motor is held whose threads are not known."""
    held = (name for name in assembly.screws if name.startswith("motor"))
    if "motor" in assembly.numbers and not any(held):
        yield (
            f"Fix the motor{assembly.number('motor')} to plate and drum, its axis within "
            f"{RUN_OUT:g} mm of the middle of their hole, as said above."
        )


def _joint(assembly: Assembly) -> Iterator[str]:
    """What the joints of the wheel rest on, and how a wheel is put on a shaft."""
    if "drum" not in assembly.numbers or assembly.device.on_bell:
        return
    screwed = any(name.startswith("wheel") for name in assembly.screws)
    for joint in joints_of(assembly.device):
        if joint.name == SHAFT_JOINT and not screwed:
            room = (
                printed_foot(assembly.device).housing.rim_height - assembly.device.flywheel.height
            )
            yield (
                f"Put the wheel on the motor's shaft: {joint.note}. Strips of "
                f"{1e3 * (CLEARANCE + room / 2.0):.1f} mm between rim and floor set its "
                "height; they come out when the compound is hard."
            )
        elif joint.name == SHAFT_JOINT:
            yield f"That joint carries the wheel by {joint.note}."


def _direction(assembly: Assembly) -> str:
    turns: dict[str, list[str]] = {"counter-clockwise": [], "clockwise": []}
    for module in assembly.device.modules:
        outward = module.frame[:, 1] @ module.axis > 0.0
        axis = ", ".join(f"{value:.3f}" for value in np.round(module.axis, 3) + 0.0)
        turns["counter-clockwise" if outward else "clockwise"].append(
            f"{joint_name(module)} (axis {axis})"
        )
    told = "; ".join(f"{way}: {', '.join(names)}" for way, names in turns.items() if names)
    return (
        "Name the drives as the robot files do. Seen from its lid, a positive torque turns the "
        f"wheel {told}. Axes are in the frame of the design, x forward, y left, z up, and the "
        "wheel turns about them by the right hand. Try each at low torque, lid on; where it is "
        "wrong, swap two of the motor's three wires, and set up its sensor again."
    )
