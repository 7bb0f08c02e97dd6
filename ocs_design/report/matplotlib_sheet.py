"""A sheet that matplotlib draws on: an extra, imported when something is drawn."""

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from typing import TYPE_CHECKING

from ocs_design.exceptions import MissingToolError

if TYPE_CHECKING:
    from matplotlib.figure import Figure

# A dollar in a robot's name is a dollar.
_STYLE = {"text.parse_math": False}


@contextmanager
def sheet(
    undrawn: str,
    size: tuple[float, float],
    style: Mapping[str, object],
    *,
    dpi: float | None = None,
) -> Iterator["Figure"]:
    """A figure in a style of our own, while it is drawn and saved.

    Args:
        undrawn: what is not drawn without matplotlib, as a sentence begins.
        size: width and height [in].
        style: settings of matplotlib.
        dpi: dots per inch; None: matplotlib's.

    Raises:
        MissingToolError: matplotlib is not installed.
    """
    try:
        # It takes a second to import.
        from matplotlib import style as styles  # noqa: PLC0415
        from matplotlib.figure import Figure  # noqa: PLC0415
    except ImportError as error:
        raise MissingToolError(
            f"{undrawn}, for matplotlib is not installed", hint="pip install 'ocs-design[plot]'"
        ) from error
    # Not from a file that the user may have.
    with styles.context(["default", _STYLE | dict(style)]):
        yield Figure(figsize=size, dpi=dpi, layout="constrained")
