"""Engines that compute the physics steps between two control instants."""

from collections.abc import Callable, Sequence
from contextlib import AbstractContextManager
from dataclasses import dataclass
from enum import StrEnum
from typing import Protocol

import mujoco

from ocs_design.common.arrays import FloatArray


class EngineName(StrEnum):
    """Physics engines for samples, by the name that users give."""

    MUJOCO = "mujoco"
    WARP = "warp"


class Physics(Protocol):
    """Steps many worlds through one control step, as `mujoco.rollout.Rollout` does."""

    def rollout(
        self,
        model: Sequence[mujoco.MjModel],
        data: Sequence[mujoco.MjData],
        initial_state: FloatArray,
        control: FloatArray,
        *,
        control_spec: int,
        skip_checks: bool,
        nstep: int,
        state: FloatArray,
        sensordata: FloatArray,
    ) -> object:
        """Step the first n worlds, and write the results into `state` and `sensordata`.

        These have shape (n, nstep, ...): states after each step, sensors at its start. `control`
        holds what the bits of `control_spec` name; the rest is zero. `data` is scratch memory, one
        for each thread.
        """


@dataclass(frozen=True, eq=False)
class Engine:
    """A physics engine other than MuJoCo on the CPU.

    Attributes:
        name: with its version, which tells campaigns apart.
        gate: largest relative momentum error of a flight that is judged at all.
        physics: makes the physics of one batch, whose worlds are all in the first call; later calls
            may only drop worlds from the end.
    """

    name: str
    gate: float
    physics: Callable[[], AbstractContextManager[Physics]]
