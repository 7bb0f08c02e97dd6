"""How a device sits on its robot: what it is near, what could hit it, what it changes."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import chain, product

import numpy as np

from ocs_design.common.arrays import FloatArray
from ocs_design.common.errors import SpecificationError
from ocs_design.common.units import format_quantity
from ocs_design.device.device import Device
from ocs_design.device.naming import flywheel_name
from ocs_design.device.records import Clearance
from ocs_design.device.solids import ModuleSolids, module_solids, motor_mount
from ocs_design.requirement.froude import Envelope
from ocs_design.requirement.maneuver import Maneuver
from ocs_design.robot.clearance import (
    Reach,
    descended,
    landing_poses,
    landing_ranges,
    reaches,
)
from ocs_design.robot.collision import CollisionModel, Nearest, collision_model
from ocs_design.robot.mass import MassProperties
from ocs_design.robot.robot import Robot
from ocs_design.robot.tree import Drum
from ocs_design.sizing.placement import Size, module_size, place_free, wheel_size


@dataclass(frozen=True, eq=False)
class Mounting:
    """Modules are their housings, motors and feet, or bare wheels, at every incidence flown.

    Attributes:
        nearest: in the nominal posture; None if the robot has no geometry.
        landing: what moves against the trunk, while the legs give way as in landings; None if
            nothing does.
        reachable: limbs that could hit a module somewhere within their joints' limits.
        com_shift: of the centre of mass by the device, in B [m], shape (3,).
        inertia_change: of I_xx, I_yy and I_zz about the centre of mass, over the robot's own.
    """

    nearest: Clearance | None
    landing: Clearance | None
    reachable: tuple[Reach, ...]
    com_shift: FloatArray
    inertia_change: FloatArray


def mounting_of(
    robot: Robot, device: Device, maneuvers: Sequence[Maneuver], whole: MassProperties
) -> Mounting:
    """Look at a device on its robot.

    Args:
        robot: without it.
        device: as designed.
        maneuvers: some may have an incidence of their own.
        whole: robot and device together, in B.
    """
    collision = collision_model(robot)
    turned = {each.incidence: each for each in (device, *(device.as_flown(m) for m in maneuvers))}
    pairs = [
        (module_solids(each, each.modules[0]), module_solids(each, each.modules[1]))
        for each in turned.values()
    ]
    solids = [solid for pair in pairs for module in pair for solid in module.all]
    return Mounting(
        nearest=_nearest_part(collision, device, pairs),
        landing=_clearance(_nearest_in_landings(collision, solid) for solid in solids),
        reachable=reaches(collision, solids),
        com_shift=whole.com - robot.com,
        inertia_change=np.diag(whole.inertia) / np.diag(robot.inertia) - 1.0,
    )


def placement_warnings(
    mounting: Mounting,
    robot: Robot,
    device: Device,
    envelope: Envelope,
    *,
    stated: bool,
    strict: bool = False,
) -> tuple[str, ...]:
    """What is hit where the modules stand, one sentence each; joints' limits are another matter.

    Args:
        mounting: of the device on the robot.
        robot, device: see `mounting_of`.
        envelope: that the rims had to keep to.
        stated: whether the user chose the position.
        strict: they are errors.

    Raises:
        SpecificationError: `strict`, and there is any.
    """
    nearest, landing = mounting.nearest, mounting.landing
    if nearest is not None and nearest.distance < 0.0:
        overlap = format_quantity(-nearest.distance, "mm")
        hit = f"a module overlaps '{nearest.part}' by {overlap} in the nominal posture"
    elif landing is not None and landing.distance < 0.0:
        hit = f"'{landing.part}' can hit a module while the legs give way in a landing"
    else:
        return ()
    hint = _free_place_hint(robot, device, envelope, stated=stated)
    if strict:
        raise SpecificationError(f"--strict: {hit}", hint=hint)
    return (f"{hit}; {hint}",)


def _free_place_hint(robot: Robot, device: Device, envelope: Envelope, *, stated: bool) -> str:
    """Clause on where a module would hit nothing."""
    if not stated:
        return "no free place was found: give one with --position X,Y,Z"
    best = place_free(robot, envelope)
    if not best.free:
        return "no free place was found"
    left, _ = best.place.centers(device_size(device))
    place = ",".join(f"{1e3 * float(value):.1f}mm" for value in left)
    return f"free would be --position {place}, {best.face} the trunk"


def device_size(device: Device) -> Size[float]:
    """The room that each module takes."""
    wheel, mount = device.flywheel, motor_mount(device)
    if device.carrier.mass == 0.0:
        return wheel_size(wheel.outer_radius, wheel.height)
    behind = mount.behind(device.motor)
    return module_size(wheel.outer_radius, wheel.height, *behind, mount.holes.reach)


def _nearest_part(
    collision: CollisionModel, device: Device, pairs: Sequence[tuple[ModuleSolids, ModuleSolids]]
) -> Clearance | None:
    """Nearest of all links and of the other module, which is named after its wheel.

    A foot stands on the trunk, and is not near it.
    """
    limbs = [part for part in collision.parts if part.limb]
    modules = [module for pair in pairs for module in pair]
    around = ((module.body, collision.parts) for module in modules)
    below = ((module.foot, limbs) for module in modules)
    nearest = _clearance(
        collision.nearest(solid, collision.nominal, parts)
        for solids, parts in chain(around, below)
        for solid in solids
    )
    if nearest is None:
        return None
    apart = min(
        collision.between(*solids)
        for left, right in pairs
        for solids in product(left.all, right.all)
    )
    if apart < nearest.distance:
        return Clearance(flywheel_name(device.modules[1]), apart)
    return nearest


def _nearest_in_landings(collision: CollisionModel, solid: Drum) -> Nearest | None:
    """Limb that comes nearest to a solid while the legs give way in a landing."""
    moving = [part for part in collision.parts if part.limb]
    near = collision.nearest(solid, landing_poses(collision), moving)
    if near is None:
        return None
    return descended(collision, solid, near, landing_ranges(collision.robot))


def _clearance(found: Iterable[Nearest | None]) -> Clearance | None:
    known = [nearest for nearest in found if nearest is not None]
    if not known:
        return None
    least = min(known, key=lambda nearest: nearest.distance)
    return Clearance(least.part.name, least.distance)
