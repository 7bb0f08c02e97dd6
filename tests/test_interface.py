"""The Python interface: paths in any form, one-line reprs, and output in notebooks."""

import json
import re
import shutil
import sys
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from fronts import make_front, task_by_hand
from stories import design, story

import ocs_design
from ocs_design import (
    OcsDesign,
    OcsError,
    Outcome,
    Robot,
    Specification,
    read_design,
    read_robot,
    read_specification,
    specify,
    validate_design,
)
from ocs_design.common.errors import UsageError
from ocs_design.common.files import to_json
from ocs_design.report.html.notebook import as_html
from ocs_design.report.text.console import Steps
from ocs_design.requirement.reading import parse_specification, specification_of
from ocs_design.requirement.writing import specification_to_toml
from ocs_design.workflows.export import export_design

ROOT = Path(__file__).parents[1]
EXAMPLES, NOTEBOOK = ROOT / "examples", ROOT / "examples" / "solo12.ipynb"


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "design.json").write_bytes(to_json(design()))
    return tmp_path


@pytest.mark.parametrize("form", [str, Path, lambda path: str(path / "design.json")])
def test_a_design_is_read_from_its_folder_or_file(folder, form):
    assert read_design(form(folder)) == design()


def test_an_outcome_serves_as_the_path_of_its_folder(folder):
    outcome = Outcome(design(), folder, task_by_hand().robot, None, ())
    assert read_design(outcome) == design()
    assert export_design(outcome, "bom", out=str(folder / "again")).files


def test_a_folder_without_a_design_is_an_error(tmp_path):
    with pytest.raises(OcsError, match=r"design\.json: No such file"):
        read_design(tmp_path)


@pytest.mark.parametrize("form", [str, Path])
def test_robots_and_specifications_are_read_from_text_and_paths(form):
    assert read_robot(form(EXAMPLES / "solo12.urdf")).name == "solo12"
    specified = read_specification(form(EXAMPLES / "solo12.toml"))
    assert toml(specification_of(form(EXAMPLES / "solo12.toml"))) == toml(specified)
    assert specification_of(specified) is specified
    file = form(EXAMPLES / "solo12.urdf")
    assert specification_of(file) == specify(file) == specify(robot={"file": file})


def toml(specification):
    return specification_to_toml(specification, "title")


def test_a_specification_in_python_equals_that_in_a_file():
    text = """
        robot.file = "a.urdf"
        flywheel.r_max = "40mm"
        ocs.position = ["0mm", "60mm", "50mm"]
        [[maneuver]]
        kind = "drop"
        name = "fall"
        height = "1m"
        pitch = "20deg"
    """
    drop = {"kind": "drop", "name": "fall", "height": "1m", "pitch": "20deg"}
    specified = specify(
        Path("a.urdf"),
        flywheel={"r_max": "40mm"},
        ocs={"position": ("0mm", "60mm", "50mm")},
        maneuver=[drop],
    )
    assert toml(specified) == toml(parse_specification(text, "the file"))


def test_numbers_of_numpy_are_those_of_python():
    from_numpy = specify(
        "a.urdf",
        supply={"voltage": np.arange(24, 48, 6)[0]},
        flywheel={"r_max": np.float32(0.25)},
        ocs={"position": np.array([0.0, 0.0625, 0.5])},
    )
    plain = specify(
        "a.urdf",
        supply={"voltage": 24},
        flywheel={"r_max": 0.25},
        ocs={"position": (0.0, 0.0625, 0.5)},
    )
    assert from_numpy == plain


def test_a_negative_seed_is_refused(folder):
    with pytest.raises(UsageError, match="--seed -1: must be a whole number from 0"):
        validate_design(folder, samples=1, seed=-1)


def test_all_faults_of_a_specification_are_reported():
    with pytest.raises(OcsError) as caught:
        specify("a.urdf", flywheel={"r_max": "40kg", "rmin": 1}, motors={})
    assert len(caught.value.problems) == 3


@cache
def results():
    front = make_front(task_by_hand())
    outcome = Outcome(design(), Path("solo12-ocs"), task_by_hand().robot, None, ())
    return {
        "OcsDesign for": design(),
        "Outcome in solo12-ocs": outcome,
        "Front of": front,
        "Robot solo12: 2.5 kg, 12 joints, 4 legs": read_robot(EXAMPLES / "solo12.urdf"),
        "Specification: robot.file=": read_specification(EXAMPLES / "solo12.toml"),
        "Specification: nothing specified": Specification(),
    }


def test_a_result_is_one_line_with_its_figures():
    for start, result in results().items():
        assert repr(result).startswith(f"<{start}")
        assert "\n" not in repr(result)
        assert len(repr(result)) < 300


EXTERNAL = re.compile(r"""(src|href)=["'](?!data:)|https?://(?!www\.w3\.org)|<script|<style""")


def test_notebook_output_is_small_escaped_and_self_contained():
    runs = tuple(replace(run, metrics={}) for run in story().design.validation)
    robot = replace(design().robot, name="<script>alert()</script>")
    shown = replace(design(), robot=robot, validation=runs)
    for result in (shown, results()["Front of"], results()["Outcome in solo12-ocs"]):
        page = result._repr_html_()
        assert not EXTERNAL.search(page)
        assert "<img" in page
        assert len(page) < 100_000
    assert "drop" in as_html(shown)
    assert "&lt;script&gt;" in as_html(shown)


def test_progress_goes_to_a_function_or_nowhere(capsys):
    calls = []
    for steps in (Steps.of(lambda label, done: calls.append((label, done))), Steps.of(None)):
        with steps.step("read") as step:
            step.update(0.5)
    assert calls == [("read", 0.0), ("read", 0.5), ("read", 1.0)]
    assert capsys.readouterr() == ("", "")
    assert Steps.of(steps) is steps


def test_progress_is_shown_below_the_cell_of_a_notebook(monkeypatch):
    display = pytest.importorskip("IPython.display")
    shown = []

    class Handle:
        def update(self, data, raw):
            shown.append(data["text/plain"])

    shell = type("Shell", (), {"kernel": object()})
    monkeypatch.setattr(sys.modules["IPython"], "get_ipython", shell)
    monkeypatch.setattr(display, "display", lambda *_, **__: Handle())
    steps = Steps.of(None)
    steps.warn([f"link {i} is light" for i in range(5)])
    with steps.step("read") as step:
        step.update(0.5)
        step.note = "a\x1b[31mrobot"
    assert any("█" * 12 in each for each in shown)
    assert re.search(r"link 2.*\n.* 2 more .*\n.*read  a\ufffd\[31mrobot$", shown[-1])


def test_the_notebook_is_stored_without_outputs():
    cells = json.loads(NOTEBOOK.read_text())["cells"]
    assert all(cell["outputs"] == [] for cell in cells if cell["cell_type"] == "code")
    assert NOTEBOOK.stat().st_size < 10_000


@pytest.fixture
def beside_solo12(tmp_path, monkeypatch):
    for name in ("solo12.urdf", "solo12.toml", "solo12.ipynb"):
        shutil.copy(EXAMPLES / name, tmp_path)
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.mark.exhaustive
@pytest.mark.filterwarnings("ignore")  # Warnings of Jupyter's own packages.
def test_the_notebook_runs(beside_solo12, monkeypatch):
    """With few samples instead of a certificate, which takes minutes, and fewer points."""
    nbformat, nbclient = pytest.importorskip("nbformat"), pytest.importorskip("nbclient")
    monkeypatch.setenv("PYTHONPATH", str(ROOT))
    page = (beside_solo12 / "solo12.ipynb").read_text()
    for full, short in (("certify=True", "samples=3"), ("points=5", "points=2")):
        assert page.count(full) == 1
        page = page.replace(full, short)
    notebook = nbformat.reads(page, as_version=4)
    nbclient.NotebookClient(notebook, timeout=600).execute()
    kinds = [
        kind
        for cell in notebook.cells
        for output in cell.get("outputs", ())
        for kind in output.get("data", ())
    ]
    assert kinds.count("text/html") == 3
    assert kinds.count("image/png") == 2
    assert (beside_solo12 / "solo12-ocs" / "report.html").exists()
    quoted = json.loads((ROOT / "docs" / "certified.json").read_text())["solo12"]
    design = read_design(beside_solo12 / "solo12-ocs")
    assert design.ocs.mass_total == pytest.approx(quoted["mass"], rel=1e-3)
    # Jumps start on the ground.
    for run in design.validation:
        assert run.passed is run.ocs, run.reason
        assert (run.metrics["lift_off_time"] > 0.0) == (run.scenario != "drop")


PYTHON = re.compile(r"^```python\n(.*?)^```", re.MULTILINE | re.DOTALL)


@pytest.mark.slow
@pytest.mark.usefixtures("no_alternatives", "no_files")
def test_the_page_on_python_runs_from_top_to_bottom(beside_solo12):
    """With fewer samples and points, and without files."""
    pytest.importorskip("matplotlib").use("agg")
    shown = PYTHON.findall((ROOT / "docs" / "api.md").read_text())
    assert len(shown) > 4
    names = {}
    for text in shown:
        exec(text.replace("samples=20", "samples=2").replace("points=3", "points=2"), names)
    assert isinstance(names["design"], OcsDesign)
    assert isinstance(names["robot"], Robot)


def test_every_public_name_has_a_docstring():
    for name in ocs_design.__all__:
        assert getattr(ocs_design, name).__doc__
