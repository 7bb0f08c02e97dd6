"""The assembly booklet: it is complete, legible and agrees with the device."""

import re
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from built_devices import CAGED, DEVICES, MAST_PLATE, device_in_layout, housed_device, in_two_rows
from hypothesis import given
from hypothesis import strategies as st
from wheel_drawings import box_of, check_words
from wheel_drawings import texts as texts_of
from wheels import paper_device

from ocs_design.actuation.supply import Supply
from ocs_design.catalogue.materials import materials
from ocs_design.common.units import rpm
from ocs_design.device.bodies import carrier_placement, wheel_placement
from ocs_design.device.joints import balance_of, burst_of, rim_fit, yield_margin
from ocs_design.device.layout import Layout, LayoutName
from ocs_design.device.records.flights import Margin
from ocs_design.device.resonances import resonances_of
from ocs_design.export.assembly.booklet import assembly_pages, chapters, piece_rows, screw_rows
from ocs_design.export.assembly.content import Assembly
from ocs_design.export.assembly.views import BALLOON, pulled_apart, spread
from ocs_design.export.assembly_notes import trunk_threads
from ocs_design.export.bill_of_materials import bill_rows
from ocs_design.export.device_parts import pedestal_kinds
from ocs_design.export.drawing.sheet import FRAME_BOX, THIN, Circle, Lettering, Line, Polyline
from ocs_design.export.electrics import wiring, wiring_parts
from ocs_design.parts.pedestal import Pedestal
from ocs_design.parts.printed import WALL

BOTTOM = FRAME_BOX[3]

AT_30_DEGREES, TRIAD = (
    DEVICES["caged"].at_incidence(np.pi / 6.0),
    device_in_layout(Layout(LayoutName.TRIAD)),
)


@pytest.fixture(params=DEVICES, ids=str, scope="module")
def assembly(request):
    return Assembly("solo12", DEVICES[request.param])


def test_sheets_are_legible_within_their_frames(assembly):
    """Large figures are written out."""
    assert not re.search(r"\de[+]", " ".join(all_texts(assembly)))
    for page in assembly_pages(assembly):
        check_words(page)
        # No balloon is level with the caption below its view.
        numbers = [item.center for item in page if isinstance(item, Circle) and item.radius > 1.0]
        for caption in (text for text in texts_of(page) if re.search(r", 1:\d", text.text)):
            _, high, _, low = box_of(caption)
            assert not [y for _, y in numbers if high - BALLOON < y < low + BALLOON]
        for item in page:
            match item:
                case Polyline(points):
                    ends = points
                case Line(start, end):
                    ends = (start, end)
                case Circle(center):
                    ends = (center,)
                case _:
                    continue
            assert all(0.0 <= x <= 297.0 and 0.0 <= y <= 210.0 for x, y in ends)


def all_texts(assembly):
    return [text for chapter in chapters(assembly) for text in chapter.texts]


def texts(assembly, title):
    """Text of the chapters whose titles start with `title`."""
    matching = [chapter for chapter in chapters(assembly) if chapter.title.startswith(title)]
    assert matching
    return " ".join(text for chapter in matching for text in chapter.texts)


@pytest.mark.parametrize("name", ["caged", "by its face"])
def test_the_sense_of_a_positive_torque_is_given_as_seen_from_the_lid(name):
    """Right-handed about the axis: counter-clockwise when seen against the axis. The lid is on the
    side of the module that is away from the motor."""
    device = DEVICES[name]
    (text,) = (text for text in all_texts(Assembly("dog", device)) if "positive torque" in text)
    pieces = {piece.key: piece for piece in Assembly("dog", device).pieces}
    lid, motor = (pieces[key].mesh.vertices.mean(axis=0) for key in ("lid", "motor"))
    for module in device.modules:
        placed = wheel_placement(module) @ carrier_placement(module)
        view = placed.rotation @ (lid - motor)
        sense = "counter-clockwise" if view @ module.axis > 0.0 else "clockwise"
        match = re.search(
            rf"(?<![\w-])({'counter-clockwise|clockwise'}): [^;]*ocs_{module.name}", text
        )
        assert match.group(1) == sense


def test_the_sweep_lists_the_modes_and_warns_near_one():
    """Response r^2 / |1 - r^2| of U / m beside a mode; the stiffness grows with thickness^3."""
    device = DEVICES["on a plate"]
    device = replace(device, motor=replace(device.motor, no_load_speed=3e3, speed_max=None))
    plate = next(mode for mode in resonances_of(device) if mode.name == "plate")
    speed = 1.07 * 2.0 * np.pi * plate.frequency
    margins = (Margin("wheel speed", speed, 3e3, "rad/s"),)
    text = texts(Assembly("solo12", device, margins), "Sweep")
    assert f"from standstill to {rpm(speed)}" in text
    for mode in resonances_of(device):
        assert f"{mode.name} {60.0 * mode.frequency:,.0f} rpm" in text
    match = re.search(r"is 7% above the plate's mode: .* with ([\d.]+) times .* with (\S+) t", text)
    at_speed, at_mode = map(float, match.groups())
    square, mass = 1.07**2, device.module_mass
    expected = balance_of(device).unbalance / mass * square / (square - 1.0) * speed**2 / 9.80665
    assert at_speed == pytest.approx(expected, rel=0.06)
    assert at_mode == pytest.approx(plate.acceleration / 9.80665, rel=0.06)
    thickness = device.plate.thickness
    stiffer = float(
        re.search(r"make the plate 4 mm thick.*?: ([\d,]+) rpm", text)[1].replace(",", "")
    )
    assert stiffer == pytest.approx(60.0 * plate.frequency * (4e-3 / thickness) ** 1.5, rel=1e-3)
    # Without flights the sweep goes up to the top speed.
    unflown = texts(Assembly("solo12", device), "Sweep")
    assert f"to {rpm(3e3)}, its top speed, in about" in unflown
    assert "of the maneuvers" not in unflown
    # Far from all modes there is no warning, and without modes no sweep.
    higher = (Margin("wheel speed", 2.0 * speed, 3e3, "rad/s"),)
    assert "above the" not in texts(Assembly("solo12", device, higher), "Sweep")
    slow = replace(device, motor=replace(device.motor, no_load_speed=10.0))
    assert "Sweep" not in {chapter.title[:5] for chapter in chapters(Assembly("solo12", slow))}


def test_every_screw_of_the_bill_is_numbered_and_has_a_torque(assembly):
    bought = [
        (row.part.removeprefix("screw "), row.quantity)
        for row in bill_rows(assembly.device)
        if row.part.startswith("screw")
    ]
    rows = list(screw_rows(assembly))
    assert sorted((row.designation, row.quantity) for row in rows) == sorted(bought)
    assert all(re.fullmatch(r"\d.*N m", row.torque) for row in rows)
    numbers = [row.number for row in piece_rows(assembly)]
    assert numbers == list(range(1, len(numbers) + 1))


def test_the_booklet_of_a_device_on_a_mast():
    """The mast has the holes for the trunk's screws, and the table of pieces fits its sheet."""
    device = replace(DEVICES["in a guard ring"], plate=MAST_PLATE)
    assembly = Assembly("dog", device, (), (), "NOT buildable as it stands. It hangs in the air.")
    first = assembly_pages(assembly)[0]
    check_words(first)
    lines = [item for item in first if isinstance(item, Line) and item.pen is THIN]
    assert max(line.end[1] for line in lines) < BOTTOM - 1.0
    steps = texts(replace(assembly, refused=""), "Steps")
    assert "with their tops 90.0 mm below and level with the upright's" in steps


@pytest.mark.parametrize(("length", "shims"), [(0.0007, True), (0.002, False)])
def test_a_sleeve_thinner_than_a_millimetre_may_be_washers(length, shims):
    device = DEVICES["on a plate"]
    plate = replace(device.plate, sleeves=(0.0, length, length, 0.0045))
    text = texts(Assembly("solo12", replace(device, plate=plate)), "Steps")
    assert "stand sleeves" in text
    assert ("Shim washers do for those under 1 mm" in text) == shims


def test_the_plate_is_under_the_foot_with_its_screws_and_sleeves():
    """Assembled, its top is at the foot's underside; exploded, the pieces are below each other."""
    assembly = Assembly("solo12", DEVICES["on a plate"])
    rows = {row.name: (row.quantity, row.file) for row in piece_rows(assembly)}
    assert rows["plate under the feet"] == (1, "plate.pdf")
    assert rows["sleeves around the trunk's screws"] == (3, "")
    screws = [row for row in screw_rows(assembly) if row.purpose.startswith("plate")]
    assert [row.quantity for row in screws] == [1, 2, 1]

    def low_and_high(pieces, name):
        """Height of the underside and of the top."""
        named = [piece for piece in pieces if name in (piece.key, getattr(piece.key, "name", ""))]
        meshes = [piece.mesh for piece in named]
        heights = np.concatenate([mesh.vertices[:, 1] for mesh in meshes])
        return -heights.max(), -heights.min()

    placed, apart = assembly.pieces, pulled_apart(assembly.pieces, 0.02)
    assert low_and_high(placed, "plate")[1] == pytest.approx(low_and_high(placed, "foot")[0])
    for above, below in pairwise(("foot on plate", "plate on trunk", "plate", "sleeves")):
        assert low_and_high(apart, above)[0] > low_and_high(apart, below)[1]
    text = texts(assembly, "Steps")
    assert "4.50 mm at" in text
    assert "into the threads of the plate" in text
    assert "its holes leave 0.2 mm around the screws, and paper is less exact" in text


@pytest.mark.parametrize("outwards", [0.0, 0.008])
def test_all_plates_are_made_each_to_its_sheet(outwards):
    """Once the booklet had one plate made, as on ANYmal C, whose front and rear plates differ."""
    device = DEVICES["on a plate"]
    both = replace(device, plate=in_two_rows(device.plate, outwards))
    text = texts(Assembly("anymal", both), "Steps")
    assert re.search(r"Make the 2 plates \(\d+\) to cad/plate\.pdf", text)
    assert "under their other 8 holes" in text
    assert "Drill and tap one of those under each plate by the template" in text
    row = next(row for row in bill_rows(both) if row.piece == "plate")
    assert row.quantity == 2
    for words in (text, row.remark):
        assert ("a sheet for each kind" in words) == bool(outwards)


def test_screws_that_the_motor_turns_in_their_play_are_bedded():
    """Heads press on PETG with half of 47 MPa; a torque wrench leaves 1 / 1.6 of that, and a
    friction coefficient of 0.1 holds 1.5 times the torque."""
    device = DEVICES["caged"]

    def held(head, hole, radius):
        return 0.1 * 4.0 * np.pi / 4.0 * (head**2 - hole**2) * 47e6 / 2.0 / 1.6 * radius

    cage, ears = device.mount.cage, device.mount.holes.screws
    by_motor = held(5.5e-3, 3.4e-3, CAGED.mounting.stator.radius)
    by_cage = held(3.8e-3, 2.4e-3, ears.radius)
    assert cage is not None
    least, most = sorted((by_motor, by_cage))
    for torque, count in ((0.99 * least, 0), (1.01 * least, 1), (1.01 * most, 2)):
        strong = replace(device, motor=replace(device.motor, torque_limit=torque / 1.5))
        text = texts(Assembly("dog", strong), "Steps")
        assert text.count("fill their holes in the prints with epoxy") == count
        assert ("Scotch-Weld" in " ".join(row.part for row in bill_rows(strong))) == (count > 0)
    assert f"no more than {by_motor:.2g} of the motor's" in text
    turned = 180.0 / np.pi * 0.4e-3 / ears.radius
    assert f"the motor turns by {turned:.2g} deg back and forth" in text


@pytest.mark.parametrize(("angle", "filed"), [(0.0, True), (10.0, False)])
def test_a_washer_at_the_end_of_a_slot_is_filed_where_it_meets_the_stem(angle, filed):
    """Slots are made for heads of 5.5 mm with 1.6 mm around them; a washer is up to 9 mm wide."""
    device = DEVICES["on a plate"].at_incidence(np.radians(angle))
    motor = replace(device.motor, mass=1.5)
    heavy = replace(device, motor=motor, carrier=replace(device.carrier, mass=1.6))
    assert heavy.foot_hold.washers
    text = texts(Assembly("dog", heavy), "Steps")
    assert ("File a side of its washer flat: the foot's stem is 4.3" in text) == filed
    light = texts(Assembly("dog", device), "Steps")
    assert "washer flat" not in light


def test_exploded_pieces_do_not_touch():
    pieces = Assembly("solo12", DEVICES["caged"]).pieces
    apart = [piece for piece in pulled_apart(pieces, 0.02) if piece.drop is None]
    for lower, upper in pairwise(apart):
        if "foot" not in (lower.key, upper.key):
            assert lower.mesh.vertices[:, 2].max() < upper.mesh.vertices[:, 2].min()


@given(st.lists(st.floats(0.0, 200.0), max_size=15))
def test_numbers_keep_their_distance(positions):
    places = spread(sorted(positions), 8.0, (0.0, 200.0))
    assert np.all(np.diff(places) >= 8.0 - 1e-9)
    assert all(place <= 200.0 for place in places)


def test_the_guard_text_has_the_wall_that_would_hold_a_burst_rim():
    device = DEVICES["caged"]
    assembly = Assembly("solo12", device)
    text, burst = texts(assembly, "Safety"), burst_of(device)
    assert assembly.top_speed == 650.4
    assert "It does not hold a burst rim" in text
    # The written wall is rounded up, so that it holds.
    (ring,) = re.findall(r"a ring of ([\d.]+) mm of mild steel", text)
    (outer,) = re.findall(r"behind it ([\d.]+) mm of 6061-T6", text)
    for written, wall in ((ring, burst.steel), (outer, burst.aluminium)):
        assert 0.0 <= float(written) - 1e3 * wall < 0.1
    # The mass is that of the written wall.
    mass, inner, width = re.search(
        r"in the drum, (\d+) g each \(([\d.]+) mm inside, ([\d.]+) mm wide", text
    ).groups()
    area = np.pi * float(ring) * (float(inner) + float(ring))
    assert float(mass) == pytest.approx(7.85e-3 * area * float(width), abs=0.6)
    energy = 0.5 * device.flywheel.spin_inertia * 650.4**2
    assert f"Each wheel stores {energy:.3g} J at 6,211 rpm, 2 of them {2 * energy:.3g} J" in text


@pytest.mark.parametrize("wall", [0.0, 1.5e-3, 2.5e-3])
def test_the_guard_text_covers_a_full_battery(wall):
    """The controller limits the speed by the nominal voltage; at 110 % of it a fragment has 1.1^2
    of the energy and needs 1.1^(4/3) of the wall.
    """
    device = replace(DEVICES["in a guard ring"], guard_wall=wall)
    text, burst = texts(Assembly("solo12", device), "Safety"), burst_of(device)
    speed, volts = device.motor.no_load_speed, device.motor.bus_voltage
    assert f"which computes with {volts:g} V, drives no wheel past 6,211 rpm" in text
    match = re.search(
        r"battery with 110% .*? to ([\d,]+) rpm, .*? has (\d+) J; .*? takes (\S+)", text
    )
    rpm, energy, steel = (float(number.replace(",", "")) for number in match.groups())
    assert rpm == pytest.approx(1.1 * speed * 30.0 / np.pi, abs=0.6)
    assert energy == pytest.approx(1.21 * burst.fragment.energy, rel=0.02)
    assert 0.0 <= steel - 1e3 * 1.1 ** (4.0 / 3.0) * burst.steel < 0.1
    enough = "and the ring built in is thick enough" in text
    assert enough == (1e3 * wall >= steel - 0.1 and wall > 0.0)
    assert ("built in is too thin" in text) == (wall > 0.0 and not enough)


def test_a_guard_ring_is_built_and_described_with_its_limits():
    device = DEVICES["in a guard ring"]
    assembly = Assembly("solo12", device)
    text, wall = texts(assembly, "Safety"), burst_of(device).steel
    assert device.guard_wall >= wall
    assert "The guard ring of 1.5 mm holds that piece" in text
    assert "no ring of this kind has been tested" in text
    rows = {row.name: row for row in piece_rows(assembly)}
    assert rows["guard ring"].file == "guard_ring.pdf"
    # The gap between ring and drum is for epoxy, which is on the bill.
    pieces = {piece.key: piece.mesh for piece in assembly.pieces}
    drum = device.foot.housing.inner_radius
    assert drum - pieces["guard"].vertices[:, 0].max() == pytest.approx(0.1e-3, abs=5e-5)
    assert "0.1 mm all around, down to its floor" in texts(assembly, "Steps")
    bill = {row.part: row for row in bill_rows(device)}
    assert bill["epoxy 3M Scotch-Weld DP760"].remark.startswith("guard ring in drum and around")
    assert f"outside {2e3 * (drum - 0.1e-3):.2f} (0/-0.2)" in bill["guard ring"].remark
    thin = texts(Assembly("solo12", replace(device, guard_wall=wall / 2.0)), "Safety")
    assert "It does not hold a burst rim" in thin


def test_the_balance_text_has_residual_unbalance_and_effect_of_holes():
    """U = m 6.3 mm/s / w."""
    device = DEVICES["caged"]
    text, balance = texts(Assembly("solo12", device), "Balance"), balance_of(device)
    assert f"at most {1e6 * device.flywheel.mass * 6.3e-3 / 650.4:.2g} g mm" in text
    holes, rim = balance.correction, device.flywheel
    pair = 2.0 * np.pi * holes.hole_radius**2 * holes.depth * rim.density
    radius = (rim.inner_radius + rim.outer_radius) / 2.0
    assert f"pair this deep removes {1e3 * pair:.2g} g, or {1e6 * pair * radius:.2g} g mm" in text
    assert f"drill of {2e3 * holes.hole_radius:.1f} mm, at most {1e3 * holes.depth:.1f} mm" in text
    assert balance.centred_by in text


def test_the_current_limit_of_the_controller_is_within_the_fuse():
    device = replace(DEVICES["caged"], supply=Supply(24.0, current_max=500.0, power_max=12000.0))
    margins = (Margin("bus current, drawn", 103.2, 500.0, "A"),)
    text = " ".join(wiring(device, margins))
    (fuse,) = (purpose for name, _, purpose in wiring_parts(device, margins) if "fuse" in name)
    assert "set that limit to no less than 104 A" in text
    assert "switch: 104 A" in fuse
    assert "the next usual rating is 125 A" in fuse


def test_the_unbalance_held_by_friction_is_given():
    """Friction holds an unbalance of its torque over g on level blades."""
    device = DEVICES["caged"]
    motor = replace(device.motor, no_load_current=0.9, torque_constant=0.0212)
    text = texts(Assembly("solo12", replace(device, motor=motor)), "Balance")
    assert (
        f"friction alone holds up to {1e6 * 0.9 * 0.0212 / 9.80665:.2g}".replace("1.9e+03", "1900")
        in text
    )
    motor = replace(motor, no_load_current=None)
    assert "blades" not in texts(Assembly("solo12", replace(device, motor=motor)), "Balance")


def test_the_heavy_side_is_opposite_the_point_of_the_four_runs():
    """The construction of the text with an assumed unbalance and response of the foot."""
    unbalance, response, wax = 2.4 * np.exp(0.7j), 0.3 * np.exp(-1.1j), 1.5
    first = abs(response * unbalance)
    around = first * np.exp(1j * np.radians([0.0, 120.0, 240.0]))
    others = abs(response * (unbalance + wax * around / first))
    # Intersection of the circles: differences of their equations are linear.
    normals = 2.0 * np.column_stack([(around[0] - around[1:]).real, (around[0] - around[1:]).imag])
    intersection = np.linalg.solve(normals, others[1:] ** 2 - others[0] ** 2)
    point = complex(*intersection)
    assert abs(point - around) == pytest.approx(others)
    assert -point / abs(point) * wax * first / abs(point) == pytest.approx(unbalance)
    assert "The heavy side is opposite that point" in texts(
        Assembly("dog", DEVICES["caged"]), "Balance"
    )


@pytest.mark.parametrize(
    ("name", "cutter", "sizes"),
    [
        ("on a plate", "", {"1.6 M2", "2.5 M3", "3.4", "strips 1.5 mm"}),
        ("caged", "", {"1.6 M2", "2.5 M3", "strips 1.5 mm"}),
        ("by its face", "2.5 mm", {"1.6 M2", "2.5 M3", "strips 1.5 and 2.0 mm"}),
        ("wheels alone", "", set()),
        ("wide", "2.5 mm", {"1.6 M2", "2.5 M3", "strips 1.5 mm"}),
    ],
)
def test_tools_are_those_that_the_design_needs(name, cutter, sizes):
    """Drills with their taps, strips for the gaps of bonds, and a hex key cut to length."""
    wide = housed_device(DEVICES["caged"].motor.mounting, outer_radius=0.05)
    assembly = Assembly("dog", (DEVICES | {"wide": wide})[name])
    tools = texts(assembly, "Before")
    tools = tools[tools.index("Tools: ") :]
    drills = re.findall(r"drill of ([\d.]+) mm(?: and tap (M\d))?", tools)
    strips = {f"strips {gaps}" for gaps in re.findall(r"strips of (.*? mm) for gaps", tools)}
    assert {" ".join(drill).strip() for drill in drills} | strips == sizes
    assert re.findall(r"short leg of a hex key of ([\d.]+ mm)", tools) == [cutter] * bool(cutter)
    steps = " ".join(all_texts(assembly))
    assert ("short leg cut" in steps) == bool(cutter)
    for tool in ("accelerometer", "wax", "damping tape", "steel box", "steel rule"):
        assert tool in tools or tool not in steps


def test_steps_for_the_robot_follow_those_for_each_module():
    per_module, once = (
        chapter for chapter in chapters(Assembly("dog", DEVICES["on a plate"]))
        if chapter.title.startswith("Steps")
    )  # fmt: skip
    assert (per_module.title, once.title) == ("Steps, for each module", "Steps, once for the robot")
    assert (per_module.first, once.first) == (1, len(per_module.texts) + 1)
    (plate,) = (
        text for text in (*per_module.texts, *once.texts) if text.startswith("Make the plate")
    )
    assert plate in once.texts


@pytest.mark.parametrize(
    ("name", "access"),
    [
        ("caged", "undo the motor's 4 screws (1), unplug it"),
        ("by its face", "behind the wheel: drill the outer face alone"),
        ("unknown threads", ""),
    ],
)
def test_access_to_the_rim_for_drilling_depends_on_the_mounting(name, access):
    device = DEVICES[name]
    # A rim whose wall can be drilled.
    wheel = replace(device.flywheel, inner_radius=device.flywheel.outer_radius - 0.004)
    text = texts(Assembly("dog", replace(device, flywheel=wheel)), "Balance")
    assert "in both faces of the rim" in text
    assert ("The inner face is" in text) == bool(access)
    assert access in text
    if name == "caged":
        diameter, window = device.motor.diameter, device.foot.housing.mount.pilot_radius
        assert diameter < 2.0 * window
        assert (
            f"its {1e3 * diameter:.1f} mm pass through the window of {2e3 * window:.1f} mm" in text
        )


def test_depths_of_screws_in_the_motor_are_given_with_those_of_a_cad_model():
    """Length of screws beyond the clamped parts; the CAD model is of the motor or its series."""
    device = DEVICES["caged"]
    screws = {joint.name: screw for joint, screw in Assembly("dog", device).screws.items()}
    names = [name for name in screws if name.startswith(("wheel", "motor"))]
    depths = [screws[name].fastening.length - screws[name].fastening.thickness for name in names]
    reached = " and ".join(
        f"{1e3 * screw_depth:.1f} mm ({name})"
        for name, screw_depth in zip(names, depths, strict=True)
    )
    of_rotor = {"": 0.0, "U8 Lite": 3.0, "MN4014": 3.8}
    for motor, model in (
        ({"name": "M1", "source": "a list"}, ""),
        ({"name": "M1", "source": "threads: those of U8 Lite, of the same series"}, "U8 Lite"),
        ({"name": "MN4014 KV330", "source": "a list"}, "MN4014"),
    ):
        with_motor = replace(device, motor=replace(device.motor, **motor))
        text = texts(Assembly("dog", with_motor), "Before")
        assert f"The screws of this design reach {reached} into it." in text
        model_depths = [of_rotor[model] if name.startswith("wheel") else 3.6 for name in names]
        figures = " and ".join(f"{depth:.1f} mm" for depth in model_depths)
        assert (f"a CAD model shows {figures}: its modeller" in text) == bool(model)
        assert f"For {model}, whose" in text or not model
        # Half a millimetre has to remain below each tip.
        too_long = any(
            1e3 * screw_depth + 0.5 > depth
            for screw_depth, depth in zip(depths, model_depths, strict=True)
        )
        assert ("these screws are too long" in text) == (bool(model) and too_long)


def test_a_wheel_on_a_gear_needs_a_joint_of_your_own():
    """Both wheels of the gear are bought parts."""
    web = DEVICES["caged"].flywheel.web
    device = DEVICES["gear"]
    device = replace(device, flywheel=replace(device.flywheel, web=web))
    assembly = Assembly("dog", device)
    rows = {row.name: row for row in piece_rows(assembly)}
    assert "gear 2" not in rows
    for name in ("gear", "gear, at the motor"):
        assert (rows[name].made, rows[name].file) == (f"bought: {device.motor.gear}", "")
    steps = texts(assembly, "Steps")
    numbers = [assembly.numbers[name] for name in ("gear", "motor")]
    assert "Fix gear ({}) and motor ({}) as described above".format(*numbers) in steps
    assert "the gear's output within 0.05 mm of the wheel's axis" in steps
    assert "middle of their hole" not in steps
    assert "by a joint of your own: how a wheel is mounted on this gear is not in" in steps
    assert "compound" not in steps


def test_a_wheel_on_an_unknown_shaft_needs_a_joint_of_your_own():
    steps = texts(Assembly("dog", DEVICES["unknown threads"]), "Steps")
    assert "by a joint of your own: the shaft and the rotor's threads are not in" in steps
    assert "compound" not in steps
    assert "middle of their hole" in steps


def test_a_rim_of_another_material_is_shrunk_on():
    """The temperature difference makes room for the tightest fit and 0.03 mm of clearance."""
    wheel = DEVICES["caged"].flywheel
    web = replace(wheel.web, material="aluminium-6061-t6", density=2700.0)
    rim = replace(wheel, material="stainless-304", web=web)
    device = replace(DEVICES["caged"], flywheel=rim)
    text = texts(Assembly("solo12", device), "Steps")
    expansion = materials()["stainless-304"].thermal_expansion
    difference = (2.0 * rim_fit(device).most + 0.03e-3) / (2.0 * rim.inner_radius * expansion)
    assert f"at least {difference:.0f} K hotter than the web" in text
    step = rim.height - web.hub.height
    part = "hub" if step > 0.0 else "rim"
    shim = f"on a flat plate, the {part} on a shim of {500.0 * abs(step):.2f} mm, and let both cool"
    assert shim in text


def test_the_feet_s_screws_are_in_their_slots():
    """The screws are on the diagonal that is nearer to the axis."""
    device = DEVICES["caged"]
    text = texts(Assembly("solo12", device), "Steps")
    match = re.search(r"left foot \(([-\d.]+), ([-\d.]+)\) and \(([-\d.]+), ([-\d.]+)\)", text)
    x1, y1, x2, y2 = map(float, match.groups())
    line, axis = np.array([x1 - x2, y1 - y2]), device.modules[0].axis[:2]
    assert abs(line[0]) == pytest.approx(abs(line[1]), abs=0.21)
    cosine = abs(line @ axis) / np.linalg.norm(line) / np.linalg.norm(axis)
    assert np.degrees(np.arccos(cosine)) <= 45.2
    position = 1e3 * device.modules[0].position[:2]
    assert [(x1 + x2) / 2.0, (y1 + y2) / 2.0] == pytest.approx(position, abs=0.06)


def test_open_points_come_first_and_once():
    note = "The feet are 41 mm above the trunk's top"
    text = texts(Assembly("solo12", DEVICES["unknown threads"], (), (note, note)), "Before")
    assert text.count(note) == 1
    assert "The motor's threads are not in the catalogue" in text


@pytest.mark.slow
def test_the_booklet_of_an_unbuildable_device_says_so_first():
    """On the first sheet above the pieces, in the title of each, and before all steps."""
    refused = "NOT buildable as it stands. The feet hang in the air; give a place."
    for device in (DEVICES["caged"], DEVICES["on a plate"]):
        threads = trunk_threads(device)
        assembly = Assembly("solo12", device, fitting=(threads, "of the motor"), refused=refused)
        assert all_texts(assembly)[0] == refused
        text = texts(assembly, "Steps")
        assert "Do not drill the trunk or cut any part that stands on it until" in text
        assert "cad/drilling.pdf" not in text
        # Threads in the trunk and tools for them are left out; a buildable device has them.
        before = texts(assembly, "Before")
        assert "Of the motor." in before
        assert "tap M2 for the prints' ears" in before
        buildable = texts(replace(assembly, refused=""), "Before")
        for part in ("trunk needs threads", "the trunk,", "for the plate"):
            assert part not in before
            assert part in buildable or device.plate is None
        for page in assembly_pages(assembly):
            check_words(page)
            title, *_ = (
                item.text for item in page if isinstance(item, Lettering) and item.height > 3.0
            )
            assert title == "Assembly, solo12: NOT buildable as it stands"
        first, *_ = assembly_pages(assembly)
        lettering = [item for item in first if isinstance(item, Lettering)]
        (verdict,) = (item for item in lettering if item.text == refused)
        heights = [item.center[1] for item in first if isinstance(item, Circle)]
        assert verdict.place[1] < min(heights) - 4.0


def test_settings_of_the_controller():
    """tau = k_t i with the current through two lines, sqrt(3)/2 of the amplitude of a phase."""
    device = DEVICES["caged"]
    motor = replace(device.motor, resistance=0.46, no_load_current=0.4)
    assembly = Assembly("solo12", replace(device, motor=motor))
    text = texts(assembly, "Wiring")
    k_t, amplitude, resistance, current_limit, speed_limit = re.search(
        r"([\d.]+) N m/A through two lines \(([\d.]+) of a .* ([\d.]+) ohm between .* "
        r"limits (\d+) A through two lines and ([\d,]+) rpm",
        text,
    ).groups()
    assert float(k_t) == pytest.approx(motor.torque_constant, rel=1e-3)
    assert float(amplitude) == pytest.approx(3.0**0.5 / 2.0 * motor.torque_constant, rel=1e-3)
    assert float(resistance) == pytest.approx(motor.resistance, rel=1e-2)
    current = motor.torque_limit / motor.torque_constant + 0.4
    assert 0.0 <= int(current_limit) - current < 1.0
    assert speed_limit == rpm(motor.top_speed).removesuffix(" rpm")


def test_a_wheel_of_unknown_speed_has_no_safety_chapter():
    device = paper_device()
    assert Assembly("solo12", device).top_speed is None
    titles = [chapter.title for chapter in chapters(Assembly("solo12", device))]
    assert "Safety" not in titles


@pytest.mark.parametrize(
    ("allowed", "words"),
    [
        (1.5, "ten seconds, 110%: 11,000 rpm, which takes 26.4 V."),
        (1.05, "ten seconds, 105%: 10,500 rpm, the limit of motor and wheel, which"),
        (1.0, "ten seconds, 100%: 10,000 rpm, the limit of motor and wheel."),
    ],
)
def test_the_spin_test_stays_within_the_speed_limit_of_the_motor(allowed, words):
    speed = 10000.0 * np.pi / 30.0
    device = next(iter(DEVICES.values()))
    motor = replace(
        device.motor,
        no_load_speed=speed,
        speed_max=allowed * speed,
        bus_voltage=24.0,
        gear="direct",
    )
    steel = {"material": "stainless-304"}
    wheel = replace(device.flywheel, **steel, web=replace(device.flywheel.web, **steel))
    driven = replace(device, motor=motor, flywheel=wheel)
    text = texts(Assembly("solo12", driven), "Spin test")
    assert words in text
    # Faster than the limit that the wiring sets.
    assert ("Raise the controller's speed limit" in text) == (allowed > 1.0)
    part, factor = yield_margin(driven, min(1.1, allowed) * speed)
    assert f"yield strength is then {factor:.1f} times the largest stress, in {part}." in text


@pytest.mark.parametrize("clearance", [0.3e-3, 1.5e-3])
def test_a_lid_that_can_be_pressed_onto_the_hub_is_noted(clearance):
    """Deflection W a^2 / (16 pi D) of PETG, 1.8 GPa and 0.38, 1.2 mm thick, under 10 N."""
    device = DEVICES["caged"]
    housing = device.foot.housing
    deflection = (
        10.0 * housing.inner_radius**2 / (16.0 * np.pi * 1.8e9 * 1.2e-3**3 / 12.0) * (1 - 0.38**2)
    )
    hub = replace(
        device.flywheel.web.hub,
        bolt_head=0.0,
        height=2.0 * (housing.half_height - 1.2e-3 - clearance),
    )
    web = replace(device.flywheel.web, hub=hub)
    tall_hub = replace(device, flywheel=replace(device.flywheel, web=web))
    text = texts(Assembly("solo12", tall_hub), "Steps, for each")
    match = re.search(
        r"the lid by ([\d.]+) mm, and 10 N on the lid press it in by ([\d.]+) mm", text
    )
    assert bool(match) == (clearance < deflection)
    if match:
        assert float(match[1]) == pytest.approx(1e3 * clearance, abs=0.05)
        assert float(match[2]) == pytest.approx(1e3 * deflection, abs=0.06)


@pytest.mark.parametrize(("shaft", "noted"), [(None, True), (0.004, False)])
def test_a_wheel_centred_by_its_screws_alone_is_noted(shaft, noted):
    """In clearance holes the run-out may be larger than the step allows."""
    caged = DEVICES["caged"]
    motor = replace(caged.motor, mounting=replace(caged.motor.mounting, shaft_diameter=shaft))
    text = texts(Assembly("solo12", replace(caged, motor=motor)), "Steps")
    assert ("Only its screws centre it" in text) == noted
    # What is still to be shifted is not locked.
    assert ("threadlocker when the wheel runs true" in text) == noted
    assert ("take them out one by one for their threadlocker" in text) == noted


def test_screws_are_shortened_in_the_step_that_tightens_them():
    """Uncut they meet the bottom of a thread of 3 mm under a hub of 3 mm."""
    caged = DEVICES["caged"]
    rotor = replace(caged.motor.mounting.rotor, drawn=0.003)
    motor = replace(caged.motor, mounting=replace(caged.motor.mounting, rotor=rotor))
    text = texts(Assembly("solo12", replace(caged, motor=motor)), "Steps")
    assert re.search(r"Wheel on rotor: \d x ISO 4762 M\d x 6 shortened to 5.5 mm \(\d+\),", text)
    assert "shortened" not in texts(Assembly("solo12", caged), "Steps")


def test_a_bell_is_measured_before_its_ring_is_bored():
    caged = DEVICES["caged"]
    text = texts(Assembly("solo12", replace(caged, on_bell=True)), "Steps")
    assert (
        0 <= text.find("Measure the bell") < text.index("Turn the wheel to") < text.index("fixture")
    )


def test_each_foot_of_a_triad_is_aligned_with_its_axis():
    text = texts(Assembly("solo12", TRIAD), "Steps")
    assert "First scribe a line forward on the trunk through the middle of each foot" in text
    assert "meets the scale at 0 deg (1), 60 deg (2), 60 deg (3)," in text
    assert "steel rule" not in text


@pytest.mark.parametrize("name", ["caged", "on a plate"])
def test_opposite_feet_are_aligned_by_a_line_and_checked_by_their_marks(name):
    """The base of a foot extends over the plate's edge except towards the other foot."""
    device = DEVICES[name].at_incidence(np.pi / 6.0)
    text, foot = texts(Assembly("solo12", device), "Steps"), device.foot
    base = "trunk" if device.plate is None else "plate"
    assert (
        f"First scribe a line on the {base} from the middle of each foot to that of the foot"
        in text
    )
    assert "meets the scale at 30 deg from the long mark under its motor, its lid looking" in text
    middle, radius = device.modules[0].position[1], foot.base_radius - WALL
    ahead, behind = (2e3 * (middle + sense * radius * 0.5) for sense in (-1.0, 1.0))
    assert f"the 0 marks of opposite feet: {ahead:.1f} mm in front and {behind:.1f} mm beh" in text
    # The lid of the left foot points forward to the left: its front mark is nearer to the middle.
    assert device.modules[0].axis[0] > 0.0 < device.modules[0].frame[1, 1]
    angles = np.radians([29.5, 30.5])
    change = np.ptp(4e3 * radius * np.sin(angles))
    assert f"changes the difference by {change:.2g} mm" in text


def test_pedestals_of_two_shapes_are_drawn_side_by_side():
    """Each has its screws and is named by the module on it."""
    caged = DEVICES["caged"]
    foot = caged.foot
    low, high = (
        Pedestal(foot.base_radius, foot.slot_radius, foot.wheel_height, lean, 0.04, module=module)
        for lean, module in ((0.3, "left"), (0.9, "right"))
    )
    device = replace(caged, plate=None, pedestals=(low, high))
    assembly, kinds = Assembly("solo12", device), pedestal_kinds(device)
    exploded = {piece.key: piece.mesh.vertices for piece in pulled_apart(assembly.pieces, 0.01)}
    extents = [np.concatenate([exploded[kind.name], exploded[kind.screws]])[:, 2] for kind in kinds]
    assert extents[1].max() < extents[0].min()
    assert [kind.screws.purpose for kind in kinds] == [
        f"pedestal {side} on trunk; longer if the trunk's thread starts deeper"
        for side in ("left", "right")
    ]
    assert {"pedestal left", "pedestal right"} <= {row.name for row in piece_rows(assembly)}
    # Assembled, the two shapes are in the same place.
    placed = {piece.key: piece for piece in assembly.pieces}
    assert placed["pedestal_left"].aside == 0.0 > placed["pedestal_right"].aside


@pytest.mark.parametrize("device", [AT_30_DEGREES, TRIAD], ids=["pair", "triad"])
def test_directions_of_lids_are_those_of_the_robot_files(device):
    """The lid is at the end of the carrier's axis that is away from the motor."""
    text = texts(Assembly("solo12", device), "Steps")
    for module in device.modules:
        rotation = wheel_placement(module).rotation @ carrier_placement(module).rotation
        x, y, _ = rotation[:, 2]
        degrees = np.degrees(np.arctan2(abs(y), x))
        side = "left" if y > 0.0 else "right"
        assert f"{degrees:.4g} deg to the {side} of forward ({module.name})" in text


def test_the_wheel_is_bonded_at_its_designed_height():
    """The gap between rim and drum floor is that of their meshes."""
    device = DEVICES["by its face"]
    assembly = Assembly("solo12", device)
    meshes = {piece.key: piece.mesh.vertices for piece in assembly.pieces}
    rim, drum = meshes["flywheel"], meshes["drum"]
    floor = drum[np.hypot(*drum[:, :2].T) < device.flywheel.inner_radius, 2].max()
    rim_bottom = rim[np.hypot(*rim[:, :2].T) > device.flywheel.inner_radius, 2].min()
    assert f"Strips of {1e3 * (rim_bottom - floor):.1f} mm between" in texts(assembly, "Steps")
