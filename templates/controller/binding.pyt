"""The controller of @name in Python, by ctypes: `make` first."""

import ctypes
from collections.abc import Iterable
from pathlib import Path

WHEELS, PERIOD = @wheels, @period  # number; of the control steps [s]


class State(ctypes.Structure):
    """See @{name}_ocs_controller.h; SI."""

    _fields_ = [
        ("maneuver", ctypes.c_int),
        ("time", ctypes.c_double),
        ("ground_time", ctypes.c_double),
        ("attitude", ctypes.c_double * 4),
        ("rate", ctypes.c_double * 3),
        ("wheel_speed", ctypes.c_double * WHEELS),
    ]


class Controller:
    """The compiled library."""

    def __init__(self, library: Path | None = None) -> None:
        path = library or Path(__file__).resolve().with_name("lib@{name}_ocs_controller.so")
        if not path.exists():
            raise FileNotFoundError(f"{path}: run `make` beside {__file__} first")
        self._step = ctypes.CDLL(str(path)).ocs_step
        self._step.argtypes, self._step.restype = [ctypes.c_void_p, ctypes.c_void_p], None

    def step(
        self,
        maneuver: int,
        time: float,
        attitude: Iterable[float],
        rate: Iterable[float],
        wheel_speed: Iterable[float],
        ground_time: float = 0.0,
    ) -> list[float]:
        """Torque of each motor [N m] until the next step."""
        state = State(maneuver, time, ground_time, (*attitude,), (*rate,), (*wheel_speed,))
        command = (ctypes.c_double * WHEELS)()
        self._step(ctypes.byref(state), command)
        return list(command)
