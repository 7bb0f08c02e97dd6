"""`select` on Solo12 with the whole catalogue, in one process on one core.

    python benchmarks/selection.py [RUNS]

A candidate is a motor behind a gear with a material in a cell of 5 deg of incidence, each decided:
settled, or left out by a bound on its mass. Goal: at least 100,000 a second.
"""

import os
import statistics
import sys
import time

# One core: before NumPy starts its threads.
os.environ.update(OMP_NUM_THREADS="1", OPENBLAS_NUM_THREADS="1", MKL_NUM_THREADS="1")

from co_design import robot_problem

from ocs_design.sizing.selection.select import select

GOAL = 100_000


def main() -> None:
    runs = int(sys.argv[1]) if len(sys.argv) > 1 else 7
    problem = robot_problem("Solo12")
    # One run, not counted, warms the caches.
    choice = select(problem)
    print(
        f"{len(problem.motors)} motors, {len(problem.gears)} gears, "
        f"{len(problem.materials)} materials: {choice.candidates} candidates"
    )
    seconds = [timed(problem) for _ in range(runs)]
    for index, duration in enumerate(seconds, start=1):
        print(f"{index:>6}  {duration:>8.3f} s  {choice.candidates / duration:>12,.0f} /s")
    median = statistics.median(seconds)
    print(f"median  {median:>8.3f} s  {choice.candidates / median:>12,.0f} /s  (goal: {GOAL:,})")


def timed(problem) -> float:
    start = time.perf_counter()
    select(problem)
    return time.perf_counter() - start


if __name__ == "__main__":
    main()
