"""Distances to links at random joint values, with Pinocchio's kinematics.

Against points on the hulls of trimesh, and against coal where links are primitives: of hulls with
hundreds of faces coal tells up to 10 mm too much.
"""

from functools import cache

import coal
import numpy as np
import pinocchio as pin
import pytest
import trimesh
from pinocchio_robots import configuration
from robots import ROBOTS

from ocs_design.robot.clearance import drawn, full_ranges, landing_poses, reaches
from ocs_design.robot.collision import CollisionModel
from ocs_design.robot.meshes import trunk_extent
from ocs_design.robot.probe import Ball, Drum
from ocs_design.robot.reader import read_robot

SOLO12, A1, BOLT = (
    "solo_description/robots/solo12",
    "a1_description/urdf/a1",
    "bolt_description/robots/bolt",
)


@cache
def collision_model(name):
    return CollisionModel(read_robot(ROBOTS / f"{name}.urdf"))


@cache
def pinocchio_of(name):
    path = str(ROBOTS / f"{name}.urdf")
    model = pin.buildModelFromUrdf(path)
    geometry = pin.buildGeomFromUrdf(
        model, path, pin.GeometryType.COLLISION, package_dirs=[str(ROBOTS.parent.parent)]
    )
    return model, geometry


def placed(name, posture):
    """Each collision shape, with its place in the trunk, which is the root."""
    model, geometry = pinocchio_of(name)
    data, geometry_data = model.createData(), geometry.createData()
    q = configuration(model, posture)
    pin.updateGeometryPlacements(model, data, geometry, geometry_data, q)
    return zip(geometry.geometryObjects, geometry_data.oMg, strict=True)


@cache
def hull_of(path):
    return trimesh.load_mesh(path).convex_hull


def by_trimesh(name, posture, point):
    """Least distance from a point to the hulls of all links; negative inside one."""
    distances = []
    for each, at in placed(name, posture):
        hull, local = hull_of(each.meshPath), at.actInv(point)
        outside = ((local - hull.triangles[:, 0]) * hull.face_normals).sum(axis=1).max() > 0.0
        distance = trimesh.proximity.closest_point_naive(hull, [local])[1][0]
        distances.append(distance if outside else -distance)
    return min(distances)


def by_coal(name, posture, shape, placement):
    """Least distance from any link to a shape."""
    where = coal.Transform3s(placement.rotation, placement.translation)
    return min(
        coal.distance(
            each.geometry,
            coal.Transform3s(at.rotation, at.translation),
            shape,
            where,
            coal.DistanceRequest(),
            coal.DistanceResult(),
        )
        for each, at in placed(name, posture)
    )


def cases(name, count):
    """Postures, and centres around the trunk."""
    collision = collision_model(name)
    postures = drawn(full_ranges(collision.robot, collision.robot.tree.joints), count)
    centers = np.random.default_rng(1).uniform(-0.4, 0.4, (count, 3))
    return collision, list(zip(postures, centers, strict=True))


@pytest.mark.parametrize("name", [SOLO12, BOLT])
def test_balls_and_hulls(name):
    collision, drawn_cases = cases(name, 20)
    for posture, center in drawn_cases:
        wanted = by_trimesh(name, posture, center) - 0.03
        found = collision.nearest(Ball(center, 0.03), collision.poses([posture]), collision.parts)
        assert found.distance == pytest.approx(wanted, abs=2e-6)


def test_drums_and_primitives():
    collision, drawn_cases = cases(A1, 60)
    axis = np.array([np.sin(0.6), np.cos(0.6), 0.0])
    turn = pin.Quaternion.FromTwoVectors(np.array([0.0, 0.0, 1.0]), axis).matrix()
    for posture, center in drawn_cases:
        wanted = by_coal(A1, posture, coal.Cylinder(0.05, 0.012), pin.SE3(turn, center))
        poses = collision.poses([posture])
        found = collision.nearest(Drum(center, axis, 0.05, 0.012), poses, collision.parts)
        # Of solids that overlap each library tells the depth in its own way.
        if wanted > 0.0:
            assert found.distance == pytest.approx(wanted, abs=5e-6)
        else:
            assert found.distance <= 1e-6


def test_parts_know_the_joints_that_move_them():
    parts = {part.name: part for part in collision_model(SOLO12).parts}
    assert (parts["base_link"].limb, parts["base_link"].joints) == ("", ())
    lower = parts["FL_LOWER_LEG"]
    assert (lower.limb, lower.joints) == ("FL_SHOULDER", ("FL_HAA", "FL_HFE", "FL_KFE"))


def test_a_limb_that_touches_in_the_nominal_posture_with_a_joint_at_its_limit():
    knee = "FR_calf_joint"
    path = ROBOTS / f"{A1}.urdf"
    limit = read_robot(path).tree.joints[knee].upper
    collision = CollisionModel(read_robot(path, joints={knee: limit}))
    (calf,) = (part for part in collision.parts if part.joints[-1:] == (knee,))
    ball = Ball(collision.nominal.positions[0, calf.geoms[-1]], 0.01)
    (reach,) = (each for each in reaches(collision, [ball]) if each.part == calf.name)
    assert reach.joints
    assert reach.joints.items() <= collision.robot.posture.items(), "nothing has to move"


@pytest.mark.parametrize("name", [SOLO12, A1])
@pytest.mark.parametrize("within", [0.01, 0.05, 10.0])
def test_what_is_left_out_as_far_off_is_no_nearer(name, within):
    """Each part in each posture alone, where neither boxes nor bounds leave anything out."""
    collision, random = collision_model(name), np.random.default_rng(5)
    ranges = full_ranges(collision.robot, collision.robot.tree.joints)
    poses = collision.poses(drawn(ranges, 24))
    for _ in range(4):
        center, axis = random.normal(scale=0.15, size=3), random.normal(size=3)
        for probe in (Ball(center, 0.03), Drum(center, axis / np.linalg.norm(axis), 0.02, 0.1)):
            alone = [
                collision.nearest(probe, poses[index], [part], within=within)
                for index in range(len(poses.postures))
                for part in collision.parts
            ]
            near = [each for each in alone if each is not None]
            found = collision.nearest(probe, poses, collision.parts, within=within)
            assert (found is None) == (not near)
            if found is not None:
                least = min(near, key=lambda each: each.distance)
                assert found.distance == pytest.approx(least.distance, abs=1e-7)
                assert found.posture == least.posture
            single = poses[0]
            near = collision.nearest(probe, single, collision.parts, within=within)
            kept = collision.near([probe], single, collision.parts, within)
            assert near is None or kept == [probe]


def test_postures_may_start_from_another_one():
    collision = collision_model(SOLO12)
    ranges = full_ranges(collision.robot, collision.robot.tree.joints)
    start, *others = drawn(ranges, 4)
    changed = [{name: each[name] for name in list(each)[:2]} for each in others]
    part = collision.parts[-1]
    whole = collision.poses([{**start, **each} for each in changed])
    found = collision.poses(changed, [part], start=start)
    assert list(found.postures) == list(whole.postures)
    np.testing.assert_array_equal(found.positions[:, part.geoms], whole.positions[:, part.geoms])
    np.testing.assert_array_equal(found.axes[:, part.geoms], whole.axes[:, part.geoms])


def test_a_fine_mesh_that_only_shows_is_met_by_its_hull(tmp_path):
    """MuJoCo looks over all of its vertices otherwise, a thousand times as long."""
    ball = trimesh.creation.icosphere(subdivisions=4, radius=0.1)
    ball.export(tmp_path / "ball.stl")
    (tmp_path / "shown.xml").write_text(
        """<mujoco><asset><mesh name="ball" file="ball.stl"/></asset><worldbody>
        <body name="trunk" pos="0 0 1"><freejoint/><geom type="box" size=".1 .1 .05" mass="3"/>
          <body name="arm" pos="0 0.5 0"><joint axis="0 1 0"/>
            <inertial pos="0 0 0" mass="1" diaginertia=".01 .01 .01"/>
            <geom type="mesh" mesh="ball" contype="0" conaffinity="0"/></body>
        </body></worldbody></mujoco>"""
    )
    model = CollisionModel(read_robot(tmp_path / "shown.xml"))
    arm = next(part for part in model.parts if part.limb)
    assert (model._model.mesh_graphadr[model._model.geom_dataid[arm.geoms]] >= 0).all()
    probe = Ball(np.array([0.0, 0.0, 0.0]), 0.05)
    near = model.nearest(probe, model.nominal, [arm])
    assert near.distance == pytest.approx(0.5 - 0.1 - 0.05, abs=1e-3)


@pytest.mark.slow
def test_legs_that_give_way_on_their_feet_kick_no_heel_up():
    """A foot's middle is below all of the trunk; what other legs do is as it was drawn."""
    collision = collision_model("human_description/robots/human")
    robot = collision.robot
    low = -trunk_extent(robot.tree, robot.trunk, -np.eye(3)[2])
    postures = {each: landing_poses(collision, on_feet=each).postures for each in (False, True)}

    def heights(postures):
        """Heights of the feet in B [m], a row for each posture."""
        places = (
            robot.tree.placements_from(robot.trunk, {**robot.posture, **each}) for each in postures
        )
        return np.array([[at[leg.body].point(leg.foot)[2] for leg in robot.legs] for at in places])

    drawn_ones, standing = heights(postures[False]), heights(postures[True])
    assert drawn_ones.max() > low
    assert standing.max() < low
    same = np.isclose(drawn_ones, standing)
    assert 0.6 < same.mean() < 1.0
    assert standing[~same] == pytest.approx(np.broadcast_to(standing[0], same.shape)[~same])
