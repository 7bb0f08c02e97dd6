"""Everything that could make a design another than its reader thinks it is, a line each."""

from collections.abc import Iterator

from ocs_design.design_file import OcsDesign, OcsRecord
from ocs_design.report.device import overrated
from ocs_design.report.doubts import doubts
from ocs_design.report.landings import flight_remarks
from ocs_design.report.motor_notes import motor_notes

_NOT_DESIGNED = "not designed"
"""In those of the workshop's notes that ask for a part of one's own."""


def mind(design: OcsDesign) -> Iterator[str]:
    """The robot's file first, then the device, its motor and its flights."""
    ocs = design.ocs
    yield from (f"warning: {told}" for told in (*design.robot.warnings, *ocs.warnings))
    yield from doubts(design)
    yield from overrated(ocs.motor)
    yield from motor_notes(design)
    yield from _clearance(design)
    yield from _reachable(ocs)
    yield from _workshop(ocs)
    if ocs.flywheel.stress_margin is None:
        yield f"the stress is NOT checked: no strength of {ocs.flywheel.material} is known"
    yield from flight_remarks(design)


def _clearance(design: OcsDesign) -> Iterator[str]:
    """A robot by hand has no shape, and nobody thinks that it was looked at."""
    if design.ocs.clearance is None and design.robot.sha256:
        yield (
            "clearance NOT checked: no shape of the robot could be read, so its parts may stand "
            "where the device does; see that its meshes are found (--package-path NAME=DIR)"
        )


def _reachable(ocs: OcsRecord) -> Iterator[str]:
    """Links that would hit a module; the whole report says how."""
    found = () if ocs.mounting is None else ocs.mounting.reachable
    if found:
        names = ", ".join(dict.fromkeys(reach.part for reach in found))
        yield f"within their joints' limits these could hit a module: {names}"


def _workshop(ocs: OcsRecord) -> Iterator[str]:
    """What is left to design, and how much more there is to know when making the parts."""
    left = [told for told in ocs.fitting if _NOT_DESIGNED in told]
    yield from left
    more = len(ocs.fitting) - len(left)
    if more:
        notes = "is a note" if more == 1 else f"are {more} notes"
        yield f"for the workshop there {notes} more: see with -v"
