"""Parses bytes into XML elements, and their attributes into numbers.

Every fault of a robot file below the level of links and joints becomes a `RobotError` that names
the place.
"""

import re
from collections.abc import Sequence
from reprlib import repr as shortened
from xml.etree import ElementTree as ET
from xml.parsers.expat import ErrorString, errors

import numpy as np

from ocs_design.common.arrays import FloatArray
from ocs_design.common.errors import RobotError, extra_command
from ocs_design.robot.links import Warnings
from ocs_design.robot.tree import LARGEST_NUMBER

MOST_ELEMENTS = 500_000
"""Largest number of XML elements in a robot file."""


def parse_xml(content: bytes, warnings: Warnings | None = None) -> ET.Element:
    """The root element of a robot file, its tags without namespaces other than xacro's.

    Bytes that contradict the declared encoding are read as Windows-1252, with a warning.
    """
    # Elements take at least fifty times their four bytes: gigabytes, if nobody counted them.
    if content.count(b"<") > 2 * MOST_ELEMENTS:
        raise _too_many_elements()
    warnings = warnings or Warnings()
    # Simulators tolerate a declaration after blank lines or comments; the line count is kept.
    if late := _LATE_DECLARATION.match(content):
        start, end = late.span(1)
        content = content[:start] + b" " * (end - start) + content[end:]
        warnings.add("the XML declaration is not the first thing in the file: read without it")
    try:
        root = _parsed(content)
    except ET.ParseError as error:
        root = _parsed_as_cp1252(content, error)
        warnings.add(
            "the file is not UTF-8 and declares no other encoding: read as Windows-1252 (Latin-1)"
        )
    except (ValueError, LookupError) as error:
        raise RobotError(
            f"the file declares a text encoding that cannot be read: {error}",
            hint="save it as UTF-8",
        ) from error
    for element in root.iter():
        if "}" in element.tag and "xacro" not in element.tag:
            element.tag = element.tag.rpartition("}")[2]
    return root


_LATE_DECLARATION = re.compile(rb"(?:\s|<!--(?:(?!--).)*-->)+(<\?xml\s[^>]*\?>)", re.DOTALL)


def _parsed_as_cp1252(content: bytes, error: ET.ParseError) -> ET.Element:
    """The root of bytes that are not UTF-8, the only case of an undeclared encoding."""
    try:
        content.decode("utf-8")
    except UnicodeDecodeError:
        pass
    else:
        raise _explained(content, error) from error
    try:
        # A str is parsed as is, whatever encoding its first line declares.
        return _parsed(content.decode("cp1252", errors="replace"))
    except ET.ParseError:
        raise _explained(content, error) from error


def _parsed(content: bytes | str) -> ET.Element:
    """The root; if the file defines entities, which may contain elements, those are counted."""
    if isinstance(content, str):
        defines = "ENTITY" in content
    else:
        # In UTF-16 there is a zero between the letters.
        defines = b"ENTITY" in content or b"E\0N\0T\0I\0T\0Y" in content
    return ET.fromstring(content, ET.XMLParser(target=_CountingBuilder()) if defines else None)


class _CountingBuilder(ET.TreeBuilder):
    """Tree builder that stops at more elements than any robot has."""

    _count = 0

    def start(self, tag: str, attrs: dict[str, str], /) -> ET.Element:
        """Start another element, unless there are more than any robot has."""
        self._count += 1
        if self._count > MOST_ELEMENTS:
            raise _too_many_elements()
        return super().start(tag, attrs)


def _too_many_elements() -> RobotError:
    return RobotError(
        f"the XML has more than {MOST_ELEMENTS:,} elements",
        hint="a robot of a thousand links has twenty thousand; remove what is not part of it",
    )


def _explained(content: bytes, error: ET.ParseError) -> RobotError:
    """Error that explains why XML cannot be parsed, and what to do."""
    line, column = error.position
    reason = ErrorString(error.code) or str(error)
    if b"<" not in content.replace(b"\0", b"")[:4096]:
        return RobotError(
            "the file is not XML", hint="give a URDF, xacro or MJCF file; a mesh is not enough"
        )
    if reason == errors.XML_ERROR_UNBOUND_PREFIX and b"xacro:" in content:
        return unexpanded_xacro()
    if "amplification" in reason:
        return RobotError(
            f"the XML's entities expand without bound (line {line}); refused",
            hint="write the values out in place of nested <!ENTITY> definitions",
        )
    # The line itself is shown if its encoding is certain.
    lines = content.splitlines()
    at_fault = lines[line - 1].strip() if line <= len(lines) else b""
    readable = at_fault and at_fault.isascii() and b"\0" not in at_fault
    excerpt = f" in {shortened(at_fault.decode('ascii'))}" if readable else ""
    hint = "check that the file is complete and that every tag is closed"
    if b"\0" in content and not content.startswith((b"\xff\xfe", b"\xfe\xff")):
        hint = "remove the null bytes; many editors do not show them"
    return RobotError(
        f"line {line}, column {column + 1}: the XML is broken: {reason}{excerpt}", hint=hint
    )


def unexpanded_xacro() -> RobotError:
    """The error for a xacro file where a URDF is needed."""
    return RobotError(
        "the file is a xacro that has not been expanded",
        hint="expand it first: xacro robot.urdf.xacro > robot.urdf; "
        f"or: {extra_command('xacro')}, to have it expanded on reading",
    )


def required(parent: ET.Element, tag: str, where: str) -> ET.Element:
    """The first child element `tag`, which must be there."""
    child = parent.find(tag)
    if child is None:
        raise RobotError(f"{where}: <{parent.tag}> has no <{tag}>", hint=f"add a <{tag}> element")
    return child


def text(element: ET.Element, attribute: str, where: str) -> str:
    """Value of an attribute that must be there."""
    value = element.get(attribute)
    if value is None:
        raise RobotError(
            f"{where}: <{element.tag}> has no {attribute}", hint=f'add {attribute}="..."'
        )
    return value


def number(
    element: ET.Element, attribute: str, where: str, *, default: float | None = None
) -> float:
    """A finite number; `default` where the attribute is missing, an error if there is none."""
    if default is not None and element.get(attribute) is None:
        return default
    return _finite(text(element, attribute, where), element, attribute, where)


def numbers(
    element: ET.Element | None, attribute: str, where: str, default: Sequence[float]
) -> FloatArray:
    """Finite numbers, as many as in `default`, which is used if the attribute is missing."""
    value = None if element is None else element.get(attribute)
    if element is None or value is None:
        return np.array(default, dtype=np.float64)
    values = [_finite(word, element, attribute, where) for word in value.split()]
    if len(values) != len(default):
        raise RobotError(
            f'{where}: {attribute}="{value}" of <{element.tag}> has {len(values)} numbers',
            hint=f"give {len(default)} numbers separated by spaces",
        )
    return np.array(values, dtype=np.float64)


def _finite(word: str, element: ET.Element, attribute: str, where: str) -> float:
    try:
        value = float(word)
    except ValueError:
        value = np.nan
    # Limits are only compared; files write `inf` or the largest number for no limit.
    limits = element.tag == "limit"
    if np.isnan(value) or "_" in word or (np.isinf(value) and not limits):
        raise RobotError(
            f'{where}: {attribute}="{word}" of <{element.tag}> is not a finite number',
            hint="write a plain number with a decimal point, such as 0.25",
        )
    if abs(value) > LARGEST_NUMBER and not limits:
        raise RobotError(
            f'{where}: {attribute}="{word}" of <{element.tag}> is far too large',
            hint="lengths are in metres, masses in kilograms, angles in radians",
        )
    return value
