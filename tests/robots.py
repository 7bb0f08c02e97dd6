"""Where the real robots of example-robot-data lie."""

import sysconfig
from pathlib import Path

SITE_PACKAGES = Path(sysconfig.get_paths()["purelib"])
ROBOTS = SITE_PACKAGES / "cmeel.prefix" / "share" / "example-robot-data" / "robots"
SOLO12 = ROBOTS / "solo_description" / "robots" / "solo12.urdf"
ALL_URDFS = sorted(ROBOTS.rglob("*.urdf"))
