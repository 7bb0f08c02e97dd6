"""The carrier of a module: motor, gear, housing and foot."""

from dataclasses import replace

import numpy as np
import pytest
import trimesh
from carrier_parts import UPRIGHT, carrier_parts, foot_for
from subsets import fast_subset

from ocs_design.actuation.fasteners import BoltCircle
from ocs_design.actuation.motor import DIRECT, Face, Motor, Mounting
from ocs_design.export.meshes import part_mesh
from ocs_design.parts.cage import cage_part
from ocs_design.parts.foot import foot_part
from ocs_design.parts.housing import housing_parts
from ocs_design.parts.module import carrier_of, drive_moments
from ocs_design.parts.motor_mount import mount_of
from ocs_design.parts.solids import Carrier
from ocs_design.robot.mass import MassProperties, combine

MOTOR = Motor(
    name="m", maker="test", mass=0.12, diameter=0.04, length=0.03, torque_constant=None,
    resistance=None, rated_voltage=None, no_load_speed=None, speed_max=None, peak_torque=None,
    peak_current=None, continuous_torque=None, rotor_inertia=None, source="made up",
    confidence="good",
)  # fmt: skip

AT_THE_BACK = Mounting(
    0.004, BoltCircle(0.012, 4, "M2"), BoltCircle(0.025, 4, "M3"), stator_face=Face.BACK
)

AT_THE_OUTPUT = Mounting(0.005, stator=BoltCircle(0.025, 4, "M3"), stator_face=Face.OUTPUT)


@pytest.mark.parametrize(("diameter", "length"), [(0.04, 0.03), (0.04, None), (None, None)])
def test_a_motor_is_a_solid_cylinder_of_its_known_size(diameter, length):
    """Without a length a disc, and without a diameter a point."""
    body = Carrier.of(drive_moments(replace(MOTOR, diameter=diameter, length=length)))
    square = (diameter or 0.0) ** 2 / 4.0
    assert body.mass == pytest.approx(0.12)
    assert body.axial_inertia == pytest.approx(0.12 * square / 2.0)
    across = 0.12 * (square / 4.0 + (length or 0.0) ** 2 / 12.0)
    assert (body.transverse_inertia, body.vertical_inertia) == pytest.approx((across, across))


@pytest.mark.parametrize("thick", fast_subset(2, [0.0084, 0.005]))
@pytest.mark.parametrize("mounting", [None, AT_THE_OUTPUT, AT_THE_BACK])
def test_the_carrier_has_the_mass_properties_of_its_meshes(mounting, thick):
    """Masses of meshes are exact, inertias to the deviation of polygons from circles."""
    weightless = replace(MOTOR, mass=0.0, mounting=mounting)
    foot = foot_for(weightless, DIRECT, 0.034, 0.004, thick)
    pieces = [(part, UPRIGHT, np.zeros(3)) for part in housing_parts(foot.housing)]
    pieces.append((foot_part(foot), np.eye(3), np.array([0.0, 0.0, -foot.wheel_height])))
    cage = mount_of(weightless, None, thick).around(0.004).cage
    if cage is not None:
        pieces.append((cage_part(cage), UPRIGHT, np.array([0.0, -cage.back, 0.0])))
    expected = combine([mesh_mass_properties(*piece) for piece in pieces])
    parts = carrier_parts(weightless, DIRECT, 0.034, 0.004, thick)
    screws = [each for each in parts if not each.inertia.any()]
    carrier = carrier_of(weightless, DIRECT, 0.034, 0.004, foot_plate=thick).mass_properties()
    total = combine([expected, *screws])
    assert carrier.mass == pytest.approx(total.mass, rel=1e-6)
    np.testing.assert_allclose(carrier.com, total.com, atol=1e-7)
    np.testing.assert_allclose(carrier.inertia, total.inertia, rtol=1e-4, atol=1e-10)


def mesh_mass_properties(part, rotation, position):
    """Mass properties of a part's mesh by trimesh."""
    triangles = part_mesh(part, 256)
    mesh = trimesh.Trimesh(triangles.vertices, triangles.triangles, process=False)
    mesh.density = part.density
    own = MassProperties(mesh.mass, mesh.center_mass, mesh.moment_inertia)
    return own.moved(rotation, position)


def test_a_carrier_with_two_inertias_is_a_body_of_revolution():
    plain = Carrier(0.2, 3e-5, 2e-5)
    np.testing.assert_array_equal(plain.inertia, np.diag([2e-5, 3e-5, 2e-5]))
    np.testing.assert_array_equal(plain.mass_properties().com, 0.0)
