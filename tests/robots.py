"""Where the real robots of example-robot-data lie."""

import sysconfig
from pathlib import Path

import pytest

SITE_PACKAGES = Path(sysconfig.get_paths()["purelib"])
ROBOTS = SITE_PACKAGES / "cmeel.prefix" / "share" / "example-robot-data" / "robots"
SOLO12 = ROBOTS / "solo_description" / "robots" / "solo12.urdf"
ALL_URDFS = sorted(ROBOTS.rglob("*.urdf"))

LARGE = {
    f"{family}_description"
    for family in (
        *("alex", "anymal_b_simple", "b1", "baxter", "borinot", "centauro", "g1", "hextilt"),
        *("icub", "kinova", "pr2", "romeo", "tiago", "tiago_pro"),
    )
} | {"talos_data"}
"""Folders of robots with so many joints or so fine meshes that to read one takes a while."""


def robot_parameters(robots, *, each=True):
    """Paths or names of robots as parameters, large ones slow.

    `each`: all of them count; else the first of each folder does, and the rest is exhaustive.
    """
    seen, found = set(), []
    for robot in robots:
        name = str(robot.relative_to(ROBOTS)) if isinstance(robot, Path) else robot
        folder = name.partition("/")[0]
        marks = [pytest.mark.slow] * (folder in LARGE)
        if folder in seen and not each:
            marks = [pytest.mark.exhaustive]
        found.append(pytest.param(robot, id=name, marks=marks))
        seen.add(folder)
    return found


def one_per_folder(robots):
    """Paths or names of robots as parameters: the first of each maker's, the rest exhaustive."""
    return robot_parameters(robots, each=False)
