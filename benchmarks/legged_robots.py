"""`ocs-design size`, with no option beyond the file, on every legged robot of example-robot-data.

    python benchmarks/legged_robots.py [PART_OF_A_NAME ...]

Prints a Markdown table of what it took. Goals: below 10 s and 1 GiB for each. `legged_samples.py`
has what comes out, and flies samples of them.
"""

import json
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from paired import PROGRAM, ROBOTS, Run, run_process

LEGGED = (
    "a1_description/urdf/a1",
    "alex_description/urdf/alex_nub_hands",
    "alex_description/urdf/alex_psyonic_hands",
    "alex_description/urdf/alex_sake_hands",
    "alexander_description/urdf/alexander_v1.lowerBodyOnly",
    "anymal_b_simple_description/robots/anymal",
    "anymal_b_simple_description/robots/anymal-kinova",
    "anymal_c_simple_description/urdf/anymal",
    "b1_description/urdf/b1",
    "b1_description/urdf/b1-z1",
    "bolt_description/robots/bolt",
    "centauro_description/urdf/centauro",
    "g1_description/urdf/g1_29dof_rev_1_0",
    "g1_description/urdf/g1_29dof_with_hand_rev_1_0",
    "go1_description/urdf/go1",
    "go2_description/urdf/go2",
    "human_description/robots/human",
    "hyq_description/robots/hyq_no_sensors",
    "icub_description/robots/icub",
    "icub_description/robots/icub_reduced",
    "laikago_description/urdf/laikago",
    "quadruped_description/urdf/quadruped",
    "romeo_description/urdf/romeo",
    "romeo_description/urdf/romeo_laas_small",
    "romeo_description/urdf/romeo_small",
    "simple_humanoid_description/urdf/simple_humanoid",
    "simple_humanoid_description/urdf/simple_humanoid_classical",
    "solo_description/robots/solo",
    "solo_description/robots/solo12",
    "talos_data/robots/talos_full_v2",
    "talos_data/robots/talos_full_v2_box",
    "talos_data/robots/talos_reduced",
    "talos_data/robots/talos_reduced_box",
    "talos_data/robots/talos_reduced_corrected",
)


@dataclass(frozen=True)
class Outcome:
    """One process, its JSON document, and what it wrote [MiB]."""

    run: Run
    document: dict[str, Any]
    written: float


def main() -> None:
    print("| robot | exit | time [s] | memory [MiB] | written [MiB] |\n|---|--:|--:|--:|--:|")
    for name in LEGGED:
        if len(sys.argv) > 1 and not any(part in name for part in sys.argv[1:]):
            continue
        with tempfile.TemporaryDirectory() as folder:
            sized = run("size", str(ROBOTS / f"{name}.urdf"), out=Path(folder) / "out")
        took, peak = f"{sized.run.seconds:.1f}", f"{sized.run.peak_memory:.0f}"
        print(
            f"| {Path(name).name} | {sized.run.code} | {took} | {peak} | {sized.written:.1f} |",
            flush=True,
        )


def run(command: str, *arguments: str, out: Path) -> Outcome:
    """A cold process."""
    with tempfile.TemporaryFile() as printed:
        done = run_process([PROGRAM, command, *arguments, "-o", str(out), "--json"], printed)
        printed.seek(0)
        text = printed.read()
    document = json.loads(text) if text else {"error": {"message": "no JSON"}}
    written = sum(f.stat().st_size for f in out.rglob("*") if f.is_file()) / 2.0**20
    return Outcome(done, document, written)


if __name__ == "__main__":
    main()
