import mujoco
import numpy as np
import pytest

from ocs_design.export.physics import lowest_point
from ocs_design.simulation.scene import FLOOR, add_floor

Geom = mujoco.mjtGeom
SHAPES = {
    "box": (Geom.mjGEOM_BOX, (0.1, 0.2, 0.3)),
    "sphere": (Geom.mjGEOM_SPHERE, (0.1, 0, 0)),
    "capsule": (Geom.mjGEOM_CAPSULE, (0.1, 0.2, 0)),
    "cylinder": (Geom.mjGEOM_CYLINDER, (0.1, 0.2, 0)),
    "ellipsoid": (Geom.mjGEOM_ELLIPSOID, (0.1, 0.2, 0.3)),
    "mesh": (Geom.mjGEOM_MESH, (0, 0, 0)),
}


def body_with(shape: str, count: int = 1) -> mujoco.MjModel:
    spec = mujoco.MjSpec()
    corners = np.random.default_rng(1).normal(scale=0.2, size=(30, 3))
    spec.add_mesh(name="cloud", uservert=corners.ravel())
    kind, size = SHAPES[shape]
    for index in range(count):
        body = spec.worldbody.add_body(name=f"body{index}")
        body.add_freejoint()
        geom = body.add_geom(type=kind, size=size, pos=(0.1, -0.2, 0.3))
        if kind is Geom.mjGEOM_MESH:
            geom.meshname = "cloud"
    add_floor(spec)
    return spec.compile()


@pytest.mark.parametrize("shape", SHAPES)
def test_contact_begins_where_the_lowest_point_meets_the_floor(shape):
    model = body_with(shape)
    data = mujoco.MjData(model)
    for quaternion in np.random.default_rng(2).normal(size=(20, 4)):
        contacts = []
        data.qpos[:] = (0.0, 0.0, 3.0, *(quaternion / np.linalg.norm(quaternion)))
        mujoco.mj_forward(model, data)
        height = 3.0 - lowest_point(model, data)
        for offset in (1e-6, -1e-6):
            data.qpos[2] = height + offset
            mujoco.mj_forward(model, data)
            contacts.append(data.ncon)
        assert contacts[0] == 0
        assert contacts[1] > 0


def test_bodies_collide_with_the_floor_alone():
    model = body_with("box", count=2)
    data = mujoco.MjData(model)
    data.qpos[2] = data.qpos[9] = 0.0
    mujoco.mj_forward(model, data)
    floor = model.geom(FLOOR).id
    assert data.ncon > 0
    assert all(floor in contact.geom for contact in data.contact)
