"""Every key that there is has its note, and no other."""

from ocs_design.requirement.kinds import FIELD_NOTES, MANEUVER_KINDS, field_note
from ocs_design.requirement.specification import all_keys


def test_every_key_is_explained():
    assert all(key.summary and key.why for key in all_keys().values())


def test_every_kind_of_maneuver_and_each_of_its_fields_is_explained():
    assert all(kind.note for kind in MANEUVER_KINDS.values())
    notes = {
        (kind, name): field_note(kind, name)
        for kind, known in MANEUVER_KINDS.items()
        for name in known.values
    }
    assert set(FIELD_NOTES) <= {name for _, name in notes} | {".".join(path) for path in notes}
    assert "torque" in notes["shove", "duration"]
    assert "turn" in notes["flip", "duration"]
    assert "torque" not in notes["flip", "duration"]
