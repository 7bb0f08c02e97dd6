"""Files of other conventions: the same robots with another axis of their root up."""

import numpy as np
import pytest
from robots import ROBOTS

from ocs_design.robot.reader import read_robot

QUADRUPEDS = (
    "a1_description/urdf/a1.urdf",
    "anymal_b_simple_description/robots/anymal.urdf",
    "laikago_description/urdf/laikago.urdf",
)


@pytest.mark.parametrize("rpy", ["-1.5707963267948966 0 0", "0 1.5707963267948966 0"], ids="yx")
@pytest.mark.parametrize("name", QUADRUPEDS, ids=lambda name: name.partition("_")[0])
def test_all_legs_are_found_whichever_axis_is_up(name, rpy, tmp_path):
    """With z for up two legs of these hang by chance, which are as long as the other two."""
    robot = read_robot(ROBOTS / name)
    first = next(iter(robot.tree.bodies[0].links))
    turned = (
        f'<link name="turned_root"/><joint name="turned" type="fixed"><parent link="turned_root"/>'
        f'<child link="{first}"/><origin rpy="{rpy}"/></joint></robot>'
    )
    path = tmp_path / "turned.urdf"
    path.write_text((ROBOTS / name).read_text().replace("</robot>", turned))
    again = read_robot(path)
    assert [leg.name for leg in again.legs] == [leg.name for leg in robot.legs]
    inertia = np.linalg.eigvalsh(robot.inertia)
    np.testing.assert_allclose(np.linalg.eigvalsh(again.inertia), inertia, rtol=1e-6)
    # Roll, pitch and yaw are what they were, forward or backward.
    np.testing.assert_allclose(np.diag(again.inertia), np.diag(robot.inertia), rtol=1e-4)
