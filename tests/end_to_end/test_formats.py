"""One robot in every format and in other postures: the design is the same for every source."""

import gzip
import json
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pinocchio as pin
import pytest
from commands import SOLO12, run
from mass_oracles import pinocchio_mass_properties
from pinocchio_robots import configuration, free_model
from products import equal_rate

# Given explicitly, so that the design does not depend on data that only one format has.
LIMITS = ("--r-max", "50mm", "--r-min", "5mm", "--h-max", "10mm", "--h-min", "2mm")
LIMITS = (*LIMITS, "--wall-min", "2mm", "--wheel-mass-max", "250g")
FEET = ("--legs", "FL_FOOT,FR_FOOT,HL_FOOT,HR_FOOT")
RATE_ALONE = "[requirement]\nmaneuvers = 'none'\nrate_change = '6.3 rad/s'\n"


@pytest.fixture(scope="module")
def solo12():
    """Pinocchio's view of the example, with all its shapes."""
    model = free_model(SOLO12)
    shapes = {
        kind: list(pin.buildGeomFromUrdf(model, SOLO12, kind).geometryObjects)
        for kind in (pin.GeometryType.COLLISION, pin.GeometryType.VISUAL)
    }
    return SimpleNamespace(model=model, shapes=shapes)


def numbers(values):
    return " ".join(repr(float(value)) for value in np.ravel(values))


def quaternion(rotation):
    x, y, z, w = pin.Quaternion(rotation).coeffs()
    return numbers([w, x, y, z])


def geom(shape, *, visual):
    """A geom of MJCF, whose sizes are half lengths."""
    place, form = shape.placement, shape.geometry
    kind = type(form).__name__.lower()
    size = {
        "box": lambda: form.halfSide,
        "sphere": lambda: form.radius,
        "cylinder": lambda: [form.radius, form.halfLength],
    }[kind]()
    touch = 'contype="0" conaffinity="0" group="2"' if visual else ""
    return (
        f'<geom type="{kind}" size="{numbers(size)}" pos="{numbers(place.translation)}" '
        f'quat="{quaternion(place.rotation)}" {touch}/>'
    )


def body(solo12, index):
    """A moving body of MJCF and all bodies below it, from Pinocchio's numbers alone."""
    model = solo12.model
    place, inertia = model.jointPlacements[index], model.inertias[index]
    tensor = inertia.inertia
    name = next(f.name for f in model.frames if f.parentJoint == index and f.type == pin.BODY)
    if index == 1:
        joint = "<freejoint/>"
    else:
        axis = {"JointModelRX": "1 0 0", "JointModelRY": "0 1 0"}[model.joints[index].shortname()]
        q = model.joints[index].idx_q
        joint_range = numbers([model.lowerPositionLimit[q], model.upperPositionLimit[q]])
        joint = f'<joint name="{model.names[index]}" axis="{axis}" range="{joint_range}"/>'
    geoms = [
        geom(shape, visual=kind is pin.GeometryType.VISUAL)
        for kind, shapes in solo12.shapes.items()
        for shape in shapes
        if shape.parentJoint == index
    ]
    children = [
        body(solo12, child) for child in range(2, model.njoints) if model.parents[child] == index
    ]
    entries = [tensor[0, 0], tensor[1, 1], tensor[2, 2], tensor[0, 1], tensor[0, 2], tensor[1, 2]]
    return (
        f'<body name="{name}" pos="{numbers(place.translation)}" '
        f'quat="{quaternion(place.rotation)}">{joint}'
        f'<inertial pos="{numbers(inertia.lever)}" mass="{inertia.mass!r}" '
        f'fullinertia="{numbers(entries)}"/>{"".join(geoms)}{"".join(children)}</body>'
    )


@pytest.fixture(scope="module")
def mjcf(solo12):
    """The example as MJCF, written without an exporter."""
    posed = numbers([0.0, 0.0, 0.3, 1.0, 0.0, 0.0, 0.0, *(0.1, 0.6, -1.1) * 4])
    return (
        '<mujoco model="solo12"><compiler angle="radian"/>'
        f"<worldbody>{body(solo12, 1)}</worldbody>"
        f'<keyframe><key name="crouch" qpos="{posed}"/></keyframe></mujoco>'
    )


def design(*arguments, motor="none", stdin=b""):
    """The document of `size` without flights."""
    result = run("size", *arguments, "--motor", motor, "--no-validate", "--json", stdin=stdin)
    assert result.code == 0, result.stdout
    return json.loads(result.stdout)


def check_same(document, expected):
    """Rim, incidence, inertia and position, to one part in a million."""
    for key in ("inner_radius", "outer_radius", "height", "mass", "spin_inertia"):
        value = expected["ocs"]["flywheel"][key]
        assert document["ocs"]["flywheel"][key] == pytest.approx(value, rel=1e-6), key
    assert document["ocs"]["incidence"] == pytest.approx(expected["ocs"]["incidence"], rel=1e-6)
    np.testing.assert_allclose(
        document["ocs"]["total_inertia"], expected["ocs"]["total_inertia"], rtol=1e-6, atol=1e-9
    )


@pytest.mark.slow
@pytest.mark.parametrize("motor", ["none", pytest.param("auto", marks=pytest.mark.exhaustive)])
def test_every_format_gives_the_same_design(folder, no_files, mjcf, motor):
    text = Path(SOLO12).read_bytes()
    (folder / "a.urdf.gz").write_bytes(gzip.compress(text))
    (folder / "robot").write_text(mjcf)
    (folder / "b.xml.gz").write_bytes(gzip.compress(mjcf.encode()))
    expected = design(SOLO12, "-o", "urdf", motor=motor)
    assert expected["robot"]["posture_name"] == "stand"
    documents = {
        "gzip": design("a.urdf.gz", "-o", "gzip", motor=motor),
        "standard input": design("-", "-o", "stdin", stdin=text, motor=motor),
        "MJCF": design("robot", "-o", "mjcf", motor=motor),
        "MJCF, gzip": design("b.xml.gz", "-o", "mjcf-gzip", motor=motor),
        "MJCF, standard input": design("-", "-o", "mjcf-stdin", stdin=mjcf.encode(), motor=motor),
    }
    for name, document in documents.items():
        check_same(document, expected)
        assert document["robot"]["standing_height"] == pytest.approx(0.272, rel=1e-6), name
        positions = [np.array(d["ocs"]["modules"][0]["position"]) for d in (document, expected)]
        np.testing.assert_allclose(*positions, rtol=0.0, atol=1e-8)
        assert document["robot"]["name"] == "solo12"
    assert documents["standard input"]["robot"]["source"] == "-"


@pytest.mark.slow
@pytest.mark.parametrize("motor", ["none", pytest.param("auto", marks=pytest.mark.exhaustive)])
def test_the_exported_robot_can_be_read_again(folder, motor):
    """It can be read as any robot, but not sized again: the names of the device are in use."""
    design(SOLO12, "-o", "first", motor=motor)
    for name in ("solo12_ocs.urdf", "solo12_ocs.xml"):
        result = run("inspect", folder / "first" / "robot" / name, "--json")
        assert result.code == 0
        assert len(result.document["robot"]["legs"]) == 4
        again = run("size", folder / "first" / "robot" / name, "--json")
        assert again.code == 3
        assert "'ocs_left" in again.document["error"]["message"]
        assert "rename" in again.document["error"]["hint"]


def test_by_hand_the_same_inertia_gives_the_same_design(folder, no_files):
    """Without legs there is no standing height to scale with: maneuvers and limits are given.

    The origin of a robot by hand is its centre of mass, so that the position has other coordinates.
    """
    (folder / "s.toml").write_text(RATE_ALONE)
    place = np.array([0.0, 0.055, 0.079])
    options = ("--spec", "s.toml", *LIMITS)
    expected = design(SOLO12, *options, "--position", ",".join(map(str, place)), "-o", "file")
    robot = expected["robot"]
    inertia = np.array(robot["inertia"])
    entries = [inertia[index] for index in ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))]
    by_hand = (
        "--mass",
        repr(robot["mass"]),
        "--inertia",
        ",".join(repr(float(value)) for value in entries),
        "--position",
        ",".join(repr(float(value)) for value in place - robot["com"]),
    )
    document = design(*by_hand, *options, "-o", "hand")
    check_same(document, expected)
    assert document["robot"]["source"] == "by hand"
    assert (document["robot"]["legs"], document["robot"]["standing_height"]) == ([], None)
    assert document["requirement"]["maneuvers"] == expected["requirement"]["maneuvers"] == []


def check_inertia(document, solo12, joints, link="base_link"):
    expected = pinocchio_mass_properties(solo12.model, configuration(solo12.model, joints), link)
    robot = document["robot"]
    np.testing.assert_allclose(robot["com"], expected.com, rtol=0.0, atol=1e-12)
    np.testing.assert_allclose(robot["inertia"], expected.inertia, rtol=1e-9, atol=1e-13)
    assert robot["trunk"] == link
    ocs = document["ocs"]
    alone = ocs["incidence_by_criterion_robot_alone"]["equal-rate"]
    assert alone == pytest.approx(equal_rate(expected.inertia), abs=1e-9)


@pytest.mark.slow
def test_postures_are_those_requested(folder, no_files, solo12):
    zero = design(SOLO12, "--posture", "zero", "-o", "zero")
    check_inertia(zero, solo12, {})
    assert zero["robot"]["posture_name"] == "zero"
    bent = ("--joint", "FL_KFE=-1.25", "--joint", "FR_HAA=10deg")
    joints = {"FL_KFE": -1.25, "FR_HAA": np.radians(10.0)}
    check_inertia(design(SOLO12, "--posture", "zero", *bent, "-o", "bent"), solo12, joints)
    standing = design(SOLO12, *bent, "-o", "standing")
    check_inertia(standing, solo12, {**standing["robot"]["posture"], **joints})
    assert standing["robot"]["posture_name"] == "stand + joints"
    assert standing["robot"]["posture"]["HL_KFE"] == pytest.approx(1.287, abs=1e-3)


@pytest.mark.slow
def test_another_trunk_has_its_own_frame(folder, solo12):
    """As an extreme case the device is on a leg."""
    document = design(SOLO12, "--posture", "zero", "--trunk", "HL_UPPER_LEG", *FEET, "-o", "leg")
    check_inertia(document, solo12, {}, "HL_UPPER_LEG")
    urdf = (folder / "leg" / "robot" / "solo12_ocs.urdf").read_text()
    assert urdf.count('<parent link="HL_UPPER_LEG"/>') == 3


def test_a_keyframe_by_name(folder, no_files, solo12, mjcf):
    (folder / "solo12.xml").write_text(mjcf)
    document = design("solo12.xml", "--posture", "crouch", "-o", "crouch")
    names = list(solo12.model.names)[2:]
    check_inertia(document, solo12, dict(zip(names, (0.1, 0.6, -1.1) * 4, strict=True)))
    assert document["robot"]["posture_name"] == "crouch"


@pytest.mark.slow
def test_an_srdf_state_by_name(folder, no_files, solo12):
    (folder / "solo12.urdf").write_bytes(Path(SOLO12).read_bytes())
    (folder / "solo12.srdf").write_text(
        '<robot name="solo12"><group_state name="kneel" group="legs">'
        '<joint name="FL_HFE" value="0.7"/><joint name="HR_KFE" value="1.5"/>'
        "</group_state></robot>"
    )
    document = design("solo12.urdf", "--posture", "kneel")
    check_inertia(document, solo12, {"FL_HFE": 0.7, "HR_KFE": 1.5})
    wrong = run("size", "solo12.urdf", "--posture", "kneal", "-o", "wrong")
    assert (wrong.code, "available: kneel" in wrong.output) == (3, True)
