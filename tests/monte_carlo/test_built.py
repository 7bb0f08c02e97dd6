"""A built robot against one that MuJoCo compiles from the same figures."""

from dataclasses import replace

import mujoco
import numpy as np
import pytest
from campaigns import NO_UNCERTAINTY, short_campaign
from scipy.spatial.transform import Rotation
from wheels import driven_device, layout_device, paper_device

from ocs_design.device.layout import Layout, LayoutName
from ocs_design.requirement.uncertainty import Constant, UncertaintySection
from ocs_design.simulation.imperfections import ImperfectDrives
from ocs_design.simulation.motor_limits import USED_SHARE, MotorLimits
from ocs_design.simulation.scene import Wheels, compile_scene, robot_scene
from ocs_design.simulation.simulate import simulate
from ocs_design.simulation.wheel_law import Allocation, Gains, WheelLaw

UP = (0.0, 0.0, 1.0)


def drawn(robot, device=None, **specified):
    """World as designed, and as built with these errors and no others."""
    given = {**NO_UNCERTAINTY, **{name: Constant(value) for name, value in specified.items()}}
    campaign = short_campaign(robot, UncertaintySection(**given), device=device, drop_only=True)
    world = campaign.flights[0].world
    return world, campaign.built(campaign.sample(0), 0)


def accelerations(model):
    """In some state of motion."""
    data, rng = mujoco.MjData(model), np.random.default_rng(0)
    data.qpos[:] = data.qpos + 0.1 * rng.normal(size=model.nq)
    data.qvel[:] = rng.normal(size=model.nv)
    data.qpos[2] = 5.0
    mujoco.mj_normalizeQuat(model, data.qpos)
    mujoco.mj_forward(model, data)
    return data.qacc.copy()


def assert_moves_as_compiled(robot, built, designed, device, change=lambda scene: None, least=1e-4):
    """As the scene with this device and this change, and otherwise than as designed."""
    scene = robot_scene(robot)
    change(scene)
    model = compile_scene(scene, robot, device, Wheels.ACTIVE, 9.81)
    # Gains of the legs follow from the masses as designed.
    for gains in ("actuator_gainprm", "actuator_biasprm", "dof_damping"):
        getattr(model, gains)[:] = getattr(designed.model, gains)
    mujoco.mj_setConst(model, mujoco.MjData(model))
    expected = accelerations(model)
    assert np.abs(expected - accelerations(designed.model)).max() > least
    np.testing.assert_allclose(accelerations(built.model), expected, rtol=1e-9, atol=1e-9)


def scale_all(scene):
    for body in scene.bodies[1:]:
        body.mass *= 1.1
        body.inertia = 1.1 * np.asarray(body.inertia)


def shift_trunk(scene):
    trunk = scene.body("base_link")
    trunk.ipos = np.asarray(trunk.ipos) + np.array([0.01, 0.01, 0.01])


@pytest.mark.parametrize(
    ("specified", "change"), [({"mass_error": 0.1}, scale_all), ({"com_error": 0.01}, shift_trunk)]
)
def test_it_moves_as_one_that_is_compiled_so(solo12, specified, change):
    world, robot = drawn(solo12, **specified)
    assert_moves_as_compiled(solo12, robot, world, driven_device(), change, least=1e-3)


def test_wheels_that_are_both_off_are_a_device_at_another_incidence(solo12):
    error = np.radians(2.0)
    device = paper_device()
    world, robot = drawn(solo12, device, incidence_error=error)
    turned = device.at_incidence(device.incidence + error)
    assert_moves_as_compiled(solo12, robot, world, turned)


@pytest.mark.parametrize(
    ("name", "feet"),
    [
        ("single", [UP]),
        ("triad", [UP, UP, UP]),
        # The upright wheel's module lies on its side, its foot towards the front.
        ("orthogonal", [UP, UP, (1.0, 0.0, 0.0)]),
    ],
)
def test_modules_that_are_off_are_turned_on_their_feet(solo12, name, feet):
    """Clockwise as seen from above, where they stand; what carries a wheel stays where it was."""
    device = replace(layout_device(Layout(LayoutName(name))), carrier=paper_device().carrier)
    error = np.radians(2.0)
    world, robot = drawn(solo12, device, incidence_error=error)
    turns = Rotation.from_rotvec(-error * np.array(feet)).as_matrix()
    modules = [
        replace(module, axis=turn @ module.axis)
        for module, turn in zip(device.modules, turns, strict=True)
    ]
    turned = replace(device, modules=tuple(modules))
    assert_moves_as_compiled(solo12, robot, world, turned)


def test_second_moments_of_mass_grow_by_what_is_drawn(solo12):
    """About the trunk's centre of mass: `S = tr(I)/2 - I` scales with 1 + e in every direction."""
    world, robot = drawn(solo12, inertia_error=0.2)
    trunk = world.addresses.trunk

    def inertia(model):
        axes = np.empty(9)
        mujoco.mju_quat2Mat(axes, model.body_iquat[trunk])
        axes = axes.reshape(3, 3)
        return axes @ np.diag(model.body_inertia[trunk]) @ axes.T

    np.testing.assert_allclose(inertia(robot.model), 1.2 * inertia(world.model), rtol=1e-12)
    assert robot.model.body_mass[trunk] == world.model.body_mass[trunk]


def test_an_inertia_stays_physical_however_far_it_is_off(solo12):
    campaign = short_campaign(solo12, drop_only=True)
    world = campaign.flights[0].world
    for seed in range(20):
        errors = np.random.default_rng(seed).uniform(-0.9, 0.9, 3)
        sample = campaign.sample(0)
        values = sample.values.copy()
        values[1:4] = errors
        own = campaign.built(replace(sample, values=values), 0).model
        low, middle, high = np.sort(own.body_inertia[world.addresses.trunk])
        assert low > 0.0
        assert high <= (low + middle) * (1.0 + 1e-12)


def test_a_world_without_errors_flies_to_the_last_bit_as_designed(solo12):
    world, robot = drawn(solo12)
    designed, flown = simulate([world]), simulate([robot])
    for name in ("attitude", "rate", "wheel_speed", "wheel_torque", "com", "momentum"):
        np.testing.assert_array_equal(getattr(designed, name), getattr(flown, name))
    assert designed.wheel_torque.any()


def test_friction_takes_its_part_of_the_torque_once(solo12):
    """A wheel gets what the nominal motor gives, whose limits are without friction."""
    device, friction = driven_device(), 0.01
    rubbing = replace(device.motor, torque_constant=1.0, no_load_current=friction)
    device = replace(device, motor=rubbing)
    _, robot = drawn(solo12, device, coulomb_friction=friction)
    response, limits = robot.law.wheel_response, MotorLimits.of(rubbing)
    law = WheelLaw.of(robot.body, Gains(0.0, 0.0), limits, Allocation.PSEUDO_INVERSE)

    def given(speed):
        asked = np.copysign(9.0, speed)
        drives = ImperfectDrives(
            [robot.imperfections], response=response, instants=1, hold=5, step=1e-3
        )
        _, real = drives.applied_torque(0, robot.law.feasible_torque(asked, speed, 5e-3), speed)
        return real[0, 0], law.feasible_torque(asked, speed, 5e-3)[0]

    real, nominal = given(np.array([[10.0, -20.0]]))
    np.testing.assert_allclose(np.abs(nominal), device.motor.torque_limit)
    np.testing.assert_allclose(real, nominal, rtol=1e-12)
    # On the line as well, but for the speed that friction takes within the control step.
    real, nominal = given(0.9 * rubbing.no_load_speed * np.array([[1.0, -1.0]]))
    held = 1.0 - USED_SHARE * limits.line_slope / (limits.line_slope + 5e-3 * response.item())
    np.testing.assert_allclose(real, nominal - held * friction * np.sign(nominal), rtol=1e-9)


@pytest.mark.parametrize("period", [1e-3, 5e-3, 2e-2])
def test_a_push_off_leaves_the_rate_that_is_drawn(solo12, period):
    """By an impulse that the momentum balance knows; a drop has no push-off."""
    given = UncertaintySection(**{**NO_UNCERTAINTY, "takeoff_rate": Constant(0.1)})
    campaign = replace(short_campaign(solo12, given, until=0.09), hold=round(period / 1e-3))
    jump, drop = campaign.worlds(campaign.sample(0))
    assert len(drop.pushes) == 1
    flown = simulate([replace(jump, law=WheelLaw.off(2))], hold=campaign.hold)
    np.testing.assert_allclose(flown.rate[-1, 0, :2], 0.1, rtol=0.03)
    expected = jump.body.actuated_inertia[:, :2] @ [0.1, 0.1]
    np.testing.assert_allclose(flown.impulse[-1, 0], expected, rtol=1e-3, atol=1e-6)
    gained = flown.momentum[-1, 0] - flown.momentum[0, 0]
    np.testing.assert_allclose(gained, flown.impulse[-1, 0], atol=1e-9)


def test_data_that_others_have_worked_with_change_no_bit(solo12):
    """One sample after the other with the same data to work with, and each with its own."""
    campaign = short_campaign(solo12, UncertaintySection(), drop_only=True)
    scratch = mujoco.MjData(campaign.flights[0].world.model)
    for index in range(3):
        sample = campaign.sample(index)
        alone, shared = (campaign.built(sample, 0, own).model for own in (None, scratch))
        for name in dir(alone):
            found = getattr(alone, name)
            if isinstance(found, np.ndarray):
                np.testing.assert_array_equal(found, getattr(shared, name), err_msg=name)
