"""The materials' figures and how they are found."""

import pytest

from ocs_design.catalogue.materials import DEFAULT_MATERIAL, Material, material, materials
from ocs_design.common.errors import OcsError, SpecificationError


def test_sorted_and_each_with_a_source():
    assert list(materials()) == sorted(materials())
    assert all(found.source for found in materials().values())
    assert all(name == found.name for name, found in materials().items())


def test_densities_are_those_of_metals():
    assert all(2500 < found.density < 20_000 for found in materials().values())


def test_the_default_has_every_strength():
    steel = material(DEFAULT_MATERIAL)
    assert (steel.density, steel.yield_strength, steel.poisson_ratio) == (8000.0, 215e6, 0.29)


def test_the_papers_material_is_known_by_its_density_only():
    paper = material("stainless-paper")
    assert paper.density == 7860.0
    assert paper.yield_strength is paper.ultimate_strength is paper.poisson_ratio is None


def test_the_catalogue_cannot_be_changed():
    with pytest.raises(TypeError):
        materials()["mine"] = material(DEFAULT_MATERIAL)


def test_an_unknown_name_gets_the_closest():
    with pytest.raises(SpecificationError, match="stainles-304") as caught:
        material("stainles-304")
    assert "stainless-304" in caught.value.hint


def test_a_name_like_no_other_gets_the_whole_list():
    with pytest.raises(SpecificationError) as caught:
        material("cheese")
    assert all(name in caught.value.hint for name in materials())


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"density": 0.0}, "positive"),
        ({"density": float("nan")}, "positive"),
        ({"yield_strength": -1.0}, "positive"),
        ({"yield_strength": 3e8, "ultimate_strength": 2e8}, "ultimate"),
        ({"poisson_ratio": 0.5}, "Poisson"),
        ({"source": ""}, "source"),
    ],
)
def test_impossible_figures_are_refused(changes, message):
    figures = {
        "name": "x",
        "density": 8000.0,
        "yield_strength": None,
        "ultimate_strength": None,
        "poisson_ratio": None,
        "source": "s",
    }
    with pytest.raises(OcsError, match=message):
        Material(**(figures | changes))
