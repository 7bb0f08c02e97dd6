"""Angles of a URDF that must be degrees."""

from xml.etree import ElementTree as ET

import numpy as np

from ocs_design.robot.remarks import Remarks
from ocs_design.robot.urdf.xml import numbers

MOST = 4.0 * np.pi
"""Nobody turns a frame by more than two turns [rad]."""


def remark_on_degrees(root: ET.Element, remarks: Remarks) -> None:
    """Note the links and joints with a roll, pitch or yaw that no one writes in radians."""
    for part in root:
        name = part.get("name", "")
        angles = [numbers(each, "rpy", name, (0.0, 0.0, 0.0)) for each in part.iter("origin")]
        if angles and np.abs(angles).max() > MOST:
            remarks.add("frames turned by more than two turns: angles in degrees?", name)
