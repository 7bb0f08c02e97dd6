"""The command that brings a package to where this program is installed."""

import shlex
import sys
from importlib.util import find_spec
from pathlib import Path

DISTRIBUTION = "ocs-design"


def install_command(*requirements: str, options: str = "") -> str:
    """Command of the tool that made this environment: pip, pipx or uv."""
    what = " ".join([*options.split(), *(f"'{each}'" for each in requirements)])
    environment = Path(sys.prefix)
    if (environment / "pipx_metadata.json").is_file():
        return f"pipx runpip {environment.name} install {what}"
    if find_spec("pip") is None:
        return f"uv pip install --python {shlex.quote(sys.executable)} {what}"
    return f"pip install {what}"


def extra_command(*extras: str) -> str:
    """Command that installs extras of this program, such as `ocs-design[step]`."""
    return install_command(f"{DISTRIBUTION}[{','.join(extras)}]")
