"""The encoded scene, decoded as by the page's script, against MuJoCo's poses."""

import base64
import zlib
from dataclasses import replace

import numpy as np
import pytest
from robots import SOLO12
from scipy.spatial.transform import Rotation
from wheels import paper_device

from ocs_design.common.frames import Placement
from ocs_design.report.bodies import ShownBody, Surface
from ocs_design.report.html.view import Blob, encoded_scene
from ocs_design.report.story import RecordedFlight
from ocs_design.requirement.froude import default_maneuvers
from ocs_design.robot.reader import read_robot
from ocs_design.simulation.scenario import Flights, Options, run_scenarios
from ocs_design.workflows.recording import record_run

KINDS = {"f4": "<f4", "i2": "<i2", "u2": "<u2", "u4": "<u4"}
TRIANGLE = np.array([[0.0, 0.0, 0.0], [0.4, 0.0, 0.1], [0.0, 0.2, 0.1]])


@pytest.fixture(scope="module")
def flights():
    solo12 = read_robot(SOLO12)
    drop = default_maneuvers(solo12)[1]
    runs = run_scenarios(Flights(solo12, paper_device(), [drop], options=Options(pose_rate=20.0)))
    return [RecordedFlight(record_run(run), run.series.columns(), run.poses) for run in runs]


def triangle_body(name):
    surface = Surface(TRIANGLE, np.array([[0, 1, 2]]), (1.0, 0.5, 0.0, 1.0))
    return ShownBody(name, Placement.identity(), (surface,))


@pytest.fixture(scope="module")
def scene(flights):
    names = ("base_link", "HL_LOWER_LEG", "ocs_left_flywheel", "ocs_right_flywheel")
    blob = Blob()
    encoded = encoded_scene([triangle_body(name) for name in names], flights, ["drop"], blob)
    return encoded, zlib.decompress(base64.b64decode(blob.text()))


def decoded(content, place):
    return np.frombuffer(content, KINDS[place["kind"]], place["length"], place["at"]).astype(float)


def test_poses_are_accurate_to_a_tenth_of_a_millimetre_and_a_hundredth_of_a_degree(scene, flights):
    encoded, content = scene
    for record, flight in zip(encoded["flights"], flights, strict=True):
        count, poses = record["frames"], flight.poses
        position = decoded(content, record["position"]).reshape(count, 4, 3)
        attitude = decoded(content, record["attitude"]).reshape(count, 4, 4) / 32767.0
        wheels = decoded(content, record["wheels"]).reshape(count, 2)
        for number, body in enumerate(encoded["bodies"]):
            index = poses.bodies.index(body["name"])
            np.testing.assert_allclose(position[:, number], poses.position[:, index], atol=6e-5)
            rotation = Rotation.from_quat(attitude[:, number], scalar_first=True)
            if body["wheel"] is not None:
                about_z = np.outer(wheels[:, body["wheel"]], [0.0, 0.0, 1.0])
                rotation = rotation * Rotation.from_rotvec(about_z)
            error = rotation.inv() * Rotation.from_quat(poses.attitude[:, index], scalar_first=True)
            assert np.degrees(error.magnitude()).max() < 0.01


def test_surfaces_are_accurate_to_a_fraction_of_their_box(scene):
    encoded, content = scene
    surface = encoded["bodies"][0]["surfaces"][0]
    fractions = decoded(content, surface["vertices"]).reshape(-1, 3) / 65535.0
    vertices = np.array(surface["low"]) + fractions * np.array(surface["size"])
    np.testing.assert_allclose(vertices, TRIANGLE, atol=1e-5)
    assert decoded(content, surface["faces"]).tolist() == [0.0, 1.0, 2.0]


def test_the_readout_is_the_tilt_of_the_flight(scene, flights):
    encoded, content = scene
    tilt = decoded(content, encoded["flights"][0]["tilt"]).reshape(-1, 2)
    assert tilt[0] == pytest.approx([30.0, 0.0], abs=1e-4)


def test_flights_about_a_pivot_have_no_floor(flights):
    for on_pivot in (False, True):
        judged = {"level": None if on_pivot else True, "stands": True}
        pivoted = [replace(it, record=replace(it.record, **judged)) for it in flights]
        scene = encoded_scene([triangle_body("base_link")], pivoted, [], Blob())
        assert {flight["floor"] for flight in scene["flights"]} == {not on_pivot}


def test_flights_without_poses_are_not_replayed(flights):
    bare = [replace(flight, poses=None) for flight in flights]
    assert encoded_scene([triangle_body("base_link")], bare, [], Blob())["flights"] == []
