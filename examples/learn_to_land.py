"""A policy learns to land Solo12 level, and is compared with the wheel law on robots it never flew.

    ocs-design size examples/solo12.urdf
    python examples/learn_to_land.py [DESIGN] [PICTURE]

The policy is linear: torques of the motors from the trunk's rate and what is left to turn, about
roll and pitch; eight numbers for two wheels.
They are found by the cross-entropy method (R. Rubinstein, Methodology and Computing in Applied
Probability 1, 1999, 127-190): draw policies, keep the best, draw around them.
"""

import os

# One thread each: the processes share the cores.
os.environ.setdefault("OMP_NUM_THREADS", "1")

import sys
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from pathlib import Path

import gymnasium
import numpy as np

from ocs_design.report.charts.chart import Axis, Chart, Curve, Ink, Rule
from ocs_design.report.charts.svg import svg_file

MANEUVER = "drop"
GENERATIONS, POLICIES, BEST, ROBOTS = 15, 16, 4, 2
SPREAD, LEAST_SPREAD = 3.0, 0.3
TESTED = range(1_000_000, 1_000_020)
"""Samples of the comparison: no training flight draws one of them."""

env = None


def begin(design: str) -> None:
    """Make the environment of a process."""
    global env  # noqa: PLW0603 - one for each process
    env = gymnasium.make("ocs_design.gym:OcsFlight-v0", design=design, maneuver=MANEUVER).unwrapped


def action(policy: np.ndarray, observation: np.ndarray) -> np.ndarray:
    """Torques from an observation, see `OcsFlight`."""
    rate, tilt = observation[3:5], observation[-5:-3]
    return np.clip(policy.reshape(-1, 4) @ np.concatenate([rate, tilt]), -1.0, 1.0)


def learnt(task: tuple[np.ndarray, int]) -> float:
    """Reward of a flight up to touchdown: by how much of half a turn it came nearer to level."""
    policy, sample = task
    observation, _ = env.reset(options={"sample": sample})
    total, is_over = 0.0, False
    while not is_over and observation[-1] == 0.0:
        observation, reward, is_over, _, _ = env.step(action(policy, observation))
        total += reward
    return total


def tested(policy: np.ndarray | None, sample: int) -> tuple[bool, float]:
    """Whether a whole flight passes, and its tilt at touchdown [rad]; None: the law flies."""
    observation, info = env.reset(options={"sample": sample})
    is_over = False
    while not is_over:
        command = info["law"] if policy is None else action(policy, observation)
        observation, _, is_over, _, info = env.step(command)
    tilt = np.hypot(env.metrics.touchdown_roll, env.metrics.touchdown_pitch)
    return info["passed"] is True, float(tilt)


def train(pool: ProcessPoolExecutor, size: int) -> tuple[np.ndarray, list[float]]:
    """The best policy's mean, and the mean reward of each generation's best."""
    rng = np.random.default_rng(0)
    mean, spread, curve = np.zeros(size), np.full(size, SPREAD), []
    for generation in range(GENERATIONS):
        drawn = mean + spread * rng.standard_normal((POLICIES, size))
        samples = rng.integers(TESTED.start, size=ROBOTS).tolist()
        tasks = [(policy, sample) for policy in drawn for sample in samples]
        rewards = np.array(list(pool.map(learnt, tasks, chunksize=6))).reshape(POLICIES, ROBOTS)
        best = np.argsort(-rewards.mean(axis=1))[:BEST]
        # Less and less is tried anew.
        least = LEAST_SPREAD * (1.0 - generation / GENERATIONS)
        mean, spread = drawn[best].mean(axis=0), drawn[best].std(axis=0) + least
        curve.append(float(rewards[best].mean()))
        print(f"generation {generation + 1:3}: {180.0 * curve[-1]:6.2f} deg nearer to level")
    return mean, curve


def main() -> None:
    """Train, compare, draw."""
    design = sys.argv[1] if len(sys.argv) > 1 else "solo12-ocs"
    picture = Path(sys.argv[2] if len(sys.argv) > 2 else "learning.svg")
    begin(design)
    size = 4 * env.action_space.shape[0]
    with ProcessPoolExecutor(2, initializer=begin, initargs=(design,)) as pool:
        policy, curve = train(pool, size)
        for name, flown in (("wheel law", None), ("policy", policy)):
            flights = list(pool.map(partial(tested, flown), TESTED))
            passes = sum(flight[0] for flight in flights)
            tilts = np.degrees([flight[1] for flight in flights])
            print(
                f"{name}: {passes} of {len(flights)} robots pass; tilt at touchdown "
                f"{np.median(tilts):.2f} deg in the median, {tilts.max():.2f} deg at most"
            )
    # A whole fall makes up for the tilt that it begins with.
    observation, _ = env.reset(options={"sample": TESTED.start})
    initial_tilt = 180.0 * float(np.hypot(*observation[-5:-3]))
    x, y = np.arange(1.0, GENERATIONS + 1.0), 180.0 * np.array(curve)
    chart = Chart(
        name="learning",
        title="Solo12 learns to land level",
        description="Degrees that the best policies of each generation came nearer to level.",
        x=Axis.around("generation", "", x, room=0.02),
        y=Axis.around("nearer to level", "deg", np.append(y, initial_tilt), room=0.1),
        marks=(
            Curve(x, y, Ink.BLUE, f"best {BEST} of {POLICIES}"),
            Rule(initial_tilt, upright=False, label="all of it", ink=Ink.FAINT),
        ),
        height=300.0,
    )
    picture.write_bytes(svg_file(chart))


if __name__ == "__main__":
    main()
