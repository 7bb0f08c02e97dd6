"""Screws and holes of known motor mountings in the bill and in printed parts."""

from dataclasses import replace
from math import pi

import pytest
from built_devices import CAGED, FLAT, housed_device
from wheels import PAPER_WHEEL

from ocs_design.actuation.fasteners import BoltCircle
from ocs_design.actuation.motor import Mounting
from ocs_design.export.bill_of_materials import bill_csv, bill_rows
from ocs_design.export.device_parts import printed_parts
from ocs_design.parts.motor_mount import screwed_by_face
from ocs_design.parts.printed import PANEL, PETG, WALL
from ocs_design.parts.solids import Carrier


def device_on(mounting):
    """The paper's rim on a motor with this mounting, without printed parts."""
    device = housed_device(mounting)
    rim = replace(device.flywheel, outer_radius=PAPER_WHEEL.outer_radius)
    return replace(device, flywheel=rim, carrier=Carrier(CAGED.mass, 1e-4, 1e-4))


def screws(device):
    """Designation and number of screws, by the joint they hold."""
    rows = [row for row in bill_rows(device) if row.part.startswith("screw")]
    return {row.remark.split(";")[0]: (row.part, row.quantity) for row in rows}


def test_the_total_shows_where_a_design_has_no_screws():
    device = housed_device(None)
    carrier = replace(device.carrier, mass=device.carrier.mass - 0.0025)
    without_screws = replace(device, carrier=carrier)
    total = bill_csv(without_screws).splitlines()[-1]
    assert total.startswith(f"total,,,,,{1e3 * device.mass:.3f},")
    assert f"design.json states {1e3 * without_screws.mass:.3f} g" in total


LIDS_AND_FEET = {
    "lid on drum, which is tapped": ("screw ISO 4762 M2 x 6", 8),
    "foot on trunk": ("screw ISO 4762 M3 x 6", 4),
}
"""4 ears of a lid of 1.6 mm, twice the diameter deep in plastic; 2 slots in a base of 3 mm."""


@pytest.mark.parametrize(
    ("device", "expected"),
    [
        (device_on(None), {}),
        (housed_device(None), LIDS_AND_FEET),
        # Through floor and foot, 1.6 mm and 5 mm, and 3 mm of thread: 9.6 mm.
        (
            housed_device(FLAT),
            LIDS_AND_FEET | {"motor on housing and foot": ("screw ISO 4762 M3 x 10", 8)},
        ),
        # M2 through 1.6 and 5 mm with 4 mm of thread in the print, M3 through 3 mm of floor.
        (
            housed_device(CAGED.mounting),
            LIDS_AND_FEET
            | {
                "housing and foot on cage, which is tapped": ("screw ISO 4762 M2 x 12", 8),
                "motor in its cage": ("screw ISO 4762 M3 x 6", 8),
                "wheel on rotor": ("screw ISO 4762 M3 x 6", 6),
            },
        ),
    ],
    ids=["nothing printed", "unknown threads", "beside its shaft", "at its back"],
)
def test_a_motor_is_held_by_its_threads(device, expected):
    assert screws(device) == expected
    printed = {part.name for part in printed_parts(device)}
    assert ("cage" in printed) == ("motor in its cage" in expected)


def test_floor_and_foot_get_the_motor_s_holes():
    plain, drilled = (printed_parts(device_on(mounting)) for mounting in (None, FLAT))
    mount = screwed_by_face(FLAT, FLAT.stator)
    area = pi * (mount.pilot_radius**2 + 4 * 0.0017**2)
    removed = [
        before.mass_properties().mass - after.mass_properties().mass
        for before, after in zip(plain, drilled, strict=True)
    ]
    assert removed[0] == pytest.approx(PETG.density * area * PANEL, rel=1e-9)
    assert removed[1] == 0.0
    assert removed[2] > 0.0


def test_the_hole_in_the_middle_leaves_a_wall_to_the_screws():
    pilot = screwed_by_face(FLAT, FLAT.stator).pilot_radius
    assert pilot == pytest.approx(0.01 - 0.0017 - WALL)
    thick_shaft = replace(FLAT, shaft_diameter=0.0141)
    room = (0.01 - 0.0017 - 0.0141 / 2.0) / 2.0
    assert screwed_by_face(thick_shaft, thick_shaft.stator).pilot_radius == pytest.approx(
        0.0141 / 2.0 + room
    )


def test_without_known_threads_there_is_a_hole_for_the_rotor():
    """A shaft of 4 mm turns in 6 mm; what is screwed to M2 on 12 mm has 2 mm of wall, 1 mm free."""
    rotor = Mounting(0.004, rotor=BoltCircle(0.012, 4, "M2"))
    holes = [device_on(mount).mount.holes for mount in (None, Mounting(0.004), rotor)]
    assert [hole.reach for hole in holes] == pytest.approx([0.0, 0.003, 0.006 + 0.0012 + 0.003])


def test_screws_too_far_out_for_the_housing_get_no_holes():
    wide = replace(FLAT, stator=BoltCircle(0.062, 4, "M3"))
    plain, drilled = (printed_parts(device_on(mounting)) for mounting in (None, wide))
    assert [part.mass_properties().mass for part in plain] == [
        part.mass_properties().mass for part in drilled
    ]
