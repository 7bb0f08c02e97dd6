"""Draws the pictures of these pages: Solo12 with its device, standing, and a wheel on paper.

MUJOCO_GL=egl python docs/draw.py        or MUJOCO_GL=osmesa; needs OpenGL and Pillow
"""

import tempfile
from pathlib import Path

import mujoco
import numpy as np
from PIL import Image

from ocs_design import design_ocs
from ocs_design.device.records.design import OcsDesign
from ocs_design.export.drawing.wheel import WheelDrawing
from ocs_design.export.drawing.wheel_sheet import draw_wheel
from ocs_design.parts.rim import Hub, RimCuts
from ocs_design.parts.wheel import Rim, Web, Wheel
from ocs_design.requirement.sections import RobotSection, ValidationSection
from ocs_design.requirement.specification import Specification

ROOT = Path(__file__).resolve().parents[1]
PICTURE = ROOT / "docs" / "_static" / "solo12-ocs.png"
DRAWING = ROOT / "docs" / "_static" / "wheel.svg"
WIDTH, HEIGHT, OVERSAMPLING = 900, 560, 2

WHEEL = WheelDrawing(
    wheel=Wheel(
        Rim(0.0392, 0.0413, 0.00305, "stainless-304", 8000.0, RimCuts(chamfer=0.3e-3)),
        Web(
            material="aluminium-6061-t6",
            density=2710.0,
            thickness=0.0015,
            mass=0.0227,
            hub=Hub(
                radius=0.0115,
                height=0.005,
                bore_radius=0.003,
                bolts=4,
                bolt_circle_radius=0.008,
                bolt_hole_radius=0.0017,
            ),
        ),
    ),
    robot="solo12",
    identity="an example",
    speed=750.0,
    count=2,
)
"""An example that shows everything a sheet has."""


def main() -> None:
    """Design, pose, light, draw."""
    specification = Specification(
        robot=RobotSection(file=str(ROOT / "examples" / "solo12.urdf")),
        validation=ValidationSection(enabled=False),
    )
    with tempfile.TemporaryDirectory() as folder:
        outcome = design_ocs(specification, out=Path(folder) / "solo12-ocs")
        spec = mujoco.MjSpec.from_file(str(outcome.folder / "robot" / "solo12_ocs.xml"))
        light(spec, (WIDTH, HEIGHT))
        model = spec.compile()
    data = mujoco.MjData(model)
    pose(data, outcome.design)
    mujoco.mj_forward(model, data)
    camera = mujoco.MjvCamera()
    camera.lookat = np.array([0.0, 0.0, 0.175])
    camera.distance, camera.azimuth, camera.elevation = 0.82, 143.0, -24.0
    draw(model, data, camera, (WIDTH, HEIGHT)).save(PICTURE, optimize=True)
    DRAWING.write_bytes(draw_wheel(WHEEL)["svg"])
    print(f"wrote {PICTURE.relative_to(ROOT)} and {DRAWING.relative_to(ROOT)}")


def light(spec: mujoco.MjSpec, size: tuple[int, int]) -> None:
    """A white studio with a floor that only takes shadows, for pictures so wide and high."""
    view = spec.visual
    view.global_.offwidth, view.global_.offheight = (OVERSAMPLING * side for side in size)
    view.headlight.ambient, view.headlight.diffuse = [0.5] * 3, [0.3] * 3
    view.quality.shadowsize = 8192
    spec.add_texture(
        type=mujoco.mjtTexture.mjTEXTURE_SKYBOX,
        builtin=mujoco.mjtBuiltin.mjBUILTIN_FLAT,
        rgb1=[1.0] * 3,
        width=64,
        height=64,
    )
    spec.worldbody.add_light(
        pos=[0.4, 0.7, 3.5],
        dir=[-0.1, -0.2, -1.0],
        cutoff=80.0,
        exponent=1.0,
        diffuse=[0.4] * 3,
        specular=[0.1] * 3,
    )
    spec.worldbody.add_geom(type=mujoco.mjtGeom.mjGEOM_PLANE, size=[0.0, 0.0, 0.1], rgba=[1.0] * 4)


def pose(data: mujoco.MjData, design: OcsDesign) -> None:
    """The nominal posture, feet on the floor."""
    for joint, value in design.robot.posture.items():
        data.joint(joint).qpos[0] = value
    data.qpos[2] = design.robot.standing_height


def draw(
    model: mujoco.MjModel, data: mujoco.MjData, camera: mujoco.MjvCamera, size: tuple[int, int]
) -> Image.Image:
    """Drawn larger and reduced, so that edges are smooth."""
    width, height = size
    renderer = mujoco.Renderer(model, height * OVERSAMPLING, width * OVERSAMPLING)
    renderer.update_scene(data, camera)
    image = Image.fromarray(renderer.render())
    renderer.close()
    return image.resize(size, Image.Resampling.LANCZOS)


if __name__ == "__main__":
    main()
