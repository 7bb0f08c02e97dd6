"""The pieces of a module in their places, against what the device weighs."""

import numpy as np
import pytest
from built import DEVICES

from ocs_design.device.solids import motor_mount
from ocs_design.export.assembly.placed import module_pieces, placed_parts
from ocs_design.export.bill_of_materials import bill_rows
from ocs_design.parts.housing import LID_SCREWS
from ocs_design.parts.printed import TRUNK_SCREWS

BUILT = ("caged", "by its face", "unknown threads", "in a guard ring")


@pytest.mark.parametrize("name", BUILT)
def test_pieces_and_screws_weigh_what_stands_still(name):
    """All of them together; what turns was sized without its holes, and is left out."""
    device = DEVICES[name]
    turning = {"flywheel", "rim", "hub"}
    pieces = sum(
        part.mass_properties().mass
        for name, (part, _) in placed_parts(device).items()
        if name not in turning
    )
    screws = sum(each.fastening.mass for each in motor_mount(device).screwed)
    screws += LID_SCREWS.mass + TRUNK_SCREWS.mass
    assert pieces + screws == pytest.approx(device.carrier.mass, rel=1e-9)


@pytest.mark.parametrize("name", [*BUILT, "on a plate"])
def test_as_many_screws_as_in_the_bill(name):
    device = DEVICES[name]
    drawn = [piece for piece in module_pieces(device) if piece.fastening]
    rows = [row for row in bill_rows(device) if row.part.startswith("screw")]
    counted = sum(each.fastening.count * (1 if each.shared else 2) for each in drawn)
    assert counted == sum(row.quantity for row in rows)


def test_a_gear_has_a_wheel_at_either_axis():
    placed = placed_parts(DEVICES["gear"])
    assert {"gear", "gear_2", "motor"} <= set(placed)
    heights = [placed[name][1].position[1] for name in ("gear", "gear_2")]
    assert heights == pytest.approx([0.0, -0.03])
    gears = sum(placed[name][0].mass_properties().mass for name in ("gear", "gear_2"))
    assert gears == pytest.approx(0.02)


def test_the_screws_heads_stand_on_what_they_hold():
    """Those of the lid: their tips are in the drum, their heads above the lid."""
    pieces = {piece.name: piece for piece in module_pieces(DEVICES["caged"])}
    lid = pieces["lid"].mesh.vertices[:, 2]
    screws = next(each for name, each in pieces.items() if name.startswith("lid on"))
    along = screws.mesh.vertices[:, 2]
    assert along.max() == pytest.approx(lid.max() + 0.002)
    assert along.min() == pytest.approx(lid.max() - 0.006)
    assert np.hypot(*screws.mesh.vertices[:, :2].T).min() > 0.04
