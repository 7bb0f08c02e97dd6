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


def flown(specification: Specification) -> tuple[float, SurvivalRecord]:
    """Mass of the device that `size` makes [kg], and its flights with each drive stopped.

    Raises:
        Infeasible: there is none.
    """
    stops = replace(
        specification, requirement=replace(specification.requirement, survives="any one motor")
    )
    with TemporaryDirectory() as folder:
        result = design_ocs(specification, out=f"{folder}/made")
        survival = validate_design(result, specification=stops).record.survival
    assert survival is not None, "its drives stop"
    return result.design.ocs.mass_total, survival


def landings_text(survival: SurvivalRecord) -> Iterator[str]:
    """Landings within the allowance of each maneuver, and the angle at the worst."""
    for name in dict.fromkeys(flight.scenario for flight in survival.flights):
        flights = [flight for flight in survival.flights if flight.scenario == name]
        worst = max(np.inf if flight.tilt is None else flight.tilt for flight in flights)
        lands = sum(flight.lands is True for flight in flights)
        yield f"{lands} of {len(flights)}, {np.degrees(worst):.1f}°"


def survival_table(robot: str) -> str:
    """A row for each layout, and one more where it can be sized to survive."""
    rows: list[tuple[str, ...]] = []
    scenarios: tuple[str, ...] = ()
    for layout in SHOWN:
        before = None
        for survives in ("none", "any one motor"):
            base = specification_of(robot)
            specification = replace(
                base,
                ocs=replace(base.ocs, layout=layout),
                requirement=replace(base.requirement, survives=survives),
                validation=replace(base.validation, ballistic=True),
            )
            try:
                mass, survival = flown(specification)
            except Infeasible as error:
                print(f"{layout}, {survives}: {error.message}", file=sys.stderr)
                continue
            scenarios = tuple(dict.fromkeys(flight.scenario for flight in survival.flights))
            more = "" if before is None else f" (+{1e3 * (mass - before):.0f} g)"
            before = mass
            rows.append(
                (f"`{layout}`", survives, f"{1e3 * mass:.0f} g{more}", *landings_text(survival))
            )
            print(rows[-1], file=sys.stderr, flush=True)
    return "\n" + table(("layout", "`survives`", "mass", *scenarios), rows) + "\n"


def layout_row(answer: LayoutAnswer) -> tuple[str, ...]:
    """The row of a layout that has a device."""
    assert answer.mass is not None, "it has a device"
    return (
        f"`{answer.layout}`",
        f"{1e3 * answer.mass:.0f} g",
        *(f"{value:.3g}" for value in (*answer.momentum, *answer.momentum_without_one)),
        ", ".join(answer.survives) or "-",
        answer.motor,
        "no" if answer.open else "yes",
    )


HEADER = (
    *("layout", "mass", "roll [N m s]", "pitch", "yaw", "one lost: roll", "pitch", "yaw"),
    *("feasible with one lost", "motor", "stands on the trunk"),
)


def layouts_table(robot: str) -> str:
    """A row for each layout that has a device, and why the others have none; nothing is flown."""
    answers = compare_layouts(
        robot, progress=lambda label, _: print(label, file=sys.stderr, flush=True)
    ).layouts
    rows = table(HEADER, [layout_row(answer) for answer in answers if answer.mass is not None])
    none = [f"- `{answer.layout}`: {answer.without}\n" for answer in answers if answer.mass is None]
    return "\n".join(["", rows, *([f"No device:\n\n{''.join(none)}"] if none else []), ""])


if __name__ == "__main__":
    files = [each for each in sys.argv[1:] if each != "--fly"]
    kind, make = ("survival", survival_table) if "--fly" in sys.argv else ("layouts", layouts_table)
    for file in files:
        own, begin = make(file), f"<!-- begin {kind}: {Path(file).stem} -->\n"
        before, found, after = PAGE.read_text().partition(begin)
        assert found, f"{PAGE} has no block for {file}"
        PAGE.write_text(before + begin + own + after[after.index("<!-- end -->") :])
