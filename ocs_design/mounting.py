"""How a device sits on its robot: what it is near, what could hit it, what it changes."""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import chain, product

import numpy as np

from ocs_design.arrays import FloatArray
from ocs_design.design import Device
from ocs_design.exceptions import SpecificationError
from ocs_design.export.naming import flywheel_name
from ocs_design.module_solids import ModuleSolids, device_size, module_solids
from ocs_design.requirement.envelope import Envelope
from ocs_design.requirement.maneuver import Maneuver
from ocs_design.robot.mass_properties import MassProperties
from ocs_design.robot.obstacles.descent import descended
from ocs_design.robot.obstacles.motion import landing_poses, landing_ranges
from ocs_design.robot.obstacles.obstacles import Nearest, Obstacles, obstacles_of
from ocs_design.robot.obstacles.probes import Drum
from ocs_design.robot.obstacles.reach import Reach, reaches
from ocs_design.robot.robot import Robot
from ocs_design.sizing.free_place import place_free
from ocs_design.units import format_quantity


@dataclass(frozen=True)
class Clearance:
    """The part that a module is nearest to.

    Attributes:
        part: name of a body of the robot, or of the other wheel.
        distance: between the surfaces, negative if they overlap [m].
    """

    part: str
    distance: float


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
    obstacles = obstacles_of(robot)
    turned = {each.incidence: each for each in (device, *(device.as_flown(m) for m in maneuvers))}
    pairs = [_both(each) for each in turned.values()]
    solids = [solid for pair in pairs for module in pair for solid in module.all]
    return Mounting(
        nearest=_nearest_of_all(obstacles, device, pairs),
        landing=_clearance(_in_landings(obstacles, solid) for solid in solids),
        reachable=reaches(obstacles, solids),
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
    found = tuple(_hits(mounting))
    if not found:
        return ()
    hint = _hint(robot, device, envelope, stated=stated)
    if strict:
        raise SpecificationError(f"--strict: {'; '.join(found)}", hint=hint)
    return tuple(f"{sentence}; {hint}" for sentence in found)


def _hits(mounting: Mounting) -> Iterator[str]:
    nearest, landing = mounting.nearest, mounting.landing
    if nearest is not None and nearest.distance < 0.0:
        overlap = format_quantity(-nearest.distance, "mm")
        yield f"a module overlaps '{nearest.part}' by {overlap} in the nominal posture"
    elif landing is not None and landing.distance < 0.0:
        yield f"'{landing.part}' can hit a module while the legs give way in a landing"


def _hint(robot: Robot, device: Device, envelope: Envelope, *, stated: bool) -> str:
    if not stated:
        return "no free place was found: give one with --position X,Y,Z"
    best = place_free(robot, envelope)
    if not best.free:
        return "no free place was found"
    left, _ = best.place.centers(device_size(device))
    place = ",".join(f"{1e3 * float(value):.1f}mm" for value in left)
    return f"free would be --position {place}, {best.face} the trunk"


def _nearest_of_all(
    obstacles: Obstacles, device: Device, pairs: Sequence[tuple[ModuleSolids, ModuleSolids]]
) -> Clearance | None:
    """Of all links and of the other module, which is named after its wheel.

    A foot stands on the trunk, and is not near it.
    """
    limbs = [part for part in obstacles.parts if part.limb]
    modules = [module for pair in pairs for module in pair]
    around = ((module.body, obstacles.parts) for module in modules)
    below = ((module.foot, limbs) for module in modules)
    nearest = _clearance(
        obstacles.nearest(solid, obstacles.nominal, parts)
        for solids, parts in chain(around, below)
        for solid in solids
    )
    if nearest is None:
        return None
    apart = min(
        obstacles.between(*solids)
        for left, right in pairs
        for solids in product(left.all, right.all)
    )
    if apart < nearest.distance:
        return Clearance(flywheel_name(device.modules[1]), apart)
    return nearest


def _in_landings(obstacles: Obstacles, solid: Drum) -> Nearest | None:
    moving = [part for part in obstacles.parts if part.limb]
    near = obstacles.nearest(solid, landing_poses(obstacles), moving)
    if near is None:
        return None
    return descended(obstacles, solid, near, landing_ranges(obstacles.robot))


def _clearance(found: Iterable[Nearest | None]) -> Clearance | None:
    known = [nearest for nearest in found if nearest is not None]
    if not known:
        return None
    least = min(known, key=lambda nearest: nearest.distance)
    return Clearance(least.part.name, least.distance)


def _both(device: Device) -> tuple[ModuleSolids, ModuleSolids]:
    left, right = device.modules
    return module_solids(device, left), module_solids(device, right)
