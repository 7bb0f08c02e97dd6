"""docs/paper.md has the results of the scripts in examples/roscia2023."""

import importlib
import sys
from pathlib import Path

import pytest
from scripts import script_at

ROOT = Path(__file__).parents[2]
SCRIPT = ROOT / "examples" / "roscia2023" / "reproduce.py"
PAGE = ROOT / "docs" / "paper.md"


@pytest.fixture(scope="module")
def script():
    """The script, with the path of the modules beside it as when it is run."""
    path = list(sys.path)
    yield script_at(SCRIPT)
    sys.path[:] = path


def outdated(text):
    return text.replace("7.447", "9").replace("0.1027 kg", "0.2 kg").replace("30.18°", "40°")


def test_the_page_has_the_results_of_the_script(script):
    text = PAGE.read_text()
    assert script.page(text, flown=False) == text
    assert outdated(text) != text
    assert script.page(outdated(text), flown=False) == text


def test_every_table_is_on_the_page(script):
    text = PAGE.read_text()
    blocks = [(found["kind"], found["argument"]) for found in script.blocks.BLOCK.finditer(text)]
    expected = [("paper", name) for name in script.QUICK]
    assert blocks == expected + [("paper flight", name) for name in script.FLOWN]


def test_every_figure_is_on_the_page_and_small():
    figures = sorted((PAGE.parent / "_static" / "paper").iterdir())
    assert len(figures) == 6
    for figure in figures:
        assert f"(_static/paper/{figure.name})" in PAGE.read_text()
        assert figure.stat().st_size < 80_000


@pytest.mark.slow
@pytest.mark.usefixtures("no_files")
def test_the_flights_on_the_page_are_reproduced(script, tmp_path):
    text = PAGE.read_text()
    assert script.page(text) == text
    drawn = importlib.import_module("drawings").draw_all(
        script.solo12(), script.experiments.fly(), tmp_path
    )
    names = {path.name for path in drawn if path.read_bytes().startswith(b"<?xml")}
    assert names == {path.name for path in (PAGE.parent / "_static" / "paper").iterdir()}
