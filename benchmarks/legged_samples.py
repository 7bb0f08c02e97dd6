"""How often the device of every legged robot of example-robot-data does its work, as it is built.

    python benchmarks/legged_samples.py FOLDER [--samples N] [--page docs/robots.md] [PART ...]
    python benchmarks/legged_samples.py FOLDER --kept      of what is there; nothing is flown

Sizes each robot with no option beyond its file and flies N samples of it; where no motor of the
catalogue will do, with wheels that no motor limits. FOLDER keeps what came of each, so that a
second run goes on where the first was stopped, or adds more samples. What is there by then is
printed as Markdown tables, or put into the blocks of a page.
"""

import argparse
import json
import sys
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from math import degrees
from pathlib import Path
from typing import Any

from legged_robots import LEGGED, ROBOTS, Outcome, run

sys.path.insert(0, str(Path(__file__).parents[1] / "docs"))
from blocks import filled, table

NOTHING_SAID = ("_description", "_simple", "_data")
"""Endings of the names of packages."""


@dataclass(frozen=True)
class Found:
    """What is kept of one robot.

    Attributes:
        name: of the robot. samples: that were asked for.
        document: that `validate --json` printed.
        seconds: that all of it took, cold.
        refusal: why no motor of the catalogue will do; empty if one does.
    """

    name: str
    samples: int
    document: dict[str, Any]
    seconds: float
    refusal: str = ""

    @property
    def designed(self) -> Mapping[str, dict[str, Any]]:
        """The flight with the device as designed, by scenario."""
        flights = self.document["validation"]
        return {flight["scenario"]: flight for flight in flights if flight["ocs"]}

    @property
    def scenarios(self) -> list[dict[str, Any]]:
        """What came of the samples."""
        return self.document["monte_carlo"]["scenarios"]


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("folder", type=Path)
    parser.add_argument("--samples", type=int, default=64)
    parser.add_argument("--page", type=Path)
    parser.add_argument("--kept", action="store_true")
    parser.add_argument("parts", nargs="*")
    arguments = parser.parse_intermixed_args()
    for robot in () if arguments.kept else LEGGED:
        wanted = not arguments.parts or any(part in robot for part in arguments.parts)
        kept = kept_of(arguments.folder, robot)
        if wanted and (kept is None or kept.samples < arguments.samples):
            keep(arguments.folder, robot, arguments.samples)
    found = [kept for robot in LEGGED if (kept := kept_of(arguments.folder, robot))]
    if arguments.page is None:
        print(*(make(found) for make in TABLES.values()), sep="\n")
    else:
        text = arguments.page.read_text()
        arguments.page.write_text(filled(text, {"legged samples": lambda t: TABLES[t](found)}))


def place(folder: Path, robot: str) -> Path:
    """Where the outcome of a robot is kept."""
    return folder / f"{name_of(robot).replace('/', '-')}.json"


def kept_of(folder: Path, robot: str) -> Found | None:
    """None: it has not been flown yet."""
    path = place(folder, robot)
    return Found(**json.loads(path.read_text())) if path.exists() else None


def name_of(robot: str) -> str:
    """Package and file, which tell any two apart."""
    package, _, file = robot.split("/")
    for ending in NOTHING_SAID:
        package = package.removesuffix(ending)
    return file if package in file else f"{package}/{file}"


def keep(folder: Path, robot: str, samples: int) -> None:
    """Size it and fly the samples; what they write stays for a closer look."""
    work = place(folder, robot).with_suffix("")
    work.mkdir(parents=True, exist_ok=True)
    sizing = sized(robot, work / "ocs")
    refusal = ""
    if sizing.document.get("error", {}).get("kind") == "infeasible":
        refusal = sizing.document["error"]["message"]
        sizing = sized(robot, work / "ocs", "--motor", "none")
    assert "error" not in sizing.document, sizing.document
    out = work / str(samples)
    flying = run("validate", str(work / "ocs"), "--samples", str(samples), out=out)
    assert "error" not in flying.document, flying.document
    seconds = sizing.seconds + flying.seconds
    found = Found(name_of(robot), samples, flying.document, seconds, refusal)
    place(folder, robot).write_text(json.dumps(vars(found)))


def sized(robot: str, out: Path, *options: str) -> Outcome:
    """Its device, in place of an earlier one."""
    return run("size", str(ROBOTS / f"{robot}.urdf"), *options, "--no-validate", "--force", out=out)


def rates(found: list[Found]) -> str:
    """A row for each robot: passes of all, and the largest error of attitude at touchdown."""
    names = list(dict.fromkeys(each["scenario"] for robot in found for each in robot.scenarios))
    rows = table(("robot", "samples", *names), (rate_row(robot, names) for robot in found))
    there = {robot.name for robot in found}
    missing = ", ".join(name for name in map(name_of, LEGGED) if name not in there)
    return rows + (f"\nNot flown yet: {missing}.\n" if missing else "")


def rate_row(robot: Found, names: list[str]) -> tuple[str, ...]:
    cells = {scenario["scenario"]: rate(robot, scenario) for scenario in robot.scenarios}
    name = robot.name + (" †" if robot.refusal else "")
    return (name, str(robot.samples), *(cells.get(each, "-") for each in names))


def rate(robot: Found, scenario: dict[str, Any]) -> str:
    """Passes; worst attitude; a star where nothing is said of standing."""
    passed, error = scenario["success"]["passed"], scenario["attitude_error"]
    designed = robot.designed[scenario["scenario"]]
    worst = f", {degrees(error['quantiles'][-1]):.1f}°" if error else ""
    told = f"{passed}{worst}" + (" \\*" if designed["can_stand"] is False else "")
    return told if passed == scenario["success"]["flown"] else f"**{told}**"


def failures(found: list[Found]) -> str:
    """A row for each maneuver of a robot that does not pass every time."""
    header = ("robot", "maneuver", "passes", "what came of the others", "goes with", "as designed")
    return table(header, (row for robot in found for row in failing_rows(robot)))


def failing_rows(robot: Found) -> Iterator[tuple[str, ...]]:
    for scenario in robot.scenarios:
        success = scenario["success"]
        if success["passed"] < success["flown"]:
            share = f"{success['passed']} of {success['flown']}"
            faults = ", ".join(f"{n} {fault}" for fault, n in scenario["faults"].items())
            causes = ", ".join(
                f"`{cause['quantity']}` {cause['correlation']:+.2f}" for cause in scenario["causes"]
            )
            designed = robot.designed[scenario["scenario"]]
            said = "passes" if designed["passed"] else designed["reason"]
            yield robot.name, scenario["scenario"], share, faults, causes or "-", said


def starts(found: list[Found]) -> str:
    """A row for each reason why jumps start at lift-off."""
    robots: dict[tuple[str, str], list[str]] = {}
    for robot in found:
        for name, flight in robot.designed.items():
            if "starts at lift-off" in flight["note"]:
                robots.setdefault((robot.name, reason(flight["note"])), []).append(name)
    rows = ((name, ", ".join(which), why) for (name, why), which in robots.items())
    return table(("robot", "starts at lift-off", "because"), rows)


def reason(note: str) -> str:
    """What comes after the announcement."""
    told = next(part for part in note.split("; ") if "starts at lift-off" in part)
    return told.split(": ", 1)[1]


def refusals(found: list[Found]) -> str:
    """A row for each robot that no motor of the catalogue turns."""
    rows = ((robot.name, robot.refusal.splitlines()[0]) for robot in found if robot.refusal)
    return table(("robot", "told by `size`"), rows)


TABLES: Mapping[str, Callable[[list[Found]], str]] = {
    "rates": rates,
    "failures": failures,
    "starts": starts,
    "refusals": refusals,
}


if __name__ == "__main__":
    main()
