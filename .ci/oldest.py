"""The oldest versions that pyproject.toml allows, as constraints for pip.

    python .ci/oldest.py > oldest.txt

What is not named there stays free: pip takes the newest that goes with these.
"""

import re
import tomllib
from pathlib import Path

LOWEST = re.compile(r"([\w.-]+)>=([\w.]+)")


def main() -> None:
    """Print one line for each."""
    project = tomllib.loads(Path("pyproject.toml").read_text(encoding="utf-8"))["project"]
    extras = project["optional-dependencies"]
    wanted = {*project["dependencies"], *(line for name in extras for line in extras[name])}
    for line in sorted(wanted):
        bound = LOWEST.match(line)
        # Our own name stands for another list of extras.
        if bound is None and not line.startswith(project["name"]):
            raise SystemExit(f"pyproject.toml: {line} has no lower bound")
        if bound is not None:
            print(f"{bound[1]}=={bound[2]}")


if __name__ == "__main__":
    main()
