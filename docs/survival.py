"""Tables of what each layout weighs and takes, and of what it survives when a drive stops.

    python docs/survival.py FILE...            sizes a robot, or a specification, with all layouts
    python docs/survival.py --fly FILE...      flies it with drives stopped, some minutes a robot

They fill in the file's block of layouts.md. Flights start at lift-off.
"""

import sys
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from blocks import table

from ocs_design.common.errors import Infeasible
from ocs_design.device.answers import LayoutAnswer
from ocs_design.device.records.flights import SurvivalRecord
from ocs_design.requirement.reading import specification_of
from ocs_design.requirement.specification import Specification
from ocs_design.workflows.layouts import compare_layouts
from ocs_design.workflows.size import design_ocs
from ocs_design.workflows.validate import validate_design

SHOWN = ("pair", "double-pair", "triad", "orthogonal", "pyramid")

PAGE = Path(__file__).with_name("layouts.md")


def flown(asked: Specification) -> tuple[float, SurvivalRecord]:
    """Mass of the device that `size` makes [kg], and its flights with each drive stopped.

    Raises:
        Infeasible: there is none.
    """
    stops = replace(asked, requirement=replace(asked.requirement, survives="any one motor"))
    with TemporaryDirectory() as folder:
        made = design_ocs(asked, out=f"{folder}/made")
        found = validate_design(made, specification=stops).record.survival
    assert found is not None, "its drives stop"
    return made.design.ocs.mass_total, found


def told(survival: SurvivalRecord) -> Iterator[str]:
    """Landings within the allowance of each maneuver, and the angle at the worst."""
    for name in dict.fromkeys(each.scenario for each in survival.flights):
        flights = [each for each in survival.flights if each.scenario == name]
        worst = max(np.inf if each.tilt is None else each.tilt for each in flights)
        lands = sum(each.lands is True for each in flights)
        yield f"{lands} of {len(flights)}, {np.degrees(worst):.1f}°"


def survival_table(robot: str) -> str:
    """A row for each layout, and one more where it can be sized to survive."""
    rows: list[tuple[str, ...]] = []
    scenarios: tuple[str, ...] = ()
    for layout in SHOWN:
        before = None
        for survives in ("none", "any one motor"):
            base = specification_of(robot)
            asked = replace(
                base,
                ocs=replace(base.ocs, layout=layout),
                requirement=replace(base.requirement, survives=survives),
                validation=replace(base.validation, ballistic=True),
            )
            try:
                mass, survival = flown(asked)
            except Infeasible as error:
                print(f"{layout}, {survives}: {error.message}", file=sys.stderr)
                continue
            scenarios = tuple(dict.fromkeys(each.scenario for each in survival.flights))
            more = "" if before is None else f" (+{1e3 * (mass - before):.0f} g)"
            before = mass
            rows.append((f"`{layout}`", survives, f"{1e3 * mass:.0f} g{more}", *told(survival)))
            print(rows[-1], file=sys.stderr, flush=True)
    return "\n" + table(("layout", "`survives`", "mass", *scenarios), rows) + "\n"


def weighed(each: LayoutAnswer) -> tuple[str, ...]:
    """The row of a layout that has a device."""
    assert each.mass is not None, "it has a device"
    return (
        f"`{each.layout}`",
        f"{1e3 * each.mass:.0f} g",
        *(f"{value:.3g}" for value in (*each.momentum, *each.momentum_without_one)),
        ", ".join(each.survives) or "-",
        each.motor,
        "no" if each.open else "yes",
    )


HEADER = (
    *("layout", "mass", "roll [N m s]", "pitch", "yaw", "one lost: roll", "pitch", "yaw"),
    *("feasible with one lost", "motor", "stands on the trunk"),
)


def layouts_table(robot: str) -> str:
    """A row for each layout that has a device, and why the others have none; nothing is flown."""
    found = compare_layouts(
        robot, progress=lambda label, _: print(label, file=sys.stderr, flush=True)
    ).layouts
    rows = table(HEADER, [weighed(each) for each in found if each.mass is not None])
    none = [f"- `{each.layout}`: {each.without}\n" for each in found if each.mass is None]
    return "\n".join(["", rows, *([f"No device:\n\n{''.join(none)}"] if none else []), ""])


if __name__ == "__main__":
    files = [each for each in sys.argv[1:] if each != "--fly"]
    kind, make = ("survival", survival_table) if "--fly" in sys.argv else ("layouts", layouts_table)
    for file in files:
        own, begin = make(file), f"<!-- begin {kind}: {Path(file).stem} -->\n"
        before, found, after = PAGE.read_text().partition(begin)
        assert found, f"{PAGE} has no block for {file}"
        PAGE.write_text(before + begin + own + after[after.index("<!-- end -->") :])
