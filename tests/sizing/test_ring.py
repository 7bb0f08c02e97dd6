"""Wheels that are rings around the bells of their motors: selection, parts and alternatives."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from designed_devices import design_of
from fronts import task_by_hand
from part_gaps import overlap_volume, turning_clearance

from ocs_design.catalogue.materials import material
from ocs_design.common.errors import SpecificationError, UsageError
from ocs_design.device.joints import balance_of, joints_of
from ocs_design.export.assembly.booklet import assembly_pages, chapters, piece_rows
from ocs_design.export.assembly.content import Assembly
from ocs_design.export.assembly.placed import bonding_pieces, placed_parts
from ocs_design.export.bill_of_materials import bill_rows
from ocs_design.export.drawing.sheet import Lettering
from ocs_design.parts.bell import FIXTURE_FIT, FIXTURE_FLOOR, GLUE_GAP
from ocs_design.parts.module import Printed
from ocs_design.parts.motor_mount import mount_of
from ocs_design.parts.printed import CLEARANCE
from ocs_design.requirement.device_sections import FlywheelSection, MotorSection, OcsSection
from ocs_design.requirement.specification import Specification
from ocs_design.requirement.sweep import Task
from ocs_design.robot.mass import MassProperties, combine
from ocs_design.sizing.alternatives import alternative_construction
from ocs_design.sizing.lightest_module import lightest_module
from ocs_design.sizing.limits import TIME
from ocs_design.sizing.selection.candidates import Candidates, drives_of
from ocs_design.sizing.selection.problem import of_parts, with_limit
from ocs_design.sizing.selection.select import lightest_by
from ocs_design.sizing.specified import selection_problem

MORE_TIME = 1.2
"""Factor of time with which no bond limits the ring."""

ALTERNATIVE_TOLERANCE = 0.015
"""Relative tolerance of an alternative's mass, whose reserve is that of the original device."""


def design_for(wheel="ring", motor="Antigravity MN5008 KV400", alpha=None, **flywheel):
    return design_of(
        Specification(
            motor=MotorSection(name=motor),
            ocs=OcsSection(wheel=wheel, alpha=alpha),
            flywheel=FlywheelSection(**flywheel),
        )
    )


@pytest.mark.slow
def test_a_ring_fits_around_the_bell_and_its_joints_hold():
    device = design_for()[1].device
    wheel, drive = device.flywheel, device.motor
    assert wheel.web is None
    assert wheel.inner_radius == pytest.approx(drive.diameter / 2.0 + GLUE_GAP, rel=1e-12)
    assert wheel.height <= 0.45 * drive.length
    assert [joint.name for joint in joints_of(device)] == [
        "largest stress of the wheel",
        "rim joint, pull on the bond",
        "shaft joint",
        "motor mount",
        "landing shock, foot",
    ]
    assert all(joint.margin >= 1.0 for joint in joints_of(device))
    assert balance_of(device).off_centre > GLUE_GAP
    assert not balance_of(device).shifted


def test_a_specified_torque_limit_holds_for_rings_as_for_discs():
    for wheel in ("ring", "disc"):
        specified = Specification(motor=MotorSection(torque_max=0.01), ocs=OcsSection(wheel=wheel))
        problem = selection_problem(Task.of(specified, task_by_hand().robot))
        assert {gear.torque_max for gear in problem.gears} == {0.01}


def test_spin_inertia_includes_the_rotor():
    _, design = design_for()
    wheel, chosen = design.device.flywheel, design.choice.chosen
    outer, inner = wheel.outer_radius, wheel.inner_radius
    plain = np.pi / 2.0 * wheel.density * wheel.height * (outer**4 - inner**4)
    cut = wheel.cuts.axial_inertia(inner, outer, wheel.density)
    assert wheel.spin_inertia == pytest.approx(plain - cut + chosen.motor.rotor_inertia, rel=1e-9)


def test_no_ring_on_a_grid_is_lighter():
    chosen = design_for()[1].choice.chosen
    limits = chosen.limits
    mount = mount_of(chosen.motor, None, chosen.problem.foot_plate, on_bell=True)
    shell = Printed(mount.holes.reach, foot_plate=chosen.problem.foot_plate, room=mount.room)
    inertia, inner = chosen.spin_inertia - chosen.drive.rotor_inertia, chosen.inner_radius
    outer = np.linspace(inner, float(limits.outer_radius_max), 4001)[1:]
    plain = inertia + limits.cuts.axial_inertia(inner, outer, limits.density)
    height = 2.0 * plain / (np.pi * limits.density * (outer**4 - inner**4))
    rim = 2.0 * plain / (outer**2 + inner**2) - limits.cuts.mass(inner, outer, limits.density)
    fits = (height <= limits.height_max) & (height >= limits.height_min)
    fits &= outer - inner >= limits.wall_min
    best = np.where(fits, rim + shell.mass(outer, height), np.inf).min()
    lightest = float(lightest_module(inertia, limits, shell).mass)
    assert lightest == pytest.approx(best, rel=1e-5)
    assert lightest <= best * (1.0 + 1e-12)
    # The chosen ring may be smaller: it is then closer to the robot, and needs less inertia.
    chosen_mass = chosen.flywheel.rim_mass + float(
        shell.mass(*map(np.array, (chosen.outer_radius, chosen.height)))
    )
    assert lightest <= chosen_mass * (1.0 + 1e-12)
    assert chosen_mass <= lightest * 1.01


def test_the_fixture_is_exported_to_step(tmp_path, monkeypatch):
    step = pytest.importorskip("ocs_design.export.step", reason="the extra [step]")
    for name in ("module_bytes", "device_bytes"):
        monkeypatch.setattr(step, name, lambda _: b"")
    step.write(SimpleNamespace(device=design_for()[1].device), tmp_path)
    assert (tmp_path / "ring_fixture.step").read_bytes().startswith(b"ISO-10303-21;")


def test_the_ring_clears_all_fixed_parts_but_its_motor():
    parts = placed_parts(design_for()[1].device)
    ring, motor = parts["flywheel"][0], parts["motor"][0]
    drum, lid = parts["drum"][0], parts["lid"][0]
    assert turning_clearance([ring], [drum, lid], 0.01) == pytest.approx(CLEARANCE, abs=1e-5)
    # The shaft protrudes from the bell, and clears the lid.
    assert turning_clearance([ring, motor], [lid], 0.01) == pytest.approx(CLEARANCE, abs=1e-5)
    assert overlap_volume(ring, motor) < 1e-12
    assert overlap_volume(motor, drum) < 1e-12
    gap = turning_clearance([ring], [motor], 0.01)
    assert gap == pytest.approx(GLUE_GAP, abs=1e-5)


def test_the_mass_of_the_device_is_that_of_its_bill():
    device = design_for()[1].device
    rows = bill_rows(device)
    assert sum(row.quantity * row.mass for row in rows) == pytest.approx(device.mass, rel=1e-12)
    names = [row.part for row in rows]
    assert any(name.startswith("epoxy") for name in names)
    assert not any(name.startswith(("retaining", "cage")) for name in names)


def test_the_carrier_has_the_mass_properties_of_its_placed_parts():
    """Except for the places of the screws, which change the centre of mass by little."""
    device = design_for()[1].device
    parts = placed_parts(device)
    names = ("drum", "lid", "foot", "motor")
    carrier_parts = combine(
        [
            part.mass_properties().moved(place.rotation, place.position)
            for part, place in (parts[name] for name in names)
        ]
    )
    point = MassProperties(device.motor.controller_mass, np.zeros(3), np.zeros((3, 3)))
    # The controller is at the centre of the body; the carrier's mass excludes the shaft.
    body = parts["motor"][0].joined[0].profile[:, 1]
    middle = np.array([0.0, 0.0, (body.min() + body.max()) / 2.0])
    carrier_parts = combine([carrier_parts, point.moved(np.eye(3), middle)])
    screws = [row for row in bill_rows(device) if row.part.startswith("screw")]
    screw_mass = sum(
        row.quantity * row.mass for row in screws if "plate on trunk" not in row.remark
    )
    screw_mass /= len(device.modules)
    carrier = device.carrier.mass_properties()
    assert carrier.mass == pytest.approx(carrier_parts.mass + screw_mass, rel=1e-9)
    # Along the axis, away from the motor; screws are within 60 mm of the wheel's centre.
    assert carrier.com[1] == pytest.approx(
        carrier_parts.com[2], abs=0.06 * screw_mass / carrier.mass
    )
    assert carrier.inertia[1, 1] == pytest.approx(carrier_parts.inertia[2, 2], rel=0.05)
    assert carrier.inertia[2, 2] == pytest.approx(carrier_parts.inertia[1, 1], rel=0.05)
    # The motor stands on the floor, and its shaft clears the lid.
    room = mount_of(device.motor, None, on_bell=True).room / 2.0 + CLEARANCE
    back = middle[2] - device.motor.length / 2.0
    shaft = device.motor.mounting.shaft_length
    assert back == pytest.approx(-room)
    assert back + device.motor.length + shaft + CLEARANCE == pytest.approx(room)


@pytest.mark.slow
def test_disc_and_ring_are_alternatives_of_each_other():
    alternatives = {}
    for wheel in ("disc", "ring"):
        task, design = design_for(wheel, alpha=0.6)
        (alternatives[wheel],) = alternative_construction(task, design.choice)
    for wheel, other in (("disc", "ring"), ("ring", "disc")):
        assert alternatives[wheel].note == f"--wheel {other}"
        mass = design_for(other, alpha=0.6)[1].device.mass
        assert alternatives[wheel].mass_total == pytest.approx(mass, rel=ALTERNATIVE_TOLERANCE)


@pytest.mark.slow
def test_no_single_motor_and_steel_has_a_lighter_ring():
    """The search prunes by bounds; a problem with one candidate cannot be pruned."""
    choice = design_for(motor=None)[1].choice
    problem = choice.problem
    some = (*problem.motors[::18], choice.chosen.motor)
    problem = replace(problem, motors=some, incidence=choice.chosen.incidence)
    candidates = [
        lightest_by(replace(problem, motors=(motor,), materials=(kind,)), None)[0]
        for motor in problem.motors
        for kind in problem.materials
    ]
    lightest = min(each.mass for each in candidates if each is not None)
    assert lightest_by(problem, None)[0].mass == pytest.approx(lightest, rel=1e-3)


@pytest.mark.parametrize("heavier", [-1e-9, 1e-9])
def test_of_equally_heavy_rings_the_one_with_the_stronger_bond_leads(heavier):
    """A ring that expands more than its bell pulls on the glue when both are warm."""
    choice = design_for()[1].choice
    incidence = choice.chosen.incidence
    problem = with_limit(choice.problem, TIME, MORE_TIME)
    strong, close = material("steel-4140-qt"), material("steel-1045-normalized")
    assert strong.yield_strength > close.yield_strength
    assert strong.thermal_expansion > close.thermal_expansion
    steels = strong, replace(close, density=strong.density * (1.0 + heavier))
    both = [
        lightest_by(replace(problem, materials=(one,), incidence=incidence), None)[0]
        for one in steels
    ]
    assert both[0].mass == pytest.approx(both[1].mass, rel=1e-7)
    lightest, _ = lightest_by(replace(problem, materials=steels, incidence=incidence), None)
    assert lightest.material.name == close.name


def test_a_motor_without_a_bell_is_refused_with_a_cure():
    with pytest.raises(UsageError, match="no ring fits around the bell of EC 45") as raised:
        design_for(motor="EC 45 flat 70 W 411812")
    assert "--wheel ring" in raised.value.hint


def test_lightening_holes_contradict_a_ring():
    with pytest.raises(SpecificationError) as raised:
        design_for(lightening=6)
    assert any("ocs.wheel" in problem for problem in raised.value.problems)


def test_a_bell_smaller_than_the_least_bore_has_no_ring():
    choice = design_for()[1].choice
    envelope = replace(choice.problem.envelope, inner_radius_min=0.03)
    alone = of_parts(replace(choice.problem, envelope=envelope), choice.chosen)
    first = np.zeros(1, dtype=np.intp)
    narrow = Candidates(alone, drives_of(alone, first.repeat(2)[None]), first).limits.take(0)
    assert np.isnan(float(lightest_module(1e-4, narrow, Printed(0.01)).mass))


def test_the_fixture_holds_ring_and_bell_as_in_the_module():
    """Both stand on it without overlap, and the shaft does not lift it off the table."""
    device = design_for()[1].device
    pieces = {piece.key: piece.mesh.vertices for piece in bonding_pieces(device)}
    assert list(pieces) == ["ring_fixture", "motor", "flywheel"]
    fixture, motor, ring = (vertices * [1.0, -1.0, 1.0] for vertices in pieces.values())
    # y is up: the bell is on the floor, the ring on the step.
    shaft = device.motor.mounting.shaft_length
    assert shaft > FIXTURE_FLOOR
    assert 0.0 < motor[:, 1].min() < FIXTURE_FIT * 1.001
    front = motor[:, 1].min() + shaft
    low, wheel = ring[:, 1].min(), device.flywheel
    radius = np.hypot(fixture[:, 0], fixture[:, 2])
    below_ring = (radius > wheel.inner_radius) & (radius < wheel.outer_radius)
    assert fixture[below_ring, 1].max() == pytest.approx(low)
    distance = ring[:, 1].mean() - front
    assert distance == pytest.approx(device.mount.bell.front, abs=1e-6)


@pytest.mark.slow
def test_the_booklet_has_the_fixture_in_table_picture_and_steps():
    assembly = Assembly("solo12", design_for()[1].device)
    row = next(row for row in piece_rows(assembly) if row.file == "ring_fixture.stl")
    assert row.number == len(assembly.numbers)
    steps = next(each for each in chapters(assembly) if each.title.startswith("Steps")).texts
    assert any(f"Print the fixture ({row.number})" in text for text in steps)
    # The fixture sets the height of a ring, not strips of another thickness.
    before = next(each for each in chapters(assembly) if each.title.startswith("Before")).texts
    assert any("strips of 1.5 mm for gaps" in text for text in before)
    page = assembly_pages(assembly)[1]
    texts = [item.text for item in page if isinstance(item, Lettering)]
    assert str(row.number) in texts
    assert sum(text.startswith("One module cut along its axis, 1:") for text in texts) == 1
    assert not Assembly("solo12", design_for("disc")[1].device).bonding
