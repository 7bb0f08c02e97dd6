"""Rows of all catalogues, lookup by name, and figures of materials."""

import pytest

from ocs_design.catalogue.gears import gear, gears
from ocs_design.catalogue.materials import DEFAULT_MATERIAL, load_materials, material, materials
from ocs_design.catalogue.motors import motor, motors
from ocs_design.common.errors import SpecificationError


@pytest.mark.parametrize("catalogue", [motors, gears, materials])
def test_catalogues_are_sorted_immutable_and_have_sources(catalogue):
    rows = catalogue()
    assert list(rows) == sorted(rows)
    assert all(row.source and name == row.name for name, row in rows.items())
    with pytest.raises(TypeError):
        rows["mine"] = next(iter(rows.values()))


@pytest.mark.parametrize(
    ("find", "query", "suggested"),
    [
        (motor, "EC 45 flat 70 W 41181", "EC 45 flat 70 W 411812"),
        (motor, "r80 kv11", "R80 KV110"),
        (motor, "mn5006 kv450", "Antigravity MN5006 KV450"),
        (motor, "T-Motor MN5006", "Antigravity MN5006 KV450"),
        (gear, "GT3 2mm x 66mm", "GT3 2 mm x 6 mm"),
        (material, "stainles-304", "stainless-304"),
    ],
)
def test_an_unknown_name_suggests_the_closest(find, query, suggested):
    with pytest.raises(SpecificationError, match=query) as caught:
        find(query)
    assert suggested in caught.value.hint


@pytest.mark.parametrize(
    ("find", "query", "name"),
    [
        (motor, "r80-kv110", "R80 KV110"),
        (motor, "t-motor antigravity MN5006 KV450", "Antigravity MN5006 KV450"),
        (gear, "gt3-2mm x 6MM", "GT3 2 mm x 6 mm"),
    ],
)
def test_case_spaces_dashes_and_maker_do_not_matter(find, query, name):
    assert find(query).name == name


def test_densities_are_those_of_metals():
    assert all(2500 < metal.density < 20_000 for metal in materials().values())


def test_the_default_has_every_strength():
    steel = material(DEFAULT_MATERIAL)
    assert None not in (steel.yield_strength, steel.ultimate_strength, steel.poisson_ratio)


def test_a_name_without_similar_ones_lists_all():
    with pytest.raises(SpecificationError) as caught:
        material("cheese")
    assert all(name in caught.value.hint for name in materials())


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"density_kg_m3": "0"}, "density_kg_m3: '0' is not positive"),
        ({"density_kg_m3": "nan"}, "density_kg_m3: 'nan' is not positive"),
        ({"density_kg_m3": ""}, "density_kg_m3: is missing"),
        ({"yield_strength_pa": "-1"}, "yield_strength_pa: '-1' is not positive"),
        ({"yield_strength_pa": "3e8", "ultimate_strength_pa": "2e8"}, "is above ultimate"),
        ({"poisson_ratio": "0.5"}, "poisson_ratio must be below 0.5"),
        ({"source": ""}, "source: is missing"),
    ],
)
def test_impossible_figures_are_refused(load, changes, message):
    cells = {"name": "x", "density_kg_m3": "8000", "source": "s"}
    assert load(rows_of(cells), ".csv", load_materials)["x"].density == 8000.0
    with pytest.raises(SpecificationError, match=message):
        load(rows_of(cells | changes), ".csv", load_materials)


def rows_of(cells):
    """A file with one row of these cells."""
    return f"{','.join(cells)}\n{','.join(cells.values())}\n"
