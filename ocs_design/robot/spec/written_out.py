"""What an MJCF model leaves to MuJoCo's compiler, written out in plain numbers."""

import mujoco
import numpy as np

from ocs_design.robot.mjcf.spec import compiled


def write_out_orientations(spec: mujoco.MjSpec) -> None:
    """Turn Euler angles and the like into quaternions, the one notation that the model keeps."""
    quaternion = mujoco.mjtOrientation.mjORIENTATION_QUAT
    for element in (*spec.bodies, *spec.frames, *spec.geoms, *spec.sites):
        if element.alt.type != quaternion:
            rules = element.compiler
            element.quat = spec.resolve_orientation(rules.degree, rules.eulerseq, element.alt)
            element.alt.type = quaternion


def write_out_inertials(spec: mujoco.MjSpec) -> None:
    """Give each body the mass properties that it compiles to.

    Rules of the model's own, such as a total mass that all bodies are scaled to, must not reach
    what is added to it later.
    """
    model = compiled(spec)
    for body in spec.bodies[1:]:
        if model.body_mass[body.id] > 0.0:
            body.explicitinertial = True
            body.mass, body.inertia = model.body_mass[body.id], model.body_inertia[body.id]
            body.ipos, body.iquat = model.body_ipos[body.id], model.body_iquat[body.id]
            body.fullinertia = [np.nan] * 6
    spec.compiler.inertiafromgeom = mujoco.mjtInertiaFromGeom.mjINERTIAFROMGEOM_FALSE
    spec.compiler.settotalmass = -1.0
    spec.compiler.boundmass = spec.compiler.boundinertia = 0.0
    spec.compiler.balanceinertia = False
