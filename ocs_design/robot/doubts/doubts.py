"""Every doubt about a robot that was read: one sentence for each test, with the links in it."""

from collections.abc import Mapping, Sequence

import numpy as np

from ocs_design.robot.doubts.box import box_of
from ocs_design.robot.doubts.density import link_density_doubts, robot_density_doubts
from ocs_design.robot.doubts.ground import foot_doubts
from ocs_design.robot.doubts.inertia import inertia_doubts
from ocs_design.robot.doubts.limits import effort_doubts, is_in_degrees
from ocs_design.robot.doubts.sides import side_doubts
from ocs_design.robot.doubts.wheels import wheel_doubts
from ocs_design.robot.mass_properties import MassProperties, physical_defect
from ocs_design.robot.remarks import Remarks
from ocs_design.robot.robot import Leg
from ocs_design.robot.stance.feet import is_wheel
from ocs_design.robot.tree import Body, Tree


def doubts_of(
    tree: Tree,
    trunk: str,
    legs: Sequence[Leg],
    posture: Mapping[str, float],
    weighed: MassProperties,
) -> tuple[str, ...]:
    """What can be, but hardly is meant (docs/plausibility.md).

    Args:
        tree: of the robot, of which mass properties are physical as a whole.
        trunk: link whose frame is B.
        legs: as found; may be empty.
        posture: that it stands in.
        weighed: the whole robot in that posture, in B.
    """
    remarks = Remarks()
    # The quotients of a mass of 1e-300 kg are infinite, and judged rightly as that.
    with np.errstate(all="ignore"):
        for doubt in robot_density_doubts(weighed):
            remarks.add(doubt)
        for body in tree.bodies:
            _add_body(body, remarks)
        for doubt, links in side_doubts(tree, trunk, legs):
            remarks.add(doubt, links)
        for doubt, joint in effort_doubts(tree, legs, weighed.mass):
            remarks.add(doubt, joint)
        for doubt in foot_doubts(tree, trunk, legs, posture):
            remarks.add(doubt)
    return remarks.sentences()


def _add_body(body: Body, remarks: Remarks) -> None:
    weighed, joint = body.mass_properties, body.joint
    if joint is not None and is_in_degrees(joint):
        remarks.add("joints with a range of many turns: limits in degrees?", joint.name)
    # What no matter could have is told as that already.
    if weighed.mass == 0.0 or physical_defect(weighed) is not None:
        return
    box = box_of(body)
    if box is None:
        return
    found = [*link_density_doubts(weighed.mass, box), *inertia_doubts(weighed, box)]
    if joint is not None and is_wheel(body):
        found += wheel_doubts(weighed, joint)
    for doubt, figure in found:
        remarks.add(doubt, f"{body.name} ({figure})")
