"""What each package is for, and the module that it brings."""

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType


@dataclass(frozen=True)
class Use:
    """Of one package.

    Attributes:
        purpose: for people.
        module: to import; empty: named like the package.
    """

    purpose: str
    module: str = ""


USES: Mapping[str, Use] = MappingProxyType(
    {
        "numpy": Use("arrays"),
        "scipy": Use("roots and small optimisations"),
        "cvxpy": Use("the rim as a convex program"),
        "clarabel": Use("solves for the rim"),
        "casadi": Use("maneuvers as optimal control"),
        "typer": Use("the command line"),
        "rich": Use("tables and progress"),
        "msgspec": Use("design.json in and out"),
        "packaging": Use("this check"),
        "trimesh": Use("meshes of parts"),
        "manifold3d": Use("holes in meshes"),
        "mujoco": Use("robots, flights and pictures"),
        "pycollada": Use("robots with .dae meshes", "collada"),
        "xacro": Use("robots that come as .xacro"),
        "matplotlib": Use("figures as PNG"),
        "dask": Use("Monte Carlo on many machines"),
        "distributed": Use("Monte Carlo on many machines"),
        "pyarrow": Use("samples as Parquet"),
        "pillow": Use("words on videos", "PIL"),
        "imageio-ffmpeg": Use("videos where the system has no ffmpeg"),
        "cadquery-ocp-novtk": Use("parts in STEP for CAD", "OCP"),
    }
)
"""By the package's name."""
