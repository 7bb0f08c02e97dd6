"""Pictures of public robots with the devices that `benchmarks/legged_samples.py` keeps.

    MUJOCO_GL=egl python docs/gallery.py FOLDER [PART_OF_A_NAME ...]     or MUJOCO_GL=osmesa

FOLDER is that of the benchmark. Needs OpenGL and Pillow. Run by hand: CI only checks that the page
shows every picture. With names, only their pictures are drawn again.
"""

import sys
from pathlib import Path

import blocks
import draw
import mujoco
import numpy as np

from ocs_design.common.wording import grams
from ocs_design.device.records.design import OcsDesign, read_design
from ocs_design.export.offscreen import shown_box

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "benchmarks"))
from legged_samples import place

PAGE = Path(__file__).with_name("gallery.md")
PICTURES = PAGE.parent / "_static" / "gallery"
SIZE = (480, 400)
QUALITY = 82

DARKEST = 0.2
"""Brightness of what is drawn."""

ACROSS = 3
"""Pictures side by side."""

ENTRIES = {
    "Bolt": ("bolt", "bolt_description/robots/bolt"),
    "Solo of 8 joints": ("solo", "solo_description/robots/solo"),
    "Solo12": ("solo12", "solo_description/robots/solo12"),
    "Quadruped": ("quadruped", "quadruped_description/urdf/quadruped"),
    "Unitree Go1": ("go1", "go1_description/urdf/go1"),
    "Unitree A1": ("a1", "a1_description/urdf/a1"),
    "Unitree Go2": ("go2", "go2_description/urdf/go2"),
    "Laikago": ("laikago", "laikago_description/urdf/laikago"),
    "ANYmal B": ("anymal-b", "anymal_b_simple_description/robots/anymal"),
}
"""Name of the picture and robot of the benchmark, by title."""


def main() -> None:
    """Picture them, and write the page's table of pictures."""
    folder, *words = sys.argv[1:]
    PICTURES.mkdir(parents=True, exist_ok=True)
    cells = []
    for title, (name, robot) in ENTRIES.items():
        design = read_design(place(Path(folder), robot) / "ocs" / "design.json")
        if not words or any(word in name for word in words):
            file = next((place(Path(folder), robot) / "ocs" / "robot").glob("*_ocs.xml"))
            picture(design, file, PICTURES / f"{name}.webp")
        cells.append(cell(title, name, design))
    cells += [""] * (-len(cells) % ACROSS)
    rows = [tuple(cells[i : i + ACROSS]) for i in range(0, len(cells), ACROSS)]
    sheet = {"gallery": lambda _: blocks.table(("",) * ACROSS, rows)}
    PAGE.write_text(blocks.filled(PAGE.read_text(encoding="utf-8"), sheet), encoding="utf-8")


def cell(title: str, name: str, design: OcsDesign) -> str:
    """Picture and caption."""
    caption = f"{title}, {design.robot.mass:.1f} kg, and {grams(design.ocs.mass_total)}"
    return f"![{title} with its device](_static/gallery/{name}.webp) {caption}"


def picture(design: OcsDesign, file: Path, out: Path) -> None:
    """The robot with its device, standing, as WebP."""
    spec = mujoco.MjSpec.from_file(str(file))
    draw.light(spec, SIZE)
    model = spec.compile()
    for colors in (model.geom_rgba, model.mat_rgba):
        # Black as the night, of files that state no color: nothing would be seen of its shape.
        colors[np.max(colors[:, :3], axis=1) < DARKEST, :3] = DARKEST
    data = mujoco.MjData(model)
    draw.pose(data, design)
    mujoco.mj_forward(model, data)
    # From the front left and above, all of it but the floor.
    planes = model.geom_type == mujoco.mjtGeom.mjGEOM_PLANE
    groups = model.geom_group[planes].copy()
    model.geom_group[planes] = mujoco.mjNGROUP - 1
    low, high = shown_box(model, data)
    model.geom_group[planes] = groups
    camera = mujoco.MjvCamera()
    camera.lookat = (low + high) / 2.0
    camera.distance = 1.25 * float(np.linalg.norm(high - low))
    camera.azimuth, camera.elevation = 143.0, -22.0
    draw.draw(model, data, camera, SIZE).save(out, quality=QUALITY, method=6)


if __name__ == "__main__":
    main()
