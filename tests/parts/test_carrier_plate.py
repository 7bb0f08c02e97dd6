"""Plates, posts and masts under the feet: mass of their meshes, strength and frequency."""

import io
from dataclasses import replace
from math import pi

import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st
from naive_outline import area_moments, as_area_moments

from ocs_design.actuation.fasteners import screw
from ocs_design.common.units import MILLIMETRES
from ocs_design.export.assembly.content import tightened
from ocs_design.export.meshes import part_manifold, part_mesh
from ocs_design.export.stl import stl_bytes
from ocs_design.parts.carrier_plate import (
    ALUMINIUM,
    STOCK,
    TUBES,
    CarrierPlate,
    Mast,
    mast_part,
    plate_bodies,
    plate_part,
    sleeve_part,
)
from ocs_design.parts.dog_bone import FILLET, DogBone, directions
from ocs_design.parts.joints import screw_use
from ocs_design.parts.plate_strength import (
    bending_stress,
    mast_screws_use,
    mast_stress,
    plate_frequency,
    plate_screws_use,
    plate_stresses,
    plate_sway,
    posts_use,
    twisting_stress,
)
from ocs_design.parts.printed import SHOCK
from ocs_design.robot.mass import combine, physical_defect


def plate_stress(plate, mass, height):
    return float(plate_stresses(plate, np.array([plate.thickness]), mass, height)[0])


def plate_of(radius, across, thickness, sleeve=0.0, neck=0.018, arms=2):
    slot = radius - 6e-3
    offset, lateral = slot / np.sqrt(2.0), neck - 8e-3
    along = 0.012 if arms == 2 else 0.03
    arm_directions = directions(arms).tolist()
    signs = (1, -1)
    feet = [
        (across * x + s * offset, across * y + s * offset) for x, y in arm_directions for s in signs
    ]
    trunk = [
        (along * x + s * lateral * y, along * y - s * lateral * x)
        for x, y in arm_directions
        for s in signs
    ]
    return CarrierPlate(
        position=(0.01, 0.0, 0.1),
        radius=radius,
        half_length=across + radius,
        neck=neck,
        thickness=thickness,
        across=across,
        window=slot - 6e-3,
        feet=tuple(feet),
        trunk=tuple(trunk),
        sleeves=(sleeve,) * 2 * arms,
        arms=arms,
    )


plates = st.builds(
    plate_of,
    st.just(0.03),
    st.floats(0.06, 0.2),
    st.sampled_from(STOCK),
    st.sampled_from([0.0, 0.005, 0.02]),
    arms=st.sampled_from([2, 3, 4]),
)


@settings(max_examples=25, deadline=None)
@given(plates)
def test_the_mass_is_that_of_mesh_sleeves_and_screws(plate):
    """One piece with five holes per arm: a window, two threads and two holes for screws."""
    part = plate_part(plate)
    body = part_manifold(part, 48)
    assert len(body.decompose()) == 1
    assert body.genus() == 5 * plate.arms
    assert body.volume() * part.density == pytest.approx(part.mass(), rel=1e-9)
    sleeves = sum(sleeve_part(plate, each).mass() for each in plate.sleeves if each)
    screws = sum(plate.screw.mass(length) for length in plate.screw_lengths)
    assert plate.mass == pytest.approx(part.mass() + sleeves + screws)
    total = plate.mass_properties()
    assert physical_defect(total) is None
    # Arms are equal.
    np.testing.assert_allclose(total.com[:2], [0.01, 0.0], atol=1e-12)
    if plate.arms > 2:
        assert total.inertia[0, 0] == pytest.approx(total.inertia[1, 1])


def test_strength_of_an_arm_does_not_depend_on_the_number_of_arms():
    """Each is a cantilever at its own two screws."""
    pair, star = (plate_of(0.03, 0.1, 4e-3, arms=arms) for arms in (2, 3))
    pair = replace(pair, trunk=tuple((x, np.sign(y) * 0.03) for x, y in pair.trunk))
    assert star.support == pytest.approx(pair.support)
    assert plate_stress(star, 0.4, 0.05) == pytest.approx(plate_stress(pair, 0.4, 0.05))
    assert plate_frequency(star, 0.4) == pytest.approx(plate_frequency(pair, 0.4))
    np.testing.assert_allclose(star.sizes, [0.1 * 3**0.5 + 0.06, 0.15 + 0.06, 4e-3])


def test_plates_of_two_pairs_are_two_plates():
    """Each has its own screws: the weaker one decides, and their masses add up."""
    front = plate_of(0.03, 0.08, 4e-3, sleeve=0.01)
    # Its screws are closer to the middle, so that the modules bend it more.
    back = replace(front, trunk=tuple((x, y / 2.0) for x, y in front.trunk))
    rows = (0.1, -0.1)
    plates = list(zip(rows, (front, back), strict=True))
    trunk = tuple((row + x, y) for row, plate in plates for x, y in plate.trunk)
    feet = tuple((row + x, y) for row, plate in plates for x, y in plate.feet)
    both = replace(front, rows=rows, trunk=trunk, feet=feet, sleeves=(0.01,) * 8)
    total = both.mass_properties()
    expected = combine(
        plate.mass_properties().moved(np.eye(3), [row, 0.0, 0.0]) for row, plate in plates
    )
    assert total.mass == pytest.approx(expected.mass, rel=1e-12)
    np.testing.assert_allclose(total.com, expected.com, atol=1e-12)
    np.testing.assert_allclose(total.inertia, expected.inertia, atol=1e-12)
    assert plate_stress(both, 0.5, 0.06) == pytest.approx(plate_stress(back, 0.5, 0.06), rel=1e-12)
    assert plate_frequency(both, 0.5) == pytest.approx(plate_frequency(back, 0.5), rel=1e-12)
    assert plate_stress(back, 0.5, 0.06) > plate_stress(front, 0.5, 0.06)
    assert len(part_manifold(plate_part(both), 48).decompose()) == 2


bones = st.builds(
    lambda radius, neck, beyond, x, arms: DogBone(
        radius, (2.0 + beyond + 0.5 * (arms - 2)) * radius, neck * radius, x, arms
    ),
    st.floats(0.01, 0.06),
    st.floats(0.2, 0.95),
    st.floats(0.0, 4.0),
    st.sampled_from([0.0, -0.1]),
    st.integers(2, 6),
).filter(lambda bone: bone.fits)


@given(bones)
def test_moments_of_a_bone_are_those_of_its_outline(bone):
    area, first, second = as_area_moments(bone.moments)
    exact_area, exact_first, exact_second = area_moments(bone.outline())
    size = bone.half_length + abs(bone.x)
    assert area == pytest.approx(exact_area, rel=1e-9)
    np.testing.assert_allclose(first, exact_first, atol=1e-9 * area * size)
    np.testing.assert_allclose(second, exact_second, atol=1e-9 * area * size**2)


@given(bones)
def test_the_integral_of_the_width_is_the_area(bone):
    """For each arm, whose hub is a triangle."""
    along = (np.arange(20000) + 0.5) / 20000 * bone.half_length
    widths = bone.half_width(along) * np.minimum(1.0, along / max(bone.hub, 1e-9))
    area = 2.0 * bone.arms * widths.mean() * bone.half_length
    assert area == pytest.approx(bone.area, rel=2e-4)
    assert bone.half_width(np.array([-1.01, 1.01]) * bone.half_length).tolist() == [0.0, 0.0]


@settings(max_examples=25)
@given(bones)
def test_the_points_inside_of_a_bone_cover_its_area(bone):
    step = bone.half_length / 200.0
    steps = (np.arange(-200, 200) + 0.5) * step
    middle = np.array([bone.x, 0.0])
    points = np.stack(np.meshgrid(steps, steps), axis=-1).reshape(-1, 2) + middle
    assert bone.holds(points).sum() * step**2 == pytest.approx(bone.area, rel=0.02)


@given(bones)
def test_fillets_are_tangent_to_neck_and_disc(bone):
    """The centre of each is at a distance of its radius from both."""
    (x, y), f = bone.meets, bone.fillet
    centre = np.array([bone.neck + f, bone.straight])
    assert 0.0 < f <= FILLET
    assert bone.straight >= bone.hub - 1e-12
    assert np.hypot(*(centre - [x, y])) == pytest.approx(f)
    assert np.hypot(x, y - bone.across) == pytest.approx(bone.radius)
    assert np.hypot(*(centre - [0.0, bone.across])) == pytest.approx(bone.radius + f)


def test_a_cantilever_by_hand():
    """0.3 kg at 20 g, 40 mm out, on 60 mm by 3 mm: M = 2.354 N m, W = 90 mm^3, 26.15 MPa."""
    assert bending_stress(0.3, 0.04, 0.06, 3e-3) == pytest.approx(26.15e6, rel=1e-3)


def test_a_twisted_strip_by_hand():
    """T = 2.942 N m on 30 mm by 3 mm: 3 T / (w t^2) = 32.69 MPa, times 1.0681 for t/w = 0.1.

    Saint-Venant's factor for sides in a ratio of ten: T = 0.312 w t^2 tau.
    """
    stress = twisting_stress(0.3, 0.05, 0.03, 3e-3)
    assert stress == pytest.approx(1.0681 * 32.69e6, rel=1e-3)
    assert stress == pytest.approx(2.942 / (0.312 * 0.03 * 9e-6), rel=2e-3)


def test_stress_of_a_plate_is_that_of_its_narrowest_section():
    """Neck of 36 mm less two holes of 3.4 mm: 29.2 mm, at the screws 12 mm off the middle."""
    plate = plate_of(0.03, 0.07, 3e-3)
    assert plate.net_width(np.array([0.012])) == pytest.approx([0.036 - 2.0 * 3.4e-3])
    # At the centre of a foot: a disc less its window.
    assert plate.net_width(np.array([0.07])) == pytest.approx([2.0 * (0.03 - 0.018)])
    down = bending_stress(0.3, 0.07 - 0.012, 0.0292, 3e-3)
    assert plate_stress(plate, 0.3, 0.01) == pytest.approx(down)
    sideways = bending_stress(0.3, 0.1, 0.0292, 3e-3)
    assert plate_stress(plate, 0.3, 0.1) == pytest.approx(sideways)


def test_a_thin_ring_around_the_window_is_weaker():
    """A window that leaves 2 mm on either side makes the ring the weakest section."""
    plate = replace(plate_of(0.03, 0.07, 3e-3), window=0.028)
    distance = 0.02
    width = 2.0 * (np.sqrt(0.03**2 - distance**2) - np.sqrt(0.028**2 - distance**2))
    assert plate_stress(plate, 0.3, 0.01) >= bending_stress(0.3, distance, width, 3e-3)
    assert plate_stress(plate, 0.3, 0.01) > plate_stress(plate_of(0.03, 0.07, 3e-3), 0.3, 0.01)


def test_a_plate_of_one_width_swings_as_a_cantilever():
    """sqrt(3 E I / m L^3) from the outermost screws, whose holes are behind the section."""
    plate = plate_of(0.03, 0.09, 0.004, neck=0.03)
    plain = replace(plate, window=0.0, feet=(), trunk=((0.0, -0.02),))
    arm = 0.09 + 0.02
    second = 0.06 * 0.004**3 / 12.0
    expected = np.sqrt(3.0 * 69e9 * second / (0.7 * arm**3)) / (2.0 * pi)
    assert plate_frequency(plain, 0.7) == pytest.approx(expected, rel=2e-3)
    assert plate_frequency(replace(plain, thickness=0.008), 0.7) == pytest.approx(
        8.0**0.5 * plate_frequency(plain, 0.7)
    )


def plate_on_mast(pairs=2, sleeve=0.004, spacer=0.02, side=0.05, wall=0.003):
    """Two modules on each plate, the plates above each other behind a trunk."""
    plate = plate_of(0.03, 0.11, 0.006, neck=0.025)
    return replace(
        plate,
        feet=plate.feet * pairs,
        trunk=((0.012, 0.02), (-0.012, 0.02), (0.012, 0.06), (-0.012, 0.06)),
        sleeves=(sleeve,) * 4,
        thread="M6",
        rows=(0.0,) * pairs,
        levels=tuple(0.28 * row for row in range(pairs)),
        mast=Mast(side, wall, 0.17, side, 0.3, 0.2, spacer),
    )


@pytest.mark.parametrize("pairs", [1, 2])
@pytest.mark.parametrize("spacer", [0.0, 0.02])
def test_the_mass_of_a_mast_is_that_of_its_mesh(pairs, spacer):
    plate = plate_on_mast(pairs, spacer=spacer)
    part = mast_part(plate, plate.mast)
    solid = part_manifold(part, 96)
    assert part.mass() == pytest.approx(part.density * solid.volume(), rel=1e-3)
    bodies = list(plate_bodies(plate))
    assert sorted(body.name for body, _ in bodies) == ["mast", "plate", *["sleeve"] * 8]
    screws = 4 * plate.screw.mass(plate.screw_lengths[0])
    assert plate.mass == pytest.approx(sum(body.mass() for body, _ in bodies) + screws)
    assert physical_defect(plate.own_mass_properties()) is None
    # Sleeves start at the block and end at the trunk.
    (first, *_) = plate.screw_places
    assert first.position[0] == plate.mast.face + spacer
    np.testing.assert_allclose(first.rotation[:, 2], [-1.0, 0.0, 0.0])


@pytest.mark.parametrize("spacer", [0.0, 0.02])
def test_the_stl_of_a_mast_is_one_closed_body(spacer):
    """Its genus: the tube, open at both ends, and four screws through two walls each."""
    rng = np.random.default_rng(0)
    for side, wall in TUBES:
        low, face, distance = rng.uniform((-0.05, 0.1, 0.2), (0.05, 0.2, 0.3))
        base = plate_on_mast(pairs=2, spacer=spacer, side=side, wall=wall)
        trunk = tuple((s * 0.3 * side, low + up) for up in (0.0, 0.03) for s in (1, -1))
        # The upper arm is flush with the end of the tube, as where no screw is above it.
        mast = replace(base.mast, face=face, below=max(side, 0.02 - low), high=distance)
        plate = replace(base, thread="M4", trunk=trunk, levels=(0.0, distance), mast=mast)
        mesh = part_mesh(mast_part(plate, mast))
        file = io.BytesIO(stl_bytes(mesh, "mast", MILLIMETRES))
        solid = trimesh.load_mesh(file, file_type="stl")
        assert solid.is_watertight and solid.is_winding_consistent
        assert solid.body_count == 1
        assert (2 - solid.euler_number) // 2 == 1 + 8


def test_a_square_tube_by_hand():
    """40 x 3 mm: I = (40^4 - 34^4) / 12 = 101,972 mm^4; 100 N m bend it with 19.6 MPa."""
    tube = Mast(0.04, 0.003, 0.1, 0.0, 0.1, 0.0)
    assert tube.second_moment == pytest.approx(101972e-12)
    assert tube.stress(100.0, 0.0) == pytest.approx(100.0 * 0.02 / 101972e-12)
    # Bredt: 100 / (2 x 3 mm x 37^2 mm^2), times sqrt(3) for von Mises.
    assert tube.stress(0.0, 100.0) == pytest.approx(np.sqrt(3.0) * 100.0 / (6e-3 * 0.037**2))


def test_a_screw_of_class_8_8_by_hand():
    """M6, 20.1 mm^2: 0.9 x 800 / 1.25 in tension, 11.6 kN, and 0.6 x 800 / 1.25 in shear."""
    m6 = screw("M6")
    assert screw_use(m6, 11590.0, 0.0) == pytest.approx(1.0, rel=2e-3)
    assert screw_use(m6, 0.0, 7730.0) == pytest.approx(1.0, rel=2e-3)
    assert screw_use(m6, 5795.0, 3865.0) == pytest.approx(0.5 / 1.4 + 0.5, rel=2e-3)


@given(st.floats(0.5, 4.0), st.floats(1.1, 2.0))
def test_loads_of_a_mast_are_proportional_to_the_mass_of_its_modules(mass, factor):
    plate = plate_on_mast()
    for figure in (mast_stress, mast_screws_use):
        assert figure(plate, factor * mass, 0.1) == pytest.approx(factor * figure(plate, mass, 0.1))
    stronger = replace(plate, thread="M8")
    assert mast_screws_use(stronger, mass, 0.1) < mast_screws_use(plate, mass, 0.1)
    wider = replace(plate, mast=replace(plate.mast, wall=0.005))
    assert mast_stress(wider, mass, 0.1) < mast_stress(plate, mass, 0.1)
    assert plate_frequency(wider, mass) > plate_frequency(plate, mass)


def test_screws_of_a_plate_by_hand():
    """Two modules of 3 kg at 20 g push with 1177 N, 140 mm above the trunk: 164.8 N m.

    Sideways that is a tension of 686 N in each of four M3 60 mm off the middle line, forward of
    2746 N at 15 mm; the shear is 294 N each. 5.03 mm^2 of 800 MPa carry 0.9 / 1.25 of that in
    tension and 0.6 / 1.25 in shear: 2897 and 1931 N.
    """
    holes = tuple((x, y) for y in (0.06, -0.06) for x in (0.015, -0.015))
    plate = replace(plate_of(0.03, 0.12, 0.01), trunk=holes)
    used = plate_screws_use(plate, 3.0, 0.13)
    assert used == pytest.approx(max(2746 / 2897, 2746 / 2897 / 1.4 + 294.2 / 1931), rel=2e-3)
    assert plate_screws_use(plate, 6.0, 0.13) == pytest.approx(2.0 * used)
    assert plate_screws_use(replace(plate, thread="M5"), 3.0, 0.13) < 0.4 * used
    both = replace(plate, rows=(0.1, -0.1), trunk=holes * 2, sleeves=plate.sleeves * 2)
    assert plate_screws_use(both, 3.0, 0.13) == pytest.approx(used)


def test_sleeves_of_a_plate_by_hand():
    """7.4 mm by 3.4 mm: 33.9 mm^2, 38.0 mm^3. Modules of 3 kg at 20 g push with 1177 N.

    Each of four sleeves of 30 mm is bent by 294 N x 15 mm, 116 MPa, and compressed by the tension
    of the screws on the other side, 294 N x 170 mm / 60 mm, 25 MPa; or, at 30 mm, 49 MPa.
    """
    holes = tuple((x, y) for y in (0.06, -0.06) for x in (0.03, -0.03))
    plate = replace(plate_of(0.04, 0.12, 0.01), trunk=holes, sleeves=(0.03, 0.0, 0.0, 0.0))
    area, section, _ = plate.sleeve_section
    assert (1e6 * area, 1e9 * section) == pytest.approx((33.93, 38.0), rel=1e-2)
    stress = 294.2 * (0.015 / section + 0.17 / 0.03 / area)
    assert plate_screws_use(plate, 3.0, 0.13) == pytest.approx(stress / 120e6, rel=1e-3)
    short = replace(plate, sleeves=(0.002,) * 4)
    assert plate_screws_use(short, 3.0, 0.13) < plate_screws_use(plate, 3.0, 0.13) / 2.0


@given(plates, st.floats(0.1, 5.0))
def test_screws_of_a_plate_balance_the_moment_of_the_shock(plate, mass):
    """Their tension is proportional to the distance from the middle line."""
    used = plate_screws_use(plate, mass, 0.1)
    x = np.array(plate.trunk)[:, 0]
    moment = plate.arms * mass * SHOCK * (0.1 + plate.thickness + max(plate.sleeves))
    tension = moment * np.abs(x).max() / (x @ x)
    assert used >= tension / (0.9 / 1.25 * 800e6 * screw(plate.thread).stress_area) / 1.4


def on_posts(gap=0.15, p=0.015, q=0.06):
    plate = plate_of(0.03, 0.12, 0.01)
    holes = tuple((x, y) for y in (q, -q) for x in (p, -p))
    return replace(plate, thread="M8", sleeve_wall=5e-3, trunk=holes, sleeves=(gap,) * 4)


@pytest.mark.parametrize("forward", [True, False])
def test_posts_sway_as_four_beams_under_a_rigid_plate_do(forward):
    """By the stiffness matrix of clamped beams, for a plate that translates and rotates."""
    gap, height, mass = 0.15, 0.13, 3.0
    p, q = (0.015, 0.06) if forward else (0.06, 0.015)
    plate = on_posts(gap, p, q)
    second, area = pi / 64.0 * (0.019**4 - 0.009**4), pi / 4.0 * (0.019**2 - 0.009**2)
    bending = np.array([[12.0, -6.0 * gap], [-6.0 * gap, 4.0 * gap**2]])
    bending *= ALUMINIUM.modulus * second / gap**3
    stretch = ALUMINIUM.modulus * area / gap * min(p, q) ** 2
    stiffness = 4.0 * (bending + np.diag([0.0, stretch]))
    # The force acts at the wheels' height above the ends of the posts.
    lever = np.array([1.0, plate.thickness + height])
    compliance = lever @ np.linalg.solve(stiffness, lever)
    expected = 1.0 / (2.0 * pi * np.sqrt(2.0 * mass * compliance))
    assert plate_sway(plate, mass, height) == pytest.approx(expected, rel=1e-9)
    assert plate_sway(replace(plate, sleeves=(0.0,) * 4), mass, height) == np.inf


def test_posts_by_hand():
    """19 mm by 9 mm: 220 mm^2, 639.5 mm^3; two of 3 kg at 20 g are 1176.8 N on four posts.

    Each is bent by 294.2 N x 75 mm and under a tension of 294.2 N x 215 mm / 15 mm.
    """
    plate = on_posts()
    area, section, _ = plate.sleeve_section
    assert (1e6 * area, 1e9 * section) == pytest.approx((219.91, 639.5), rel=1e-4)
    force = 294.2
    stress = force * 0.075 / 639.5e-9 + force * 0.215 / 0.015 / 219.9e-6
    # M8 of class 8.8: 0.9 x 640 MPa x 36.6 mm^2 / 1.132, friction 0.12; a torque wrench gives at
    # least 1 / 1.6 of that (VDI 2230-1).
    preload = 18.62e3 / 219.9e-6
    shares = 1.6 * stress / preload, stress / 127.5e6, (stress + preload) / 255e6
    assert posts_use(plate, 3.0, 0.13) == pytest.approx(max(shares), rel=5e-3)
    (fastening,) = plate.fastenings
    bolt = fastening.screw
    assert tightened(fastening).torque == pytest.approx(bolt.torque(bolt.preload))
    assert fastening.length == plate.screw_lengths[0]
    two = replace(plate, rows=(0.1, -0.1), trunk=plate.trunk * 2, sleeves=plate.sleeves * 2)
    assert plate_screws_use(two, 3.0, 0.13) == pytest.approx(posts_use(plate, 3.0, 0.13))
    assert posts_use(on_posts(p=0.025), 3.0, 0.13) < posts_use(plate, 3.0, 0.13)
    assert posts_use(on_posts(gap=0.1), 3.0, 0.13) < posts_use(plate, 3.0, 0.13)
