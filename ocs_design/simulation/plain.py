"""MuJoCo's own settings in place of those that a robot's file has for its own simulations.

A model that was tuned for speed stops its solver after one iteration; one for learning clamps every
command to one; and a class of defaults of the file holds for whatever is added to it.
"""

from collections.abc import Iterable

import mujoco
import numpy as np

_OF_CONTACT = {"cone", "impratio"}
"""Options that say what friction is like."""

_OF_ACTUATOR = (
    *("gear", "gainprm", "biasprm", "dynprm", "dyntype", "actdim", "actearly", "delay", "nsample"),
    *("ctrllimited", "ctrlrange", "forcelimited", "forcerange", "actlimited", "actrange"),
    *("armature", "damping", "cranklength", "lengthrange", "inheritrange"),
)


def plain_options(spec: mujoco.MjSpec) -> None:
    """All options but those of contact as MuJoCo has them."""
    plain = mujoco.MjSpec().option
    _copy(plain, spec.option, (name for name in dir(plain) if name not in _OF_CONTACT))


def plain_actuator(actuator: "mujoco.MjsActuator") -> None:
    """Nothing of the file's defaults; type, transmission and names stay."""
    _copy(mujoco.MjSpec().add_actuator(), actuator, _OF_ACTUATOR)


def _copy(source: object, target: object, names: Iterable[str]) -> None:
    for name in names:
        value = getattr(source, name)
        if isinstance(value, np.ndarray):
            getattr(target, name)[:] = value
        elif not name.startswith("_") and not callable(value):
            setattr(target, name, value)
