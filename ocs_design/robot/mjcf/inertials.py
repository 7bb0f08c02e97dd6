"""Whether a MJCF body's inertia survives the loss of one of its geoms."""

import math

import mujoco

from ocs_design.exceptions import RobotError


def require_inertial(spec: mujoco.MjSpec, geom: mujoco.MjsGeom, file: str) -> None:
    """Refuse a model whose missing mesh `file` is what a body's inertia would come from."""
    body = geom.parent
    if body == spec.worldbody or _is_massless(geom) or not _in_group_range(spec, geom):
        return
    if body.explicitinertial and not _always_from_geoms(spec):
        return
    raise RobotError(
        f"{_named(body)} takes its inertia from the mesh {file}, which was not found",
        hint="put the mesh where the model expects it, or give the body an <inertial>",
    )


def _always_from_geoms(spec: mujoco.MjSpec) -> bool:
    always: bool = spec.compiler.inertiafromgeom == mujoco.mjtInertiaFromGeom.mjINERTIAFROMGEOM_TRUE
    return always


def _is_massless(geom: mujoco.MjsGeom) -> bool:
    """Geoms that are only to look at carry no mass by statement."""
    return bool(geom.mass == 0.0 or (math.isnan(geom.mass) and geom.density == 0.0))


def _in_group_range(spec: mujoco.MjSpec, geom: mujoco.MjsGeom) -> bool:
    first, last = spec.compiler.inertiagrouprange
    return bool(first <= geom.group <= last)


def _named(body: mujoco.MjsBody) -> str:
    """Name of a body or, if it has none, of the nearest body above that has one."""
    if body.name:
        return f"body {body.name!r}"
    return f"a body without a name below {_named(body.parent)}"
