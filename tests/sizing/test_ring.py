"""Wheels that are rings around the bells of their motors, chosen, built and compared."""

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
from ocs_design.device.solids import motor_mount
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
"""Factor with which no bond limits the ring."""

ABOUT = 0.015
"""To which an alternative's mass is good: the reserve of the device as it stands is kept."""


def made(wheel="ring", motor="Antigravity MN5008 KV400", alpha=None, **flywheel):
    return design_of(
        Specification(
            motor=MotorSection(name=motor),
            ocs=OcsSection(wheel=wheel, alpha=alpha),
            flywheel=FlywheelSection(**flywheel),
        )
    )


@pytest.mark.slow
def test_it_is_around_the_bell_within_its_straight_part_and_its_joints_hold():
    _, designed = made()
    wheel, drive = designed.device.flywheel, designed.device.motor
    assert wheel.web is None
    assert wheel.inner_radius == pytest.approx(drive.diameter / 2.0 + GLUE_GAP, rel=1e-12)
    assert wheel.height <= 0.45 * drive.length
    assert [joint.name for joint in joints_of(designed.device)] == [
        "largest stress of the wheel",
        "rim joint, pull on the bond",
        "shaft joint",
        "landing shock, foot",
    ]
    assert all(joint.margin >= 1.0 for joint in joints_of(designed.device))
    assert balance_of(designed.device).off_centre > GLUE_GAP
    assert not balance_of(designed.device).shifted


def test_a_specified_torque_limit_holds_for_rings_as_for_discs():
    for wheel in ("ring", "disc"):
        specified = Specification(motor=MotorSection(torque_max=0.01), ocs=OcsSection(wheel=wheel))
        problem = selection_problem(Task.of(specified, task_by_hand().robot))
        assert {gear.torque_max for gear in problem.gears} == {0.01}


def test_the_rotor_counts():
    _, designed = made()
    wheel, chosen = designed.device.flywheel, designed.choice.chosen
    outer, inner = wheel.outer_radius, wheel.inner_radius
    plain = np.pi / 2.0 * wheel.density * wheel.height * (outer**4 - inner**4)
    cut = wheel.cuts.axial_inertia(inner, outer, wheel.density)
    assert wheel.spin_inertia == pytest.approx(plain - cut + chosen.motor.rotor_inertia, rel=1e-9)


def test_no_ring_on_a_grid_is_lighter():
    _, designed = made()
    chosen = designed.choice.chosen
    limits = chosen.limits
    mount = mount_of(chosen.motor, None, chosen.foot_plate, on_bell=True)
    shell = Printed(mount.holes.reach, foot_plate=chosen.foot_plate, room=mount.room)
    inertia, inner = chosen.spin_inertia - chosen.drive.rotor_inertia, chosen.inner_radius
    outer = np.linspace(inner, float(limits.outer_radius_max), 4001)[1:]
    left = inertia + limits.cuts.axial_inertia(inner, outer, limits.density)
    height = 2.0 * left / (np.pi * limits.density * (outer**4 - inner**4))
    rim = 2.0 * left / (outer**2 + inner**2) - limits.cuts.mass(inner, outer, limits.density)
    fits = (height <= limits.height_max) & (height >= limits.height_min)
    fits &= outer - inner >= limits.wall_min
    best = np.where(fits, rim + shell.mass(outer, height), np.inf).min()
    found = float(lightest_module(inertia, limits, shell).mass)
    assert found == pytest.approx(best, rel=1e-5)
    assert found <= best * (1.0 + 1e-12)
    # A smaller one stands nearer to the robot, and needs a little less.
    own = chosen.rim_mass + float(shell.mass(*map(np.array, (chosen.outer_radius, chosen.height))))
    assert found <= own * (1.0 + 1e-12)
    assert own <= found * 1.01


def test_its_fixture_has_an_exact_solid_too(tmp_path, monkeypatch):
    step = pytest.importorskip("ocs_design.export.step", reason="the extra [step]")
    for whole in ("module_bytes", "device_bytes"):
        monkeypatch.setattr(step, whole, lambda _: b"")
    step.write(SimpleNamespace(device=made()[1].device), tmp_path)
    assert (tmp_path / "ring_fixture.step").read_bytes().startswith(b"ISO-10303-21;")


def test_it_turns_free_of_all_that_stands_but_its_motor():
    _, designed = made()
    parts = placed_parts(designed.device)
    ring, motor = parts["flywheel"][0], parts["motor"][0]
    still = [parts[name][0] for name in ("drum", "lid")]
    turning = turning_clearance([ring, motor], still[1:], 0.01)
    assert turning_clearance([ring], still, 0.01) == pytest.approx(CLEARANCE, abs=1e-5)
    # The shaft stands out of the bell, and is clear of the lid.
    assert turning == pytest.approx(CLEARANCE, abs=1e-5)
    assert overlap_volume(ring, motor) < 1e-12
    assert overlap_volume(motor, still[0]) < 1e-12
    gap = turning_clearance([ring], [motor], 0.01)
    assert gap == pytest.approx(GLUE_GAP, abs=1e-5)


def test_the_device_weighs_what_its_parts_weigh():
    _, designed = made()
    device = designed.device
    rows = bill_rows(device)
    assert sum(row.quantity * row.mass for row in rows) == pytest.approx(device.mass, rel=1e-12)
    names = [row.part for row in rows]
    assert any(name.startswith("epoxy") for name in names)
    assert not any(name.startswith(("retaining", "cage")) for name in names)


def test_what_stands_still_has_the_mass_properties_of_its_parts_in_their_places():
    """But for the screws, whose mass is known and whose places move the middle by little."""
    device = made()[1].device
    parts = placed_parts(device)
    names = ("drum", "lid", "foot", "motor")
    still = combine(
        [
            part.mass_properties().moved(place.rotation, place.position)
            for part, place in (parts[name] for name in names)
        ]
    )
    point = MassProperties(device.motor.controller_mass, np.zeros(3), np.zeros((3, 3)))
    # It is where the body's middle is, and the carrier was weighed without the shaft.
    body = parts["motor"][0].joined[0].profile[:, 1]
    middle = np.array([0.0, 0.0, (body.min() + body.max()) / 2.0])
    still = combine([still, point.moved(np.eye(3), middle)])
    screws = [row for row in bill_rows(device) if row.part.startswith("screw")]
    own = sum(row.quantity * row.mass for row in screws if "plate on trunk" not in row.remark)
    own /= len(device.modules)
    carrier = device.carrier.mass_properties()
    assert carrier.mass == pytest.approx(still.mass + own, rel=1e-9)
    # Along the axis, away from the motor; screws are within 60 mm of the wheel's middle.
    assert carrier.com[1] == pytest.approx(still.com[2], abs=0.06 * own / carrier.mass)
    assert carrier.inertia[1, 1] == pytest.approx(still.inertia[2, 2], rel=0.05)
    assert carrier.inertia[2, 2] == pytest.approx(still.inertia[1, 1], rel=0.05)
    # The motor stands on the floor, and its shaft is clear of the lid.
    room = mount_of(device.motor, None, on_bell=True).room / 2.0 + CLEARANCE
    back = middle[2] - device.motor.length / 2.0
    shaft = device.motor.mounting.shaft_length
    assert back == pytest.approx(-room)
    assert back + device.motor.length + shaft + CLEARANCE == pytest.approx(room)


@pytest.mark.slow
def test_each_construction_tells_of_the_other():
    sides, alone = {}, {"alpha": 0.6}
    for wheel in ("disc", "ring"):
        task, designed = made(wheel, **alone)
        (sides[wheel],) = alternative_construction(task, designed.choice)
    for wheel, other in (("disc", "ring"), ("ring", "disc")):
        assert sides[wheel].note == f"--wheel {other}"
        mass = made(other, **alone)[1].device.mass
        assert sides[wheel].mass_total == pytest.approx(mass, rel=ABOUT)


@pytest.mark.slow
def test_none_of_the_motors_and_steels_alone_has_a_lighter_one():
    """The search leaves out what its bounds say is heavier: each by itself cannot be left out."""
    _, designed = made(motor=None)
    problem = designed.choice.problem
    some = (*problem.motors[::18], designed.choice.chosen.motor)
    problem = replace(problem, motors=some, incidence=designed.choice.chosen.incidence)
    found = [
        lightest_by(replace(problem, motors=(motor,), materials=(kind,)), None)
        for motor in problem.motors
        for kind in problem.materials
    ]
    least = min(each.mass for each in found if each is not None)
    assert lightest_by(problem, None).mass == pytest.approx(least, rel=1e-3)


@pytest.mark.parametrize("heavier", [-1e-9, 1e-9])
def test_of_equally_heavy_rings_the_one_whose_bond_holds_more_leads(heavier):
    """A ring that expands more than its bell pulls on the glue when both are warm."""
    _, designed = made()
    at = designed.choice.chosen.incidence
    problem = with_limit(designed.choice.problem, TIME, MORE_TIME)
    strong, close = material("steel-4140-normalized"), material("steel-1045-cold-worked")
    assert strong.yield_strength > close.yield_strength
    assert strong.thermal_expansion > close.thermal_expansion
    steels = strong, replace(close, density=strong.density * (1.0 + heavier))
    both = [lightest_by(replace(problem, materials=(one,), incidence=at), None) for one in steels]
    assert both[0].mass == pytest.approx(both[1].mass, rel=1e-7)
    found = lightest_by(replace(problem, materials=steels, incidence=at), None)
    assert found.material.name == close.name


def test_a_motor_without_a_bell_is_refused_with_a_cure():
    with pytest.raises(UsageError, match="no ring fits around the bell of EC 45") as raised:
        made(motor="EC 45 flat 70 W 411812")
    assert "--wheel ring" in raised.value.hint


def test_what_a_ring_has_nothing_of_is_a_contradiction():
    with pytest.raises(SpecificationError) as raised:
        made(lightening=6)
    assert any("ocs.wheel" in problem for problem in raised.value.problems)


def test_a_bore_below_the_least_is_no_ring():
    _, designed = made()
    envelope = replace(designed.choice.problem.envelope, inner_radius_min=0.03)
    alone = of_parts(replace(designed.choice.problem, envelope=envelope), designed.choice.chosen)
    first = np.zeros(1, dtype=np.intp)
    narrow = Candidates(alone, drives_of(alone, first.repeat(2)[None]), first).limits.take(0)
    assert np.isnan(float(lightest_module(1e-4, narrow, Printed(0.01)).mass))


def test_in_their_fixture_ring_and_bell_stand_as_they_do_in_the_module():
    """Both stand on it, in none of its walls, as far from each other as in the housing, and the
    shaft does not lift it off the table."""
    device = made()[1].device
    pieces = {piece.key: piece.mesh.vertices for piece in bonding_pieces(device)}
    assert list(pieces) == ["ring_fixture", "motor", "flywheel"]
    fixture, motor, ring = (vertices * [1.0, -1.0, 1.0] for vertices in pieces.values())
    # Of y up: the bell on the floor, the ring on the step; nothing of the fixture in the ring.
    shaft = device.motor.mounting.shaft_length
    assert shaft > FIXTURE_FLOOR
    assert 0.0 < motor[:, 1].min() < FIXTURE_FIT * 1.001
    front = motor[:, 1].min() + shaft
    low, wheel = ring[:, 1].min(), device.flywheel
    away = np.hypot(fixture[:, 0], fixture[:, 2])
    within = (away > wheel.inner_radius) & (away < wheel.outer_radius)
    assert fixture[within, 1].max() == pytest.approx(low)
    middle = -motor_mount(device).bell.front
    apart = ring[:, 1].mean() - front
    assert apart == pytest.approx(-middle, abs=1e-6)


@pytest.mark.slow
def test_the_booklet_has_the_fixture_in_table_picture_and_steps():
    assembly = Assembly("solo12", made()[1].device)
    row = next(row for row in piece_rows(assembly) if row.file == "ring_fixture.stl")
    assert row.number == len(assembly.numbers)
    steps = next(each for each in chapters(assembly) if each.title.startswith("Steps")).texts
    assert any(f"Print the fixture ({row.number})" in text for text in steps)
    # The fixture sets the height of a ring, and no strips of another thickness.
    before = next(each for each in chapters(assembly) if each.title.startswith("Before")).texts
    assert any("strips of 1.5 mm for gaps" in text for text in before)
    page = assembly_pages(assembly)[1]
    texts = [item.text for item in page if isinstance(item, Lettering)]
    assert str(row.number) in texts
    assert sum(text.startswith("One module cut along its axis, 1:") for text in texts) == 1
    assert not Assembly("solo12", made("disc")[1].device).bonding
