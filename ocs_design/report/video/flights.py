"""Each maneuver as a film: with the device and without it, side by side, in real time."""

from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np

from ocs_design.design import Device
from ocs_design.export.film import Frames, Take, film_model, render_takes
from ocs_design.report.quantities import degrees, rpm
from ocs_design.report.video.captions import Caption, captioned
from ocs_design.report.video.encoding import encode
from ocs_design.requirement.maneuver import Maneuver
from ocs_design.robot.robot import Robot
from ocs_design.simulation.poses import Poses
from ocs_design.simulation.scenario import Run
from ocs_design.text_files import safe_name

STRIDE = 2
"""Poses from one frame to the next: 33 frames a second of 67 poses."""


def film_flights(
    robot: Robot, device: Device, maneuvers: Sequence[Maneuver], runs: Sequence[Run], folder: Path
) -> tuple[Path, ...]:
    """A film of each maneuver, `<name>.mp4` or `.gif`.

    Args:
        robot, device: that flew.
        maneuvers: that were flown.
        runs: with their poses.
        folder: that takes the films.

    Raises:
        MissingToolError: OpenGL does not work here.
    """
    films = []
    for maneuver in maneuvers:
        pair = [run for run in runs if run.scenario == maneuver.name and run.poses is not None]
        if pair:
            films.append(_film(robot, device.as_flown(maneuver), pair, folder))
    return tuple(films)


def _film(robot: Robot, device: Device, runs: Sequence[Run], folder: Path) -> Path:
    poses = [run.poses for run in runs if run.poses is not None]
    takes = [
        Take(film_model(robot, device, ocs=run.ocs), pose.qpos[::STRIDE])
        for run, pose in zip(runs, poses, strict=True)
    ]
    sides = [
        list(_captioned(run, pose, frames))
        for run, pose, frames in zip(runs, poses, render_takes(takes), strict=True)
    ]
    seconds = STRIDE * float(poses[0].time[1] - poses[0].time[0])
    return encode(_side_by_side(sides), seconds, folder / safe_name(runs[0].scenario))


def _side_by_side(sides: Sequence[Sequence[Frames]]) -> list[Frames]:
    """Who is done first stands still until the other is."""
    longest = max(map(len, sides))
    return [
        np.concatenate([side[min(k, len(side) - 1)] for side in sides], axis=1)
        for k in range(longest)
    ]


def _captioned(run: Run, poses: Poses, frames: Frames) -> Iterator[Frames]:
    title = f"{run.scenario}, {'with' if run.ocs else 'without'} the device"
    series = run.series
    for time, frame in zip(poses.time[::STRIDE], frames, strict=True):
        at = min(int(np.searchsorted(series.time, time - 1e-9)), len(series.time) - 1)
        tilt = float(np.arccos(np.cos(series.roll[at]) * np.cos(series.pitch[at])))
        lines = [f"{time:.2f} s   tilt {degrees(tilt, 0)}"]
        if run.ocs:
            left, right = (rpm(float(speed)) for speed in series.wheel_speed[at])
            lines.append(f"wheels {left}, {right}")
        yield captioned(frame, Caption(title, run.passed, tuple(lines)))
