"""Words on the picture of what was recognised: each foot's name is legible in each view."""

from itertools import combinations
from xml.etree import ElementTree as ET

import pytest
from robots import ROBOTS, SOLO12

from ocs_design.report.stick_figure import stick_figure
from ocs_design.robot.reader import read_robot

FILES = {
    "four legs": SOLO12,
    "two legs": ROBOTS / "bolt_description/robots/bolt.urdf",
    "long names": ROBOTS / "hyq_description/robots/hyq_no_sensors.urdf",
}


@pytest.mark.parametrize("file", FILES.values(), ids=FILES)
def test_every_foot_is_named_in_every_view_and_no_name_is_on_another(file):
    robot = read_robot(file)
    names = {leg.name for leg in robot.legs}
    page = ET.fromstring(stick_figure(robot, robot.legs, ["legs"]))
    words = [each for each in page.iter() if each.tag.endswith("text")]
    feet = [each for each in words if each.text in names and each.get("font-size") == "10"]
    assert len(feet) == 3 * len(names)
    boxes = []
    for each in feet:
        x, y = float(each.get("x")), float(each.get("y"))
        # Capitals of 10 px in most fonts are 7.3 px high and no more than 7 px wide in the mean.
        boxes.append((x, y - 7.3, x + 7.0 * len(each.text), y))
    for (x, y, far, low), (other_x, other_y, other_far, other_low) in combinations(boxes, 2):
        assert far <= other_x or other_far <= x or low <= other_y or other_low <= y
