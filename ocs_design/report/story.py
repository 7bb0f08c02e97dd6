"""What a report is made of: the design, its flights and its looks."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import msgspec

from ocs_design.answers import PostureLine
from ocs_design.design_file import OcsDesign
from ocs_design.exceptions import OcsError
from ocs_design.monte_carlo.storage import RESULT_FILE
from ocs_design.monte_carlo.summary import MonteCarloRecord
from ocs_design.report.flight import Flight, first_file, recorded_flight
from ocs_design.report.viewer.bodies import ShownBody, read_bodies
from ocs_design.text_files import safe_name


@dataclass(frozen=True, eq=False)
class Story:
    """Everything that a report tells.

    Attributes:
        design: the artefact.
        flights: in the order of its validation.
        bodies: of the robot with its device; empty where there is no picture of them.
        postures: alpha* in other postures; empty where the robot was not read.
        monte_carlo: many flights, where some were flown.
        command: that made the report; empty: none, a program did.
    """

    design: OcsDesign
    flights: tuple[Flight, ...]
    bodies: tuple[ShownBody, ...]
    postures: tuple[PostureLine, ...] = ()
    monte_carlo: MonteCarloRecord | None = None
    command: str = ""


def story_in(
    folders: Sequence[Path],
    design: OcsDesign,
    *,
    flights: Sequence[Flight] = (),
    postures: tuple[PostureLine, ...] = (),
    command: str = "",
) -> Story:
    """From output folders: their CSV files where no flights are given, and their GLB.

    Args:
        folders: that were written or are being written; the first that has a file is asked for it.
        design: that they are of.
        flights: as they were simulated.
        postures, command: see `Story`.
    """
    recorded = flights or [
        flight
        for record in design.validation
        if (flight := recorded_flight(folders, record)) is not None
    ]
    picture = first_file(folders, f"robot/{safe_name(design.robot.name)}_ocs.glb")
    bodies = () if picture is None else read_bodies(picture.read_bytes())
    return Story(design, tuple(recorded), bodies, postures, read_campaign(folders), command=command)


def read_campaign(folders: Sequence[Path]) -> MonteCarloRecord | None:
    """What `validate --samples` wrote into one of these folders, or below one.

    Raises:
        OcsError: it is there and cannot be read.
    """
    places = (path for folder in folders for path in sorted(folder.glob(f"**/{RESULT_FILE}")))
    path = next(places, None)
    if path is None:
        return None
    try:
        return msgspec.json.decode(path.read_bytes(), type=MonteCarloRecord)
    except (msgspec.DecodeError, UnicodeDecodeError, RecursionError) as error:
        raise OcsError(f"{path}: {error}", hint="fly the samples again") from error
