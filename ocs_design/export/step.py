"""STEP (ISO 10303-21, application protocol 214): exact parts in millimetres, by Open CASCADE.

Millimetres, because Open CASCADE's tolerances are made for them.

Importing this module takes seconds, and fails if Open CASCADE is not installed.
"""

import re
from collections.abc import Sequence
from functools import reduce
from io import BytesIO
from pathlib import Path

import numpy as np
from OCP.APIHeaderSection import APIHeaderSection_MakeHeader
from OCP.BRepAlgoAPI import BRepAlgoAPI_Cut, BRepAlgoAPI_Fuse
from OCP.BRepBuilderAPI import (
    BRepBuilderAPI_MakeEdge,
    BRepBuilderAPI_MakeFace,
    BRepBuilderAPI_MakeWire,
    BRepBuilderAPI_Transform,
)
from OCP.BRepPrimAPI import BRepPrimAPI_MakeBox, BRepPrimAPI_MakePrism, BRepPrimAPI_MakeRevol
from OCP.collections import Array1_double, Array1_int, Array2_gp_Pnt
from OCP.GC import GC_MakeArcOfCircle
from OCP.Geom import Geom_BSplineSurface
from OCP.gp import gp_Ax1, gp_Dir, gp_Pnt, gp_Trsf, gp_Vec
from OCP.Interface import Interface_Static
from OCP.Message import Message, Message_PrinterOStream
from OCP.ShapeUpgrade import ShapeUpgrade_UnifySameDomain
from OCP.StepBasic import StepBasic_Product
from OCP.STEPCAFControl import STEPCAFControl_Writer
from OCP.STEPControl import STEPControl_Controller, STEPControl_StepModelType, STEPControl_Writer
from OCP.StepRepr import StepRepr_NextAssemblyUsageOccurrence
from OCP.TCollection import TCollection_ExtendedString, TCollection_HAsciiString
from OCP.TDataStd import TDataStd_Name
from OCP.TDF import TDF_Label
from OCP.TDocStd import TDocStd_Document
from OCP.TopAbs import TopAbs_ShapeEnum
from OCP.TopExp import TopExp_Explorer
from OCP.TopLoc import TopLoc_Location
from OCP.TopoDS import TopoDS_Edge, TopoDS_Face, TopoDS_Shape
from OCP.XCAFApp import XCAFApp_Application
from OCP.XCAFDoc import XCAFDoc_DocumentTool
from scipy.interpolate import make_interp_spline

from ocs_design.common.arrays import FloatArray
from ocs_design.common.frames import Placement
from ocs_design.common.units import MILLIMETRES
from ocs_design.device.bodies import carrier_placement, wheel_placement
from ocs_design.device.device import Device
from ocs_design.export.assembly.placed import placed_parts
from ocs_design.export.device_parts import (
    metal_pieces,
    pedestal_kinds,
    printed_pieces,
    wheel_pieces,
)
from ocs_design.export.formats import Notes, Subject
from ocs_design.export.meshes import Color
from ocs_design.export.visuals import ALUMINIUM, PRINT, piece_color
from ocs_design.parts.carrier_plate import plate_bodies, plate_part
from ocs_design.parts.outline import Arc
from ocs_design.parts.shapes import Disc
from ocs_design.parts.solids import ORIGIN, Part, Prism, Relief, Revolution, Solid

DECIMALS = 10
"""Decimals of coordinates [mm], without which 30.4 mm would be written with sixteen digits."""

_SETTINGS = {"write.step.schema": "AP214IS", "write.step.unit": "MM"}

_CURVES_ON_SURFACES = "write.surfacecurve.mode"
"""Switched off: readers compute them from the curves in space, and the file is half as large."""

_TIMESTAMP = "2000-01-01T00:00:00"
"""Time stamp in every file, so that equal parts give equal bytes."""


def write(subject: Subject, folder: Path) -> Notes:
    """Write `flywheel.step`, or one file for each of its pieces, and one for each other part.

    `plate.step` or `pedestal*.step` are the supports of the feet, if these are designed;
    `ring_fixture.step` is the bonding fixture of a ring; `module.step` has one whole module in
    place, with motor and gear as cylinders, and `device.step` all modules and their supports.
    """
    device = subject.device
    metal = {**wheel_pieces(device.flywheel), **metal_pieces(device)}
    for name, part in {**metal, **printed_pieces(device)}.items():
        (folder / f"{name}.step").write_bytes(step_bytes(part))
    (folder / "module.step").write_bytes(module_bytes(device))
    (folder / "device.step").write_bytes(device_bytes(device))
    return ()


def module_bytes(device: Device) -> bytes:
    """STEP of one module, a coloured solid for each piece, in the frame of the left wheel."""
    assembly = _Assembly()
    assembly.add_module(device)
    return assembly.written("module")


def device_bytes(device: Device) -> bytes:
    """STEP of all modules, which share their pieces, and their supports, in the base frame B."""
    assembly = _Assembly()
    group, device_group = assembly.add_module(device), assembly.add_group("device")
    for module in device.modules:
        place = wheel_placement(module) @ carrier_placement(module)
        assembly.put(group, device_group, place, module.name)
    if (plate := device.plate) is not None:
        # The first body has all plates; here each is a separate piece.
        _, *others = plate_bodies(plate)
        bodies = [(plate_part(single), single.position, ORIGIN) for single in plate.single_plates]
        bodies += [(part, plate.position, at) for part, at in others]
        for part, position, at in bodies:
            label = assembly.add_part(part.name, part, ALUMINIUM)
            place = Placement(np.eye(3), np.array(position)) @ at
            assembly.put(label, device_group, place, part.name)
    for kind in pedestal_kinds(device):
        label = assembly.add_part(kind.name, kind.part, PRINT)
        for pedestal in kind.alike:
            assembly.put(label, device_group, pedestal.placement, f"pedestal {pedestal.module}")
    return assembly.written("device")


class _Assembly:
    """Assembly of named and coloured parts, placed in groups (XCAF)."""

    def __init__(self) -> None:
        self._document = TDocStd_Document(TCollection_ExtendedString("BinXCAF"))
        XCAFApp_Application.GetApplication_s().InitDocument(self._document)
        self._shapes = XCAFDoc_DocumentTool.ShapeTool_s(self._document.Main())
        self._colors: list[Color] = []

    def add_part(self, name: str, part: Part, color: Color) -> TDF_Label:
        """Add a part that is not yet in a group."""
        label = self._shapes.AddShape(part_brep(part), False)
        _name(label, name)
        self._colors.append(color)
        return label

    def add_group(self, name: str) -> TDF_Label:
        """Add an empty group."""
        label = self._shapes.NewShape()
        _name(label, name)
        return label

    def add_module(self, device: Device) -> TDF_Label:
        """Add all pieces of a module as a group."""
        group = self.add_group("module")
        for name, (part, place) in placed_parts(device).items():
            label = self.add_part(name, part, piece_color(device, name))
            self.put(label, group, place, name)
        return group

    def put(self, what: TDF_Label, group: TDF_Label, place: Placement, name: str) -> None:
        """Place a part or a group in a group, with a name for this instance."""
        where = TopLoc_Location(_transformation(place))
        _name(self._shapes.AddComponent(group, what, where), name)

    def written(self, name: str) -> bytes:
        """STEP file of the whole assembly."""
        self._shapes.UpdateAssemblies()
        _prepare()
        writer = STEPCAFControl_Writer()
        writer.SetColorMode(False)
        writer.Transfer(self._document, STEPControl_StepModelType.STEPControl_AsIs)
        return _colored(_bytes(writer.ChangeWriter(), name), self._colors)


def _colored(content: bytes, colors: Sequence[Color]) -> bytes:
    """File with colours added to its solids, in their order.

    Open CASCADE's own writer would order them by memory address.
    """
    text = content.decode("ascii")
    solids = re.findall(r"#(\d+) = (?:MANIFOLD_SOLID_BREP|BREP_WITH_VOIDS)", text)
    shown = r"ADVANCED_BREP_SHAPE_REPRESENTATION\('[^']*',\s*\([^)]*\),\s*#(\d+)\)"
    number, lines = max(map(int, re.findall(r"^#(\d+) = ", text, re.MULTILINE))), []
    for solid, context, color in zip(solids, re.findall(shown, text), colors, strict=True):
        red, green, blue = (
            f"{value:.4g}" if value % 1.0 else f"{value:.0f}." for value in color[:3]
        )
        for entity in (
            f"COLOUR_RGB('',{red},{green},{blue})",
            "FILL_AREA_STYLE_COLOUR('',{})",
            "FILL_AREA_STYLE('',({}))",
            "SURFACE_STYLE_FILL_AREA({})",
            "SURFACE_SIDE_STYLE('',({}))",
            "SURFACE_STYLE_USAGE(.BOTH.,{})",
            "PRESENTATION_STYLE_ASSIGNMENT(({}))",
            f"STYLED_ITEM('color',({{}}),#{solid})",
            f"MECHANICAL_DESIGN_GEOMETRIC_PRESENTATION_REPRESENTATION('',({{}}),#{context})",
        ):
            lines.append(f"#{number + 1} = {entity.format(f'#{number}')};\n")
            number += 1
    end = text.rindex("ENDSEC;")
    return (text[:end] + "".join(lines) + text[end:]).encode("ascii")


def _name(label: TDF_Label, name: str) -> None:
    TDataStd_Name.Set_s(label, TCollection_ExtendedString(name))


def step_bytes(part: Part) -> bytes:
    """STEP of the part as one solid with its name, reproducible byte for byte."""
    _prepare()
    writer = STEPControl_Writer()
    writer.Transfer(part_brep(part), STEPControl_StepModelType.STEPControl_AsIs)
    model, title = writer.Model(), TCollection_HAsciiString(part.name)
    for entity in (model.Value(number) for number in range(1, model.NbEntities() + 1)):
        if isinstance(entity, StepBasic_Product):
            entity.SetName(title)
            entity.SetId(title)
    return _bytes(writer, part.name)


def _prepare() -> None:
    """Set the options of the writer, and silence its messages."""
    # Open CASCADE prints to standard output, which is for a command's JSON.
    Message.DefaultMessenger_s().RemovePrinters(Message_PrinterOStream.get_type_descriptor_s())
    # The settings exist only after this call.
    STEPControl_Controller.Init_s()
    for setting, value in _SETTINGS.items():
        Interface_Static.SetCVal_s(setting, value)
    Interface_Static.SetIVal_s(_CURVES_ON_SURFACES, 0)


def _bytes(writer: STEPControl_Writer, name: str) -> bytes:
    """File of the transferred shapes, with fixed names and numbers for counters and time stamps."""
    model, title = writer.Model(), TCollection_HAsciiString(name)
    header = APIHeaderSection_MakeHeader(model)
    header.SetName(title)
    header.SetDescriptionValue(1, title)
    header.SetTimeStamp(TCollection_HAsciiString(_TIMESTAMP))
    header.SetOriginatingSystem(TCollection_HAsciiString("ocs-design"))
    for number in range(1, model.NbEntities() + 1):
        entity = model.Value(number)
        if isinstance(entity, StepRepr_NextAssemblyUsageOccurrence):
            entity.SetId(TCollection_HAsciiString(str(number)))
    buffer = BytesIO()
    writer.WriteStream(buffer)
    return buffer.getvalue()


def part_brep(part: Part) -> TopoDS_Shape:
    """Boundary representation of the part [mm], without edges inside its faces.

    Separate plates that form one part are a compound.
    """
    joined = reduce(
        lambda left, right: BRepAlgoAPI_Fuse(left, right).Shape(), map(_shape, part.joined)
    )
    difference = reduce(
        lambda left, hole: BRepAlgoAPI_Cut(left, _shape(hole)).Shape(), part.cut, joined
    )
    cleaner = ShapeUpgrade_UnifySameDomain(difference, True, True, False)
    cleaner.Build()
    # Boolean operations return a compound even for one piece.
    solids = TopExp_Explorer(cleaner.Shape(), TopAbs_ShapeEnum.TopAbs_SOLID)
    solid = solids.Current()
    solids.Next()
    return cleaner.Shape() if solids.More() else solid


def _shape(solid: Solid) -> TopoDS_Shape:
    match solid:
        case Revolution():
            # The profile in the half plane y = 0, x > 0 is revolved about z.
            corners = [_point(np.array([r, 0.0]), z) for r, z in solid.profile]
            sides = zip(corners, [*corners[1:], corners[0]], strict=True)
            face = _face([BRepBuilderAPI_MakeEdge(start, end).Edge() for start, end in sides])
            axis = gp_Ax1(gp_Pnt(0.0, 0.0, 0.0), gp_Dir(0.0, 0.0, 1.0))
            return BRepPrimAPI_MakeRevol(face, axis).Shape()
        case Prism():
            edges = []
            for start, end, bulge in solid.outline.edges():
                first, last = _point(start, solid.low), _point(end, solid.low)
                if bulge == 0.0:
                    edges.append(BRepBuilderAPI_MakeEdge(first, last).Edge())
                    continue
                # An arc through both ends and its middle.
                arc = Arc.of(start, end, bulge)
                middle = _point(arc.centre + arc.radius * arc.outward, solid.low)
                curve = GC_MakeArcOfCircle(first, middle, last).Value()
                edges.append(BRepBuilderAPI_MakeEdge(curve).Edge())
            face = _face(edges)
            length = round(MILLIMETRES * (solid.high - solid.low), DECIMALS)
            shape = BRepPrimAPI_MakePrism(face, gp_Vec(0.0, 0.0, length)).Shape()
            place = _transformation(solid.placement)
            return BRepBuilderAPI_Transform(shape, place, True).Shape()
        case Relief():
            place = _transformation(solid.placement)
            return BRepBuilderAPI_Transform(_relief(solid), place, True).Shape()


def _relief(relief: Relief) -> TopoDS_Shape:
    """A relief in its own frame, whose face is one smooth surface through the corners of its cells.

    Between corners it deviates by hundredths of a millimetre where the shape is curved.
    """
    heights = np.round(MILLIMETRES * relief.heights, DECIMALS)
    splines, poles = [], heights
    for axis, places in enumerate((relief.x, relief.y)):
        at = np.round(MILLIMETRES * places, DECIMALS)
        spline = make_interp_spline(at, poles, k=min(3, len(at) - 1), axis=axis)
        splines.append(spline)
        poles = np.moveaxis(spline.c, 0, axis) if axis else spline.c
    # Positions of the poles over the plane: along a line, the means of their knots.
    across = [
        np.array([spline.t[i + 1 : i + 1 + spline.k].mean() for i in range(count)])
        for spline, count in zip(splines, poles.shape, strict=True)
    ]
    control = Array2_gp_Pnt(1, poles.shape[0], 1, poles.shape[1])
    for row, column in np.ndindex(*poles.shape):
        place = across[0][row], across[1][column], poles[row, column]
        control.SetValue(row + 1, column + 1, gp_Pnt(*map(float, place)))
    knots, counts = [], []
    for spline in splines:
        values, often = np.unique(spline.t, return_counts=True)
        knots.append(Array1_double(1, len(values)))
        counts.append(Array1_int(1, len(values)))
        for index, (value, many) in enumerate(zip(values.tolist(), often.tolist(), strict=True)):
            knots[-1].SetValue(index + 1, value)
            counts[-1].SetValue(index + 1, many)
    degrees = (spline.k for spline in splines)
    surface = Geom_BSplineSurface(control, *knots, *counts, *degrees)
    face, deep = BRepBuilderAPI_MakeFace(surface, 1e-6).Face(), float(heights.max()) + 1.0
    block = BRepPrimAPI_MakePrism(face, gp_Vec(0.0, 0.0, -deep)).Shape()
    corner = across[0][0] - 1.0, across[1][0] - 1.0, -2.0 * deep
    other = across[0][-1] + 1.0, across[1][-1] + 1.0, 0.0
    below = BRepPrimAPI_MakeBox(*(gp_Pnt(*map(float, point)) for point in (corner, other))).Shape()
    block = BRepAlgoAPI_Cut(block, below).Shape()
    for x, y, radius in relief.holes:
        drill = Prism(Disc(radius, (x, y)), -1e-3, (deep + 1.0) / MILLIMETRES)
        block = BRepAlgoAPI_Cut(block, _shape(drill)).Shape()
    return block


def _transformation(place: Placement) -> gp_Trsf:
    rows = np.column_stack([place.rotation, MILLIMETRES * place.position])
    transformation = gp_Trsf()
    transformation.SetValues(*rows.ravel().tolist())
    return transformation


def _face(edges: list[TopoDS_Edge]) -> TopoDS_Face:
    wire = BRepBuilderAPI_MakeWire()
    for edge in edges:
        wire.Add(edge)
    return BRepBuilderAPI_MakeFace(wire.Wire(), True).Face()


def _point(plane: FloatArray, height: float) -> gp_Pnt:
    x, y = plane
    return gp_Pnt(*(round(MILLIMETRES * float(value), DECIMALS) for value in (x, y, height)))
