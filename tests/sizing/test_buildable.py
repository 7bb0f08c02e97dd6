"""What makes a device unbuildable: motor, joints, mounting or margins."""

from dataclasses import replace
from math import inf

import numpy as np
import pytest

from ocs_design.actuation.motor import build_gaps
from ocs_design.catalogue.motors import motors
from ocs_design.device.records.device import Clearance
from ocs_design.device.records.flights import Margin
from ocs_design.robot.reader import read_robot
from ocs_design.sizing.buildable import buildable
from ocs_design.sizing.footing.contact import FootContact
from ocs_design.sizing.mounting import DeviceMounting

KNOWN_MOTOR = next(motor for motor in motors().values() if not build_gaps(motor))
FREE = DeviceMounting(Clearance("trunk", 0.01), None, (), np.zeros(3), np.zeros(3))


def margin(name, demand, capacity):
    """A margin of a quantity in W."""
    return Margin(name, demand, capacity, "W", scenario="drop")


@pytest.mark.parametrize(
    ("motor", "mounting", "demand", "yes", "open_points"),
    [
        (KNOWN_MOTOR, FREE, 900.0, True, 0),
        # Without a motor nothing is known, and without shapes of the robot only faults are.
        (None, FREE, 2000.0, None, 0),
        (KNOWN_MOTOR, None, 900.0, None, 0),
        (KNOWN_MOTOR, None, 2000.0, False, 1),
    ],
)
def test_buildable_is_decided_as_far_as_it_is_known(motor, mounting, demand, yes, open_points):
    result = buildable(motor, mounting, (margin("bus power", demand, 1000.0),))
    assert (result.yes, len(result.open)) == (yes, open_points)


@pytest.mark.parametrize(
    ("joint", "cure"),
    [
        (
            Margin("motor mount", 135.0, 134.0, "N m", note="filled with epoxy"),
            "threads in its stator",
        ),
        (Margin("landing shock, web", 196.1, 195.0, "m/s2"), "--r-max"),
    ],
)
def test_mounts_and_webs_that_do_not_hold_are_open_points(joint, cure):
    held = replace(joint, capacity=joint.demand)
    assert buildable(KNOWN_MOTOR, FREE, (), (held,)).yes is True
    result = buildable(KNOWN_MOTOR, FREE, (), (joint,))
    assert result.yes is False
    (point,) = result.open
    assert point.what.startswith(f"{joint.name}: ")
    assert cure in point.cure


def test_with_unknown_shapes_a_failing_joint_is_a_fault_and_a_collision_is_not():
    """A trunk of unknown shape is a box with the robot's inertia, which a module may overlap."""
    unknown = replace(FREE, feet=(FootContact("left foot", "trunk", None, None, 0.0, held=None),))
    assert not unknown.known
    joint = Margin("shaft joint", 2.26, 1.37, "N m")
    assert buildable(KNOWN_MOTOR, unknown, (), (joint,)).yes is False
    overlaps = replace(unknown, nearest=Clearance("base", -0.035))
    result = buildable(KNOWN_MOTOR, overlaps, ())
    assert (result.yes, len(result.open)) == (None, 1)


def test_missing_data_of_a_motor_are_named():
    result = buildable(replace(KNOWN_MOTOR, diameter=None, mass=None), FREE, ())
    (point,) = result.open
    assert result.yes is False
    assert point.what == f"no source gives the body diameter and mass of {KNOWN_MOTOR.name}"
    assert "--motors" in point.cure


@pytest.mark.parametrize(
    ("mounting", "margins", "joints", "fault"),
    [
        *(
            (
                FREE,
                (margin(name, 1200.0, 1000.0),),
                (),
                f"{name}: 1,200 W required by drop, 1,000 W allowed",
            )
            for name in ("wheel speed", "motor torque", "bus current, fed back", "hoop stress")
        ),
        (
            FREE,
            (),
            (Margin("rim joint", 2.0, 1.0, "N m"),),
            "rim joint: 2 N m required, 1 N m available",
        ),
        (
            FREE,
            (),
            (Margin("shaft joint", 1.0, None, "N m", note="not in the catalogue"),),
            "not in the catalogue",
        ),
        (replace(FREE, nearest=Clearance("leg", -0.002)), (), (), "leg"),
    ],
)
def test_exceeded_capacities_weak_joints_and_collisions_are_faults(
    mounting, margins, joints, fault
):
    result = buildable(KNOWN_MOTOR, mounting, margins, joints)
    assert result.yes is False
    assert fault in result.open[0].what


@pytest.mark.parametrize(
    ("name", "demand", "yes"),
    [
        ("wheel speed", 1000.5, True),
        ("wheel speed", 1002.0, False),
        # These only need a pause, or give less torque.
        ("rms current", 2000.0, True),
        ("voltage line", 2000.0, True),
    ],
)
def test_a_capacity_is_exceeded_only_beyond_a_tolerance(name, demand, yes):
    assert buildable(KNOWN_MOTOR, FREE, (margin(name, demand, 1000.0),)).yes is yes


@pytest.mark.parametrize("name", ["shaft joint, screws in shear", "landing shock, foot"])
def test_joints_backed_by_friction_or_a_milled_foot_are_no_fault(name):
    backed = Margin(name, 2.0, 1.0, "N m")
    assert buildable(KNOWN_MOTOR, FREE, (), (backed,)).yes is True


LEGLESS = """<robot name="rover"><link name="trunk"><inertial><mass value="2"/>
<inertia ixx="0.02" iyy="0.03" izz="0.04" ixy="0" ixz="0" iyz="0"/></inertial>{}</link></robot>"""
MESH = '<geometry><mesh filename="package://rover/{}.stl"/></geometry>'
BALL = '<geometry><sphere radius="0.1"/></geometry>'


@pytest.mark.parametrize(
    ("shapes", "missing"),
    [
        (("collision", MESH.format("hull")), True),
        (("visual", MESH.format("skin")), True),
        (("collision", BALL, "collision", MESH.format("hull")), True),
        (("collision", BALL, "visual", MESH.format("skin")), False),
        (("collision", BALL), False),
    ],
)
def test_missing_meshes_make_a_device_unbuildable(tmp_path, shapes, missing):
    """A missing visual does no harm where the collision shapes are known."""
    kinds = zip(shapes[::2], shapes[1::2], strict=True)
    file = tmp_path / "rover.urdf"
    file.write_text(LEGLESS.format("".join(f"<{kind}>{each}</{kind}>" for kind, each in kinds)))
    robot = read_robot(file, legs=())
    result = buildable(KNOWN_MOTOR, FREE, (), (), robot)
    assert result.yes is not missing
    assert buildable(None, FREE, (), (), robot).yes is None
    assert any("the top of the trunk is not known" in each for each in robot.warnings) is missing
    if missing:
        (point,) = result.open
        assert point.what == "meshes are missing: the shape of trunk is not known"
        assert point.cure == "give --package-path rover=DIR"


@pytest.mark.parametrize(("visual", "missing"), [(MESH.format("skin"), True), (BALL, False)])
def test_a_missing_mesh_of_the_trunk_is_named_before_loose_feet(tmp_path, visual, missing):
    """Feet may hang in the air because the trunk's visual was not found."""
    file = tmp_path / "rover.urdf"
    file.write_text(LEGLESS.format(f"<collision>{BALL}</collision><visual>{visual}</visual>"))
    loose = FootContact("left foot", "trunk", 0.0, inf, 0.0, held=False)
    result = buildable(KNOWN_MOTOR, replace(FREE, feet=(loose,)), (), (), read_robot(file, legs=()))
    cures = [point.cure for point in result.open]
    assert "--position" in cures[-1]
    assert cures[:-1] == (["give --package-path rover=DIR"] if missing else [])


@pytest.mark.parametrize(("collides", "missing"), [(1, True), (0, False)])
def test_missing_meshes_of_an_mjcf_count_too(tmp_path, collides, missing):
    """A visual mesh does no harm beside a box for collisions."""
    file = tmp_path / "rover.xml"
    file.write_text(
        '<mujoco><asset><mesh name="hull" file="hull.stl"/></asset><worldbody><body name="trunk">'
        '<freejoint/><inertial pos="0 0 0" mass="2" diaginertia="0.02 0.03 0.04"/>'
        '<geom type="box" size="0.1 0.1 0.1"/><geom type="mesh" mesh="hull" '
        f'contype="{collides}" conaffinity="{collides}"/></body></worldbody></mujoco>'
    )
    result = buildable(KNOWN_MOTOR, FREE, (), (), read_robot(file, legs=()))
    assert result.yes is not missing
    if missing:
        assert result.open[0].cure == f"put them where the model names them, below {tmp_path}"
