"""Every key that there is has its note, and no other."""

from ocs_design.requirement.key_notes import FIELD_NOTES, KEY_NOTES, MANEUVER_NOTES
from ocs_design.requirement.maneuver_table import MANEUVER_KINDS
from ocs_design.requirement.specification import all_keys


def test_every_key_is_explained():
    assert set(KEY_NOTES) == set(all_keys())
    assert all(note.why for note in KEY_NOTES.values())


def test_every_kind_of_maneuver_and_each_of_its_fields_is_explained():
    assert set(MANEUVER_NOTES) == set(MANEUVER_KINDS)
    assert set(FIELD_NOTES) == {name for kind in MANEUVER_KINDS.values() for name in kind.values}
