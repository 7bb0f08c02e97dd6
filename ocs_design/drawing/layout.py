"""Where the views of a wheel stand on the sheet, and at which scale."""

from dataclasses import dataclass

from ocs_design.drawing.scale import Scale, largest_scale
from ocs_design.drawing.sheet import HEIGHT, WIDTH, Point
from ocs_design.drawing.wheel import widest
from ocs_design.parts.wheel import Wheel

MARGIN_LEFT, MARGIN = 20.0, 10.0
"""Of the frame (ISO 5457): room to file the sheet on the left."""

MIDDLE = 82.0
"""y of the wheel's axis in both views [mm]."""

TALLEST = 98.0
"""Of a view: what name and dimensions leave above, and the title block below [mm]."""

LEFT, BETWEEN, RIGHT = 33.0, 36.0, 51.0
"""Room for the diameters, for the widths, and for the leaders [mm]."""

_ROOM = WIDTH - MARGIN_LEFT - MARGIN - LEFT - BETWEEN - RIGHT


@dataclass(frozen=True)
class Layout:
    """Centres of both views [mm].

    Attributes:
        scale: of both.
        section: of the cut, left; seen from the right of the front view, as in first-angle
            projection.
        front: of the view along the axis.
    """

    scale: Scale
    section: Point
    front: Point


def lay_out(wheel: Wheel) -> Layout:
    """Both views side by side, in the middle of the room that they have."""

    def fits(scale: Scale) -> bool:
        """Whether both views have room at that scale."""
        across, wide = scale(2.0 * wheel.rim.outer_radius), scale(widest(wheel))
        return across <= TALLEST and across + wide <= _ROOM

    scale = largest_scale(fits)
    across, wide = scale(2.0 * wheel.rim.outer_radius), scale(widest(wheel))
    start = MARGIN_LEFT + LEFT + max(0.0, _ROOM - across - wide) / 2.0
    section = start + wide / 2.0
    front = start + wide + BETWEEN + across / 2.0
    return Layout(scale, (section, MIDDLE), (front, MIDDLE))


FRAME_BOX = (MARGIN_LEFT, MARGIN, WIDTH - MARGIN, HEIGHT - MARGIN)
"""Left, top, right, bottom [mm]."""
