"""`ocs-design size` on Solo12, a cold process that writes everything, against `bare.py`.

    python benchmarks/size.py [PAIRS]

Both take the same number of Runge-Kutta steps: those of the simulated runs, read from the time
series that `size` wrote. Runs that leave no time series count for `size` only.
Goals: at most 1.2 times the bare script, and a peak memory below 1 GiB.
"""

import csv
import sys
import tempfile
from pathlib import Path

from bare import TIME_STEP
from paired import alternate, print_pairs, run_process

LIMIT = 1.2
HERE = Path(__file__).resolve().parent
ROBOT = HERE.parent / "examples" / "solo12.urdf"


def main() -> None:
    pairs = int(sys.argv[1]) if len(sys.argv) > 1 else 7
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / "solo12-ocs"
        size = size_command(out)
        run_process(size)
        steps = simulated_steps(out)
        bare = bare_command(out, steps)
        print(f"{steps} steps of {TIME_STEP * 1e3:g} ms")
        measured = alternate(lambda: run_process(size), lambda: run_process(bare), pairs)
        print_pairs(measured, ("ocs-design size", "bare script"), LIMIT)


def size_command(out: Path) -> list[str]:
    """The command that is measured; the folder is replaced each time."""
    program = str(Path(sys.executable).with_name("ocs-design"))
    return [program, "size", str(ROBOT), "-o", str(out), "--force"]


def bare_command(out: Path, steps: int) -> list[str]:
    """The bare script on a copy of the exported robot, which `--force` will replace."""
    kept = out.with_name("model")
    (out / "robot").rename(kept)
    model = next(kept.glob("*_ocs.xml"))
    return [sys.executable, str(HERE / "bare.py"), str(model), str(steps)]


def simulated_steps(out: Path) -> int:
    """Over all runs with a time series."""
    return sum(round(duration(path) / TIME_STEP) for path in out.glob("validation/*.csv"))


def duration(path: Path) -> float:
    """Last time in a time series [s]; it starts at zero."""
    with path.open(newline="") as file:
        return max(float(row["time_s"]) for row in csv.DictReader(file))


if __name__ == "__main__":
    main()
