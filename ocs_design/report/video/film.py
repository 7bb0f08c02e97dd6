"""Each maneuver as a film: with the device and without it, side by side, in real time."""

from collections.abc import Sequence
from importlib.util import find_spec
from pathlib import Path

import numpy as np

from ocs_design.common.errors import MissingToolError, extra_command
from ocs_design.common.files import safe_name
from ocs_design.common.units import rpm
from ocs_design.common.wording import degrees
from ocs_design.device.device import Device
from ocs_design.export.film import Frames, Take, film_model, render_takes
from ocs_design.export.programs import FFMPEG_HINT
from ocs_design.report.flights import off_level
from ocs_design.requirement.maneuver import Maneuver
from ocs_design.robot.robot import Robot
from ocs_design.simulation.run import Run

EXTRA = extra_command("video")

STRIDE = 2
"""Poses from one frame to the next: 33 frames a second of 67 poses."""


def film_or_tell(
    robot: Robot, device: Device, maneuvers: Sequence[Maneuver], runs: Sequence[Run], folder: Path
) -> tuple[str, ...]:
    """Write the films of `film_flights` where they can be made, never failing; gives remarks."""
    if find_spec("PIL") is None:
        return (f"no video, because Pillow is not installed; {EXTRA}",)
    try:
        films = film_flights(robot, device, maneuvers, runs, folder)
    except MissingToolError as error:
        return (f"{error}; {error.hint}" if error.hint else str(error),)
    if any(film.suffix == ".gif" for film in films):
        return (f"the video is a GIF, because there is no ffmpeg that makes H.264; {FFMPEG_HINT}",)
    return ()


def film_flights(
    robot: Robot, device: Device, maneuvers: Sequence[Maneuver], runs: Sequence[Run], folder: Path
) -> tuple[Path, ...]:
    """A film of each maneuver, `<name>.mp4` or `.gif`, of runs with their poses.

    Raises:
        MissingToolError: OpenGL does not work here.
    """
    # Pillow is an extra.
    from ocs_design.report.video import pictures  # noqa: PLC0415

    films = []
    for maneuver in maneuvers:
        pair = [run for run in runs if run.scenario == maneuver.name and run.poses is not None]
        if not pair:
            continue
        flown = device.as_flown(maneuver)
        poses = [run.poses for run in pair if run.poses is not None]
        takes = [
            Take(film_model(robot, flown, ocs=run.ocs), pose.qpos[::STRIDE])
            for run, pose in zip(pair, poses, strict=True)
        ]
        sides = []
        for run, pose, frames in zip(pair, poses, render_takes(takes), strict=True):
            title, side = f"{run.scenario}, {'with' if run.ocs else 'without'} the device", []
            series = run.series
            for frame, time in zip(frames, pose.time[::STRIDE], strict=True):
                at = min(int(np.searchsorted(series.time, time - 1e-9)), len(series.time) - 1)
                tilt = float(off_level(series.roll[at], series.pitch[at]))
                lines = [f"{time:.2f} s   tilt {degrees(tilt, 0)}"]
                if run.ocs:
                    speeds = (rpm(float(speed)) for speed in series.wheel_speed[at])
                    lines.append(f"wheels {', '.join(speeds)}")
                side.append(pictures.captioned(frame, title, run.passed, lines))
            sides.append(side)
        # Who is done first stands still until the other is.
        longest = max(map(len, sides))
        film: list[Frames] = [
            np.concatenate([side[min(k, len(side) - 1)] for side in sides], axis=1)
            for k in range(longest)
        ]
        seconds = STRIDE * float(poses[0].time[1] - poses[0].time[0])
        films.append(pictures.encode(film, seconds, folder / safe_name(maneuver.name)))
    return tuple(films)
