"""STEP files, read again by Open CASCADE, against the closed form."""

from dataclasses import dataclass, replace

import numpy as np
import pytest
from built_devices import CAGED_DEVICE, DEVICES, MAST_PLATE
from sample_parts import PARTS, TUBE

from ocs_design.common.arrays import FloatArray

pytest.importorskip("OCP", reason="Open CASCADE is the extra [step]")
from OCP.BRepCheck import BRepCheck_Analyzer
from OCP.BRepGProp import BRepGProp
from OCP.collections import Sequence_TDF_Label
from OCP.GProp import GProp_GProps
from OCP.Quantity import Quantity_Color, Quantity_TypeOfColor
from OCP.STEPCAFControl import STEPCAFControl_Reader
from OCP.STEPControl import STEPControl_Reader
from OCP.TCollection import TCollection_ExtendedString
from OCP.TDataStd import TDataStd_Name
from OCP.TDF import TDF_Label
from OCP.TDocStd import TDocStd_Document
from OCP.TopAbs import TopAbs_ShapeEnum
from OCP.TopLoc import TopLoc_Location
from OCP.TopoDS import TopoDS_Shape
from OCP.XCAFApp import XCAFApp_Application
from OCP.XCAFDoc import XCAFDoc_ColorType, XCAFDoc_DocumentTool, XCAFDoc_ShapeTool

from ocs_design.common.frames import FORWARDS, Placement
from ocs_design.device.bodies import STEEL, carrier_placement, wheel_placement
from ocs_design.export.assembly.placed import placed_parts
from ocs_design.export.bill_of_materials import bill_rows
from ocs_design.export.step import device_bytes, module_bytes, step_bytes
from ocs_design.export.visuals import ALUMINIUM, MOTOR, PRINT
from ocs_design.parts.carrier_plate import plate_bodies, plate_part
from ocs_design.parts.solids import Part, Relief

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


SMALL = "wheel", "foot", "slotted", "tube"


@pytest.mark.parametrize(
    "part",
    [
        pytest.param(part, marks=[pytest.mark.slow] * (name not in SMALL), id=name)
        for name, part in PARTS.items()
    ],
)
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


@dataclass(frozen=True)
class Shown:
    """A solid in the tree of a file, with all names from the root to it."""

    path: tuple[str, ...]
    color: tuple[float, ...]
    solid: Volume


def tree(path) -> list[Shown]:
    """What a CAD program shows of an assembly, by XCAF."""
    document = TDocStd_Document(TCollection_ExtendedString("BinXCAF"))
    XCAFApp_Application.GetApplication_s().InitDocument(document)
    reader = STEPCAFControl_Reader()
    reader.ReadFile(str(path))
    assert reader.Transfer(document)
    shapes = XCAFDoc_DocumentTool.ShapeTool_s(document.Main())
    colors = XCAFDoc_DocumentTool.ColorTool_s(document.Main())

    def name(label):
        found = TDataStd_Name()
        assert label.FindAttribute(TDataStd_Name.GetID_s(), found)
        return found.Get().ToExtString()

    def below(label, names, place):
        if XCAFDoc_ShapeTool.IsReference_s(label):
            referred = TDF_Label()
            XCAFDoc_ShapeTool.GetReferredShape_s(label, referred)
            here = place.Multiplied(XCAFDoc_ShapeTool.GetLocation_s(label))
            yield from below(referred, (*names, name(label)), here)
        elif XCAFDoc_ShapeTool.IsAssembly_s(label):
            parts = Sequence_TDF_Label()
            XCAFDoc_ShapeTool.GetComponents_s(label, parts)
            for number in range(1, parts.Length() + 1):
                yield from below(parts.Value(number), names, place)
        else:
            shape, shade = XCAFDoc_ShapeTool.GetShape_s(label), Quantity_Color()
            assert colors.GetColor(shape, XCAFDoc_ColorType.XCAFDoc_ColorSurf, shade)
            rgb = shade.Values(Quantity_TypeOfColor.Quantity_TOC_sRGB)
            yield Shown(names, rgb, integrated(shape.Moved(place)))

    free = Sequence_TDF_Label()
    shapes.GetFreeShapes(free)
    assert free.Length() == 1
    return list(below(free.Value(1), (name(free.Value(1)),), TopLoc_Location()))


COLORS = {
    **dict.fromkeys(("drum", "lid", "foot", "cage"), PRINT),
    "motor": MOTOR,
    "plate": ALUMINIUM,
    "mast": ALUMINIUM,
    "sleeve": ALUMINIUM,
    "flywheel": STEEL,
}


def check_solid(found, part, place, color):
    own = part.mass_properties()
    assert found.solid.volume == pytest.approx(own.mass / part.density, rel=TOLERANCE)
    np.testing.assert_allclose(
        found.solid.com, place.rotation @ own.com + place.position, atol=1e-9
    )
    assert found.color == pytest.approx(color[:3], abs=1e-3)


@pytest.mark.slow
def test_a_module_has_all_its_pieces_in_their_places(tmp_path):
    """Motor and cage among them: each by its name and colour, of its volume, at its place."""
    (tmp_path / "module.step").write_bytes(module_bytes(CAGED_DEVICE))
    assert module_bytes(CAGED_DEVICE) == (tmp_path / "module.step").read_bytes()
    found, placed = tree(tmp_path / "module.step"), placed_parts(CAGED_DEVICE)
    assert [each.path for each in found] == [("module", name) for name in placed]
    assert {"flywheel", "motor", "cage", "drum", "lid", "foot"} == set(placed)
    for each, (part, place) in zip(found, placed.values(), strict=True):
        check_solid(each, part, place, COLORS[each.path[-1]])
    read(tmp_path / "module.step")


ON_A_PLATE = DEVICES["on a plate"].plate
TWO_PLATES = replace(
    ON_A_PLATE,
    feet=tuple((x + row, y) for row in (0.2, -0.2) for x, y in ON_A_PLATE.feet),
    trunk=tuple((x + row, y) for row in (0.2, -0.2) for x, y in ON_A_PLATE.trunk),
    sleeves=2 * ON_A_PLATE.sleeves,
    rows=(0.2, -0.2),
)


@pytest.mark.slow
@pytest.mark.parametrize("plate", [TWO_PLATES, replace(MAST_PLATE, sleeves=ON_A_PLATE.sleeves)])
def test_the_device_has_every_module_in_its_place_and_its_plates(tmp_path, plate):
    device = replace(DEVICES["on a plate"], plate=plate)
    (tmp_path / "device.step").write_bytes(device_bytes(device))
    found = tree(tmp_path / "device.step")
    frames = [wheel_placement(each) @ carrier_placement(each) for each in device.modules]
    expected = [
        (("device", module.name, name), part, frame @ place)
        for module, frame in zip(device.modules, frames, strict=True)
        for name, (part, place) in placed_parts(device).items()
    ]
    bodies = [
        (plate_part(each), Placement(np.eye(3), np.array(each.position))) for each in plate.each
    ]
    on_trunk = Placement(np.eye(3), np.array(plate.position))
    bodies += [(part, on_trunk @ at) for part, at in list(plate_bodies(plate))[1:]]
    expected += [(("device", part.name), part, place) for part, place in bodies]
    assert [each.path for each in found] == [path for path, *_ in expected]
    for each, (path, part, place) in zip(found, expected, strict=True):
        check_solid(each, part, place, COLORS[path[-1]])
    assert step_bytes(plate_part(plate)).count(b"MANIFOLD_SOLID_BREP(") == len(plate.each)
    billed = sum(row.quantity for row in bill_rows(device) if row.part.startswith("sleeve"))
    assert sum(each.path[-1].startswith("sleeve") for each in found) == billed > 0
    wheels = [each.solid.com for each in found if each.path[-1] == "flywheel"]
    np.testing.assert_allclose(wheels, [module.position for module in device.modules], atol=1e-9)


def test_a_formed_face_is_one_smooth_surface(tmp_path):
    """It goes through the corners of its cells; the closed form has flat triangles between them."""
    x, y = np.linspace(-1.0, 1.0, 31)[:, None], np.linspace(-1.0, 1.0, 41)
    heights = 0.01 + 0.006 * (x**2 + 0.5 * y**2)
    place = Placement(FORWARDS, np.array([0.01, 0.02, 0.03]))
    holes = (0.015, 0.0, 0.0045), (-0.015, 0.02, 0.0045)
    block = Part("block", 2710.0, (Relief(-0.03, 0.03, -0.03, 0.05, heights, holes, place),))
    (tmp_path / "block.step").write_bytes(step_bytes(block))
    shape = read(tmp_path / "block.step")
    assert BRepCheck_Analyzer(shape).IsValid()
    found, own = integrated(shape), block.mass_properties()
    assert found.volume * block.density == pytest.approx(own.mass, rel=2e-3)
    assert found.com == pytest.approx(own.com, abs=1e-5)
