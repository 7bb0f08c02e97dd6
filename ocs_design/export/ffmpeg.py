"""Search for ffmpeg, which encodes videos."""

import shutil
from importlib.util import find_spec

from ocs_design.common.errors import extra_command

FFMPEG_HINT = f"{extra_command('video')}, or on Debian: apt install ffmpeg"


def ffmpeg_program() -> str | None:
    """Path of the system's ffmpeg, else of that of imageio-ffmpeg; None if there is neither."""
    found = shutil.which("ffmpeg")
    if found is not None or find_spec("imageio_ffmpeg") is None:
        return found
    # An extra.
    import imageio_ffmpeg  # noqa: PLC0415

    try:
        return str(imageio_ffmpeg.get_ffmpeg_exe())
    except RuntimeError:
        return None
