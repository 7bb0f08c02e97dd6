"""Sampled robots against models that MuJoCo compiles with the same deviations."""

from dataclasses import replace

import mujoco
import numpy as np
import pytest
from campaigns import NO_UNCERTAINTY, short_campaign
from scipy.spatial.transform import Rotation
from wheels import driven_device, layout_device, paper_device

from ocs_design.actuation.supply import Supply
from ocs_design.device.layout import Layout, LayoutName
from ocs_design.requirement.froude import Gains
from ocs_design.requirement.uncertainty import Constant, UncertaintySection
from ocs_design.simulation.imperfections import ImperfectDrives
from ocs_design.simulation.metrics import series_of
from ocs_design.simulation.motor_limits import USED_SHARE, MotorLimits
from ocs_design.simulation.scene import Wheels, compile_scene, robot_scene
from ocs_design.simulation.simulate import simulate
from ocs_design.simulation.wheel_law import Allocation, WheelLaw

UP = (0.0, 0.0, 1.0)


def designed_and_sampled(robot, device=None, **errors):
    """The world as designed, and as sampled with these errors and no others."""
    distributions = {**NO_UNCERTAINTY, **{name: Constant(value) for name, value in errors.items()}}
    campaign = short_campaign(
        robot, UncertaintySection(**distributions), device=device, drop_only=True
    )
    world = campaign.flights[0].world
    return world, campaign.sampled_world(campaign.sample(0), 0)


def accelerations(model):
    """Accelerations in a random state of motion."""
    data, rng = mujoco.MjData(model), np.random.default_rng(0)
    data.qpos[:] = data.qpos + 0.1 * rng.normal(size=model.nq)
    data.qvel[:] = rng.normal(size=model.nv)
    data.qpos[2] = 5.0
    mujoco.mj_normalizeQuat(model, data.qpos)
    mujoco.mj_forward(model, data)
    return data.qacc.copy()


def assert_same_accelerations(
    robot, built, designed, device, change=lambda scene: None, least=1e-4
):
    """Accelerations are those of a compiled scene with this device and change, unlike designed."""
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
def test_errors_of_mass_and_centre_act_as_in_a_compiled_model(solo12, specified, change):
    world, robot = designed_and_sampled(solo12, **specified)
    assert_same_accelerations(solo12, robot, world, driven_device(), change, least=1e-3)


def test_equal_incidence_errors_are_another_incidence(solo12):
    error = np.radians(2.0)
    device = paper_device()
    world, robot = designed_and_sampled(solo12, device, incidence_error=error)
    at_other_incidence = device.at_incidence(device.incidence + error)
    assert_same_accelerations(solo12, robot, world, at_other_incidence)


@pytest.mark.parametrize(
    ("name", "feet"),
    [
        ("single", [UP]),
        ("triad", [UP, UP, UP]),
        # The module of the wheel about z lies on its side, with its foot towards the front.
        ("orthogonal", [UP, UP, (1.0, 0.0, 0.0)]),
    ],
)
def test_incidence_errors_rotate_modules_on_their_feet(solo12, name, feet):
    """Clockwise as seen from above; the carriers stay in their places."""
    device = replace(layout_device(Layout(LayoutName(name))), carrier=paper_device().carrier)
    error = np.radians(2.0)
    world, robot = designed_and_sampled(solo12, device, incidence_error=error)
    rotations = Rotation.from_rotvec(-error * np.array(feet)).as_matrix()
    modules = [
        replace(module, axis=rotation @ module.axis)
        for module, rotation in zip(device.modules, rotations, strict=True)
    ]
    rotated = replace(device, modules=tuple(modules))
    assert_same_accelerations(solo12, robot, world, rotated)


def test_inertia_errors_scale_the_second_moments_of_mass(solo12):
    """About the trunk's centre of mass: `S = tr(I)/2 - I` scales with 1 + e in every direction."""
    world, robot = designed_and_sampled(solo12, inertia_error=0.2)
    trunk = world.addresses.trunk

    def inertia(model):
        axes = np.empty(9)
        mujoco.mju_quat2Mat(axes, model.body_iquat[trunk])
        axes = axes.reshape(3, 3)
        return axes @ np.diag(model.body_inertia[trunk]) @ axes.T

    np.testing.assert_allclose(inertia(robot.model), 1.2 * inertia(world.model), rtol=1e-12)
    assert robot.model.body_mass[trunk] == world.model.body_mass[trunk]


def test_inertias_stay_physical_for_large_errors(solo12):
    campaign = short_campaign(solo12, drop_only=True)
    world = campaign.flights[0].world
    for seed in range(20):
        errors = np.random.default_rng(seed).uniform(-0.9, 0.9, 3)
        sample = campaign.sample(0)
        values = sample.values.copy()
        values[1:4] = errors
        model = campaign.sampled_world(replace(sample, values=values), 0).model
        low, middle, high = np.sort(model.body_inertia[world.addresses.trunk])
        assert low > 0.0
        assert high <= (low + middle) * (1.0 + 1e-12)


def test_a_sample_without_errors_flies_exactly_as_designed(solo12):
    world, robot = designed_and_sampled(solo12)
    designed, sampled = simulate([world]), simulate([robot])
    for name in ("attitude", "rate", "wheel_speed", "wheel_torque", "com", "momentum"):
        np.testing.assert_array_equal(getattr(designed, name), getattr(sampled, name))
    assert designed.wheel_torque.any()


def test_friction_is_subtracted_once(solo12):
    """A wheel gets the torque of the nominal motor, whose limits already include friction."""
    device, friction = driven_device(), 0.01
    with_friction = replace(device.motor, torque_constant=1.0, no_load_current=friction)
    device = replace(device, motor=with_friction)
    _, robot = designed_and_sampled(solo12, device, coulomb_friction=friction)
    response, limits = robot.law.wheel_response, MotorLimits.of(with_friction)
    law = WheelLaw.of(robot.body, Gains(0.0, 0.0), limits, Allocation.PSEUDO_INVERSE)

    def torques(speed):
        command = np.copysign(9.0, speed)
        drives = ImperfectDrives(
            [robot.imperfections], response=response, instants=1, hold=5, step=1e-3
        )
        _, real = drives.applied_torque(0, robot.law.feasible_torque(command, speed, 5e-3), speed)
        return real[0, 0], law.feasible_torque(command, speed, 5e-3)[0]

    real, nominal = torques(np.array([[10.0, -20.0]]))
    np.testing.assert_allclose(np.abs(nominal), device.motor.torque_limit)
    np.testing.assert_allclose(real, nominal, rtol=1e-12)
    # On the voltage line too, except for the speed lost by friction within the control step.
    real, nominal = torques(0.9 * with_friction.no_load_speed * np.array([[1.0, -1.0]]))
    share = 1.0 - USED_SHARE * limits.line_slope / (limits.line_slope + 5e-3 * response.item())
    np.testing.assert_allclose(real, nominal - share * friction * np.sign(nominal), rtol=1e-9)


def test_power_and_available_torque_of_a_sample_are_those_of_its_own_motors(solo12):
    """`R i^2 + tau W` at its own torque constant and resistance, over its own voltage."""
    constant, resistance, voltage = 0.036, 0.61, 24.0
    motor = replace(driven_device().motor, torque_constant=constant, resistance=resistance)
    device = replace(driven_device(), motor=motor, supply=Supply(voltage))
    errors = {"torque_constant": -0.05, "resistance": 0.2, "bus_voltage": 0.1}
    _, robot = designed_and_sampled(
        solo12, device, **{f"{name}_error": error for name, error in errors.items()}
    )
    series = series_of(simulate([robot]), 0, robot)
    k_t, R = 0.95 * constant, 1.2 * resistance
    ends = np.stack([series.wheel_speed[:-1], series.wheel_speed[1:]])
    torque = series.wheel_torque[:-1]
    power = (R * (torque / k_t) ** 2 + torque * ends).sum(axis=-1)
    largest = np.take_along_axis(power, np.abs(power).argmax(axis=0)[None], axis=0)[0]
    np.testing.assert_allclose(series.bus_power[:-1], largest, rtol=1e-9, atol=1e-9)
    np.testing.assert_allclose(series.bus_current, series.bus_power / (1.1 * voltage))
    assert series.bus_power.max() > 10.0
    np.testing.assert_allclose(series.torque_highest[0], 0.95 * motor.torque_limit)


@pytest.mark.parametrize("period", [1e-3, 5e-3, 2e-2])
def test_a_takeoff_rate_is_an_impulse_at_push_off(solo12, period):
    """The impulse is in the momentum balance; a drop has no push-off."""
    distributions = UncertaintySection(**{**NO_UNCERTAINTY, "takeoff_rate": Constant(0.1)})
    campaign = replace(short_campaign(solo12, distributions, until=0.09), hold=round(period / 1e-3))
    jump, drop = campaign.worlds(campaign.sample(0))
    assert len(drop.pushes) == 1
    recording = simulate([replace(jump, law=WheelLaw.off(2))], hold=campaign.hold)
    np.testing.assert_allclose(recording.rate[-1, 0, :2], 0.1, rtol=0.03)
    expected = jump.body.actuated_inertia[:, :2] @ [0.1, 0.1]
    np.testing.assert_allclose(recording.impulse[-1, 0], expected, rtol=1e-3, atol=1e-6)
    gained = recording.momentum[-1, 0] - recording.momentum[0, 0]
    np.testing.assert_allclose(gained, recording.impulse[-1, 0], atol=1e-9)
