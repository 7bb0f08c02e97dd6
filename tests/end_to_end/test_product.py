"""The products of `size` with and without a motor: every file and every number."""

import csv
import hashlib
import re
from pathlib import Path

import mujoco
import numpy as np
import pytest
import trimesh
from commands import SOLO12, all_paths_in
from exported import check_moments, check_wheels_in_pinocchio
from mass_oracles import pinocchio_mass_properties
from pinocchio_robots import configuration
from products import FILES, with_modules

from ocs_design.actuation.motor import build_gaps
from ocs_design.catalogue.motors import motors
from ocs_design.common.files import to_json
from ocs_design.device.records.design import read_design
from ocs_design.parts.joints import hub_joint
from ocs_design.parts.motor_mount import bond_length, hub_height, motor_front, mount_of

# INTERFACE: the fields that scripts and other programs rely on.
SCHEMA = {
    "": "schema_version tool seed robot requirement ocs sizing margins validation files "
    "supply alternatives buildable",
    "buildable": "yes open",
    "margins.0": "name demand capacity unit margin scenario",
    "tool": "name version",
    "robot": "name source sha256 trunk posture mass com inertia warnings",
    "requirement": "maneuvers rate_change wheel_speed_max required_inertia reliability",
    "requirement.required_inertia": "pitch roll",
    "ocs": "incidence incidence_criterion incidence_by_criterion spin_inertia mass_total modules "
    "flywheel motor layout",
    "ocs.modules.0": "name axis position",
    "ocs.modules.1": "name axis position",
    "ocs.flywheel": "inner_radius outer_radius height material density mass spin_inertia "
    "transverse_inertia hoop_stress stress_margin stored_energy",
    "ocs.motor": "name mass stall_torque no_load_speed torque_limit rotor_inertia source",
    "sizing": "status method objective binding shadow_prices gap",
    "validation.0": "scenario ocs passed level stands reason metrics",
    "validation.0.metrics": "touchdown_pitch touchdown_roll upright_at_end peak_wheel_speed "
    "peak_wheel_torque momentum_error",
}
PAUSE = re.compile(r"a pause of [\d.]+ s after each maneuver cools it")


def value_at(document, path):
    for key in filter(None, path.split(".")):
        document = document[int(key) if key.isdigit() else key]
    return document


def test_it_succeeds_and_writes_only_its_folder(product):
    assert product.result.code == 0
    assert list(product.folder.parent.iterdir()) == [product.folder]
    written = {name for name in all_paths_in(product.folder) if (product.folder / name).is_file()}
    assert written == {*product.case.files, "design.json", "report.html"}
    assert 2**16 < product.peak < 2**20, "KiB, hence 1 GiB"


@pytest.mark.parametrize(("path", "keys"), SCHEMA.items())
def test_design_json_has_the_fields_that_others_rely_on(document, path, keys):
    assert set(keys.split()) <= set(value_at(document, path))


def test_hashes_are_those_of_the_files(product, document):
    hashes = {
        name: hashlib.sha256((product.folder / name).read_bytes()).hexdigest()
        for name in product.case.files
    }
    assert document["files"] == hashes
    assert document["robot"]["sha256"] == hashlib.sha256(Path(SOLO12).read_bytes()).hexdigest()


def test_the_design_reads_back_as_it_was_written(product):
    path = product.folder / "design.json"
    assert to_json(read_design(path)) == path.read_bytes()


def test_alternatives_are_lighter(document):
    for change in document["alternatives"]:
        if change["note"] != "saves nothing" and "bonded" not in change["change"]:
            assert change["mass_total"] < document["ocs"]["mass_total"], change


def test_axes_follow_from_the_incidence(document, device):
    alpha = document["ocs"]["incidence"]
    for module, side in zip(device.modules, (1.0, -1.0), strict=True):
        expected = [side * np.sin(alpha), np.cos(alpha), 0.0]
        np.testing.assert_allclose(module.axis, expected, rtol=0.0, atol=1e-15)
    left, right = (module.position for module in device.modules)
    np.testing.assert_allclose(left, right * [1.0, -1.0, 1.0], rtol=0.0, atol=1e-15)


def test_wheels_do_not_touch_each_other(device):
    """Either their enclosing spheres are apart, or their extents in y."""
    left, right = (module.position for module in device.modules)
    wheel = device.flywheel
    radius = np.hypot(wheel.outer_radius, wheel.height / 2.0)
    half_widths = [
        wheel.outer_radius * abs(module.axis[0]) + wheel.height / 2.0 * abs(module.axis[1])
        for module in device.modules
    ]
    assert np.linalg.norm(left - right) > 2.0 * radius or left[1] - right[1] > sum(half_widths)


def test_the_total_is_the_sum_of_robot_and_modules(document, device):
    ocs = document["ocs"]
    mass, com, inertia = with_modules(document, device, ocs["incidence"])
    assert ocs["total_mass"] == pytest.approx(mass, rel=1e-12)
    np.testing.assert_allclose(ocs["total_com"], com, rtol=0.0, atol=1e-12)
    np.testing.assert_allclose(ocs["total_inertia"], inertia, rtol=1e-9, atol=1e-12)


def test_pinocchio_reads_the_design_from_the_urdf(document, device, exported):
    check_wheels_in_pinocchio(exported, device, document["robot"]["trunk"])
    total = pinocchio_mass_properties(
        exported, configuration(exported, document["robot"]["posture"])
    )
    ocs = document["ocs"]
    assert total.mass == pytest.approx(ocs["total_mass"], rel=1e-9)
    np.testing.assert_allclose(total.com, ocs["total_com"], rtol=0.0, atol=1e-9)
    np.testing.assert_allclose(total.inertia, ocs["total_inertia"], rtol=1e-9, atol=1e-11)


@pytest.mark.parametrize("name", ["robot/solo12_ocs.xml", "robot/solo12_ocs.urdf"])
def test_mujoco_reads_the_same_robot(product, document, device, name):
    """MuJoCo fixes the root of a URDF to the world, so that only its wheels are compared."""
    model = mujoco.MjModel.from_xml_path(str(product.folder / name))
    for module in device.modules:
        body = model.body(f"ocs_{module.name}_flywheel")
        joint = model.joint(f"ocs_{module.name}")
        assert body.mass[0] == pytest.approx(device.flywheel.mass, rel=1e-9)
        inertial_axes = np.empty(9)
        mujoco.mju_quat2Mat(inertial_axes, body.iquat)
        frame = inertial_axes.reshape(3, 3)
        check_moments(frame @ np.diag(body.inertia) @ frame.T, device)
        orientation = np.empty(9)
        mujoco.mju_quat2Mat(orientation, body.quat)
        np.testing.assert_allclose(
            orientation.reshape(3, 3) @ joint.axis, module.axis, rtol=0.0, atol=1e-9
        )
        np.testing.assert_allclose(body.pos, module.position, rtol=0.0, atol=1e-9)
    if name.endswith(".xml"):
        assert model.body_mass.sum() == pytest.approx(document["ocs"]["total_mass"], rel=1e-9)


def test_the_stl_of_the_wheel_is_watertight_with_its_mass_and_inertia(product, device):
    wheel, rotor = device.flywheel, device.motor.rotor_inertia
    mesh = trimesh.load_mesh(product.folder / "cad/flywheel.stl").apply_scale(1e-3)
    assert mesh.body_count == 1
    assert mesh.is_watertight
    assert mesh.is_winding_consistent
    mesh.density = wheel.density
    np.testing.assert_allclose(mesh.center_mass, 0.0, atol=1e-6 * wheel.outer_radius)
    assert mesh.mass == pytest.approx(wheel.mass, rel=1e-6)
    expected = np.diag([wheel.transverse_inertia] * 2 + [wheel.spin_inertia - rotor])
    np.testing.assert_allclose(
        mesh.moment_inertia, expected, rtol=1e-6, atol=1e-6 * wheel.spin_inertia
    )


@pytest.mark.parametrize("name", [name for name in FILES if name.startswith("validation/")])
def test_time_series_can_be_read_with_their_units(product, document, name):
    with (product.folder / name).open(newline="") as file:
        rows = list(csv.DictReader(file))
    units = ("_s", "_m", "_rad", "_rad_s", "_nm", "_w", "_a")
    assert all(heading.endswith(units) for heading in rows[0] if heading != "contact")
    table = {heading: np.array([float(row[heading]) for row in rows]) for heading in rows[0]}
    assert all(np.isfinite(column).all() for column in table.values())
    assert (np.diff(table["time_s"]) > 0.0).all()
    scenario, device_given = re.fullmatch(r"validation/(.+)_(with|without)_ocs\.csv", name).groups()
    metrics = next(
        flight["metrics"]
        for flight in document["validation"]
        if (flight["scenario"], flight["ocs"]) == (scenario, device_given == "with")
    )
    lift_off, touchdown = metrics["lift_off_time"], metrics["touchdown_time"]
    flight = (lift_off <= table["time_s"]) & (table["time_s"] <= touchdown)
    assert not table["contact"][flight][:-1].any()
    speeds = [
        np.abs(table[f"wheel_speed_{side}_rad_s"][flight]).max() for side in ("left", "right")
    ]
    assert max(speeds) == pytest.approx(metrics["peak_wheel_speed"], rel=0.05, abs=1e-6)


def test_flights_pass_with_the_device_and_fail_without(document):
    runs = {(run["scenario"], run["ocs"]): run for run in document["validation"]}
    for scenario in ("disturbance", "drop", "back-flip"):
        carrying, bare = runs[scenario, True], runs[scenario, False]
        assert carrying["passed"] is True, carrying["reason"]
        assert bare["passed"] is False
        assert bare["reason"]
        for axis in ("pitch", "roll"):
            assert abs(carrying["metrics"][f"touchdown_{axis}"]) < np.radians(5.0)
        assert carrying["metrics"]["momentum_error"] < 1e-6
        assert carrying["metrics"]["upright_at_end"] is True
    assert runs["back-flip", True]["metrics"]["turned_angle"] == pytest.approx(
        -2.0 * np.pi, abs=np.radians(5.0)
    )
    assert abs(runs["back-flip", False]["metrics"]["turned_angle"]) < np.radians(1.0)
    bare_drop = runs["drop", False]["metrics"]["touchdown_pitch"]
    assert np.degrees(bare_drop) == pytest.approx(30.0, abs=0.5)
    bare_jump = runs["disturbance", False]["metrics"]
    assert np.degrees(abs(bare_jump["touchdown_pitch"])) > 10.0


def test_margins_are_capacity_over_demand(document, product):
    for margin in document["margins"]:
        if margin["capacity"] is None:
            assert margin["margin"] is None
        else:
            assert margin["margin"] == pytest.approx(margin["capacity"] / margin["demand"])
            kept = margin["margin"] >= 1.0 - product.case.slack
            # The continuous rating may be exceeded for seconds if a pause follows.
            assert kept or (margin["name"] == "rms current" and PAUSE.search(margin["note"]))


def engagement(row):
    """Length of the motor's shaft in the hub's bore, without chamfers of 0.5 mm [m]."""
    mount = mount_of(row, None)
    front = motor_front(mount, min(mount.rim_height_max, 0.03))
    return bond_length(row.mounting, hub_height(row.mounting), 0.5e-3, front)


@pytest.mark.parametrize("product", ["motor"], indirect=True)
def test_the_selection_lists_all_suitable_motors(document):
    selection = document["selection"]
    masses = [entry["mass"] for entry in selection["ranking"]]
    # Smaller differences count as equal mass, where the stronger motor comes first.
    assert (np.diff(masses) > -1e-5 * np.array(masses[1:])).all()
    assert len(masses) >= 10
    assert len({entry["motor"] for entry in selection["ranking"]}) >= 5
    # Each motor is combined with a gear and five steels, at one incidence.
    assert selection["candidates"] % 5 == 0
    assert selection["candidates"] >= 5 * len({entry["motor"] for entry in selection["ranking"]})
    for task in selection["tasks"]:
        assert task["time_needed"] <= task["time_given"] * (1.0 + 1e-9)
        assert task["spin_inertia"] <= document["ocs"]["spin_inertia"] * (1.0 + 1e-9)
    ranked = {entry["motor"] for entry in selection["ranking"]}
    rejected = {entry["motor"] for entry in selection["rejections"]}
    complete = {name: row for name, row in motors().items() if not build_gaps(row)}
    suitable = {
        name
        for name, row in complete.items()
        if hub_joint(row.mounting, engagement(row)) >= 1.5 * row.peak_torque
        and (row.voltage_max or row.rated_voltage) >= 24.0
    }
    assert ranked | rejected == suitable < set(complete) < set(motors())
    assert ranked.isdisjoint(rejected)
