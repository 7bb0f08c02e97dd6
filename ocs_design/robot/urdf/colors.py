"""Colours of a URDF's materials. They are for looking at: one that cannot be read is left out."""

from collections.abc import Mapping
from typing import TypeAlias
from xml.etree import ElementTree as ET

Color: TypeAlias = tuple[float, float, float, float]
"""Red, green, blue and opacity, each 0..1."""


def read_palette(root: ET.Element) -> Mapping[str, Color]:
    """Every named material of the file, wherever it is defined first."""
    found: dict[str, Color] = {}
    for material in root.iter("material"):
        color = _color(material)
        if color is not None:
            found.setdefault(material.get("name", ""), color)
    return found


def color_of(visual: ET.Element, palette: Mapping[str, Color]) -> Color | None:
    """The colour of one `<visual>`: its own, or that of the material it names."""
    material = visual.find("material")
    if material is None:
        return None
    return _color(material) or palette.get(material.get("name", ""))


def _color(material: ET.Element) -> Color | None:
    color = material.find("color")
    if color is None:
        return None
    try:
        red, green, blue, opacity = (float(part) for part in color.get("rgba", "").split())
    except ValueError:
        return None
    values = (red, green, blue, opacity)
    return values if all(0.0 <= value <= 1.0 for value in values) else None
