"""Fastening of a foot: heads of screws at its slots, tilting edge, and torque about its axis."""

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
    foot_screws,
    joints_of,
    unheld_moment,
)
from ocs_design.device.records.flights import Margin
from ocs_design.export.assembly.booklet import chapters, piece_rows, screw_rows
from ocs_design.export.assembly.content import Assembly
from ocs_design.export.assembly.placed import module_pieces
from ocs_design.export.assembly_notes import drive_notes
from ocs_design.export.bill_of_materials import bill_rows

SLOT, SHOCK = 3.4, 20.0 * 9.80665


def device_with_module_mass(mass, plated=True):
    """The caged device with modules of this mass, on a plate or on the trunk."""
    device = DEVICES["caged"]
    carrier = replace(device.carrier, mass=mass - device.flywheel.mass)
    device = replace(device, carrier=carrier)
    return with_plate(device) if plated else device


def area_beside_slot(across):
    """Area of a disc without a strip through its middle, by integration [mm^2]."""
    radius = across / 2.0
    half, _ = quad(lambda x: 2.0 * np.sqrt(radius**2 - x**2), SLOT / 2.0, radius)
    return 2.0 * half


def pull_of_screw(device, mass):
    """Tension of the farther of two screws [N]; both stretch by their distance from the edge."""
    foot = device.foot
    edge = foot.base_radius if device.plate is None else device.plate.radius
    arms = edge + foot.slot_radius * np.array([1.0, -1.0])
    return mass * SHOCK * foot.wheel_height * arms[0] / (arms @ arms)


@pytest.mark.parametrize(("across", "area"), [(5.5, 6.33), (9.0, 33.77)])
def test_the_area_under_a_head_is_reduced_by_the_slot(across, area):
    """M3: 6.3 mm^2 instead of 14.7 mm^2 around a round hole; 33.8 mm^2 with a washer ISO 7093-1."""
    actual = 1e6 * screw("M3").slot_area(1e-3 * across)
    assert (
        actual == pytest.approx(area_beside_slot(across), rel=1e-6) == pytest.approx(area, abs=0.01)
    )


@pytest.mark.parametrize("plated", [True, False])
@pytest.mark.parametrize("mass", [0.3, 2.0, 12.0])
def test_heads_of_screws_bear_a_landing_or_have_washers_or_a_note(mass, plated):
    device = device_with_module_mass(mass, plated)
    hold, pull = device.foot_hold, pull_of_screw(device, mass)
    assert hold.pull == pytest.approx(pull)
    # Preloaded to half the yield pressure of PETG, a bare head would let the foot lift.
    assert hold.washers == (pull / area_beside_slot(5.5) > 47.0 / 2.0)
    pressure = pull / area_beside_slot(9.0 if hold.washers else 5.5)
    assert hold.heads_bear == pytest.approx(SHOCK * 47.0 / pressure)
    margin = next(joint for joint in joints_of(device) if joint.name == FOOT_SHOCK)
    assert margin.capacity == pytest.approx(min(hold.heads_bear, hold.prints_bear))
    washers = [row.quantity for row in bill_rows(device) if row.part == "washer ISO 7093-1 - 3"]
    assert washers == ([4] if hold.washers else [])
    note = re.search(r"press with (\d+) MPa even on washers", " ".join(drive_notes(device)))
    assert (note is not None) == (pressure > 47.0)
    assert not note or int(note[1]) == round(pressure)


@pytest.mark.parametrize("mass", [0.3, 2.0])
def test_the_torque_of_foot_screws_follows_from_the_area_beside_the_slot(mass):
    """Half of 47 MPa on 6.33 mm^2 is 149 N, 0.079 N m; on 33.8 mm^2 794 N, 0.42 N m."""
    assembly = Assembly("solo12", device_with_module_mass(mass))
    (row,) = (row for row in screw_rows(assembly) if row.purpose.startswith("foot on"))
    assert row.torque == ("0.079 N m" if mass == 0.3 else "0.42 N m")
    (bought,) = (row.made for row in piece_rows(assembly) if "screw, foot on" in row.name)
    for words in (row.purpose, bought):
        assert ("ISO 7093-1 - 3" in words) == (mass == 2.0)
    length = int(re.search(r"x (\d+)$", row.designation)[1])
    base = 1e3 * float(assembly.device.foot.base) + (0.8 if mass == 2.0 else 0.0)
    # The next length would touch the trunk under 3 mm of plate at its upper limit of js15.
    assert length == (6 if mass == 2.0 else 5)
    thread = length - base
    assert row.engagement.startswith(f"{thread:.1f} mm ({thread / 3.0:.1f} d)")
    assert "cut to" not in row.purpose
    parts = [row.part for row in bill_rows(assembly.device) if "foot on plate" in row.remark]
    # The mass of such a light module leaves nothing for prints and their screws.
    assert parts == ([f"screw {row.designation}"] if mass == 2.0 else [])


@pytest.mark.parametrize(
    ("base", "length", "cut"),
    [
        (3.0, 5, None),
        (3.3, 6, None),
        (4.4, 6, None),
        # 6 mm would engage less than three turns: M3 x 8 with js15 of 0.29 mm is cut.
        (4.6, 8, 7.3),
        (5.0, 8, 7.7),
        (5.4, 8, None),
    ],
)
def test_foot_screws_do_not_reach_the_trunk_under_the_plate(base, length, cut):
    """Lengths of ISO 4762 have a tolerance of js15: 0.24 mm up to 6 mm, 0.29 mm up to 10 mm."""
    device = replace(device_with_module_mass(0.3), foot_plate=base / 0.6e3)
    assert device.plate.thickness == 0.003
    fastening = foot_screws(device, device.modules[0])
    assert fastening.thickness == pytest.approx(1e-3 * base)
    assert fastening.length == pytest.approx(1e-3 * length)
    assert (f"cut to {cut} mm, or they reach the trunk" in fastening.purpose) == bool(cut)
    longest = length + (0.24 if length <= 6 else 0.29)
    assert (cut or longest) <= base + 3.0
    assert fastening.engagement == pytest.approx(1e-3 * ((cut or length) - base))
    assert fastening.engagement >= 1.5e-3


@pytest.mark.parametrize("share", [0.9, 1.1])
def test_a_foot_that_its_wheel_would_turn_is_pinned(share):
    """Friction of 0.1 under two screws at the least preload of a torque wrench, 1 / 1.6."""
    device = device_with_module_mass(0.3)
    friction_moment = 0.1 * 2.0 * (23.5 * area_beside_slot(5.5)) / 1.6 * device.foot.slot_radius
    margin = Margin(name=BEARING_MOMENT, demand=share * friction_moment, capacity=None, unit="N m")
    assert bool(unheld_moment(device, (margin,))) == (share > 1.0)
    steps = " ".join(
        text for chapter in chapters(Assembly("s", device, (margin,))) for text in chapter.texts
    )
    assert ("put a pin in" in steps) == (share > 1.0)
    pins = [row.quantity for row in bill_rows(device, (margin,)) if row.part == "pin of 3 mm"]
    assert pins == ([2] if share > 1.0 else [])


def test_the_key_for_a_screw_under_the_cage_fits():
    """The written clearance above the head is free for a key of 2.5 mm across the flats."""
    mounting = DEVICES["caged"].motor.mounting
    device = housed_device(mounting, outer_radius=0.05)
    steps = " ".join(text for chapter in chapters(Assembly("s", device)) for text in chapter.texts)
    match = re.search(r"under the motor, with (\d+) mm above its head: .* cut to (\d+) mm", steps)
    assert match
    clearance = float(match[1])
    assert float(match[2]) < clearance < 18.0
    pieces = {piece.key: piece for piece in module_pieces(device)}
    heads = pieces[foot_screws(device, device.modules[0])].mesh.vertices
    # Up is -y; the inner screw is on the motor's side, at -z.
    inner = heads[heads[:, 2] < 0.0]
    x, _, z = (inner.min(axis=0) + inner.max(axis=0)) / 2.0
    top = inner[:, 1].min()
    key = Manifold.cylinder(1.0, 1.25e-3, circular_segments=6).rotate([90.0, 0.0, 0.0])

    def hits(height):
        """Whether a key of this height above the head collides with cage or motor."""
        leg = key.scale([1.0, 1e-3 * height, 1.0]).translate([x, top, z])
        return any(
            (leg ^ Manifold(Mesh64(piece.mesh.vertices, piece.mesh.triangles))).volume() > 0.0
            for piece in (pieces["cage"], pieces["motor"])
        )

    assert not hits(clearance - 0.5)
    assert hits(clearance + 6.0)


def test_the_additional_mass_of_washers_is_in_the_bill():
    """Steel washers of 9.0 mm by 3.2 mm by 0.8 mm: 0.35 g each."""
    device = device_with_module_mass(2.0, plated=False)
    (row,) = (row for row in bill_rows(device) if row.part == "washer ISO 7093-1 - 3")
    grams = 4 * 0.25 * np.pi * (9.0**2 - 3.2**2) * 0.8 * 7.85e-3
    # The screws are one step of 2 mm longer, which is not in their mass.
    (screws,) = (row for row in bill_rows(device) if row.remark.startswith("foot on trunk"))
    assert screws.remark.endswith("weighed as ISO 4762 M3 x 6")
    assert (screws.part, screws.mass) == ("screw ISO 4762 M3 x 8", screw("M3").mass(0.006))
    grams += 4e3 * (screw("M3").mass(0.008) - screw("M3").mass(0.006))
    remark = (
        f"not in the mass: {grams:.1f} g in all, {1e-3 * grams / device.mass:.2%} of the device"
    )
    assert row.mass == 0.0
    assert remark in row.remark
