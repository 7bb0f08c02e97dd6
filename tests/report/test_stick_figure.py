"""The stick figure of a recognised robot: the name of each foot is legible in each view."""

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
    texts = [element for element in page.iter() if element.tag.endswith("text")]
    feet = [text for text in texts if text.text in names and text.get("font-size") == "10"]
    assert len(feet) == 3 * len(names)
    boxes = []
    for text in feet:
        x, y = float(text.get("x")), float(text.get("y"))
        # Capitals of 10 px are 7.3 px high in most fonts and at most 7 px wide on average.
        boxes.append((x, y - 7.3, x + 7.0 * len(text.text), y))
    for (x, y, right, bottom), (other_x, other_y, other_right, other_bottom) in combinations(
        boxes, 2
    ):
        assert right <= other_x or other_right <= x or bottom <= other_y or other_bottom <= y
