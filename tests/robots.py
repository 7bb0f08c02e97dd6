"""Where the real robots of example-robot-data lie."""

import sysconfig
from pathlib import Path

import pytest

SITE_PACKAGES = Path(sysconfig.get_paths()["purelib"])
ROBOTS = SITE_PACKAGES / "cmeel.prefix" / "share" / "example-robot-data" / "robots"
SOLO12 = ROBOTS / "solo_description" / "robots" / "solo12.urdf"
ALL_URDFS = sorted(ROBOTS.rglob("*.urdf"))


def one_of_each(robots):
    """Paths or names of robots as parameters: the first of each maker's, the rest exhaustive."""
    seen, marked = set(), []
    for robot in robots:
        name = str(robot.relative_to(ROBOTS)) if isinstance(robot, Path) else robot
        family = name.partition("/")[0]
        marked.append(
            pytest.param(robot, id=name, marks=[pytest.mark.exhaustive] if family in seen else [])
        )
        seen.add(family)
    return marked
