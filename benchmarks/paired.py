"""Cold processes, and two timed in turn, A B A B: a machine that slows down slows both."""

import os
import statistics
import subprocess
import sys
import sysconfig
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import IO

PROGRAM = str(Path(sys.executable).with_name("ocs-design"))
ROBOTS = Path(sysconfig.get_paths()["purelib"]) / "cmeel.prefix/share/example-robot-data/robots"
SOLO12 = Path(__file__).resolve().parents[1] / "examples" / "solo12.urdf"


@dataclass(frozen=True)
class Run:
    """One process: exit code, wall time [s] and largest resident memory [MiB]."""

    code: int
    seconds: float
    peak_memory: float


def run_process(command: Sequence[str], stdout: IO[bytes] | None = None) -> Run:
    """Run to the end; its children count towards the memory.

    Args:
        command: that must end well, unless somebody reads what it prints.
        stdout: where that goes; None: it is thrown away.
    """
    # As pip installs them, packages have their byte code beside them.
    environment = {k: v for k, v in os.environ.items() if k != "PYTHONDONTWRITEBYTECODE"}
    start = time.perf_counter()
    process = subprocess.Popen(
        command, env=environment, stdout=stdout or subprocess.DEVNULL, stderr=subprocess.DEVNULL
    )
    _, status, usage = os.wait4(process.pid, 0)
    seconds = time.perf_counter() - start
    # wait4 took the status that Popen would wait for.
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode and stdout is None:
        raise SystemExit(f"exit {process.returncode}: {' '.join(command)}")
    return Run(process.returncode, seconds, usage.ru_maxrss / 1024.0)


def alternate(
    first: Callable[[], Run], second: Callable[[], Run], pairs: int
) -> list[tuple[Run, Run]]:
    """Pairs of runs; one of each, not counted, warms the disk cache."""
    first(), second()
    return [(first(), second()) for _ in range(pairs)]


def print_pairs(pairs: Sequence[tuple[Run, Run]], names: tuple[str, str], limit: float) -> None:
    """One line a pair, then the medians; the ratio is the median of the pairs' ratios."""
    widths = [max(len(name), 12) for name in names]
    print(f"{'pair':>6}  {names[0]:>{widths[0]}}  {names[1]:>{widths[1]}}  {'ratio':>6}")
    for index, (a, b) in enumerate(pairs, start=1):
        print(_line(str(index), a.seconds, b.seconds, a.seconds / b.seconds, widths))
    seconds = [statistics.median(pair[side].seconds for pair in pairs) for side in (0, 1)]
    ratio = statistics.median(a.seconds / b.seconds for a, b in pairs)
    print(_line("median", *seconds, ratio, widths) + f"  (goal: at most {limit:g})")
    print(f"peak memory of {names[0]}: {max(a.peak_memory for a, _ in pairs):.0f} MiB")


def _line(label: str, a: float, b: float, ratio: float, widths: Sequence[int]) -> str:
    return f"{label:>6}  {a:>{widths[0] - 2}.3f} s  {b:>{widths[1] - 2}.3f} s  {ratio:>6.3f}"
