"""`ocs-design size`, with no option beyond the file, on every legged robot of example-robot-data.

    python benchmarks/legged_robots.py [PART_OF_A_NAME ...]

Prints a Markdown table: what came out, what it took, and why the first scenario fails that does.
Goals: below 10 s and 1 GiB for each. `legged_samples.py` flies samples of them.
"""

import argparse
import json
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
    parser = argparse.ArgumentParser()
    parser.add_argument("names", nargs="*")
    arguments = parser.parse_args()
    wanted = [
        name for name in LEGGED if not arguments.names or any(w in name for w in arguments.names)
    ]
    print(
        "| robot | exit | wheels / robot [%] | passed with / without | time [s] | memory [MiB] "
        "| written [MiB] | first reason |"
    )
    print("|---|--:|--:|--:|--:|--:|--:|---|")
    for name in wanted:
        with tempfile.TemporaryDirectory() as folder:
            sized = run("size", str(ROBOTS / f"{name}.urdf"), out=Path(folder) / "out")
        print(row(name, sized), flush=True)


def run(command: str, *arguments: str, out: Path) -> Outcome:
    """A cold process."""
    with tempfile.TemporaryFile() as printed:
        done = run_process([PROGRAM, command, *arguments, "-o", str(out), "--json"], printed)
        printed.seek(0)
        text = printed.read()
    document = json.loads(text) if text else {"error": {"message": "no JSON"}}
    written = sum(f.stat().st_size for f in out.rglob("*") if f.is_file()) / 2.0**20
    return Outcome(done, document, written)


def row(name: str, outcome: Outcome) -> str:
    """Of the table."""
    document = outcome.document
    if "error" in document:
        share, passed, reason = "-", "-", document["error"]["message"]
    else:
        share = f"{100.0 * document['ocs']['mass_total'] / document['robot']['mass']:.1f}"
        passed = f"{count(document, ocs=True)} / {count(document, ocs=False)}"
        reason = first_reason(document)
    cells = (
        Path(name).name,
        str(outcome.run.code),
        share,
        passed,
        f"{outcome.run.seconds:.1f}",
        f"{outcome.run.peak_memory:.0f}",
        f"{outcome.written:.1f}",
        reason.replace("\n", " ").replace("|", "/"),
    )
    return f"| {' | '.join(cells)} |"


def count(document: dict[str, Any], *, ocs: bool) -> int:
    """Scenarios that pass with or without the device."""
    return sum(run["passed"] is True for run in document["validation"] if run["ocs"] is ocs)


def first_reason(document: dict[str, Any]) -> str:
    """Why the first scenario with the device does not pass; empty if all do."""
    failing = [r for r in document["validation"] if r["ocs"] and r["passed"] is not True]
    return f"{failing[0]['scenario']}: {failing[0]['reason']}" if failing else ""


if __name__ == "__main__":
    main()
