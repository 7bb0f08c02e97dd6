"""Modes of a module on its foot and plate, against beams of finite elements."""

from dataclasses import replace
from itertools import pairwise
from math import pi

import numpy as np
import pytest
from built_devices import DEVICES

from ocs_design.device.device import Device, Module
from ocs_design.device.resonances import foot_frequency, resonances_of

SHEAR_OF_PETG, RIGID = 1.8e9 / 2.7, 1e16
"""Shear modulus with a Poisson's ratio of 0.35, and modulus of rigid parts [Pa]."""

ON_A_PLATE = DEVICES["on a plate"]


def beam(length, moduli, section):
    """Stiffness matrix of an Euler-Bernoulli beam with Saint-Venant torsion, shape (12, 12).

    Przemieniecki, Theory of Matrix Structural Analysis, section 5.6, without shear. Each end has
    three displacements and three rotations; the beam lies along the first axis.

    Args:
        moduli: Young's and shear modulus [Pa].
        section: Area, second moments about the second and third axis, torsion constant.
    """
    (young, shear), (area, second, third, torsion) = moduli, section
    matrix = np.zeros((12, 12))
    for dofs, rate in (([0, 6], young * area), ([3, 9], shear * torsion)):
        matrix[np.ix_(dofs, dofs)] = rate / length * np.array([[1.0, -1.0], [-1.0, 1.0]])
    for dofs, moment, arm in (([1, 5, 7, 11], third, length), ([2, 4, 8, 10], second, -length)):
        square = length**2
        bent = np.array(
            [
                [12.0, 6.0 * arm, -12.0, 6.0 * arm],
                [6.0 * arm, 4.0 * square, -6.0 * arm, 2.0 * square],
                [-12.0, -6.0 * arm, 12.0, -6.0 * arm],
                [6.0 * arm, 2.0 * square, -6.0 * arm, 4.0 * square],
            ]
        )
        matrix[np.ix_(dofs, dofs)] = young * moment / length**3 * bent
    return matrix


def rectangle(width, depth):
    """Area, second moments about the axes along width and depth, and torsion constant.

    K = w d^3 (1/3 - 64 d / (pi^5 w) sum over odd n of tanh(n pi w / 2 d) / n^5): Timoshenko and
    Goodier, Theory of Elasticity, section 109, for a depth below the width.
    """
    odd = np.arange(1, 41, 2)
    series = (np.tanh(odd * pi * width / (2.0 * depth)) / odd**5).sum()
    torsion = width * depth**3 * (1.0 / 3.0 - 64.0 * depth / (pi**5 * width) * series)
    return width * depth, width * depth**3 / 12.0, depth * width**3 / 12.0, torsion


def frequencies(device, *, rigid_plate=False):
    """First three modes of a module on its plate, which is clamped at the trunk's screws [Hz].

    Plate and stem of the foot are rows of beams, the base of the foot is rigid, and the module is a
    rigid body at the end.
    """
    plate, foot, axis = device.plate, device.foot, device.modules[0].axis
    up, forward = np.array([0.0, 0.0, 1.0]), np.cross(axis, [0.0, 0.0, 1.0])
    nodes, stiffnesses = [np.array([0.0, plate.support, 0.0])], []

    def add_beam(place, moduli, section, second_axis):
        """Add a beam; the second axis of the beam is the first axis of its section."""
        along = place - nodes[-1]
        length = np.linalg.norm(along)
        rotation = np.array([along / length, second_axis, np.cross(along / length, second_axis)])
        rotations = np.kron(np.eye(4), rotation)
        stiffnesses.append(rotations.T @ beam(length, moduli, section) @ rotations)
        nodes.append(place)

    edges = np.linspace(plate.support, plate.across, 101)
    for low, high in pairwise(edges):
        section = rectangle(plate.net_width(np.array([low + high]) / 2.0)[0], plate.thickness)
        moduli = (RIGID, RIGID) if rigid_plate else (69e9, 26e9)
        add_beam(np.array([0.0, high, 0.0]), moduli, section, np.array([1.0, 0.0, 0.0]))
    base = nodes[-1] + (plate.thickness / 2.0 + foot.base) * up
    add_beam(base, (RIGID, RIGID), (1e-3, 1e-6, 1e-6, 1e-6), forward)
    height = foot.wheel_height - foot.base
    for share in np.linspace(0.0, 1.0, 11)[1:]:
        section = rectangle(2.0 * foot.stem, float(foot.thickness))
        add_beam(base + share * height * up, (1.8e9, SHEAR_OF_PETG), section, forward)

    total_stiffness, mass = np.zeros((6 * len(nodes),) * 2), np.zeros((6 * len(nodes),) * 2)
    for index, stiffness in enumerate(stiffnesses):
        total_stiffness[6 * index : 6 * index + 12, 6 * index : 6 * index + 12] += stiffness
    wheel, carrier = device.flywheel, device.carrier
    inertia = carrier.inertia + wheel.transverse_inertia * np.diag([1.0, 0.0, 1.0])
    rotation = np.array([forward, axis, up])
    mass[-6:-3, -6:-3] = (wheel.mass + carrier.mass) * np.eye(3)
    mass[-3:, -3:] = rotation.T @ np.diag(np.diag(inertia)) @ rotation
    squares = np.linalg.eigvals(np.linalg.solve(total_stiffness[6:, 6:], mass[6:, 6:])).real
    return np.sort(1.0 / (2.0 * pi * np.sqrt(np.sort(squares)[-3:])))


def with_incidence(angle):
    """The device on a plate at another incidence [rad], without a speed limit."""
    axes = np.array([[np.sin(angle), np.cos(angle), 0.0], [-np.sin(angle), np.cos(angle), 0.0]])
    modules = (
        Module(module.name, axis, module.position)
        for module, axis in zip(ON_A_PLATE.modules, axes, strict=True)
    )
    drive = replace(ON_A_PLATE.motor, no_load_speed=1e5, speed_max=None)
    return replace(ON_A_PLATE, modules=tuple(modules), incidence=angle, motor=drive)


@pytest.mark.parametrize("angle", [0.0, 0.55, 1.2, pi / 2.0])
def test_modes_of_a_module_agree_with_beams(angle):
    """Adding squared periods gives a lower bound, which is close since the modes are far apart."""
    device = with_incidence(angle)
    sway, twist, _ = frequencies(device)
    modes = {mode.name: mode.frequency for mode in resonances_of(device)}
    assert modes["foot"] == pytest.approx(sway, rel=0.04)
    assert modes["twisted plate"] == pytest.approx(twist, rel=0.04)
    alone, _, _ = frequencies(device, rigid_plate=True)
    without_plate = replace(device, plate=None)
    assert foot_frequency(without_plate) == pytest.approx(alone, rel=0.03)
    # Without the compliance of the plate the frequency was too high.
    assert foot_frequency(without_plate) > 1.1 * sway


def test_the_plate_limits_the_gain_of_an_aluminium_foot():
    sized: Device = with_incidence(0.55)
    ratio_on_plate = foot_frequency(sized, 69e9) / foot_frequency(sized)
    without_plate = replace(sized, plate=None)
    ratio_alone = foot_frequency(without_plate, 69e9) / foot_frequency(without_plate)
    assert ratio_alone == pytest.approx((69e9 / 1.8e9) ** 0.5)
    assert 1.2 < ratio_on_plate < 0.7 * ratio_alone
