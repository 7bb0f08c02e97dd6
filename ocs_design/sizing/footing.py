"""What the feet stand on: the trunk's own surface, or a carrier plate across it.

A foot is held where the ring that its screws' lands sweep, whatever the incidence, lies on the
trunk whole: within `FLATNESS` below the plane that it stands on, and nothing above that plane under
its base. A plate is held by four screws, where the trunk is as flat under each head or sleeve.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache
from itertools import product
from math import ceil, copysign, cos, inf, isfinite, isnan, log, nan, pi, sin, sqrt

import numpy as np
from numpy.typing import NDArray

from ocs_design.actuation.fasteners import Screw, screw
from ocs_design.actuation.tilt_inertia import OUT_OF_REACH
from ocs_design.common.arrays import FloatArray, frozen, vector
from ocs_design.device.device import Device, Module
from ocs_design.device.layout import ISOTROPIC, PAIR, Layout
from ocs_design.device.solids import (
    foot_of,
    mast_solids,
    pedestal_of,
    pedestal_solids,
    plate_solids,
)
from ocs_design.parts.carrier_plate import (
    EDGE,
    MAST_YIELD,
    SAFETY,
    SLEEVE_WALL,
    STOCK,
    TUBES,
    YIELD_STRENGTH,
    CarrierPlate,
    DogBone,
    Mast,
    Point,
    directions,
    plate_part,
)
from ocs_design.parts.foot import Foot
from ocs_design.parts.housing import Housing
from ocs_design.parts.joints import pattern_use
from ocs_design.parts.module import part_name
from ocs_design.parts.pedestal import FLANGE, Pedestal
from ocs_design.parts.printed import AROUND_SLOT, SHOCK, TRUNK_SCREW
from ocs_design.requirement.froude import Envelope
from ocs_design.robot.collision import collision_model
from ocs_design.robot.mass import MassProperties, combine
from ocs_design.robot.robot import Robot
from ocs_design.robot.surface import Surface, trunk_back, trunk_surface
from ocs_design.robot.tree import Drum
from ocs_design.sizing.placement import (
    CLEARANCE,
    Place,
    Search,
    Size,
    Sizes,
    around,
    device_size,
    place_at,
    place_free,
    place_on_top,
)

FLATNESS = 1e-3
"""Largest depth of a trunk's surface below what stands on it [m]: a washer's thickness."""

PROUD = 1e-4
"""Largest height of a trunk's surface above what stands on it [m]: rounding of meshes."""

HEAD_ROOM = 0.5e-3
"""Room between a screw's head and a foot's base [m]."""

PLATE_SCREW, POST_SCREW = screw("M3"), screw("M8")
"""Screws that hold a plate on the trunk: through sleeves at the most, and through posts."""

SPREAD = 0.02
"""Least distance of a plate's screws, forward and sideways [m]: four heads of M5 and a key."""

SPREAD_MAX = 0.15
"""Largest distance of a mast's screws, up and down [m]."""

MAST_SCREWS = tuple(map(screw, ("M4", "M5", "M6", "M8")))

SPACERS = (0.0, 0.02, 0.04, 0.06, 0.08)
"""Blocks between a mast and the trunk that are tried, where a limb is in its way [m]."""

SENSES = (1.0, -1.0)

ASIDE = (0.04, 0.08)
"""How much farther to both sides pairs are tried, where a limb lies over the trunk's middle [m]."""

_PATTERNS = 8
"""Patterns of a mast's screws that are tried."""

WIDER = (0.0, 5e-3, 10e-3, 15e-3, 20e-3)
"""Steps by which half a neck's width may grow, to find where the trunk takes its screws or to bear
what the narrowest does not [m]."""

SLEEVE_MAX = 0.03
"""Longest sleeve under a plate [m]: four times as long as wide, for M3."""

POST_WALL, POST_MAX = 4e-3, 0.17
"""Wall of a post, and longest one [m]: with M8 x 200."""

MODULE_SHARE = 0.1
"""Mass of a module over its robot's, for the plate's estimate before one is chosen: Solo12's."""

SPARE = 1e-3
"""Height by which a pedestal may be higher than it must be [m], so that places settle."""

_FEW = 29
"""Of so many points of a screw's land one is looked at first."""

_ENDLESS = 1e3
"""Step of a surface of one place [m]."""

_SAME = 1e-9
"""Distance between places that are the same but for rounding [m]."""

_ALIKE = 1.02
"""Ratio of sizes, or of masses, of modules that are nearly equal."""

_STEP = 4e-3
"""Step between places along the trunk [m], or a sixteenth of a module's reach."""

_PATTERN_STEP = 2e-3
"""Step between patterns of screws [m], or a fortieth of a module's reach."""


@dataclass(frozen=True)
class FootContact:
    """How something stands on what is below it.

    Attributes:
        name: what stands, as in "left foot" or "foot 1".
        on: what it stands on, as in "trunk".
        area: of contact [m^2]; None: not known.
        share: of its underside that is in contact; None likewise.
        gap: largest under its screws' lands [m]; inf: nothing is there; None: not known.
        proud: height of what is below over its underside [m]; 0: nothing is in its way.
        held: whether all its screws' lands are in contact and nothing is in its way; None: not
            known.
        leans: whether the module leans, and stands on nothing.
    """

    name: str
    on: str
    area: float | None
    share: float | None
    gap: float | None
    proud: float
    held: bool | None
    leans: bool = False


@dataclass(frozen=True)
class Feet:
    """Feet of a device.

    Attributes:
        x: forward coordinate of what `bases` count from, in B [m].
        bases: middles of the feet's bases over (x, 0) [m]; a pair's are left and right.
        slopes: 1 where a base's screws are before it on its left, -1 on its right; empty where any
            foot leans.
        radius: of the bases [m].
        slot_radius: of the circle that their screws are on [m].
        reach: radius around each that its module stays within [m].
        height: of the wheels' middles above their undersides [m].
        mass: of one module [kg].
    """

    x: float
    bases: tuple[Point, ...]
    slopes: tuple[float, ...]
    radius: float
    slot_radius: float
    reach: float
    height: float
    mass: float

    @property
    def middles(self) -> list[Point]:
        """Middles of the bases in B [m]."""
        return [(self.x + along, across) for along, across in self.bases]

    @property
    def y(self) -> float:
        """How far left the first base stands [m]."""
        return self.bases[0][1]

    @cached_property
    def rows(self) -> tuple[float, ...]:
        """How far before x the middle of each plate is [m]; none where no plate carries them.

        A pair has one plate, and a ring of more.
        """
        if self.arms > 2:
            return (0.0,)
        pairs = list(zip(self.bases[::2], self.bases[1::2], strict=False))
        mirrored = all(np.allclose(right, (x, -y), atol=_SAME) for (x, y), right in pairs)
        in_pairs = 2 * len(pairs) == len(self.bases) == len(self.slopes) and mirrored
        return tuple(x for (x, _), _ in pairs) if in_pairs else ()

    @cached_property
    def arms(self) -> int:
        """How many feet stand on each plate: all where they are evenly around, else pairs."""
        count = len(self.bases)
        upright = count > 2 and len(self.slopes) == count
        ring = upright and np.allclose(self.y * directions(count), self.bases, atol=_SAME)
        return count if ring else len(SENSES)

    @property
    def screws(self) -> tuple[Point, ...]:
        """Places of their screws over (x, 0) [m]: at 45 degrees to the lateral direction."""
        off = self.slot_radius / sqrt(2.0)
        return tuple(
            (x + sense * off, y + sense * slope * off)
            for (x, y), slope in zip(self.bases, self.slopes, strict=True)
            for sense in SENSES
        )


@dataclass(frozen=True, eq=False)
class Footing:
    """Place and plate of modules before they are chosen.

    Attributes:
        place: of the modules by their size.
        plate: what they would stand on, were they as large as they may be; None: the trunk.
        pedestals: under those that lean.
    """

    place: Place
    plate: CarrierPlate | None
    pedestals: tuple[Pedestal, ...] = ()

    def carried(self, robot: MassProperties) -> MassProperties:
        """The robot with plate and pedestals, which the chosen device's own replace."""
        under = [*(() if self.plate is None else (self.plate,)), *self.pedestals]
        return combine([robot, *(each.mass_properties() for each in under)]) if under else robot


def footing_of(
    robot: Robot,
    envelope: Envelope,
    position: tuple[float, ...] | None = None,
    layout: Layout = PAIR,
) -> Footing:
    """Place of modules with feet, and the plate under them where the trunk does not hold them.

    The nearest place on top of the trunk over the centre of mass where the largest module's feet
    are held, by the trunk or by a plate, and where no leg comes near. Where there is none, or the
    trunk's shapes are not known, it is that of `place_free`: a mast, whose place and mass go with
    the modules', is looked for under a chosen device (`footing_under`). Plates are those
    of pairs, and of rings of three and more.

    Args:
        robot: that carries them. envelope: room for a rim.
        position: as stated in B [m] (`place_at`); None: free.
        layout: of the modules.
    """
    sizes, surface = Sizes.of(envelope), trunk_surface(robot)
    largest, mass = sizes.largest, MODULE_SHARE * robot.mass
    foot = Foot(Housing(envelope.outer_radius_max, envelope.height_max))
    base = foot.base_radius, foot.slot_radius, largest.reach, largest.standing
    if position is not None:
        place = place_at(position, layout)
        if surface is None or layout != PAIR:
            return Footing(place, None)
        x, y, z = position
        feet = Feet(x, ((0.0, y), (0.0, -y)), SENSES, *base, mass)
        return Footing(place, _plate_of(_held_at(surface, feet, z - largest.standing)))
    if surface is not None:
        start = round(float(robot.com[0]), 6) + 0.0
        slopes = _slopes(layout.axes(ISOTROPIC if layout.angle is None else layout.angle))
        feet = Feet(start, _ring_of(layout, largest.reach), slopes, *base, mass)
        found = _on_trunk(surface, feet, Search(collision_model(robot), sizes, layout))
        if found is not None:
            return found
    return Footing(place_free(robot, envelope, layout).place, None)


def _ring_of(layout: Layout, reach: float) -> tuple[Point, ...]:
    """Middles of the feet's bases of modules of this radius around theirs [m]."""
    return tuple((CLEARANCE * reach * x, CLEARANCE * reach * y) for x, y, _ in layout.ring)


def _slopes(axes: FloatArray) -> tuple[float, ...]:
    """Sides on which the screws of each foot are (`Feet`); axes in B, shape (3, n)."""
    if np.abs(axes[2]).max() > OUT_OF_REACH:
        return ()
    return tuple(copysign(1.0, x * y) for x, y in axes[:2].T.tolist())


def stand_on_trunk(device: Device, robot: Robot, *, stated: bool) -> Device:
    """The device with its feet on the trunk, and a plate under them where they are not held.

    Modules whose place is not stated go to the height of what they stand on, and forward or back
    to the nearest place where they are held. Where there is none the device stays as it is: see
    `contacts_of`.

    Args:
        device: as selected. robot: that carries it.
        stated: whether the modules' places are.
    """
    found = footing_under(device, robot, stated=stated)
    if found is None:
        return device
    centers = found.place.centers(device_size(device))
    modules = (
        replace(module, position=frozen(center))
        for module, center in zip(device.modules, centers, strict=True)
    )
    return replace(device, modules=tuple(modules), plate=found.plate, pedestals=found.pedestals)


def footing_under(device: Device, robot: Robot, *, stated: bool) -> Footing | None:
    """Footing of a chosen device; see `stand_on_trunk`. None: where it is, on nothing known."""
    surface = trunk_surface(robot)
    if device.carrier.mass == 0.0:
        return None
    feet, layout = feet_of(device), device.layout
    if not feet.slopes:
        return _pedestalled(robot, surface, device, stated=stated)
    if surface is None:
        return None
    if stated:
        places = [module.position for module in device.modules]
        if layout != PAIR:
            return Footing(place_at(tuple(np.concatenate(places).tolist()), layout), None)
        held = _held_at(surface, feet, float(places[0][2]) - foot_of(device).wheel_height)
        return Footing(place_at(tuple(places[0].tolist())), _plate_of(held))
    size = device_size(device)
    feet = replace(feet, bases=_ring_of(layout, size.reach))
    search = Search(collision_model(robot), Sizes(size, size), layout)
    found = _on_trunk(surface, feet, search)
    return found or _behind(robot, feet, size, layout)


def feet_of(device: Device) -> Feet:
    """Feet of a device that has them."""
    foot = foot_of(device)
    places = np.array([module.position[:2] for module in device.modules])
    x = float(places[:, 0].mean())
    bases = tuple((float(along) - x, float(across)) for along, across in places)
    mass = device.flywheel.mass + device.carrier.mass
    size = device_size(device)
    slopes = _slopes(np.stack([module.axis for module in device.modules], axis=1))
    base = foot.base_radius, foot.slot_radius, size.reach, size.standing
    return Feet(x, bases, slopes, *base, mass)


def contacts_of(robot: Robot, device: Device) -> tuple[FootContact, ...]:
    """What the feet stand on, and each screw of the plate where there is one.

    Empty for wheels without feet. A foot whose wheel's axis is not horizontal stands on its
    pedestal, and that on the trunk; without one it stands on nothing.
    """
    if device.carrier.mass == 0.0:
        return ()
    surface, plate, feet = trunk_surface(robot), device.plate, feet_of(device)
    height, found = foot_of(device).wheel_height, []
    for module, middle in zip(device.modules, feet.middles, strict=True):
        name, underside = part_name("foot", module.name), float(module.position[2]) - height
        under = [each for each in device.pedestals if each.module == module.name]
        if under and surface is None:
            found.append(
                FootContact(
                    part_name("pedestal", module.name), "trunk", None, None, None, 0.0, held=None
                )
            )
        elif under and surface is not None:
            found += [_under_pedestal(surface, device, module, each) for each in under]
        elif _leans(module):
            found.append(FootContact(name, "trunk", 0.0, 0.0, inf, 0.0, held=False, leans=True))
        elif plate is not None:
            found.append(_on_plate(name, plate, feet, middle, underside))
        elif surface is None:
            found.append(FootContact(name, "trunk", None, None, None, 0.0, held=None))
        else:
            lands = feet.slot_radius - AROUND_SLOT, feet.slot_radius + AROUND_SLOT
            found.append(_contact(name, surface, middle, feet.radius, plane=underside, lands=lands))
    if plate is not None:
        found += _plate_contacts(robot, plate)
    return tuple(found)


def _leans(module: Module) -> bool:
    return float(module.frame[2, 2]) < 1.0 - OUT_OF_REACH


def _under_pedestal(
    surface: Surface, device: Device, module: Module, pedestal: Pedestal
) -> FootContact:
    """Contact of a pedestal with the trunk, which also has to bear the foot where it is."""
    plane, base, place = pedestal.position[2], _base(pedestal), pedestal.placement
    depth = plane - _heights(surface, base)
    share = float(((depth <= FLATNESS) & (depth >= -PROUD)).mean())
    lands = [
        _disc(vector(place.rotation @ [*hole, 0.0] + place.position)[:2], AROUND_SLOT)
        for hole in pedestal.holes
    ]
    gap = max(0.0, float((plane - _heights(surface, np.concatenate(lands))).max()))
    proud = max(0.0, -float(depth.min()))
    wheel = place.rotation @ pedestal.wheel + place.position
    seated = (
        bool(np.allclose(wheel, module.position, rtol=0.0, atol=1e-6))
        and pedestal.middle >= pedestal_of(device, module).middle - 1e-6
    )
    held = gap <= FLATNESS and proud <= PROUD and seated
    area = share * pedestal.width * (pedestal.length + 2.0 * FLANGE)
    return FootContact(part_name("pedestal", module.name), "trunk", area, share, gap, proud, held)


def _base(pedestal: Pedestal) -> FloatArray:
    """Points all over a pedestal's underside in B [m], shape (n, 2)."""
    half, place = pedestal.width / 2.0, pedestal.placement
    ends = (-half, half), (-FLANGE, pedestal.length + FLANGE)
    grid = [np.linspace(low, high, 2 + int((high - low) / 1e-3)) for low, high in ends]
    points = np.stack(np.meshgrid(*grid), axis=-1).reshape(-1, 2)
    return points @ place.rotation[:2, :2].T + place.position[:2]


def _pedestalled(
    robot: Robot, surface: Surface | None, device: Device, *, stated: bool
) -> Footing | None:
    """The nearest place where the trunk holds the pedestals of those that lean, and other feet.

    Each stands on what the trunk has beneath it, and no limb comes near. Stated places stay, and a
    pedestal is as high as there is room under its foot. A trunk whose shapes are not known counts
    as flat.
    """
    layout, size = device.layout, device_size(device)
    if surface is None:
        _, _, top = place_on_top(robot, layout).origins[0]
        surface = Surface(0.0, 0.0, _ENDLESS, np.array([[top]]))
    if any(_leans(module) and module.frame[2, 1] < -OUT_OF_REACH for module in device.modules):
        return None
    if stated:
        held = _all_held(surface, device, fixed=True)
        place = place_at(tuple(np.ravel([each.position for each in device.modules])), layout)
        return None if held is None else Footing(place, None, held[1])
    search = Search(collision_model(robot), Sizes(size, size), layout)
    ring, start = np.array(_ring_of(layout, size.reach)), round(float(robot.com[0]), 6) + 0.0
    low, high = surface.x_range
    steps = np.arange(np.ceil((low - start) / _STEP), (high - start) / _STEP) * _STEP
    for shift in (0.0, *sorted(steps[steps != 0.0].tolist(), key=abs)):
        x = round(start + shift, 6)
        modules = tuple(
            replace(module, position=frozen([x + along, across, float(module.position[2])]))
            for module, (along, across) in zip(device.modules, ring.tolist(), strict=True)
        )
        held = _all_held(surface, replace(device, modules=modules), fixed=False)
        if held is None:
            continue
        heights, pedestals = held
        around_it = around((x, 0.0, 0.0), layout)
        # Not rounded: a pedestal's seat is where its foot is.
        origins = tuple((x, 0.0, height - size.standing) for height in heights)
        place = replace(around_it, origins=origins)
        solids = [solid for each in pedestals for solid in pedestal_solids(each)]
        if search.is_off(solids) and search.is_free(place) and not any(map(search.touches, solids)):
            return Footing(place, None, pedestals)
    return None


def _all_held(
    surface: Surface, device: Device, *, fixed: bool
) -> tuple[list[float], tuple[Pedestal, ...]] | None:
    """Heights of the modules in B and the pedestals under them; None: the trunk holds not all.

    Args:
        surface: of the trunk. device: with its modules over the places that they shall have.
        fixed: whether their heights are theirs as well.
    """
    heights, found, foot = [], [], foot_of(device)
    for module in device.modules:
        own = float(module.position[2])
        low = pedestal_of(device, module) if _leans(module) else None
        middle = vector(module.position)[:2]
        beneath = _disc(middle, foot.base_radius) if low is None else _base(low)
        plane = round(_highest(surface, beneath), 6)
        if not isfinite(plane):
            return None
        least = plane + (foot.wheel_height if low is None else float(low.wheel[2]))
        if low is None:
            lands = foot.slot_radius - AROUND_SLOT, foot.slot_radius + AROUND_SLOT
            height = own if fixed else least
            under = height - foot.wheel_height
            on = _contact("", surface, middle, foot.base_radius, plane=under, lands=lands)
        else:
            # As high as it is, where that does, so that places settle.
            within = least <= own <= least + SPARE
            height = own if fixed or within else round(least + SPARE / 2.0, 5)
            placed = replace(module, position=frozen([*module.position[:2], height]))
            found.append(pedestal_of(device, placed, plane))
            on = _under_pedestal(surface, device, placed, found[-1])
        if not on.held:
            return None
        heights.append(height)
    return heights, tuple(found)


def _on_plate(
    name: str, plate: CarrierPlate, feet: Feet, middle: Point, underside: float
) -> FootContact:
    """Contact of a foot with a plate, which carries it around its screws' circle."""
    base = _disc(middle, feet.radius)
    gap = min(abs(underside - plate.top - level) for level in plate.heights)
    share = float(_over_plate(plate, base).mean())
    lands = _ring(middle, feet.slot_radius - AROUND_SLOT, feet.slot_radius + AROUND_SLOT)
    held = bool(_over_plate(plate, lands).all()) and gap <= PROUD
    return FootContact(name, "plate", share * pi * feet.radius**2, share, gap, 0.0, held)


def _over_plate(plate: CarrierPlate, points: FloatArray) -> NDArray[np.bool_]:
    """Whether points of B are over a plate's aluminium, its holes for screws counted as full."""
    own, over = points - np.array(plate.position[:2]), np.zeros(len(points), dtype=bool)
    for shape in plate.shapes:
        inside = shape.holds(own)
        for middle in plate.across * directions(plate.arms) + [shape.x, 0.0]:
            inside &= np.hypot(*(own - middle).T) >= plate.window
        over |= inside
    return over


def _plate_contacts(robot: Robot, plate: CarrierPlate) -> Iterator[FootContact]:
    """Contact of each of a plate's screws, or of its sleeve, with the trunk."""
    (x, y, z), mast = plate.position, plate.mast
    if mast is None:
        surface, plane = trunk_surface(robot), z
        outline = -inf if surface is None else _highest(surface, _all_over(plate))
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
    what = "plate" if mast is None else "mast"
    for number, (hole, sleeve) in enumerate(zip(plate.trunk, plate.sleeves, strict=True), start=1):
        along, across = hole if mast is None else hole[::-1]
        name, middle = f"{what}'s screw {number}", (x + along, y + across)
        if surface is None:
            yield FootContact(name, "trunk", None, None, None, 0.0, held=None)
            continue
        radius = plate.sleeve_radius
        found = _contact(name, surface, middle, radius, plane=plane - sleeve, lands=(0.0, radius))
        proud = max(found.proud, outline - plane)
        yield replace(found, proud=proud, held=bool(found.held) and proud <= PROUD)


def _contact(
    name: str,
    surface: Surface,
    middle: Point,
    radius: float,
    *,
    plane: float,
    lands: tuple[float, float],
) -> FootContact:
    """Contact of a disc with the trunk, whose screws' lands are between two radii [m]."""
    depth = plane - _heights(surface, _disc(middle, radius))
    share = float(((depth <= FLATNESS) & (depth >= -PROUD)).mean())
    gap = max(0.0, float((plane - _heights(surface, _ring(middle, *lands))).max()))
    proud = max(0.0, -float(depth.min()))
    held = gap <= FLATNESS and proud <= PROUD
    return FootContact(name, "trunk", share * pi * radius**2, share, gap, proud, held)


def _on_trunk(surface: Surface, feet: Feet, search: Search) -> Footing | None:
    """The nearest place of the feet, as near to each other as may be, or of pairs another way."""
    found = _nearest_footing(surface, feet, search, 0.0, PLATE_SCREW)
    if found is None and search.layout.pairs:
        way = _way(search.collision.robot, *_rough(feet, search.sizes.largest), search.layout)
        return None if way is None else _nearest_footing(surface, feet, search, *way)
    return found


@lru_cache(maxsize=64)
def _way(robot: Robot, feet: Feet, size: Size[float], layout: Layout) -> tuple[float, Screw] | None:
    """How much farther apart pairs stand than they must, and what screws hold their plate.

    Farther apart first, then on posts, over what stands up from the trunk; None: neither does.
    """
    surface, x = trunk_surface(robot), round(float(robot.com[0]), 6) + 0.0
    search = Search(collision_model(robot), Sizes(size, size), layout)
    feet = replace(feet, x=x, bases=_ring_of(layout, size.reach))
    ways = [*((aside, PLATE_SCREW) for aside in ASIDE), (0.0, POST_SCREW)]
    found = (way for way in ways if surface and _nearest_footing(surface, feet, search, *way))
    return next(found, None)


def _nearest_footing(
    surface: Surface, feet: Feet, search: Search, aside: float, held_by: Screw
) -> Footing | None:
    """The nearest place to that of the feet where they are held and no leg comes near.

    A longer sleeve is as bad as as far a way forward, and so is a plate as its thickness.

    Args:
        surface: of the trunk. feet: on it, as near to each other as may be. search: of places.
        aside: how much farther to its side each stands [m]. held_by: screws of a plate.
    """
    bases = tuple((x, y + copysign(aside, y)) for x, y in feet.bases)
    feet = replace(feet, bases=bases)
    low, high = surface.x_range
    step = max(_STEP, feet.reach / 16.0)
    steps = np.arange(np.ceil((low - feet.x) / step), (high - feet.x) / step)
    waiting: list[tuple[float, Footing]] = []
    for shift in (*sorted((steps * step).tolist(), key=abs), np.inf):
        # Nothing farther away can be better than what is nearer than that.
        while waiting and waiting[0][0] <= abs(shift):
            _, footing = waiting.pop(0)
            # Farther apart, modules leave room for a limb between them, but not a plate.
            posts = held_by is POST_SCREW
            between = plate_solids(footing.plate) if aside or posts else ()
            if search.is_free(footing.place) and not any(map(search.touches, between)):
                return footing
        if shift == np.inf:
            break
        moved = replace(feet, x=feet.x + shift)
        held = None
        if not _in_the_way(surface, moved, search, aside):
            held = _held_at(surface, moved, held_by=held_by)
        if held is not None:
            plate = _plate_of(held)
            height = held.top if isinstance(held, CarrierPlate) else held
            origin = round(feet.x + shift, 6) + 0.0, 0.0, height
            lift = 0.0 if plate is None else plate.thickness + max(plate.sleeves)
            place = around(origin, search.layout, aside)
            waiting.append((abs(shift) + lift, Footing(place, plate)))
            waiting.sort(key=lambda each: each[0])
    return None


def _behind(robot: Robot, feet: Feet, size: Size[float], layout: Layout) -> Footing | None:
    """The place behind the trunk nearest to the robot's middle where a mast carries pairs.

    They stand one above the other, on plates of one kind, by the lightest tube that bears them.
    """
    back, at = trunk_back(robot), _mast_spot(robot, *_rough(feet, size), layout)
    if back is None or at is None:
        return None
    feet, search = (
        _stacked(feet, size, layout),
        Search(collision_model(robot), Sizes(size, size), layout),
    )
    far, height, spacer = at
    arms = _all_arms(feet, size, far=far)
    masted = (_masted(back, feet, plate, search, (height, spacer)) for plate in arms)
    return next((footing for footing in masted if footing is not None), None)


def _rough(feet: Feet, size: Size[float]) -> tuple[Feet, Size[float]]:
    """Feet of modules that are nearly equal, wherever they stood, and their size."""
    rough = replace(
        feet,
        x=0.0,
        bases=(),
        radius=_rounded_up(feet.radius),
        slot_radius=_rounded_up(feet.slot_radius),
        reach=_rounded_up(feet.reach),
        height=_rounded_up(feet.height),
        mass=_rounded_up(feet.mass),
    )
    return rough, Size(_rounded_up(size.reach), _rounded_up(size.standing))


def _rounded_up(value: float) -> float:
    """By up to a fiftieth, so that what is nearly equal is looked for once."""
    return _ALIKE ** ceil(log(value, _ALIKE))


def _stacked(feet: Feet, size: Size[float], layout: Layout) -> Feet:
    """Feet of pairs one above the other."""
    out = CLEARANCE * size.reach
    return replace(feet, bases=((0.0, out), (0.0, -out)) * layout.pairs)


def _all_arms(feet: Feet, size: Size[float], *, far: bool) -> Iterator[CarrierPlate]:
    """Plates on the arms of each tube in stock that bears them, as short as may be or longer.

    On the shortest, pairs stand to both sides of the upright; on the longer ones behind it.
    """
    masts = (
        Mast(side, wall, side + max(_between(side, size), side, feet.y * far), 0.0, 0.0, 0.0)
        for side, wall in TUBES
    )
    return (plate for mast in masts if (plate := _on_arms(feet, mast)) is not None)


@lru_cache(maxsize=64)
def _mast_spot(
    robot: Robot, feet: Feet, size: Size[float], layout: Layout
) -> tuple[bool, float, float] | None:
    """Whether a mast's arms are long, height of its lowest plate and thickness of its block [m].

    None: no mast holds them.
    """
    back = trunk_back(robot)
    if back is None or not layout.pairs:
        return None
    search = Search(collision_model(robot), Sizes(size, size), layout)
    feet = _stacked(feet, size, layout)
    down, up = back.x_range
    step = size.reach / 4.0
    heights = np.arange(down - 2.0 * size.standing, up + size.standing, step).tolist()
    arms = {far: list(_all_arms(feet, size, far=far)) for far in (False, True)}
    if not all(arms.values()):
        return None
    face = back.farthest(down, up, arms[False][0].support)
    spots = [
        (_placed(back, plates[0], size, height, face + spacer), far, height, spacer)
        for (far, plates), height, spacer in product(arms.items(), heights, SPACERS)
    ]
    # A block is heavier than a longer way up.
    spots.sort(key=lambda each: (each[3], search.cost(each[0])))
    for place, far, height, spacer in spots:
        tubes = _tubes(arms[far][0], place.centers(size), height, face + spacer)
        if not (search.is_off(tubes) and search.is_free(place)) or any(map(search.touches, tubes)):
            continue
        masted = (_masted(back, feet, plate, search, (height, spacer)) for plate in arms[far])
        for footing in (each for each in masted if each is not None):
            # A wider tube moves modules by less than what is kept free around them.
            if not search.is_free(footing.place):
                break
            if not any(map(search.touches, plate_solids(footing.plate))):
                return far, height, spacer
    return None


def _on_arms(feet: Feet, mast: Mast) -> CarrierPlate | None:
    """The lightest plate across the arms of a mast that bears a pair; None: there is none."""
    edge = max(AROUND_SLOT, EDGE * TRUNK_SCREW.diameter)
    ring = feet.slot_radius + edge
    blanks = (
        CarrierPlate(
            position=(0.0, 0.0, 0.0),
            radius=ring,
            half_length=feet.y + ring,
            # A rounding that flat is none.
            neck=neck if neck < ring - _PATTERN_STEP else ring,
            thickness=STOCK[0],
            across=feet.y,
            window=max(0.0, feet.slot_radius - edge),
            feet=feet.screws,
            trunk=(),
            sleeves=(),
            rows=feet.rows,
            mast=mast,
        )
        for neck in (mast.side / 2.0 + wider for wider in WIDER)
    )
    # Thicker plates stand higher, which bends the arms more.
    bearing = (
        plate
        for blank in blanks
        if blank.shape.half_width(np.asarray(mast.side / 2.0)) <= mast.back
        and (plate := next(_thick_enough(blank, feet, MAST_YIELD), None)) is not None
        and plate.arm_stress(feet.mass, feet.height) <= MAST_YIELD
    )
    return min(bearing, key=lambda plate: plate_part(plate).mass(), default=None)


def _thick_enough(blank: CarrierPlate, feet: Feet, stress: float) -> Iterator[CarrierPlate]:
    """The plate in all thicknesses in stock that keep it below a stress [Pa], the thinnest first.

    Args:
        blank: of any thickness. feet: on it.
    """
    stresses = blank.stresses(np.array(STOCK), feet.mass, feet.height)
    for thickness, own in zip(STOCK, stresses.tolist(), strict=True):
        if own <= stress:
            yield replace(blank, thickness=thickness)


def _tubes(
    plate: CarrierPlate, centers: FloatArray, height: float, face: float
) -> tuple[Drum, ...]:
    """Upright and arms of the plates of modules whose centers these are, see `_placed`."""
    mast, x = plate.mast, float(centers[0, 0])
    assert mast is not None, "a plate on arms"
    levels = tuple((centers[:: len(SENSES), 2] - centers[0, 2]).tolist())
    upright = replace(mast, face=-face - x, below=mast.side, high=levels[-1])
    return mast_solids(replace(plate, position=(x, 0.0, height), levels=levels, mast=upright))


def _placed(
    back: Surface, plate: CarrierPlate, size: Size[float], height: float, face: float
) -> Place:
    """Place of pairs behind the trunk, clear of it and of a mast's upright.

    Args:
        back: of the trunk. plate: on arms. size: of a module.
        height: of the lowest plate in B [m]. face: how far back the upright's front is [m].
    """
    mast, out = plate.mast, CLEARANCE * size.reach
    assert mast is not None, "a plate on arms"
    # Arms reach down between the modules below, and these to both sides of the upright.
    room = max(0.0, sqrt(2.0) * mast.side - out + _between(mast.side, size)) + plate.thickness
    apart = size.standing / size.reach + CLEARANCE
    rows = range(len(plate.rows))
    top = height + rows[-1] * (room + apart * size.reach) + plate.thickness + size.standing + out
    behind = max(back.farthest(height, top, 2.0 * out), face + mast.face - out)
    x = -round(behind, 6)
    origins = [(x, 0.0, height + plate.thickness + row * room) for row in rows]
    sides = [(-CLEARANCE, sense * CLEARANCE) for sense in SENSES]
    return Place(
        tuple(origin for origin in origins for _ in SENSES),
        tuple((*side, row * apart) for row in rows for side in sides),
        upright=True,
    )


def _between(side: float, size: Size[float]) -> float:
    """How far off a tube modules to both its sides must be to be clear of it [m].

    It is as wide as across its corners.
    """
    aside = CLEARANCE * size.reach - side / sqrt(2.0)
    return sqrt(max(0.0, size.reach**2 - aside**2))


def _masted(
    back: Surface,
    feet: Feet,
    plate: CarrierPlate,
    search: Search,
    at: tuple[float, float],
) -> Footing | None:
    """Pairs on a mast behind the trunk; None: it does not hold them there.

    Args:
        back, plate: see `_placed`. feet: of all modules. search: of the largest, and of limbs.
        at: height of the lowest plate in B, and thickness of the block before the upright [m].
    """
    mast, (height, spacer) = plate.mast, at
    assert mast is not None, "a plate on arms"
    half, best, size = mast.side / 2.0, None, search.sizes.largest
    centers = _placed(back, plate, size, height, 0.0).centers(size)[:: len(SENSES)]
    levels = tuple((centers[:, 2] - centers[0, 2]).tolist())
    # Where the strongest screws do not hold no others do, but they need the widest tube.
    for held in reversed(MAST_SCREWS):
        edge, blank, before = EDGE * held.clearance_hole, replace(plate, thread=held.name), best
        for low, high, aside, pads in _patterns(back, feet, blank, (height, spacer, centers)):
            bottom, top = min(low - edge, height - mast.side), max(high + edge, height + levels[-1])
            # The block lies on what is farthest back beneath it.
            plane = round(back.farthest(low - edge, high + edge, half), 6)
            face = plane + spacer
            if face < back.farthest(bottom, top, half) - PROUD:
                continue
            place = _placed(back, blank, size, height, face)
            x = float(place.centers(size)[0, 0])
            holes = [(y, z - height) for z in (low, high) for y in (aside, -aside)]
            gaps = [
                0.0 if plane - deep <= FLATNESS else round(plane - top, 5) for deep, top in pads
            ]
            arms = [height + level - half for level in levels]
            own = replace(
                mast,
                face=-face - x,
                below=height - bottom,
                high=top - height,
                overhang=max(0.0, *(max(arm - high, low - arm) for arm in arms)),
                spacer=spacer,
            )
            masted = replace(
                blank,
                position=(x, 0.0, height),
                levels=levels,
                trunk=tuple(holes),
                sleeves=tuple(gap for gap in gaps for _ in SENSES),
                mast=own,
            )
            if (
                masted.mast_stress(feet.mass, feet.height) <= MAST_YIELD
                and masted.screws_use(feet.mass, feet.height) <= 1.0
                and search.is_off(plate_solids(masted))
            ):
                best = Footing(place, masted)
                break
        if best is before and best is not None:
            break
    return best


def _patterns(
    back: Surface, feet: Feet, plate: CarrierPlate, at: tuple[float, float, FloatArray]
) -> list[tuple[float, float, float, tuple[Point, Point]]]:
    """Patterns of four screws that a trunk's back takes and that bear, of the shortest mast first.

    Lower and upper height, how far to both sides, and how far back the trunk is at both heights, at
    the least and at the most.

    Args:
        back: of the trunk. feet: of all modules. plate: on arms.
        at: height of the lowest plate, thickness of the block, centers of the wheels, a row each.
    """
    mast, held, (height, spacer, centers) = plate.mast, plate.screw, at
    assert mast is not None, "a plate on arms"
    least = held.head_diameter / 2.0 + HEAD_ROOM
    most = mast.bore / 2.0 - plate.sleeve_radius
    force = 2.0 * feet.mass * SHOCK * len(centers)
    wheels, off, found = float(centers[:, 2].mean()), mast.face + spacer, []
    for aside in np.arange(least, most, _PATTERN_STEP).tolist():
        z, pads, (low, high) = _pads(back, plate.sleeve_radius, aside)
        half = (z[high] - z[low]) / 2.0
        up = np.abs(wheels - (z[low] + z[high]) / 2.0)
        used = pattern_use(held, force, (off, up), (half, np.asarray(aside)))
        if not (used <= 1.0).any():
            continue
        longer = np.maximum(0.0, height - z[low]) + np.maximum(0.0, z[high] - centers[-1, 2])
        longer = np.where(used <= 1.0, longer + 1e-3 * used, np.inf)
        for index in np.argsort(longer, kind="stable")[:_PATTERNS].tolist():
            one, two = low[index], high[index]
            lower, upper = ((float(deep), float(far)) for deep, far in pads[[one, two]])
            pattern = float(z[one]), float(z[two]), aside, (lower, upper)
            if np.isfinite(longer[index]):
                found.append((float(longer[index]), pattern))
    return [pattern for _, pattern in sorted(found, key=lambda each: each[0])[:_PATTERNS]]


@lru_cache(maxsize=256)
def _pads(
    back: Surface, radius: float, aside: float
) -> tuple[FloatArray, FloatArray, tuple[NDArray[np.int64], NDArray[np.int64]]]:
    """Heights at which a trunk's back is flat under a sleeve on either side, and how far back [m].

    That is a row of two: at the least and at the most. Last come the numbers of lower and upper
    heights that are as far apart as screws may be.

    Args:
        back: of the trunk. radius: of the sleeves [m]. aside: of their middles to both sides [m].
    """
    down, up = back.x_range
    z = np.arange(down, up, _PATTERN_STEP)
    lands = np.concatenate([_disc((0.0, side * aside), radius) for side in SENSES])
    behind = back.height(z[:, None] + lands[:, 0], lands[None, :, 1] + 0.0 * z[:, None])
    top, low = behind.max(axis=1), behind.min(axis=1)
    with np.errstate(invalid="ignore"):
        flat = top - low <= FLATNESS
    z, low, top = z[flat], low[flat], top[flat]
    lower, upper = np.triu_indices(len(z), 1)
    half = (z[upper] - z[lower]) / 2.0
    near = (half >= SPREAD / 2.0) & (half <= SPREAD_MAX / 2.0)
    near &= np.abs(top[upper] - top[lower]) <= SLEEVE_MAX
    return frozen(z), frozen(np.stack([low, top], axis=1)), (lower[near], upper[near])


def _in_the_way(surface: Surface, feet: Feet, search: Search, aside: float) -> bool:
    """Whether a limb is where modules of several pairs would stand on the trunk itself.

    A plate would lift them by its thickness only, and is long looked for.
    """
    bases = np.concatenate([_disc(middle, feet.radius) for middle in feet.middles])
    top = _highest(surface, bases) if len(feet.rows) > 1 else np.nan
    standing = around((feet.x, 0.0, top), search.layout, aside)
    return bool(np.isfinite(top)) and not search.is_clear(standing)


def _plate_of(held: CarrierPlate | float | None) -> CarrierPlate | None:
    """The plate, where it is one that holds the feet."""
    return held if isinstance(held, CarrierPlate) else None


def _held_at(
    surface: Surface,
    feet: Feet,
    underside: float | None = None,
    held_by: Screw = PLATE_SCREW,
) -> CarrierPlate | float | None:
    """What holds the feet at their place: the trunk at a height [m], a plate, or nothing.

    Args:
        surface: of the trunk. feet: on it.
        underside: height of the feet in B, where it is stated [m]; None: what the trunk has.
        held_by: screws of a plate.
    """
    plane = _level(surface, feet) if underside is None else underside
    lands = feet.slot_radius - AROUND_SLOT, feet.slot_radius + AROUND_SLOT
    if np.isfinite(plane) and all(
        _contact("", surface, side, feet.radius, plane=plane, lands=lands).held
        for side in feet.middles
    ):
        return float(round(plane, 6))
    return _plate(surface, feet, underside, held_by) if feet.rows else None


def _level(surface: Surface, feet: Feet) -> float:
    """Height of the trunk under feet that it may hold at one height [m]; nan: it holds not all."""
    lands = feet.slot_radius - AROUND_SLOT, feet.slot_radius + AROUND_SLOT
    # A few points of the screws' lands tell of most places that they are not.
    few = np.concatenate([_ring(side, *lands)[::_FEW] for side in feet.middles])
    heights = _heights(surface, few)
    with np.errstate(invalid="ignore"):
        if not heights.max() - heights.min() <= FLATNESS:
            return nan
    return _highest(surface, np.concatenate([_disc(side, feet.radius) for side in feet.middles]))


def _plate(
    surface: Surface, feet: Feet, underside: float | None, held_by: Screw
) -> CarrierPlate | None:
    """The lightest plate of its necks in stock that carries all modules; None: there is none.

    Each pair of them has a plate of its own, all alike and at one height. A ring has one.
    """
    edge = max(AROUND_SLOT, EDGE * TRUNK_SCREW.diameter)
    ring = feet.slot_radius + edge
    # Heads stand clear of the feet, before and behind where these are nearest to each other.
    inside = max(0.0, feet.y - SPREAD / 2.0)
    beside = (
        sqrt(max(0.0, _apart(feet, held_by) ** 2 - inside**2)) if feet.arms == len(SENSES) else 0.0
    )
    least = max(SPREAD / 2.0, beside + _PATTERN_STEP) + EDGE * held_by.clearance_hole
    blank = CarrierPlate(
        position=(feet.x, 0.0, 0.0),
        radius=ring,
        half_length=feet.y + ring,
        neck=least,
        thickness=STOCK[0],
        across=feet.y,
        window=max(0.0, feet.slot_radius - edge),
        feet=feet.screws,
        trunk=(),
        sleeves=(),
        thread=held_by.name,
        rows=feet.rows,
        arms=feet.arms,
        sleeve_wall=SLEEVE_WALL if held_by is PLATE_SCREW else POST_WALL,
    )
    shapes = []
    for neck in (least + wider for wider in WIDER):
        radius = max(ring, neck)
        # A rounding this flat is none.
        wide = neck if neck < radius - _PATTERN_STEP else radius
        plate = replace(blank, radius=radius, half_length=feet.y + radius, neck=wide)
        if plate.shape.fits:
            shapes.append(plate)
    if not shapes:
        return None
    flat = [_flat_patterns(surface, feet, row, shapes) for row in blank.rows]
    best, lightest, beside = None, inf, nan
    for index, plate in enumerate(shapes):
        patterns = [row.of(index) for row in flat]
        if not all(len(row) for row in patterns):
            continue
        if isnan(beside):
            # Beside the plate the trunk may be as high as its top: modules begin above that.
            beneath = np.concatenate([_disc(middle, feet.reach) for middle in feet.middles])
            beside = _highest(surface, beneath) - STOCK[0]
        level = max(_highest(surface, _all_over(plate)), beside)
        borne = _borne(feet, plate, patterns, underside, level)
        if borne is not None and (mass := borne.mass) < lightest:
            best, lightest = borne, mass
        # What is wider and as thick is heavier.
        if best is not None and best.thickness == STOCK[0]:
            return best
    return best


def _borne(
    feet: Feet,
    blank: CarrierPlate,
    patterns: Sequence["_Patterns"],
    underside: float | None,
    highest: float,
) -> CarrierPlate | None:
    """The thinnest plate of this outline that the trunk holds and that bears the modules.

    Args:
        feet: on it. blank: the plate without screws.
        patterns: of screws that are flat on the trunk, of each row.
        underside: height of the feet in B, where it is stated [m].
        highest: least height of the plate, for what is beneath and beside it [m].
    """
    if not np.isfinite(highest):
        return None
    x, y, _ = blank.position
    if underside is None:
        held = _screwed(replace(blank, position=(x, y, round(highest, 6))), patterns)
        return None if held is None else _bearing(held, feet, STOCK)
    for thickness in STOCK:
        height = underside - thickness
        if height < highest - PROUD:
            return None
        held = _screwed(replace(blank, position=(x, y, height)), patterns)
        if held is None:
            return None
        plate = _bearing(held, feet, (thickness,))
        if plate is not None:
            return plate
    return None


def _bearing(held: CarrierPlate, feet: Feet, thicknesses: tuple[float, ...]) -> CarrierPlate | None:
    """The plate in the first of some thicknesses [m] that bears the modules; None: in none."""
    stresses = held.stresses(np.array(thicknesses), feet.mass, feet.height)
    for thickness, stress in zip(thicknesses, stresses.tolist(), strict=True):
        plate = replace(held, thickness=thickness)
        if stress <= YIELD_STRENGTH / SAFETY and (
            not _on_posts(plate) or plate.posts_use(feet.mass, feet.height) <= 1.0
        ):
            return plate
    return None


@dataclass(frozen=True, eq=False)
class _Patterns:
    """Patterns of screws that are flat on the trunk under every screw.

    Attributes:
        along, across: of a screw from the middle line of its arm and from the plate's middle [m],
            shape (n,).
        shared: whether neighbouring arms share it, shape (n,).
        widest: number of the plate at whose neck's edge it is; -1: of the grid that all have.
        most: largest of `along` of each plate [m].
        places: of the screws over the plate's middle [m], shape (n, m, 2).
        top, low: of the trunk under each screw in B [m], shape (n, m).
    """

    along: FloatArray
    across: FloatArray
    shared: NDArray[np.bool_]
    widest: NDArray[np.int64]
    most: FloatArray
    places: FloatArray
    top: FloatArray
    low: FloatArray

    def __len__(self) -> int:
        return len(self.along)

    def where(self, chosen: NDArray[np.bool_]) -> "_Patterns":
        """Those that are chosen."""
        own = (self.along, self.across, self.shared, self.widest)
        along, across, shared, widest = (each[chosen] for each in own)
        places, top, low = (each[chosen] for each in (self.places, self.top, self.low))
        return _Patterns(along, across, shared, widest, self.most, places, top, low)

    def of(self, index: int) -> "_Patterns":
        """Those of the plate with this number."""
        inside = (self.widest < 0) & (self.along < self.most[index])
        return self.where(inside | (self.widest == index))


def _flat_patterns(
    surface: Surface, feet: Feet, row: float, plates: Sequence[CarrierPlate]
) -> _Patterns:
    """Patterns of screws at which the trunk is flat, whatever its height.

    Two screws in each arm, as far from its middle line on either side. Of three arms and more each
    may share its screws with the next ones. Heads stay clear of the feet and of the next arm's.

    Args:
        surface: of the trunk. feet: on it. row: of the plates' middle before that of the feet [m].
        plates: that differ in their necks alone, the narrowest first.
    """
    grid = _pattern_grid(
        feet.y,
        max(_PATTERN_STEP, feet.reach / 40.0),
        _apart(feet, plates[0].screw),
        tuple(plate.neck - EDGE * plate.screw.clearance_hole for plate in plates),
        feet.arms,
    )
    lands, middle = _disc((0.0, 0.0), plates[0].sleeve_radius), np.array([feet.x + row, 0.0])
    some, kept = lands[:: max(1, len(lands) // 8)], np.arange(len(grid))
    # Most patterns fail at a few points of their first screw already.
    for screw_places in grid.places.swapaxes(0, 1):
        top, low = _top_and_low(surface, screw_places[kept, None] + some + middle)
        with np.errstate(invalid="ignore"):
            kept = kept[top - low <= FLATNESS]
        if not len(kept):
            break
    within = np.zeros(len(grid), dtype=bool)
    within[kept] = True
    found = grid.where(within)
    top, low = _top_and_low(surface, found.places[:, :, None] + lands + middle)
    with np.errstate(invalid="ignore"):
        flat = (top - low <= FLATNESS).all(axis=1)
    return replace(found, top=top, low=low).where(flat)


def _top_and_low(surface: Surface, points: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Largest and least height of a trunk at the points of each disc [m], shape (..., m, 2)."""
    heights = surface.height(points[..., 0], points[..., 1])
    return heights.max(axis=-1), heights.min(axis=-1)


@lru_cache(maxsize=8)
def _pattern_grid(
    aside: float, step: float, apart: float, most: tuple[float, ...], arms: int
) -> _Patterns:
    """Patterns of screws that stand clear of the feet, whatever is below them.

    Args:
        aside: of a foot's middle from that of its plate [m]. step: between patterns [m].
        apart: least distance of a screw from the middle of a foot [m].
        most: farthest of a screw from the middle line of its arm, for each plate [m].
        arms: of each plate.
    """
    steps = np.concatenate([np.arange(SPREAD / 2.0, max(most), step), most])
    widest = np.concatenate([np.full(len(steps) - len(most), -1), np.arange(len(most))])
    order = np.argsort(steps, kind="stable")
    steps, widest = steps[order], widest[order]
    out = np.append(np.arange(SPREAD / 2.0, aside, step), aside)
    along, across = (each.ravel() for each in np.meshgrid(steps, out, indexing="ij"))
    half, edges = pi / arms, np.repeat(widest, len(out))
    shared = np.zeros(len(along), dtype=bool)
    clear = across * sin(half) - along * cos(half) >= SPREAD / 2.0 - _SAME
    if arms > len(SENSES):
        between = steps / np.tan(half)
        along, across = np.append(along, steps), np.append(across, between)
        shared = np.append(shared, np.ones(len(between), dtype=bool))
        clear, edges = np.append(clear, shared[shared]), np.append(edges, widest)
    clear &= np.hypot(along, aside - across) >= apart
    places = np.stack(
        [
            np.stack([y * side * along + x * across, y * across - x * side * along], axis=1)
            for sense in SENSES
            for x, y in directions(arms)
            # Of both arms of a pair the same side: forward.
            for side in (sense * y if arms == len(SENSES) else sense,)
        ],
        axis=1,
    )
    none = np.empty(places.shape[:2])
    found = _Patterns(along, across, shared, edges, np.array(most), places, none, none)
    return found.where(clear)


def _screwed(plate: CarrierPlate, patterns: Sequence[_Patterns]) -> CarrierPlate | None:
    """The plate with the widest pattern of screws that the trunk holds; None: there is none.

    Patterns without sleeves come first.

    Args:
        plate: in its place. patterns: that are flat on the trunk, of each row.
    """
    z, longest = plate.position[2], POST_MAX if _on_posts(plate) else SLEEVE_MAX
    trunk: list[Point] = []
    sleeves: list[float] = []
    for ahead, each in zip(plate.rows, patterns, strict=True):
        reached = ((each.top <= z + PROUD) & (z - each.top <= longest)).all(axis=1)
        if not reached.any():
            return None
        direct = (z - each.low <= FLATNESS).all(axis=1)
        spread = np.minimum(each.along, each.across) + 0.1 * (each.along + each.across)
        best = int(np.where(reached, spread + direct, -1.0).argmax())
        top, low = each.top[best], each.low[best]
        gaps = np.where(z - low <= FLATNESS, 0.0, np.round(z - top, 5))
        count = plate.arms if each.shared[best] else len(gaps)
        trunk += [
            (ahead + round(float(x), 6), round(float(y), 6)) for x, y in each.places[best][:count]
        ]
        sleeves += gaps[:count].tolist()
    return replace(plate, trunk=tuple(trunk), sleeves=tuple(sleeves))


def _on_posts(plate: CarrierPlate) -> bool:
    return plate.thread == POST_SCREW.name


def _apart(feet: Feet, held_by: Screw) -> float:
    """Least distance of a plate's screws from the middle of a foot [m]."""
    return feet.radius + held_by.head_diameter / 2.0 + HEAD_ROOM


def _heights(surface: Surface, points: FloatArray) -> FloatArray:
    return surface.height(points[:, 0], points[:, 1])


def _highest(surface: Surface, points: FloatArray) -> float:
    return float(_heights(surface, points).max())


def _disc(middle: Sequence[float], radius: float) -> FloatArray:
    """Points that stand for equal shares of a disc [m], shape (n, 2)."""
    return _ring(middle, 0.0, radius)


def _ring(middle: Sequence[float], inner: float, outer: float) -> FloatArray:
    """Points that stand for equal shares of a ring [m], shape (n, 2)."""
    return frozen(_around_middle(max(inner, 0.0), outer) + np.asarray(middle))


@lru_cache(maxsize=64)
def _around_middle(inner: float, outer: float) -> FloatArray:
    """Points of a ring around the origin [m], shape (n, 2)."""
    count = max(4, min(48, round((outer - inner) / 1e-3)))
    around = max(16, min(180, round(2.0 * pi * outer / 1e-3)))
    share = (np.arange(count) + 0.5) / count
    radii = np.sqrt(inner**2 + share * (outer**2 - inner**2))
    # The rim itself, where lands end first.
    angles = (np.arange(around) + 0.5) * 2.0 * pi / around
    rings = np.stack([np.cos(angles), np.sin(angles)], axis=1)
    return frozen((radii[:, None, None] * rings).reshape(-1, 2))


def _all_over(plate: CarrierPlate) -> FloatArray:
    """Points all over a plate in B [m], shape (n, 2)."""
    places = _within(plate.shape) + np.array(plate.position[:2])
    return np.concatenate([places + np.array([row, 0.0]) for row in plate.rows])


@lru_cache(maxsize=64)
def _within(shape: DogBone) -> FloatArray:
    """Points all over an outline [m], shape (n, 2)."""
    wide = shape.half_length if shape.arms > 2 else shape.radius
    xs, ys = (
        np.linspace(-half, half, 1 + int(np.ceil(2.0 * half / max(1e-3, shape.radius / 40.0))))
        for half in (wide, shape.half_length)
    )
    places = np.stack(np.meshgrid(xs, ys), axis=-1).reshape(-1, 2)
    return frozen(places[shape.holds(places)])
