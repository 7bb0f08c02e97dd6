"""`ocs-design export` on Solo12 with its meshes: every file again, in a cold process.

    python benchmarks/export.py [RUNS]

The design is made once, by `size`, and is not measured. The whole process counts, imports too.
Goals: at most 3 s without STEP, and an output folder below 20 MB.
"""

import statistics
import sys
import tempfile
from pathlib import Path

from paired import PROGRAM, ROBOTS, run_process

SECONDS = 3.0
MEGABYTES = 20.0


def main() -> None:
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 5
    robot = ROBOTS / "solo_description/robots/solo12.urdf"
    with tempfile.TemporaryDirectory() as folder:
        design, out = Path(folder) / "design", Path(folder) / "again"
        run_process([PROGRAM, "size", str(robot), "--no-validate", "-o", str(design)])
        export = [PROGRAM, "export", str(design), "-o", str(out), "--force"]
        # The first one warms the disk cache.
        runs = [run_process(export) for _ in range(count + 1)][1:]
        sizes = [path.stat().st_size for path in out.rglob("*") if path.is_file()]
    seconds = [run.seconds for run in runs]
    print("   ".join(f"{duration:.2f} s" for duration in seconds))
    print(f"median {statistics.median(seconds):.2f} s  (goal: at most {SECONDS:g} s)")
    print(f"{len(sizes)} files, {sum(sizes) / 1e6:.2f} MB  (goal: below {MEGABYTES:g} MB)")
    print(f"peak memory: {max(run.peak_memory for run in runs):.0f} MiB")


if __name__ == "__main__":
    main()
