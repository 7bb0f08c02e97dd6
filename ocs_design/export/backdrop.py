"""What is behind and beneath what is drawn."""

import mujoco

CHEQUERS = 4.0
"""Pairs of the floor's tiles in the extent of a robot."""


def add_white_sky(spec: mujoco.MjSpec) -> None:
    """It shows through what one can look into."""
    spec.add_texture(
        name="ocs_sky",
        type=mujoco.mjtTexture.mjTEXTURE_SKYBOX,
        builtin=mujoco.mjtBuiltin.mjBUILTIN_FLAT,
        rgb1=(1.0, 1.0, 1.0),
        width=16,
        height=16,
    )


def add_floor(spec: mujoco.MjSpec, extent: float) -> None:
    """A chequered plane at z = 0 in the light of the sun, for a robot of that extent [m]."""
    name = "ocs_floor"
    spec.add_texture(
        name=name,
        type=mujoco.mjtTexture.mjTEXTURE_2D,
        builtin=mujoco.mjtBuiltin.mjBUILTIN_CHECKER,
        rgb1=(0.90, 0.91, 0.92),
        rgb2=(0.80, 0.81, 0.83),
        width=64,
        height=64,
    )
    material = spec.add_material(name=name, texuniform=True)
    material.textures[mujoco.mjtTextureRole.mjTEXROLE_RGB] = name
    material.texrepeat = [CHEQUERS / extent] * 2
    spec.worldbody.add_light(
        type=mujoco.mjtLightType.mjLIGHT_DIRECTIONAL,
        dir=(0.3, 0.4, -1.0),
        diffuse=(0.5, 0.5, 0.5),
        castshadow=False,
    )
    spec.worldbody.add_geom(
        name=name, type=mujoco.mjtGeom.mjGEOM_PLANE, size=(0.0, 0.0, 1.0), material=name
    )
