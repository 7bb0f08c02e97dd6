"""STEP (ISO 10303-21, application protocol 214): exact parts in millimetres, by Open CASCADE.

Importing this takes seconds, and fails where Open CASCADE is not installed.
"""

from functools import reduce
from io import BytesIO
from pathlib import Path

import numpy as np
from OCP.APIHeaderSection import APIHeaderSection_MakeHeader
from OCP.BRep import BRep_Builder
from OCP.BRepAlgoAPI import BRepAlgoAPI_Cut, BRepAlgoAPI_Fuse
from OCP.BRepBuilderAPI import (
    BRepBuilderAPI_MakeEdge,
    BRepBuilderAPI_MakeFace,
    BRepBuilderAPI_MakeWire,
    BRepBuilderAPI_Transform,
)
from OCP.BRepPrimAPI import BRepPrimAPI_MakePrism, BRepPrimAPI_MakeRevol
from OCP.GC import GC_MakeArcOfCircle
from OCP.gp import gp_Ax1, gp_Dir, gp_Pnt, gp_Trsf, gp_Vec
from OCP.Interface import Interface_Static
from OCP.Message import Message, Message_PrinterOStream
from OCP.ShapeUpgrade import ShapeUpgrade_UnifySameDomain
from OCP.StepBasic import StepBasic_Product
from OCP.STEPControl import STEPControl_Controller, STEPControl_StepModelType, STEPControl_Writer
from OCP.StepRepr import StepRepr_NextAssemblyUsageOccurrence
from OCP.TCollection import TCollection_HAsciiString
from OCP.TopAbs import TopAbs_ShapeEnum
from OCP.TopExp import TopExp_Explorer
from OCP.TopoDS import TopoDS_Compound, TopoDS_Edge, TopoDS_Face, TopoDS_Shape

from ocs_design.common.arrays import FloatArray
from ocs_design.device.device import Device
from ocs_design.export.assembly.placed import placed_parts
from ocs_design.export.device_parts import metal_pieces, printed_parts, wheel_pieces
from ocs_design.export.formats import Notes, Subject
from ocs_design.parts.outline import Arc
from ocs_design.parts.part import Part
from ocs_design.parts.solids import Prism, Revolution, Solid
from ocs_design.robot.tree import Placement

MILLIMETRES = 1000.0
"""Units per metre: Open CASCADE's tolerances are made for millimetres."""

DECIMALS = 10
"""Decimals of coordinates [mm]: else 30.4 mm would be written with sixteen digits."""

_SETTINGS = {"write.step.schema": "AP214IS", "write.step.unit": "MM"}

_CURVES_ON_SURFACES = "write.surfacecurve.mode"
"""Off: readers make them from the curves in space, and the file is half as large."""

_TIMESTAMP = "2000-01-01T00:00:00"
"""Time in every file, so that the same part has the same bytes."""


def write(subject: Subject, folder: Path) -> Notes:
    """Write `flywheel.step`, or one file for each of its pieces, and one for each other part.

    `plate.step` is what the feet stand on, where that is designed; `module.step` has all of one
    module in its place, motor and gear as cylinders.
    """
    device = subject.device
    printed = {f"housing_{part.name}": part for part in printed_parts(device)}
    metal = {**wheel_pieces(device.flywheel), **metal_pieces(device)}
    for name, part in {**metal, **printed}.items():
        (folder / f"{name}.step").write_bytes(step_bytes(part))
    (folder / "module.step").write_bytes(module_bytes(device))
    return ()


def module_bytes(device: Device) -> bytes:
    """STEP of one module, a solid for each piece, in the frame of the left wheel."""
    compound, builder = TopoDS_Compound(), BRep_Builder()
    builder.MakeCompound(compound)
    placed = placed_parts(device)
    for part, place in placed.values():
        builder.Add(compound, _moved(part_brep(part), place))
    return _written(compound, "module", *placed)


def step_bytes(part: Part) -> bytes:
    """STEP of the part as one solid that bears its name; the same bytes every time."""
    return _written(part_brep(part), part.name)


def _written(shape: TopoDS_Shape, name: str, *pieces: str) -> bytes:
    """File of a shape, or of an assembly of pieces, with their names."""
    # Open CASCADE reports to standard output, where a command's JSON goes.
    Message.DefaultMessenger_s().RemovePrinters(Message_PrinterOStream.get_type_descriptor_s())
    # Before that there are no settings.
    STEPControl_Controller.Init_s()
    for setting, value in _SETTINGS.items():
        Interface_Static.SetCVal_s(setting, value)
    Interface_Static.SetIVal_s(_CURVES_ON_SURFACES, 0)
    writer = STEPControl_Writer()
    writer.Transfer(shape, STEPControl_StepModelType.STEPControl_AsIs)
    # Name and time in place of counters and clocks.
    model, title = writer.Model(), TCollection_HAsciiString(name)
    header = APIHeaderSection_MakeHeader(model)
    header.SetName(title)
    header.SetDescriptionValue(1, title)
    header.SetTimeStamp(TCollection_HAsciiString(_TIMESTAMP))
    header.SetOriginatingSystem(TCollection_HAsciiString("ocs-design"))
    names = [name, *pieces] if pieces else [name]
    for number in range(1, model.NbEntities() + 1):
        entity = model.Value(number)
        if isinstance(entity, StepBasic_Product):
            # The whole first, then its pieces in the order that they were added.
            called = TCollection_HAsciiString(names.pop(0))
            entity.SetName(called)
            entity.SetId(called)
        elif isinstance(entity, StepRepr_NextAssemblyUsageOccurrence):
            entity.SetId(TCollection_HAsciiString(str(number)))
    buffer = BytesIO()
    writer.WriteStream(buffer)
    return buffer.getvalue()


def part_brep(part: Part) -> TopoDS_Shape:
    """Boundary representation of the part [mm], without edges inside its faces.

    Raises:
        ValueError: its solids do not make one piece.
    """
    joined = reduce(
        lambda left, right: BRepAlgoAPI_Fuse(left, right).Shape(), map(_shape, part.joined)
    )
    whole = reduce(lambda left, hole: BRepAlgoAPI_Cut(left, _shape(hole)).Shape(), part.cut, joined)
    cleaner = ShapeUpgrade_UnifySameDomain(whole, True, True, False)
    cleaner.Build()
    # Boolean operations hand back a compound.
    found = TopExp_Explorer(cleaner.Shape(), TopAbs_ShapeEnum.TopAbs_SOLID)
    solid = found.Current()
    found.Next()
    if found.More():
        raise ValueError(f"{part.name} is not one piece")
    return solid


def _shape(solid: Solid) -> TopoDS_Shape:
    match solid:
        case Revolution():
            # The profile in the half plane y = 0, x > 0 is turned about z.
            corners = [_point(np.array([r, 0.0]), z) for r, z in solid.profile]
            sides = zip(corners, [*corners[1:], corners[0]], strict=True)
            face = _face([BRepBuilderAPI_MakeEdge(start, end).Edge() for start, end in sides])
            axis = gp_Ax1(gp_Pnt(0.0, 0.0, 0.0), gp_Dir(0.0, 0.0, 1.0))
            return BRepPrimAPI_MakeRevol(face, axis).Shape()
        case Prism():
            face = _face([_edge(*edge, solid.low) for edge in solid.outline.edges()])
            length = round(MILLIMETRES * (solid.high - solid.low), DECIMALS)
            shape = BRepPrimAPI_MakePrism(face, gp_Vec(0.0, 0.0, length)).Shape()
            return _moved(shape, solid.placement)


def _moved(shape: TopoDS_Shape, place: Placement) -> TopoDS_Shape:
    rows = np.column_stack([place.rotation, MILLIMETRES * place.position])
    transformation = gp_Trsf()
    transformation.SetValues(*rows.ravel().tolist())
    return BRepBuilderAPI_Transform(shape, transformation, True).Shape()


def _edge(start: FloatArray, end: FloatArray, bulge: float, height: float) -> TopoDS_Edge:
    """Line, or arc through both ends and its middle."""
    first, last = _point(start, height), _point(end, height)
    if bulge == 0.0:
        return BRepBuilderAPI_MakeEdge(first, last).Edge()
    arc = Arc.of(start, end, bulge)
    middle = _point(arc.centre + arc.radius * arc.outward, height)
    return BRepBuilderAPI_MakeEdge(GC_MakeArcOfCircle(first, middle, last).Value()).Edge()


def _face(edges: list[TopoDS_Edge]) -> TopoDS_Face:
    wire = BRepBuilderAPI_MakeWire()
    for edge in edges:
        wire.Add(edge)
    return BRepBuilderAPI_MakeFace(wire.Wire(), True).Face()


def _point(plane: FloatArray, height: float) -> gp_Pnt:
    x, y = plane
    return gp_Pnt(*(round(MILLIMETRES * float(value), DECIMALS) for value in (x, y, height)))
