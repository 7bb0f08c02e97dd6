"""The whole drawing of a wheel, in both formats."""

from ocs_design.drawing.front_view import front_view
from ocs_design.drawing.layout import lay_out
from ocs_design.drawing.notes import notes
from ocs_design.drawing.pdf import pdf_bytes
from ocs_design.drawing.section_view import section_view
from ocs_design.drawing.sheet import Item
from ocs_design.drawing.svg import svg_bytes
from ocs_design.drawing.tables import frame, parts_list, title_block
from ocs_design.drawing.wheel import WheelDrawing


def wheel_sheet(drawing: WheelDrawing) -> list[Item]:
    """Section and front view in first-angle projection, notes, list of parts and title block."""
    layout = lay_out(drawing.wheel)
    return [
        *frame(),
        *section_view(drawing.wheel, layout),
        *front_view(drawing.wheel, layout),
        *notes(drawing),
        *parts_list(drawing),
        *title_block(drawing, layout),
    ]


def draw_wheel(drawing: WheelDrawing) -> dict[str, bytes]:
    """The drawing by the suffix of its format, `svg` and `pdf`; the same bytes every time."""
    items, title = wheel_sheet(drawing), f"Flywheel of {drawing.robot}"
    return {"svg": svg_bytes(items, title), "pdf": pdf_bytes(items, title)}
