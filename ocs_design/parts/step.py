"""Parts in STEP (ISO 10303-21, application protocol 214), exact, in millimetres."""

from importlib.util import find_spec

from ocs_design.exceptions import MissingToolError
from ocs_design.parts.part import Part


def step_bytes(part: Part) -> bytes:
    """The part as one solid that bears its name; the same bytes every time.

    Raises:
        MissingToolError: Open CASCADE is not installed, or cannot be loaded.
    """
    require_open_cascade()
    try:
        # An extra, which takes seconds to import.
        from ocs_design.parts.step_writer import write_step  # noqa: PLC0415
    except ImportError as error:
        raise _missing(f"cannot be loaded: {error}") from error
    return write_step(part)


def require_open_cascade() -> None:
    """Asks without importing it, so that a command can before its work.

    Raises:
        MissingToolError: Open CASCADE is not installed.
    """
    if find_spec("OCP") is None:
        raise _missing("is not installed")


def _missing(what: str) -> MissingToolError:
    return MissingToolError(
        f"no STEP file can be written, for Open CASCADE {what}",
        hint="pip install 'ocs-design[step]'",
    )
