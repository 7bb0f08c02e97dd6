"""The main job, once, and then the product opened: every file, every number, every line."""

import csv
import hashlib
import json
import os
import pty
import re
from dataclasses import dataclass
from pathlib import Path
from types import SimpleNamespace

import mujoco
import numpy as np
import pinocchio as pin
import pytest
import trimesh
from commands import PROGRAM, SOLO12, Result, environment, everything_in, run, run_process
from exported import check_moments, check_wheels_in_pinocchio, pinocchio_model

from ocs_design.catalogue.materials import material
from ocs_design.catalogue.motors import motors
from ocs_design.design_file import design_to_json, read_design

# INTERFACE: the fields that scripts and other programs rely on.
SCHEMA = {
    "": "schema_version tool seed robot requirement ocs sizing margins validation files",
    "tool": "name version",
    "robot": "name source sha256 trunk posture mass com inertia warnings",
    "requirement": "maneuvers rate_change wheel_speed_max required_inertia",
    "requirement.required_inertia": "pitch roll",
    "ocs": "incidence incidence_criterion incidence_by_criterion spin_inertia mass_total modules "
    "flywheel motor",
    "ocs.modules.0": "name axis position",
    "ocs.modules.1": "name axis position",
    "ocs.flywheel": "inner_radius outer_radius height material density mass spin_inertia "
    "transverse_inertia hoop_stress stress_margin stored_energy",
    "ocs.motor": "name mass stall_torque no_load_speed torque_limit rotor_inertia source",
    "sizing": "status method objective binding shadow_prices gap",
    "margins.0": "name demand capacity unit margin",
    "validation.0": "scenario ocs passed reason metrics",
    "validation.0.metrics": "touchdown_pitch touchdown_roll upright_at_end peak_wheel_speed "
    "peak_wheel_torque momentum_error",
}
FILES = [
    "cad/flywheel.stl",
    "robot/solo12_ocs.urdf",
    "robot/solo12_ocs.xml",
    "robot/meshes/ocs_flywheel.stl",
    "snippets/ocs.urdf.xacro",
    "snippets/ocs.urdf",
    "snippets/ocs.xml",
    "validation/disturbance_with_ocs.csv",
    "validation/disturbance_without_ocs.csv",
    "validation/drop_with_ocs.csv",
    "validation/drop_without_ocs.csv",
    "validation/back-flip_with_ocs.csv",
    "validation/back-flip_without_ocs.csv",
]
SGR = re.compile(r"\x1b\[[0-9;]*m")


@dataclass(frozen=True)
class Product:
    """What a command said and the folder that it wrote."""

    said: Result
    folder: Path


@pytest.fixture(scope="module")
def product(tmp_path_factory):
    """A cold process, its streams piped."""
    parent = tmp_path_factory.mktemp("cold")
    said = run_process("size", SOLO12, cwd=parent, env=environment())
    return Product(said, parent / "solo12-ocs")


@pytest.fixture(scope="module")
def document(product):
    return json.loads((product.folder / "design.json").read_text())


@pytest.fixture(scope="module")
def device(document):
    """Wheel and modules as numbers, straight from the file."""
    ocs = document["ocs"]
    modules = [
        SimpleNamespace(name=m["name"], axis=np.array(m["axis"]), position=np.array(m["position"]))
        for m in ocs["modules"]
    ]
    return SimpleNamespace(
        flywheel=SimpleNamespace(**ocs["flywheel"]),
        carrier=SimpleNamespace(**ocs["carrier"]),
        motor=SimpleNamespace(**ocs["motor"]),
        modules=modules,
    )


@pytest.fixture(scope="module")
def exported(product):
    return pinocchio_model((product.folder / "robot" / "solo12_ocs.urdf").read_text())


def at(document, path):
    for key in filter(None, path.split(".")):
        document = document[int(key) if key.isdigit() else key]
    return document


def test_it_succeeds_and_leaves_nothing_but_its_folder(product):
    assert (product.said.code, product.said.stdout) == (0, "")
    assert list(product.folder.parent.iterdir()) == [product.folder]
    written = {name for name in everything_in(product.folder) if (product.folder / name).is_file()}
    assert written == {*FILES, "design.json"}


@pytest.mark.parametrize(("path", "keys"), SCHEMA.items())
def test_design_json_has_the_fields_that_others_rely_on(document, path, keys):
    assert set(keys.split()) <= set(at(document, path))


def test_hashes_are_those_of_the_files(product, document):
    hashes = {
        name: hashlib.sha256((product.folder / name).read_bytes()).hexdigest() for name in FILES
    }
    assert document["files"] == hashes
    assert document["robot"]["sha256"] == hashlib.sha256(Path(SOLO12).read_bytes()).hexdigest()


def test_the_design_reads_back_as_it_was_written(product):
    path = product.folder / "design.json"
    assert design_to_json(read_design(path)) == path.read_bytes()


def test_the_rim_is_the_cylinder_that_it_says(document):
    ocs = document["ocs"]
    wheel, motor = SimpleNamespace(**ocs["flywheel"]), SimpleNamespace(**ocs["motor"])
    fourth = wheel.outer_radius**4 - wheel.inner_radius**4
    area = wheel.outer_radius**2 - wheel.inner_radius**2
    column = np.pi * wheel.density * wheel.height
    speed = min(motor.no_load_speed, motor.speed_max)
    expected = {
        "mass": column * area,
        "spin_inertia": column * fourth / 2.0 + motor.rotor_inertia,
        "transverse_inertia": column * (3.0 * fourth + wheel.height**2 * area) / 12.0,
        "stored_energy": wheel.spin_inertia * speed**2 / 2.0,
    }
    for name, value in expected.items():
        assert getattr(wheel, name) == pytest.approx(value, rel=1e-9), name
    metal = material(wheel.material)
    nu = metal.poisson_ratio
    stress = (3.0 + nu) * wheel.outer_radius**2 + (1.0 - nu) * wheel.inner_radius**2
    assert wheel.hoop_stress == pytest.approx(wheel.density * speed**2 / 4.0 * stress, rel=1e-9)
    # At 1.2 times the highest speed the rim still has the safety of 2 that is assumed.
    assert metal.yield_strength / (1.2**2 * wheel.hoop_stress) >= 2.0 * (1.0 - 1e-9)
    assert ocs["spin_inertia"] == wheel.spin_inertia


def test_the_masses_add_up(document):
    ocs = document["ocs"]
    row = motors()[ocs["motor"]["name"]]
    assert ocs["motor"]["mass"] == row.mass
    standing = ocs["carrier"]["mass"] - row.mass - ocs["motor"]["gear_mass"]
    assert standing > 0.0
    assert ocs["mass_total"] == pytest.approx(
        2.0 * (ocs["flywheel"]["mass"] + ocs["carrier"]["mass"]), rel=1e-12
    )
    assert document["sizing"]["objective"] == pytest.approx(ocs["mass_total"], rel=1e-9)
    lightest = document["selection"]["ranking"][0]
    assert lightest["mass"] == pytest.approx(ocs["mass_total"], rel=1e-9)
    parts = [lightest[f"{name}_mass"] for name in ("wheels", "motors", "gears", "housings")]
    assert sum(parts) == pytest.approx(lightest["mass"], rel=1e-12)


def test_the_drive_is_the_motors_data_sheet_at_the_bus(document):
    """V = R i + k_t w, by hand from the row of the catalogue."""
    drive = document["ocs"]["motor"]
    row, volts = motors()[drive["name"]], document["selection"]["bus_voltage"]
    assert (drive["gear"], drive["gear_ratio"], volts) == ("direct", 1.0, 24.0)
    assert drive["no_load_speed"] == pytest.approx(volts / row.torque_constant, rel=1e-12)
    stall = volts * row.torque_constant / row.resistance
    assert drive["stall_torque"] == pytest.approx(stall, rel=1e-12)
    assert drive["torque_limit"] == row.peak_torque


def test_the_choice_says_what_it_looked_at(document):
    selection = document["selection"]
    masses = [entry["mass"] for entry in selection["ranking"]]
    assert masses == sorted(masses)
    assert len(masses) == 10
    assert selection["candidates"] > 1_000_000
    for task in selection["tasks"]:
        assert task["time_needed"] <= task["time_given"] * (1.0 + 1e-9)
        assert task["spin_inertia"] <= document["ocs"]["spin_inertia"] * (1.0 + 1e-9)
    listed = {entry["motor"] for entry in selection["ranking"]}
    fallen = {entry["motor"] for entry in selection["rejections"]}
    assert listed | fallen == set(motors())
    assert listed.isdisjoint(fallen)


def test_axes_follow_from_the_incidence(document, device):
    alpha = document["ocs"]["incidence"]
    for module, side in zip(device.modules, (1.0, -1.0), strict=True):
        expected = [side * np.sin(alpha), np.cos(alpha), 0.0]
        np.testing.assert_allclose(module.axis, expected, rtol=0.0, atol=1e-15)
    left, right = (module.position for module in device.modules)
    np.testing.assert_allclose(left, right * [1.0, -1.0, 1.0], rtol=0.0, atol=1e-15)


def test_wheels_do_not_touch_each_other(device):
    """Two cylinders of radius R and height h, each within a sphere: far enough, or side by side."""
    left, right = (module.position for module in device.modules)
    wheel = device.flywheel
    reach = np.hypot(wheel.outer_radius, wheel.height / 2.0)
    sideways = [
        wheel.outer_radius * abs(module.axis[0]) + wheel.height / 2.0 * abs(module.axis[1])
        for module in device.modules
    ]
    assert np.linalg.norm(left - right) > 2.0 * reach or left[1] - right[1] > sum(sideways)


def shifted(mass, offset):
    """Of the parallel axis theorem."""
    return mass * (offset @ offset * np.eye(3) - np.outer(offset, offset))


def with_modules(document, device, incidence):
    """Robot and both braked modules about their common centre of mass, in numpy alone."""
    robot, wheel = document["robot"], device.flywheel
    parts = [(robot["mass"], np.array(robot["com"]), np.array(robot["inertia"]))]
    for module, side in zip(device.modules, (1.0, -1.0), strict=True):
        axis = np.array([side * np.sin(incidence), np.cos(incidence), 0.0])
        across, along = np.eye(3) - np.outer(axis, axis), np.outer(axis, axis)
        # The rotor is in the motor's mass already, and stands still with it.
        rim = wheel.spin_inertia - device.motor.rotor_inertia
        parts.append((wheel.mass, module.position, wheel.transverse_inertia * across + rim * along))
        carrier = device.carrier
        own = carrier.transverse_inertia * across + carrier.axial_inertia * along
        parts.append((carrier.mass, module.position, own))
    mass = sum(part[0] for part in parts)
    com = sum(part[0] * part[1] for part in parts) / mass
    return mass, com, sum(own + shifted(m, c - com) for m, c, own in parts)


def test_the_total_is_the_sum_of_robot_and_modules(document, device):
    ocs = document["ocs"]
    mass, com, inertia = with_modules(document, device, ocs["incidence"])
    assert ocs["total_mass"] == pytest.approx(mass, rel=1e-12)
    np.testing.assert_allclose(ocs["total_com"], com, rtol=0.0, atol=1e-12)
    np.testing.assert_allclose(ocs["total_inertia"], inertia, rtol=1e-9, atol=1e-12)


def composite(model, posture):
    """Mass, centre of mass and inertia about it with the joints held, by Pinocchio."""
    data, q = model.createData(), pin.neutral(model)
    for name, value in posture.items():
        q[model.joints[model.getJointId(name)].idx_q] = value
    pin.ccrba(model, data, q, np.zeros(model.nv))
    return data.Ig.mass, data.com[0], data.Ig.inertia


def test_the_exported_urdf_is_the_design_to_pinocchio(document, device, exported):
    check_wheels_in_pinocchio(exported, device, document["robot"]["trunk"])
    mass, com, inertia = composite(exported, document["robot"]["posture"])
    ocs = document["ocs"]
    assert mass == pytest.approx(ocs["total_mass"], rel=1e-9)
    np.testing.assert_allclose(com, ocs["total_com"], rtol=0.0, atol=1e-9)
    np.testing.assert_allclose(inertia, ocs["total_inertia"], rtol=1e-9, atol=1e-11)


@pytest.mark.parametrize("name", ["robot/solo12_ocs.xml", "robot/solo12_ocs.urdf"])
def test_mujoco_reads_the_same_robot(product, document, device, name):
    """MuJoCo fuses a URDF's root to the world: only its wheels can be compared."""
    model = mujoco.MjModel.from_xml_path(str(product.folder / name))
    for module in device.modules:
        body = model.body(f"ocs_{module.name}_flywheel")
        joint = model.joint(f"ocs_{module.name}")
        assert body.mass[0] == pytest.approx(device.flywheel.mass, rel=1e-9)
        turned = np.empty(9)
        mujoco.mju_quat2Mat(turned, body.iquat)
        frame = turned.reshape(3, 3)
        check_moments(frame @ np.diag(body.inertia) @ frame.T, device)
        placed = np.empty(9)
        mujoco.mju_quat2Mat(placed, body.quat)
        np.testing.assert_allclose(
            placed.reshape(3, 3) @ joint.axis, module.axis, rtol=0.0, atol=1e-9
        )
        np.testing.assert_allclose(body.pos, module.position, rtol=0.0, atol=1e-9)
    if name.endswith(".xml"):
        assert model.body_mass.sum() == pytest.approx(document["ocs"]["total_mass"], rel=1e-9)


@pytest.mark.parametrize(
    ("name", "unit"), [("cad/flywheel.stl", 1e-3), ("robot/meshes/ocs_flywheel.stl", 1.0)]
)
def test_meshes_are_watertight_and_weigh_what_they_should(product, device, name, unit):
    mesh = trimesh.load_mesh(product.folder / name)
    mesh.apply_scale(unit)
    wheel = device.flywheel
    assert mesh.is_watertight
    assert mesh.is_winding_consistent
    mesh.density = wheel.density
    assert mesh.mass == pytest.approx(wheel.mass, rel=1e-4)
    expected = np.diag([wheel.transverse_inertia] * 2 + [wheel.spin_inertia])
    np.testing.assert_allclose(
        mesh.moment_inertia, expected, rtol=1e-4, atol=1e-4 * wheel.spin_inertia
    )
    np.testing.assert_allclose(mesh.center_mass, 0.0, atol=1e-6 * wheel.outer_radius)
    np.testing.assert_allclose(
        mesh.extents, 2.0 * np.array([wheel.outer_radius] * 2 + [wheel.height / 2.0]), rtol=1e-4
    )


@pytest.mark.parametrize("name", [name for name in FILES if name.endswith(".csv")])
def test_time_series_can_be_read_with_their_units(product, document, name):
    with (product.folder / name).open(newline="") as file:
        rows = list(csv.DictReader(file))
    units = ("_s", "_m", "_rad", "_rad_s", "_nm")
    assert all(heading.endswith(units) for heading in rows[0] if heading != "contact")
    table = {heading: np.array([float(row[heading]) for row in rows]) for heading in rows[0]}
    assert all(np.isfinite(column).all() for column in table.values())
    assert (np.diff(table["time_s"]) > 0.0).all()
    scenario, device_given = re.fullmatch(r"validation/(.+)_(with|without)_ocs\.csv", name).groups()
    metrics = next(
        each["metrics"]
        for each in document["validation"]
        if (each["scenario"], each["ocs"]) == (scenario, device_given == "with")
    )
    flight = table["time_s"] <= metrics["touchdown_time"]
    assert not table["contact"][flight][:-1].any()
    speeds = [
        np.abs(table[f"wheel_speed_{side}_rad_s"][flight]).max() for side in ("left", "right")
    ]
    assert max(speeds) == pytest.approx(metrics["peak_wheel_speed"], rel=0.05, abs=1e-6)


def test_the_flights_prove_the_device(document):
    runs = {(r["scenario"], r["ocs"]): r for r in document["validation"]}
    for scenario in ("disturbance", "drop", "back-flip"):
        proved, bare = runs[scenario, True], runs[scenario, False]
        assert proved["passed"] is True, proved["reason"]
        assert bare["passed"] is False
        assert bare["reason"]
        for axis in ("pitch", "roll"):
            assert abs(proved["metrics"][f"touchdown_{axis}"]) < np.radians(5.0)
        assert proved["metrics"]["momentum_error"] < 1e-6
        assert proved["metrics"]["upright_at_end"] is True
        speed = proved["metrics"]["peak_wheel_speed"]
        # The trunk's own motion carries a wheel a little past the speed where its motor stops.
        assert speed <= document["ocs"]["motor"]["speed_max"] * (1.0 + 1e-5)
        torque = proved["metrics"]["peak_wheel_torque"]
        assert torque <= document["ocs"]["motor"]["torque_limit"] * (1.0 + 1e-12)
    assert runs["back-flip", True]["metrics"]["turned_angle"] == pytest.approx(
        -2.0 * np.pi, abs=np.radians(5.0)
    )
    assert abs(runs["back-flip", False]["metrics"]["turned_angle"]) < np.radians(1.0)
    bare_drop = runs["drop", False]["metrics"]["touchdown_pitch"]
    assert np.degrees(bare_drop) == pytest.approx(30.0, abs=0.5)
    bare_jump = runs["disturbance", False]["metrics"]
    assert np.degrees(abs(bare_jump["touchdown_pitch"])) > 10.0


def test_margins_are_capacity_over_demand(document):
    for margin in document["margins"]:
        if margin["capacity"] is None:
            assert margin["margin"] is None
        else:
            assert margin["margin"] == pytest.approx(margin["capacity"] / margin["demand"])
            assert margin["margin"] >= 1.0 - 1e-5


# The terminal.


@pytest.fixture(scope="module")
def wide(tmp_path_factory):
    """Once more, on a single processor, for a terminal of 120 columns."""
    parent = tmp_path_factory.mktemp("wide")
    allowed = os.sched_getaffinity(0)
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(parent)
        patch.setenv("COLUMNS", "120")
        patch.delenv("FORCE_COLOR", raising=False)
        os.sched_setaffinity(0, {min(allowed)})
        try:
            said = run("size", SOLO12)
        finally:
            os.sched_setaffinity(0, allowed)
    return Product(said, parent / "solo12-ocs")


def test_the_same_run_writes_the_same_bytes_on_any_number_of_threads(product, wide):
    for name in ("design.json", *FILES):
        assert (product.folder / name).read_bytes() == (wide.folder / name).read_bytes(), name


@pytest.mark.parametrize(("width", "which"), [(80, "product"), (120, "wide")])
def test_the_report_fits_its_terminal(request, width, which):
    said = request.getfixturevalue(which).said
    assert "\x1b" not in said.stderr
    lines = said.stderr.splitlines()
    assert max(map(len, lines)) <= width
    headings = [line for line in lines if re.match(r"[A-Z]", line)]
    assert len(headings) == len(set(headings)) == 9
    for word in ("2.5 kg", "24 V", "Assumed", "housing", "r_max", "back-flip", "fell out"):
        assert word in said.stderr
    assert "3 of 3 scenarios pass" in lines[-1]


def test_a_wider_terminal_breaks_fewer_lines(product, wide):
    assert len(wide.said.stderr.splitlines()) < len(product.said.stderr.splitlines())


def test_json_is_the_artefact_and_nothing_else(product, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    result = run("size", SOLO12, "--json")
    assert (result.code, result.stderr) == (0, "")
    assert result.stdout == (product.folder / "design.json").read_text()
    assert result.stdout == (tmp_path / "solo12-ocs" / "design.json").read_text()


def test_quiet_prints_nothing(tmp_path):
    result = run("size", SOLO12, "-q", "--no-validate", "-o", tmp_path / "out")
    assert result == Result(0, "", "")
    assert (tmp_path / "out" / "design.json").is_file()
    assert not (tmp_path / "out" / "validation").exists()


def in_a_terminal(*arguments, **variables):
    """What a terminal of 80 columns gets to see."""
    child, screen = pty.fork()
    if child == 0:
        os.execvpe(PROGRAM[0], [*PROGRAM, *map(str, arguments)], environment(**variables))
    seen = bytearray()
    try:
        while chunk := os.read(screen, 1 << 16):
            seen += chunk
    except OSError:  # The child has closed its end: Linux says EIO.
        pass
    os.close(screen)
    code = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
    return code, seen.decode()


@pytest.mark.parametrize("arguments", [("inspect", SOLO12), ("inspect", "nowhere.urdf")])
def test_a_terminal_gets_colour_unless_it_is_declined(arguments):
    code, plain = in_a_terminal(*arguments)
    assert SGR.search(plain)
    for declined in (
        in_a_terminal(*arguments, "--no-color"),
        in_a_terminal(*arguments, NO_COLOR="1"),
    ):
        assert declined == (code, SGR.sub("", plain))
