"""Rows of all catalogues, lookup by name, and figures of materials."""

import pytest

from ocs_design.catalogue.gears import gear, gears
from ocs_design.catalogue.materials import (
    DEFAULT_MATERIAL,
    load_materials,
    material,
    materials,
    recorded_material,
    strong_materials,
)
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


@pytest.mark.parametrize(
    ("name", "yields", "breaks", "order"),
    [
        ("stainless-304", 190, 500, "1.4301+AT, EN 10088-3"),
        ("stainless-316", 200, 500, "1.4401+AT, EN 10088-3"),
        ("steel-a36", 250, 400, "A36, ASTM A36"),
        ("steel-1045-normalized", 275, 560, "C45+N (1.0503), EN 10083-2"),
        ("steel-4140-qt", 500, 750, "42CrMo4+QT (1.7225), EN 10083-3"),
        ("brass-c360", 105, 275, "C36000, H02 or O60, ASTM B16"),
        ("tungsten-alloy-class-4", 517, 689, "class 4, ASTM B777"),
        ("aluminium-7075-t6", 400, 440, "EN AW-7075 T6, EN 755-2"),
        ("aluminium-6061-t6", 240, 260, "EN AW-6061 T6, EN 755-2"),
        ("titanium-6al-4v", 828, 895, "grade 5, annealed, ASTM B348"),
    ],
)
def test_strengths_are_those_that_the_order_guarantees(name, yields, breaks, order):
    """In MPa, for bars as thick as wheels are wide: typical or thin ones are stronger."""
    metal = material(name)
    assert (metal.yield_strength, metal.ultimate_strength) == (1e6 * yields, 1e6 * breaks)
    assert metal.order.startswith(order)
    assert any(standard in metal.source for standard in ("EN ", "ASTM "))


def test_every_material_with_a_strength_says_how_it_is_ordered():
    assert all(metal.order for metal in strong_materials())
    assert not material("stainless-paper").order


def test_former_names_lead_to_the_condition_that_is_ordered():
    """No standard guarantees a strength of thick bars in the conditions of these names."""
    assert material("steel-4140-normalized") == material("steel-4140-qt")
    assert recorded_material("steel-1045-cold-worked") == material("steel-1045-normalized")
    assert recorded_material("cheese") is None
    assert "steel-4140-normalized" not in materials()


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
