"""Interactive view of the robot: a still picture, its controls, and the data for the script."""

import base64
import json
import zlib
from collections.abc import Sequence
from html import escape
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ocs_design.common.arrays import FloatArray
from ocs_design.common.quaternions import from_axis_angle
from ocs_design.common.quaternions import product as hamilton
from ocs_design.device.bodies import PREFIX, flywheels_among
from ocs_design.export.raster import png_bytes
from ocs_design.export.snapshot import HEIGHT, WIDTH
from ocs_design.export.templates import fill
from ocs_design.report.bodies import ShownBody, still_picture
from ocs_design.report.html.elements import Markup, element, joined, json_element
from ocs_design.report.story import RecordedFlight, Story
from ocs_design.robot.mujoco_bodies import quaternion
from ocs_design.simulation.run import Poses


def view(story: Story, bodies: Sequence[ShownBody], scenarios: Sequence[str]) -> Markup:
    """Picture, canvas and controls; empty if there are no bodies."""
    if not bodies:
        return Markup("")
    options = (element("option", name, value=str(i)) for i, name in enumerate(scenarios))
    replay = fill("report/replay.html", {"scenarios": joined(options)}) if scenarios else ""
    values = {
        "picture": base64.b64encode(png_bytes(still_picture(bodies))).decode("ascii"),
        "name": escape(f"{story.design.robot.name} with its device, oblique view from the front"),
        "width": str(WIDTH),
        "height": str(HEIGHT),
        "replay": replay,
    }
    # Line breaks only help readers of the template.
    return Markup(fill("report/view.html", values).replace("\n", ""))


def view_data(story: Story, bodies: Sequence[ShownBody], scenarios: Sequence[str]) -> Markup:
    """Data for the script, at the end of the page so that the page shows first."""
    if not bodies:
        return Markup("")
    blob = Blob()
    scene = encoded_scene(bodies, story.flights, scenarios, blob)
    numbers = element("script", Markup(blob.text()), type="text/plain", id="scene-numbers")
    return joined((json_element("scene", json.dumps(scene, separators=(",", ":"))), numbers))


Record = dict[str, Any]
"""Value that becomes a JSON object."""

_INT16_MAX = 32767
"""Largest signed 16-bit number, for components of quaternions."""

_UINT16_MAX = 65535

_POSITION_SCALE = 1e4
"""Positions are rounded to a tenth of a millimetre, which compresses well."""

_SPACING = 1.25
"""Distance between two robots shown side by side, relative to the width of one."""


class Blob:
    """Concatenated arrays, which the script in the page unpacks."""

    def __init__(self) -> None:
        self._content = bytearray()

    def add(self, values: NDArray[Any], kind: str) -> Record:
        """Append an array as little-endian `f4`, `i2`, `u2` or `u4`; returns its position."""
        content = np.ascontiguousarray(values, dtype=f"<{kind}").tobytes()
        position = {"at": len(self._content), "kind": kind, "length": int(values.size)}
        # A typed array must start at a multiple of its element size.
        self._content += content + b"\0" * (-len(content) % 4)
        return position

    def text(self) -> str:
        """All arrays, compressed by zlib, in base64."""
        return base64.b64encode(zlib.compress(bytes(self._content), 6)).decode("ascii")


def encoded_scene(
    bodies: Sequence[ShownBody],
    flights: Sequence[RecordedFlight],
    scenarios: Sequence[str],
    blob: Blob,
) -> Record:
    """Everything that the viewer shows, for at least one body; its arrays go into the blob.

    Flights with poses can be replayed, in the order of `scenarios`.
    """
    low, high = _box(bodies)
    radius = _radius(low, high)
    device = _box([body for body in bodies if body.name.startswith(PREFIX)] or bodies)
    names = [body.name for body in bodies]
    wheels, records = flywheels_among(names), []
    for body in bodies:
        surfaces = []
        for surface in body.surfaces:
            points = surface.vertices
            low_corner, size = points.min(axis=0), np.ptp(points, axis=0)
            # Coordinates as fractions of the surface's box, 0..65535.
            offsets = points - low_corner
            fractions = np.divide(offsets, size, out=np.zeros_like(points), where=size > 0.0)
            kind = "u2" if len(points) <= _UINT16_MAX else "u4"
            record = {
                "color": list(surface.color),
                "low": low_corner.tolist(),
                "size": size.tolist(),
                "vertices": blob.add(np.round(_UINT16_MAX * fractions), "u2"),
                "faces": blob.add(surface.faces, kind),
            }
            surfaces.append(record)
        records.append(
            {
                "name": body.name,
                "device": body.name.startswith(PREFIX),
                "wheel": wheels.index(body.name) if body.name in wheels else None,
                "position": body.placement.position.tolist(),
                "attitude": list(map(float, quaternion(body.placement.rotation))),
                "surfaces": surfaces,
            }
        )
    return {
        "bodies": records,
        "trunk": 0,
        "middle": ((low + high) / 2.0).tolist(),
        "ground": float(low[2]),
        "reach": radius,
        "device": {"middle": np.mean(device, axis=0).tolist(), "reach": _radius(*device)},
        "tile": float(10.0 ** np.round(np.log10(radius / 2.0))),
        "apart": float(_SPACING * (high - low)[1]),
        "scenarios": list(scenarios),
        "flights": [
            _flight(flight, flight.poses, names, blob)
            for flight in flights
            if flight.poses is not None and set(names) <= set(flight.poses.bodies)
        ],
    }


def _flight(flight: RecordedFlight, poses: Poses, names: Sequence[str], blob: Blob) -> Record:
    columns = [poses.bodies.index(name) for name in names]
    tilt = [flight.columns[f"{axis}_rad"] for axis in ("pitch", "roll")]
    at_frames = [np.interp(poses.time, flight.time, np.degrees(angle)) for angle in tilt]
    # Without the wheels' own rotation, which is many turns from one pose to the next.
    attitude = poses.attitude.copy()
    for wheel, name in enumerate(flywheels_among(poses.bodies)):
        body = poses.bodies.index(name)
        backwards = from_axis_angle(np.array([0.0, 0.0, 1.0]), -poses.wheel_angle[:, wheel])
        attitude[:, body] = hamilton(attitude[:, body], backwards)
    return {
        "scenario": flight.record.scenario,
        "ocs": flight.record.ocs,
        # A robot on a pivot would swing through the floor.
        "floor": not flight.record.was_on_pivot,
        "frames": len(poses.time),
        "time": blob.add(poses.time, "f4"),
        "position": blob.add(
            np.round(_POSITION_SCALE * poses.position[:, columns]) / _POSITION_SCALE, "f4"
        ),
        "attitude": blob.add(np.round(_INT16_MAX * attitude[:, columns]), "i2"),
        "wheels": blob.add(poses.wheel_angle, "f4"),
        "tilt": blob.add(np.stack(at_frames, axis=1), "f4"),
    }


def _radius(low: FloatArray, high: FloatArray) -> float:
    """Radius of the sphere around a box."""
    return float(np.linalg.norm(high - low)) / 2.0


def _box(bodies: Sequence[ShownBody]) -> tuple[FloatArray, FloatArray]:
    """Lowest and highest corner of everything shown, in B [m]."""
    corners = np.concatenate(
        [
            surface.vertices @ body.placement.rotation.T + body.placement.position
            for body in bodies
            for surface in body.surfaces
        ]
    )
    return corners.min(axis=0), corners.max(axis=0)
