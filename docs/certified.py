"""Certificates that the docs quote: flown by this script, kept in `certified.json`.

    python docs/certified.py [--seed N] examples/solo12.urdf ...    sizes and flies each: minutes
    python docs/generate.py --quick                                 fills in the pages

A slow test flies Solo12's again: on another machine single samples may end otherwise, so it asks
for the same verdict and for intervals that overlap.
"""

import argparse
import ast
import hashlib
import json
import subprocess
import sys
import tempfile
from math import degrees, exp, inf, log
from pathlib import Path
from typing import Any

import numpy as np
from blocks import table

from ocs_design.common.units import floored
from ocs_design.device.records.flights import Conclusion
from ocs_design.monte_carlo.certificate import ERROR, SequentialTest

ROOT = Path(__file__).resolve().parents[1]
PACKAGE = ROOT / "ocs_design"
KEPT = Path(__file__).with_name("certified.json")


FLIGHTS = (
    *("common/frames.py", "common/quaternions.py", "device/*.py", "export/physics.py"),
    *("jumping/*.py", "monte_carlo/*.py"),
    "robot/*.py",
    *("requirement/boundary.py", "requirement/maneuver.py", "requirement/pivoted.py"),
    *("requirement/pushes.py", "requirement/turns.py"),
    *("requirement/froude.py", "requirement/uncertainty.py", "requirement/reality.toml"),
    *("simulation/*.py", "sizing/trajectory/*.py"),
)
"""Files of the package that the flights of a device follow from."""


def sources(files: tuple[str, ...] = FLIGHTS) -> str:
    """Digest of these files of the package, comments and docstrings left out."""
    digest = hashlib.sha256()
    for path in sorted(path for pattern in files for path in PACKAGE.glob(pattern)):
        text = path.read_text()
        if path.suffix == ".py":
            text = ast.unparse(_Bare().visit(ast.parse(text)))
        digest.update(text.encode())
    return digest.hexdigest()[:12]


class _Bare(ast.NodeTransformer):
    """Takes strings that nothing is done with out of a program."""

    def visit_Expr(self, node: ast.Expr) -> ast.AST:
        """Docstrings, of attributes too."""
        value = node.value
        return ast.Pass() if isinstance(value, ast.Constant) else self.generic_visit(node)


def flown(robot: Path, seed: int = 0) -> dict[str, Any]:
    """Certificate of the device of a robot that is sized without options."""
    with tempfile.TemporaryDirectory() as folder:
        options = ("--certify", "--seed", str(seed), "-q", "-o", f"{folder}/ocs")
        command = [sys.executable, "-m", "ocs_design", "size", str(robot), *options]
        subprocess.run(command, check=False)
        return certificate_of(Path(folder) / "ocs")


def certificate_of(folder: Path) -> dict[str, Any]:
    """What a folder of `size --certify` says of reliability, and how far off level robots land."""
    design = json.loads((folder / "design.json").read_text())
    record = json.loads((folder / "certificate" / "monte_carlo.json").read_text())
    off_level = {
        scenario["scenario"]: round(degrees(scenario["attitude_error"]["quantiles"][-1]), 2)
        for scenario in record["scenarios"]
    }
    return {
        "sources": sources(),
        "mass": round(design["ocs"]["mass_total"], 4),
        "off_level": off_level,
        **design["reliability"],
    }


def kept() -> dict[str, dict[str, Any]]:
    """Certificates by the robot's name."""
    by_name: dict[str, dict[str, Any]] = json.loads(KEPT.read_text())
    return by_name


def sentence(name: str) -> str:
    """What is sure of one robot, for the README."""
    certificate = kept()[name]
    low, asked = floored(100.0 * certificate["whole_interval"][0], 1), 100.0 * certificate["asked"]
    return (
        f"With all of them (`size --certify`, seed {certificate['seed']}), {certificate['whole']} "
        f"of {certificate['samples']}\nsampled {name} complete all maneuvers: at least {low} "
        "of 100, with 95 % confidence. The test for\n"
        f"{asked:.4g} of 100 says: {certificate['verdict']} "
        f"([Monte Carlo](docs/monte_carlo.md), [all robots](docs/robots.md)).\n"
    )


def certificates(_: str) -> str:
    """Table of all robots; a star for those flown with earlier sources than today's."""
    rows, today = [], sources()
    for name, certificate in kept().items():
        low = floored(100.0 * certificate["whole_interval"][0], 1)
        worst = ", ".join(f"{key} {angle:.1f}°" for key, angle in certificate["off_level"].items())
        rows.append(
            (
                name + ("" if certificate.get("sources") == today else " \\*"),
                f"{1e3 * certificate['mass']:.0f} g",
                certificate["verdict"],
                f"{certificate['whole']} of {certificate['samples']}",
                f"{low} %",
                str(certificate["round"]),
                worst,
            )
        )
    heads = ("robot", "device", "verdict for 99 %", "complete all", "at least", "round")
    return table((*heads, "largest tilt at touchdown"), rows)


def endings(test: SequentialTest) -> list[tuple[int, int, Conclusion, float]]:
    """All ends of a test: passed, flown, finding, and the logarithm of the ways that lead there.

    Dynamic programming over the number of failures: exact, nothing is drawn.
    """
    gain = log(test.required / test.worse)
    loss = log((1.0 - test.required) / (1.0 - test.worse))
    ends, ways = [], {0: 0.0}
    for count in range(1, test.most_flights + 1):
        grown: dict[int, float] = {}
        for failed, before in ways.items():
            for now in (failed, failed + 1):
                grown[now] = float(np.logaddexp(grown.get(now, -inf), before))
        ways = {}
        for failed, paths in grown.items():
            evidence = (count - failed) * gain + failed * loss
            if abs(evidence) >= log(1.0 / ERROR):
                finding = Conclusion.CERTIFIED if evidence > 0.0 else Conclusion.SHORT
                ends.append((count - failed, count, finding, paths))
            elif count == test.most_flights:
                ends.append((count - failed, count, Conclusion.UNDECIDED, paths))
            else:
                ways[failed] = paths
    return ends


def operating(
    ends: list[tuple[int, int, Conclusion, float]], reliability: float
) -> tuple[dict[Conclusion, float], float]:
    """Probability of each finding for a device of this reliability, and the mean of flights."""
    chances, mean = dict.fromkeys(Conclusion, 0.0), 0.0
    for passed, count, finding, paths in ends:
        odds = passed * log(reliability) + (count - passed) * log(1.0 - reliability)
        chance = exp(paths + odds)
        chances[finding] += chance
        mean += chance * count
    return chances, mean


def characteristic(asked: str) -> str:
    """Table of what the test finds, by the reliability that a device really has."""
    test = SequentialTest(float(asked))
    ends = endings(test)
    rows = []
    for share in (0.1, 0.5, 1.0, 2.0, 3.0, 5.0):
        reliability = 1.0 - share * (1.0 - test.required)
        chances, mean = operating(ends, reliability)
        rows.append(
            (
                f"{100.0 * reliability:.4g} %",
                *(f"{100.0 * chances[each]:.1f} %" for each in Conclusion),
                f"{mean:.0f}",
            )
        )
    return table(("works in truth", *map(str, Conclusion), "flights on average"), rows)


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    parser.add_argument("robots", type=Path, nargs="+")
    parser.add_argument("--seed", type=int, default=0)
    arguments = parser.parse_args()
    for path in arguments.robots:
        found = flown(path, arguments.seed)
        known = kept() if KEPT.exists() else {}
        KEPT.write_text(json.dumps({**known, path.stem: found}, indent=1) + "\n")
