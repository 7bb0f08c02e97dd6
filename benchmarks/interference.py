"""Common volume of all solids of written devices over the turns of their wheels, and what stands.

    python benchmarks/interference.py FOLDER [FOLDER ...]

Each FOLDER is what `ocs-design size` wrote. Everything is measured in its exported MJCF and in the
meshes beside it: parts where MuJoCo puts them, booleans by manifold3d, the trunk's surface by
vertical rays. Nothing of the program is used, so that what it believes of its own geometry is not
asked. Prints a Markdown table: pairs of parts, the largest common volume of any, the smallest gap
between a wheel and its housing, and the area of the plate or of the feet that is within 0.5 mm of
the trunk, with the deepest place below its surface. A mast stands behind the trunk and has none.
"""

import sys
from itertools import combinations
from pathlib import Path

import mujoco
import numpy as np
from manifold3d import Error, Manifold, Mesh64

MESH, BOX, CYLINDER = (
    int(getattr(mujoco.mjtGeom, f"mjGEOM_{kind}")) for kind in ("MESH", "BOX", "CYLINDER")
)

STEP = np.radians(5.0)
"""Between two places of a wheel [rad]."""

GRID = 5e-4
"""Distance of the rays [m]."""

REACH = 0.02
"""Gaps beyond which none is looked for [m]."""


class Written:
    """A device as its files have it, in the posture of the keyframe."""

    def __init__(self, folder):
        (path,) = Path(folder).glob("robot/*_ocs.xml")
        self.model = mujoco.MjModel.from_xml_path(str(path))
        self.data = mujoco.MjData(self.model)
        mujoco.mj_resetDataKeyframe(self.model, self.data, 0)
        mujoco.mj_kinematics(self.model, self.data)
        self.own, self.robot = {}, []
        for geom in range(self.model.ngeom):
            body = self.model.body(self.model.geom_bodyid[geom]).name
            kind = self.model.geom_type[geom]
            if not body.startswith("ocs_"):
                self.robot.append(geom)
            elif self.model.geom_group[geom] != 3:
                mesh = kind == MESH
                part = self.model.mesh(self.model.geom_dataid[geom]).name if mesh else "motor"
                self.own[body, part] = geom

    def triangles(self, geom):
        """Corners of a mesh or a box in the world [m], shape (n, 3, 3)."""
        if self.model.geom_type[geom] == BOX:
            found = Manifold.cube(2.0 * self.model.geom_size[geom], center=True).to_mesh64()
            places = found.vert_properties @ self.data.geom_xmat[geom].reshape(3, 3).T
            return (places + self.data.geom_xpos[geom])[found.tri_verts.astype(int)]
        mesh = self.model.geom_dataid[geom]
        start, count = self.model.mesh_vertadr[mesh], self.model.mesh_vertnum[mesh]
        places = np.array(self.model.mesh_vert[start : start + count], float)
        places = places @ self.data.geom_xmat[geom].reshape(3, 3).T + self.data.geom_xpos[geom]
        start, count = self.model.mesh_faceadr[mesh], self.model.mesh_facenum[mesh]
        return places[self.model.mesh_face[start : start + count]]

    def solid(self, geom):
        """A mesh, or a motor's cylinder, in the world."""
        if self.model.geom_type[geom] == CYLINDER:
            radius, half, _ = self.model.geom_size[geom]
            solid = Manifold.cylinder(2.0 * half, radius, circular_segments=128, center=True)
            turned = self.data.geom_xmat[geom].reshape(3, 3)
            return solid.transform(np.column_stack([turned, self.data.geom_xpos[geom]]))
        corners = self.triangles(geom).reshape(-1, 3)
        points, faces = np.unique(np.round(corners, 9), axis=0, return_inverse=True)
        solid = Manifold(Mesh64(points, faces.reshape(-1, 3).astype(np.uint64)))
        assert solid.status() == Error.NoError, "a part's mesh is closed"
        return solid


def overlaps(device):
    """Largest common volume of each pair over the turns [m^3], and the least gap of a wheel [m]."""
    still = {key: device.solid(geom) for key, geom in device.own.items()}
    wheels = {body for body, part in device.own if body.endswith("_flywheel")}
    common = {
        pair: (still[pair[0]] ^ still[pair[1]]).volume()
        for pair in combinations(still, 2)
        if not {body for body, _ in pair} & wheels
    }
    gap = REACH
    for key, geom in device.own.items():
        if key[0] not in wheels:
            continue
        joint = device.model.body_jntadr[device.model.body(key[0]).id]
        place = device.model.jnt_qposadr[joint]
        start = device.data.qpos[place]
        for angle in np.arange(0.0, 2.0 * np.pi, STEP):
            device.data.qpos[place] = start + angle
            mujoco.mj_kinematics(device.model, device.data)
            wheel = device.solid(geom)
            for other, solid in still.items():
                if other != key:
                    volume = (wheel ^ solid).volume()
                    common[key, other] = max(volume, common.get((key, other), 0.0))
                    housed = other[0].split("_")[1] == key[0].split("_")[1]
                    if housed and other[1] == "ocs_housing":
                        gap = min(gap, wheel.min_gap(solid, REACH))
        device.data.qpos[place] = start
    mujoco.mj_kinematics(device.model, device.data)
    return common, gap


def heights(triangles, places, *, highest):
    """Highest or lowest z of triangles over places [m]; infinite where there is none."""
    sign = 1.0 if highest else -1.0
    extremes = np.full(len(places), -np.inf)
    low, high = places.min(axis=0), places.max(axis=0)
    flat = triangles[:, :, :2]
    for a, b, c in triangles[((flat.max(1) >= low) & (flat.min(1) <= high)).all(axis=1)]:
        area = (b[1] - c[1]) * (a[0] - c[0]) + (c[0] - b[0]) * (a[1] - c[1])
        if abs(area) < 1e-16:
            continue
        ends = np.array([a, b, c])[:, :2]
        near = np.flatnonzero(((places >= ends.min(0)) & (places <= ends.max(0))).all(axis=1))
        x, y = (places[near] - c[:2]).T
        one = ((b[1] - c[1]) * x + (c[0] - b[0]) * y) / area
        two = ((c[1] - a[1]) * x + (a[0] - c[0]) * y) / area
        inside = (one >= -1e-9) & (two >= -1e-9) & (one + two <= 1.0 + 1e-9)
        z = one * a[2] + two * b[2] + (1.0 - one - two) * c[2]
        extremes[near[inside]] = np.maximum(extremes[near[inside]], sign * z[inside])
    return sign * extremes


def standing(device):
    """Area on the trunk [m^2], and the deepest place below its surface [m]; None: no shape."""
    model = device.model
    on_plate = {key: geom for key, geom in device.own.items() if key[0] == "ocs_plate"}
    feet = on_plate or {key: geom for key, geom in device.own.items() if key[1] == "ocs_foot"}
    trunk = model.body_weldid[model.body(next(iter(feet))[0]).id]
    shown = [
        geom
        for geom in device.robot
        if model.body_weldid[model.geom_bodyid[geom]] == trunk
        and model.geom_type[geom] in (MESH, BOX)
        and model.geom_group[geom] != 3
    ]
    if not shown:
        return None
    surface = np.concatenate([device.triangles(geom) for geom in shown])
    area, deepest = 0.0, 0.0
    for geom in feet.values():
        under = device.triangles(geom)
        normals = np.cross(under[:, 1] - under[:, 0], under[:, 2] - under[:, 0])
        under = under[normals[:, 2] < -0.99 * np.linalg.norm(normals, axis=1)]
        ends = under[:, :, :2].reshape(-1, 2)
        rows = [np.arange(*limits, GRID) for limits in zip(ends.min(0), ends.max(0), strict=True)]
        places = np.stack(np.meshgrid(*rows), axis=-1).reshape(-1, 2)
        low = heights(under, places, highest=False)
        over = np.isfinite(low)
        gaps = low[over] - heights(surface, places[over], highest=True)
        gaps = gaps[np.isfinite(gaps)]
        area += GRID**2 * np.count_nonzero(np.abs(gaps) < 5e-4)
        deepest = max(deepest, -float(gaps.min(initial=0.0)))
    return area, deepest


def main() -> None:
    print("| device | pairs | common volume [mm3] | gap [mm] | on the trunk [mm2] | deepest [mm] |")
    print("|---|---|---|---|---|---|")
    for folder in sys.argv[1:]:
        device = Written(folder)
        common, gap = overlaps(device)
        stands = standing(device)
        told = " | " if stands is None else f"{1e6 * stands[0]:.0f} | {1e3 * stands[1]:.2f}"
        most = 1e9 * max(common.values())
        print(f"| {Path(folder).name} | {len(common)} | {most:.3f} | {1e3 * gap:.2f} | {told} |")


if __name__ == "__main__":
    main()
