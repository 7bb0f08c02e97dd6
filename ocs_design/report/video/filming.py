"""Films where they can be made, and what to install where they cannot: never a reason to fail."""

from collections.abc import Sequence
from importlib.util import find_spec
from pathlib import Path

from ocs_design.design import Device
from ocs_design.exceptions import MissingToolError
from ocs_design.export.ffmpeg import FFMPEG_HINT
from ocs_design.requirement.maneuver import Maneuver
from ocs_design.robot.robot import Robot
from ocs_design.simulation.scenario import Run

EXTRA = "pip install 'ocs-design[video]'"


def film_or_tell(
    robot: Robot, device: Device, maneuvers: Sequence[Maneuver], runs: Sequence[Run], folder: Path
) -> tuple[str, ...]:
    """Write the films of `film_flights`; what is to be told of them, one sentence each.

    Args:
        robot, device, maneuvers, runs, folder: see there.
    """
    if find_spec("PIL") is None:
        return (f"no video, because Pillow is not installed; {EXTRA}",)
    # Pillow is an extra.
    from ocs_design.report.video.flights import film_flights  # noqa: PLC0415

    try:
        films = film_flights(robot, device, maneuvers, runs, folder)
    except MissingToolError as error:
        return (f"{error}; {error.hint}" if error.hint else str(error),)
    if any(film.suffix == ".gif" for film in films):
        return (f"the video is a GIF, because there is no ffmpeg that makes H.264; {FFMPEG_HINT}",)
    return ()
