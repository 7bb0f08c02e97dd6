"""The pedestal under a foot that leans, from nearly flat to upright."""

from dataclasses import replace

import numpy as np
import pytest
import trimesh
from made_parts import FOOT, HOUSING

from ocs_design.export.meshes import part_manifold, part_mesh
from ocs_design.parts.foot import BASE_THICKNESS, TRUNK_SCREW, Foot, foot_part
from ocs_design.parts.housing import Housing, housing_parts
from ocs_design.parts.pedestal import (
    FLANGE_SCREW,
    HEAD_TOP,
    LEAST_SEAT,
    Pedestal,
    drilled,
    pedestal_part,
    pedestal_use,
    seat_thickness,
)
from ocs_design.parts.printed import MountHoles
from ocs_design.parts.solids import Prism, hollow_cylinder

LEANS = np.radians([25.0, np.degrees(np.arctan(np.sqrt(0.5))), 60.0, 90.0])


def pedestal(lean: float) -> Pedestal:
    # Far enough up the seat for a module with nothing behind its plate.
    return Pedestal(FOOT, lean, FOOT.base_radius + 5e-3)


def at(part, *placements):
    body = part_manifold(part)
    for where in placements:
        body = body.transform(np.column_stack([where.rotation, where.position]))
    return body


@pytest.mark.parametrize("lean", LEANS)
def test_weighs_what_its_mesh_does(lean):
    part = pedestal_part(pedestal(lean))
    mesh, exact = part_mesh(part), part.mass_properties()
    found = trimesh.Trimesh(mesh.vertices, mesh.triangles)
    assert found.is_watertight
    found.density = part.density
    assert exact.mass == pytest.approx(found.mass, rel=1e-9)
    np.testing.assert_allclose(exact.com, found.center_mass, atol=1e-10)
    np.testing.assert_allclose(exact.inertia, found.moment_inertia, atol=1e-9 * exact.inertia.max())


@pytest.mark.parametrize("lean", LEANS)
def test_holes_lie_within_it_and_do_not_overlap(lean):
    part = drilled(pedestal(lean))
    # Circles as polygons of their own area.
    assert part_manifold(part).volume() * part.density == pytest.approx(part.mass(), rel=1e-9)


def test_arrays_weigh_what_each_does():
    radii = np.array([0.02, 0.03, 0.05])

    def of(radius):
        foot = Foot(Housing(radius, radius / 3.0, MountHoles(0.0 * radius)))
        return pedestal_part(Pedestal(foot, LEANS[1], foot.base_radius)).moments()

    whole, alone = of(radii), [of(float(radius)) for radius in radii]
    for name in ("mass", "y", "z", "xx", "yy", "zz", "yz"):
        expected = [getattr(each, name) for each in alone]
        np.testing.assert_allclose(getattr(whole, name), expected, rtol=1e-12)


@pytest.mark.parametrize("lean", LEANS)
def test_foot_lies_on_the_seat_and_housing_is_clear(lean):
    made = pedestal(lean)
    body = at(drilled(made))
    foot = at(foot_part(FOOT), made.seat)
    assert (body ^ foot).volume() < 1e-14
    assert body.min_gap(foot, 0.01) == pytest.approx(0.0, abs=1e-9)
    where = FOOT.placement.inverse()
    for part in housing_parts(HOUSING):
        assert body.min_gap(at(part, where, made.seat), 0.01) > 1e-3


@pytest.mark.parametrize("lean", LEANS)
def test_driver_reaches_every_screw_of_the_base(lean):
    """Before the foot is on: a cylinder as wide as the head, straight up."""
    made, radius = pedestal(lean), TRUNK_SCREW.head_diameter / 2.0
    body = at(drilled(made))
    foot = at(foot_part(FOOT), made.seat)
    for x in (-made.off, made.off):
        for y in (-FLANGE_SCREW, made.length + FLANGE_SCREW):
            driver = part_manifold(
                replace(
                    drilled(made),
                    solids=(hollow_cylinder(0.0, radius, BASE_THICKNESS, 0.3),),
                    holes=(),
                )
            ).translate((x, y, 0.0))
            assert (body ^ driver).volume() < 1e-15
            head = driver.trim_by_plane((0.0, 0.0, -1.0), -HEAD_TOP)
            assert (foot ^ head).volume() < 1e-15


def test_seat_is_as_thick_as_it_must_be():
    made = pedestal(LEANS[1])
    heavy = 3.0
    thick = replace(made, thickness=seat_thickness(made, heavy))
    assert thick.thickness > LEAST_SEAT
    assert seat_thickness(made, 0.01) == LEAST_SEAT
    # The section modulus goes with the square.
    assert seat_thickness(made, 4.0 * heavy) == pytest.approx(2.0 * thick.thickness, abs=2e-4)
    # So thick, the seat is not what breaks first: the flanges are.
    assert pedestal_use(thick, heavy) > 1.0
    # All loads are proportional to the mass.
    assert pedestal_use(thick, 2.0) == pytest.approx(2.0 * pedestal_use(thick, 1.0))


def test_screws_of_the_seat_fit_the_slots():
    slots = [cut for cut in foot_part(FOOT).cut[:2] if isinstance(cut, Prism)]
    made = pedestal(LEANS[2])
    holes = [cut.shape.centre for cut in drilled(made).cut if cut.placement.position[1] != 0.0]
    assert len(holes) == len(slots) == 2
    for x, y in holes:
        assert np.hypot(x, y) == pytest.approx(FOOT.slot_radius)
        assert abs(abs(np.arctan2(y, x)) % (np.pi / 2.0)) == pytest.approx(np.pi / 4.0)
