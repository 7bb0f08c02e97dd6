"""STEP files, read back by Open CASCADE, against the closed form."""

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
class VolumeIntegrals:
    """Volume integrals over the faces by Open CASCADE, in SI, about the centre of mass."""

    volume: float
    com: FloatArray
    second: FloatArray


def read(path) -> TopoDS_Shape:
    reader = STEPControl_Reader()
    reader.ReadFile(str(path))
    assert reader.TransferRoots() == 1
    return reader.OneShape()


def integrated(shape: TopoDS_Shape) -> VolumeIntegrals:
    properties = GProp_GProps()
    BRepGProp.VolumeProperties_s(shape, properties)
    com, matrix = properties.CentreOfMass(), properties.MatrixOfInertia()
    entries = [[matrix.Value(i, j) for j in (1, 2, 3)] for i in (1, 2, 3)]
    centre = np.array([com.X(), com.Y(), com.Z()])
    return VolumeIntegrals(properties.Mass() * 1e-9, centre * 1e-3, np.array(entries) * 1e-15)


SMALL = "wheel", "foot", "slotted", "tube"


@pytest.mark.parametrize(
    "part",
    [
        pytest.param(part, marks=[pytest.mark.slow] * (name not in SMALL), id=name)
        for name, part in PARTS.items()
    ],
)
def test_solid_has_the_mass_and_inertia_of_the_closed_form(part, tmp_path, record_property):
    (tmp_path / "part.step").write_bytes(step_bytes(part))
    shape = read(tmp_path / "part.step")
    assert shape.ShapeType() == TopAbs_ShapeEnum.TopAbs_SOLID
    assert BRepCheck_Analyzer(shape).IsValid()
    integrals, exact = integrated(shape), part.mass_properties()
    inertia_error = (
        np.abs(integrals.second * part.density - exact.inertia).max() / exact.inertia.max()
    )
    record_property("inertia_error", float(inertia_error))
    assert integrals.volume * part.density == pytest.approx(exact.mass, rel=TOLERANCE)
    assert inertia_error < TOLERANCE
    np.testing.assert_allclose(integrals.com, exact.com, atol=1e-12)


def test_file_has_the_name_and_no_timestamp():
    content = step_bytes(TUBE)
    assert b"PRODUCT('tube','tube'" in content
    assert b"AUTOMOTIVE_DESIGN { 1 0 10303 214" in content
    assert b"SI_UNIT(.MILLI.,.METRE.)" in content
    assert content == step_bytes(TUBE)


def test_nothing_is_printed(capfd):
    step_bytes(TUBE)
    assert capfd.readouterr() == ("", "")


@dataclass(frozen=True)
class ShownSolid:
    """A solid in the tree of a file, with the names from the root to it."""

    path: tuple[str, ...]
    color: tuple[float, ...]
    solid: VolumeIntegrals


def tree(path) -> list[ShownSolid]:
    """The solids that a CAD program shows of an assembly, by XCAF."""
    document = TDocStd_Document(TCollection_ExtendedString("BinXCAF"))
    XCAFApp_Application.GetApplication_s().InitDocument(document)
    reader = STEPCAFControl_Reader()
    reader.ReadFile(str(path))
    assert reader.Transfer(document)
    shapes = XCAFDoc_DocumentTool.ShapeTool_s(document.Main())
    colors = XCAFDoc_DocumentTool.ColorTool_s(document.Main())

    def name(label):
        attribute = TDataStd_Name()
        assert label.FindAttribute(TDataStd_Name.GetID_s(), attribute)
        return attribute.Get().ToExtString()

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
            yield ShownSolid(names, rgb, integrated(shape.Moved(place)))

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


def check_solid(shown, part, place, color):
    expected = part.mass_properties()
    assert shown.solid.volume == pytest.approx(expected.mass / part.density, rel=TOLERANCE)
    np.testing.assert_allclose(
        shown.solid.com, place.rotation @ expected.com + place.position, atol=1e-9
    )
    assert shown.color == pytest.approx(color[:3], abs=1e-3)


@pytest.mark.slow
def test_a_module_has_all_its_pieces_in_their_places(tmp_path):
    """Each part, motor and cage included, has its name, colour, volume and place."""
    (tmp_path / "module.step").write_bytes(module_bytes(CAGED_DEVICE))
    assert module_bytes(CAGED_DEVICE) == (tmp_path / "module.step").read_bytes()
    solids, parts = tree(tmp_path / "module.step"), placed_parts(CAGED_DEVICE)
    assert [solid.path for solid in solids] == [("module", name) for name in parts]
    assert {"flywheel", "motor", "cage", "drum", "lid", "foot"} == set(parts)
    for solid, (part, place) in zip(solids, parts.values(), strict=True):
        check_solid(solid, part, place, COLORS[solid.path[-1]])
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
    solids = tree(tmp_path / "device.step")
    frames = [wheel_placement(module) @ carrier_placement(module) for module in device.modules]
    expected = [
        (("device", module.name, name), part, frame @ place)
        for module, frame in zip(device.modules, frames, strict=True)
        for name, (part, place) in placed_parts(device).items()
    ]
    bodies = [
        (plate_part(single), Placement(np.eye(3), np.array(single.position)))
        for single in plate.single_plates
    ]
    on_trunk = Placement(np.eye(3), np.array(plate.position))
    bodies += [
        (part, on_trunk @ place_on_trunk) for part, place_on_trunk in list(plate_bodies(plate))[1:]
    ]
    expected += [(("device", part.name), part, place) for part, place in bodies]
    assert [solid.path for solid in solids] == [path for path, *_ in expected]
    for solid, (path, part, place) in zip(solids, expected, strict=True):
        check_solid(solid, part, place, COLORS[path[-1]])
    assert step_bytes(plate_part(plate)).count(b"MANIFOLD_SOLID_BREP(") == len(plate.single_plates)
    billed = sum(row.quantity for row in bill_rows(device) if row.part.startswith("sleeve"))
    assert sum(solid.path[-1].startswith("sleeve") for solid in solids) == billed > 0
    wheels = [solid.solid.com for solid in solids if solid.path[-1] == "flywheel"]
    np.testing.assert_allclose(wheels, [module.position for module in device.modules], atol=1e-9)


def test_a_formed_face_is_one_smooth_surface(tmp_path):
    """The surface passes through the nodes of the grid; the closed form has flat triangles."""
    x, y = np.linspace(-1.0, 1.0, 31)[:, None], np.linspace(-1.0, 1.0, 41)
    heights = 0.01 + 0.006 * (x**2 + 0.5 * y**2)
    place = Placement(FORWARDS, np.array([0.01, 0.02, 0.03]))
    holes = (0.015, 0.0, 0.0045), (-0.015, 0.02, 0.0045)
    block = Part("block", 2710.0, (Relief(-0.03, 0.03, -0.03, 0.05, heights, holes, place),))
    (tmp_path / "block.step").write_bytes(step_bytes(block))
    shape = read(tmp_path / "block.step")
    assert BRepCheck_Analyzer(shape).IsValid()
    integrals, expected = integrated(shape), block.mass_properties()
    assert integrals.volume * block.density == pytest.approx(expected.mass, rel=2e-3)
    assert integrals.com == pytest.approx(expected.com, abs=1e-5)
