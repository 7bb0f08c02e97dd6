"""Fills the gallery: a dozen public robots, each sized by its file alone, and pictured.

    MUJOCO_GL=egl python docs/gallery.py [PART_OF_A_NAME ...]     or MUJOCO_GL=osmesa

Needs OpenGL, Pillow and the package example-robot-data; takes two minutes. Run by hand: CI only
checks that the page has a row and a picture for each robot. With names, only their pictures are
drawn again.
"""

import json
import subprocess
import sys
import sysconfig
import tempfile
from dataclasses import dataclass, replace
from pathlib import Path

import blocks
import draw
import mujoco
import numpy as np
from PIL import Image

from ocs_design.actuation.motor import DIRECT
from ocs_design.device.records import OcsDesign, read_design
from ocs_design.export.offscreen import shown_box
from ocs_design.report.quantities import grams, tenths
from ocs_design.requirement.froude import default_maneuvers
from ocs_design.requirement.specification import RobotSection, Specification
from ocs_design.requirement.writing import specification_to_toml
from ocs_design.robot.reader import read_robot

ROOT = Path(__file__).resolve().parents[1]
PAGE = ROOT / "docs" / "gallery.md"
PICTURES = ROOT / "docs" / "_static" / "gallery"
ROBOTS = Path(sysconfig.get_paths()["purelib"]) / "cmeel.prefix/share/example-robot-data/robots"
WIDTH, HEIGHT, OVERSAMPLING = 480, 400, 2
QUALITY = 82

GENTLE, GENTLE_NAME = np.radians(10.0), "a drop at 10° only"
"""[rad], asked of robots for which no motor is quick enough otherwise."""

DARKEST = 0.2
"""Brightness of what is drawn."""

ACROSS = 3
"""Pictures side by side."""

HEADER = (
    "robot", "legs", "mass", "α\\*", "wheel R × h", "motor", "device", "of the robot", "flights"
)  # fmt: skip


@dataclass(frozen=True)
class Entry:
    """A robot of the gallery.

    Attributes:
        title: for people. picture: its name. file: below example-robot-data's robots, or here.
    """

    title: str
    picture: str
    file: Path


ENTRIES = tuple(
    Entry(title, picture, ROBOTS / file)
    for title, picture, file in (
        ("Bolt", "bolt", "bolt_description/robots/bolt.urdf"),
        ("Solo12", "solo12", "solo_description/robots/solo12.urdf"),
        ("Unitree A1", "a1", "a1_description/urdf/a1.urdf"),
        ("Unitree Go1", "go1", "go1_description/urdf/go1.urdf"),
        ("Unitree Go2", "go2", "go2_description/urdf/go2.urdf"),
        ("Laikago", "laikago", "laikago_description/urdf/laikago.urdf"),
        ("iCub", "icub", "icub_description/robots/icub.urdf"),
        ("Unitree G1", "g1", "g1_description/urdf/g1_29dof_rev_1_0.urdf"),
        ("ANYmal C", "anymal-c", "anymal_c_simple_description/urdf/anymal.urdf"),
        ("Unitree B1", "b1", "b1_description/urdf/b1.urdf"),
        ("HyQ", "hyq", "hyq_description/robots/hyq_no_sensors.urdf"),
        ("TALOS", "talos", "talos_data/robots/talos_reduced.urdf"),
    )
)


def main() -> None:
    """Size, picture, tabulate."""
    PICTURES.mkdir(parents=True, exist_ok=True)
    words = sys.argv[1:]
    rows = []
    for entry in ENTRIES:
        if words and not any(word in entry.picture for word in words):
            continue
        rows.append(made(entry))
        print(" ".join(rows[-1]), flush=True)
    if not words:
        kinds = {"gallery": {"table": blocks.table(HEADER, rows), "pictures": sheet()}.__getitem__}
        text = PAGE.read_text(encoding="utf-8")
        PAGE.write_text(blocks.filled(text, kinds), encoding="utf-8")


def made(entry: Entry) -> tuple[str, ...]:
    """Size and picture one robot; its row of the table."""
    with tempfile.TemporaryDirectory() as folder:
        out, gentler = Path(folder) / "design", Path(folder) / "gentler.toml"
        title, refusal = entry.title, size(out, str(entry.file))
        if refusal:
            gentler.write_text(gentle(entry), encoding="utf-8")
            title, refusal = f"{entry.title}, {GENTLE_NAME}", size(out, "--spec", str(gentler))
        if refusal:
            return (entry.title, *["–"] * (len(HEADER) - 2), f"no device: {refusal}")
        design = read_design(out / "design.json")
        picture(design, next((out / "robot").glob("*.xml")), entry)
        return row(title, design)


def gentle(entry: Entry) -> str:
    """A specification for robots that ask more than any motor of the catalogue gives."""
    robot = read_robot(entry.file)
    _, drop, _ = default_maneuvers(robot)
    return specification_to_toml(
        Specification(
            robot=RobotSection(file=str(entry.file)), maneuvers=(replace(drop, pitch=GENTLE),)
        )
    )


def size(out: Path, *arguments: str) -> str:
    """Why there is no device; empty if there is one, whether its flights pass or not."""
    command = [sys.executable, "-m", "ocs_design", "size", *arguments, "-o", str(out), "--json"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    error = json.loads(done.stdout).get("error")
    return "" if error is None else str(error["message"])


def row(title: str, design: OcsDesign) -> tuple[str, ...]:
    """Of the table."""
    ocs, wheel = design.ocs, design.ocs.flywheel
    gear = "" if ocs.motor.gear == DIRECT.name else f", {ocs.motor.gear}"
    return (
        title,
        str(len(design.robot.legs)),
        f"{design.robot.mass:.1f} kg",
        f"{np.degrees(ocs.incidence):.1f}°",
        f"{tenths(wheel.outer_radius)} × {tenths(wheel.height)} mm",
        f"{ocs.motor.name}{gear}",
        grams(ocs.mass_total),
        f"{ocs.mass_total / design.robot.mass:.1%}",
        flights(design),
    )


def flights(design: OcsDesign) -> str:
    """How many pass, with the device and without, and which does not with it."""
    passed = dict.fromkeys((True, False), 0)
    for run in design.validation:
        passed[run.ocs] += run.passed is True
    failed = [run.scenario for run in design.validation if run.ocs and run.passed is not True]
    count = len(design.validation) // 2
    told = f"; not {', '.join(failed)}" if failed else ""
    return f"{passed[True]} of {count} pass, {passed[False]} without{told}"


def sheet() -> str:
    """The pictures that there are, side by side."""
    shown = [
        f"![{entry.title} with its device](_static/gallery/{entry.picture}.webp) {entry.title}"
        for entry in ENTRIES
        if (PICTURES / f"{entry.picture}.webp").exists()
    ]
    shown += [""] * (-len(shown) % ACROSS)
    rows = [tuple(shown[i : i + ACROSS]) for i in range(0, len(shown), ACROSS)]
    return blocks.table(("",) * ACROSS, rows)


def picture(design: OcsDesign, file: Path, entry: Entry) -> None:
    """The robot with its device, standing, as WebP."""
    spec = mujoco.MjSpec.from_file(str(file))
    draw.light(spec)
    spec.visual.global_.offwidth = WIDTH * OVERSAMPLING
    spec.visual.global_.offheight = HEIGHT * OVERSAMPLING
    model = spec.compile()
    for colors in (model.geom_rgba, model.mat_rgba):
        # Black as the night, of files that state no color: nothing would be seen of its shape.
        colors[np.max(colors[:, :3], axis=1) < DARKEST, :3] = DARKEST
    data = mujoco.MjData(model)
    draw.pose(data, design)
    mujoco.mj_forward(model, data)
    image = snapshot(model, data).resize((WIDTH, HEIGHT), Image.Resampling.LANCZOS)
    image.save(PICTURES / f"{entry.picture}.webp", quality=QUALITY, method=6)


def snapshot(model: mujoco.MjModel, data: mujoco.MjData) -> Image.Image:
    """From the front left and above, all of it."""
    planes = model.geom_type == mujoco.mjtGeom.mjGEOM_PLANE
    groups = model.geom_group[planes].copy()
    model.geom_group[planes] = mujoco.mjNGROUP - 1
    low, high = shown_box(model, data)
    model.geom_group[planes] = groups
    camera = mujoco.MjvCamera()
    camera.lookat = (low + high) / 2.0
    camera.distance = 1.25 * float(np.linalg.norm(high - low))
    camera.azimuth, camera.elevation = 143.0, -22.0
    renderer = mujoco.Renderer(model, HEIGHT * OVERSAMPLING, WIDTH * OVERSAMPLING)
    renderer.update_scene(data, camera)
    image = Image.fromarray(renderer.render())
    renderer.close()
    return image


if __name__ == "__main__":
    main()
