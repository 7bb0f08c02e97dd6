"""Parts as exact boundary representations of Open CASCADE, in millimetres.

Importing this takes seconds, and fails where Open CASCADE is not installed.
"""

from functools import reduce

import numpy as np
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
from OCP.ShapeUpgrade import ShapeUpgrade_UnifySameDomain
from OCP.TopAbs import TopAbs_ShapeEnum
from OCP.TopExp import TopExp_Explorer
from OCP.TopoDS import TopoDS_Edge, TopoDS_Face, TopoDS_Shape

from ocs_design.arrays import FloatArray
from ocs_design.parts.outline import Arc
from ocs_design.parts.part import Part
from ocs_design.parts.solids import Prism, Revolution, Solid
from ocs_design.robot.tree import Placement

MILLIMETRES = 1000.0
"""Per metre: Open CASCADE's tolerances are made for them."""

DECIMALS = 10
"""Of coordinates [mm]: else 30.4 mm would be written with sixteen digits."""


def part_brep(part: Part) -> TopoDS_Shape:
    """The part, without edges inside its faces.

    Raises:
        ValueError: its solids do not make one piece.
    """
    joined = reduce(
        lambda left, right: BRepAlgoAPI_Fuse(left, right).Shape(), map(_shape, part.joined)
    )
    whole = reduce(lambda left, hole: BRepAlgoAPI_Cut(left, _shape(hole)).Shape(), part.cut, joined)
    cleaner = ShapeUpgrade_UnifySameDomain(whole, True, True, False)
    cleaner.Build()
    return _only_solid(cleaner.Shape(), part.name)


def _only_solid(shape: TopoDS_Shape, name: str) -> TopoDS_Shape:
    """What a boolean operation hands back in a compound."""
    found = TopExp_Explorer(shape, TopAbs_ShapeEnum.TopAbs_SOLID)
    solid = found.Current()
    found.Next()
    if found.More():
        raise ValueError(f"{name} is not one piece")
    return solid


def _shape(solid: Solid) -> TopoDS_Shape:
    match solid:
        case Revolution():
            return _revolution(solid)
        case Prism():
            return _prism(solid)


def _revolution(solid: Revolution) -> TopoDS_Shape:
    """Turned about z from the half plane y = 0, x > 0."""
    corners = [_point(np.array([r, 0.0]), z) for r, z in solid.profile]
    following = [*corners[1:], corners[0]]
    face = _face(
        [
            BRepBuilderAPI_MakeEdge(start, end).Edge()
            for start, end in zip(corners, following, strict=True)
        ]
    )
    axis = gp_Ax1(gp_Pnt(0.0, 0.0, 0.0), gp_Dir(0.0, 0.0, 1.0))
    return BRepPrimAPI_MakeRevol(face, axis).Shape()


def _prism(solid: Prism) -> TopoDS_Shape:
    face = _face([_edge(*edge, solid.low) for edge in solid.outline.edges()])
    length = round(MILLIMETRES * (solid.high - solid.low), DECIMALS)
    shape = BRepPrimAPI_MakePrism(face, gp_Vec(0.0, 0.0, length)).Shape()
    return BRepBuilderAPI_Transform(shape, _transformation(solid.placement), True).Shape()


def _edge(start: FloatArray, end: FloatArray, bulge: float, height: float) -> TopoDS_Edge:
    """A line, or the arc through both ends and its middle."""
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


def _transformation(placement: Placement) -> gp_Trsf:
    rows = np.column_stack([placement.rotation, MILLIMETRES * placement.position])
    transformation = gp_Trsf()
    transformation.SetValues(*rows.ravel().tolist())
    return transformation
