"""MuJoCo Warp as the physics of campaigns: all worlds at once on a GPU, in single precision.

Models go to the device before the first step; arrays that differ between them have a row for each
world. States and commands follow at every control step, and the law stays on the CPU.
"""

from collections.abc import Sequence
from copy import copy
from dataclasses import fields
from functools import partial
from importlib import import_module
from importlib.metadata import version
from types import ModuleType
from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray

from ocs_design.common.arrays import FloatArray
from ocs_design.common.errors import MissingToolError, OcsError, extra_command
from ocs_design.simulation.engine import Engine
from ocs_design.simulation.world import ANCHOR

SINGLE_GATE = 1e-4
"""Largest relative momentum error of a flight in single precision that is judged at all: 0.04 deg
in a whole turn."""

_MOST_DENSE_DOFS = 60
"""Most degrees of freedom for which MuJoCo Warp supports a dense Jacobian."""

_CONTACTS_PER_GEOM = 4
"""Most contacts of a geom with a plane."""

_IRRELEVANT_FIELDS = {"disableflags", "dof_length"}
"""Fields that may differ: a flag that is cleared for all, and a length used only for sleeping."""

_PUSHED = mujoco.mjtState.mjSTATE_XFRC_APPLIED.value


def warp_engine(device: str | None = None) -> Engine:
    """MuJoCo Warp on a device, by Warp's name for it; None: the first GPU.

    Raises:
        MissingToolError: it is not installed, or there is no GPU.
    """
    try:
        # Before the import below: Warp reports on standard output what it compiles.
        warp = import_module("warp")
        warp.config.log_level = warp.LOG_WARNING
        simulator = import_module("mujoco_warp")
    except ImportError as error:
        raise MissingToolError(
            "--engine warp needs MuJoCo Warp, which is not installed", hint=extra_command("gpu")
        ) from error
    if device is None:
        if not warp.is_cuda_available():
            raise MissingToolError(
                "--engine warp needs a CUDA device; none was found", hint="leave --engine out"
            )
        device = "cuda:0"
    return Engine(
        name=f"mujoco-warp {version('mujoco-warp')}",
        gate=SINGLE_GATE,
        physics=partial(WarpPhysics, warp, simulator, device),
    )


class WarpPhysics:
    """Worlds on a device; see `Physics`."""

    def __init__(self, warp: ModuleType, simulator: ModuleType, device: str) -> None:
        self._warp, self._simulator, self._device = warp, simulator, device
        # Set with the first worlds: the host's model, the device's model, and the device's state.
        self._first: Any = None
        self._model: Any = None
        self._data: Any = None

    def __enter__(self) -> "WarpPhysics":
        return self

    def __exit__(self, *_raised: object) -> None:
        self._model = self._data = None

    def rollout(
        self,
        model: Sequence[mujoco.MjModel],
        data: Sequence[mujoco.MjData],  # noqa: ARG002 - MuJoCo's own
        initial_state: FloatArray,
        control: FloatArray,
        *,
        control_spec: int,
        skip_checks: bool,  # noqa: ARG002 - MuJoCo's own
        nstep: int,
        state: FloatArray,
        sensordata: FloatArray,
    ) -> None:
        """Step the first n worlds; see `Physics.rollout`."""
        with self._warp.ScopedDevice(self._device):
            if self._model is None:
                self._put(model)
            if self._data is None or self._data.nworld != len(model):
                contacts, rows = buffer_sizes(self._first)
                self._data = self._simulator.make_data(
                    self._first, nworld=len(model), nconmax=contacts, njmax=rows
                )
            # Set the states of the worlds, and clear everything left from earlier steps.
            first = self._first
            qpos, qvel = np.split(initial_state[:, 1 : 1 + first.nq + first.nv], [first.nq], axis=1)
            self._data.qpos.assign(_single(qpos))
            self._data.qvel.assign(_single(qvel))
            self._data.qacc_warmstart.zero_()
            self._data.xfrc_applied.zero_()
            self._step(control, bool(control_spec & _PUSHED), nstep, state, sensordata)
        # Time computed exactly: the sum of the steps in single precision is not exact.
        steps = np.arange(1, nstep + 1) * model[0].opt.timestep
        state[..., 0] = initial_state[:, :1] + steps

    def _put(self, models: Sequence[mujoco.MjModel]) -> None:
        """Copy the models to the device, with equal arrays only once.

        Raises:
            OcsError: MuJoCo Warp cannot simulate them.
        """
        if mujoco.mj_name2id(models[0], mujoco.mjtObj.mjOBJ_BODY, ANCHOR) >= 0:
            # Added to an anchor of 1e7 times its mass, a robot's mass vanishes in seven digits.
            raise OcsError(
                "--engine warp: maneuvers about a pivot need double precision",
                hint="leave --engine out",
            )
        first = copy(models[0])
        # Warp never resets a state that is not finite, and does not know this flag.
        first.opt.disableflags &= ~int(mujoco.mjtDisableBit.mjDSBL_AUTORESET)
        if first.nv > _MOST_DENSE_DOFS:
            first.opt.jacobian = mujoco.mjtJacobian.mjJAC_AUTO
        try:
            put = self._simulator.put_model(first)
            self._give_each_world_its_row(put, [first, *models[1:]])
            self._give_each_world_its_row(
                put.opt, [first.opt, *(model.opt for model in models[1:])]
            )
        except (NotImplementedError, ValueError) as error:
            raise OcsError(
                f"--engine warp: MuJoCo Warp cannot simulate these flights: {error}",
                hint="leave --engine out",
            ) from error
        # Contacts and sums in the same order, whichever worlds run together.
        put.opt.deterministic = int(self._simulator.DeterminismType.ALL)
        self._first, self._model = first, put

    def _give_each_world_its_row(self, put: Any, sources: Sequence[Any]) -> None:  # noqa: ANN401 - optional
        """Replace every array of `put` in which sources differ by one with a row for each source.

        Raises:
            ValueError: sources differ in a field that all worlds share.
        """
        for field in fields(put):
            values: list[Any] = [getattr(source, field.name, None) for source in sources]
            if field.name in _IRRELEVANT_FIELDS or not isinstance(
                values[0], np.ndarray | float | int
            ):
                continue
            if all(np.array_equal(values[0], value) for value in values[1:]):
                continue
            if getattr(field.type, "shape", (0,))[0] != "*":
                raise ValueError(f"they differ in {field.name}, which all worlds share")
            shared = getattr(put, field.name)
            one = shared.numpy()[0]
            rows = np.stack(values).astype(one.dtype).reshape(len(sources), *one.shape)
            setattr(put, field.name, self._warp.array(rows, dtype=shared.dtype))

    def _step(
        self, control: FloatArray, pushed: bool, nstep: int, state: FloatArray, sensed: FloatArray
    ) -> None:
        """Step all worlds; if `pushed`, wrenches follow the actuators' commands in `control`."""
        warp, data, first = self._warp, self._data, self._first
        commands = warp.array(_single(control[..., : first.nu].swapaxes(0, 1)))
        wrenches = None
        if pushed:
            wrenches = control[..., first.nu :].reshape(len(control), nstep, first.nbody, 6)
            wrenches = warp.array(_single(wrenches.swapaxes(0, 1)), dtype=warp.spatial_vector)
        count = len(control)
        positions = warp.empty((nstep, count, first.nq), dtype=float)
        speeds = warp.empty((nstep, count, first.nv), dtype=float)
        sensors = warp.empty((nstep, count, first.nsensordata), dtype=float)
        for step in range(nstep):
            warp.copy(data.ctrl, commands[step])
            if wrenches is not None:
                warp.copy(data.xfrc_applied, wrenches[step])
            self._simulator.step(self._model, data)
            warp.copy(positions[step], data.qpos)
            warp.copy(speeds[step], data.qvel)
            warp.copy(sensors[step], data.sensordata)
        state[..., 1 : 1 + first.nq] = positions.numpy().swapaxes(0, 1)
        state[..., 1 + first.nq :] = speeds.numpy().swapaxes(0, 1)
        sensed[:] = sensors.numpy().swapaxes(0, 1)


def buffer_sizes(model: mujoco.MjModel) -> tuple[int, int]:
    """Most floor contacts of a scene, and most rows of its constraints."""
    collides = (model.geom_contype | model.geom_conaffinity) != 0
    contacts = _CONTACTS_PER_GEOM * int(np.count_nonzero(collides & (model.geom_bodyid > 0)))
    # A friction pyramid has two edges for each of its directions.
    widest = max(1, 2 * (int(model.geom_condim.max()) - 1))
    others = model.nv + model.njnt + 6 * model.neq + 2 * model.ntendon
    return max(contacts, 1), widest * contacts + others


def _single(values: FloatArray) -> NDArray[np.float32]:
    return np.ascontiguousarray(values, dtype=np.float32)
