"""How a device sits on its robot: contacts, clearances, possible collisions, change of mass."""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import chain, combinations, product
from math import inf, isfinite

import numpy as np
from numpy.typing import NDArray

from ocs_design.common.arrays import FloatArray
from ocs_design.common.errors import SpecificationError
from ocs_design.common.units import format_quantity
from ocs_design.common.wording import some_of
from ocs_design.device.bodies import flywheel_name
from ocs_design.device.device import Device
from ocs_design.device.layout import PAIR, SIDES, Layout
from ocs_design.device.records.device import Clearance
from ocs_design.device.records.flights import OpenPoint
from ocs_design.device.solids import (
    ModuleSolids,
    mast_solids,
    module_solids,
    pedestal_of,
    pedestal_solids,
    plate_heads,
    plate_solids,
)
from ocs_design.parts.carrier_plate import TOUCH, CarrierPlate, steepest
from ocs_design.parts.dog_bone import directions
from ocs_design.parts.module import part_name
from ocs_design.parts.pedestal import Pedestal, pedestal_use
from ocs_design.requirement.device_sections import Envelope
from ocs_design.requirement.maneuver import Maneuver
from ocs_design.robot.clearance import nearest_in_landings, reaches
from ocs_design.robot.collision import CollisionModel, Nearest, collision_model
from ocs_design.robot.mass import MassProperties
from ocs_design.robot.probe import Drum, Reach
from ocs_design.robot.robot import Robot
from ocs_design.robot.surface import HeightMap, trunk_back, trunk_surface
from ocs_design.sizing.footing.contact import (
    INTERFERENCE_MAX,
    FootContact,
    contact_of,
    disc_points,
    highest_of,
    plate_points,
    ring_points,
    under_pedestal,
)
from ocs_design.sizing.footing.feet import device_size, feet_of, is_tilted
from ocs_design.sizing.footing.formed import TILT_MAX, distance_from_trunk
from ocs_design.sizing.footing.mast import Pads, pads_needed
from ocs_design.sizing.footing.plate import SPREAD
from ocs_design.sizing.free_place import place_free


@dataclass(frozen=True, eq=False)
class DeviceMounting:
    """How a device sits on its robot, at every incidence flown.

    Modules are their housings, motors and feet, or bare wheels.

    Attributes:
        nearest: clearance in the nominal posture; None if the robot has no geometry.
        landing: clearance to parts that move relative to the trunk, while the legs give way as in
            landings; None if there are none.
        reachable: limbs that could hit a module somewhere within their joint limits.
        com_shift: shift of the centre of mass by the device, in B [m], shape (3,).
        inertia_change: change of I_xx, I_yy and I_zz about the centre of mass, relative to the
            robot's own.
        feet: what each foot stands on, which may be the plate; empty where wheels have no feet.
        pedestals: the pedestal of each tilted foot, existing or needed.
        module_mass: mass of the module on each [kg].
        pads: flat spots that would hold a mast; None: the modules are not in pairs, or no mast is
            strong enough.
        layout: of the wheels.
    """

    nearest: Clearance | None
    landing: Clearance | None
    reachable: tuple[Reach, ...]
    com_shift: FloatArray
    inertia_change: FloatArray
    feet: tuple[FootContact, ...] = ()
    pedestals: tuple[Pedestal, ...] = ()
    module_mass: float = 0.0
    pads: Pads | None = None
    layout: Layout = PAIR

    @property
    def known(self) -> bool:
        """Whether it is known what the feet stand on."""
        return all(contact.held is not None for contact in self.feet)


def mounting_open_points(mounting: DeviceMounting) -> tuple[OpenPoint, ...]:
    """Open points of a mounting: feet without support, and collisions.

    Feet on a trunk of unknown shape are not an open point: `known` reports them.
    """
    points: list[OpenPoint] = []
    cure = "choose a layout whose axes are horizontal: --layout pair, triad or single"
    tilted = [contact.name for contact in mounting.feet if contact.tilted]
    use = max(
        (pedestal_use(pedestal, mounting.module_mass) for pedestal in mounting.pedestals), default=0
    )
    if tilted:
        largest = max(mounting.pedestals, key=lambda pedestal: pedestal.mass)
        mass = format_quantity(sum(pedestal.mass for pedestal in mounting.pedestals), "g", digits=3)
        length, width, height = (format_quantity(size, "mm", digits=2) for size in largest.sizes)
        what = (
            f"{some_of(tilted, len(tilted))} cannot stand on the trunk: a wheel whose axis is "
            "not horizontal needs a pedestal, and the trunk is nowhere flat enough for all "
            f"pedestals and other feet. Pedestals would weigh {mass} together, the largest "
            f"{length} long, {width} wide and {height} high, and use {use:.0%} of their strength "
            "at 20 g; mass, positions and files do not include them"
        )
        points.append(OpenPoint(what=what, cure=cure))
    elif use > 1.0:
        what = f"the pedestals' screws or threads would use {use:.0%} of their strength at 20 g"
        points.append(OpenPoint(what=what, cure=cure))
    points += _unsupported_feet(mounting)
    collision = _collision(mounting)
    if collision:
        cure = f"give another place with {_position_option(mounting.layout)}"
        points.append(OpenPoint(what=collision, cure=cure))
    return tuple(points)


def _position_option(layout: Layout) -> str:
    """Command line option for the positions of a layout's wheels, as text."""
    one = layout == PAIR or len(layout) == 1
    return "--position X,Y,Z" if one else "--position, with x, y and z of every wheel"


def _unsupported_feet(mounting: DeviceMounting) -> Iterator[OpenPoint]:
    """Feet that are not held, and what would hold them; similar ones are reported once."""
    feet, pads = mounting.feet, mounting.pads
    unsupported = [contact for contact in feet if contact.held is False and not contact.tilted]
    in_pairs = any(contact.name.startswith(SIDES[0]) for contact in feet)
    more_feet = (
        "make a plate that carries all feet, or choose another layout: --layout pair, double-pair "
        "or triad"
    )
    interference = max((contact.interference for contact in unsupported), default=0.0)
    if interference > INTERFERENCE_MAX:
        reaches_up = format_quantity(interference, "mm", digits=2)
        what = f"the {feet[0].on} under the feet reaches {reaches_up} above their underside"
        higher = f"stand the modules higher with {_position_option(mounting.layout)}"
        yield OpenPoint(what=what, cure=higher if in_pairs else more_feet)
    elif unsupported:
        gap = max(contact.gap or 0.0 for contact in unsupported)
        share = min(contact.share or 0.0 for contact in unsupported)
        names = some_of(list(dict.fromkeys(contact.name for contact in unsupported)))
        most = "at screws the gap is up to " + format_quantity(gap, "mm", digits=2)
        at_screws = most if isfinite(gap) else "under screws there is nothing"
        what = (
            f"{names}: {share:.0%} of the underside touches the {unsupported[0].on}; {at_screws}"
            if share > 0.0
            else "the feet hang in the air: the trunk is not below them, or too far below"
        )
        flat_spot = format_quantity(2.0 * SPREAD, "mm")
        cure = (
            f"give a place on the trunk with {_position_option(mounting.layout)}, or another trunk "
            f"with --trunk, or make a flat spot of {flat_spot} by {flat_spot} on top of it for a "
            "plate's four screws"
        )
        cures = [cure] if in_pairs else []
        if pads is not None:
            wide, aside, up = (
                format_quantity(length, "mm", digits=2)
                for length in (pads.diameter, pads.aside, pads.up)
            )
            cures.append(
                "keep limbs and protrusions clear of its back, which is flat enough for the "
                f"{pads.screw} screws of a mast"
                if pads.exist
                else f"make four flat spots of {wide} on its back, {aside} apart sideways and at "
                f"least {up} up and down, for a mast's {pads.screw} screws, nothing behind them"
            )
        yield OpenPoint(what=what, cure=", or ".join(cures) or more_feet)


def _collision(mounting: DeviceMounting) -> str:
    """Collision in the nominal posture or in a landing, as a clause; empty if there is none."""
    nearest, landing = mounting.nearest, mounting.landing
    if nearest is not None and nearest.distance < 0.0:
        overlap = format_quantity(-nearest.distance, "mm")
        return f"a module overlaps '{nearest.part}' by {overlap} in the nominal posture"
    if landing is not None and landing.distance < 0.0:
        return f"'{landing.part}' can hit a module while the legs give way in a landing"
    return ""


def mounting_of(
    robot: Robot, device: Device, maneuvers: Sequence[Maneuver], total: MassProperties
) -> DeviceMounting:
    """How a device sits on its robot, also at the incidences that maneuvers have of their own.

    `total`: robot and device together, in B.
    """
    collision = collision_model(robot)
    turned = {
        turned_device.incidence: turned_device
        for turned_device in (device, *(device.as_flown(m) for m in maneuvers))
    }
    flown = [
        [module_solids(turned_device, module) for module in turned_device.modules]
        for turned_device in turned.values()
    ]
    solids = [solid for modules in flown for module in modules for solid in module.all]
    solids += plate_solids(device.plate)
    solids += [solid for pedestal in device.pedestals for solid in pedestal_solids(pedestal)]
    surface = trunk_surface(robot) if device.carrier.mass > 0.0 else None
    feet = contacts_of(robot, device)
    # With a mast's formed block, the last resort, heels are assumed not to be kicked up against it.
    on_feet = device.plate is not None and device.plate.relief is not None
    landing = [nearest_in_landings(collision, solid, on_feet=on_feet) for solid in solids]
    return DeviceMounting(
        nearest=_nearest_part(collision, device, flown, surface),
        landing=_clearance(landing),
        reachable=reaches(collision, solids),
        com_shift=total.com - robot.com,
        inertia_change=np.diag(total.inertia) / np.diag(robot.inertia) - 1.0,
        feet=feet,
        pedestals=device.pedestals
        or tuple(
            pedestal_of(device, module)
            for module, contact in zip(device.modules, feet, strict=False)
            if contact.tilted
        ),
        module_mass=device.module_mass,
        pads=pads_needed(robot, feet_of(device), device.layout)
        if any(contact.held is False for contact in feet)
        else None,
        layout=device.layout,
    )


def placement_warnings(
    mounting: DeviceMounting,
    robot: Robot,
    device: Device,
    envelope: Envelope,
    *,
    specified: bool,
    strict: bool = False,
) -> tuple[str, ...]:
    """Collisions at the modules' place, one sentence each; joint limits are not considered.

    Args:
        specified: whether the user chose the position.
        strict: whether collisions are errors.

    Raises:
        SpecificationError: `strict`, and there is a collision.
    """
    collision = _collision(mounting)
    if not collision:
        return ()
    layout, hint = device.layout, "no free place was found"
    if not specified:
        hint += f": give one with {_position_option(layout)}"
    elif layout != PAIR:
        hint = f"give another place with {_position_option(layout)}"
    elif (best := place_free(robot, envelope, layout)).free:
        left, _ = best.place.centers(device_size(device))
        place = ",".join(f"{1e3 * float(value):.1f}mm" for value in left)
        hint = f"--position {place}, {best.face} the trunk, would be free"
    if strict:
        raise SpecificationError(f"--strict: {collision}", hint=hint)
    return (f"{collision}; {hint}",)


def _nearest_part(
    collision: CollisionModel,
    device: Device,
    flown: Sequence[Sequence[ModuleSolids]],
    surface: HeightMap | None,
) -> Clearance | None:
    """The nearest of all links, the plate and other modules; a module is named after its wheel.

    Feet and plate stand on the trunk, so their distance from it does not count. Where the trunk's
    surface is known, it replaces the trunk's convex hull.
    """
    modules = [module for modules_at_incidence in flown for module in modules_at_incidence]
    pedestals = {pedestal.module: pedestal_solids(pedestal) for pedestal in device.pedestals}
    below = chain(
        plate_solids(device.plate), *pedestals.values(), *(module.foot for module in modules)
    )
    bodies = [solid for module in modules for solid in module.body]
    nearest = _clearance(
        collision.nearest(solid, collision.nominal, parts)
        for solids, parts in (
            (bodies, collision.parts if surface is None else collision.limbs),
            (below, collision.limbs),
        )
        for solid in solids
    )
    clearances = [] if nearest is None else [nearest]
    if surface is not None:
        trunk = collision.robot.trunk
        clearances += [Clearance(trunk, _height_above(surface, solid)) for solid in bodies]
        clearances = [clearance for clearance in clearances if np.isfinite(clearance.distance)]
    if not clearances:
        return None
    for modules_at_incidence in flown:
        for (_, one), (module, other) in combinations(
            zip(device.modules, modules_at_incidence, strict=True), 2
        ):
            apart = min(collision.between(*solids) for solids in product(one.all, other.all))
            clearances.append(Clearance(flywheel_name(module), apart))
        for module, solids_of_module in zip(device.modules, modules_at_incidence, strict=True):
            clearances += [
                Clearance("pedestal", collision.between(body, solid))
                for name, frame in pedestals.items()
                if name != module.name
                for body, solid in product(solids_of_module.all, frame)
            ]
    discs = plate_solids(device.plate)[:1] + plate_heads(device.plate) + mast_solids(device.plate)
    clearances += [
        Clearance("plate", collision.between(body, solid)) for body in bodies for solid in discs
    ]
    return min(clearances, key=lambda clearance: clearance.distance)


def _height_above(surface: HeightMap, solid: Drum) -> float:
    """Least height of a cylinder above the trunk's surface [m]; inf: nothing is below."""
    side = np.cross(solid.axis, [0.0, 0.0, 1.0] if abs(solid.axis[2]) < 0.9 else [1.0, 0.0, 0.0])
    side /= np.linalg.norm(side)
    up = np.cross(side, solid.axis)
    angles = np.arange(0.0, 2.0 * np.pi, np.pi / 90.0)
    across = np.outer(np.cos(angles), side) + np.outer(np.sin(angles), up)
    along = np.linspace(-0.5, 0.5, 1 + max(2, round(solid.height / 1e-3)))
    radii = solid.radius * np.linspace(0.0, 1.0, 1 + max(2, round(solid.radius / 2e-3)))
    mantle = solid.radius * across[:, None] + solid.height * along[:, None] * solid.axis
    ends = (
        radii[:, None, None] * across
        + 0.5 * solid.height * np.sign([[[-1.0]], [[1.0]]])[:, None] * solid.axis
    )
    points = solid.center + np.concatenate([mantle.reshape(-1, 3), ends.reshape(-1, 3)])
    return float((points[:, 2] - surface.height(points[:, 0], points[:, 1])).min())


def _clearance(candidates: Iterable[Nearest | None]) -> Clearance | None:
    known = [candidate for candidate in candidates if candidate is not None]
    if not known:
        return None
    # To a nanometre: rounding must not choose between the two sides of a symmetric robot.
    nearest = min(known, key=lambda candidate: round(candidate.distance, 9))
    return Clearance(nearest.part.name, nearest.distance)


def contacts_of(robot: Robot, device: Device) -> tuple[FootContact, ...]:
    """What the feet stand on, and each screw of the plate where there is one.

    Empty for wheels without feet. A foot whose wheel's axis is not horizontal stands on a pedestal,
    and that on the trunk; without a pedestal it has no support.
    """
    if device.wheels_alone:
        return ()
    surface, plate, feet = trunk_surface(robot), device.plate, feet_of(device)
    height, contacts = device.foot.wheel_height, []
    for module, center in zip(device.modules, feet.centers, strict=True):
        name, underside = part_name("foot", module.name), float(module.position[2]) - height
        under = [pedestal for pedestal in device.pedestals if pedestal.module == module.name]
        if under:
            contacts += [under_pedestal(surface, device, module, pedestal) for pedestal in under]
        elif is_tilted(module):
            contacts.append(FootContact(name, "trunk", 0.0, inf, 0.0, held=False, tilted=True))
        elif plate is not None:
            # A plate supports a foot around its screw circle.
            gap = min(abs(underside - plate.top - level) for level in plate.heights)
            share = float(_over_plate(plate, disc_points(center, feet.radius)).mean())
            lands = ring_points(center, *feet.lands)
            held = bool(_over_plate(plate, lands).all()) and gap <= INTERFERENCE_MAX
            contacts.append(FootContact(name, "plate", share, gap, 0.0, held))
        else:
            contacts.append(
                contact_of(name, surface, center, feet.radius, plane=underside, lands=feet.lands)
            )
    if plate is not None:
        contacts += _plate_contacts(robot, plate)
    return tuple(contacts)


def _plate_contacts(robot: Robot, plate: CarrierPlate) -> Iterator[FootContact]:
    """Contact of each of a plate's screws, or of its sleeve, with the trunk.

    For a formed block, the contact of its front.
    """
    (x, y, z), mast = plate.position, plate.mast
    if mast is None:
        surface, plane = trunk_surface(robot), z
        outline = -inf if surface is None else highest_of(surface, plate_points(plate))
    else:
        # Seen from behind.
        surface, plane, half = trunk_back(robot), -x - mast.face - mast.spacer, mast.side / 2.0
        x, outline = z, -inf
        if surface is not None:
            block, upright = (
                surface.farthest(z + low, z + high, half)
                for low, high in (plate.block, (mast.low, mast.high))
            )
            outline = max(block, upright - mast.spacer)
            distance = distance_from_trunk(surface, plate)
            if distance is not None:
                # Distance of the trunk from a formed block at points all over its front.
                known = np.nan_to_num(distance, nan=inf)
                gap = max(0.0, float(known.max()))
                interference = max(0.0, -float(known.min()), upright - mast.spacer - plane)
                share = float((np.abs(known) <= TOUCH).mean())
                held = (
                    gap <= TOUCH
                    and interference <= INTERFERENCE_MAX
                    and steepest(plate) <= TILT_MAX
                )
                yield FootContact("mast's block", "trunk", share, gap, interference, held)
                return
    what = "plate" if mast is None else "mast"
    for number, (hole, sleeve) in enumerate(zip(plate.trunk, plate.sleeves, strict=True), start=1):
        along, across = hole if mast is None else hole[::-1]
        name, middle = f"{what}'s screw {number}", (x + along, y + across)
        radius = plate.sleeve_radius
        contact = contact_of(
            name, surface, middle, radius, plane=plane - sleeve, lands=(0.0, radius)
        )
        interference = max(contact.interference, outline - plane)
        yield replace(
            contact,
            interference=interference,
            held=contact.held and interference <= INTERFERENCE_MAX,
        )


def _over_plate(plate: CarrierPlate, points: FloatArray) -> NDArray[np.bool_]:
    """Whether points of B are over a plate's aluminium, screw holes counted as solid."""
    own, over = points - np.array(plate.position[:2]), np.zeros(len(points), dtype=bool)
    for shape in plate.shapes:
        inside = shape.holds(own)
        for middle in plate.across * directions(plate.arms) + [shape.x, 0.0]:
            inside &= np.hypot(*(own - middle).T) >= plate.window
        over |= inside
    return over
