"""A front as a drawing, in SVG."""

from io import BytesIO
from typing import TYPE_CHECKING

from ocs_design.pareto import Front
from ocs_design.report.matplotlib_sheet import sheet
from ocs_design.units import to_unit

if TYPE_CHECKING:
    from matplotlib.axes import Axes

WIDTH, HEIGHT = 9.0, 4.2
"""Of the drawing [in]; it grows with its legend."""

LEGEND_ROW = 0.2
"""[in]"""

COLORS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000")
"""One for each drive, told apart by colour-blind eyes too (Okabe and Ito)."""

MARKERS = "osD^vP*X"

_STYLE = {
    "font.size": 9.0,
    # Else every drawing names its parts anew.
    "svg.hashsalt": "ocs-design",
}


def front_svg(front: Front) -> bytes:
    """Mass against what is varied, each drive in its colour; the same bytes every time.

    Raises:
        MissingToolError: matplotlib is not installed.
    """
    rows = len(dict.fromkeys(_drives(front))) + 2
    size = WIDTH, max(HEIGHT, LEGEND_ROW * rows)
    with sheet("front.svg is not drawn", size, _STYLE) as figure:
        axes = figure.subplots()
        _draw_masses(axes, front)
        _draw_marks(axes, front)
        axes.set_title(f"{front.robot}: lightest device", loc="left")
        axes.set_xlabel(f"{front.label} [{front.unit}]")
        axes.set_ylabel("mass of the device [g]")
        axes.set_xlim(*_ends(front))
        axes.grid(color="#dddddd", linewidth=0.6)
        figure.legend(loc="outside right upper", frameon=False)
        buffer = BytesIO()
        figure.savefig(buffer, format="svg", metadata={"Date": None})
    return buffer.getvalue()


def _ends(front: Front) -> tuple[float, float]:
    """Of the axis, with room for a marker; values without a device count too."""
    low, high = (to_unit(front.points[place].value, front.unit) for place in (0, -1))
    room = 0.04 * (high - low)
    return low - room, high + room


def _draw_masses(axes: "Axes", front: Front) -> None:
    """One line, broken where there is no device, and a marker for each drive."""
    values = [to_unit(point.value, front.unit) for point in front.points]
    masses = [1e3 * point.device.mass if point.device else float("nan") for point in front.points]
    axes.plot(values, masses, color="#999999", linewidth=1.0, zorder=1)
    drives = _drives(front)
    for index, name in enumerate(dict.fromkeys(filter(None, drives))):
        chosen = [place for place, drive in enumerate(drives) if drive == name]
        axes.scatter(
            [values[place] for place in chosen],
            [masses[place] for place in chosen],
            color=COLORS[index % len(COLORS)],
            marker=MARKERS[index % len(MARKERS)],
            s=26.0,
            label=name,
            zorder=2,
        )


def _drives(front: Front) -> list[str]:
    """Motor and gear of each point; empty without a device."""
    devices = [point.device for point in front.points]
    return [f"{device.motor}, {device.gear}" if device else "" for device in devices]


def _draw_marks(axes: "Axes", front: Front) -> None:
    """The specification's own value, and values without a device at the foot."""
    if front.spans_own_value:
        axes.axvline(
            to_unit(front.own_value, front.unit),
            color="#666666",
            linewidth=0.8,
            linestyle="--",
            label="as specified",
            zorder=0,
        )
    without = [to_unit(point.value, front.unit) for point in front.points if point.device is None]
    if without:
        axes.scatter(
            without,
            [0.03] * len(without),
            color="#b3382c",
            marker="x",
            label="no device",
            transform=axes.get_xaxis_transform(),
        )
