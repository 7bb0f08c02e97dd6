"""Both wheels' motors as ros2_control takes them: torque in, angle, speed and torque out.

See control.ros.org, "ros2_control hardware interface types".
"""

from collections.abc import Iterable

from ocs_design.design import Device
from ocs_design.export.motor import largest_torque
from ocs_design.export.templates import fill, numbers

MOCK_PLUGIN = "mock_components/GenericSystem"
"""Hardware of ros2_control's own that moves nothing."""


def ros2_control_urdf(
    device: Device, joints: Iterable[str], *, name: str = "ocs", plugin: str = MOCK_PLUGIN
) -> str:
    """The element of a URDF, indented by two spaces.

    Args:
        device: whose motors limit the command.
        joints: names of the wheels' joints, ready to stand in XML.
        name: of the system, likewise. plugin: its hardware, likewise.
    """
    command = _command(largest_torque(device.motor))
    elements = [
        fill("ros2_control_joint.urdf", {"joint": joint, "command": command}) for joint in joints
    ]
    return fill("ros2_control.urdf", {"name": name, "plugin": plugin, "joints": "".join(elements)})


def _command(limit: float | None) -> str:
    if limit is None:
        return '<command_interface name="effort"/>'
    bounds = (("min", -limit), ("max", limit))
    inside = "".join(f'<param name="{name}">{numbers(bound)}</param>' for name, bound in bounds)
    return f'<command_interface name="effort">{inside}</command_interface>'
