"""Joints that follow other joints, sorted out so that every leader moves freely."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

from ocs_design.robot.remarks import Remarks
from ocs_design.robot.tree import Body, Joint


def resolve_mimics(bodies: Sequence[Body], remarks: Remarks) -> tuple[Body, ...]:
    """The bodies with every follower tied to the joint at the end of its chain of leaders."""
    joints = {body.joint.name: body.joint for body in bodies if body.joint is not None}
    return tuple(
        body
        if body.joint is None or body.joint.mimic is None
        else replace(body, joint=_resolved(body.joint, joints, remarks))
        for body in bodies
    )


def _resolved(joint: Joint, joints: Mapping[str, Joint], remarks: Remarks) -> Joint:
    multiplier, offset, leader = 1.0, 0.0, joint
    seen = set[str]()
    while leader.mimic is not None:
        seen.add(leader.name)
        name, factor, shift = leader.mimic
        if name not in joints:
            remarks.add("joints that mimic a joint which does not move, read as free", joint.name)
            return replace(joint, mimic=None)
        if name in seen:
            remarks.add("joints that mimic each other in a circle, read as free", joint.name)
            return replace(joint, mimic=None)
        multiplier, offset, leader = multiplier * factor, offset + multiplier * shift, joints[name]
    return replace(joint, mimic=(leader.name, multiplier, offset))
