"""How long the command line takes to say anything, against what its parser costs to import.

    python benchmarks/startup.py [PAIRS]

Goal: `ocs-design --help` takes at most 1.5 times `python -c "import typer"`.
"""

import sys

from paired import PROGRAM, alternate, print_pairs, run_process

LIMIT = 1.5


def main() -> None:
    pairs = int(sys.argv[1]) if len(sys.argv) > 1 else 15
    print_pairs(
        alternate(
            lambda: run_process([PROGRAM, "--help"]),
            lambda: run_process([sys.executable, "-c", "import typer"]),
            pairs,
        ),
        ("ocs-design --help", "import typer"),
        LIMIT,
    )


if __name__ == "__main__":
    main()
