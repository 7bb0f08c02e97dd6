"""Mass, centre of mass and inertia with all joints held, as MuJoCo and Pinocchio have them."""

import numpy as np
import pinocchio as pin
import pytest

from ocs_design.robot.mass import MassProperties, combine


def mujoco_mass_properties(model, data, base=None, bodies=slice(1, None)):
    """Of these bodies where they are, in the frame of one of them or in the world's."""
    axes = data.ximat[bodies].reshape(-1, 3, 3)
    own = axes @ (model.body_inertia[bodies, :, None] * axes.transpose(0, 2, 1))
    whole = combine(map(MassProperties, model.body_mass[bodies], data.xipos[bodies], own))
    if base is None:
        return whole
    turn = data.body(base).xmat.reshape(3, 3).T
    return whole.moved(turn, -turn @ data.body(base).xpos)


def pinocchio_mass_properties(model, q, base=None):
    """Of the whole in a configuration, in the frame of a link or in the world's."""
    data = model.createData()
    pin.ccrba(model, data, q, np.zeros(model.nv))
    pin.updateFramePlacements(model, data)
    whole = MassProperties(data.Ig.mass, data.com[0], data.Ig.inertia)
    if base is None:
        return whole
    frame = data.oMf[model.getFrameId(base, pin.BODY)].inverse()
    return whole.moved(frame.rotation, frame.translation)


def assert_same_mass_properties(one, other, relative=1e-12):
    """Lengths relative to the other's radius of gyration, moments to its largest one."""
    assert one.mass == pytest.approx(other.mass, rel=relative)
    size = np.sqrt(np.trace(other.inertia) / other.mass)
    np.testing.assert_allclose(one.com, other.com, rtol=0.0, atol=relative * size)
    largest = np.abs(other.inertia).max()
    np.testing.assert_allclose(one.inertia, other.inertia, rtol=0.0, atol=relative * largest)
