"""Mast blocks formed to a round trunk: contact by meshes, mass, strength, and limits."""

from dataclasses import replace
from math import pi

import msgspec
import numpy as np
import pytest
import trimesh
from coarse_masts import coarse_mast_search
from manifold3d import Manifold, Mesh64, OpType
from urdf_text import inertial, solid, topped
from wheels import driven_device, stand_on_trunk

from ocs_design.common.errors import OcsError
from ocs_design.device.checks import check_device
from ocs_design.export.meshes import part_mesh
from ocs_design.parts.carrier_plate import MAST_YIELD, TOUCH, block_part, plate_bodies, steepest
from ocs_design.parts.joints import pattern_use
from ocs_design.parts.plate_strength import mast_screws_use, mast_stress
from ocs_design.robot.reader import read_robot
from ocs_design.robot.surface import surface_of, trunk_triangles
from ocs_design.sizing.footing.formed import DEPTH_MAX, TILT_MAX, front_of
from ocs_design.sizing.mounting import mounting_of, mounting_open_points

DEVICE = driven_device()

RADIUS = 0.022
CYLINDER = solid(f'<cylinder radius="{RADIUS}" length="0.16"/>')
RIDGE = solid('<box size="0.12 0.12 0.16"/>', rpy="0 0 0.785")
HEAD = inertial(2, "0.01 0.01 0.01") + solid('<box size="0.2 0.3 0.2"/>')


@coarse_mast_search()
def standing(folder, shape):
    """A trunk of this shape with a head on top that leaves no other room, and its device."""
    path = folder / "round.urdf"
    path.write_bytes(topped(inertial(20, "0.3 0.3 0.1") + shape, HEAD, "0 0 0.2"))
    robot = read_robot(path, trunk="base")
    return robot, stand_on_trunk(DEVICE, robot, specified=False, formed=True)


@pytest.fixture(scope="module")
def on_cylinder(tmp_path_factory):
    return standing(tmp_path_factory.mktemp("round"), CYLINDER)


def block_in_trunk(plate):
    """The block as a mesh in B, with chords fine enough for the mass of its holes."""
    mesh = part_mesh(block_part(plate, plate.relief), 256)
    return trimesh.Trimesh(mesh.vertices + plate.position, mesh.triangles)


def test_a_round_trunk_carries_a_mast_by_a_formed_block(on_cylinder):
    robot, device = on_cylinder
    plate = device.plate
    assert plate.mast.formed
    assert plate.relief is not None
    mounting = mounting_of(robot, device, (), robot.mass_properties)
    assert mounting_open_points(mounting) == ()
    (block,) = (each for each in mounting.feet if each.name == "mast's block")
    assert block.held
    assert block.share == 1.0
    assert 0.0 < steepest(plate) <= TILT_MAX
    mass, height = device.module_mass, device.foot.wheel_height
    assert mast_stress(plate, mass, height) <= MAST_YIELD
    assert mast_screws_use(plate, mass, height) <= 1.0
    assert msgspec.json.decode(msgspec.json.encode(plate), type=type(plate)) == plate
    check_device(device)


def test_the_block_touches_the_trunk_everywhere_without_overlap(on_cylinder):
    """By the intersection of both meshes, and by the vertices of the trunk's mesh."""
    robot, device = on_cylinder
    plate, corners = device.plate, trunk_triangles(robot)
    trunk = trimesh.Trimesh(corners.reshape(-1, 3), np.arange(3 * len(corners)).reshape(-1, 3))
    trunk.merge_vertices()
    trunk.update_faces(trunk.nondegenerate_faces())
    assert trunk.is_watertight
    block, mast = block_in_trunk(plate), plate.mast
    assert block.is_watertight
    solids = [
        Manifold(Mesh64(np.array(each.vertices), np.array(each.faces, dtype=np.uint64)))
        for each in (block, trunk)
    ]
    assert Manifold.batch_boolean(solids, OpType.Intersect).volume() == 0.0
    # The trunk is a prism with as many sides as its height map has.
    behind = trunk.vertices[(trunk.vertices[:, 0] <= 1e-9) & (trunk.vertices[:, 2] > 0.0)]
    behind = behind[np.hypot(*behind[:, :2].T) > 0.5 * RADIUS]
    order = np.argsort(behind[:, 1])
    random, half, (low, high) = np.random.default_rng(0), mast.side / 2.0, plate.block
    y, z = random.uniform(-half, half, 2000), random.uniform(low, high, 2000)
    face = plate.position[0] + mast.face + plate.relief.height(y, z)
    gap = np.interp(y, behind[order, 1], behind[order, 0]) - face
    assert gap.min() >= 0.0
    assert gap.max() <= TOUCH


def test_mass_properties_agree_with_the_meshes(on_cylinder):
    _, device = on_cylinder
    plate = device.plate
    solid, exact = block_in_trunk(plate), block_part(plate, plate.relief).mass_properties()
    assert exact.mass == pytest.approx(plate.density * solid.volume, rel=1e-4)
    assert exact.com + plate.position == pytest.approx(solid.center_mass, abs=1e-6)
    assert exact.inertia == pytest.approx(
        plate.density * solid.moment_inertia, abs=1e-4 * exact.mass
    )
    bodies = [part for part, _ in plate_bodies(plate)]
    assert [part.name for part in bodies].count("block") == 1
    screws = sum(plate.screw.mass(length) for length in plate.screw_lengths)
    assert plate.mass == pytest.approx(sum(part.mass() for part in bodies) + screws)
    assert device.mass > plate.mass


def test_screws_are_long_enough_for_the_thickest_part_of_the_block(on_cylinder):
    _, device = on_cylinder
    plate, thread = device.plate, device.plate.screw.diameter
    for (y, z), length in zip(plate.trunk, plate.screw_lengths, strict=True):
        angles = np.linspace(0.0, 2.0 * pi, 90)
        radius = plate.screw.clearance_hole / 2.0
        block = plate.relief.height(y + radius * np.cos(angles), z + radius * np.sin(angles)).max()
        assert length >= plate.mast.side + block + thread - 1e-4


def test_slopes_follow_the_trunk_and_load_the_screws_in_shear(on_cylinder):
    """On a cylinder the lateral slope is y / sqrt(R^2 - y^2); both sides cancel."""
    _, device = on_cylinder
    plate = device.plate
    for (y, _), (left, up) in zip(plate.trunk, plate.slopes, strict=True):
        # The block is thicker where the trunk is farther away.
        assert left == pytest.approx(y / np.sqrt(RADIUS**2 - y**2), abs=0.05)
        assert up == pytest.approx(0.0, abs=1e-6)
    assert np.abs(plate.slopes.mean(axis=0)).max() < 0.02
    thread, force, arms = plate.screw, 1000.0, (0.1, np.asarray(0.05))
    half = np.asarray(0.03), np.asarray(0.015)
    assert pattern_use(thread, force, arms, half, 500.0) > pattern_use(thread, force, arms, half)


@pytest.mark.slow
def test_a_trunk_that_is_too_steep_carries_no_block(tmp_path):
    """A box with an edge at its back slopes by 45 degrees."""
    robot, device = standing(tmp_path, RIDGE)
    assert device.plate is None
    mounting = mounting_of(robot, device, (), robot.mass_properties)
    assert any(each.held is False for each in mounting.feet)
    assert mounting_open_points(mounting)


def test_gentle_forms_are_accepted_and_steps_and_edges_are_not():
    def back(height):
        """Triangles of a trunk's back over a square of 0.2 m."""
        x, y = np.meshgrid(*2 * (np.linspace(-0.1, 0.1, 201),), indexing="ij")
        points = np.stack([x, y, height(x, y)], axis=-1)
        a, b, c, d = points[:-1, :-1], points[1:, :-1], points[1:, 1:], points[:-1, 1:]
        return surface_of(
            np.concatenate([np.stack(t, 2).reshape(-1, 3, 3) for t in ((a, b, c), (a, c, d))])
        )

    bowl = back(lambda x, y: 0.1 - 0.5 * (x**2 + y**2) / 0.15)
    front = front_of(bowl, 0.02, -0.03, 0.03)
    assert front is not None
    assert np.ptp(front) < DEPTH_MAX
    assert front_of(back(lambda x, _: np.where(x > 0.0, 0.1, 0.098)), 0.02, -0.03, 0.03) is None
    assert front_of(back(lambda x, _: 0.1 - abs(x)), 0.02, -0.03, 0.03) is None
    assert front_of(bowl, 0.02, 0.08, 0.14) is None


@pytest.mark.parametrize(
    "changed", [{"formed": ((0.01, 0.01),)}, {"formed": ((0.01, 0.01), (0.01,))}, {"spacer": 0.02}]
)
def test_an_inconsistent_block_is_refused(on_cylinder, changed):
    _, device = on_cylinder
    mast = replace(device.plate.mast, **changed)
    with pytest.raises(OcsError, match=r"plate\.mast"):
        check_device(replace(device, plate=replace(device.plate, mast=mast)))
