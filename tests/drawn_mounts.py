"""Mounts of motors and rooms of gears, drawn for problems that have none."""

from dataclasses import replace

import numpy as np

from ocs_design.actuation.motor import BoltCircle, Face, GearRoom, Mounting


def with_mounts(problem, seed):
    """The same catalogue, each motor with threads before, behind or nowhere; gears with room."""
    rng = np.random.default_rng([seed, 1])
    return replace(
        problem,
        motors=tuple(replace(motor, mounting=_mounting(rng, motor)) for motor in problem.motors),
        gears=tuple(
            gear if gear.room is None else replace(gear, room=_room(rng)) for gear in problem.gears
        ),
    )


def _mounting(rng, motor):
    """As far as there is room on the motor."""
    across = motor.diameter * rng.uniform(0.5, 0.65)
    face = rng.choice([None, Face.OUTPUT, Face.BACK, Face.BACK])
    shaft = rng.choice([None, 0.1 * motor.diameter])
    if face is None or across < 0.012:
        return rng.choice([None, Mounting(shaft)])
    rotor = None if shaft is not None else BoltCircle(0.6 * across, 4, "M2")
    stator = BoltCircle(across, int(rng.integers(3, 5)), "M2")
    return Mounting(shaft, rotor, stator, Face(face))


def _room(rng):
    depth, offset = rng.uniform(0.005, 0.02), rng.choice([0.0, rng.uniform(0.02, 0.05)])
    return GearRoom(depth, offset, 0.01, 0.01, center=0.4 * offset)
