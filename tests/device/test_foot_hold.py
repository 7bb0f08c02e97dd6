"""What holds a foot: heads beside its slots, the edge that it tilts about, what turns it."""

import re
from dataclasses import replace

import numpy as np
import pytest
from built_devices import DEVICES, housed_device, with_plate
from manifold3d import Manifold, Mesh64
from scipy.integrate import quad

from ocs_design.actuation.fasteners import screw
from ocs_design.device.joints import (
    BEARING_MOMENT,
    FOOT_SHOCK,
    foot_hold,
    foot_screws,
    joints_of,
    unheld_moment,
)
from ocs_design.device.records.device import Margin
from ocs_design.device.solids import foot_of
from ocs_design.export.assembly.booklet import chapters, piece_rows, screw_rows
from ocs_design.export.assembly.content import Assembly
from ocs_design.export.assembly.placed import module_pieces
from ocs_design.export.assembly_notes import drive_notes
from ocs_design.export.bill_of_materials import bill_rows

SLOT, SHOCK = 3.4, 20.0 * 9.80665


def weighing(mass, plated=True):
    """The caged device with modules of that mass, on a plate or on the trunk."""
    device = DEVICES["caged"]
    carrier = replace(device.carrier, mass=mass - device.flywheel.mass)
    device = replace(device, carrier=carrier)
    return with_plate(device) if plated else device


def beside_a_slot(across):
    """Area of a disc with a strip through its middle left out, as an integral [mm^2]."""
    radius = across / 2.0
    half, _ = quad(lambda x: 2.0 * np.sqrt(radius**2 - x**2), SLOT / 2.0, radius)
    return 2.0 * half


def pulled(device, mass):
    """Pull of the far one of two screws [N]: both give way as far as they are from the edge."""
    foot = foot_of(device)
    edge = foot.base_radius if device.plate is None else device.plate.radius
    arms = edge + foot.slot_radius * np.array([1.0, -1.0])
    return mass * SHOCK * foot.wheel_height * arms[0] / (arms @ arms)


@pytest.mark.parametrize(("across", "area"), [(5.5, 6.33), (9.0, 33.77)])
def test_a_head_presses_on_what_its_slot_leaves(across, area):
    """M3: 6.3 of the 14.7 mm^2 around a round hole, and 33.8 under a large washer, ISO 7093-1."""
    found = 1e6 * screw("M3").slot_area(1e-3 * across)
    assert found == pytest.approx(beside_a_slot(across), rel=1e-6) == pytest.approx(area, abs=0.01)


@pytest.mark.parametrize("plated", [True, False])
@pytest.mark.parametrize("mass", [0.3, 2.0, 12.0])
def test_heads_bear_a_landing_or_have_washers_or_it_is_told(mass, plated):
    device = weighing(mass, plated)
    hold, pull = foot_hold(device), pulled(device, mass)
    assert hold.pull == pytest.approx(pull)
    # Tightened to half of what PETG yields at, a bare head would let the foot lift.
    assert hold.washers == (pull / beside_a_slot(5.5) > 47.0 / 2.0)
    pressed = pull / beside_a_slot(9.0 if hold.washers else 5.5)
    assert hold.heads_bear == pytest.approx(SHOCK * 47.0 / pressed)
    margin = next(each for each in joints_of(device) if each.name == FOOT_SHOCK)
    assert margin.capacity == pytest.approx(min(hold.heads_bear, hold.prints_bear))
    washers = [row.quantity for row in bill_rows(device) if row.part == "washer ISO 7093-1 - 3"]
    assert washers == ([4] if hold.washers else [])
    milled = re.search(r"press with (\d+) MPa even on washers", " ".join(drive_notes(device)))
    assert (milled is not None) == (pressed > 47.0)
    assert not milled or int(milled[1]) == round(pressed)


@pytest.mark.parametrize("mass", [0.3, 2.0])
def test_torque_of_a_foot_s_screws_is_what_beside_a_slot_bears(mass):
    """Half of 47 MPa on 6.33 mm^2 are 149 N, 0.079 N m; on 33.8 mm^2 794 N, 0.42 N m."""
    assembly = Assembly("solo12", weighing(mass))
    (row,) = (row for row in screw_rows(assembly) if row.purpose.startswith("foot on"))
    assert row.torque == ("0.079 N m" if mass == 0.3 else "0.42 N m")
    (bought,) = (row.made for row in piece_rows(assembly) if "screw, foot on" in row.name)
    for words in (row.purpose, bought):
        assert ("ISO 7093-1 - 3" in words) == (mass == 2.0)
    length = int(re.search(r"x (\d+)$", row.designation)[1])
    base = 1e3 * float(foot_of(assembly.device).base) + (0.8 if mass == 2.0 else 0.0)
    # The next would reach the trunk under 3 mm of plate, which it may by half of IT15.
    assert length == (6 if mass == 2.0 else 5)
    thread = length - base
    assert row.engagement.startswith(f"{thread:.1f} mm ({thread / 3.0:.1f} d)")
    assert "cut to" not in row.purpose
    parts = [each.part for each in bill_rows(assembly.device) if "foot on plate" in each.remark]
    # So light a module leaves nothing for prints and their screws.
    assert parts == ([f"screw {row.designation}"] if mass == 2.0 else [])


@pytest.mark.parametrize(
    ("base", "length", "cut"),
    [
        (3.0, 5, None),
        (3.3, 6, None),
        (4.4, 6, None),
        # 6 mm would have less than three turns: M3 x 8, made to +-0.29, is cut.
        (4.6, 8, 7.3),
        (5.0, 8, 7.7),
        (5.4, 8, None),
    ],
)
def test_no_foot_s_screw_reaches_the_trunk_under_its_plate(base, length, cut):
    """Lengths of ISO 4762 are made to js15: 0.24 mm up to 6 mm, 0.29 mm up to 10 mm."""
    device = replace(weighing(0.3), foot_plate=base / 0.6e3)
    assert device.plate.thickness == 0.003
    held = foot_screws(device, device.modules[0])
    assert held.thickness == pytest.approx(1e-3 * base)
    assert held.length == pytest.approx(1e-3 * length)
    assert (f"cut to {cut} mm, or they reach the trunk" in held.purpose) == bool(cut)
    made = length + (0.24 if length <= 6 else 0.29)
    assert (cut or made) <= base + 3.0
    assert held.engagement == pytest.approx(1e-3 * ((cut or length) - base))
    assert held.engagement >= 1.5e-3


@pytest.mark.parametrize("share", [0.9, 1.1])
def test_a_foot_that_its_wheel_would_turn_is_pinned(share):
    """Friction of 0.1 under two screws, at the least preload that a wrench leaves, 1 / 1.6."""
    device = weighing(0.3)
    holds = 0.1 * 2.0 * (23.5 * beside_a_slot(5.5)) / 1.6 * foot_of(device).slot_radius
    asked = Margin(name=BEARING_MOMENT, demand=share * holds, capacity=None, unit="N m")
    assert bool(unheld_moment(device, (asked,))) == (share > 1.0)
    steps = " ".join(
        text for each in chapters(Assembly("s", device, (asked,))) for text in each.texts
    )
    assert ("put a pin in" in steps) == (share > 1.0)
    pins = [row.quantity for row in bill_rows(device, (asked,)) if row.part == "pin of 3 mm"]
    assert pins == ([2] if share > 1.0 else [])


def test_a_screw_under_the_cage_has_a_key_that_goes_there():
    """What is told is clear above its head, for a key of 2.5 mm across the flats."""
    mounting = DEVICES["caged"].motor.mounting
    device = housed_device(mounting, outer_radius=0.05)
    steps = " ".join(text for each in chapters(Assembly("s", device)) for text in each.texts)
    found = re.search(r"under the motor, with (\d+) mm above its head: .* cut to (\d+) mm", steps)
    assert found
    room = float(found[1])
    assert float(found[2]) < room < 18.0
    pieces = {each.key: each for each in module_pieces(device)}
    heads = pieces[foot_screws(device, device.modules[0])].mesh.vertices
    # Up is -y; the inner screw is on the motor's side, at -z.
    inner = heads[heads[:, 2] < 0.0]
    x, _, z = (inner.min(axis=0) + inner.max(axis=0)) / 2.0
    top = inner[:, 1].min()
    key = Manifold.cylinder(1.0, 1.25e-3, circular_segments=6).rotate([90.0, 0.0, 0.0])

    def hits(height):
        """Whether a key that stands so high above the head meets what is over it."""
        leg = key.scale([1.0, 1e-3 * height, 1.0]).translate([x, top, z])
        return any(
            (leg ^ Manifold(Mesh64(each.mesh.vertices, each.mesh.triangles))).volume() > 0.0
            for each in (pieces["cage"], pieces["motor"])
        )

    assert not hits(room - 0.5)
    assert hits(room + 6.0)


def test_what_washers_weigh_beside_the_device_is_in_the_bill():
    """9.0 mm across, 3.2 mm inside and 0.8 mm high, of steel: 0.35 g each."""
    device = weighing(2.0, plated=False)
    (row,) = (each for each in bill_rows(device) if each.part == "washer ISO 7093-1 - 3")
    grams = 4 * 0.25 * np.pi * (9.0**2 - 3.2**2) * 0.8 * 7.85e-3
    # Screws of M3 go in steps of 2 mm: they are longer by one, and weighed without it.
    (screws,) = (each for each in bill_rows(device) if each.remark.startswith("foot on trunk"))
    assert screws.remark.endswith("weighed as ISO 4762 M3 x 6")
    assert (screws.part, screws.mass) == ("screw ISO 4762 M3 x 8", screw("M3").mass(0.006))
    grams += 4e3 * (screw("M3").mass(0.008) - screw("M3").mass(0.006))
    told = f"not in the mass: {grams:.1f} g in all, {1e-3 * grams / device.mass:.2%} of the device"
    assert row.mass == 0.0
    assert told in row.remark
