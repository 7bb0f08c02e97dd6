"""The pedestal under a foot that leans, from nearly flat to upright."""

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


EACH_LEAN = pytest.mark.parametrize("lean", LEANS)


def pedestal(lean: float) -> Pedestal:
    # Far enough up the seat for a module with nothing behind its plate.
    middle = FOOT.base_radius + 5e-3
    return Pedestal(FOOT.base_radius, FOOT.slot_radius, FOOT.wheel_height, lean, middle)


def at(part, *placements):
    body = part_manifold(part)
    for where in placements:
        body = body.transform(np.column_stack([where.rotation, where.position]))
    return body


@EACH_LEAN
def test_weighs_what_its_mesh_does_with_holes_that_lie_within_it_and_do_not_overlap(lean):
    holed = pedestal_part(pedestal(lean))
    part = replace(holed, holes=holed.holes[:1])
    mesh, exact = part_mesh(part), part.mass_properties()
    found = trimesh.Trimesh(mesh.vertices, mesh.triangles)
    assert found.is_watertight
    found.density = part.density
    assert exact.mass == pytest.approx(found.mass, rel=1e-9)
    np.testing.assert_allclose(exact.com, found.center_mass, atol=1e-10)
    np.testing.assert_allclose(exact.inertia, found.moment_inertia, atol=1e-9 * exact.inertia.max())
    # Circles as polygons of their own area.
    assert part_manifold(holed).volume() * holed.density == pytest.approx(holed.mass(), rel=1e-9)


@EACH_LEAN
def test_mass_is_that_of_what_is_printed_and_of_its_screws_in_its_place(lean):
    made = replace(pedestal(lean), position=(0.1, -0.2, 0.3), heading=0.7)
    where = made.placement
    printed = pedestal_part(made).mass_properties().moved(where.rotation, where.position)
    # A foot that stands on the trunk has two screws of its own, which its module counts.
    screws = made.base_screws.mass + made.seat_screws.mass - trunk_screws(PLATE_THICKNESS).mass
    assert made.mass == pytest.approx(printed.mass + screws, rel=1e-9)
    whole = made.mass_properties()
    assert whole.mass == pytest.approx(made.mass)
    # Four screws of 1 g move it by no more than their share of it, over its own length.
    bound = screws / made.mass * (made.length + made.height)
    assert np.linalg.norm(whole.com - printed.com) < bound


@pytest.mark.parametrize("lean", fast_subset(2, LEANS))
def test_foot_lies_on_the_seat_housing_is_clear_and_a_driver_reaches_every_screw(lean):
    """Before the foot is on: a cylinder as wide as a screw's head, straight up."""
    made, radius = pedestal(lean), TRUNK_SCREW.head_diameter / 2.0
    body, foot = at(pedestal_part(made)), at(foot_part(FOOT), made.seat)
    assert (body ^ foot).volume() < 1e-14
    assert body.min_gap(foot, 0.01) == pytest.approx(0.0, abs=1e-9)
    where = FOOT.placement.inverse()
    for part in housing_parts(HOUSING):
        assert body.min_gap(at(part, where, made.seat), 0.01) > 1e-3
    cylinder = part_manifold(Part("driver", 1.0, (hollow_cylinder(0.0, radius, made.base, 0.3),)))
    for x, y in made.holes:
        driver = cylinder.translate((x, y, 0.0))
        assert (body ^ driver).volume() < 1e-15
        head = driver.trim_by_plane((0.0, 0.0, -1.0), -(made.base + TRUNK_SCREW.head_height))
        assert (foot ^ head).volume() < 1e-15


def test_is_as_thick_as_it_must_be():
    made, heavy = pedestal(LEANS[1]), 3.0
    light, thick = strengthened(made, 0.01), strengthened(made, heavy)
    assert (light.thickness, light.base) == (LEAST_SEAT, BASE_THICKNESS)
    assert thick.thickness > LEAST_SEAT
    assert thick.base > BASE_THICKNESS
    # A tenth of a millimetre less of either is too little.
    for thinner in (
        replace(thick, thickness=thick.thickness - 1.01e-4),
        replace(thick, base=thick.base - 1.01e-4),
    ):
        assert pedestal_use(thinner, heavy) > 1.0
    # The section modulus of the seat goes with the square.
    four = strengthened(made, 4.0 * heavy)
    assert four.thickness == pytest.approx(2.0 * thick.thickness, abs=2e-4)
    # All loads are proportional to the mass.
    assert pedestal_use(thick, 2.0) == pytest.approx(2.0 * pedestal_use(thick, 1.0))


@EACH_LEAN
def test_wheel_is_as_high_as_asked(lean):
    above = pedestal(lean).wheel[2] + 4e-3
    assert strengthened(pedestal(lean), 2.0, above).wheel[2] == pytest.approx(above)


def test_screws_of_the_seat_fit_the_slots():
    cuts = pedestal_part(pedestal(LEANS[2])).cut
    holes = [cut.shape.centre for cut in cuts if cut.placement.position[1] != 0.0]
    assert len(holes) == 2
    for x, y in holes:
        assert np.hypot(x, y) == pytest.approx(FOOT.slot_radius)
        assert abs(abs(np.arctan2(y, x)) % (np.pi / 2.0)) == pytest.approx(np.pi / 4.0)


@EACH_LEAN
def test_the_seat_gives_way_as_a_beam_that_is_integrated(lean):
    """Mohr: the integral of the moment times that of a unit load, over E I, along the seat."""
    made = strengthened(pedestal(lean), 2.0)
    a, whole, high = made.middle, made.length, made.wheel_height
    # The middle of each of many equal pieces; none is where the couple is.
    at = (np.arange(200_000) + 0.5) * whole / 200_000
    near = at < a
    of_force = np.where(near, at * (whole - a) / whole, a * (whole - at) / whole)
    of_couple = np.where(near, -at / whole, 1.0 - at / whole)
    bent = PETG.modulus * made.width * made.thickness**3 / 12.0
    square, along = seat_compliance(made)
    assert square == pytest.approx(float(np.mean(of_force**2)) * whole / bent, rel=1e-4)
    assert along == pytest.approx(float(np.mean(of_couple**2)) * whole * high**2 / bent, rel=1e-4)
