"""Every reader of user files as one call, and random mutations of files for them."""

import struct
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

from bad_input import MOTORS, SOLO12_TEXT
from commands import BOUND, ROOT, run
from exported import MJCF
from urdf_text import LIMIT, inertial, joint, link, robot

from ocs_design.catalogue.gears import load_gears
from ocs_design.catalogue.motors import load_motors
from ocs_design.common.errors import OcsError
from ocs_design.common.files import safe_name, to_json
from ocs_design.device.records.design import read_design
from ocs_design.export.folder import recorded_hashes
from ocs_design.requirement.reading import read_specification
from ocs_design.requirement.resolving import resolve
from ocs_design.requirement.sections import RobotSection
from ocs_design.requirement.specification import Specification
from ocs_design.robot.manual import robot_by_hand
from ocs_design.robot.meshes import longest_side, mesh_bounds, unscaled_bounds
from ocs_design.robot.mujoco_model import build_spec
from ocs_design.robot.reader import read_group_states, read_robot
from ocs_design.workflows.inspect import inspect_robot
from ocs_design.workflows.restoring import base_of, read_design_and_device, robot_of

GEARS = b"""[[gear]]
name = "one to five"
maker = "me"
source = "bench"
kind = "fixed"
ratios = "5"
mass_kg = 0.05
inertia_kg_m2 = 1e-7
inertia_at = "motor"
efficiency = 0.8
torque_max_nm = 2.0

[[gear]]
name = "belt"
maker = "me"
source = "bench"
kind = "belt"
efficiency = 0.95
mass_kg = 0.0358
teeth = "20 30 40"
pitch_m = 0.002
width_m = 0.006
belt_mass_kg_per_m = 0.0112
working_tension_n = 26.2
belt_speed_max_m_s = 33
pulley_density_kg_m3 = 2700
"""
SRDF = b"""<robot name="test"><group name="leg"><joint name="hip"/></group>
<group_state name="sit" group="leg"><joint name="hip" value="0.5"/></group_state>
<group_state name="lie" group="leg"><joint name="hip" value="1 0 0"/></group_state></robot>"""
XACRO = b"""<robot name="test" xmlns:xacro="http://www.ros.org/wiki/xacro">
<xacro:property name="m" value="2.5"/><xacro:arg name="side" default="left"/>
<xacro:macro name="leg" params="prefix mass:=1 *block"><xacro:if value="${mass > 0}">
<link name="${prefix}leg"><inertial><mass value="${2*mass}"/>
<inertia ixx="1" iyy="${max(1, 0.5)}" izz="1"/></inertial></link><xacro:insert_block name="block"/>
</xacro:if></xacro:macro><xacro:leg prefix="$(arg side)_" mass="${m}"><origin xyz="0 0 1"/>
</xacro:leg></robot>"""
URDF = robot(
    link(
        "trunk",
        inertial(2.0, "0.01 0.02 0.03"),
        '<visual><origin xyz="0 0 1" rpy="0 1 0"/><geometry><box size="1 2 3"/></geometry>'
        '<material name="red"><color rgba="1 0 0 1"/></material></visual>',
        '<collision><geometry><sphere radius="0.1"/></geometry></collision>'
        '<collision><geometry><cylinder radius="0.1" length="1"/></geometry></collision>'
        '<collision><geometry><mesh filename="package://a/b.stl" scale="1 1 1"/></geometry>'
        "</collision>",
    ),
    link("hip", inertial(), "<collision/>"),
    link("leg", inertial()),
    joint("h", "trunk", "hip", LIMIT, '<axis xyz="1 0 0"/><origin xyz="0 1 0"/>'),
    joint("k", "hip", "leg", LIMIT, '<mimic joint="h" multiplier="2" offset="1"/>'),
)
TETRAHEDRON = ((0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
FACETS = ((0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2))
OBJ = (
    "mtllib x.mtl\n"
    + "".join(f"v {x} {y} {z}\n" for x, y, z in TETRAHEDRON)
    + "vt 0 0\nvn 0 0 1\n"
    + "".join(f"f {a + 1}/1/1 {b + 1}/1/1 {c + 1}/1/1\n" for a, b, c in FACETS)
).encode()
ASCII_STL = (
    "solid x\n"
    + "".join(
        "facet normal 0 0 1\nouter loop\n"
        + "".join("vertex {} {} {}\n".format(*TETRAHEDRON[corner]) for corner in facet)
        + "endloop\nendfacet\n"
        for facet in FACETS
    )
    + "endsolid x\n"
).encode()
BINARY_STL = (
    bytes(80)
    + struct.pack("<I", len(FACETS))
    + b"".join(
        struct.pack("<12fH", 0, 0, 1, *(x for corner in facet for x in TETRAHEDRON[corner]), 0)
        for facet in FACETS
    )
)
DAE = (
    b'<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1"><asset>'
    b'<unit name="centimeter" meter="0.01"/><up_axis>Z_UP</up_axis></asset>'
    b'<library_geometries><geometry id="g"><mesh><source id="p"><float_array id="a" count="9">'
    b'0 0 0 1 0 0 0 1 1</float_array><technique_common><accessor source="#a" count="3" stride="3">'
    b'<param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/>'
    b'</accessor></technique_common></source><vertices id="v"><input semantic="POSITION" '
    b'source="#p"/></vertices><triangles count="1"><input semantic="VERTEX" source="#v" '
    b'offset="0"/><p>0 1 2</p></triangles></mesh></geometry></library_geometries>'
    b'<library_visual_scenes><visual_scene id="s"><node id="n"><instance_geometry url="#g"/></node>'
    b'</visual_scene></library_visual_scenes><scene><instance_visual_scene url="#s"/></scene>'
    b"</COLLADA>"
)
BY_HAND = robot_by_hand(2.5, (0.032, 0.055, 0.07))


@dataclass(frozen=True)
class Reader:
    """A reader of one kind of file.

    Attributes:
        file: name of the file.
        read: reads and processes it; OcsError is the only permitted exception.
        seeds: valid contents.
        words: with a meaning in such files.
    """

    file: str
    read: Callable[[Path], object]
    seeds: tuple[bytes, ...]
    words: tuple[bytes, ...] = field(default=())


def read_and_inspect(path: Path) -> object:
    """As `ocs-design inspect` does."""
    return to_json(inspect_robot(Specification(robot=RobotSection(file=str(path)))))


def read_and_build(path: Path) -> object:
    """Read a robot and compile it in MuJoCo."""
    read_and_inspect(path)
    return build_spec(read_robot(path), visuals=False).spec.compile()


def read_and_resolve(path: Path) -> object:
    """Read a specification and resolve it for a robot."""
    specification = read_specification(path)
    return resolve(
        specification, BY_HAND, longest_side(BY_HAND.tree, BY_HAND.posture, BY_HAND.trunk)
    )


def read_and_restore(path: Path) -> object:
    """Read a design and restore its live values, without its robot's file."""
    design, device = read_design_and_device(path)
    robot = robot_of(design.robot, path, {}) if design.robot.format == "manual" else None
    return (
        safe_name(design.robot.name),
        device.mass,
        base_of(design.robot),
        robot,
        to_json(design),
    )


def read_mesh_bounds(path: Path) -> object:
    """Bounds of a mesh; None if it cannot be read."""
    unscaled_bounds.cache_clear()
    return mesh_bounds(path, (1.0, 1.0, 1.0))


def build_with_mesh(path: Path) -> object:
    """Compile a robot whose trunk is this mesh in MuJoCo."""
    urdf = path.with_name("mesh.urdf")
    shape = f'<collision><geometry><mesh filename="{path.name}"/></geometry></collision>'
    urdf.write_bytes(robot(link("trunk", inertial(2.0, "0.01 0.02 0.03"), shape)))
    read_mesh_bounds(path)
    return build_spec(read_robot(urdf), visuals=False).spec.compile()


def size_device(path: Path) -> None:
    """Run `size` at its fastest; any exit code but those for usage and missing tools may occur."""
    out = path.with_name("out")
    code = run("size", path, *BOUND, "--ballistic", "--force", "-q", "-o", out).code
    assert code in {0, 1, 3, 4}, f"exit code {code}"
    if code in {0, 1}:
        assert read_design(out / "design.json").files == recorded_hashes(out)
    else:
        raise OcsError(f"exit code {code}")


XML_WORDS = (
    *(b"<origin ", b"<robot>", b"<link name=", b"<joint ", b'type="fixed"', b'type="floating"'),
    *(b"<mimic ", b"<limit ", b"xyz=", b"rpy=", b"<!DOCTYPE ", b"<!ENTITY ", b"&#0;", b"&amp;"),
    *(b"<![CDATA[", b'<?xml encoding="utf-16"?>', b"xmlns=", b"xmlns:xacro="),
)
MJCF_WORDS = (
    *(b'<include file="x.xml"/>', b"<default class=", b"<freejoint/>", b'type="ball"', b"quat="),
    *(b'type="mesh"', b"euler=", b"<compiler ", b"<option ", b"<size memory=", b"<flag "),
    *(b"<composite ", b"<replicate count=", b"<frame ", b"<key ", b"childclass=", b"<tendon>"),
    *(b"fromto=", b"<plugin ", b"<flexcomp ", b"inertiafromgeom=", b"meshdir=", b"<equality>"),
)
XACRO_WORDS = (
    *(b"${", b"$(arg x)", b"$(eval 1)", b"$(env HOME)", b"$(find x)", b"xacro:include", b"**"),
    *(b"xacro:property", b"xacro:if", b"xacro:macro", b"xacro:element", b"xacro:call", b"lambda"),
    *(b"xacro.load_yaml('a')", b"python.", b"lazy_eval=", b'scope="global"'),
)
TOML_WORDS = tuple(
    b"[[maneuver]]|[flywheel]|[ocs]|[motor]|[requirement]|kind = 'pitch'|r_max|'30mm'|{|}|'''|0x10|"
    b"1979-05-27|true|nan|inf|-0.0|1e400|[robot]|mass =|inertia =".split(b"|")
)

READERS = {
    "urdf": Reader("x.urdf", read_and_inspect, (URDF, SOLO12_TEXT), XML_WORDS),
    "mjcf": Reader("x.xml", read_and_build, (MJCF.encode(),), XML_WORDS + MJCF_WORDS),
    "xacro": Reader("x.xacro", read_and_inspect, (XACRO,), XML_WORDS + XACRO_WORDS),
    "srdf": Reader("x.srdf", lambda path: read_group_states(path.read_bytes()), (SRDF,), XML_WORDS),
    "specification": Reader(
        "x.toml",
        read_and_resolve,
        tuple((ROOT / "examples" / name).read_bytes() for name in ("by_hand.toml", "solo12.toml")),
        TOML_WORDS,
    ),
    "motors": Reader(
        "x.csv", load_motors, (MOTORS.replace(b"plenty", b"1").replace(b"413.5", b""),)
    ),
    "gears": Reader("x.toml", load_gears, (GEARS,), TOML_WORDS),
    "design": Reader(
        "design.json",
        read_and_restore,
        ((ROOT / "tests" / "data" / "design_0_1_0.json").read_bytes(),),
        (b"null", b"1e999", b"NaN", b"[", b"{", b'"\\u001b"', b'"\\ud800"'),
    ),
    "stl": Reader("x.stl", build_with_mesh, (BINARY_STL, ASCII_STL)),
    "obj": Reader("x.obj", build_with_mesh, (OBJ,)),
    "dae": Reader("x.dae", build_with_mesh, (DAE,), XML_WORDS),
}

SLOW_READERS = {"size": Reader("x.urdf", size_device, (URDF, SOLO12_TEXT), XML_WORDS)}
"""Readers that take seconds per file: run only when named."""

SPLIT = (b"\n", b"<", b" ", b'"', b",", b"{")
NUMBERS = tuple(
    b"0 -0 -1 1e308 -1e308 1e-320 nan inf -inf 1e999 9999999999999999999999 0x1p3 1_000".split()
)
TEXTS = (
    *(b"../../x", b"/etc/passwd", b"\0", b"\xff\xfe", b"\xc2\x9b2J", b"[bold]", b"<script>", b"&"),
)


def mutated(seeds, words, draw):
    """A random seed with a few changes of bytes, words, numbers or whole pieces."""
    content = draw.choice(seeds)
    for _ in range(draw.choice((1, 1, 1, 2, 3, 8))):
        content = draw.choice((_bytes, _word, _number, _number, _piece, _piece, _cut))(
            content, seeds, words, draw
        )
    return content


def _bytes(content, _seeds, _words, draw):
    changed = bytearray(content)
    for _ in range(draw.randint(1, 4)):
        if changed:
            changed[draw.randrange(len(changed))] = draw.randrange(256)
    return bytes(changed)


def _word(content, _seeds, words, draw):
    place = draw.randint(0, len(content))
    return content[:place] + draw.choice((*words, *TEXTS)) + content[place:]


def _number(content, _seeds, _words, draw):
    digits = [index for index, byte in enumerate(content) if chr(byte).isdigit()]
    if not digits:
        return content
    start = end = draw.choice(digits)
    while end < len(content) and content[end] in b"0123456789.eE+-":
        end += 1
    return content[:start] + draw.choice(NUMBERS) + content[end:]


def _piece(content, seeds, _words, draw):
    mark = draw.choice(SPLIT)
    pieces, others = content.split(mark), draw.choice(seeds).split(mark)
    place = draw.randrange(len(pieces))
    pieces[place : place + draw.randint(0, 2)] = [draw.choice(others)] * draw.choice(
        (0, 1, 1, 2, 50)
    )
    return mark.join(pieces)


def _cut(content, _seeds, _words, draw):
    return content[: draw.randint(0, len(content))]
