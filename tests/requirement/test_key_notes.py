"""Every key that there is has its note, and no other."""

from ocs_design.requirement.kinds import MANEUVER_KINDS
from ocs_design.requirement.specification import all_keys
from ocs_design.requirement.writing import FIELD_NOTES, KEY_NOTES, MANEUVER_NOTES, field_note


def test_every_key_is_explained():
    assert set(KEY_NOTES) == set(all_keys())
    assert all(note.why for note in KEY_NOTES.values())


def test_every_kind_of_maneuver_and_each_of_its_fields_is_explained():
    assert set(MANEUVER_NOTES) == set(MANEUVER_KINDS)
    notes = {
        (kind, name): field_note(kind, name)
        for kind, known in MANEUVER_KINDS.items()
        for name in known.values
    }
    assert set(FIELD_NOTES) <= {name for _, name in notes} | {".".join(path) for path in notes}
    assert "torque" in notes["shove", "duration"]
    assert "turn" in notes["flip", "duration"]
    assert "torque" not in notes["flip", "duration"]
