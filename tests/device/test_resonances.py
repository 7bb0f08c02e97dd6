"""Modes of a module on its foot and plate, against beams of finite elements."""

from dataclasses import replace
from itertools import pairwise
from math import pi

import numpy as np
import pytest
from built_devices import DEVICES

from ocs_design.device.device import Device, Module
from ocs_design.device.resonances import foot_frequency, resonances_of
from ocs_design.device.solids import foot_of

SHEAR_OF_PETG, RIGID = 1.8e9 / 2.7, 1e16
"""Shear modulus with a Poisson's ratio of 0.35, and what gives no way [Pa]."""

ON_A_PLATE = DEVICES["on a plate"]


def beam(length, moduli, section):
    """Stiffness of a beam of Euler, Bernoulli and Saint-Venant, shape (12, 12).

    Przemieniecki, Theory of Matrix Structural Analysis, section 5.6, without shear. Each end has
    three displacements and three rotations; the beam lies along the first axis.

    Args:
        moduli: of tension and shear.
        section: its area, second moments about the second and the third axis, and torsion constant.
    """
    (tension, shear), (area, second, third, torsion) = moduli, section
    found = np.zeros((12, 12))
    for dofs, rate in (([0, 6], tension * area), ([3, 9], shear * torsion)):
        found[np.ix_(dofs, dofs)] = rate / length * np.array([[1.0, -1.0], [-1.0, 1.0]])
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
        found[np.ix_(dofs, dofs)] = tension * moment / length**3 * bent
    return found


def rectangle(width, depth):
    """Area, second moments about the axes along width and depth, torsion constant by its series.

    K = w d^3 (1/3 - 64 d / (pi^5 w) sum over odd n of tanh(n pi w / 2 d) / n^5): Timoshenko and
    Goodier, Theory of Elasticity, section 109; the depth is the lesser.
    """
    odd = np.arange(1, 41, 2)
    series = (np.tanh(odd * pi * width / (2.0 * depth)) / odd**5).sum()
    torsion = width * depth**3 * (1.0 / 3.0 - 64.0 * depth / (pi**5 * width) * series)
    return width * depth, width * depth**3 / 12.0, depth * width**3 / 12.0, torsion


def frequencies(device, *, rigid_plate=False):
    """The first three modes of one module on its plate, clamped at the trunk's screws [Hz].

    The plate is a row of beams, the foot's base stands on its end, on it the stem as beams, and on
    those the module, a body.
    """
    plate, foot, axis = device.plate, foot_of(device), device.modules[0].axis
    up, forward = np.array([0.0, 0.0, 1.0]), np.cross(axis, [0.0, 0.0, 1.0])
    nodes, stiffnesses = [np.array([0.0, plate.support, 0.0])], []

    def to(place, moduli, section, second_axis):
        """One more beam, whose section's first axis is the second one of the beam."""
        along = place - nodes[-1]
        length = np.linalg.norm(along)
        turn = np.array([along / length, second_axis, np.cross(along / length, second_axis)])
        turns = np.kron(np.eye(4), turn)
        stiffnesses.append(turns.T @ beam(length, moduli, section) @ turns)
        nodes.append(place)

    edges = np.linspace(plate.support, plate.across, 101)
    for low, high in pairwise(edges):
        section = rectangle(plate.net_width(np.array([low + high]) / 2.0)[0], plate.thickness)
        moduli = (RIGID, RIGID) if rigid_plate else (69e9, 26e9)
        to(np.array([0.0, high, 0.0]), moduli, section, np.array([1.0, 0.0, 0.0]))
    base = nodes[-1] + (plate.thickness / 2.0 + foot.base) * up
    to(base, (RIGID, RIGID), (1e-3, 1e-6, 1e-6, 1e-6), forward)
    height = foot.wheel_height - foot.base
    for share in np.linspace(0.0, 1.0, 11)[1:]:
        section = rectangle(2.0 * foot.stem, float(foot.thickness))
        to(base + share * height * up, (1.8e9, SHEAR_OF_PETG), section, forward)

    whole, mass = np.zeros((6 * len(nodes),) * 2), np.zeros((6 * len(nodes),) * 2)
    for index, stiffness in enumerate(stiffnesses):
        whole[6 * index : 6 * index + 12, 6 * index : 6 * index + 12] += stiffness
    wheel, carrier = device.flywheel, device.carrier
    about = carrier.inertia + wheel.transverse_inertia * np.diag([1.0, 0.0, 1.0])
    turn = np.array([forward, axis, up])
    mass[-6:-3, -6:-3] = (wheel.mass + carrier.mass) * np.eye(3)
    mass[-3:, -3:] = turn.T @ np.diag(np.diag(about)) @ turn
    squares = np.linalg.eigvals(np.linalg.solve(whole[6:, 6:], mass[6:, 6:])).real
    return np.sort(1.0 / (2.0 * pi * np.sqrt(np.sort(squares)[-3:])))


def turned(angle):
    """The device on a plate with its wheels' axes at another incidence [rad]."""
    axes = np.array([[np.sin(angle), np.cos(angle), 0.0], [-np.sin(angle), np.cos(angle), 0.0]])
    modules = (
        Module(each.name, axis, each.position)
        for each, axis in zip(ON_A_PLATE.modules, axes, strict=True)
    )
    drive = replace(ON_A_PLATE.motor, no_load_speed=1e5, speed_max=None)
    return replace(ON_A_PLATE, modules=tuple(modules), incidence=angle, motor=drive)


@pytest.mark.parametrize("angle", [0.0, 0.55, 1.2, pi / 2.0])
def test_a_module_sways_and_twists_its_plate_as_beams_do(angle):
    """The sum of the squared periods is a bound from below, and the modes are far apart."""
    device = turned(angle)
    sways, twists, _ = frequencies(device)
    told = {mode.name: mode.frequency for mode in resonances_of(device)}
    assert told["foot"] == pytest.approx(sways, rel=0.04)
    assert told["twisted plate"] == pytest.approx(twists, rel=0.04)
    alone, _, _ = frequencies(device, rigid_plate=True)
    bench = replace(device, plate=None)
    assert foot_frequency(bench) == pytest.approx(alone, rel=0.03)
    # What was told before the plate gave way.
    assert foot_frequency(bench) > 1.1 * sways


def test_a_foot_of_aluminium_is_held_back_by_its_plate():
    stiff: Device = turned(0.55)
    on_plate = foot_frequency(stiff, 69e9) / foot_frequency(stiff)
    alone = replace(stiff, plate=None)
    on_bench = foot_frequency(alone, 69e9) / foot_frequency(alone)
    assert on_bench == pytest.approx((69e9 / 1.8e9) ** 0.5)
    assert 1.2 < on_plate < 0.7 * on_bench
