"""Predicted against flown reliability of random specifications, from unseen seeds.

    python benchmarks/reliability.py FOLDER [ROBOT] [COUNT] [SAMPLES]

Each specification has deviations of `[reality]` of its own, 1.5 to 3.5 times the defaults (with
those next to nothing fails), and one of three reliabilities. Told is how often the exact interval
of the flights holds what the closed forms predict, and how often it is not below. ROBOT is
`examples/solo12.urdf`, COUNT 20 and SAMPLES 256 unless stated; a folder's flights are kept.
"""

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
from paired import SOLO12

LEVELS = (0.8, 0.95, 0.99)
SEED = 30_000


def specification(index: int) -> str:
    """`[reality]` and the reliability of one specification."""
    factor = np.random.default_rng([SEED, index]).uniform(1.5, 3.5, 5)
    voltage = 7.5 * factor[4]
    return f"""[requirement]
reliability = {LEVELS[index % len(LEVELS)]}
[reality]
mass_error = "normal(0, {2.0 * factor[0]:.2f}%)"
inertia_error = "normal(0, {5.0 * factor[1]:.2f}%)"
torque_constant_error = "normal(0, {3.0 * factor[2]:.2f}%)"
attitude_bias = "normal(0, {0.4 * factor[3]:.3f}deg)"
bus_voltage_error = "uniform({2.5 - voltage:.2f}%, {2.5 + voltage:.2f}%)"
"""


def run(*words: str | Path) -> None:
    """One command of ocs-design; a maneuver that fails is no error here."""
    done = subprocess.run(
        [sys.executable, "-m", "ocs_design", *map(str, words)], capture_output=True, check=False
    )
    if done.returncode > 1:
        raise RuntimeError(done.stderr.decode())


def main(folder: Path, robot: Path = SOLO12, count: int = 20, samples: int = 256) -> None:
    """Size, fly and compare; one line each."""
    inside = safe = 0
    for index in range(count):
        run_folder = folder / f"{index:02d}"
        run_folder.mkdir(parents=True, exist_ok=True)
        (run_folder / "spec.toml").write_text(specification(index))
        design, flown = run_folder / "design", run_folder / "flown"
        if not design.exists():
            run("size", robot, "--spec", run_folder / "spec.toml", "--no-validate", "-o", design)
        run("validate", design, "--samples", str(samples), "--seed", str(SEED + index), "-o", flown)
        kept = json.loads((design / "design.json").read_text())["selection"]["kept"]
        success = json.loads((flown / "monte_carlo.json").read_text())["success"]
        low, high, predicted = success["low"], success["high"], kept["predicted"]
        inside += low <= predicted <= high
        safe += predicted <= high
        print(
            f"{index:02d}: asked {kept['reliability']:.2f}, predicted {predicted:.3f}, flown "
            f"{success['estimate']:.3f} ({low:.3f} .. {high:.3f})",
            flush=True,
        )
    print(f"inside the interval: {inside} of {count}; not below what is predicted: {safe}")


if __name__ == "__main__":
    folder, *rest = sys.argv[1:]
    robot = Path(rest[0]) if rest else SOLO12
    main(Path(folder), robot, *map(int, rest[1:]))
