"""The bill of materials and the first screen's figures, calculated once more from the files alone.

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


@pytest.fixture(scope="module", params=slow_subset(2, SIZED))
def sized(request, tmp_path_factory, no_alternatives):
    """What `size` said, its design and its parts as meshes [m]."""
    out = tmp_path_factory.mktemp("bill") / "out"
    asked = (*SIZED[request.param], "--gear", "direct", "--no-validate", "-v", "-o", out)
    with writing_only("stl", "printed", "bom", "mjcf"):
        said = run("size", *asked)
    assert said.code in {0, 1}, said.output
    with (out / "cad" / "bill_of_materials.csv").open(encoding="utf-8") as stream:
        rows = list(csv.DictReader(stream))
    meshes = {path.stem: trimesh.load(path) for path in (out / "cad").glob("*.stl")}
    for mesh in meshes.values():
        mesh.apply_scale(1e-3)
    design = json.loads((out / "design.json").read_text())
    return SimpleNamespace(
        said=said.output, out=out, rows=rows, meshes=meshes, design=design, ocs=design["ocs"],
        motor=catalogue_row("motors.csv", design["ocs"]["motor"]["name"]),
    )  # fmt: skip


def row(sized, start):
    (found,) = (each for each in sized.rows if each["part"].startswith(start))
    return found


def grams(sized, start):
    """Of one of it; 0 where there is none."""
    known = [float(r["mass each [g]"]) for r in sized.rows if r["part"].startswith(start)]
    return known[0] if known else 0.0


def weighed(sized, density, *names):
    return 1e3 * density * sum(sized.meshes[name].volume for name in names)


def holes(mesh):
    """Through holes of a solid of one piece: its genus, from Euler's formula."""
    assert mesh.body_count == 1
    return (2 - mesh.euler_number) // 2


def screw_mass(name, length):
    """Of a solid head with its socket, and a thread of its stress area [g]."""
    d, head, tall, pitch, key, deep = ISO_4762[name]
    bolt = math.pi / 4.0 * (d - 0.9382 * pitch) ** 2 * length
    return 1e-6 * STEEL * (math.pi / 4.0 * head**2 * tall - 0.75**0.5 * key**2 * deep + bolt)


def test_every_part_weighs_its_volume(sized):
    wheel = sized.ocs["flywheel"]
    density = float(catalogue_row("materials.csv", wheel["material"])["density_kg_m3"])
    for start, expected in (
        ("flywheel", weighed(sized, density, "flywheel")),
        ("housing", weighed(sized, PETG, "housing_drum", "housing_lid")),
        ("foot", weighed(sized, PETG, "housing_foot")),
        ("cage", weighed(sized, PETG, "housing_cage")),
        ("plate", weighed(sized, ALUMINIUM, "plate")),
        (
            f"motor {sized.motor['maker']} {sized.motor['name']}",
            1e3 * float(sized.motor["mass_kg"]),
        ),
    ):
        assert grams(sized, start) == pytest.approx(expected, rel=5e-4), start
    if sized.ocs["guard_wall"]:
        ring = weighed(sized, STEEL, "guard_ring")
        assert grams(sized, "guard ring") == pytest.approx(ring, rel=5e-4)
        _, high = sized.meshes["guard_ring"].bounds
        assert high[0] - wheel["outer_radius"] - 1.9e-3 == pytest.approx(
            sized.ocs["guard_wall"], abs=2e-5
        )


def test_a_controller_weighs_by_its_current(sized):
    """Of a phase's amplitude: of six-step current through two lines, 2 / sqrt(3)."""
    specified = r"Controllers: ([\d.]+) g each, plus ([\d.]+) g per"
    base, rate = re.search(specified, sized.output).groups()
    peak = float(sized.motor["peak_current_a"]) * 2.0 / math.sqrt(3.0)
    assert grams(sized, "motor controller") == pytest.approx(
        float(base) + float(rate) * peak, abs=0.05
    )


def test_screws_fill_the_holes_and_weigh_what_iso_4762_says(sized):
    """Kinds, counts by the parts' holes, and the shortest length whose thread is deep enough.

    But the longest that ends 0.5 mm off the 3.6 mm of thread that a model draws in the stator, and
    above the underside of the plate even at its upper limit, js15.
    """
    meshes, plate = sized.meshes, sized.ocs["plate"]
    lid = floor = float(np.ptp(meshes["housing_lid"].vertices[:, 2]))
    thick = {round(1e3 * s, 5): plate["sleeves"].count(s) for s in plate["sleeves"]}
    windows = 2 if plate["window"] else 0
    assert holes(meshes["housing_lid"]) == 4
    assert (
        holes(meshes["plate"])
        == windows + len(plate["feet"]) + len(plate["trunk"])
        == (windows + 8)
    )
    # The drum's floor: what turns in the middle, and the cage's screws around it.
    assert holes(meshes["housing_drum"]) == 1 + 4
    stator = int(sized.motor["stator_bolts"])
    metal, printed, stem = 1.0, 2.0, 1e3 * sized.ocs["foot_plate"]
    washer = 0.8 if any(each["part"].startswith("washer") for each in sized.rows) else 0.0
    expected = {
        "motor in its cage": (2 * stator, [max(3.0, 0.42 * stem)], metal),
        "housing and foot on cage": (8, [1e3 * floor + stem], printed),
        "lid on drum": (8, [1e3 * lid], printed),
        "foot on plate": (4, [max(3.0, 0.6 * stem) + washer], metal),
        "plate on trunk": (4, [1e3 * plate["thickness"] + each for each in thick], metal),
    }
    found = dict.fromkeys(expected, 0)
    for each in sized.rows:
        if not each["part"].startswith("screw") or each["remark"].startswith("wheel"):
            continue
        name, length = re.fullmatch(r"screw ISO 4762 (M\d) x (\d+)", each["part"]).groups()
        counted = re.search(r"weighed as ISO 4762 M\d x (\d+)", each["remark"])
        assert float(each["mass each [g]"]) == pytest.approx(
            screw_mass(name, int(counted[1] if counted else length)), abs=6e-4
        )
        purpose = next(key for key in expected if each["remark"].startswith(key))
        found[purpose] += int(each["quantity"])
        _, through, depth = expected[purpose]
        needed = [least + depth * ISO_4762[name][0] for least in through]
        fits = {next(n for n in LENGTHS if n >= each - 1e-6) for each in needed}
        room = {
            "motor in its cage": through[0] + 3.1,
            "foot on plate": through[0]
            + 1e3 * plate["thickness"]
            - (0.24 if fits <= {6} else 0.29),
        }.get(purpose, math.inf)
        shorter = {max(n for n in LENGTHS if n <= min(fit, room)) for fit in fits}
        assert int(length) in shorter, (each, through, room)
    assert found == {key: count for key, (count, _, _) in expected.items()}


def test_sums_are_those_of_design_and_screen(sized):
    rows = [each for each in sized.rows if each["mass [g]"]]
    *parts, total = rows
    for each in parts:
        product = int(each["quantity"]) * float(each["mass each [g]"])
        assert float(each["mass [g]"]) == pytest.approx(product, abs=0.01)
    whole = sum(float(each["mass [g]"]) for each in parts)
    assert float(total["mass [g]"]) == pytest.approx(whole, abs=0.01)
    assert 1e-3 * whole == pytest.approx(sized.ocs["mass_total"], abs=2e-5)
    shown = sized.output
    assert re.search(r"carrier plate ([\d.]+) g", shown)[1] == f"{_plate(sized):.1f}"
    wheel, density = sized.ocs["flywheel"], sized.ocs["flywheel"]["density"]
    outer, inner, tall = (wheel[k] for k in ("outer_radius", "inner_radius", "height"))
    cut = 0.2e-3
    # Two faces, an edge outside and one inside, by Pappus' theorem.
    edges = math.pi * cut**2 * 2.0 * (outer - cut / 3.0 + inner + cut / 3.0)
    rim = 1e3 * density * (math.pi * (outer**2 - inner**2) * tall - edges)
    around = re.search(r"rim ([\d.]+), web ([\d.]+), motor .* housing ([\d.]+) g", shown).groups()
    web = grams(sized, "flywheel") - rim
    printed = [r for r in parts if not r["part"].startswith(("flywheel", "motor", "plate", "slee"))]
    housing = sum(float(r["mass [g]"]) for r in printed if "plate on" not in r["remark"]) / 2.0
    assert [float(each) for each in around] == pytest.approx([rim, web, housing], abs=0.06)


def _plate(sized):
    """Plate, sleeves and the trunk's screws [g]."""
    return sum(
        float(r["mass [g]"])
        for r in sized.rows
        if r["part"].startswith(("plate", "sleeve")) or r["remark"].startswith("plate on trunk")
    )


def test_inertia_places_and_centre_of_mass(sized):
    """Of the wheel's mesh and its rotor; of the bodies that MuJoCo reads."""
    wheel, motor = sized.ocs["flywheel"], sized.motor
    mesh = sized.meshes["flywheel"]
    mesh.density = wheel["density"]
    rotor = 0.05 * float(motor["mass_kg"]) * float(motor["diameter_m"]) ** 2
    spin = mesh.moment_inertia[2, 2] + rotor
    assert sized.ocs["spin_inertia"] == pytest.approx(spin, rel=5e-4)
    shown = re.search(
        r"spin inertia ([\d.]+) kg mm2 each, of which its rotor ([\d.]+) kg mm2", sized.output
    )
    assert [1e-6 * float(each) for each in shown.groups()] == pytest.approx([spin, rotor], rel=1e-3)
    (path,) = (sized.out / "robot").glob("*_ocs.xml")
    model = mujoco.MjModel.from_xml_path(str(path))
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    mujoco.mj_kinematics(model, data)
    mujoco.mj_comPos(model, data)
    own = [i for i in range(model.nbody) if model.body(i).name.startswith("ocs_")]
    mass = model.body_mass[own]
    assert sum(mass) == pytest.approx(sized.ocs["mass_total"], rel=1e-6)
    base = model.body(model.body_parentid[own[0]])
    turn = data.body(base.id).xmat.reshape(3, 3)
    middle = turn.T @ (mass @ data.xipos[own] / sum(mass) - data.body(base.id).xpos)
    np.testing.assert_allclose(sized.ocs["center_of_mass"], middle, atol=1e-6)
