"""Trunk and number of legs of each robot in example-robot-data, as judged by eye."""

from functools import cache

from robots import ROBOTS

from ocs_design.robot.reader import load
from ocs_design.robot.recognition import recognise
from ocs_design.robot.robot import Leg, Reading
from ocs_design.robot.stance import Stand, stand
from ocs_design.robot.tree import Tree

ANATOMY = {
    "a1_description/urdf/a1": ("base", 4),
    "alex_description/urdf/alex_nub_hands": ("Torso", 0),
    "alex_description/urdf/alex_psyonic_hands": ("Torso", 0),
    "alex_description/urdf/alex_sake_hands": ("Torso", 0),
    "alexander_description/urdf/alexander_v1.lowerBodyOnly": ("PELVIS_LINK", 2),
    "allegro_hand_description/urdf/allegro_left_hand": ("palm_link", 0),
    "allegro_hand_description/urdf/allegro_right_hand": ("palm_link", 0),
    "anymal_b_simple_description/robots/anymal-kinova": ("base", 4),
    "anymal_b_simple_description/robots/anymal": ("base", 4),
    "anymal_c_simple_description/urdf/anymal": ("base", 4),
    "asr_twodof_description/urdf/TwoDofs": ("ground", 0),
    "b1_description/urdf/b1-z1": ("base", 4),
    "b1_description/urdf/b1": ("base", 4),
    "baxter_description/urdf/baxter": ("base", 0),
    "bolt_description/robots/bolt": ("base_link", 2),
    "borinot_description/urdf/borinot_flying_arm_2": ("borinot__base_link", 0),
    "centauro_description/urdf/centauro": ("pelvis", 4),
    "double_pendulum_description/urdf/double_pendulum": ("link2", 0),
    "double_pendulum_description/urdf/double_pendulum_continuous": ("link2", 0),
    "double_pendulum_description/urdf/double_pendulum_simple": ("link2", 0),
    "finger_edu_description/robots/finger_edu": ("base_link", 0),
    "g1_description/urdf/g1_29dof_rev_1_0": ("pelvis", 2),
    "g1_description/urdf/g1_29dof_with_hand_rev_1_0": ("pelvis", 2),
    "go1_description/urdf/go1": ("base", 4),
    "go2_description/urdf/go2": ("base", 4),
    "hector_description/robots/quadrotor_base": ("base_link", 0),
    "hextilt_description/urdf/hextilt_flying_arm_5": ("hextilt__base_link", 0),
    "human_description/robots/human": ("middle_pelvis", 2),
    "hyq_description/robots/hyq_no_sensors": ("base_link", 4),
    "icub_description/robots/icub": ("base_link", 2),
    "icub_description/robots/icub_reduced": ("base_link", 2),
    "iris_description/robots/iris": ("iris__base_link", 0),
    "iris_description/robots/iris_simple": ("iris__base_link", 0),
    "kinova_description/robots/kinova": ("base", 0),
    "laikago_description/urdf/laikago": ("trunk", 4),
    "panda_description/urdf/panda": ("panda_link0", 0),
    "panda_description/urdf/panda_collision": ("panda_link0", 0),
    "pr2_description/urdf/pr2": ("base_footprint", 0),
    "quadruped_description/urdf/quadruped": ("base_link", 4),
    "romeo_description/urdf/romeo": ("base_link", 2),
    "romeo_description/urdf/romeo_laas_small": ("base_link", 2),
    "romeo_description/urdf/romeo_small": ("base_link", 2),
    "simple_humanoid_description/urdf/simple_humanoid": ("base_link", 2),
    "simple_humanoid_description/urdf/simple_humanoid_classical": ("base_link", 2),
    "so_arm_description/urdf/so100": ("base", 0),
    "so_arm_description/urdf/so101": ("base_link", 0),
    "solo_description/robots/solo": ("base_link", 4),
    "solo_description/robots/solo12": ("base_link", 4),
    "talos_data/robots/talos_full_v2": ("base_link", 2),
    "talos_data/robots/talos_full_v2_box": ("base_link", 2),
    "talos_data/robots/talos_left_arm": ("arm_left_1_link", 0),
    "talos_data/robots/talos_reduced": ("base_link", 2),
    "talos_data/robots/talos_reduced_box": ("base_link", 2),
    "talos_data/robots/talos_reduced_corrected": ("base_link", 2),
    "tiago_description/robots/tiago": ("base_footprint", 0),
    "tiago_description/robots/tiago_dual": ("base_footprint", 0),
    "tiago_description/robots/tiago_no_hand": ("base_footprint", 0),
    "tiago_pro_description/robots/tiago_pro": ("base_footprint", 0),
    "ur_description/urdf/ur10_joint_limited_robot": ("upper_arm_link", 0),
    "ur_description/urdf/ur10_robot": ("upper_arm_link", 0),
    "ur_description/urdf/ur3_gripper": ("base_link", 0),
    "ur_description/urdf/ur3_joint_limited_robot": ("base_link", 0),
    "ur_description/urdf/ur3_robot": ("base_link", 0),
    "ur_description/urdf/ur5_gripper": ("base_link", 0),
    "ur_description/urdf/ur5_joint_limited_robot": ("base_link", 0),
    "ur_description/urdf/ur5_robot": ("base_link", 0),
    "xarm_description/urdf/xarm7": ("link_base", 0),
    "z1_description/urdf/z1": ("link00", 0),
}
"""Trunk link and number of legs; without legs the trunk is the heaviest body."""

LEGGED = [name for name, (_, legs) in ANATOMY.items() if legs]


@cache
def tree_of(name: str) -> Tree:
    """Tree of a robot of `ANATOMY`, read once per process."""
    return load(ROBOTS / f"{name}.urdf").tree


@cache
def reading_of(name: str) -> Reading:
    """Trunk and legs of a robot of `ANATOMY`, recognised once per process."""
    return recognise(tree_of(name)).reading


def legs_of(name: str) -> tuple[Leg, ...]:
    """Legs of a robot of `ANATOMY`."""
    return reading_of(name).legs


@cache
def stand_of(name: str) -> Stand:
    """Stance of a robot of `ANATOMY`, computed once per process."""
    return stand(tree_of(name), ANATOMY[name][0], legs_of(name))
