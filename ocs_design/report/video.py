"""Films of each maneuver, with the device and without it side by side, in real time."""

import subprocess
from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from ocs_design.common.errors import MissingToolError
from ocs_design.common.files import safe_name
from ocs_design.common.units import rpm
from ocs_design.common.wording import degrees
from ocs_design.device.device import Device
from ocs_design.export.film import Take, film_model, render_takes
from ocs_design.export.programs import FFMPEG_HINT, ffmpeg_program
from ocs_design.report.flights import off_level
from ocs_design.requirement.maneuver import Maneuver
from ocs_design.robot.robot import Robot
from ocs_design.simulation.run import Run

STRIDE = 2
"""Poses from one frame to the next: 33 frames a second of 67 poses."""

Picture: TypeAlias = NDArray[np.uint8]
"""Red, green and blue, shape (height, width, 3)."""

LETTER_SIZE = 18
"""Height of letters [pixels]."""

MARGIN = 10
INK, GOOD, BAD = (30, 30, 35), (20, 120, 50), (170, 40, 40)
_PAPER = (255, 255, 255)
_HALO = 2
"""Width of the white halo around letters, which keeps them legible on any image [pixels]."""

GIF_STRIDE = 2
"""A GIF keeps one of so many frames, because GIFs compress badly."""

GIF_COLORS = 128

_SAMPLES = 8
"""Number of frames from which a GIF's palette is chosen."""

_ENCODING_TIMEOUT = 300.0
"""Longest time that ffmpeg may take [s]."""


def film_if_possible(
    robot: Robot, device: Device, maneuvers: Sequence[Maneuver], runs: Sequence[Run], folder: Path
) -> tuple[str, ...]:
    """Write the films of `film_flights` if OpenGL works.

    Returns:
        Remarks on what is missing.
    """
    try:
        films = film_flights(robot, device, maneuvers, runs, folder)
    except MissingToolError as error:
        return (f"{error}; {error.hint}" if error.hint else str(error),)
    if any(film.suffix == ".gif" for film in films):
        return (f"the video is a GIF, because no ffmpeg with H.264 was found; {FFMPEG_HINT}",)
    return ()


def film_flights(
    robot: Robot, device: Device, maneuvers: Sequence[Maneuver], runs: Sequence[Run], folder: Path
) -> tuple[Path, ...]:
    """Write a film `<name>.mp4` or `.gif` of each maneuver from runs with poses.

    Raises:
        MissingToolError: OpenGL does not work here.
    """
    films = []
    for maneuver in maneuvers:
        own_runs = [run for run in runs if run.scenario == maneuver.name]
        pair = [(run, run.poses) for run in own_runs if run.poses is not None]
        if not pair:
            continue
        flown = device.as_flown(maneuver)
        takes = [
            Take(film_model(robot, flown, ocs=run.ocs), poses.qpos[::STRIDE]) for run, poses in pair
        ]
        sides = []
        for (run, poses), frames in zip(pair, render_takes(takes), strict=True):
            title, side = f"{run.scenario}, {'with' if run.ocs else 'without'} the device", []
            series = run.series
            for frame, time in zip(frames, poses.time[::STRIDE], strict=True):
                index = min(int(np.searchsorted(series.time, time - 1e-9)), len(series.time) - 1)
                tilt = float(off_level(series.roll[index], series.pitch[index]))
                lines = [f"{time:.2f} s   tilt {degrees(tilt, 0)}"]
                if run.ocs:
                    speeds = (rpm(float(speed)) for speed in series.wheel_speed[index])
                    lines.append(f"wheels {', '.join(speeds)}")
                side.append(captioned(frame, title, run.passed, lines))
            sides.append(side)
        # The shorter film holds its last frame until the other ends.
        film: list[Picture] = [
            np.concatenate([side[min(k, len(side) - 1)] for side in sides], axis=1)
            for k in range(max(map(len, sides)))
        ]
        times = pair[0][1].time
        seconds = STRIDE * float(times[1] - times[0])
        films.append(encode(film, seconds, folder / safe_name(maneuver.name)))
    return tuple(films)


def captioned(picture: Picture, title: str, passed: bool | None, lines: Sequence[str]) -> Picture:
    """The picture with a title, coloured by the verdict if there is one, and lines below."""
    # Importing it takes time, and only films need it.
    from PIL import Image, ImageDraw, ImageFont  # noqa: PLC0415

    image = Image.fromarray(picture)
    draw = ImageDraw.Draw(image)
    font = ImageFont.load_default(LETTER_SIZE)
    color = INK if passed is None else GOOD if passed else BAD
    leading = LETTER_SIZE + 6
    top = image.height - MARGIN - leading * len(lines)
    captions = ((top + index * leading, line, INK) for index, line in enumerate(lines))
    for height, text, ink in ((MARGIN, title, color), *captions):
        draw.text((MARGIN, height), text, ink, font, stroke_width=_HALO, stroke_fill=_PAPER)
    return np.asarray(image)


def encode(pictures: Sequence[Picture], seconds: float, stem: Path) -> Path:
    """Write a film of pictures of equal, even size, one every so many seconds.

    Returns:
        The path: `stem` with the suffix `.mp4` if ffmpeg is available, else `.gif`.
    """
    from PIL import Image  # noqa: PLC0415 - as above

    program = ffmpeg_program()
    if program is not None:
        path = stem.with_suffix(".mp4")
        height, width, _ = pictures[0].shape
        source = ["-f", "rawvideo", "-pix_fmt", "rgb24", "-s", f"{width}x{height}"]
        # H.264, which all browsers play.
        codec = ["-c:v", "libx264", "-crf", "23", "-pix_fmt", "yuv420p", "-movflags", "+faststart"]
        with suppress(OSError, subprocess.TimeoutExpired):
            rate = f"{1.0 / seconds:.6f}"
            result = subprocess.run(
                [program, "-y", *source, "-r", rate, "-i", "-", *codec, str(path)],
                input=b"".join(picture.tobytes() for picture in pictures),
                capture_output=True,
                check=False,
                timeout=_ENCODING_TIMEOUT,
            )
            if result.returncode == 0:
                return path
        # Remove what ffmpeg left unfinished.
        path.unlink(missing_ok=True)
    path, kept = stem.with_suffix(".gif"), pictures[::GIF_STRIDE]
    # One palette from a few frames keeps the file small and prevents flicker.
    sampled = kept[:: max(1, len(kept) // _SAMPLES)]
    palette = Image.fromarray(np.concatenate(sampled)).quantize(GIF_COLORS)
    # Dithered colours compress badly: to twice the size and more.
    no_dither = Image.Dither.NONE
    frames = [Image.fromarray(frame).quantize(palette=palette, dither=no_dither) for frame in kept]
    duration = round(1e3 * GIF_STRIDE * seconds)
    frames[0].save(path, save_all=True, append_images=frames[1:], duration=duration, loop=0)
    return path
