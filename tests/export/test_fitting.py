"""Notes where a motor, its wheel and the printed parts do not simply fit."""

import re
from dataclasses import replace

import numpy as np
import pytest
from built_devices import DEVICES, FLAT, device_in_layout
from hypothesis import given
from hypothesis import strategies as st
from wheels import EC45, PAPER_WHEEL, driven_device, geared, paper_device

from ocs_design.actuation.fasteners import BoltCircle
from ocs_design.actuation.motor import Face, Mounting
from ocs_design.device.bodies import wheel_placement
from ocs_design.device.device import Device
from ocs_design.device.layout import Layout, LayoutName
from ocs_design.export.assembly.content import Assembly
from ocs_design.export.assembly.steps import module_steps
from ocs_design.export.assembly_notes import device_notes, drive_notes
from ocs_design.export.device_parts import printed_parts
from ocs_design.export.meshes import part_manifold
from ocs_design.export.visuals import still_visuals
from ocs_design.parts.foot import foot_shock, plate_thickness
from ocs_design.parts.rim import Hub, RimCuts
from ocs_design.parts.wheel import Web

WEB = Web("aluminium-6061-t6", 2710.0, 0.0015, 0.01, Hub(0.008, 0.005, 0.002))
BACK_OF_PLATE = 0.005 + 0.002 + 0.0012 + 0.005
"""Distance from the wheel's middle: half of the rim's 10 mm, clearance, floor and plate [m]."""


def device_on(mounting, drive=EC45, offset=0.05, incidence=0.3) -> Device:
    device = driven_device(incidence, replace(drive, mounting=mounting))
    left, right = device.modules
    modules = (
        replace(left, position=np.array([0.0, offset, 0.05])),
        replace(right, position=np.array([0.0, -offset, 0.05])),
    )
    return replace(device, modules=modules, flywheel=replace(PAPER_WHEEL, web=WEB))


def notes(device):
    return " | ".join(drive_notes(device))


def test_a_long_enough_shaft_needs_no_note():
    assert notes(device_on(replace(FLAT, shaft_length=BACK_OF_PLATE + 1e-6))) == ""
    assert notes(paper_device()) == ""


def test_broken_edges_that_were_not_designed_are_noted():
    device = paper_device()
    (remark,) = device_notes(device)
    assert remark == "with its edges broken 0.2 mm a wheel has 0.10% less inertia than was designed"
    cut = replace(device.flywheel, cuts=RimCuts(chamfer=0.2e-3))
    assert device_notes(replace(device, flywheel=cut)) == ()


@given(st.floats(0.05, 20.0), st.floats(0.0, 1.0))
def test_feet_bear_the_shock_or_a_note_says_so(mass, share):
    """There is a note exactly where the plate does not bear the shock."""
    device = device_on(replace(FLAT, shaft_length=0.05))
    device = replace(device, carrier=replace(device.carrier, mass=mass))
    thickness = plate_thickness(device.foot, mass + device.flywheel.mass)
    device = replace(device, foot_plate=0.005 + share * (thickness - 0.005))
    limit = foot_shock(device.foot, mass + device.flywheel.mass) / 9.80665
    noted = "printed in PETG, the feet take" in notes(device)
    assert noted == (limit < 20.0)
    assert "mill them from 6061-T6" in notes(device) or not noted
    if share == 1.0 and thickness < device.foot.stem:
        assert not noted


def heavy_device(wheel):
    """The caged device with a motor of 3 kg, a wheel of this mass [kg] and a thick plate."""
    thick = replace(DEVICES["caged"], foot_plate=0.03)
    motor = replace(thick.motor, mass=3.0, length=0.08)
    return replace(thick, motor=motor, flywheel=replace(thick.flywheel, mass=wheel))


@pytest.mark.parametrize(("mass", "noted"), [(0.5, False), (5.0, True)])
def test_cage_and_drum_bear_the_shock_or_a_note_says_so(mass, noted):
    """Heads of four M2 sink in at 1,282 N (tests/device/test_joints.py): 8.3 kg at 16 g."""
    heavy = heavy_device(mass)
    assert ("cage and drum hold motor and wheel up to 16 g" in notes(heavy)) == noted


def test_parts_that_must_be_milled_are_not_printed_and_their_mass_is_stated():
    """Aluminium of 2.71 g/cm^3 in place of PETG of 1.27 in the volume of the exported meshes."""
    heavy = heavy_device(5.0)
    heavy = replace(heavy, carrier=replace(heavy.carrier, mass=20.0))
    text = notes(heavy)
    volumes = {part.name: part_manifold(part).volume() for part in printed_parts(heavy)}
    foot, cage, drum = (
        f"{1e3 * 1440.0 * volumes[name]:.0f} g" for name in ("foot", "cage", "drum")
    )
    assert f"mill the feet from 6061-T6 to the same file, {foot} heavier each" in text
    assert f"mill both from 6061-T6 to the same files, {cage} and {drum} heavier" in text
    for device, milled in ((heavy, True), (DEVICES["caged"], False)):
        (step,) = (each for each in module_steps(Assembly("dog", device)) if "Print drum" in each)
        assert ("The foot is milled instead" in step) == milled


ROTOR = BoltCircle(0.012, 3, "M2")


@pytest.mark.parametrize(
    ("mounting", "words"),
    [
        (
            replace(FLAT, shaft_length=BACK_OF_PLATE - 0.0021),
            "^the shaft ends 2.1 mm short of the hub's middle$",
        ),
        (FLAT, "protrude by 13.2 mm to reach the hub's middle, by 15.7 mm to go through"),
        (None, "the motor's threads are not in the catalogue: drill floor and plate"),
        (Mounting(0.004), "the motor's threads are not in the catalogue"),
        (
            Mounting(0.004, ROTOR),
            "^(?!.*the motor's threads).*the threads of its stator are not in the catalogue",
        ),
        (
            replace(FLAT, stator_face=Face.BACK),
            "4 x M3 on 20 mm, are at its back, and its size is not known or its cage does not fit",
        ),
        (
            replace(FLAT, stator=BoltCircle(0.062, 4, "M3")),
            "4 x M3 on 62 mm, do not fit the housing's floor of 64 mm",
        ),
        # From the back of the plate to the hub's face, 2.5 mm off the wheel's middle.
        (
            replace(FLAT, rotor=ROTOR),
            "the hub is 10.7 mm away from the rotor that it is screwed to",
        ),
    ],
)
def test_misfits_of_the_mounting_are_noted(mounting, words):
    assert re.search(words, notes(device_on(mounting)))


def test_the_mounting_behind_a_gear_is_not_designed():
    drive = replace(geared(2.0), diameter=0.04, length=0.1)
    assert notes(device_on(None, drive)).startswith(
        "the mounting of motor and gear is not designed"
    )


def test_feet_of_a_heavy_module_behind_a_gear_are_checked_too():
    drive = replace(geared(2.0), diameter=0.04, length=0.1)
    device = replace(device_on(None, drive), foot_plate=0.005)
    heavy = replace(device, carrier=replace(device.carrier, mass=20.0))
    assert "printed in PETG, the feet take" in notes(heavy)
    assert "printed in PETG, the feet take" not in notes(device)


def test_colliding_feet_are_noted():
    assert "the feet overlap, each by" in notes(device_on(FLAT, offset=0.02))


@pytest.mark.parametrize("name", ["single", "triad", "orthogonal", "pyramid"])
def test_other_layouts_have_no_note_on_a_mirror_image(name):
    device = device_in_layout(Layout(LayoutName(name)))
    assert "overlap, each by" not in notes(device)


@given(incidence=st.floats(0.0, 1.5), diameter=st.floats(0.02, 0.06), length=st.floats(0.005, 0.06))
def test_motors_that_reach_over_the_middle_are_noted(incidence, diameter, length):
    """Compared with points on the edges of both ends."""
    drive = replace(EC45, diameter=diameter, length=length)
    device = device_on(FLAT, drive, incidence=incidence)
    motor = still_visuals(device, device.modules[0])[-1]
    angles, (radius, half) = np.linspace(0.0, 2.0 * np.pi, 2001), motor.size
    circle = np.column_stack([radius * np.cos(angles), radius * np.sin(angles)])
    ends = [np.column_stack([circle, np.full(len(circle), end)]) for end in (-half, half)]
    place = wheel_placement(device.modules[0]) @ motor.place
    least = (np.concatenate(ends) @ place.rotation.T + place.position)[:, 1].min()
    if abs(least) > 1e-6:
        assert ("the motors overlap, each by" in notes(device)) == (least < 0.0)
