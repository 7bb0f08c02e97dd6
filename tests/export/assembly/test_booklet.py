"""The booklet of assembly: everything is in it, legible and where it belongs."""

import re
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from built_devices import DEVICES, MAST_PLATE, device_in_layout, housed_device
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
from ocs_design.device.records.device import Margin
from ocs_design.device.resonances import resonances_of
from ocs_design.device.solids import foot_of
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


def test_all_is_on_the_sheet_and_no_text_on_another(assembly):
    """And large figures are written out."""
    assert not re.search(r"\de[+]", " ".join(all_texts(assembly)))
    for page in assembly_pages(assembly):
        check_words(page)
        # No number is level with the words below its view.
        numbers = [item.center for item in page if isinstance(item, Circle) and item.radius > 1.0]
        for caption in (each for each in texts_of(page) if re.search(r", 1:\d", each.text)):
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
    """Of the chapters whose titles begin so."""
    found = [each for each in chapters(assembly) if each.title.startswith(title)]
    assert found
    return " ".join(text for each in found for text in each.texts)


@pytest.mark.parametrize("name", ["caged", "by its face"])
def test_the_way_that_a_positive_torque_turns_is_told_as_seen_from_the_lid(name):
    """About its axis by the right hand: whoever looks against the axis sees it counter-clockwise.
    A lid is on the far side of its module from the motor, in its own mesh."""
    device = DEVICES[name]
    (text,) = (text for text in all_texts(Assembly("dog", device)) if "positive torque" in text)
    pieces = {piece.key: piece for piece in Assembly("dog", device).pieces}
    lid, motor = (pieces[each].mesh.vertices.mean(axis=0) for each in ("lid", "motor"))
    for module in device.modules:
        placed = wheel_placement(module) @ carrier_placement(module)
        looks = placed.rotation @ (lid - motor)
        way = "counter-clockwise" if looks @ module.axis > 0.0 else "clockwise"
        said = re.search(
            rf"(?<![\w-])({'counter-clockwise|clockwise'}): [^;]*ocs_{module.name}", text
        )
        assert said.group(1) == way


def test_modes_are_swept_for_on_the_robot_and_what_is_near_one_is_told():
    """An unbalance shakes by r^2 / |1 - r^2| of U / m off a mode; k goes with thickness^3."""
    device = DEVICES["on a plate"]
    device = replace(device, motor=replace(device.motor, no_load_speed=3e3, speed_max=None))
    plate = next(mode for mode in resonances_of(device) if mode.name == "plate")
    at = 1.07 * 2.0 * np.pi * plate.frequency
    margins = (Margin("wheel speed", at, 3e3, "rad/s"),)
    said = texts(Assembly("solo12", device, margins), "Sweep")
    assert f"from standstill to {rpm(at)}" in said
    for mode in resonances_of(device):
        assert f"{mode.name} {60.0 * mode.frequency:,.0f} rpm" in said
    told = re.search(r"is 7% above the plate's mode: .* with ([\d.]+) times .* with (\S+) t", said)
    near, met = map(float, told.groups())
    square, mass = 1.07**2, device.module_mass
    own = balance_of(device).unbalance / mass * square / (square - 1.0) * at**2 / 9.80665
    assert near == pytest.approx(own, rel=0.06)
    assert met == pytest.approx(plate.acceleration / 9.80665, rel=0.06)
    thick = device.plate.thickness
    stiffer = float(
        re.search(r"make the plate 4 mm thick.*?: ([\d,]+) rpm", said)[1].replace(",", "")
    )
    assert stiffer == pytest.approx(60.0 * plate.frequency * (4e-3 / thick) ** 1.5, rel=1e-3)
    # Without flights it is the top speed.
    unflown = texts(Assembly("solo12", device), "Sweep")
    assert f"to {rpm(3e3)}, its top speed, in about" in unflown
    assert "of the maneuvers" not in unflown
    # Far from all modes nothing of the kind is told, and without modes there is no sweep.
    far = (Margin("wheel speed", 2.0 * at, 3e3, "rad/s"),)
    assert "above the" not in texts(Assembly("solo12", device, far), "Sweep")
    slow = replace(device, motor=replace(device.motor, no_load_speed=10.0))
    assert "Sweep" not in {each.title[:5] for each in chapters(Assembly("solo12", slow))}


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


def test_what_stands_on_a_mast_is_made_as_it_is_drawn():
    """Holes for the trunk's screws are in the mast, and the table of pieces is on its sheet."""
    device = replace(DEVICES["in a guard ring"], plate=MAST_PLATE)
    assembly = Assembly("dog", device, (), (), "NOT buildable as it stands. It hangs in the air.")
    first = assembly_pages(assembly)[0]
    check_words(first)
    lines = [item for item in first if isinstance(item, Line) and item.pen is THIN]
    assert max(line.end[1] for line in lines) < BOTTOM - 1.0
    steps = texts(replace(assembly, refused=""), "Steps")
    assert "with their tops 90.0 mm below and level with the upright's" in steps


def test_the_plate_is_under_the_foot_with_its_screws_and_sleeves():
    """Where it stands, its top is the foot's underside; pulled apart they are one below another."""
    assembly = Assembly("solo12", DEVICES["on a plate"])
    rows = {row.name: (row.quantity, row.file) for row in piece_rows(assembly)}
    assert rows["plate under the feet"] == (1, "plate.pdf")
    assert rows["sleeves around the trunk's screws"] == (3, "")
    screws = [row for row in screw_rows(assembly) if row.purpose.startswith("plate")]
    assert [row.quantity for row in screws] == [1, 2, 1]

    def low_and_high(pieces, name):
        """Height of the underside and of the top."""
        meshes = [each.mesh for each in pieces if name in (each.key, getattr(each.key, "name", ""))]
        down = np.concatenate([mesh.vertices[:, 1] for mesh in meshes])
        return -down.max(), -down.min()

    placed, apart = assembly.pieces, pulled_apart(assembly.pieces, 0.02)
    assert low_and_high(placed, "plate")[1] == pytest.approx(low_and_high(placed, "foot")[0])
    for above, below in pairwise(("foot on plate", "plate on trunk", "plate", "sleeves")):
        assert low_and_high(apart, above)[0] > low_and_high(apart, below)[1]
    said = texts(assembly, "Steps")
    assert "4.50 mm at" in said
    assert "into the threads of the plate" in said


def test_pulled_apart_no_piece_touches_its_neighbour():
    pieces = Assembly("solo12", DEVICES["caged"]).pieces
    apart = [piece for piece in pulled_apart(pieces, 0.02) if piece.drop is None]
    for one, other in pairwise(apart):
        if "foot" not in (one.key, other.key):
            assert one.mesh.vertices[:, 2].max() < other.mesh.vertices[:, 2].min()


@given(st.lists(st.floats(0.0, 200.0), max_size=15))
def test_numbers_never_stand_on_each_other(wanted):
    places = spread(sorted(wanted), 8.0, (0.0, 200.0))
    assert np.all(np.diff(places) >= 8.0 - 1e-9)
    assert all(place <= 200.0 for place in places)


def test_the_guard_is_told_what_it_does_not_do():
    device = DEVICES["caged"]
    assembly = Assembly("solo12", device)
    said, burst = texts(assembly, "Safety"), burst_of(device)
    assert assembly.top_speed == 650.4
    assert "It does not hold a burst rim" in said
    # Rounded up: what is told must hold.
    (ring,) = re.findall(r"a ring of ([\d.]+) mm of mild steel", said)
    (outer,) = re.findall(r"behind it ([\d.]+) mm of 6061-T6", said)
    for told, wall in ((ring, burst.steel), (outer, burst.aluminium)):
        assert 0.0 <= float(told) - 1e3 * wall < 0.1
    # The mass is that of the wall that is told.
    weighs, inside, wide = re.search(
        r"in the drum, (\d+) g each \(([\d.]+) mm inside, ([\d.]+) mm wide", said
    ).groups()
    area = np.pi * float(ring) * (float(inside) + float(ring))
    assert float(weighs) == pytest.approx(7.85e-3 * area * float(wide), abs=0.6)
    energy = 0.5 * device.flywheel.spin_inertia * 650.4**2
    assert f"Each wheel stores {energy:.3g} J at 6,211 rpm, 2 of them {2 * energy:.3g} J" in said


@pytest.mark.parametrize("wall", [0.0, 1.5e-3, 2.5e-3])
def test_what_keeps_a_wheel_from_its_top_speed_is_told_beside_its_guard(wall):
    """The law does, by its voltage; a full battery does not: 1.1^2 of the energy, 1.1^(4/3) of
    the wall.
    """
    device = replace(DEVICES["in a guard ring"], guard_wall=wall)
    said, burst = texts(Assembly("solo12", device), "Safety"), burst_of(device)
    speed, volts = device.motor.no_load_speed, device.motor.bus_voltage
    assert f"which computes with {volts:g} V, drives no wheel past 6,211 rpm" in said
    found = re.search(
        r"battery with 110% .*? to ([\d,]+) rpm, .*? has (\d+) J; .*? takes (\S+)", said
    )
    rpm, energy, steel = (float(each.replace(",", "")) for each in found.groups())
    assert rpm == pytest.approx(1.1 * speed * 30.0 / np.pi, abs=0.6)
    assert energy == pytest.approx(1.21 * burst.fragment.energy, rel=0.02)
    assert 0.0 <= steel - 1e3 * 1.1 ** (4.0 / 3.0) * burst.steel < 0.1
    enough = "and the ring built in is thick enough" in said
    assert enough == (1e3 * wall >= steel - 0.1 and wall > 0.0)
    assert ("built in is too thin" in said) == (wall > 0.0 and not enough)


def test_a_guard_ring_is_built_and_told_with_its_limits():
    device = DEVICES["in a guard ring"]
    assembly = Assembly("solo12", device)
    said, wall = texts(assembly, "Safety"), burst_of(device).steel
    assert device.guard_wall >= wall
    assert "The guard ring of 1.5 mm holds that piece" in said
    assert "no ring of this kind has been tested" in said
    rows = {row.name: row for row in piece_rows(assembly)}
    assert rows["guard ring"].file == "guard_ring.stl"
    # Its epoxy has room between ring and drum, and is on the bill.
    pieces = {piece.key: piece.mesh for piece in assembly.pieces}
    drum = foot_of(device).housing.inner_radius
    assert drum - pieces["guard"].vertices[:, 0].max() == pytest.approx(0.1e-3, abs=5e-5)
    assert "0.1 mm all around, down to its floor" in texts(assembly, "Steps")
    bill = {row.part: row for row in bill_rows(device)}
    assert bill["epoxy 3M Scotch-Weld DP760"].remark.startswith("guard ring in drum, or an epoxy")
    assert f"outside {2e3 * (drum - 0.1e-3):.2f} (0/-0.2)" in bill["guard ring"].remark
    thin = texts(Assembly("solo12", replace(device, guard_wall=wall / 2.0)), "Safety")
    assert "It does not hold a burst rim" in thin


def test_the_balance_says_how_much_is_left_and_what_holes_take():
    """U = m 6.3 mm/s / w."""
    device = DEVICES["caged"]
    said, balance = texts(Assembly("solo12", device), "Balance"), balance_of(device)
    assert f"at most {1e6 * device.flywheel.mass * 6.3e-3 / 650.4:.2g} g mm" in said
    holes, rim = balance.correction, device.flywheel
    pair = 2.0 * np.pi * holes.hole_radius**2 * holes.depth * rim.density
    away = (rim.inner_radius + rim.outer_radius) / 2.0
    assert f"pair this deep removes {1e3 * pair:.2g} g, or {1e6 * pair * away:.2g} g mm" in said
    assert f"drill of {2e3 * holes.hole_radius:.1f} mm, at most {1e3 * holes.depth:.1f} mm" in said
    assert balance.centred_by in said


def test_no_limit_of_a_controller_is_asked_for_beyond_what_the_fuse_carries():
    device = replace(DEVICES["caged"], supply=Supply(24.0, current_max=500.0, power_max=12000.0))
    margins = (Margin("bus current, drawn", 103.2, 500.0, "A"),)
    said = " ".join(wiring(device, margins))
    (fuse,) = (what for name, _, what in wiring_parts(device, margins) if "fuse" in name)
    assert "set that limit to no less than 104 A" in said
    assert "switch: 104 A" in fuse
    assert "the next usual rating is 125 A" in fuse


def test_blades_are_not_said_to_show_what_friction_holds():
    """Friction torque over g is the unbalance that it holds on level blades."""
    device = DEVICES["caged"]
    motor = replace(device.motor, no_load_current=0.9, torque_constant=0.0212)
    said = texts(Assembly("solo12", replace(device, motor=motor)), "Balance")
    assert (
        f"friction alone holds up to {1e6 * 0.9 * 0.0212 / 9.80665:.2g}".replace("1.9e+03", "1900")
        in said
    )
    motor = replace(motor, no_load_current=None)
    assert "blades" not in texts(Assembly("solo12", replace(device, motor=motor)), "Balance")


def test_the_heavy_side_is_opposite_the_point_of_the_four_runs():
    """Its construction, with a made unbalance and a made response of the foot."""
    unbalance, response, wax = 2.4 * np.exp(0.7j), 0.3 * np.exp(-1.1j), 1.5
    first = abs(response * unbalance)
    around = first * np.exp(1j * np.radians([0.0, 120.0, 240.0]))
    others = abs(response * (unbalance + wax * around / first))
    # Where the circles meet: differences of their equations are linear.
    normals = 2.0 * np.column_stack([(around[0] - around[1:]).real, (around[0] - around[1:]).imag])
    meet = np.linalg.solve(normals, others[1:] ** 2 - others[0] ** 2)
    point = complex(*meet)
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
    """Drills with their taps, strips for the gaps of bonds, and what cuts a key to its length."""
    wide = housed_device(DEVICES["caged"].motor.mounting, outer_radius=0.05)
    assembly = Assembly("dog", (DEVICES | {"wide": wide})[name])
    told = texts(assembly, "Before")
    told = told[told.index("Tools: ") :]
    drills = re.findall(r"drill of ([\d.]+) mm(?: and tap (M\d))?", told)
    strips = {f"strips {each}" for each in re.findall(r"strips of (.*? mm) for gaps", told)}
    assert {" ".join(each).strip() for each in drills} | strips == sizes
    assert re.findall(r"short leg of a hex key of ([\d.]+ mm)", told) == [cutter] * bool(cutter)
    steps = " ".join(all_texts(assembly))
    assert ("short leg cut" in steps) == bool(cutter)
    for tool in ("accelerometer", "wax", "damping tape", "steel box", "steel rule"):
        assert tool in told or tool not in steps


def test_work_on_the_robot_is_told_once_and_its_numbers_go_on():
    each, once = (
        chapter for chapter in chapters(Assembly("dog", DEVICES["on a plate"]))
        if chapter.title.startswith("Steps")
    )  # fmt: skip
    assert (each.title, once.title) == ("Steps, for each module", "Steps, once for the robot")
    assert (each.first, once.first) == (1, len(each.texts) + 1)
    (made,) = (text for text in (*each.texts, *once.texts) if text.startswith("Make the plate"))
    assert made in once.texts


@pytest.mark.parametrize(
    ("name", "says"),
    [
        ("caged", "undo the motor's 4 screws (1), unplug it"),
        ("by its face", "behind the wheel: drill the outer face alone"),
        ("unknown threads", ""),
    ],
)
def test_a_drill_gets_at_the_rim_as_the_motor_is_held(name, says):
    device = DEVICES[name]
    # Of a wall that can be drilled.
    wheel = replace(device.flywheel, inner_radius=device.flywheel.outer_radius - 0.004)
    said = texts(Assembly("dog", replace(device, flywheel=wheel)), "Balance")
    assert "in both faces of the rim" in said
    assert ("The inner face is" in said) == bool(says)
    assert says in said
    if name == "caged":
        across, window = device.motor.diameter, foot_of(device).housing.mount.pilot_radius
        assert across < 2.0 * window
        assert f"its {1e3 * across:.1f} mm pass through the window of {2e3 * window:.1f} mm" in said


def test_the_screws_reach_into_the_motor_is_told_beside_what_its_model_draws():
    """Screws less what they go through; models are of the motor, or of the one that it follows."""
    device = DEVICES["caged"]
    screws = {held.name: each for held, each in Assembly("dog", device).screws.items()}
    names = [name for name in screws if name.startswith(("wheel", "motor"))]
    reach = [screws[name].fastening.length - screws[name].fastening.thickness for name in names]
    reached = " and ".join(
        f"{1e3 * deep:.1f} mm ({name})" for name, deep in zip(names, reach, strict=True)
    )
    of_rotor = {"": 0.0, "U8 Lite": 3.0, "MN4014": 3.8}
    for motor, model in (
        ({"name": "M1", "source": "a list"}, ""),
        ({"name": "M1", "source": "threads: those of U8 Lite, of the same series"}, "U8 Lite"),
        ({"name": "MN4014 KV330", "source": "a list"}, "MN4014"),
    ):
        told = replace(device, motor=replace(device.motor, **motor))
        said = texts(Assembly("dog", told), "Before")
        assert f"The screws of this design reach {reached} into it." in said
        drawn = [of_rotor[model] if name.startswith("wheel") else 3.6 for name in names]
        figures = " and ".join(f"{depth:.1f} mm" for depth in drawn)
        assert (f"a CAD model shows {figures}: its modeller" in said) == bool(model)
        assert f"For {model}, whose" in said or not model
        # Half a millimetre is to be left below each tip.
        long = any(1e3 * deep + 0.5 > depth for deep, depth in zip(reach, drawn, strict=True))
        assert ("these screws are too long" in said) == (bool(model) and long)


def test_behind_a_gear_nothing_is_fixed_in_a_hole_or_bonded_on_a_shaft():
    """Its wheels are bought, both of them."""
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


def test_on_an_unknown_shaft_no_compound_hardens():
    steps = texts(Assembly("dog", DEVICES["unknown threads"]), "Steps")
    assert "by a joint of your own: the shaft and the rotor's threads are not in" in steps
    assert "compound" not in steps
    assert "middle of their hole" in steps


def test_a_rim_of_another_material_is_shrunk_on():
    """Steel of 12e-6 per K on aluminium: hotter by the tightest fit and 0.03 mm of air."""
    wheel = DEVICES["caged"].flywheel
    web = replace(wheel.web, material="aluminium-6061-t6", density=2700.0)
    rim = replace(wheel, material="stainless-304", web=web)
    device = replace(DEVICES["caged"], flywheel=rim)
    said = texts(Assembly("solo12", device), "Steps")
    expansion = materials()["stainless-304"].thermal_expansion
    hotter = (2.0 * rim_fit(device).most + 0.03e-3) / (2.0 * rim.inner_radius * expansion)
    assert f"at least {hotter:.0f} K hotter than the web" in said
    higher = rim.height - web.hub.height
    part = "hub" if higher > 0.0 else "rim"
    shim = (
        f"on a flat plate, the {part} on a shim of {500.0 * abs(higher):.2f} mm, and let both cool"
    )
    assert shim in said


def test_the_feet_s_screws_are_in_their_slots():
    """As far forward as to the side, on the diagonal that the axis leans to."""
    device = DEVICES["caged"]
    said = texts(Assembly("solo12", device), "Steps")
    found = re.search(r"left foot \(([-\d.]+), ([-\d.]+)\) and \(([-\d.]+), ([-\d.]+)\)", said)
    x1, y1, x2, y2 = map(float, found.groups())
    line, axis = np.array([x1 - x2, y1 - y2]), device.modules[0].axis[:2]
    assert abs(line[0]) == pytest.approx(abs(line[1]), abs=0.21)
    cosine = abs(line @ axis) / np.linalg.norm(line) / np.linalg.norm(axis)
    assert np.degrees(np.arccos(cosine)) <= 45.2
    position = 1e3 * device.modules[0].position[:2]
    assert [(x1 + x2) / 2.0, (y1 + y2) / 2.0] == pytest.approx(position, abs=0.06)


def test_open_points_stand_first_and_once():
    note = "The feet are 41 mm above the trunk's top"
    said = texts(Assembly("solo12", DEVICES["unknown threads"], (), (note, note)), "Before")
    assert said.count(note) == 1
    assert "The motor's threads are not in the catalogue" in said


@pytest.mark.slow
def test_what_cannot_be_built_is_told_first_of_all():
    """On the first sheet above the pieces, in the title of each, and before all steps."""
    refused = "NOT buildable as it stands. The feet hang in the air; give a place."
    for device in (DEVICES["caged"], DEVICES["on a plate"]):
        threads = trunk_threads(device)
        assembly = Assembly("solo12", device, fitting=(threads, "of the motor"), refused=refused)
        assert all_texts(assembly)[0] == refused
        said = texts(assembly, "Steps")
        assert "Do not drill the trunk or cut any part that stands on it until" in said
        assert "cad/drilling.pdf" not in said
        # Nor is a thread in it or a tool for it, which a device that is settled has.
        before = texts(assembly, "Before")
        assert "Of the motor." in before
        assert "tap M2 for the prints' ears" in before
        settled = texts(replace(assembly, refused=""), "Before")
        for words in ("trunk needs threads", "the trunk,", "for the plate"):
            assert words not in before
            assert words in settled or device.plate is None
        for page in assembly_pages(assembly):
            check_words(page)
            title, *_ = (
                each.text for each in page if isinstance(each, Lettering) and each.height > 3.0
            )
            assert title == "Assembly, solo12: NOT buildable as it stands"
        first, *_ = assembly_pages(assembly)
        (told,) = (each for each in first if isinstance(each, Lettering) and each.text == refused)
        drawn = [each.center[1] for each in first if isinstance(each, Circle)]
        assert told.place[1] < min(drawn) - 4.0


def test_a_controller_is_told_what_to_be_set_to():
    """tau = k_t i of the current through two lines, which is sqrt(3)/2 of a phase's amplitude."""
    device = DEVICES["caged"]
    motor = replace(device.motor, resistance=0.46, no_load_current=0.4)
    assembly = Assembly("solo12", replace(device, motor=motor))
    said = texts(assembly, "Wiring")
    k_t, amplitude, ohm, most, fastest = re.search(
        r"([\d.]+) N m/A through two lines \(([\d.]+) of a .* ([\d.]+) ohm between .* "
        r"limits (\d+) A through two lines and ([\d,]+) rpm",
        said,
    ).groups()
    assert float(k_t) == pytest.approx(motor.torque_constant, rel=1e-3)
    assert float(amplitude) == pytest.approx(3.0**0.5 / 2.0 * motor.torque_constant, rel=1e-3)
    assert float(ohm) == pytest.approx(motor.resistance, rel=1e-2)
    asked = motor.torque_limit / motor.torque_constant + 0.4
    assert 0.0 <= int(most) - asked < 1.0
    assert fastest == rpm(motor.top_speed).removesuffix(" rpm")


def test_a_wheel_whose_speed_is_not_known_is_not_tested():
    device = paper_device()
    assert Assembly("solo12", device).top_speed is None
    titles = [chapter.title for chapter in chapters(Assembly("solo12", device))]
    assert "Safety" not in titles


@pytest.mark.parametrize(
    ("allowed", "says"),
    [
        (1.5, "ten seconds, 110%: 11,000 rpm, which takes 26.4 V."),
        (1.05, "ten seconds, 105%: 10,500 rpm, the limit of motor and wheel, which"),
        (1.0, "ten seconds, 100%: 10,000 rpm, the limit of motor and wheel."),
    ],
)
def test_the_spin_test_keeps_to_the_speed_that_the_motor_is_allowed(allowed, says):
    free = 10000.0 * np.pi / 30.0
    device = next(iter(DEVICES.values()))
    motor = replace(
        device.motor, no_load_speed=free, speed_max=allowed * free, bus_voltage=24.0, gear="direct"
    )
    steel = {"material": "stainless-304"}
    wheel = replace(device.flywheel, **steel, web=replace(device.flywheel.web, **steel))
    driven = replace(device, motor=motor, flywheel=wheel)
    said = texts(Assembly("solo12", driven), "Spin test")
    assert says in said
    where, factor = yield_margin(driven, min(1.1, allowed) * free)
    assert f"yield strength is then {factor:.1f} times the largest stress, in {where}." in said


@pytest.mark.parametrize("apart", [0.3e-3, 1.5e-3])
def test_a_hub_that_a_pressed_lid_touches_is_told(apart):
    """W a^2 / (16 pi D) of PETG with 1.8 GPa and 0.38, 1.2 mm thick, under 10 N."""
    device = DEVICES["caged"]
    housing = foot_of(device).housing
    sag = 10.0 * housing.inner_radius**2 / (16.0 * np.pi * 1.8e9 * 1.2e-3**3 / 12.0) * (1 - 0.38**2)
    hub = replace(
        device.flywheel.web.hub, bolt_head=0.0, height=2.0 * (housing.half_height - 1.2e-3 - apart)
    )
    web = replace(device.flywheel.web, hub=hub)
    near = replace(device, flywheel=replace(device.flywheel, web=web))
    said = texts(Assembly("solo12", near), "Steps, for each")
    told = re.search(
        r"the lid by ([\d.]+) mm, and 10 N on the lid press it in by ([\d.]+) mm", said
    )
    assert bool(told) == (apart < sag)
    if told:
        assert float(told[1]) == pytest.approx(1e3 * apart, abs=0.05)
        assert float(told[2]) == pytest.approx(1e3 * sag, abs=0.06)


@pytest.mark.parametrize(("shaft", "told"), [(None, True), (0.004, False)])
def test_a_wheel_that_only_its_screws_centre_is_shifted(shaft, told):
    """In clearance holes it may run out by more than the step allows."""
    caged = DEVICES["caged"]
    motor = replace(caged.motor, mounting=replace(caged.motor.mounting, shaft_diameter=shaft))
    said = texts(Assembly("solo12", replace(caged, motor=motor)), "Steps")
    assert ("Only its screws centre it" in said) == told


def test_each_foot_of_a_ring_is_turned_to_its_own_axis():
    said = texts(Assembly("solo12", TRIAD), "Steps")
    assert "First scribe a line forward on the trunk through the middle of each foot" in said
    assert "meets the scale at 0 deg (1), 60 deg (2), 60 deg (3)," in said
    assert "steel rule" not in said


@pytest.mark.parametrize("on", ["caged", "on a plate"])
def test_opposite_feet_are_turned_by_a_line_between_them_and_checked_by_their_marks(on):
    """A base reaches over its plate's edge everywhere but towards the other foot."""
    device = DEVICES[on].at_incidence(np.pi / 6.0)
    said, foot = texts(Assembly("solo12", device), "Steps"), foot_of(device)
    under = "trunk" if device.plate is None else "plate"
    assert (
        f"First scribe a line on the {under} from the middle of each foot to that of the foot"
        in said
    )
    assert "meets the scale at 30 deg from the long mark under its motor, its lid looking" in said
    middle, radius = device.modules[0].position[1], foot.base_radius - WALL
    front, behind = (2e3 * (middle + sense * radius * 0.5) for sense in (-1.0, 1.0))
    assert f"the 0 marks of opposite feet: {front:.1f} mm in front and {behind:.1f} mm beh" in said
    # The lid of the left foot looks forward to the left, so its front mark is nearer the middle.
    assert device.modules[0].axis[0] > 0.0 < device.modules[0].frame[1, 1]
    angles = np.radians([29.5, 30.5])
    change = np.ptp(4e3 * radius * np.sin(angles))
    assert f"changes the difference by {change:.2g} mm" in said


def test_pedestals_of_two_shapes_stand_beside_each_other():
    """Each with its screws, and told and numbered by what stands on it."""
    caged = DEVICES["caged"]
    foot = foot_of(caged)
    low, high = (
        Pedestal(foot.base_radius, foot.slot_radius, foot.wheel_height, lean, 0.04, module=module)
        for lean, module in ((0.3, "left"), (0.9, "right"))
    )
    device = replace(caged, plate=None, pedestals=(low, high))
    assembly, kinds = Assembly("solo12", device), pedestal_kinds(device)
    apart = {piece.key: piece.mesh.vertices for piece in pulled_apart(assembly.pieces, 0.01)}
    along = [np.concatenate([apart[kind.name], apart[kind.screws]])[:, 2] for kind in kinds]
    assert along[1].max() < along[0].min()
    assert [kind.screws.purpose for kind in kinds] == [
        f"pedestal {side} on trunk; longer if the trunk's thread starts deeper"
        for side in ("left", "right")
    ]
    assert {"pedestal left", "pedestal right"} <= {row.name for row in piece_rows(assembly)}
    # In their places they have one seat.
    placed = {piece.key: piece for piece in assembly.pieces}
    assert placed["pedestal_left"].aside == 0.0 > placed["pedestal_right"].aside


@pytest.mark.parametrize("device", [AT_30_DEGREES, TRIAD], ids=["pair", "triad"])
def test_lids_look_where_the_robot_files_have_them(device):
    """The lid is at the end of the carrier's axis that its wheel's motor is not at."""
    said = texts(Assembly("solo12", device), "Steps")
    for module in device.modules:
        turn = wheel_placement(module).rotation @ carrier_placement(module).rotation
        x, y, _ = turn[:, 2]
        degrees = np.degrees(np.arctan2(abs(y), x))
        side = "left" if y > 0.0 else "right"
        assert f"{degrees:.4g} deg to the {side} of forward ({module.name})" in said


def test_the_wheel_is_bonded_as_high_as_it_was_designed():
    """What is between its rim and the drum's floor, by their meshes."""
    device = DEVICES["by its face"]
    assembly = Assembly("solo12", device)
    meshes = {piece.key: piece.mesh.vertices for piece in assembly.pieces}
    rim, drum = meshes["flywheel"], meshes["drum"]
    below = drum[np.hypot(*drum[:, :2].T) < device.flywheel.inner_radius, 2].max()
    low = rim[np.hypot(*rim[:, :2].T) > device.flywheel.inner_radius, 2].min()
    assert f"Strips of {1e3 * (low - below):.1f} mm between" in texts(assembly, "Steps")
