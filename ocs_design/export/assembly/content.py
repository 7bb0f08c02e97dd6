"""What a builder has to know, as plain values: pieces, screws, steps, tests, wiring, safety.

Pages and the report's section show the same text.
"""

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property, lru_cache
from math import sqrt

import numpy as np

from ocs_design.actuation.fasteners import IN_PLASTIC
from ocs_design.actuation.motor import DIRECT
from ocs_design.catalogue.materials import materials
from ocs_design.common.units import format_quantity, rpm, significant
from ocs_design.device.device import Device
from ocs_design.device.joints import (
    DAMPING,
    SHAFT_JOINT,
    balance_of,
    burst_of,
    joints_of,
    resonances_of,
    rim_fit,
)
from ocs_design.device.layout import PAIR
from ocs_design.device.naming import joint_name
from ocs_design.device.records.device import MarginRecord
from ocs_design.device.solids import motor_mount
from ocs_design.export.assembly.placed import (
    Piece,
    bonding_pieces,
    holds_wheel,
    module_pieces,
)
from ocs_design.export.assembly.tightening import Tightened, tightened
from ocs_design.export.assembly_notes import drive_notes
from ocs_design.export.bill_of_materials import BillRow, bill_rows
from ocs_design.export.device_parts import (
    foot_holes,
    pedestal_holes,
    pedestal_kinds,
    printed_foot,
    wheel_geometry,
)
from ocs_design.export.drawing.title_block import RUN_OUT
from ocs_design.export.drawing.wheel import Seat, seat
from ocs_design.export.electrics import demand_of, electrics
from ocs_design.export.formats import Subject
from ocs_design.parts.bell import GLUE_GAP
from ocs_design.parts.foot import LONG_MARKS
from ocs_design.parts.guard import Containment
from ocs_design.parts.joints import EPOXY
from ocs_design.parts.module import part_name
from ocs_design.parts.pedestal import SEAT_SCREWS
from ocs_design.parts.printed import CLEARANCE, LID_SCREW, WALL
from ocs_design.parts.rim import stored_energy

SPIN_STEPS = (0.1, 0.25, 0.5, 0.75, 1.0)
"""Shares of the top speed at which a wheel is watched for a minute each."""

OVERSPEED = 1.1
"""Speed of the spin test over the top speed, once, before the wheel goes on a robot."""

LEAST_DRILL = 0.8e-3
"""Diameter below which steel is ground and not drilled [m]."""

FREE_SPAN = 10.0e-3
"""Width that a printer bridges without supports [m]: an assumption. Of a round hole with its axis
level, what hangs over by more than 45 degrees is sqrt(2) times its radius wide."""

DROP = 0.03e-3
"""Air on the diameter with which a hot rim drops on its web before it has cooled [m]."""

_LABELS = {
    "flywheel": "flywheel",
    "rim": "rim",
    "hub": "web with hub",
    "motor": "motor",
    "gear": "gear",
    "drum": "housing, drum",
    "lid": "housing, lid",
    "foot": "foot",
    "cage": "cage of the motor",
    "guard": "guard ring",
    "plate": "plate under the feet",
    "mast": "mast behind the trunk",
    "sleeves": "sleeves around the trunk's screws",
    "ring_fixture": "fixture to bond a ring in",
}

_SOFT = 68.0
"""Heat deflection temperature of PETG at 0.45 MPa [deg C]: Prusament PETG, technical data sheet."""


@dataclass(frozen=True)
class PieceRow:
    """A piece, or equal screws, as the pictures number them.

    Attributes:
        number: in the pictures. name: for people. quantity: in the whole device.
        made: "bought", "turned" or "printed", and of what.
        file: to make it from; empty: none.
    """

    number: int
    name: str
    quantity: int
    made: str
    file: str


@dataclass(frozen=True)
class ScrewRow:
    """Equal screws: number in the pictures, what they are, and how they are tightened."""

    number: int
    designation: str
    quantity: int
    purpose: str
    engagement: str
    torque: str
    rule: str

    @property
    def cells(self) -> tuple[str, ...]:
        """What a table shows of it."""
        told = (self.designation, self.purpose, self.engagement, self.torque, self.rule)
        return (str(self.number), str(self.quantity), *told)


@dataclass(frozen=True)
class Chapter:
    """Sentences under a heading; in order where `numbered`."""

    title: str
    texts: tuple[str, ...]
    numbered: bool = False


@dataclass(frozen=True, eq=False)
class Assembly:
    """Everything that the pages and the report's section are made of.

    Attributes:
        robot: its name.
        device: to build.
        margins: of the recorded flights; empty where none are known.
        notes: what the design leaves to do by hand, one sentence each.
    """

    robot: str
    device: Device
    margins: Sequence[MarginRecord] = ()
    notes: tuple[str, ...] = ()

    @cached_property
    def pieces(self) -> tuple[Piece, ...]:
        """Pieces of one module in their places."""
        return module_pieces(self.device)

    @cached_property
    def bonding(self) -> tuple[Piece, ...]:
        """Ring and motor in the fixture that they are bonded in; none without a ring."""
        return bonding_pieces(self.device)

    @cached_property
    def numbers(self) -> dict[str, int]:
        """Numbers of the pieces by their names, the tool's last."""
        names = dict.fromkeys(piece.name for piece in (*self.pieces, *self.bonding))
        return {name: number for number, name in enumerate(names, start=1)}

    @cached_property
    def screws(self) -> dict[str, Tightened]:
        """Screws by what they hold."""
        on_wheel = {
            each.fastening.purpose for each in motor_mount(self.device).screwed if holds_wheel(each)
        }
        return {
            piece.name: tightened(
                piece.fastening,
                on_metal=piece.name in on_wheel,
                head_on_print=not piece.shared,
            )
            for piece in self.pieces
            if piece.fastening is not None
        }

    @cached_property
    def top_speed(self) -> float | None:
        """Highest that motor, voltage and gear let the wheel reach [rad/s]; None: not limited."""
        speed = self.device.motor.top_speed
        return speed if math.isfinite(speed) else None

    @cached_property
    def burst(self) -> Containment | None:
        """What would hold a wheel that bursts at its top speed; None where that is not known."""
        return None if self.top_speed is None else burst_of(self.device)

    def piece_rows(self) -> Iterator[PieceRow]:
        """Pieces and screws in the order of their numbers."""
        bill = bill_rows(self.device)
        drawn = {piece.name: piece for piece in (*self.pieces, *self.bonding)}
        for piece in drawn.values():
            number, count = self.numbers[piece.name], self._count(piece)
            if piece.fastening is not None:
                what = piece.fastening.designation
                yield PieceRow(number, f"screw, {_short(piece.name)}", count, f"bought: {what}", "")
            else:
                label = _LABELS.get(piece.name, piece.name.replace("_", " "))
                made, file = _made(self.device, piece.name, bill)
                yield PieceRow(number, label, count, made, file)

    def screw_rows(self) -> Iterator[ScrewRow]:
        """Screws with their torques."""
        for piece in self.pieces:
            if piece.fastening is None:
                continue
            name, found, held = piece.name, self.screws[piece.name], piece.fastening
            depth = (
                f"{1e3 * found.engagement:.1f} mm ({found.engagement / held.screw.diameter:.1f} d)"
            )
            yield ScrewRow(
                self.numbers[name],
                held.designation,
                self._count(piece),
                held.purpose,
                depth,
                f"{found.torque:.2g} N m",
                found.rule,
            )

    def _count(self, piece: Piece) -> int:
        """How many of it the device has."""
        modules = 1 if piece.shared else piece.modules or len(self.device.modules)
        return modules * (piece.count if piece.fastening is None else piece.fastening.count)

    def chapters(self) -> tuple[Chapter, ...]:
        """All text, in the order of the work."""
        whole = (
            Chapter("Before you start", tuple(self._before())),
            Chapter("Steps, for each module", tuple(self._steps()), numbered=True),
            Chapter("Balance", tuple(self._balance())),
            Chapter("Spin test, before anything goes on the robot", tuple(self._test()), True),
            Chapter("Wiring", tuple(electrics(self.device, self.margins).sentences())),
            Chapter("Safety", tuple(self._safety())),
        )
        return tuple(chapter for chapter in whole if chapter.texts)

    def _number(self, name: str) -> str:
        number = self.numbers.get(name)
        return "" if number is None else f" ({number})"

    def _before(self) -> Iterator[str]:
        yield "Read the safety notes at the end before anything turns."
        notes = (*drive_notes(self.device), *self.notes)
        yield from (f"{note[:1].upper()}{note[1:]}." for note in dict.fromkeys(notes))
        if any(
            found.fastening.depth < IN_PLASTIC and "motor" in found.fastening.purpose
            for found in self.screws.values()
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

    def _steps(self) -> Iterator[str]:
        device, wheel = self.device, wheel_geometry(self.device.flywheel)
        if "drum" in self.numbers:
            caged = "cage" in self.numbers
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
                f"Shrink the rim{self._number('rim')} on the web{self._number('hub')}: heat it in "
                f"an oven{self._hot()} until it drops on the web on a flat plate, and let both "
                "cool."
            )
        yield from self._bonded()
        if "guard" in self.numbers:
            yield (
                f"Bond the guard ring{self._number('guard')} into the drum"
                f"{self._number('drum')} with epoxy, down to its floor; its seam, if it has one, "
                "is welded through."
            )
        yield from self._motor()
        yield from (self._screwed(name) for name in self.screws if name not in self._late)
        yield from self._joint()
        if "lid" in self.numbers:
            yield (
                "Turn the wheel by hand: it is free all around, and a strip of "
                f"{1e3 * CLEARANCE - 0.5:g} mm passes between rim and housing. Check the rim's "
                f"run-out on its motor: at most {2 * RUN_OUT:g} mm."
            )
            yield "Balance the wheel on its motor (below): lid off, behind the spin test's wall."
            yield self._screwed(
                next(name for name in self.screws if name.startswith("lid")), lid=True
            )
            yield "Run the spin test (below), lid on."
            yield from self._on_the_trunk()
        yield self._direction()

    def _bonded(self) -> Iterator[str]:
        """How a ring is bonded around the bell of its motor."""
        if not self.device.on_bell:
            return
        gap, wide = 1e3 * GLUE_GAP, 2e3 * GLUE_GAP
        yield (
            "Measure the bell across its straight part before the ring is bored: the bore is "
            f"{wide:g} mm wider. Print the fixture{self._number('ring_fixture')} in PETG, one for "
            "each ring, floor down; scrape it until bell and ring slide in, and wax it."
        )
        yield (
            "Take the bell with its shaft off the stator, as its maker's clip allows, so that no "
            f"glue gets into the motor. Roughen and degrease bell and bore. Lay the ring"
            f"{self._number('flywheel')} on the step of the fixture, spread epoxy ({EPOXY}, or "
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

    def _hot(self) -> str:
        """How much hotter than its web a rim has to be to drop on it; empty: not known."""
        fit, wheel = rim_fit(self.device), self.device.flywheel
        material = materials().get(wheel.material)
        if fit is None or material is None or material.thermal_expansion is None:
            return ""
        grown = 2.0 * fit.most + DROP
        hotter = grown / (2.0 * wheel.inner_radius * material.thermal_expansion)
        return f", at least {hotter:.0f} K hotter than the web,"

    @property
    def _late(self) -> tuple[str, ...]:
        """Screws that come after balancing: those of lid and trunk."""
        return tuple(
            name
            for name in self.screws
            if name.startswith(("lid", "foot on", "plate on", "mast on", "pedestal"))
        )

    def _motor(self) -> Iterator[str]:
        """How a motor is held whose threads are not known."""
        held = (name for name in self.screws if name.startswith("motor"))
        if "motor" in self.numbers and not any(held):
            yield (
                f"Fix the motor{self._number('motor')} to plate and drum, its axis within "
                f"{RUN_OUT:g} mm of the middle of their hole, as said above."
            )

    def _joint(self) -> Iterator[str]:
        """What the joints of the wheel rest on, and how a wheel is put on a shaft."""
        if "drum" not in self.numbers or self.device.on_bell:
            return
        screwed = any(name.startswith("wheel") for name in self.screws)
        for joint in joints_of(self.device):
            if joint.name == SHAFT_JOINT and not screwed:
                room = printed_foot(self.device).housing.rim_height - self.device.flywheel.height
                yield (
                    f"Put the wheel on the motor's shaft: {joint.note}. Strips of "
                    f"{1e3 * (CLEARANCE + room / 2.0):.1f} mm between rim and floor set its "
                    "height; they come out when the compound is hard."
                )
            elif joint.name == SHAFT_JOINT:
                yield f"That joint carries the wheel by {joint.note}."

    def _screwed(self, name: str, *, lid: bool = False) -> str:
        found = self.screws[name]
        held = found.fastening
        joint = "Lid on drum" if lid else _short(name).capitalize()
        lock = (
            "; threadlocker of medium strength" if held.depth < IN_PLASTIC else "; no threadlocker"
        )
        return (
            f"{joint}: {held.count} x {held.designation}"
            f"{self._number(name)}, {found.torque:.2g} N m, crosswise in two rounds{lock}"
            f"{self._where(name)}."
        )

    def _where(self, name: str) -> str:
        """Where the trunk's screws of this length go, where there are several lengths [mm]."""
        plate = self.device.plate
        if (
            plate is None
            or len(plate.fastenings) == 1
            or name not in {held.purpose for held in plate.fastenings}
        ):
            return ""
        x, y = plate.position[:2] if plate.mast is None else plate.position[1:]
        length = self.screws[name].fastening.length
        places = _places(
            (x + at[0], y + at[1])
            for at, own in zip(plate.trunk, plate.screw_lengths, strict=True)
            if own == length
        )
        return f"; those at {', '.join(places)}"

    def _on_the_trunk(self) -> Iterator[str]:
        foot = printed_foot(self.device)
        standing = foot_holes(self.device)
        places = [
            f"{part_name('foot', module)} {' and '.join(_places(ends))}"
            for module, ends in standing.items()
        ]
        holes = pedestal_holes(self.device)
        places += [
            f"{part_name('pedestal', module)} {', '.join(_places(ends))}"
            for module, ends in holes.items()
        ]
        heights = [
            *(
                float(module.position[2]) - foot.wheel_height
                for module in self.device.modules
                if module.name not in holes
            ),
            *(each.position[2] for each in self.device.pedestals),
        ]
        stand = " and ".join(dict.fromkeys(f"{1e3 * height:.1f}" for height in heights))
        motor, plate = self.device.motor, self.device.plate
        mass = self.device.flywheel.mass + self.device.carrier.mass - motor.controller_mass
        yield (
            f"Weigh the module with all its screws, without its controller: {1e3 * mass:.0f} g. If "
            "it is 2 % off, weigh its parts against cad/bill_of_materials.csv."
        )
        if self.device.layout == PAIR:
            yield (
                "Both modules are of the same parts. On the robot the right one is turned by half "
                "a turn about the vertical, so that both motors are on the inner side."
            )
        else:
            yield "All modules are of the same parts, each turned as its wheel's axis points."
        frame = "in mm forward and to the left of the frame that the design is in (`robot.trunk` of"
        what = "feet and pedestals" if standing and holes else "pedestals" if holes else "the feet"
        places_of = f"{'; '.join(places)}; {what} stand at z = {stand} mm"
        if plate is None:
            yield (
                "Drill the trunk by cad/drilling.pdf, printed at 100 %; it says how deep. Places, "
                f"{frame} design.json): "
                f"{places_of}."
            )
        else:
            cut = (
                f"Make the plate{self._number('plate')} to cad/plate.pdf (`export --formats dxf` "
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
                    f"Weld the mast{self._number('mast')} to cad/plate.pdf, of square tube "
                    f"{1e3 * mast.side:.0f} x {1e3 * mast.wall:.0f} mm: an upright of "
                    f"{1e3 * (mast.high - mast.low):.1f} mm, an arm of "
                    f"{1e3 * (mast.back + plate.neck):.1f} mm whose top is "
                    f"{' and '.join(ends)} mm above the lowest plate, and a plate on each arm. "
                    f"Drill it {1e3 * plate.screw.clearance_hole:.1f} mm through both walls, with "
                    f"a sleeve of {1e3 * mast.bore:.1f} mm between them around each screw."
                )
            origin = plate.position[:2] if plate.mast is None else plate.position[1:]
            sleeves = [
                f"{1e3 * length:.2f} mm at ({1e3 * (origin[0] + x):.1f}, "
                f"{1e3 * (origin[1] + y):.1f})"
                for (x, y), length in zip(plate.trunk, plate.sleeves, strict=True)
                if length > 0.0
            ]
            if sleeves:
                yield f"Under its holes stand sleeves{self._number('sleeves')}: " + (
                    ", ".join(sleeves) + ". File them to the trunk where it slopes under them."
                )
            yield from (
                self._screwed(each)
                for each in self._late
                if each.startswith(("plate on", "mast on"))
            )
        yield from self._on_pedestals()
        if standing:
            yield self._turned(list(standing))

    def _turned(self, standing: Sequence[str]) -> str:
        """How the feet of these modules are turned to the incidence by their scales."""
        foot = printed_foot(self.device)
        screws, found = next(
            each
            for each in self.screws.items()
            if each[0].startswith("foot on") and each[0] != SEAT_SCREWS.purpose
        )
        modules = [each for each in self.device.modules if each.name in standing]
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
            module.name: float(np.arctan2(module.frame[1, 1], module.frame[0, 1]))
            for module in modules
        }
        looks = ", ".join(
            f"{format_quantity(abs(angle), 'deg')} to the {'left' if angle > 0.0 else 'right'} of "
            f"forward ({name})"
            for name, angle in outward.items()
        )
        long, degree = 360.0 / LONG_MARKS, 1e3 * np.radians(foot.base_radius - WALL)
        held, plate = found.fastening, self.device.plate
        into = "the threads of the plate" if plate else "threads, inserts or nuts of the trunk"
        return (
            f"The scale's 0 is the long mark square to the wheel's axis; marks are {long / 3.0:g} "
            f"deg apart, long ones {long:g}, and a degree is {degree:.2g} mm at their ends. Scribe "
            "a line forward through the middle of each foot, turn the foot until it meets "
            f"the scale at {scale}, its lid looking {looks}, and tighten {held.count} x "
            f"{held.designation}{self._number(screws)} with {found.torque:.2g} N m each, into "
            f"{into}."
        )

    def _on_pedestals(self) -> Iterator[str]:
        """How pedestals come on the trunk, and the feet that lean on them."""
        for name, kind in pedestal_kinds(self.device).items():
            one = kind[0]
            turned = ", ".join(
                f"{format_quantity(each.heading, 'deg', digits=3)} ({each.module})" for each in kind
            )
            yield (
                f"Print {len(kind)} x {name}{self._number(name)} (cad/{name}.stl) in PETG on its "
                "side, of solid layers, as strong as it is computed; tap the 2 holes of its seat "
                f"{one.base_screws.screw.name}. Its seat's far end points, from forward to the "
                f"left, to {turned}. It goes on the trunk before the foot is on it. "
                + self._screwed(f"{name.replace('_', ' ')} on trunk")
            )
        if self.device.pedestals:
            name = SEAT_SCREWS.purpose
            middles = " and ".join(
                f"{1e3 * kind[0].middle:.1f} mm" for kind in pedestal_kinds(self.device).values()
            )
            yield (
                f"Scribe a line across each seat, {middles} up from its low end, put the foot's "
                "middle on it with the wheel's axis along the seat, and turn the foot until the "
                f"line meets the scale at 0 deg. {self._screwed(name)}"
            )

    def _direction(self) -> str:
        turns: dict[str, list[str]] = {"counter-clockwise": [], "clockwise": []}
        for module in self.device.modules:
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

    def _balance(self) -> Iterator[str]:
        wheel, speed = self.device.flywheel, self.top_speed
        if speed is None:
            return
        balance = balance_of(self.device)
        yield (
            f"Grade G {balance.grade:g} (ISO 21940-11) at {rpm(speed)}: at most "
            f"{_two(1e6 * balance.unbalance)} g mm are left in one plane, the wheel's own; its "
            f"centre of mass is then {_two(1e6 * balance.eccentricity)} µm off the axis."
        )
        if balance.off_centre is not None:
            found = balance.off_centre * wheel.mass
            yield (
                f"As made it may be {1e6 * balance.off_centre:.0f} µm off, {_two(1e6 * found)} g "
                f"mm (turning, and {balance.centred_by}). So balance it on its motor, and mark "
                "both: taken apart, they go together again the same way."
            )
        holes, cuts = balance.correction, wheel.cuts
        if cuts.holes:
            yield (
                f"Remove mass by deepening the {cuts.holes} balancing holes in a face, a little at "
                "a time, on the heavy side; never to the middle of the rim."
            )
        elif holes.hole_radius >= LEAST_DRILL / 2.0:
            yield (
                "Remove mass on the heavy side with a drill of "
                f"{2e3 * holes.hole_radius:.2g} mm, at most {1e3 * holes.depth:.2g} mm deep, in "
                "both faces of the rim, one hole opposite the other, "
                f"{1e3 * holes.radius:.1f} mm from the axis and {1e3 * holes.apart:.2g} mm from "
                f"the next: so deep a pair takes {_two(1e3 * holes.mass)} g, which are "
                f"{_two(1e6 * holes.mass * holes.radius)} g mm; half as deep, half of it. One "
                f"half of the rim has room for {holes.count} pairs, {_two(1e6 * holes.most)} g mm: "
                "a wheel that is off by more is made anew."
                f"{'' if wheel.web is None else ' Nothing is taken off web and hub.'}"
            )
        else:
            yield (
                "The rim's wall is too thin to drill by hand: grind the heavy side of its face, "
                "evenly over 60 degrees."
            )
        for mode in resonances_of(self.device):
            yield (
                f"The {mode.name}'s first mode: {mode.frequency:.0f} Hz, "
                f"{60.0 * mode.frequency:,.0f} rpm. What is left pushes with {_two(mode.force)} N; "
                "a wheel that stays there shakes the module by "
                f"{_two(1e6 * mode.amplitude)} µm, with {_two(mode.acceleration / 9.81)} times its "
                f"weight ({DAMPING:.0%} damping, assumed)."
            )
        yield (
            "By hand: shaft level on two blades, heavy side down; or with an accelerometer on the "
            "foot, a trial mass of wax in three places, and the circle through the three readings."
        )

    def _test(self) -> Iterator[str]:
        speed, burst = self.top_speed, self.burst
        if speed is None or burst is None:
            return
        wheel, steel = self.device.flywheel, burst.steel.wall
        yield (
            "Clamp the module by its foot on a bench inside a closed steel box or behind steel of "
            f"at least {max(2.0, math.ceil(2e3 * steel)):.0f} mm (twice the wall that holds it, "
            "see Safety) on all sides of the wheel's plane. Nobody stands in that plane. Drive it "
            "from behind the wall; a switch there cuts the supply."
        )
        steps = ", ".join(f"{share:.0%} ({rpm(share * speed)})" for share in SPIN_STEPS)
        # Nothing but its own foot is under it on the bench.
        foot = [mode for mode in resonances_of(self.device) if mode.name == "foot"]
        past = "".join(
            f" Pass quickly through {60.0 * mode.frequency:,.0f} rpm, where the foot shakes."
            for mode in foot
        )
        yield f"One minute each at {steps}; stop, and feel the motor and look at all screws.{past}"
        motor = self.device.motor
        allowed = math.inf if motor.speed_max is None else motor.speed_max
        share = min(OVERSPEED, allowed / speed)
        over = rpm(share * speed)
        if share < OVERSPEED:
            over += ", the most that motor and wheel are allowed"
        supply = (
            ""
            if motor.bus_voltage is None or share <= 1.0
            else f", which takes {share * motor.bus_voltage:.3g} V"
        )
        margin = wheel.stress_margin
        stress = (
            ""
            if margin is None
            else f" The yield strength is then {margin / share**2:.1f} times the hoop stress."
        )
        yield f"Once, for ten seconds, {share:.0%}: {over}{supply}.{stress}"
        yield (
            "It fails if anything hums that did not before, if the vibration rises between two "
            "steps other than with the square of the speed, if the run-out has changed, if a screw "
            f"has moved, or if the print at the motor is warmer than {_SOFT - 8:.0f} °C (PETG "
            f"gives way at {_SOFT:.0f} °C). Then balance again, or build again."
        )
        yield (
            "Brake from full speed with the battery that will be used, and watch the bus voltage: "
            "it must stay below what controllers and battery stand."
        )

    def _safety(self) -> Iterator[str]:
        speed, burst = self.top_speed, self.burst
        if speed is None or burst is None:
            return
        count = len(self.device.modules)
        energy = stored_energy(self.device.flywheel.spin_inertia, speed)
        both = demand_of(self.margins, "stored energy")
        flown = ""
        if both is not None:
            flown = f"; the planned maneuvers reach {significant(both, 3)} J in all wheels"
        yield (
            f"Each wheel stores {significant(energy, 3)} J at {rpm(speed)}, {count} of them "
            f"{significant(count * energy, 3)} J{flown}. That is "
            f"{_two(count * energy / 9.81)} kg dropped from 1 m."
        )
        part = burst.fragment
        yield (
            f"If a wheel bursts at that speed, a third of it ({1e3 * part.mass:.0f} g) flies off "
            f"at {part.speed:.0f} m/s with {_two(part.energy)} J."
        )
        steel, aluminium = burst.steel, burst.aluminium
        rule = "BRL formula, 1.25 times the thickness that is just perforated"
        built = self.device.guard_wall
        if built >= steel.wall:
            yield (
                f"The guard ring of {1e3 * built:.1f} mm holds that piece by the {rule}, which "
                f"asks for {1e3 * steel.wall:.2g} mm. That formula rests on tests of large plates; "
                "no ring of this kind has been tested: stay out of the wheel's plane all the same."
            )
        elif "drum" in self.numbers:
            short = f" and its ring of {1e3 * built:.1f} mm" if built else ""
            yield (
                f"The printed guard{short} keeps fingers out. It does not hold a burst rim: that "
                f"would need a ring of {1e3 * steel.wall:.2g} mm of mild steel in the drum, "
                f"{1e3 * steel.mass:.0f} g each ({2e3 * steel.inner_radius:.1f} mm inside, "
                f"{1e3 * steel.height:.1f} mm wide; {rule}), or by an estimate without tests "
                f"behind it {1e3 * aluminium.wall:.2g} mm of 6061-T6, "
                f"{1e3 * aluminium.mass:.0f} g each. `size --guard containing` builds the one of "
                "steel in."
            )
        if "cage" in self.numbers:
            yield (
                "Between the posts of the cage the motor's bell turns with the wheel and can be "
                "touched: keep hands away while the supply is on, and cables tied to the cage."
            )
        yield (
            "Whenever the supply is on: nobody in the plane of a wheel, eye protection for "
            "everybody in the room, no loose sleeves or cables, the lid on. Wheels coast on "
            "after the supply is cut; wait until they stand."
        )
        yield (
            "After a crash, a fall on a wheel, or a touch of rim and housing: run-out, balance and "
            "spin test again before the next flight."
        )


@lru_cache(maxsize=1)
def assembly_of(subject: Subject) -> Assembly:
    """Assembly of the subject's device, for the booklet and for the report."""
    return Assembly(subject.name, subject.device, subject.margins, subject.fitting)


def _made(device: Device, name: str, bill: Sequence[BillRow]) -> tuple[str, str]:
    """How a piece is made, and the file to make it from."""
    motor = device.motor
    if name == "motor":
        return f"bought: {motor.full_name}", ""
    if name == "gear":
        return f"bought: {motor.gear}" if motor.gear != DIRECT.name else "bought", ""
    of_housing = name in ("drum", "lid", "foot", "cage")
    if of_housing or name.startswith(("pedestal", "ring_fixture")):
        return "printed, PETG", f"{'housing_' if of_housing else ''}{name}.stl"
    starts = {"rim": "flywheel rim", "hub": "flywheel web", "sleeves": "sleeve"}
    start = starts.get(name, name)
    row = next((each for each in bill if each.part.startswith(start)), None)
    if name == "guard":
        assert row is not None, "the bill has a row for the ring"
        return f"{row.material}, {row.stock}", "guard_ring.stl"
    if name in ("plate", "mast", "sleeves"):
        cut = "" if row is None else f" from {row.material}, {row.stock}"
        return f"cut{cut}", "" if name == "sleeves" else "plate.pdf"
    made = "turned" if row is None else f"turned from {row.stock}, {row.material}"
    return made, "wheel.pdf"


def _places(ends: Iterable[tuple[float, float]]) -> Iterator[str]:
    """Places of screws [mm]."""
    return (f"({1e3 * x:.1f}, {1e3 * y:.1f})" for x, y in ends)


def _short(purpose: str) -> str:
    """What screws hold, without what to mind."""
    return purpose.split(";", maxsplit=1)[0].split(", ", maxsplit=1)[0]


def _two(value: float) -> str:
    """Two digits: most of these figures are estimates."""
    return significant(value, 2)
