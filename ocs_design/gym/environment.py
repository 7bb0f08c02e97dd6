"""A flight of the designed robot whose wheels a policy drives, judged as `validate` judges it.

World, legs, sensors, motors and sampled values are those of the Monte Carlo campaign: under the
torques of the wheel law an episode equals the campaign's flight.
"""

from math import remainder, tau
from typing import Any, TypeAlias

import gymnasium
import numpy as np
from gymnasium import spaces
from gymnasium.core import RenderFrame
from numpy.typing import NDArray

from ocs_design.common.arrays import FloatArray
from ocs_design.common.errors import OcsError, UsageError
from ocs_design.common.files import AnyPath
from ocs_design.export.film import Take, film_model, render_takes
from ocs_design.report.text.console import Steps
from ocs_design.requirement.boundary import End
from ocs_design.requirement.maneuver import Maneuver
from ocs_design.requirement.specification import Specification
from ocs_design.simulation.metrics import measure
from ocs_design.simulation.piloted import PilotedFlight
from ocs_design.simulation.run import Metrics
from ocs_design.simulation.verdict import landing_attitude
from ocs_design.workflows.flying import read_flights

Observation: TypeAlias = NDArray[np.float32]

BOUND = 10.0
"""Bound on normalised observations; in flights that can be judged they stay below 4."""

SAMPLES = 2**31
"""Number of samples from which an episode draws one."""


class OcsFlight(gymnasium.Env[Observation, Observation]):
    """A flight from lift-off, or from the push, to its end some time after touchdown.

    Observation with n wheels, as the sensors measure it: the vertical in B (3), the trunk's rate in
    half turns per flight (3), the wheels' speeds over their top speed (n), roll, pitch and heading
    left to turn in half turns (3, zero where free), the share of the flight time that is left, and
    whether anything touches the ground; shape (11 + n,).

    Action: torque of each motor over the most that it can give at its speed, -1..1, shape (n,).
    The legs hold their posture or follow their plans, as under the law.

    Reward: at each step in the air, the decrease of the angle left to turn, in half turns; at the
    end, one each for a pass, a level touchdown and standing.

    Attributes:
        metrics: figures of the last flight that ended; None: it became unstable, or none has ended.
    """

    metadata: dict[str, Any] = {"render_modes": ["rgb_array", "rgb_array_list"], "render_fps": 200}  # noqa: RUF012

    def __init__(
        self,
        design: AnyPath = "design.json",
        *,
        maneuver: str | None = None,
        randomise: bool = True,
        robot_file: AnyPath | None = None,
        render_mode: str | None = None,
    ) -> None:
        """Environment of a design.

        Args:
            design: its folder, or its `design.json`.
            maneuver: one of the design's own; None: each episode draws one.
            randomise: whether each episode draws a sampled robot; otherwise the robot is as
                designed, with perfect sensors and drives.
            robot_file: file of the robot, if it has moved.
            render_mode: `rgb_array`, `rgb_array_list` or None. OpenGL runs in a process of its own,
                which takes a second to start; a list is rendered in one go.

        Raises:
            OcsError: the design or its robot cannot be read, its flights cannot be judged, or it
                has no motor.
            UsageError: it has no such maneuver.
        """
        flights = read_flights(design, Specification(), robot_file=robot_file)
        # The record says what the legs can bear, unless the design was never flown.
        runs = flights.design.validation or flights.fly(Steps())
        self._campaign = flights.campaign(runs)
        names = [flight.maneuver.name for flight in self._campaign.flights]
        if maneuver is not None and maneuver not in names:
            raise UsageError(f"the design has no maneuver {maneuver!r}", hint=f"it has {names}")
        self._names = names if maneuver is None else [maneuver]
        self._top_speed = flights.device.motor.top_speed
        if flights.design.selection is None or not np.isfinite(self._top_speed):
            raise OcsError(
                f"{flights.path}: no motor was selected, so actions have no scale",
                hint="size it with a motor",
            )
        self._flights, self._randomise, self.render_mode = flights, randomise, render_mode
        self._period = flights.control.period
        self.metadata = {**self.metadata, "render_fps": round(1.0 / self._period)}
        count = len(flights.device.modules)
        self.action_space = spaces.Box(-1.0, 1.0, (count,), np.float32)
        self.observation_space = spaces.Box(-BOUND, BOUND, (11 + count,), np.float32)
        self.metrics: Metrics | None = None
        self._pilot: PilotedFlight | None = None
        self._models: dict[str, Any] = {}

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Observation, dict[str, Any]]:
        """Begin a flight.

        Args:
            seed: of the random draws of episodes.
            options: `maneuver`, a name; `sample`, as in `ocs-design validate --sample`.

        Raises:
            UsageError: an option is unknown, or has a wrong value.
        """
        super().reset(seed=seed)
        given = options or {}
        if unknown := sorted(given.keys() - {"maneuver", "sample"}):
            raise UsageError(
                f"reset has no option {unknown[0]!r}",
                hint="it has 'maneuver' and 'sample'",
            )
        chosen = self._names[int(self.np_random.integers(len(self._names)))]
        sample = int(self.np_random.integers(SAMPLES))
        name, sample = given.get("maneuver", chosen), given.get("sample", sample)
        names = [flight.maneuver.name for flight in self._campaign.flights]
        if name not in names:
            raise UsageError(f"the design has no maneuver {name!r}", hint=f"it has {names}")
        if not isinstance(sample, int | np.integer) or sample < 0:
            raise UsageError(f"the sample is {sample!r}, not a whole number >= 0")
        sample, self._number, hold = int(sample), names.index(name), self._campaign.hold
        flight = self._campaign.flights[self._number]
        self._world = flight.world
        if self._randomise:
            self._world = self._campaign.sampled_world(self._campaign.sample(sample), self._number)
        self._pilot = PilotedFlight(self._world, hold)
        self._pitch, self._landed = 0.0, False
        self._poses = [self._pilot.pose]
        observed = self._observed()
        self._angle_left = float(np.linalg.norm(self._left))
        info = {"maneuver": name, "sample": sample if self._randomise else None}
        return observed, {**info, "law": self._law_action()}

    def step(self, action: Observation) -> tuple[Observation, float, bool, bool, dict[str, Any]]:
        """Fly one control step; `info["law"]` is the action that the law would take next.

        At the end `info` has the verdict: `passed`, `level`, `stands` and `reason`.

        Raises:
            UsageError: the action has another shape, or a NaN.
        """
        pilot = self._flying()
        low, high = pilot.readings.lowest, pilot.readings.highest
        share = np.clip(np.asarray(action, dtype=np.float64), -1.0, 1.0)
        if share.shape != self.action_space.shape or not np.isfinite(share).all():
            raise UsageError(f"an action must fit {self.action_space}, not {action}")
        if not pilot.ended:
            pilot.fly(np.where(share < 0.0, -share * low, share * high))
        if self.render_mode is not None:
            self._poses.append(pilot.pose)
        if pilot.ended:
            self.metrics = measure(pilot.recording(), 0, self._world)
            verdict = self._campaign.judged(self.metrics, self._number)
            judged = {name: getattr(verdict, name) for name in ("passed", "level", "stands")}
            reward = float(sum(value is True for value in judged.values()))
            return self._last, reward, True, False, {**judged, "reason": verdict.reason}
        observed, reward = self._observed(), 0.0
        self._landed |= pilot.in_contact and not self._maneuver.on_feet
        if not self._landed:
            angle_left = float(np.linalg.norm(self._left))
            reward, self._angle_left = self._angle_left - angle_left, angle_left
        return observed, reward, False, False, {"law": self._law_action()}

    def render(self) -> RenderFrame | list[RenderFrame] | None:
        """Picture of the robot, shape (height, width, 3), or list since `reset` or the last call.

        Raises:
            MissingToolError: OpenGL does not work here.
        """
        self._flying()
        if self.render_mode is None:
            return None
        name, flights = self._maneuver.name, self._flights
        if name not in self._models:
            device = flights.device.as_flown(self._maneuver)
            self._models[name] = film_model(flights.robot, device, ocs=True)
        as_list = self.render_mode == "rgb_array_list"
        poses = self._poses if as_list else self._poses[-1:]
        (pictures,) = render_takes([Take(self._models[name], np.stack(poses))])
        if as_list:
            self._poses = self._poses[-1:]
        frames: list[RenderFrame] = list(pictures)
        return frames if as_list else frames[0]

    @property
    def _maneuver(self) -> Maneuver:
        return self._campaign.flights[self._number].maneuver

    def _flying(self) -> PilotedFlight:
        if self._pilot is None:
            raise gymnasium.error.ResetNeeded("call reset() first")
        return self._pilot

    def _observed(self) -> Observation:
        """Observation now; keeps it, and the angles left to turn [half turns]."""
        pilot, world = self._flying(), self._world
        readings = pilot.readings
        time = 1.0 - pilot.steps_since_lift_off * self._period / world.flight_time
        x, y, z = readings.vertical
        pitch = np.arctan2(-x, z)
        self._pitch += remainder(pitch - self._pitch, tau)
        roll = np.arcsin(np.clip(y, -1.0, 1.0))
        left = self._goal() - (roll, self._pitch, readings.heading)
        left[2] = remainder(left[2], tau)
        self._left = np.nan_to_num(left / np.pi)
        rate = readings.rate * world.flight_time / np.pi
        spin = readings.wheel_speed / self._top_speed
        others = np.array([time, float(pilot.in_contact)])
        observation = np.concatenate([readings.vertical, rate, spin, self._left, others])
        last: Observation = np.clip(observation, -BOUND, BOUND).astype(np.float32)
        self._last = last
        return last

    def _goal(self) -> FloatArray:
        """Target roll, pitch with whole turns, and heading at touchdown [rad]; NaN: free."""
        maneuver, turn = self._maneuver, self._world.turn
        roll, pitch = turn.end * turn.axis[:2]
        if not maneuver.heading_matters:
            return np.array([roll, pitch, np.nan])
        if maneuver.end == End.AT_REST:
            return np.full(3, np.nan)
        roll, last, heading = landing_attitude(maneuver)
        pitch = last + tau * round((pitch - last) / tau)
        return np.array([roll, pitch, np.nan if heading is None else heading])

    def _law_action(self) -> FloatArray:
        """Action that the wheel law would take, shape (n,)."""
        readings = self._flying().readings
        torque = readings.law_torque
        limit = np.where(torque < 0.0, -readings.lowest, readings.highest)
        return np.divide(torque, limit, out=np.zeros_like(torque), where=limit > 0.0)
