"""What a gear ratio that could be had at will would be worth, over the pairs of teeth that exist.

    python benchmarks/gear_ratio.py

The co-design leaves the gear as it was selected, for a belt has whole teeth. Here every robot's
best geared device is selected again from stages that differ from its own in nothing but the ratio,
in steps of 1 % and then of 0.1 % around the best: the mass that a continuous ratio would save.
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from co_design import FILES, robot_problem

from ocs_design.actuation.motor import DIRECT, Gear
from ocs_design.common.errors import Infeasible
from ocs_design.sizing.selection.problem import Candidate, SelectionProblem
from ocs_design.sizing.selection.select import select

STEPS = ((0.20, 0.01), (0.01, 0.001))
"""How far to both sides and in what steps, relative."""


def main() -> None:
    print("| robot | geared device | with any ratio | gain | ratio |\n|---|---|---|---|---|")
    for name in FILES:
        print(f"| {name} | {row(robot_problem(name))} |", flush=True)


def row(problem: SelectionProblem) -> str:
    """Of the lightest device that has a gear."""
    geared = [gear for gear in problem.gears if gear.name != DIRECT.name]
    chosen = best(replace(problem, gears=geared))
    if chosen is None:
        return "none | – | – | –"
    free = chosen
    for width, step in STEPS:
        ratios = free.gear.ratio * np.arange(1.0 - width, 1.0 + width + step / 2.0, step)
        choice = best(alone(problem, free, [replace(free.gear, ratio=float(r)) for r in ratios]))
        free = free if choice is None else choice
    return (
        f"{chosen.motor.name}, {chosen.gear.name}, {1e3 * chosen.mass:.1f} g "
        f"| {1e3 * free.mass:.1f} g | {1.0 - free.mass / chosen.mass:+.2%} "
        f"| {chosen.gear.ratio:.3f} to {free.gear.ratio:.3f}"
    )


def alone(problem: SelectionProblem, chosen: Candidate, gears: Sequence[Gear]) -> SelectionProblem:
    """The same motor and material behind each of these gears."""
    named = [replace(gear, name=f"{gear.name} at {gear.ratio:.4f}") for gear in gears]
    return replace(problem, motors=[chosen.motor], gears=named, materials=[chosen.material])


def best(problem: SelectionProblem) -> Candidate | None:
    """The lightest device; None: there is none."""
    try:
        return select(problem).best
    except Infeasible:
        return None


if __name__ == "__main__":
    main()
