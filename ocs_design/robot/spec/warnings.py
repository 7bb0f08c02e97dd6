"""MuJoCo's warnings about a model, as remarks.

By itself MuJoCo prints some of them and writes MUJOCO_LOG.TXT into the current folder; its
bindings make Python warnings of others.
"""

import warnings
from collections.abc import Iterator
from contextlib import contextmanager

import mujoco

from ocs_design.robot.remarks import Remarks


@contextmanager
def mujoco_warnings_to(remarks: Remarks) -> Iterator[None]:
    """Turn what MuJoCo warns of while parsing and compiling into remarks."""

    def tell(text: str) -> None:
        """Keep it on one line."""
        remarks.add(f"MuJoCo: {' '.join(text.split())}")

    before = mujoco.get_mju_user_warning()
    mujoco.set_mju_user_warning(tell)
    try:
        with warnings.catch_warnings(record=True) as told:
            warnings.simplefilter("always")
            yield
    finally:
        mujoco.set_mju_user_warning(before)
    for warning in told:
        tell(str(warning.message))
