"""The pedestal under a tilted foot, from nearly flat to upright."""

from dataclasses import replace

import numpy as np
import pytest
import trimesh
from sample_parts import FOOT, HOUSING
from subsets import fast_subset

from ocs_design.export.meshes import part_manifold, part_mesh
from ocs_design.parts.foot import foot_part
from ocs_design.parts.housing import housing_parts
from ocs_design.parts.pedestal import (
    LEAST_SEAT,
    Pedestal,
    pedestal_part,
    pedestal_use,
    seat_compliance,
    strengthened,
)
from ocs_design.parts.printed import (
    BASE_THICKNESS,
    PETG,
    PLATE_THICKNESS,
    TRUNK_SCREW,
    trunk_screws,
)
from ocs_design.parts.solids import Part, hollow_cylinder

LEANS = np.radians([25.0, np.degrees(np.arctan(np.sqrt(0.5))), 60.0, 90.0])

for_each_lean = pytest.mark.parametrize("lean", LEANS)


def pedestal(lean: float) -> Pedestal:
    # High enough on the seat for a module with nothing behind its plate.
    middle = FOOT.base_radius + 5e-3
    return Pedestal(FOOT.base_radius, FOOT.slot_radius, FOOT.wheel_height, lean, middle)


def placed(part, *placements):
    body = part_manifold(part)
    for where in placements:
        body = body.transform(np.column_stack([where.rotation, where.position]))
    return body


@for_each_lean
def test_mass_properties_agree_with_the_mesh(lean):
    holed = pedestal_part(pedestal(lean))
    part = replace(holed, holes=holed.holes[:1])
    mesh, exact = part_mesh(part), part.mass_properties()
    solid = trimesh.Trimesh(mesh.vertices, mesh.triangles)
    assert solid.is_watertight
    solid.density = part.density
    assert exact.mass == pytest.approx(solid.mass, rel=1e-9)
    np.testing.assert_allclose(exact.com, solid.center_mass, atol=1e-10)
    np.testing.assert_allclose(exact.inertia, solid.moment_inertia, atol=1e-9 * exact.inertia.max())
    # Holes are within the body and do not overlap; circles are polygons of equal area.
    assert part_manifold(holed).volume() * holed.density == pytest.approx(holed.mass(), rel=1e-9)


@for_each_lean
def test_mass_is_that_of_the_printed_part_and_its_screws(lean):
    placed_pedestal = replace(pedestal(lean), position=(0.1, -0.2, 0.3), heading=0.7)
    where = placed_pedestal.placement
    printed = pedestal_part(placed_pedestal).mass_properties().moved(where.rotation, where.position)
    # The two screws of a foot on the trunk are already part of the module.
    screws = placed_pedestal.base_screws.mass + placed_pedestal.seat_screws.mass
    screws -= trunk_screws(PLATE_THICKNESS).mass
    assert placed_pedestal.mass == pytest.approx(printed.mass + screws, rel=1e-9)
    total = placed_pedestal.mass_properties()
    assert total.mass == pytest.approx(placed_pedestal.mass)
    # The screws move the centre of mass by at most their share of the mass times the size.
    bound = screws / placed_pedestal.mass * (placed_pedestal.length + placed_pedestal.height)
    assert np.linalg.norm(total.com - printed.com) < bound


@pytest.mark.parametrize("lean", fast_subset(2, LEANS))
def test_foot_lies_on_the_seat_housing_is_clear_and_a_driver_reaches_every_screw(lean):
    """Before the foot is mounted: a cylinder as wide as a screw's head, straight up."""
    made, radius = pedestal(lean), TRUNK_SCREW.head_diameter / 2.0
    body, foot = placed(pedestal_part(made)), placed(foot_part(FOOT), made.seat)
    assert (body ^ foot).volume() < 1e-14
    assert body.min_gap(foot, 0.01) == pytest.approx(0.0, abs=1e-9)
    where = FOOT.placement.inverse()
    for part in housing_parts(HOUSING):
        assert body.min_gap(placed(part, where, made.seat), 0.01) > 1e-3
    cylinder = part_manifold(Part("driver", 1.0, (hollow_cylinder(0.0, radius, made.base, 0.3),)))
    for x, y in made.holes:
        driver = cylinder.translate((x, y, 0.0))
        assert (body ^ driver).volume() < 1e-15
        head = driver.trim_by_plane((0.0, 0.0, -1.0), -(made.base + TRUNK_SCREW.head_height))
        assert (foot ^ head).volume() < 1e-15


def test_thickness_is_the_least_sufficient_one():
    made, heavy = pedestal(LEANS[1]), 3.0
    light, thick = strengthened(made, 0.01), strengthened(made, heavy)
    assert (light.thickness, light.base) == (LEAST_SEAT, BASE_THICKNESS)
    assert thick.thickness > LEAST_SEAT
    assert thick.base > BASE_THICKNESS
    # 0.1 mm less of either is too thin.
    for thinner in (
        replace(thick, thickness=thick.thickness - 1.01e-4),
        replace(thick, base=thick.base - 1.01e-4),
    ):
        assert pedestal_use(thinner, heavy) > 1.0
    # The section modulus of the seat is proportional to the square.
    four = strengthened(made, 4.0 * heavy)
    assert four.thickness == pytest.approx(2.0 * thick.thickness, abs=2e-4)
    # All loads are proportional to the mass.
    assert pedestal_use(thick, 2.0) == pytest.approx(2.0 * pedestal_use(thick, 1.0))


@for_each_lean
def test_wheel_is_at_the_required_height(lean):
    above = pedestal(lean).wheel[2] + 4e-3
    assert strengthened(pedestal(lean), 2.0, above).wheel[2] == pytest.approx(above)


def test_screws_of_the_seat_fit_the_slots():
    cuts = pedestal_part(pedestal(LEANS[2])).cut
    holes = [cut.shape.centre for cut in cuts if cut.placement.position[1] != 0.0]
    assert len(holes) == 2
    for x, y in holes:
        assert np.hypot(x, y) == pytest.approx(FOOT.slot_radius)
        assert abs(abs(np.arctan2(y, x)) % (np.pi / 2.0)) == pytest.approx(np.pi / 4.0)


@for_each_lean
def test_the_compliance_of_the_seat_is_that_of_a_beam(lean):
    """Mohr: the integral of the moment times that of a unit load, over E I, along the seat."""
    made = strengthened(pedestal(lean), 2.0)
    a, length, high = made.middle, made.length, made.wheel_height
    # Midpoints of many equal pieces, none of them at the couple.
    x = (np.arange(200_000) + 0.5) * length / 200_000
    before = x < a
    of_force = np.where(before, x * (length - a) / length, a * (length - x) / length)
    of_couple = np.where(before, -x / length, 1.0 - x / length)
    stiffness = PETG.modulus * made.width * made.thickness**3 / 12.0
    square, along = seat_compliance(made)
    assert square == pytest.approx(float(np.mean(of_force**2)) * length / stiffness, rel=1e-4)
    assert along == pytest.approx(
        float(np.mean(of_couple**2)) * length * high**2 / stiffness, rel=1e-4
    )
