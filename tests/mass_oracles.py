"""Mass, centre of mass and inertia with all joints locked, by MuJoCo and Pinocchio."""

import numpy as np
import pinocchio as pin
import pytest

from ocs_design.robot.mass import MassProperties, combine


def mujoco_mass_properties(model, data, base=None, bodies=slice(1, None)):
    """Total of some bodies in the frame of the body `base`, or of the world."""
    axes = data.ximat[bodies].reshape(-1, 3, 3)
    own = axes @ (model.body_inertia[bodies, :, None] * axes.transpose(0, 2, 1))
    total = combine(map(MassProperties, model.body_mass[bodies], data.xipos[bodies], own))
    if base is None:
        return total
    rotation = data.body(base).xmat.reshape(3, 3).T
    return total.moved(rotation, -rotation @ data.body(base).xpos)


def pinocchio_mass_properties(model, q, base=None):
    """Total of a model in a configuration, in the frame of a link or of the world."""
    data = model.createData()
    pin.ccrba(model, data, q, np.zeros(model.nv))
    pin.updateFramePlacements(model, data)
    total = MassProperties(data.Ig.mass, data.com[0], data.Ig.inertia)
    if base is None:
        return total
    frame = data.oMf[model.getFrameId(base, pin.BODY)].inverse()
    return total.moved(frame.rotation, frame.translation)


def assert_same_mass_properties(one, other, relative=1e-12):
    """Compare lengths relative to the radius of gyration, moments relative to the largest."""
    assert one.mass == pytest.approx(other.mass, rel=relative)
    size = np.sqrt(np.trace(other.inertia) / other.mass)
    np.testing.assert_allclose(one.com, other.com, rtol=0.0, atol=relative * size)
    largest = np.abs(other.inertia).max()
    np.testing.assert_allclose(one.inertia, other.inertia, rtol=0.0, atol=relative * largest)
