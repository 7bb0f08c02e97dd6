"""Notes on manual work where motor, wheel, printed parts and trunk do not fit directly."""

from collections.abc import Iterator
from math import sqrt

import numpy as np

from ocs_design.actuation.motor import DIRECT, Face, GearRoom, Mounting
from ocs_design.catalogue.motors import motors
from ocs_design.common.units import STANDARD_GRAVITY, format_quantity
from ocs_design.device.device import Device
from ocs_design.device.joints import FLOOR_SHOCK, joints_of
from ocs_design.device.resonances import DAMPING, foot_frequency, resonances_of
from ocs_design.device.solids import shaft_cut
from ocs_design.export.device_parts import foot_holes, places, trunk_holes
from ocs_design.export.drawing.wheel import BROKEN_EDGE, broken_edge_losses
from ocs_design.parts.bell import BELL_SHARE
from ocs_design.parts.cage import cage_part
from ocs_design.parts.carrier_plate import ALUMINIUM
from ocs_design.parts.foot import Foot, foot_part
from ocs_design.parts.housing import housing_parts
from ocs_design.parts.joints import GRADE
from ocs_design.parts.motor_mount import motor_front
from ocs_design.parts.printed import PETG, SHOCK, TRUNK_SCREW
from ocs_design.parts.solids import Part
from ocs_design.robot.manual import assumed_trunk, origin_by_hand
from ocs_design.robot.robot import Robot, RobotFormat
from ocs_design.robot.surface import trunk_surface

ON_TOP = 0.5e-3
"""Distance from the top of an assumed trunk within which feet count as resting on it [m]."""

_DRILL_FOR_IT = "drill floor and plate for it"


def device_notes(device: Device) -> tuple[str, ...]:
    """Notes on wheel, motor and printed parts, one sentence each."""
    notes = drive_notes(device)
    if device.flywheel.cuts.chamfer > 0.0:
        return notes
    # The wheel was sized with sharp edges.
    _, share = broken_edge_losses(device.flywheel.shape)
    edge = format_quantity(BROKEN_EDGE, "mm")
    return (
        f"with its edges broken {edge} a wheel has {share:.2%} less inertia than was designed",
        *notes,
    )


def drive_notes(device: Device) -> tuple[str, ...]:
    """Notes on motor and printed parts, one sentence each; none for wheels without motors."""
    if device.wheels_alone:
        return ()
    motor, foot = device.motor, device.foot
    if motor.gear != DIRECT.name:
        # Dimensions needed to design the mounting of motor and gear.
        room = motor.gear_room or GearRoom()
        above = format_quantity(room.offset, "mm")
        beside = f", its axis {above} above the wheel's" if room.offset else ""
        unknown = "shafts" if room.depth else "room and threads"
        known = motors().get(motor.name)
        stator = None if known is None or known.mounting is None else known.mounting.stator
        threads = "" if stator is None else f"; the motor's threads are {stator}"
        stands = (
            f"the motor sits {format_quantity(room.depth, 'mm')} behind the plate{beside}, where "
            "it is counted and shown"
            if room.depth
            else "the motor is counted right behind the plate"
        )
        note = (
            f"the mounting of motor and gear is not designed, because the gear's {unknown} are not "
            f"in the catalogue: {stands}; {_DRILL_FOR_IT}{threads}"
        )
        return (note, *_overlap_notes(device, foot), *_landing_notes(device, foot))
    mounting, known = motor.mounting or Mounting(), motors().get(motor.name)
    remark = () if known is None or not known.remark else (f"about the motor: {known.remark}",)
    notes = *_mounting_notes(mounting, device), *_shaft_notes(mounting, device)
    return (*remark, *notes, *_overlap_notes(device, foot), *_landing_notes(device, foot))


def _mounting_notes(mounting: Mounting, device: Device) -> Iterator[str]:
    """Notes on how the motor is fixed to plate and floor, and on a ring around its bell."""
    stator, mount = mounting.stator, device.mount
    if stator is None:
        bare = mount.holes.pilot_radius == 0.0
        hole = format_quantity(2.0 * mount.holes.pilot_radius, "mm")
        there = "" if bare else f", besides the hole of {hole} for the rotating parts"
        threads = "the motor's threads" if mounting.rotor is None else "the threads of its stator"
        yield f"{threads} are not in the catalogue: {_DRILL_FOR_IT}{there}"
    elif mount.holes.screws is None and mounting.stator_face is Face.BACK:
        yield (
            f"the motor's threads, {stator}, are at its back, and its size is not known or its "
            "cage does not fit the housing's floor: make a bracket for it"
        )
    elif mount.holes.screws is None:
        room = format_quantity(2.0 * device.foot.housing.inner_radius, "mm")
        unfit = f"the motor's screws, {stator}, do not fit the housing's floor of {room}"
        yield f"{unfit}: {_DRILL_FOR_IT}"
    bell, wheel = mount.bell, device.flywheel
    if bell is None:
        return
    middle, half = (device.motor.length or 0.0) - bell.front, wheel.height / 2.0
    low, high = (format_quantity(end, "mm", digits=3) for end in (middle - half, middle + half))
    yield (
        f"the ring is {low} to {high} from the motor's back; that the bell is straight there, over "
        f"the middle {BELL_SHARE:.0%} of the motor's length, is an estimate without a source: "
        "measure it before the ring is made"
    )
    if mounting.shaft_diameter is not None and mounting.shaft_length is None:
        yield (
            "no source gives how far the shaft protrudes from the motor, and 0 is assumed: if it "
            "touches the lid, cut it off"
        )
    yield (
        "the motor turns in the closed drum: cut a slot into its floor for the three wires, and "
        "watch its temperature, because its continuous torque is for free air"
    )


def _shaft_notes(mounting: Mounting, device: Device) -> Iterator[str]:
    """Notes on the wheel's joint: on the shaft, or on threads behind plate and floor."""
    remaining, cut_off = shaft_cut(device)
    if cut_off > 0.0:
        yield (
            f"the shaft would run into the lid: cut {format_quantity(cut_off, 'mm', digits=3)} off "
            f"its end, so that {format_quantity(remaining, 'mm', digits=3)} protrude from the "
            "motor, before the motor is built in and with its bearings covered"
        )
    web, mount = device.flywheel.web, device.mount
    # A rotor in a cage reaches through plate and floor to the hub.
    if web is None or (mount.cage is not None and mounting.rotor is not None):
        return
    middle = -motor_front(mount, device.flywheel.height)
    half = web.hub.height / 2.0
    near, reach, far = (
        format_quantity(length, "mm", digits=3) for length in (middle - half, middle, middle + half)
    )
    if mounting.rotor is not None:
        yield (
            f"the hub is {near} away from the rotor that it is screwed to, plate and floor between "
            "them: make a spacer, which is not designed"
        )
    elif mounting.shaft_length is None:
        yield (
            f"the shaft must protrude by {reach} to reach the hub's middle, by {far} to go "
            "through it; its length is not in the catalogue"
        )
    elif mounting.shaft_length < middle:
        short = format_quantity(middle - mounting.shaft_length, "mm", digits=3)
        yield f"the shaft ends {short} short of the hub's middle"


def _overlap_notes(device: Device, foot: Foot) -> Iterator[str]:
    """Notes on paired feet and motors that collide because they cross the robot's mid-plane."""
    if not device.layout.pairs:
        # No module is opposite its mirror image.
        return
    left = device.modules[0]
    room, inwards = float(left.position[1]), float(left.axis[1])
    if foot.base_radius > room:
        yield _overlap("feet", foot.base_radius - room)
    across = sqrt(max(0.0, 1.0 - inwards**2))
    behind = (solid.radius * across - solid.low * inwards for solid in device.drive_solids)
    reach = max(behind, default=0.0)
    if reach > room:
        yield _overlap("motors", reach - room)


def _landing_notes(device: Device, foot: Foot) -> Iterator[str]:
    """Notes on prints and screws too weak for a landing, and on speeds at which parts resonate."""
    module, modes, hold = device.module_mass, resonances_of(device), device.foot_hold
    capacity = hold.prints_bear
    heavier = _milled_heavier(foot_part(foot))
    if capacity < SHOCK:
        stronger = ALUMINIUM.strength / PETG.strength
        stiffer = foot_frequency(device, ALUMINIUM.modulus) / foot_frequency(device)
        frequencies = (mode.frequency for mode in modes if mode.name == "foot")
        sway = "".join(f", and let it sway at {frequency:.0f} Hz" for frequency in frequencies)
        yield (
            f"printed in PETG, the feet take a shock of {capacity / STANDARD_GRAVITY:.2g} g on "
            f"{module:.2g} kg along the wheel's axis, not of {SHOCK / STANDARD_GRAVITY:.0f} "
            f"g{sway}: where landings are harder, mill them from 6061-T6 to the same file, at "
            f"least {stronger:.0f} times as strong, {stiffer:.2g} times as high a frequency and "
            f"{heavier} heavier each"
        )
    if hold.heads_bear < SHOCK:
        yield (
            f"mill the feet from 6061-T6 to the same file, {heavier} heavier each, which the "
            f"device's mass does not count: at {SHOCK / STANDARD_GRAVITY:.0f} g the "
            f"heads of their screws press with {1e-6 * hold.pull / hold.area:.0f} MPa even on "
            f"washers, and PETG yields at {1e-6 * PETG.strength:.0f}"
        )
    for joint in joints_of(device):
        if joint.name == FLOOR_SHOCK and joint.capacity is not None and joint.capacity < SHOCK:
            drum, _ = housing_parts(foot.housing)
            cage = device.mount.cage
            parts = (drum,) if cage is None else (cage_part(cage), drum)
            yield (
                "printed in PETG, cage and drum hold motor and wheel up to "
                f"{joint.capacity / STANDARD_GRAVITY:.2g} g along the wheel's axis, not "
                f"{SHOCK / STANDARD_GRAVITY:.0f}: where landings are harder, mill both from "
                f"6061-T6 to the same files, {' and '.join(map(_milled_heavier, parts))} heavier"
            )
    for mode in modes:
        if mode.acceleration > STANDARD_GRAVITY:
            yield (
                f"let no wheel dwell at {60.0 * mode.frequency:,.0f} rpm: there the {mode.name}'s "
                f"first mode shakes the module with "
                f"{mode.acceleration / STANDARD_GRAVITY:.1f} times its weight "
                f"({mode.frequency:.0f} Hz, unbalance of grade G {GRADE:g}, damping {DAMPING:.0%})"
            )


def _milled_heavier(printed: Part[float]) -> str:
    """Mass that a printed part gains if it is milled from 6061-T6."""
    own = printed.mass_properties().mass
    return f"{1e3 * own * (ALUMINIUM.density / PETG.density - 1.0):.0f} g"


def _overlap(parts: str, length: float) -> str:
    overlap = format_quantity(length, "mm", digits=2)
    return (
        f"the {parts} overlap, each by {overlap} beyond the robot's middle plane: set the modules "
        "farther apart with --position"
    )


def trunk_notes(device: Device, robot: Robot) -> tuple[str, ...]:
    """Notes on the holes in the trunk, and on the position of their reference frame."""
    if device.wheels_alone:
        return ()
    surface = trunk_surface(robot)
    if surface is not None:
        half, last = surface.step / 2.0, surface.y + surface.step * (surface.heights.shape[1] - 1)
        rear, front = surface.x_range
        ends = (
            ("front end", front + half, "behind", "before"),
            ("rear end", half - rear, "before", "behind"),
            ("left side", last + half, "right of", "left of"),
            ("right side", half - surface.y, "left of", "right of"),
            ("highest point", float(surface.heights.max()), "below", "above"),
        )
        measured = ", ".join(
            f"{1e3 * abs(gap):.1f} mm {one if gap >= 0.0 else other} the {what}"
            for what, gap, one, other in ends
        )
        of = "of the trunk with all that the robot's file fixes to it"
        return trunk_threads(device), f"the origin of the base frame lies {measured} {of}"
    if robot.format is not RobotFormat.MANUAL:
        return (trunk_threads(device),)
    where = f"the origin of the base frame is {origin_by_hand(robot.com.tolist())}"
    box = assumed_trunk(robot)
    if box is None:
        return trunk_threads(device), where
    top = float(box.position[2] + np.abs(box.rotation[2]) @ box.size)
    lowest = min(float(module.position[2]) for module in device.modules)
    gap, stand = lowest - device.foot.wheel_height - top, "on its top"
    if gap > ON_TOP:
        stand = f"{1e3 * gap:.1f} mm above its top, and what is between them is not designed"
    elif gap < -ON_TOP:
        stand = f"{-1e3 * gap:.1f} mm below its top, inside it"
    sides = " x ".join(f"{2e3 * half:.0f}" for half in box.size)
    return (
        trunk_threads(device),
        f"{where}; the trunk's shape is not known and taken as a box of {sides} mm: its top "
        f"is at z = {1e3 * top:.1f} mm, and the feet stand {stand}. Compare it with the robot",
    )


def trunk_threads(device: Device) -> str:
    """Note on the holes in the trunk for the plate, or for the feet themselves."""
    plate = device.plate
    if device.pedestals:
        count = 4 * len(device.pedestals) + 2 * len(foot_holes(device))
        return (
            f"printed pedestals carry the feet that lean; the trunk needs threads "
            f"{TRUNK_SCREW.name} for {count} screws, whose places in the base frame are on "
            "cad/drilling.pdf; whether its wall can carry them is not checked"
        )
    if plate is None:
        return (
            f"the trunk needs threads {TRUNK_SCREW.name} for the feet's screws, which stand at 45 "
            "degrees to the lateral direction on a circle of "
            f"{format_quantity(2.0 * device.foot.slot_radius, 'mm', digits=3)}; their "
            "places in the base frame are on cad/drilling.pdf"
        )
    at, longest, sleeved = ", ".join(places(trunk_holes(plate))), max(plate.sleeves), ""
    if longest > 0.0:
        sleeved = f"; sleeves of up to {format_quantity(longest, 'mm', digits=3)} go under it"
    if plate.relief is not None:
        sleeved = ", through a block shaped to the trunk"
    if plate.mast is not None:
        return (
            f"a mast behind the trunk carries the feet; the trunk's back needs threads "
            f"{plate.thread} for its {len(plate.trunk)} screws at y, z = {at} mm of the base "
            f"frame{sleeved}; whether its wall can carry them is not checked"
        )
    carried = "a plate carries" if len(plate.rows) == 1 else f"{len(plate.rows)} plates carry"
    return (
        f"{carried} the feet; the trunk needs threads {plate.thread} for its "
        f"{len(plate.trunk)} screws at x, y = {at} mm of the base frame{sleeved}"
    )
