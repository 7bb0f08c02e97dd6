"""Collision meshes reduced to their hulls: what can touch is the same, only lighter."""

import mujoco
import numpy as np
import pytest
import trimesh
from robots import ROBOTS

from ocs_design.robot.mujoco_model import build_spec, reduce_to_hulls
from ocs_design.robot.reader import read_robot

DIRECTIONS = np.random.default_rng(0).normal(size=(500, 3))


def reach(model):
    """How far each mesh geom that may touch reaches in each direction [m], by its body and place.

    Two convex bodies are the same if their support functions are.
    """
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    found = {}
    for geom in range(model.ngeom):
        mesh = model.geom_dataid[geom]
        if mesh < 0 or model.geom_contype[geom] == 0:
            continue
        first = model.mesh_vertadr[mesh]
        own = model.mesh_vert[first : first + model.mesh_vertnum[mesh]].astype(np.float64)
        placed = own @ data.geom_xmat[geom].reshape(3, 3).T + data.geom_xpos[geom]
        found[geom] = (placed @ DIRECTIONS.T).max(axis=0)
    return found


@pytest.mark.parametrize(
    "name",
    [
        pytest.param("g1_description/urdf/g1_29dof_rev_1_0", marks=pytest.mark.exhaustive),
        "bolt_description/robots/bolt",
    ],
)
def test_hulls_reach_as_far_as_the_meshes(name):
    robot = read_robot(ROBOTS / f"{name}.urdf")
    whole, hulls = (build_spec(robot, visuals=shown).spec for shown in (True, False))
    for geom in [geom for geom in whole.geoms if geom.contype == 0]:
        whole.delete(geom)
    before, after = whole.compile(), hulls.compile()
    expected, found = reach(before), reach(after)
    assert expected.keys() == found.keys() != set()
    for geom, distance in expected.items():
        np.testing.assert_allclose(found[geom], distance, rtol=0.0, atol=1e-6)
    assert after.nmeshvert < before.nmeshvert / 3
    assert after.body_inertia.tolist() == before.body_inertia.tolist()
    assert not hulls.assets


def test_a_box_fitted_to_a_mesh_stays_as_it_is():
    """Its size comes from the inertia of the mesh, which is not that of the hull."""
    ring = trimesh.creation.annulus(0.05, 0.1, 0.02)
    spec = mujoco.MjSpec()
    spec.assets["ring.stl"] = ring.export(file_type="stl")
    spec.add_mesh(name="ring", file="ring.stl")
    for kind in (mujoco.mjtGeom.mjGEOM_BOX, mujoco.mjtGeom.mjGEOM_MESH):
        spec.worldbody.add_geom(type=kind, meshname="ring")
    before = spec.compile()
    reduce_to_hulls(spec, before)
    after = spec.compile()
    assert after.geom_size.tolist() == before.geom_size.tolist()
    assert after.nmeshvert == before.nmeshvert
