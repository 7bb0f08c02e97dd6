"""STEP files, read again by Open CASCADE, against the closed form."""

import re
from dataclasses import dataclass

import numpy as np
import pytest
from built import CAGED_DEVICE
from made_parts import PARTS, TUBE

from ocs_design.common.arrays import FloatArray

pytest.importorskip("OCP", reason="Open CASCADE is the extra [step]")
from OCP.BRepCheck import BRepCheck_Analyzer
from OCP.BRepGProp import BRepGProp
from OCP.GProp import GProp_GProps
from OCP.STEPControl import STEPControl_Reader
from OCP.TopAbs import TopAbs_ShapeEnum
from OCP.TopExp import TopExp_Explorer
from OCP.TopoDS import TopoDS_Shape

from ocs_design.export.assembly.placed import placed_parts
from ocs_design.export.step import module_bytes, step_bytes

TOLERANCE = 1e-9


@dataclass(frozen=True)
class Volume:
    """What Open CASCADE integrates over faces, in SI, of unit density about the centre of mass."""

    volume: float
    com: FloatArray
    second: FloatArray


def read(path) -> TopoDS_Shape:
    reader = STEPControl_Reader()
    reader.ReadFile(str(path))
    assert reader.TransferRoots() == 1
    return reader.OneShape()


def integrated(shape: TopoDS_Shape) -> Volume:
    properties = GProp_GProps()
    BRepGProp.VolumeProperties_s(shape, properties)
    com, matrix = properties.CentreOfMass(), properties.MatrixOfInertia()
    entries = [[matrix.Value(i, j) for j in (1, 2, 3)] for i in (1, 2, 3)]
    centre = np.array([com.X(), com.Y(), com.Z()])
    return Volume(properties.Mass() * 1e-9, centre * 1e-3, np.array(entries) * 1e-15)


@pytest.mark.parametrize("part", PARTS.values(), ids=PARTS)
def test_solid_weighs_what_the_closed_form_says(part, tmp_path, record_property):
    (tmp_path / "part.step").write_bytes(step_bytes(part))
    shape = read(tmp_path / "part.step")
    assert shape.ShapeType() == TopAbs_ShapeEnum.TopAbs_SOLID
    assert BRepCheck_Analyzer(shape).IsValid()
    found, exact = integrated(shape), part.mass_properties()
    inertia = np.abs(found.second * part.density - exact.inertia).max() / exact.inertia.max()
    record_property("inertia_error", float(inertia))
    assert found.volume * part.density == pytest.approx(exact.mass, rel=TOLERANCE)
    assert inertia < TOLERANCE
    np.testing.assert_allclose(found.com, exact.com, atol=1e-12)


def test_file_bears_the_name_and_no_clock():
    content = step_bytes(TUBE)
    assert b"PRODUCT('tube','tube'" in content
    assert b"AUTOMOTIVE_DESIGN { 1 0 10303 214" in content
    assert b"SI_UNIT(.MILLI.,.METRE.)" in content
    assert content == step_bytes(TUBE)


def test_nothing_is_printed(capfd):
    step_bytes(TUBE)
    assert capfd.readouterr() == ("", "")


def test_a_module_has_all_its_pieces_in_their_places(tmp_path):
    """Motor and cage among them: as many solids as pieces, each of its volume, at its place."""
    (tmp_path / "module.step").write_bytes(module_bytes(CAGED_DEVICE))
    shape = read(tmp_path / "module.step")
    solids, found = TopExp_Explorer(shape, TopAbs_ShapeEnum.TopAbs_SOLID), []
    while solids.More():
        found.append(integrated(solids.Current()))
        solids.Next()
    placed, text = placed_parts(CAGED_DEVICE), module_bytes(CAGED_DEVICE).decode()
    assert text == (tmp_path / "module.step").read_text()
    assert re.findall(r"PRODUCT\('(\w+)'", text) == ["module", *placed]
    assert {"motor", "cage", "drum", "lid", "foot"} <= set(placed)
    assert len(found) == len(placed)
    for part, place in placed.values():
        own = part.mass_properties()
        at, volume = place.rotation @ own.com + place.position, own.mass / part.density
        assert any(
            solid.volume == pytest.approx(volume, rel=TOLERANCE)
            and np.linalg.norm(solid.com - at) < 1e-9
            for solid in found
        )
