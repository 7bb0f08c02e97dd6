"""Shaft and threads of motors: what may be stated, and what is refused."""

import json

import pytest
from motor_rows import csv, toml

from ocs_design.actuation.motor import BY_CONVENTION, BoltCircle, Face, Mounting
from ocs_design.catalogue.motors import motor, motors, motors_to_json
from ocs_design.common.errors import SpecificationError
from ocs_design.report.text.catalogue import motor_mounting

WHOLE = {
    "name": "M",
    "maker": "me",
    "source": "bench",
    "diameter_m": 0.05,
    "shaft_diameter_m": 0.005,
    "rotor_bolt_circle_m": 0.017,
    "rotor_bolts": 3,
    "rotor_thread": "M3",
    "stator_bolt_circle_m": 0.025,
    "stator_bolts": 4,
    "stator_thread": "M2.5",
    "stator_face": "output",
}
MOUNTING = Mounting(0.005, BoltCircle(0.017, 3, "M3"), BoltCircle(0.025, 4, "M2.5"), Face.OUTPUT)


@pytest.mark.parametrize(("write", "suffix"), [(toml, ".toml"), (csv, ".csv")])
def test_both_formats_say_the_same(load, write, suffix):
    assert load(write(WHOLE), suffix)["M"].mounting == MOUNTING


def test_each_part_may_stand_alone(load):
    nothing = dict.fromkeys(key for key in WHOLE if key.startswith(("shaft", "rotor", "stator")))
    assert load(toml(WHOLE | nothing))["M"].mounting is None
    shaft = nothing | {"shaft_diameter_m": 0.005}
    assert load(toml(WHOLE | shaft))["M"].mounting == Mounting(0.005)


FAULTS = {
    "no thread": ({"rotor_thread": None}, "rotor_bolt_circle_m.* belong together: no rotor_thread"),
    "only a number": (
        {"stator_bolt_circle_m": None, "stator_thread": None, "stator_face": None},
        "no stator_bolt_circle_m, stator_thread",
    ),
    "two bolts": ({"rotor_bolts": 2}, "rotor_bolts is 2; it must be 3 or more"),
    "one bolt": ({"stator_bolts": 1}, "stator_bolts is 1; it must be 2 or more"),
    "half a bolt": ({"rotor_bolts": 3.5}, "rotor_bolts: 3.5 is not a whole number"),
    "no bolts": ({"rotor_bolts": 0}, "rotor_bolts: 0 is not positive"),
    "no class": ({"rotor_screws": "9.9"}, "rotor_screws is '9.9', which is none of 8.8, 10.9"),
    "half a depth": ({"rotor_depth_m": 0.01}, "rotor_depth_m and rotor_depth_max_m belong to"),
    "depth of nothing": (
        {
            "stator_bolt_circle_m": None,
            "stator_bolts": None,
            "stator_thread": None,
            "stator_face": None,
            "stator_depth_m": 0.01,
            "stator_depth_max_m": 0.02,
        },
        "belong to each other and to stator_bolt_circle_m",
    ),
    "depths": ({"rotor_depth_m": 0.02, "rotor_depth_max_m": 0.01}, "0.02, above rotor_depth_max_m"),
    "inch thread": ({"rotor_thread": "4-40"}, "rotor_thread is '4-40', which is none of M2, M2.5"),
    "wide circle": ({"rotor_bolt_circle_m": 0.05}, "0.05, but the motor is only 0.05 m wide"),
    "thick shaft": ({"shaft_diameter_m": 0.06}, "shaft_diameter_m is 0.06, but the motor is only"),
    "shaft between": ({"shaft_diameter_m": 0.0117}, "leave less than 1 mm to the shaft"),
    "many bolts": ({"rotor_bolts": 13}, "13 holes for M3 leave less than 1 mm between them"),
    "no face": ({"stator_face": None}, "stator_face and the stator's bolt circle"),
    "wrong face": ({"stator_face": "front"}, "'front' is none of output, back"),
}


@pytest.mark.parametrize(("changes", "message"), FAULTS.values(), ids=FAULTS)
def test_what_cannot_be_is_refused_whatever_the_remark(load, changes, message):
    with pytest.raises(SpecificationError, match=message) as caught:
        load(toml(WHOLE | changes | {"remark": "so it is"}))
    assert "(M)" in str(caught.value)


def test_the_edges_of_what_can_be_made_pass(load):
    """Of M3 on 17 mm, 3.4 mm holes: 1 mm is left to a shaft of 11.6 mm, and between 11 screws."""
    changes = {"shaft_diameter_m": 0.0116 - 1e-9, "rotor_bolts": 11}
    edge = load(toml(WHOLE | changes))["M"].mounting
    assert edge.rotor.inside - edge.shaft_diameter / 2.0 == pytest.approx(1e-3, abs=1e-9)
    assert 1e-3 < edge.rotor.spacing < 1.4e-3


def test_how_many_rows_know_what():
    known = [found.mounting for found in motors().values() if found.mounting is not None]
    assert sum(found.shaft_diameter is not None for found in known) >= 82
    assert sum(found.rotor is not None for found in known) >= 29
    assert sum(found.stator is not None for found in known) >= 72


def test_convention_is_said_where_threads_are_not_of_the_motors_own_drawing():
    for found in motors().values():
        words = "convention of makers" in found.source or "of the same series" in found.source
        assert words <= (BY_CONVENTION in found.confidence), found.name


def test_rows_with_threads_say_where_they_are_from():
    for found in motors().values():
        mounting = found.mounting
        if mounting is not None and (mounting.rotor or mounting.stator):
            assert "threads: " in found.source, found.name


def test_it_is_in_the_json_and_in_words():
    (row,) = json.loads(motors_to_json([motor("MN5212 KV340")]))["motors"]
    assert row["mounting"]["rotor"] == {
        "diameter": 0.017,
        "bolts": 3,
        "thread": "M3",
        "screws": "8.8",
        "depth": None,
        "depth_max": None,
    }
    said = motor_mounting(motor("MN5212 KV340").mounting)
    assert said == "shaft 4 mm, rotor 3 x M3 on 17 mm, stator 4 x M3 on 25 mm (back)"
    assert motor_mounting(None) == ""
