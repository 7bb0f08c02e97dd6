"""The bill of materials and the printed figures, recalculated from the files alone.

Volumes of the STL files times densities, screws by the dimensions of ISO 4762 and the holes that
the STL files have, bought parts by their rows in the catalogue.
"""

import csv
import json
import math
import re
from types import SimpleNamespace

import mujoco
import numpy as np
import pytest
import trimesh
from commands import run, writing_only
from flown_margins import catalogue_row
from robots import ROBOTS, SOLO12
from subsets import slow_subset

PETG, ALUMINIUM, STEEL = 1270.0, 2710.0, 7850.0
ISO_4762 = {
    "M2": (2.0, 3.8, 2.0, 0.4, 1.5, 1.0),
    "M3": (3.0, 5.5, 3.0, 0.5, 2.5, 1.3),
    "M4": (4.0, 7.0, 4.0, 0.7, 3.0, 2.0),
}
"""Thread, head's diameter and height, pitch, socket's width and depth [mm]."""
LENGTHS = (4, 5, 6, 8, 10, 12, 16, 20, 25, 30)
GO2 = ROBOTS / "go2_description/urdf/go2.urdf"
SIZED = {
    "solo12": (SOLO12, "--motor", "Antigravity MN5006 KV450"),
    "go2": (GO2, "--motor", "U8 Lite L KV110"),
    "in rings": (SOLO12, "--motor", "AT2820 KV1050", "--guard", "containing"),
}


@pytest.fixture(scope="module", params=slow_subset(3, SIZED))
def sized(request, tmp_path_factory, no_alternatives):
    """Output of `size`, its design, bill and catalogue row, and its parts as meshes [m]."""
    out = tmp_path_factory.mktemp("bill") / "out"
    options = (*SIZED[request.param], "--gear", "direct", "--no-validate", "-v", "-o", out)
    with writing_only("stl", "printed", "bom", "mjcf"):
        result = run("size", *options)
    assert result.code in {0, 1}, result.output
    with (out / "cad" / "bill_of_materials.csv").open(encoding="utf-8") as stream:
        rows = list(csv.DictReader(stream))
    meshes = {path.stem: trimesh.load(path) for path in (out / "cad").glob("*.stl")}
    for mesh in meshes.values():
        mesh.apply_scale(1e-3)
    design = json.loads((out / "design.json").read_text())
    return SimpleNamespace(
        text=result.output, out=out, rows=rows, meshes=meshes, design=design, ocs=design["ocs"],
        motor=catalogue_row("motors.csv", design["ocs"]["motor"]["name"]),
    )  # fmt: skip


def row(sized, start):
    (matching,) = (row for row in sized.rows if row["part"].startswith(start))
    return matching


def mass_of(sized, start):
    """Mass of one such part [g], 0 where there is none."""
    masses = [float(r["mass each [g]"]) for r in sized.rows if r["part"].startswith(start)]
    return masses[0] if masses else 0.0


def mass_of_meshes(sized, density, *names):
    return 1e3 * density * sum(sized.meshes[name].volume for name in names)


def holes(mesh):
    """Through holes of a solid of one piece: its genus, from Euler's formula."""
    assert mesh.body_count == 1
    return (2 - mesh.euler_number) // 2


def screw_mass(name, length):
    """Mass of a screw with its socket and a thread of its stress area [g]."""
    d, head, height, pitch, socket, depth = ISO_4762[name]
    bolt = math.pi / 4.0 * (d - 0.9382 * pitch) ** 2 * length
    return 1e-6 * STEEL * (math.pi / 4.0 * head**2 * height - 0.75**0.5 * socket**2 * depth + bolt)


def test_every_part_has_the_mass_of_its_volume(sized):
    wheel = sized.ocs["flywheel"]
    density = float(catalogue_row("materials.csv", wheel["material"])["density_kg_m3"])
    for start, expected in (
        ("flywheel", mass_of_meshes(sized, density, "flywheel")),
        ("housing", mass_of_meshes(sized, PETG, "housing_drum", "housing_lid")),
        ("foot", mass_of_meshes(sized, PETG, "housing_foot")),
        ("cage", mass_of_meshes(sized, PETG, "housing_cage")),
        ("plate", mass_of_meshes(sized, ALUMINIUM, "plate")),
        (
            f"motor {sized.motor['maker']} {sized.motor['name']}",
            1e3 * float(sized.motor["mass_kg"]),
        ),
    ):
        assert mass_of(sized, start) == pytest.approx(expected, rel=5e-4), start
    if sized.ocs["guard_wall"]:
        ring = mass_of_meshes(sized, STEEL, "guard_ring")
        assert mass_of(sized, "guard ring") == pytest.approx(ring, rel=5e-4)
        _, high = sized.meshes["guard_ring"].bounds
        assert high[0] - wheel["outer_radius"] - 1.9e-3 == pytest.approx(
            sized.ocs["guard_wall"], abs=2e-5
        )


def test_the_mass_of_a_controller_grows_with_its_current(sized):
    """The amplitude of a phase is 2 / sqrt(3) times the six-step current through two lines."""
    pattern = r"Controllers: ([\d.]+) g each, plus ([\d.]+) g per"
    base, rate = re.search(pattern, sized.text).groups()
    peak = float(sized.motor["peak_current_a"]) * 2.0 / math.sqrt(3.0)
    assert mass_of(sized, "motor controller") == pytest.approx(
        float(base) + float(rate) * peak, abs=0.05
    )


def test_screws_fit_the_holes_with_masses_of_iso_4762(sized):
    """Sizes, counts by the holes of the parts, and the shortest length that is deep enough.

    Where space is limited, the longest that ends 0.5 mm before the end of the stator's thread,
    3.6 mm in a CAD model, and above the underside of the plate at its upper limit of js15.
    """
    meshes, plate = sized.meshes, sized.ocs["plate"]
    lid = floor = float(np.ptp(meshes["housing_lid"].vertices[:, 2]))
    sleeves = {round(1e3 * s, 5): plate["sleeves"].count(s) for s in plate["sleeves"]}
    windows = 2 if plate["window"] else 0
    assert holes(meshes["housing_lid"]) == 4
    assert (
        holes(meshes["plate"])
        == windows + len(plate["feet"]) + len(plate["trunk"])
        == (windows + 8)
    )
    # The drum's floor: a hole for the rotor in the middle, and the cage's screws around it.
    assert holes(meshes["housing_drum"]) == 1 + 4
    stator = int(sized.motor["stator_bolts"])
    metal, printed, stem = 1.0, 2.0, 1e3 * sized.ocs["foot_plate"]
    washer = 0.8 if any(row["part"].startswith("washer") for row in sized.rows) else 0.0
    expected = {
        "motor in its cage": (2 * stator, [max(3.0, 0.42 * stem)], metal),
        "housing and foot on cage": (8, [1e3 * floor + stem], printed),
        "lid on drum": (8, [1e3 * lid], printed),
        "foot on plate": (4, [max(3.0, 0.6 * stem) + washer], metal),
        "plate on trunk": (4, [1e3 * plate["thickness"] + sleeve for sleeve in sleeves], metal),
    }
    counts = dict.fromkeys(expected, 0)
    for row in sized.rows:
        if not row["part"].startswith("screw") or row["remark"].startswith("wheel"):
            continue
        name, length = re.fullmatch(r"screw ISO 4762 (M\d) x (\d+)", row["part"]).groups()
        counted = re.search(r"weighed as ISO 4762 M\d x (\d+)", row["remark"])
        assert float(row["mass each [g]"]) == pytest.approx(
            screw_mass(name, int(counted[1] if counted else length)), abs=6e-4
        )
        purpose = next(key for key in expected if row["remark"].startswith(key))
        counts[purpose] += int(row["quantity"])
        _, through, depth = expected[purpose]
        needed = [least + depth * ISO_4762[name][0] for least in through]
        enough = {next(n for n in LENGTHS if n >= least - 1e-6) for least in needed}
        limits = {
            "motor in its cage": through[0] + 3.1,
            "foot on plate": through[0]
            + 1e3 * plate["thickness"]
            - (0.24 if enough <= {6} else 0.29),
        }.get(purpose, math.inf)
        shorter = {max(n for n in LENGTHS if n <= min(fit, limits)) for fit in enough}
        assert int(length) in shorter, (row, through, limits)
    assert counts == {key: count for key, (count, _, _) in expected.items()}


def test_sums_agree_with_design_and_output(sized):
    rows = [row for row in sized.rows if row["mass [g]"]]
    *parts, total = rows
    for row in parts:
        product = int(row["quantity"]) * float(row["mass each [g]"])
        assert float(row["mass [g]"]) == pytest.approx(product, abs=0.01)
    mass = sum(float(row["mass [g]"]) for row in parts)
    assert float(total["mass [g]"]) == pytest.approx(mass, abs=0.01)
    assert 1e-3 * mass == pytest.approx(sized.ocs["mass_total"], abs=2e-5)
    text = sized.text
    assert re.search(r"carrier plate ([\d.]+) g", text)[1] == f"{_plate_mass(sized):.1f}"
    wheel, density = sized.ocs["flywheel"], sized.ocs["flywheel"]["density"]
    outer, inner, height = (wheel[k] for k in ("outer_radius", "inner_radius", "height"))
    chamfer = 0.2e-3
    # Chamfers of both faces, outside and inside, by Pappus' theorem.
    edges = math.pi * chamfer**2 * 2.0 * (outer - chamfer / 3.0 + inner + chamfer / 3.0)
    rim = 1e3 * density * (math.pi * (outer**2 - inner**2) * height - edges)
    masses = re.search(r"rim ([\d.]+), web ([\d.]+), motor .* housing ([\d.]+) g", text).groups()
    web = mass_of(sized, "flywheel") - rim
    printed = [r for r in parts if not r["part"].startswith(("flywheel", "motor", "plate", "slee"))]
    housing = sum(float(r["mass [g]"]) for r in printed if "plate on" not in r["remark"]) / 2.0
    assert [float(mass) for mass in masses] == pytest.approx([rim, web, housing], abs=0.06)


def _plate_mass(sized):
    """Mass of plate, sleeves and screws into the trunk [g]."""
    return sum(
        float(r["mass [g]"])
        for r in sized.rows
        if r["part"].startswith(("plate", "sleeve")) or r["remark"].startswith("plate on trunk")
    )


def test_spin_inertia_and_centre_of_mass(sized):
    """Spin inertia of the wheel's mesh and its rotor; centre of mass of the bodies in MuJoCo."""
    wheel, motor = sized.ocs["flywheel"], sized.motor
    mesh = sized.meshes["flywheel"]
    mesh.density = wheel["density"]
    rotor = 0.05 * float(motor["mass_kg"]) * float(motor["diameter_m"]) ** 2
    spin = mesh.moment_inertia[2, 2] + rotor
    assert sized.ocs["spin_inertia"] == pytest.approx(spin, rel=5e-4)
    match = re.search(
        r"spin inertia ([\d.]+) kg mm2 each, of which its rotor ([\d.]+) kg mm2", sized.text
    )
    assert [1e-6 * float(inertia) for inertia in match.groups()] == pytest.approx(
        [spin, rotor], rel=1e-3
    )
    (path,) = (sized.out / "robot").glob("*_ocs.xml")
    model = mujoco.MjModel.from_xml_path(str(path))
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    mujoco.mj_kinematics(model, data)
    mujoco.mj_comPos(model, data)
    bodies = [i for i in range(model.nbody) if model.body(i).name.startswith("ocs_")]
    mass = model.body_mass[bodies]
    assert sum(mass) == pytest.approx(sized.ocs["mass_total"], rel=1e-6)
    base = model.body(model.body_parentid[bodies[0]])
    rotation = data.body(base.id).xmat.reshape(3, 3)
    centre = rotation.T @ (mass @ data.xipos[bodies] / sum(mass) - data.body(base.id).xpos)
    np.testing.assert_allclose(sized.ocs["center_of_mass"], centre, atol=1e-6)
