"""`ocs-design export` on Solo12 with its meshes: every file again, in a cold process.

    python benchmarks/export.py [RUNS]

The design is made once, by `size`, and is not measured. The whole process counts, imports too.
Goals: at most 3 s without STEP, and an output folder below 20 MB.
"""

import statistics
import sys
import sysconfig
import tempfile
from pathlib import Path

from paired import run_process

SECONDS = 3.0
MEGABYTES = 20.0
ROBOT = (
    Path(sysconfig.get_paths()["purelib"])
    / "cmeel.prefix/share/example-robot-data/robots/solo_description/robots/solo12.urdf"
)


def main() -> None:
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 5
    program = str(Path(sys.executable).with_name("ocs-design"))
    with tempfile.TemporaryDirectory() as folder:
        design, out = Path(folder) / "design", Path(folder) / "again"
        run_process([program, "size", str(ROBOT), "--no-validate", "-o", str(design)])
        export = [program, "export", str(design), "-o", str(out), "--force"]
        # The first one warms the disk cache.
        runs = [run_process(export) for _ in range(count + 1)][1:]
        print_result([run.seconds for run in runs], max(run.peak_memory for run in runs), out)


def print_result(seconds: list[float], memory: float, folder: Path) -> None:
    """Times, memory, and what was written."""
    paths = [path for path in folder.rglob("*") if path.is_file()]
    size = sum(path.stat().st_size for path in paths) / 1e6
    print("   ".join(f"{each:.2f} s" for each in seconds))
    print(f"median {statistics.median(seconds):.2f} s  (goal: at most {SECONDS:g} s)")
    print(f"{len(paths)} files, {size:.2f} MB  (goal: below {MEGABYTES:g} MB)")
    print(f"peak memory: {memory:.0f} MiB")


if __name__ == "__main__":
    main()
