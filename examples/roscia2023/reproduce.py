"""The paper again: every number of it beside what comes out here, and its figures.

    python examples/roscia2023/reproduce.py             fills docs/paper.md, draws its figures
    python examples/roscia2023/reproduce.py --tables    without the figures

Roscia, Cumerlotti, Del Prete, Semini, Focchi: Orientation Control System: Enhancing Aerial
Maneuvers for Quadruped Robots. Sensors 23:1234, 2023. The figures need
matplotlib. Takes ten seconds.
"""

import argparse
import sys
from collections.abc import Callable, Iterable, Mapping
from functools import cache
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))  # for those who load this file from elsewhere
sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "docs"))

import blocks
import design_figures
import experiments
from statements import HEADER, Statement

from ocs_design.robot.reader import read_robot
from ocs_design.robot.robot import Robot

ROOT = Path(__file__).resolve().parents[2]
PAGE = ROOT / "docs" / "paper.md"
FIGURES = ROOT / "docs" / "_static" / "paper"


@cache
def solo12() -> Robot:
    """At its nominal posture."""
    return read_robot(ROOT / "examples" / "solo12.urdf")


QUICK: Mapping[str, Callable[[], Iterable[Statement]]] = {
    "robot": lambda: design_figures.robot_statements(solo12()),
    "bound": lambda: design_figures.bound_statements(solo12()),
    "angle": lambda: design_figures.angle_statements(solo12()),
    "wheel": design_figures.wheel_statements,
    "physics": lambda: experiments.physics_statements(solo12()),
}
"""Tables of the page that are done at once, `<!-- begin paper: NAME -->`."""

FLOWN: Mapping[str, Callable[[], Iterable[Statement]]] = {
    "disturbance": experiments.disturbance_statements,
    "drop": experiments.drop_statements,
    "back-flip": experiments.flip_statements,
}
"""Those that need the flights, `<!-- begin paper flight: NAME -->`."""


def page(text: str, *, flown: bool = True) -> str:
    """The page with its tables made anew; without the flights those stay as they are."""
    kinds = {"paper": lambda name: as_table(QUICK[name]())}
    if flown:
        kinds["paper flight"] = lambda name: as_table(FLOWN[name]())
    return blocks.filled(text, kinds)


def as_table(statements: Iterable[Statement]) -> str:
    """In Markdown."""
    rows = ((s.what, s.stated, s.found, s.difference or "–", s.why or "–") for s in statements)
    return blocks.table(HEADER, rows)


def main() -> None:
    """Fill the page, draw the figures."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--tables", action="store_true", help="leave the figures as they are")
    arguments = parser.parse_args()
    PAGE.write_text(page(PAGE.read_text(encoding="utf-8")), encoding="utf-8")
    print(f"filled {PAGE.relative_to(ROOT)}")
    if not arguments.tables:
        from drawings import draw_all  # noqa: PLC0415  Matplotlib is an extra

        for path in draw_all(solo12(), experiments.fly(), FIGURES):
            print(f"drew {path.relative_to(ROOT)}")


if __name__ == "__main__":
    main()
