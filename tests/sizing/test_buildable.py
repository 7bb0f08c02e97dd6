"""What keeps a device from being built: its motor, joints, mounting and margins."""

from dataclasses import replace
from math import inf

import numpy as np
import pytest

from ocs_design.actuation.motor import build_gaps
from ocs_design.catalogue.motors import motors
from ocs_design.device.records.device import Clearance, Margin
from ocs_design.robot.reader import read_robot
from ocs_design.sizing.buildable import buildable
from ocs_design.sizing.footing.contact import FootContact
from ocs_design.sizing.mounting import DeviceMounting

WHOLE = next(motor for motor in motors().values() if not build_gaps(motor))
FREE = DeviceMounting(Clearance("trunk", 0.01), None, (), np.zeros(3), np.zeros(3))


def margin(name, demand, capacity):
    """Of a quantity in W."""
    return Margin(name, demand, capacity, "W", scenario="drop")


@pytest.mark.parametrize(
    ("motor", "mounting", "demand", "yes", "open_points"),
    [
        (WHOLE, FREE, 900.0, True, 0),
        # Without a motor nothing can be told, and without shapes of the robot only what fails.
        (None, FREE, 2000.0, None, 0),
        (WHOLE, None, 900.0, None, 0),
        (WHOLE, None, 2000.0, False, 1),
    ],
)
def test_whether_it_can_be_built_is_told_as_far_as_it_is_known(
    motor, mounting, demand, yes, open_points
):
    found = buildable(motor, mounting, (margin("bus power", demand, 1000.0),))
    assert (found.yes, len(found.open)) == (yes, open_points)


def test_on_shapes_that_are_not_known_a_joint_that_fails_is_a_fault_and_a_collision_is_not():
    """A trunk of unknown shape is a box of the robot's inertia, which a module may overlap."""
    unknown = replace(FREE, feet=(FootContact("left foot", "trunk", None, None, 0.0, held=None),))
    assert not unknown.known
    joint = Margin("shaft joint", 2.26, 1.37, "N m")
    assert buildable(WHOLE, unknown, (), (joint,)).yes is False
    overlaps = replace(unknown, nearest=Clearance("base", -0.035))
    found = buildable(WHOLE, overlaps, ())
    assert (found.yes, len(found.open)) == (None, 1)


def test_a_motor_that_lacks_figures_is_named_with_them():
    found = buildable(replace(WHOLE, diameter=None, mass=None), FREE, ())
    (point,) = found.open
    assert found.yes is False
    assert point.what == f"no source gives the body diameter and mass of {WHOLE.name}"
    assert "--motors" in point.cure


@pytest.mark.parametrize(
    "name", ["wheel speed", "motor torque", "bus current, fed back", "hoop stress"]
)
def test_a_capacity_that_is_exceeded_is_open(name):
    found = buildable(WHOLE, FREE, (margin(name, 1200.0, 1000.0),))
    assert found.yes is False
    assert found.open[0].what == f"{name}: 1,200 W required by drop, 1,000 W allowed"


@pytest.mark.parametrize(
    ("name", "demand", "yes"),
    [
        ("wheel speed", 1000.5, True),
        ("wheel speed", 1002.0, False),
        # What only asks for a pause, or gives less torque.
        ("rms current", 2000.0, True),
        ("voltage line", 2000.0, True),
    ],
)
def test_what_is_used_up_to_the_last_is_not_exceeded(name, demand, yes):
    assert buildable(WHOLE, FREE, (margin(name, demand, 1000.0),)).yes is yes


@pytest.mark.parametrize(
    ("joint", "words"),
    [
        (Margin("rim joint", 2.0, 1.0, "N m"), "rim joint: 2 N m required, 1 N m available"),
        (
            Margin("shaft joint", 1.0, None, "N m", note="not in the catalogue"),
            "not in the catalogue",
        ),
    ],
)
def test_a_joint_that_does_not_hold_or_is_not_known_is_open(joint, words):
    found = buildable(WHOLE, FREE, (), (joint,))
    assert found.yes is False
    assert words in found.open[0].what


@pytest.mark.parametrize("name", ["shaft joint, screws in shear", "landing shock, foot"])
def test_what_friction_or_a_milled_foot_makes_up_for_is_a_reserve(name):
    spare = Margin(name, 2.0, 1.0, "N m")
    assert buildable(WHOLE, FREE, (), (spare,)).yes is True


def test_a_collision_is_open():
    found = buildable(WHOLE, replace(FREE, nearest=Clearance("leg", -0.002)), ())
    assert found.yes is False
    assert "leg" in found.open[0].what


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
def test_a_device_on_shapes_that_are_not_known_cannot_be_built(tmp_path, shapes, missing):
    """A skin that is missing does no harm where the collision shapes are there."""
    kinds = zip(shapes[::2], shapes[1::2], strict=True)
    file = tmp_path / "rover.urdf"
    file.write_text(LEGLESS.format("".join(f"<{kind}>{each}</{kind}>" for kind, each in kinds)))
    robot = read_robot(file, legs=())
    found = buildable(WHOLE, FREE, (), (), robot)
    assert found.yes is not missing
    assert buildable(None, FREE, (), (), robot).yes is None
    assert any("the top of the trunk is not known" in each for each in robot.warnings) is missing
    if missing:
        (point,) = found.open
        assert point.what == "meshes are missing: the shape of trunk is not known"
        assert point.cure == "give --package-path rover=DIR"


@pytest.mark.parametrize(("visual", "missing"), [(MESH.format("skin"), True), (BALL, False)])
def test_what_is_amiss_with_the_feet_may_be_a_mesh_of_the_trunk(tmp_path, visual, missing):
    """Feet in the air over a trunk whose skin was not found: the skin is asked for first."""
    file = tmp_path / "rover.urdf"
    file.write_text(LEGLESS.format(f"<collision>{BALL}</collision><visual>{visual}</visual>"))
    loose = FootContact("left foot", "trunk", 0.0, inf, 0.0, held=False)
    found = buildable(WHOLE, replace(FREE, feet=(loose,)), (), (), read_robot(file, legs=()))
    cures = [point.cure for point in found.open]
    assert "--position" in cures[-1]
    assert cures[:-1] == (["give --package-path rover=DIR"] if missing else [])


@pytest.mark.parametrize(("collides", "missing"), [(1, True), (0, False)])
def test_meshes_that_an_mjcf_lacks_count_too(tmp_path, collides, missing):
    """One that is only to look at does no harm beside a box that collides."""
    file = tmp_path / "rover.xml"
    file.write_text(
        '<mujoco><asset><mesh name="hull" file="hull.stl"/></asset><worldbody><body name="trunk">'
        '<freejoint/><inertial pos="0 0 0" mass="2" diaginertia="0.02 0.03 0.04"/>'
        '<geom type="box" size="0.1 0.1 0.1"/><geom type="mesh" mesh="hull" '
        f'contype="{collides}" conaffinity="{collides}"/></body></worldbody></mujoco>'
    )
    found = buildable(WHOLE, FREE, (), (), read_robot(file, legs=()))
    assert found.yes is not missing
    if missing:
        assert found.open[0].cure == f"put them where the model names them, below {tmp_path}"
