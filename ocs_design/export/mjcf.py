"""Whole robot with its device as an MJCF model in full double precision, its scene and its README.

MuJoCo itself prints six digits. The folder is laid out like those of MuJoCo Menagerie: a model that
can be included, a scene for viewing, and a page that describes the content.
"""

from collections.abc import Mapping, Sequence
from pathlib import Path, PurePath
from xml.etree import ElementTree as ET

import mujoco
import numpy as np

from ocs_design.actuation.motor import DIRECT
from ocs_design.common.arrays import FloatArray
from ocs_design.common.units import format_quantity, rpm, significant
from ocs_design.device.bodies import IMU, WHEEL_CONTACT_BIT, joint_names, largest_torque
from ocs_design.export.formats import Notes, Subject
from ocs_design.export.offscreen import shown_box
from ocs_design.export.physics import STEADY_LEGS, leg_joints
from ocs_design.export.raster import png_bytes
from ocs_design.export.robot_model import HOLD, HOME, RobotModel, model_of
from ocs_design.export.snapshot import snapshot
from ocs_design.export.templates import fill, in_comment, numbers, quoted, template_text
from ocs_design.export.visuals import WHEEL_MESH
from ocs_design.robot.robot import RobotFormat

_MESHES = PurePath(WHEEL_MESH).parent

_CONTACT = {"contact_bit": str(WHEEL_CONTACT_BIT)}

_SIDE = np.array([0.83, -1.18, 0.39])
"""Position of the scene's camera from the robot, relative to its extent: matches `xyaxes` in the
template."""

_PRINT_ERROR = 1e-5
"""Relative error of six printed digits."""

_NAMES = {"polycoef": "data"}
"""Names of XML attributes in MuJoCo's objects, if they differ."""

_SINGLE_PRECISION = {"rgba"}
"""Attributes that MuJoCo stores in less than double precision."""

_INERTIAL_NAMES = {"pos": "ipos", "quat": "iquat", "diaginertia": "inertia"}


def write(subject: Subject, folder: Path) -> Notes:
    """Write `<name>_ocs.xml` with its meshes and textures, `scene.xml`, and `README.md`."""
    model, name = model_of(subject), f"{subject.name}_ocs"
    path = export_robot_mjcf(model, folder / f"{name}.xml")
    data = mujoco.MjData(model.compiled)
    mujoco.mj_resetDataKeyframe(model.compiled, data, model.compiled.key(HOME).id)
    mujoco.mj_forward(model.compiled, data)
    scene = scene_xml(model, data, path.name, subject.name)
    (folder / "scene.xml").write_text(scene, encoding="utf-8", newline="\n")
    (folder / f"{name}.png").write_bytes(png_bytes(snapshot(model.compiled, data)))
    page = readme(subject, data, path.name, f"{name}.png")
    (folder / "README.md").write_text(page, encoding="utf-8", newline="\n")
    return model.warnings


def export_robot_mjcf(model: RobotModel, path: Path) -> Path:
    """Write the robot with the flywheels on its trunk, with its meshes and textures beside it.

    The model refers to nothing outside its folder, so the folder can be moved. It has no floor.
    """
    text = precise_xml(model.spec, model.compiled, assets=str(_MESHES))
    path.write_bytes((fill("robot_comment.xml", _CONTACT) + text).encode("utf-8"))
    folder = path.parent / _MESHES
    for name, content in model.spec.assets.items():
        folder.mkdir(exist_ok=True)
        (folder / name).write_bytes(content)
    return path


def scene_xml(model: RobotModel, data: mujoco.MjData, file: str, name: str) -> str:
    """Scene with light, a camera, and a floor that every collidable geom of the robot can touch.

    `data` is at the keyframe, with kinematics computed; `file` is the model's MJCF, and `name` the
    robot's name.
    """
    compiled = model.compiled
    robot = compiled.geom_bodyid > 0
    low, high = shown_box(compiled, data)
    extent = float(np.linalg.norm(high - low))
    sky = any(texture.type == mujoco.mjtTexture.mjTEXTURE_SKYBOX for texture in model.spec.textures)
    return fill(
        "scene.xml",
        {
            **_CONTACT,
            "robot": quoted(in_comment(name)),
            "file": quoted(file),
            "height": numbers((low[2] + high[2]) / 2.0),
            "extent": numbers(extent),
            "sky": "" if sky else template_text("sky.xml"),
            "camera": numbers(extent * _SIDE),
            # Two geoms collide if the contype of one shares a bit with the other's conaffinity.
            "contype": str(np.bitwise_or.reduce(compiled.geom_conaffinity[robot], initial=1)),
            "conaffinity": str(np.bitwise_or.reduce(compiled.geom_contype[robot], initial=1)),
        },
    )


def readme(subject: Subject, data: mujoco.MjData, file: str, picture: str) -> str:
    """Page that describes the folder's content, with the design's figures.

    `data` is at the keyframe, with kinematics computed.
    """
    robot, device, model = subject.carrier, subject.device, model_of(subject)
    motor, wheel, torque = device.motor, device.flywheel, largest_torque(device.motor)
    speed, legs = motor.top_speed, leg_joints(robot)
    axes = (
        ", ".join(significant(part + 0.0, 4) for part in m.axis.tolist()) for m in device.modules
    )
    fastest, strongest = "not limited", "not limited"
    if np.isfinite(speed):
        fastest = f"{rpm(speed)} ({format_quantity(speed, 'rad/s')}), {motor.top_speed_reason}"
    if torque is not None:
        strongest = format_quantity(torque, "N m")
    inertia = "inertia of a wheel about its axis, rotor included"
    figures = {
        "mass of the robot with its device": format_quantity(robot.mass + device.mass, "kg"),
        "mass of the device": format_quantity(device.mass, "g"),
        "wheel": f"{format_quantity(2.0 * wheel.outer_radius, 'mm')} in diameter, "
        f"{format_quantity(wheel.height, 'mm')} high, {wheel.material}, "
        f"{format_quantity(wheel.mass, 'g')}",
        inertia: format_quantity(wheel.spin_inertia, "kg m2"),
        "axes of the wheels in the base frame": ", ".join(f"({axis})" for axis in axes),
        "motor": motor.full_name + ("" if motor.gear == DIRECT.name else f" with {motor.gear}"),
        "highest speed of a wheel": fastest,
        "largest torque of a motor": strongest,
        "standing height of the trunk's frame": format_quantity(float(data.site(IMU).xpos[2]), "m"),
    }
    drives = "The robot's own actuators, unchanged; `ocs_home` has commands for those on joints."
    if model.driven:
        drives = (
            f"{len(legs)} position servos, one for each leg joint and named after it: kp from "
            "weight and length of the leg, kv from its Froude time, the force limited to the "
            "file's effort. The flights use the same."
            if legs
            else "None was recognised."
        )
    held = sum(equality.name.startswith(HOLD) for equality in model.spec.equalities)
    others = (
        f"- **Other joints.** {held} joints outside the legs are held in the posture "
        f"by the equalities `{HOLD}...`, as in the flights. Disable them to drive these joints.\n"
    )
    values = {
        "name": subject.name,
        "refused": f"**{subject.refused}**\n\n" if subject.refused else "",
        "picture": picture,
        "model": file,
        "file": file.removesuffix(".xml"),
        "trunk": robot.trunk,
        "count": str(len(device.modules)),
        "figures": "".join(f"| {what} | {figure} |\n" for what, figure in figures.items()),
        "step": format_quantity(model.compiled.opt.timestep, "ms"),
        "stands": "It stands by itself."
        if len(robot.legs) >= STEADY_LEGS
        else "On fewer than three legs it does not balance by itself, and falls.",
        "legs": drives,
        "others": others if held else "",
        "contact": "The robot's own contacts are as in its file"
        if robot.format is RobotFormat.MJCF
        else "Links collide with floors and objects, not with each other, as in the flights",
        "wheels": ", ".join(f"`{joint}`" for joint in joint_names(device)),
    }
    return fill("robot_readme.md", {**_CONTACT, **values})


def precise_xml(spec: mujoco.MjSpec, model: mujoco.MjModel, *, assets: str) -> str:
    """XML of the model in which rounded printed numbers are replaced by the exact ones.

    `spec` has just been compiled to `model`; `assets` is the folder of meshes beside the file.
    """
    root = ET.fromstring(spec.to_xml())
    for compiler in root.iter("compiler"):
        compiler.attrib.update(meshdir=assets, texturedir=assets)
    for option in root.iter("option"):
        _restore_digits(option, [model.opt])
    # Elements with numbers, by section and tag, and the objects that they were printed from.
    for section, tags, objects in (
        ("worldbody", ("body",), spec.bodies[1:]),
        ("worldbody", ("frame",), spec.frames),
        ("worldbody", ("joint",), spec.joints),
        ("worldbody", ("geom",), spec.geoms),
        ("worldbody", ("site",), spec.sites),
        ("asset", ("mesh",), spec.meshes),
        ("equality", (), spec.equalities),
        ("actuator", (), spec.actuators),
        ("keyframe", (), spec.keys),
    ):
        top = root.find(section)
        if top is None:
            continue
        elements = [e for e in top.iter() if e is not top and (e.tag in tags or not tags)]
        # Matched by name if there is one, else by position.
        named = {item.name: item for item in objects if getattr(item, "name", "")}
        for element, same_place in zip(elements, objects, strict=False):
            source = named.get(element.get("name", ""), same_place)
            sources = [source]
            # The compiled counterpart has angles in radians and unit vectors.
            match source:
                case mujoco.MjsActuator():
                    sources.append(model.actuator(source.id))
                case mujoco.MjsBody() | mujoco.MjsJoint() | mujoco.MjsGeom() | mujoco.MjsSite():
                    sources.append(getattr(model, element.tag)(source.id))
            _restore_digits(element, sources)
            for inertial in element.findall("inertial"):
                _restore_digits(inertial, sources[1:], _INERTIAL_NAMES)
    ET.indent(root)
    return ET.tostring(root, encoding="unicode") + "\n"


def _restore_digits(
    element: ET.Element, sources: Sequence[object], names: Mapping[str, str] = _NAMES
) -> None:
    """Replace printed numbers by the exact ones of the first source that agrees with them."""
    for attribute, text in element.attrib.items():
        if attribute in _SINGLE_PRECISION:
            continue
        printed = _floats(text.split())
        for source in sources if printed.size else ():
            exact = _floats(getattr(source, names.get(attribute, attribute), ()))[: printed.size]
            if exact.size != printed.size:
                continue
            # Tiny numbers are printed as zero.
            nothing = _PRINT_ERROR**2 * float(np.abs(exact).max())
            if np.allclose(printed, exact, rtol=_PRINT_ERROR, atol=nothing):
                if not np.array_equal(printed, exact):
                    element.set(attribute, numbers(exact))
                break


def _floats(values: object) -> FloatArray:
    """Values as numbers; empty if they are none."""
    try:
        return np.ravel(np.asarray(values, dtype=np.float64))
    except (TypeError, ValueError):
        return np.empty(0)
