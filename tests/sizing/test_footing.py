"""Support of the feet: contact in closed form on a box, plates, posts, pedestals and masts."""

import re
from dataclasses import replace
from itertools import combinations, cycle, pairwise, product
from math import acos, hypot, pi, sqrt

import msgspec
import numpy as np
import pytest
import urdf_text as urdf
from coarse_masts import coarse_mast_search
from designed_devices import design_with_motor
from robots import ROBOTS
from subsets import fast_subset
from wheels import driven_device, stand_on_trunk

from ocs_design.actuation.tilt_inertia import TiltInertia
from ocs_design.common.errors import Infeasible, OcsError
from ocs_design.device.bodies import wheel_placement
from ocs_design.device.checks import check_device
from ocs_design.device.device import Module
from ocs_design.device.layout import PAIR, Layout, LayoutName
from ocs_design.device.solids import module_solids, plate_heads, plate_solids
from ocs_design.export.assembly.placed import placed_parts
from ocs_design.export.device_parts import foot_holes, wheel_pieces
from ocs_design.export.meshes import part_manifold
from ocs_design.parts.carrier_plate import ALUMINIUM, MAST_YIELD, SAFETY, STOCK, plate_bodies
from ocs_design.parts.pedestal import pedestal_part
from ocs_design.parts.plate_strength import mast_screws_use, mast_stress, plate_stresses, posts_use
from ocs_design.parts.printed import TRUNK_SCREW
from ocs_design.parts.shapes import Disc, Rectangle
from ocs_design.parts.solids import Part, Prism, Revolution, hollow_cylinder
from ocs_design.requirement.device_sections import MotorSection, OcsSection
from ocs_design.requirement.froude import default_envelope
from ocs_design.requirement.phrases import Tilt
from ocs_design.requirement.sections import RequirementSection, RobotSection
from ocs_design.requirement.specification import Specification
from ocs_design.requirement.sweep import Task
from ocs_design.robot.collision import collision_model
from ocs_design.robot.manual import robot_by_hand
from ocs_design.robot.reader import read_robot
from ocs_design.robot.surface import trunk_surface
from ocs_design.sizing.design import design_device
from ocs_design.sizing.footing.contact import FLATNESS
from ocs_design.sizing.footing.feet import device_size, feet_of
from ocs_design.sizing.footing.on_top import LATERAL_OFFSETS
from ocs_design.sizing.footing.plate import POST_SCREW, support_at
from ocs_design.sizing.footing.standing import footing_of
from ocs_design.sizing.free_place import place_free, place_on_top
from ocs_design.sizing.mounting import contacts_of, mounting_of, mounting_open_points
from ocs_design.sizing.place import SPACING

DEVICE = driven_device()
FOOT = DEVICE.foot
TOP = 0.05

REAL = [
    "solo_description/robots/solo12",
    "a1_description/urdf/a1",
    "go2_description/urdf/go2",
    "bolt_description/robots/bolt",
    "anymal_c_simple_description/urdf/anymal",
]


@pytest.fixture
def read(tmp_path):
    """Reads the text of a URDF whose trunk is `base`."""

    def read_text(text):
        (tmp_path / "robot.urdf").write_bytes(text)
        return read_robot(tmp_path / "robot.urdf", trunk="base")

    return read_text


def box(x, y, z, xyz="0 0 0"):
    return urdf.solid(f'<box size="{x} {y} {z}"/>', xyz)


@pytest.fixture
def boxed(read):
    """Robots whose trunk is a box 0.1 m high, with further collision shapes."""
    inertial = urdf.inertial(10, "0.1 0.4 0.4")
    return lambda width, length=0.6, more="": read(
        urdf.robot(urdf.link("base", inertial, box(length, width, 0.1), more))
    )


def pair_at(offset, up=0.0):
    """The device with its feet at +-`offset` to the sides and `up` above the trunk's top [m]."""
    place = np.array([0.0, offset, TOP + FOOT.wheel_height + up])
    places = place, place * [1.0, -1.0, 1.0]
    modules = map(Module, PAIR.names, PAIR.axes(DEVICE.incidence).T, places)
    return replace(DEVICE, modules=tuple(modules))


def placed_on(robot, layout, base=DEVICE, angle=DEVICE.incidence):
    """The device in another layout, placed on a robot, with a support where there is one."""
    centers = place_on_top(robot, layout).centers(device_size(base))
    modules = tuple(map(Module, layout.names, layout.axes(angle).T, centers))
    return stand_on_trunk(replace(base, modules=modules, layout=layout), robot, specified=False)


def mounting_without_faults(robot, device):
    """Mounting of a valid device, whose feet are all held and which clears all limbs."""
    check_device(device)
    mounting = mounting_of(robot, device, (), robot.mass_properties)
    assert mounting_open_points(mounting) == ()
    assert all(contact.held for contact in mounting.feet)
    assert mounting.nearest.distance > 0.0
    return mounting


def plate_stress(plate, device):
    return plate_stresses(plate, np.array([plate.thickness]), device.module_mass, FOOT.wheel_height)


def survives_json(plate):
    return msgspec.json.decode(msgspec.json.encode(plate), type=type(plate)) == plate


def test_the_contact_share_is_that_of_a_circle_cut_by_a_line(boxed):
    robot = boxed(0.3)
    for inside in np.linspace(-0.9, 0.9, 9).tolist():
        offset = 0.15 - inside * FOOT.base_radius
        share = 1.0 - (acos(inside) - inside * sqrt(1.0 - inside**2)) / pi
        for contact in contacts_of(robot, pair_at(offset)):
            assert contact.share == pytest.approx(share, abs=0.03 if inside else 0.02)
            assert inside > 0.0 or (contact.held, contact.gap) == (False, np.inf)


@pytest.mark.parametrize(
    ("up", "held"), [(0.0, True), (0.5 * FLATNESS, True), (2.0 * FLATNESS, False)]
)
def test_a_foot_in_the_air_is_not_held(boxed, up, held):
    for contact in contacts_of(boxed(0.6), pair_at(0.1, up)):
        assert contact.held == held
        assert contact.gap == pytest.approx(up, abs=1e-9)


@pytest.mark.parametrize(("over", "at_screws"), [(0.5, "nothing"), (0.0, "2 mm")])
def test_incomplete_contact_of_a_foot_is_reported(boxed, over, at_screws):
    """Half over the edge, or all screws over a gap of 2 mm around a raised disc."""
    step = 0.2 * FOOT.base_radius
    more = "".join(
        urdf.solid(f'<cylinder radius="{step}" length="0.002"/>', f"0 {side * 0.1} 0.051")
        for side in (1.0, -1.0)
    )
    robot = boxed(0.2 if over else 0.6, more="" if over else more)
    device = pair_at(0.1, 0.0 if over else 0.002)
    (point,) = mounting_open_points(mounting_of(robot, device, (), robot.mass_properties))
    match = re.fullmatch(
        r"left foot, right foot: (\d+)% of the underside touches the trunk; (.*)", point.what
    )
    assert 0 < int(match[1]) < 100
    assert match[2].startswith("under screws there is" if over else "at screws the gap is up to")
    assert match[2].endswith(at_screws)


def test_a_foot_inside_the_trunk_is_reported(boxed):
    robot = boxed(0.6)
    device = pair_at(0.1, -0.004)
    mounting = mounting_of(robot, device, (), robot.mass_properties)
    assert mounting.feet[0].interference == pytest.approx(0.004)
    assert "reaches 4 mm above" in mounting_open_points(mounting)[0].what


def test_on_a_wide_trunk_there_is_no_plate(boxed):
    robot = boxed(0.6)
    device = stand_on_trunk(pair_at(0.1, 0.02), robot, specified=False)
    assert device.plate is None
    assert device.modules[0].position[2] == pytest.approx(TOP + FOOT.wheel_height)
    assert all(contact.held for contact in contacts_of(robot, device))


@pytest.mark.parametrize(("width", "heavier"), [(0.05, 1.0), (0.1, 1.0), (0.13, 1.0), (0.1, 30.0)])
def test_on_a_narrow_trunk_a_plate_carries_both_feet(boxed, width, heavier):
    robot, carrier = boxed(width), DEVICE.carrier
    unsupported = replace(pair_at(0.1), carrier=replace(carrier, mass=heavier * carrier.mass))
    device = stand_on_trunk(unsupported, robot, specified=False)
    plate = device.plate
    assert plate.position[2] == pytest.approx(TOP)
    assert device.modules[0].position[2] == pytest.approx(plate.top + FOOT.wheel_height)
    assert device.mass == pytest.approx(unsupported.mass + plate.mass)
    assert (plate.thickness > STOCK[0]) == (heavier > 1.0)
    assert all(contact.held for contact in contacts_of(robot, device))
    allowed = ALUMINIUM.strength / SAFETY
    assert plate_stress(plate, device) <= allowed
    thinner = [replace(plate, thickness=each) for each in STOCK if each < plate.thickness]
    assert all(plate_stress(each, device) > allowed for each in thinner)


@pytest.mark.parametrize("width", [0.1, 0.6])
def test_two_pairs_stand_on_the_trunk_or_on_a_plate_each(boxed, width):
    """Mirrored in the sagittal plane, with equal orientations in front and at the back."""
    robot, layout = boxed(width), Layout(LayoutName.DOUBLE_PAIR)
    device = placed_on(robot, layout)
    assert (device.plate is None) == (width == 0.6)
    if device.plate is not None:
        assert len(device.plate.rows) == 2
        assert len(device.plate.trunk) == len(device.plate.feet) == 8
    mounting_without_faults(robot, device)
    front_left, front_right, back_left, _ = (each.position for each in device.modules)
    np.testing.assert_allclose(front_right, front_left * [1.0, -1.0, 1.0], atol=1e-12)
    assert back_left[0] < front_left[0]
    frames = [each.frame for each in device.modules]
    np.testing.assert_allclose(frames, layout.frames(DEVICE.incidence), atol=1e-12)
    np.testing.assert_allclose(frames[:2], [each.frame for each in DEVICE.modules], atol=1e-12)


@pytest.mark.parametrize("count", [3, 6])
def test_a_ring_of_modules_stands_on_one_plate(boxed, count):
    """On a trunk narrower than the plate: threads for each foot, two screws for each arm."""
    robot = boxed(0.13)
    angles = np.radians(90.0 + 360.0 / count * np.arange(count))
    axes = np.stack([np.cos(angles), np.sin(angles), 0.0 * angles], axis=1).round(15) + 0.0
    device = placed_on(robot, Layout(LayoutName.BY_HAND, tuple(map(tuple, axes.tolist()))))
    plate = device.plate
    assert plate.arms == count
    assert len(plate.trunk) in {count, 2 * count}
    assert len(mounting_without_faults(robot, device).feet) == count + len(plate.trunk)
    holes = [hole for each in foot_holes(device).values() for hole in each]
    screws = np.array(plate.feet) + plate.position[:2]
    nearest = np.linalg.norm(screws[:, None] - np.array(holes), axis=2).min(axis=1)
    np.testing.assert_allclose(nearest, 0.0, atol=1e-6)
    assert plate_stress(plate, device) <= ALUMINIUM.strength / SAFETY
    assert survives_json(plate)


def test_a_bump_is_bridged_by_sleeves(boxed):
    robot = boxed(0.1, more=urdf.solid('<sphere radius="0.006"/>', "0 0 0.05"))
    device = stand_on_trunk(pair_at(0.1), robot, specified=True)
    # The feet stay at their specified height, where the bump leaves no room for a plate.
    assert device.plate is None
    higher = stand_on_trunk(pair_at(0.1, 0.012), robot, specified=True)
    assert max(higher.plate.sleeves) == pytest.approx(0.012 - higher.plate.thickness, abs=1e-4)
    assert all(contact.held for contact in contacts_of(robot, higher))


@coarse_mast_search()
def test_a_trunk_too_narrow_for_four_screws_carries_no_plate(boxed):
    robot = boxed(0.012, length=0.3)
    device = stand_on_trunk(pair_at(0.1), robot, specified=False)
    assert device.plate is None
    (point,) = mounting_open_points(mounting_of(robot, device, (), robot.mass_properties))
    assert point.what.startswith("the feet hang in the air")
    assert "--position" in point.cure


def test_without_shapes_of_the_robot_contact_is_unknown():
    robot = robot_by_hand(2.5, (0.03, 0.05, 0.07))
    device = stand_on_trunk(pair_at(0.1), robot, specified=False)
    assert device is not None
    assert [contact.held for contact in contacts_of(robot, device)] == [None, None]


def test_wheels_without_feet_have_no_contacts(boxed):
    bare = replace(DEVICE, carrier=replace(DEVICE.carrier, mass=0.0))
    assert contacts_of(boxed(0.2), bare) == ()
    assert stand_on_trunk(bare, boxed(0.2), specified=False) is bare


def test_the_selection_counts_the_plate_of_the_largest_modules(boxed):
    robot = boxed(0.1)
    footing = footing_of(robot, default_envelope(robot))
    carried = footing.added_to(robot.mass_properties)
    assert carried.mass == pytest.approx(robot.mass + footing.plate.mass)
    assert footing.place.origins[0][2] == pytest.approx(TOP + footing.plate.thickness)
    wide = boxed(1.0)
    assert (
        footing_of(wide, default_envelope(wide)).place
        == place_free(wide, default_envelope(wide)).place
    )


@pytest.mark.parametrize("name", [LayoutName.ORTHOGONAL, LayoutName.PYRAMID])
def test_tilted_modules_stand_on_pedestals_that_the_mass_counts(boxed, name):
    """Each foot lies on its seat. A second pass changes nothing; raised modules are not held."""
    robot, layout = boxed(0.8, length=0.8), Layout(name)
    angle = layout.angle or 0.0
    device = placed_on(robot, layout, replace(DEVICE, incidence=angle), angle)
    pedestal_mass = sum(each.mass for each in device.pedestals)
    assert device.mass == pytest.approx(len(layout) * DEVICE.module_mass + pedestal_mass)
    assert pedestal_mass > 0.0
    modules = {module.name: module for module in device.modules}
    for each in device.pedestals:
        module, seat = modules[each.module], each.placement @ each.seat
        assert each.position[2] == pytest.approx(TOP, abs=1e-6)
        np.testing.assert_allclose(seat.rotation[:, 1:], module.frame[:, 1:], atol=1e-9)
        middle = module.position - FOOT.wheel_height * module.frame[:, 2]
        np.testing.assert_allclose(seat.position, middle, atol=1e-9)
    again = stand_on_trunk(device, robot, specified=False)
    assert again.pedestals == device.pedestals
    assert all(contact.held for contact in contacts_of(robot, device))
    raised = tuple(
        replace(module, position=np.add(module.position, [0.0, 0.0, 0.002]))
        for module in device.modules
    )
    assert not any(contact.held for contact in contacts_of(robot, replace(device, modules=raised)))
    # Specified inside the trunk, where no pedestal fits.
    low = [replace(module, position=np.zeros(3)) for module in device.modules]
    sunk = stand_on_trunk(replace(device, modules=tuple(low), pedestals=()), robot, specified=True)
    assert sunk.pedestals == ()
    assert not any(contact.held for contact in contacts_of(robot, sunk))
    assert check_device(device) is None
    (other, *rest) = device.pedestals
    with pytest.raises(OcsError, match="a module that does not exist"):
        check_device(replace(device, pedestals=(replace(other, module="none"), *rest)))


@pytest.mark.parametrize(
    ("name", "layout"),
    fast_subset(3, zip(REAL, cycle((LayoutName.PAIR, LayoutName.TRIAD)), strict=False)),
)
def test_modules_are_held_and_do_not_collide_on_real_robots(name, layout):
    """At any wheel angle: bodies are the cylinders that they sweep."""
    robot = read_robot(ROBOTS / f"{name}.urdf")
    device = placed_on(robot, Layout(layout))
    assert mounting_without_faults(robot, device).known
    between = collision_model(robot).between
    solids = [module_solids(device, module) for module in device.modules]
    for one, other in combinations(solids, 2):
        assert min(between(*each) for each in product(one.all, other.all)) > 0.0
    heads = plate_heads(device.plate)
    for module in solids:
        assert all(between(head, solid) > 0.0 for head in heads for solid in module.all)
        # A foot stands on its plate.
        for solid in module.foot:
            nearest = min(between(disc, solid) for disc in plate_solids(device.plate))
            assert nearest == pytest.approx(0.0, abs=1e-6)


def with_motor():
    """A designed device with a real motor."""
    _, design = design_with_motor("Antigravity MN5006 KV450", alpha_criterion="lightest")
    return design.device


def swept(part):
    """Volume swept by a part in a full turn about its axis: off-axis holes are filled."""
    return replace(part, holes=tuple(each for each in part.holes if isinstance(each, Revolution)))


def solids_of(device):
    """Solids of modules, plate and screw heads in place; rotating ones are swept volumes."""
    turning = wheel_pieces(device.flywheel)
    solids = {
        (module.name, name): solid.transform(np.column_stack([place.rotation, place.position]))
        for name, (part, own) in placed_parts(device).items()
        for solid in (part_manifold(swept(part) if name in turning else part, 96),)
        for module in device.modules
        for place in (wheel_placement(module) @ own,)
    }
    bodies = () if device.plate is None else plate_bodies(device.plate)
    for number, (part, own) in enumerate(bodies):
        at = own.position + device.plate.position
        solids["plate", number] = part_manifold(part, 96).transform(
            np.column_stack([own.rotation, at])
        )
    for number, head in enumerate(plate_heads(device.plate)):
        drum = hollow_cylinder(0.0, head.radius, -head.height / 2.0, head.height / 2.0)
        solid = part_manifold(Part("head", 1.0, (drum,)), 96)
        solids["head", number] = solid.translate(head.center)
    return solids


def block(x, y, z):
    """A box between two coordinates along each axis [m]."""
    return part_manifold(Part("block", 1.0, (Prism(Rectangle(*x, *y), *z),)), 96)


def assert_disjoint(solids):
    overlapping = [
        (one, other)
        for one, other in combinations(solids, 2)
        if (solids[one] ^ solids[other]).volume() > 1e-12
    ]
    assert overlapping == []


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "width"),
    [
        *((name, 0.12) for name in list(LayoutName) if name not in {"by-hand", "pyramid"}),
        (LayoutName.ORTHOGONAL, 0.6),
        (LayoutName.PYRAMID, 0.6),
    ],
)
def test_no_two_solids_of_any_layout_overlap_over_a_full_turn(boxed, name, width):
    robot, layout = boxed(width), Layout(name)
    angle = 0.5 if layout.angle is None else layout.angle
    device = placed_on(robot, layout, with_motor(), angle)
    stands = layout.stands(angle)
    upright = stands.all()
    is_held = upright or width > 0.5
    assert len(device.pedestals) == (0 if width < 0.5 else (~stands).sum())
    assert (device.plate is not None) == (upright and len(layout) > 1)
    assert (
        mounting_open_points(mounting_of(robot, device, (), robot.mass_properties)) == ()
    ) == is_held
    solids = solids_of(device)
    for each in device.pedestals:
        where = np.column_stack([each.placement.rotation, each.placement.position])
        solids["pedestal", each.module] = part_manifold(pedestal_part(each), 96).transform(where)
        radius, high = TRUNK_SCREW.head_diameter / 2.0, each.base + TRUNK_SCREW.head_height
        heads = tuple(Prism(Disc(radius, hole), each.base, high) for hole in each.holes)
        solids["heads", each.module] = part_manifold(Part("heads", 1.0, heads), 96).transform(where)
    if is_held:
        solids["trunk", ""] = block((-0.3, 0.3), (-width / 2.0, width / 2.0), (-TOP, TOP))
    assert_disjoint(solids)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "width"), [(LayoutName.PAIR, 0.12), (LayoutName.DOUBLE_PAIR, 0.5)]
)
def test_modules_on_both_sides_of_an_arm_over_the_trunk(read, name, width):
    """No part of any module, nor a plate under the arm, overlaps the arm."""
    base = urdf.inertial(20, "0.3 0.6 0.6") + box(0.6, width, 0.1)
    arm = urdf.inertial(1, "0.01 0.01 0.01") + box(0.6, 0.06, 0.06)
    robot = read(urdf.topped(base, arm, "0 0 0.13", "0 1 0"))
    device = placed_on(robot, Layout(name), with_motor(), 0.5)
    assert (device.plate is not None) == (width < 0.5)
    mounting_without_faults(robot, device)
    (aside,) = {round(float(abs(each.position[1])), 9) for each in device.modules}
    reach = SPACING * device_size(device).reach
    assert min(abs(aside - reach - each) for each in LATERAL_OFFSETS) < 1e-9
    arm = block((-0.3, 0.3), (-0.03, 0.03), (0.1, 0.16))
    assert max((solid ^ arm).volume() for solid in solids_of(device).values()) < 1e-12
    # Spheres around the modules, which are as close as possible, would touch the arm.
    up = float(device.modules[0].position[2])
    assert hypot(reach - 0.03, up - max(0.1, min(0.16, up))) < reach


BARS = np.arange(-0.14, 0.15, 0.07).round(3).tolist()
"""x of bars across a trunk, 100 mm high, with 60 mm between them: too narrow for a module."""


def bars(high, places=BARS):
    """Shapes of bars of this height on the trunk [m]."""
    return "".join(box(0.01, 0.24, high, f"{x} 0 {TOP + high / 2.0}") for x in places)


@pytest.mark.parametrize(("thickness", "length"), [(12e-3, 0.2), (15e-3, None)])
def test_posts_are_limited_by_the_longest_screws(boxed, monkeypatch, thickness, length):
    """170 mm posts, 15.2 mm threads and a 12 mm plate need M8 x 200; no screw fits 15 mm."""
    monkeypatch.setattr("ocs_design.sizing.footing.plate.STOCK", (thickness,))
    robot = boxed(0.24, 0.32, bars(0.17))
    _, plate = support_at(trunk_surface(robot), feet_of(pair_at(0.1)), None, (POST_SCREW,))
    assert (plate and plate.screw_lengths[0]) == length


@pytest.mark.parametrize(("up", "thickness"), [(0.0325, 3e-3), (0.0335, 4e-3), (0.0345, 5e-3)])
def test_at_a_specified_height_a_thicker_plate_has_shorter_sleeves(boxed, up, thickness):
    """Sleeves of up to 30 mm and the plate make up the height of the feet above the trunk."""
    feet, robot = feet_of(pair_at(0.1)), boxed(0.24, 0.32)
    height, plate = support_at(trunk_surface(robot), feet, TOP + up)
    assert height == pytest.approx(TOP + up)
    assert plate.thickness == thickness
    assert plate.sleeves == pytest.approx((up - thickness,) * 4)


@pytest.mark.parametrize(("high", "stands"), [(0.0335, True), (0.034, False)])
def test_beside_a_plate_the_trunk_may_reach_the_top_of_the_plate(boxed, high, stands):
    """Modules begin above the plate. Walls stand in front of the feet and behind them."""
    feet, up = feet_of(pair_at(0.1)), 0.0335
    distance = feet.reach + 0.003
    surface = trunk_surface(boxed(0.24, 0.32, bars(high, (distance, -distance))))
    _, plate = support_at(surface, feet, TOP + up)
    assert (plate is not None) == stands
    assert plate is None or plate.thickness == 4e-3


@pytest.mark.slow
def test_over_bars_across_the_trunk_a_plate_stands_on_posts(boxed):
    """The posts are strong enough, count in its mass, and overlap neither bars nor modules."""
    robot = boxed(0.24, 0.32, bars(0.1))
    device = placed_on(robot, PAIR, with_motor(), 0.5)
    plate = device.plate
    assert plate.thread == "M8"
    assert plate.sleeves == (pytest.approx(0.1, abs=1e-4),) * 4
    assert plate.position[2] == pytest.approx(TOP + 0.1, abs=1e-4)
    mounting_without_faults(robot, device)
    feet = feet_of(device)
    assert posts_use(plate, feet.mass, feet.height) <= 1.0
    stress = plate_stresses(plate, np.array([plate.thickness]), feet.mass, feet.height)
    assert stress <= ALUMINIUM.strength / SAFETY
    assert survives_json(plate)
    # Its mass includes tubes of 17 mm by 9 mm.
    tubes = 4 * 0.1 * plate.density * pi / 4.0 * (0.017**2 - 0.009**2)
    screws = sum(plate.screw.mass(length) for length in plate.screw_lengths)
    assert plate.mass > tubes + screws
    solids = solids_of(device)
    boxes = [block((-0.16, 0.16), (-0.12, 0.12), (-TOP, TOP))]
    boxes += [block((x - 0.005, x + 0.005), (-0.12, 0.12), (TOP, TOP + 0.1)) for x in BARS]
    assert max((each ^ box).volume() for each in solids.values() for box in boxes) < 1e-9
    assert_disjoint(solids)


@pytest.fixture
def column(read):
    """Trunks with a head on top that leaves no room for a device."""
    head = urdf.inertial(2, "0.01 0.01 0.01") + box(0.2, 0.3, 0.2)

    def of_width(width=0.14):
        return read(
            urdf.topped(urdf.inertial(20, "0.3 0.3 0.1") + box(0.12, width, 0.3), head, "0 0 0.3")
        )

    return of_width


@pytest.mark.parametrize("name", fast_subset(2, [LayoutName.DOUBLE_PAIR, LayoutName.PAIR]))
def test_without_room_on_top_a_mast_carries_the_device(column, name):
    robot, layout = column(), Layout(name)
    device = placed_on(robot, layout, angle=0.5)
    plate, mass, height = device.plate, device.module_mass, FOOT.wheel_height
    assert plate.mast is not None
    assert len(plate.heights) == layout.pairs
    mounting = mounting_without_faults(robot, device)
    assert all(each.share > 0.9 for each in mounting.feet if each.name.startswith("mast"))
    assert survives_json(plate)
    assert mast_stress(plate, mass, height) <= MAST_YIELD
    assert plate_stress(plate, device) <= MAST_YIELD
    assert mast_screws_use(plate, mass, height) <= 1.0
    # At any incidence, modules clear the tube between them and the arms above.
    tube, reach = plate.mast, device_size(device).reach
    lateral = plate.across - tube.side / 2.0
    assert tube.back < plate.across
    assert reach <= hypot(lateral, tube.back)
    for below, above in pairwise(plate.heights):
        middle = below + plate.thickness + height
        assert reach <= hypot(lateral, above - tube.side - middle)
    # Screws are on the flat back, 6 cm behind the middle, with the modules behind them.
    for place in plate.screw_places:
        x, y, z = place.position + np.array(plate.position)
        assert (x, abs(z) < 0.15, abs(y) < 0.07) == (pytest.approx(-0.06), True, True)
    assert max(module.position[0] for module in device.modules) < -0.06


STRONG = "U12 II KV120"
"""The motor that comes closest."""


def falling(height, robot):
    """Requirement and design for a column that falls from a height [m] tilted by 30 degrees."""
    requirement = RequirementSection(fall=(height,), tilt=(Tilt(0.0, pi / 6.0),), reliability=0.5)
    specification = Specification(
        robot=RobotSection(file=robot.source, trunk="base"),
        requirement=requirement,
        motor=MotorSection(name=STRONG),
        ocs=OcsSection(layout="pair", alpha_criterion="lightest"),
    )
    task = Task.of(specification, robot)
    return task.resolved, design_device(task)


@pytest.mark.slow
def test_the_sizing_counts_the_mast(column):
    """A motor is infeasible because of its mast; a feasible device turns its mast in time too."""
    robot = column()
    with pytest.raises(Infeasible) as caught:
        falling(0.62, robot)
    mount = re.match(r"With a mount of (.*) kg on the trunk: Motor U12 II", caught.value.message)
    assert float(mount[1]) == pytest.approx(caught.value.problem.robot.mass - robot.mass, rel=1e-3)
    resolved, design = falling(0.66, robot)
    total, (fall,) = design.sized.total, resolved.requirement.maneuvers
    assert total.mass == pytest.approx(robot.mass + design.device.mass)
    assert design.device.plate.mast is not None
    # The turn accelerates for half of the angle and brakes for half, at the peak torque at most.
    time = fall.slew(TiltInertia.uncoupled(np.diag(total.inertia)[:2])).duration
    torque = 2.0 * np.cos(design.device.incidence) * design.choice.chosen.motor.peak_torque
    assert time >= 2.0 * sqrt(total.inertia[1, 1] * pi / 6.0 / torque)


@pytest.mark.slow
@coarse_mast_search()
def test_the_flat_spots_that_a_mast_needs_are_reported(column):
    """A back too narrow for two screws side by side; one just wide enough carries a mast."""
    narrow = column(0.01)
    device = stand_on_trunk(DEVICE, narrow, specified=False)
    assert device.plate is None
    mounting = mounting_of(narrow, device, (), narrow.mass_properties)
    pads, points = mounting.pads, mounting_open_points(mounting)
    assert any(f"for a mast's {pads.screw} screws" in point.cure for point in points)
    wide = column(pads.aside + pads.diameter + 2e-3)
    masted = stand_on_trunk(DEVICE, wide, specified=False)
    assert masted.plate.mast is not None
    assert mounting_of(wide, masted, (), wide.mass_properties).pads is None
