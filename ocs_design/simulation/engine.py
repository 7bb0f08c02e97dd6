"""What computes the steps of the physics between two control instants."""

from collections.abc import Callable, Sequence
from contextlib import AbstractContextManager
from dataclasses import dataclass
from enum import StrEnum
from typing import Protocol

import mujoco

from ocs_design.common.arrays import FloatArray


class EngineName(StrEnum):
    """What may compute the physics of samples, by the word for it."""

    MUJOCO = "mujoco"
    WARP = "warp"


class Physics(Protocol):
    """Takes many worlds through the steps of a control step, as `mujoco.rollout.Rollout` does."""

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
        """Step the first n worlds, and write what comes of it into `state` and `sensordata`.

        These have shape (n, nstep, ...), after each step and at its start. `control` holds what the
        bits of `control_spec` say, the rest is zero. `data` is to work with, one for each thread.
        """


@dataclass(frozen=True, eq=False)
class Engine:
    """Physics in place of MuJoCo on the processors.

    Attributes:
        name: with its version, by which campaigns are told apart.
        gate: largest relative momentum error of a flight that is judged at all.
        physics: of one batch, whose worlds come with the first call, and leave from the end only.
    """

    name: str
    gate: float
    physics: Callable[[], AbstractContextManager[Physics]]
