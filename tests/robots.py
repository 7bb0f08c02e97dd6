"""Where the real robots of example-robot-data lie."""

import sysconfig
from pathlib import Path

ROBOTS = (
    Path(sysconfig.get_paths()["purelib"]) / "cmeel.prefix" / "share" / "example-robot-data" / "robots"
)
SOLO12 = ROBOTS / "solo_description" / "robots" / "solo12.urdf"
ALL_URDFS = sorted(ROBOTS.rglob("*.urdf"))
