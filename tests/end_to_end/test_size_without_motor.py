"""The main job without a motor: wheels sized by the bound alone."""

from types import SimpleNamespace

import numpy as np
import pytest
from products import composite, coupling, equal_rate

from ocs_design.catalogue.materials import material

pytestmark = pytest.mark.parametrize("product", ["no motor"], indirect=True)


def test_the_rim_is_the_cylinder_that_it_says(document):
    wheel = SimpleNamespace(**document["ocs"]["flywheel"])
    fourth = wheel.outer_radius**4 - wheel.inner_radius**4
    area = wheel.outer_radius**2 - wheel.inner_radius**2
    column = np.pi * wheel.density * wheel.height
    speed = document["requirement"]["wheel_speed_max"]
    assert speed == pytest.approx(7200.0 * np.pi / 30.0, rel=1e-12)
    expected = {
        "mass": column * area,
        "spin_inertia": column * fourth / 2.0,
        "transverse_inertia": column * (3.0 * fourth + wheel.height**2 * area) / 12.0,
        "stored_energy": wheel.spin_inertia * speed**2 / 2.0,
    }
    for name, value in expected.items():
        assert getattr(wheel, name) == pytest.approx(value, rel=1e-9), name
    steel = material(wheel.material)
    nu = steel.poisson_ratio
    stress = (3.0 + nu) * wheel.outer_radius**2 + (1.0 - nu) * wheel.inner_radius**2
    assert wheel.hoop_stress == pytest.approx(wheel.density * speed**2 / 4.0 * stress, rel=1e-9)
    assert wheel.stress_margin == pytest.approx(steel.yield_strength / wheel.hoop_stress, rel=1e-9)
    ocs = document["ocs"]
    assert ocs["spin_inertia"] == wheel.spin_inertia
    assert ocs["mass_total"] == 2.0 * wheel.mass
    assert document["sizing"]["objective"] == wheel.mass


def test_the_fixed_point_closes_on_the_exported_urdf(document, device, exported):
    """What the wheels must do, from the masses that were exported, is what they were sized for."""
    _, _, total = composite(exported, document["robot"]["posture"])
    alpha = document["ocs"]["incidence"]
    assert equal_rate(total) == pytest.approx(alpha, abs=1e-9)
    maneuvers = {m["name"]: m for m in document["requirement"]["maneuvers"]}
    speed = document["requirement"]["wheel_speed_max"]

    torque = np.array(maneuvers["disturbance"]["parameters"]["torque"])
    impulse = torque * maneuvers["disturbance"]["parameters"]["duration"]
    fall = maneuvers["drop"]["parameters"]["height"] - document["robot"]["standing_height"]
    drop_time = np.sqrt(2.0 * fall / maneuvers["drop"]["gravity"])
    roll, pitch = np.array([coupling(total), total[1, 1]]) * 2.0 * np.radians(30.0) / drop_time
    assert maneuvers["back-flip"]["parameters"]["duration"] == 2.0
    rolled, flip = np.array([coupling(total), total[1, 1]]) * 2.0 * 2.0 * np.pi / 2.0
    expected = {
        "disturbance": (impulse[0] / np.sin(alpha) + impulse[1] / np.cos(alpha)) / (2.0 * speed),
        "drop": (roll / np.sin(alpha) + pitch / np.cos(alpha)) / (2.0 * speed),
        "back-flip": (rolled / np.sin(alpha) + flip / np.cos(alpha)) / (2.0 * speed),
    }
    found = {d["source"]: d["spin_inertia"] for d in document["requirement"]["demands"]}
    assert found == pytest.approx(expected, rel=1e-9)
    assert device.flywheel.spin_inertia == pytest.approx(max(expected.values()), rel=1e-9)
    assert document["sizing"]["residual"] < 1e-9
    required = document["requirement"]["required_inertia"]
    assert required["pitch"] == pytest.approx(flip / speed, rel=1e-9)
    assert required["roll"] == pytest.approx(impulse[0] / speed, rel=1e-9)


def test_the_flights_stay_within_the_speed(document):
    limit = document["requirement"]["wheel_speed_max"]
    for run in (run["metrics"] for run in document["validation"] if run["ocs"]):
        assert run["peak_wheel_speed"] <= limit * (1.0 + 1e-9)
