"""The robot and its flights as the page's viewer takes them."""

from collections.abc import Iterator, Sequence

import numpy as np

from ocs_design.arrays import FloatArray
from ocs_design.export.naming import PREFIX
from ocs_design.report.flight import Flight
from ocs_design.report.viewer.blob import Blob, Record
from ocs_design.report.viewer.bodies import ShownBody, Surface
from ocs_design.robot.spec.frames import quaternion
from ocs_design.simulation.poses import Poses
from ocs_design.simulation.quaternions import from_axis_angle
from ocs_design.simulation.quaternions import product as hamilton
from ocs_design.simulation.scene import FLYWHEELS

_LARGEST = 32767
"""Of 16 bits with a sign: quaternions."""

_MOST_UINT16 = 65535

_FINE = 1e4
"""Positions are kept to a tenth of a millimetre, which packs well."""

_BESIDE = 1.25
"""From one robot to the other where both are shown, over the width of one."""


def encoded_scene(
    bodies: Sequence[ShownBody], flights: Sequence[Flight], scenarios: Sequence[str], blob: Blob
) -> Record:
    """Everything that the viewer shows; its arrays go into the blob.

    Args:
        bodies: at least one.
        flights: of which those with poses can be replayed.
        scenarios: in the order of the page.
        blob: that grows.
    """
    low, high = _box(bodies)
    radius = _radius(low, high)
    device = _box([body for body in bodies if body.name.startswith(PREFIX)] or bodies)
    names = [body.name for body in bodies]
    return {
        "bodies": [_body(body, blob) for body in bodies],
        "trunk": 0,
        "middle": ((low + high) / 2.0).tolist(),
        "ground": float(low[2]),
        "reach": radius,
        "device": {"middle": np.mean(device, axis=0).tolist(), "reach": _radius(*device)},
        "tile": float(10.0 ** np.round(np.log10(radius / 2.0))),
        "apart": float(_BESIDE * (high - low)[1]),
        "scenarios": list(scenarios),
        "flights": [
            _flight(flight, flight.poses, names, blob)
            for flight in flights
            if flight.poses is not None and set(names) <= set(flight.poses.bodies)
        ],
    }


def _body(body: ShownBody, blob: Blob) -> Record:
    return {
        "name": body.name,
        "device": body.name.startswith(PREFIX),
        "wheel": FLYWHEELS.index(body.name) if body.name in FLYWHEELS else None,
        "position": body.placement.position.tolist(),
        "attitude": list(map(float, quaternion(body.placement.rotation))),
        "surfaces": [_surface(surface, blob) for surface in body.surfaces],
    }


def _surface(surface: Surface, blob: Blob) -> Record:
    low, size = surface.vertices.min(axis=0), np.ptp(surface.vertices, axis=0)
    kind = "u2" if len(surface.vertices) <= _MOST_UINT16 else "u4"
    return {
        "color": list(surface.color),
        "low": low.tolist(),
        "size": size.tolist(),
        "vertices": blob.add(_in_box(surface.vertices, low, size), "u2"),
        "faces": blob.add(surface.faces, kind),
    }


def _in_box(points: FloatArray, low: FloatArray, size: FloatArray) -> FloatArray:
    """Coordinates as parts of the box, 0..65535."""
    parts = np.divide(points - low, size, out=np.zeros_like(points), where=size > 0.0)
    return np.round(_MOST_UINT16 * parts)


def _flight(flight: Flight, poses: Poses, names: Sequence[str], blob: Blob) -> Record:
    places = [poses.bodies.index(name) for name in names]
    tilt = [flight.columns[f"{axis}_rad"] for axis in ("pitch", "roll")]
    at_frames = [np.interp(poses.time, flight.time, np.degrees(angle)) for angle in tilt]
    return {
        "scenario": flight.scenario,
        "ocs": flight.ocs,
        "frames": len(poses.time),
        "time": blob.add(poses.time, "f4"),
        "position": blob.add(np.round(_FINE * poses.position[:, places]) / _FINE, "f4"),
        "attitude": blob.add(np.round(_LARGEST * _unspun(poses)[:, places]), "i2"),
        "wheels": blob.add(poses.wheel_angle, "f4"),
        "tilt": blob.add(np.stack(at_frames, axis=1), "f4"),
    }


def _unspun(poses: Poses) -> FloatArray:
    """Attitudes with the wheels' own turns taken out, which are many from one pose to the next."""
    attitude = poses.attitude.copy()
    for wheel, name in enumerate(FLYWHEELS):
        body = poses.bodies.index(name)
        back = from_axis_angle(np.array([0.0, 0.0, 1.0]), -poses.wheel_angle[:, wheel])
        attitude[:, body] = hamilton(attitude[:, body], back)
    return attitude


def _radius(low: FloatArray, high: FloatArray) -> float:
    """Of the ball around a box."""
    return float(np.linalg.norm(high - low)) / 2.0


def _box(bodies: Sequence[ShownBody]) -> tuple[FloatArray, FloatArray]:
    """Around all that is shown, in B."""
    corners = np.concatenate(list(_corners(bodies)))
    return corners.min(axis=0), corners.max(axis=0)


def _corners(bodies: Sequence[ShownBody]) -> Iterator[FloatArray]:
    for body in bodies:
        for surface in body.surfaces:
            place = body.placement
            yield surface.vertices @ place.rotation.T + place.position
