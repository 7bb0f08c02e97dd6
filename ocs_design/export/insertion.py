"""Adds to a user's XML file and leaves every byte of it as it was."""

from xml.parsers import expat

from ocs_design.exceptions import RobotError


def insert_before_end(content: bytes, addition: str) -> bytes:
    """`content` with `addition` in front of the end tag of its root element.

    Args:
        content: a well-formed XML file in any encoding that expat knows, or in Latin-1 undeclared.
        addition: elements, one a line, each line ended by a line feed; becomes CRLF where the file
            has it, and is written in the file's encoding.
    """
    place = _offset_of_root_end(content)
    unit = _code_unit(content)
    newline = "\r\n" if _encoded("\r\n", unit) in content else "\n"
    if not content[:place].rstrip(b" \t\0").endswith(b"\n"):
        addition = "\n" + addition
    return content[:place] + _encoded(addition.replace("\n", newline), unit) + content[place:]


def _offset_of_root_end(content: bytes) -> int:
    """Offset of the root's end tag: expat is not fooled by comments and CDATA, and counts bytes."""
    try:
        return _offset_read_as(content, None)
    except expat.ExpatError:
        # Undeclared Latin-1 or Windows-1252: one byte a character, as the reader has taken it.
        return _offset_read_as(content, "iso-8859-1")


def _offset_read_as(content: bytes, encoding: str | None) -> int:
    parser = expat.ParserCreate(encoding)
    ends: list[int] = []
    parser.EndElementHandler = lambda _: ends.append(parser.CurrentByteIndex)
    parser.Parse(content, True)
    if not content[ends[-1] :].startswith((b"</", b"<\0/", b"\0<\0/")):
        raise RobotError("the robot's root element is empty", hint="give a robot with links")
    return ends[-1]


def _code_unit(content: bytes) -> str:
    """How the characters of ASCII are written in the file."""
    if content.startswith((b"\xff\xfe", b"<\0")):
        return "utf-16-le"
    if content.startswith((b"\xfe\xff", b"\0<")):
        return "utf-16-be"
    return "ascii"


def _encoded(text: str, unit: str) -> bytes:
    """Characters that the encoding lacks become references, which XML takes anywhere."""
    return text.encode(unit, errors="xmlcharrefreplace")
