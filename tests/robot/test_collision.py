"""Distances to links at random joint values, with Pinocchio's kinematics.

Compared with points on the hulls of trimesh, and with coal where links are primitives: for hulls
with hundreds of faces coal overestimates the distance by up to 10 mm.
"""

from functools import cache

import coal
import numpy as np
import pinocchio as pin
import pytest
import trimesh
from pinocchio_robots import configuration
from robots import ROBOTS

from ocs_design.robot.clearance import full_ranges, landing_poses, reaches, sampled_postures
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


def placed_shapes(name, posture):
    """Each collision shape with its placement in the trunk frame, which is the root's."""
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
    for geometry, at in placed_shapes(name, posture):
        hull, local = hull_of(geometry.meshPath), at.actInv(point)
        outside = ((local - hull.triangles[:, 0]) * hull.face_normals).sum(axis=1).max() > 0.0
        distance = trimesh.proximity.closest_point_naive(hull, [local])[1][0]
        distances.append(distance if outside else -distance)
    return min(distances)


def by_coal(name, posture, shape, placement):
    """Least distance from any link to a shape."""
    place = coal.Transform3s(placement.rotation, placement.translation)
    return min(
        coal.distance(
            geometry.geometry,
            coal.Transform3s(at.rotation, at.translation),
            shape,
            place,
            coal.DistanceRequest(),
            coal.DistanceResult(),
        )
        for geometry, at in placed_shapes(name, posture)
    )


def cases(name, count):
    """Random postures, each with a point around the trunk."""
    collision = collision_model(name)
    postures = sampled_postures(full_ranges(collision.robot, collision.robot.tree.joints), count)
    centers = np.random.default_rng(1).uniform(-0.4, 0.4, (count, 3))
    return collision, list(zip(postures, centers, strict=True))


@pytest.mark.parametrize("name", [SOLO12, BOLT])
def test_balls_and_hulls(name):
    collision, pairs = cases(name, 20)
    for posture, center in pairs:
        expected = by_trimesh(name, posture, center) - 0.03
        nearest = collision.nearest(Ball(center, 0.03), collision.poses([posture]), collision.parts)
        assert nearest.distance == pytest.approx(expected, abs=2e-6)


def test_drums_and_primitives():
    collision, pairs = cases(A1, 60)
    axis = np.array([np.sin(0.6), np.cos(0.6), 0.0])
    rotation = pin.Quaternion.FromTwoVectors(np.array([0.0, 0.0, 1.0]), axis).matrix()
    for posture, center in pairs:
        expected = by_coal(A1, posture, coal.Cylinder(0.05, 0.012), pin.SE3(rotation, center))
        poses = collision.poses([posture])
        nearest = collision.nearest(Drum(center, axis, 0.05, 0.012), poses, collision.parts)
        # Each library defines the depth of overlapping solids in its own way.
        if expected > 0.0:
            assert nearest.distance == pytest.approx(expected, abs=5e-6)
        else:
            assert nearest.distance <= 1e-6


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
    (reach,) = (reach for reach in reaches(collision, [ball]) if reach.part == calf.name)
    assert reach.joints
    assert reach.joints.items() <= collision.robot.posture.items(), "nothing has to move"


@pytest.mark.parametrize("name", [SOLO12, A1])
@pytest.mark.parametrize("within", [0.01, 0.05, 10.0])
def test_skipped_parts_are_not_the_nearest(name, within):
    """Against each part in each posture alone, where neither boxes nor bounds skip anything."""
    collision, random = collision_model(name), np.random.default_rng(5)
    ranges = full_ranges(collision.robot, collision.robot.tree.joints)
    poses = collision.poses(sampled_postures(ranges, 24))
    for _ in range(4):
        center, axis = random.normal(scale=0.15, size=3), random.normal(size=3)
        for probe in (Ball(center, 0.03), Drum(center, axis / np.linalg.norm(axis), 0.02, 0.1)):
            separate = [
                collision.nearest(probe, poses[index], [part], within=within)
                for index in range(len(poses.postures))
                for part in collision.parts
            ]
            within_range = [distance for distance in separate if distance is not None]
            nearest = collision.nearest(probe, poses, collision.parts, within=within)
            assert (nearest is None) == (not within_range)
            if nearest is not None:
                least = min(within_range, key=lambda separation: separation.distance)
                assert nearest.distance == pytest.approx(least.distance, abs=1e-7)
                assert nearest.posture == least.posture
            pose = poses[0]
            nearest = collision.nearest(probe, pose, collision.parts, within=within)
            kept = collision.near([probe], pose, collision.parts, within)
            assert nearest is None or kept == [probe]


def test_postures_may_start_from_another_one():
    collision = collision_model(SOLO12)
    ranges = full_ranges(collision.robot, collision.robot.tree.joints)
    start, *others = sampled_postures(ranges, 4)
    changed = [{name: posture[name] for name in list(posture)[:2]} for posture in others]
    part = collision.parts[-1]
    expected = collision.poses([{**start, **posture} for posture in changed])
    poses = collision.poses(changed, [part], start=start)
    assert list(poses.postures) == list(expected.postures)
    np.testing.assert_array_equal(poses.positions[:, part.geoms], expected.positions[:, part.geoms])
    np.testing.assert_array_equal(poses.axes[:, part.geoms], expected.axes[:, part.geoms])


def test_a_fine_visual_mesh_collides_as_its_hull(tmp_path):
    """Without the hull MuJoCo searches all vertices, which takes a thousand times as long."""
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
    nearest = model.nearest(probe, model.nominal, [arm])
    assert nearest.distance == pytest.approx(0.5 - 0.1 - 0.05, abs=1e-3)


@pytest.mark.slow
def test_landing_legs_keep_their_feet_below_the_trunk():
    """No foot's centre rises above the trunk's bottom; legs whose foot is lower stay as sampled."""
    collision = collision_model("human_description/robots/human")
    robot = collision.robot
    trunk_bottom = -trunk_extent(robot.tree, robot.trunk, -np.eye(3)[2])
    postures = {on_feet: landing_poses(collision, on_feet=on_feet).postures for on_feet in (0, 1)}

    def heights(postures):
        """Heights of the feet in B [m], a row for each posture."""
        places = (
            robot.tree.placements_from(robot.trunk, {**robot.posture, **changed})
            for changed in postures
        )
        return np.array([[at[leg.body].point(leg.foot)[2] for leg in robot.legs] for at in places])

    free, standing = heights(postures[0]), heights(postures[1])
    assert free.max() > trunk_bottom
    assert standing.max() < trunk_bottom
    unchanged = np.isclose(free, standing)
    assert 0.6 < unchanged.mean() < 1.0
    assert standing[~unchanged] == pytest.approx(
        np.broadcast_to(standing[0], unchanged.shape)[~unchanged]
    )
