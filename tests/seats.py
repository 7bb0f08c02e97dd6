"""Trunks on which tests mount a device, and files that call the exported macro."""

from dataclasses import dataclass

import xacro

from ocs_design.robot.robot import Mount

TRUNK = "base_link"
_CALLER = f"""<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:include filename="ocs.urdf.xacro"/>
  <link name="{TRUNK}"><inertial><mass value="1"/>
    <inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>
  CALL
</robot>"""


@dataclass(frozen=True)
class TrunkOnly:
    trunk: str = TRUNK
    mount: Mount | None = None


def expand_macro(folder, call):
    """URDF of a robot with one link that calls the macro in `folder`."""
    (folder / "robot.urdf.xacro").write_text(_CALLER.replace("CALL", call))
    return xacro.process_file(str(folder / "robot.urdf.xacro")).toxml()
