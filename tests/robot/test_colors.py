"""Colours are for looking at: they are kept where they can be read and never stop a robot."""

import pytest

from ocs_design.robot.urdf import read_urdf

ROBOT = """
<robot name="r">
  <material name="steel"><color rgba="0.5 0.5 0.6 1"/></material>
  <link name="base">
    <inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>
    <visual><geometry><sphere radius="1"/></geometry>{material}</visual>
    <collision><geometry><sphere radius="1"/></geometry></collision>
  </link>
</robot>
"""


@pytest.mark.parametrize(
    ("material", "color"),
    [
        ("", None),
        ('<material name="steel"/>', (0.5, 0.5, 0.6, 1.0)),
        ('<material name="own"><color rgba="1 0 0 0.5"/></material>', (1.0, 0.0, 0.0, 0.5)),
        ('<material name="nowhere"/>', None),
        ('<material name="odd"><color rgba="red"/></material>', None),
        ('<material name="odd"><color rgba="255 0 0 1"/></material>', None),
        ('<material name="odd"><color rgba="nan 0 0 1"/></material>', None),
    ],
)
def test_color_of_a_visual(material, color):
    tree = read_urdf(ROBOT.format(material=material).encode(), find_mesh=lambda _: None)
    visual, collision = tree.bodies[0].shapes
    assert visual.color == color
    assert collision.color is None
