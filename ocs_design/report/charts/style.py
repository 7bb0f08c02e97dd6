"""Colours of charts in files, on white; those of the page are in its own style sheet."""

from ocs_design.report.charts.marks import Ink

COLORS = {
    Ink.BLUE: "#0072b2",
    Ink.VERMILION: "#d55e00",
    Ink.GREEN: "#009e73",
    Ink.PURPLE: "#cc79a7",
    Ink.ORANGE: "#e69f00",
    Ink.SKY: "#56b4e9",
    Ink.PLAIN: "#30343a",
    Ink.FAINT: "#8a9099",
}

_SHAPES = (
    ".chart{font-family:system-ui,'Helvetica Neue',Arial,sans-serif}"
    ".sheet{fill:#fff}.title{font-size:13px;font-weight:600;fill:#1a1d21}"
    ".tick,.note{font-size:11px;fill:#4a5058}.note{paint-order:stroke;stroke:#fff;stroke-width:3px}.axis{font-size:11.5px;fill:#30343a}"
    ".grid{stroke:#e3e6ea;fill:none}.line{fill:none;stroke-width:1.8;stroke-linejoin:round}"
    ".thin{stroke-width:1.1}.rule{fill:none;stroke-width:1.1}.dashed{stroke-dasharray:5 3}"
    ".area{fill-opacity:.14}.ring{fill:#fff;stroke-width:2}"
)

SHEET = _SHAPES + "".join(
    f".{ink}{{stroke:{color}}}.fill-{ink}{{fill:{color}}}" for ink, color in COLORS.items()
)
