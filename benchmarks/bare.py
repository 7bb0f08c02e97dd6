"""The least that a program of this kind must pay: the imports, and the physics on one thread.

    python benchmarks/bare.py FOLDER

FOLDER holds one model `*.mjb` and its start `*.npz` for each run; see `size.py`.
"""

import sys
from pathlib import Path

import cvxpy  # noqa: F401  its import is what is measured
import mujoco
import numpy
import trimesh  # noqa: F401  its import is what is measured


def main() -> None:
    for path in sorted(Path(sys.argv[1]).glob("*.mjb")):
        model = mujoco.MjModel.from_binary_path(str(path))
        data = mujoco.MjData(model)
        start = numpy.load(path.with_suffix(".npz"))
        data.qpos[:], data.qvel[:], data.ctrl[:] = start["qpos"], start["qvel"], start["ctrl"]
        mujoco.mj_step(model, data, int(start["steps"]))


if __name__ == "__main__":
    main()
