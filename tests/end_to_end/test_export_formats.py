"""`export --formats`: which files are written, alone and on request."""

import sys
from pathlib import Path

import pytest
from commands import files_in, made_in, run

from ocs_design.export import formats
from ocs_design.export.formats import FORMATS, USUAL_FORMATS
from ocs_design.workflows.export import ON_DESIGN


@pytest.mark.parametrize("each", USUAL_FORMATS, ids=lambda each: each.name)
def test_one_format_alone(solo12, each):
    assert (
        run("export", solo12 / "design.json", "-o", "again", "-q", "--formats", each.name).code == 0
    )
    again = made_in("again")
    assert again
    assert again.items() <= made_in(solo12).items()


@pytest.mark.slow
@pytest.mark.parametrize("product", ["motor"], indirect=True)
def test_what_is_written_on_request_alone(product, folder):
    """For the printer and for CAD."""
    asked = ("--formats", "3mf,step,printed")
    result = run("export", product.folder, "-o", "again", *asked)
    assert result.code == 0, result.said
    again = files_in("again")
    case = product.case
    parts = {*(f"cad/housing_{part}.stl" for part in ("drum", "lid", "foot")), *case.cages}
    steps = {part.replace(".stl", ".step") for part in parts}
    steps |= {f"cad/{piece}.step" for piece in (*case.pieces, *case.plates)}
    made = {
        "cad/flywheel.3mf",
        "cad/housing.3mf",
        "cad/module.step",
        "cad/device.step",
        *parts,
        *steps,
    }
    assert set(again) == {"design.json", *made}


@pytest.mark.parametrize("name", ["step", "dxf"])
def test_a_format_without_its_extra_is_a_missing_tool(solo12, monkeypatch, name):
    monkeypatch.setattr(formats, "find_spec", lambda _: None)
    result = run("export", solo12, "-o", "again", "--formats", name)
    assert result.code == 5
    assert f"pip install 'ocs-design[{name}]'" in result.said
    assert not Path("again").exists()


@pytest.mark.parametrize("name", ["step", "dxf"])
def test_a_library_that_does_not_load_is_a_missing_tool(solo12, monkeypatch, name):
    """As where a shared library that it needs is not on the system."""
    (each,) = (each for each in FORMATS if each.name == name)
    monkeypatch.setitem(sys.modules, f"ocs_design.export.{each.module}", None)
    result = run("export", solo12, "-o", "again", "--formats", name)
    assert result.code == 5
    assert "cannot be loaded" in result.said


def test_dxf_of_each_piece(solo12):
    assert run("export", solo12, "-o", "one", "-q", "--formats", "dxf").code == 0
    pieces = {f"cad/{path.stem}.dxf" for path in (solo12 / "cad").glob("flywheel*.stl")}
    assert set(files_in("one")) == {"design.json", *pieces}


def test_formats_are_listed_with_commas_or_one_by_one(solo12):
    run("export", solo12, "-o", "a", "-q", "--formats", "stl,bom")
    run("export", solo12, "-o", "b", "-q", "--formats", "bom", "--formats", "stl")
    assert files_in("a") == files_in("b")
    assert set(files_in("a")) == {
        "design.json",
        "cad/flywheel.stl",
        "cad/bill_of_materials.csv",
    }


def test_an_unknown_format_is_wrong_usage(solo12):
    result = run("export", solo12, "-o", "again", "--formats", "stl,dwg", "--json")
    assert result.code == 2
    assert "dwg" in result.document["error"]["message"]
    known = {*(each.name for each in FORMATS), *ON_DESIGN}
    assert all(name in result.document["error"]["hint"] for name in known)
