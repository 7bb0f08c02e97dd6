"""Paths of the real robots in example-robot-data."""

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
"""Folders of robots that take long to read because of many joints or fine meshes."""


def robot_parameters(robots, *, each=True):
    """Paths or names of robots as parameters, large ones marked slow.

    Unless `each`, all but the first robot of each folder are marked exhaustive.
    """
    seen, parameters = set(), []
    for robot in robots:
        name = str(robot.relative_to(ROBOTS)) if isinstance(robot, Path) else robot
        folder = name.partition("/")[0]
        marks = [pytest.mark.slow] * (folder in LARGE)
        if folder in seen and not each:
            marks = [pytest.mark.exhaustive]
        parameters.append(pytest.param(robot, id=name, marks=marks))
        seen.add(folder)
    return parameters


def one_per_folder(robots):
    """Paths or names of robots as parameters, all but the first of each folder exhaustive."""
    return robot_parameters(robots, each=False)
