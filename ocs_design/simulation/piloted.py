"""One world whose wheels are driven by something other than the law, one control step at a time."""

from dataclasses import dataclass

import mujoco
import numpy as np
from mujoco.rollout import Rollout

from ocs_design.common import quaternions
from ocs_design.common.arrays import FloatArray
from ocs_design.simulation.batch import Batch, Recording
from ocs_design.simulation.world import World


@dataclass(frozen=True, eq=False)
class SensorReadings:
    """Sensor readings of a trunk with m wheels at one control instant.

    Attributes:
        vertical: the world's upward direction in B, shape (3,).
        heading: turn about the vertical since the start [rad], within half a turn.
        rate: in B [rad/s], (3,).
        wheel_speed: relative to the trunk [rad/s], (m,).
        law_torque: that the wheel law would command [N m], (m,).
        lowest, highest: torques that the motors can give [N m], (m,).
    """

    vertical: FloatArray
    heading: float
    rate: FloatArray
    wheel_speed: FloatArray
    law_torque: FloatArray
    lowest: FloatArray
    highest: FloatArray


class PilotedFlight(Batch):
    """A flight from start to end with the batch's own physics, sensors, drives, legs and pushes.

    The wheels wait for lift-off, as they do under the law.
    """

    def __init__(self, world: World, hold: int) -> None:
        """Flight of a world with active wheels; `hold` physics steps per control step."""
        super().__init__([world], hold)
        self._physics = [mujoco.MjData(world.model)]
        self._pool = Rollout(nthread=0)
        self._instant = 0
        self.readings = self._read_sensors()
        while not self.ended and self.steps_since_lift_off < 0:
            self.fly(np.zeros(len(self._wheels)))

    @property
    def ended(self) -> bool:
        """Whether it is over: its time is up, or its state is not finite."""
        return self._instant >= self._lengths[0] or not np.isfinite(self._state).all()

    @property
    def steps_since_lift_off(self) -> int:
        """Control steps since lift-off; negative on the ground before it."""
        return int(self._clock.steps(self._instant, 1)[0])

    @property
    def in_contact(self) -> bool:
        """Whether anything touched the floor in the last control step."""
        return bool(self._record.contact[self._instant - 1, 0])

    @property
    def pose(self) -> FloatArray:
        """Joint positions of the model, shape (nq,)."""
        pose: FloatArray = self._qpos[0].copy()
        return pose

    def fly(self, torque: FloatArray) -> None:
        """One control step with these motor commands [N m], (m,), clipped as the law's are."""
        k, speed = self._instant, self.readings.wheel_speed[None]
        commanded = self._law.feasible_torque(torque[None], speed, self._period)
        if self.steps_since_lift_off < 0:
            commanded[:] = 0.0
        if self._stopped is not None:
            commanded = self._stopped.without_stopped(self._clock.steps(k, 1), commanded)
        self.advance(self._pool, self._physics, k, self.applied_torque(k, commanded))
        self.record_sensors(k, 1)
        self._instant += 1
        if not self.ended:
            self.readings = self._read_sensors()

    def recording(self) -> Recording:
        """What happened, once it has ended."""
        return self.recorded(self._physics[0])

    def _read_sensors(self) -> SensorReadings:
        commanded, (vertical, rate, attitude) = self.observe_and_decide(self._instant, self._law)
        speed = self._record.wheel_speed[self._instant, :1].copy()
        gain = (self._law.wheel_response * self._period)[:, None]
        unlimited = np.full_like(speed, np.inf)
        low, high = (
            self._law.limits.clipped(torque, speed, gain)[0] for torque in (-unlimited, unlimited)
        )
        heading = quaternions.heading(attitude)[0]
        return SensorReadings(vertical[0], heading, rate[0], speed[0], commanded[0], low, high)
