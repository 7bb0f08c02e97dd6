"""The least that a program of this kind must pay: the imports, and the physics on one thread.

python benchmarks/bare.py MODEL.xml STEPS
"""

import sys

import cvxpy  # noqa: F401  its import is what is measured
import mujoco
import numpy  # noqa: F401  its import is what is measured
import trimesh  # noqa: F401  its import is what is measured

TIME_STEP = 1e-3


def main() -> None:
    model = mujoco.MjModel.from_xml_path(sys.argv[1])
    model.opt.timestep = TIME_STEP
    model.opt.integrator = mujoco.mjtIntegrator.mjINT_RK4
    model.opt.jacobian = mujoco.mjtJacobian.mjJAC_DENSE
    data = mujoco.MjData(model)
    mujoco.mj_step(model, data, int(sys.argv[2]))


if __name__ == "__main__":
    main()
