"""Output of `size` in terminals and pipes and as JSON, on any number of threads."""

import os
import re
from io import StringIO

import pytest
from commands import SOLO12, run, run_in_terminal
from products import FILES, Product
from rich.console import Console
from threadpoolctl import threadpool_limits

from ocs_design.device.records.design import read_design
from ocs_design.report.text.size import print_design, print_outcome, print_solution

SGR = re.compile(r"\x1b\[[0-9;]*m")
REPEATED = pytest.mark.parametrize(
    "product", [pytest.param("motor", marks=pytest.mark.exhaustive), "no motor"], indirect=True
)


@pytest.fixture(scope="session")
def wide(product, tmp_path_factory):
    """The product again, on one processor with two threads in linear algebra, for 120 columns."""
    parent = tmp_path_factory.mktemp("wide")
    allowed = os.sched_getaffinity(0)
    with pytest.MonkeyPatch.context() as patch, threadpool_limits(limits=2, user_api="blas"):
        patch.chdir(parent)
        patch.setenv("COLUMNS", "120")
        patch.delenv("FORCE_COLOR", raising=False)
        os.sched_setaffinity(0, {min(allowed)})
        try:
            result = run("size", SOLO12, *product.case.options)
        finally:
            os.sched_setaffinity(0, allowed)
    return Product(product.case, result, parent / "solo12-ocs")


@pytest.mark.slow
@REPEATED
def test_files_do_not_depend_on_the_number_of_threads(product, wide):
    for name in ("design.json", *FILES):
        assert (product.folder / name).read_bytes() == (wide.folder / name).read_bytes(), name


@pytest.mark.slow
@pytest.mark.parametrize(
    ("product", "width", "fixture"),
    [
        ("motor", 80, "product"),
        ("no motor", 80, "product"),
        pytest.param("motor", 120, "wide", marks=pytest.mark.exhaustive),
        ("no motor", 120, "wide"),
    ],
    indirect=["product"],
)
def test_the_report_fits_its_terminal(request, width, fixture, product):
    result, case = request.getfixturevalue(fixture).result, product.case
    assert "\x1b" not in result.stdout + result.stderr
    assert max(map(len, result.stderr.splitlines())) <= width
    lines = result.stdout.splitlines()
    assert max(map(len, lines)) <= width
    headings = [line for line in lines if re.match(r"[A-Z]", line)]
    assert len(headings) == len(set(headings)) == case.headings
    for word in ("2.5 kg", "Assumed", "r_max", "back-flip", *case.words):
        assert word in result.output
    # The verdict is the first and the last line.
    assert re.search(r"  ·  level 3 of 3  ·  stands 3 of 3", lines[0])
    last = lines[-1] if result.code == 0 else "".join(lines[-6:])
    assert lines[0] in last


def test_the_output_is_little_more_than_one_screen(product):
    """A screen of 45 lines with 80 columns."""
    assert len(product.result.stdout.splitlines()) <= 58


@pytest.mark.parametrize("width", [60, 80, 120])
def test_the_verbose_output_fits_its_terminal(width, product):
    console = Console(file=StringIO(), width=width)
    design = read_design(product.folder / "design.json")
    print_design(console, design)
    print_solution(console, design)
    print_outcome(console, design, product.folder)
    text = console.file.getvalue()
    assert max(map(len, text.splitlines())) <= width
    for word in ("locked inertia", "Active limits", "Margins", "incidence by criterion"):
        assert word in text
    assert "Written to" in text
    assert ("ruled out" in text) == (design.selection is not None)
    assert len(design.requirement.assumptions) > 10
    for note in (*design.ocs.fitting, *design.requirement.assumptions):
        assert note in " ".join(text.split()).replace(" - ", " ")


@pytest.mark.slow
@REPEATED
def test_a_wider_terminal_needs_no_more_lines(product, wide):
    assert len(wide.result.stdout.splitlines()) <= len(product.result.stdout.splitlines())


@pytest.mark.slow
@REPEATED
def test_json_output_is_exactly_the_design_file(product, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    result = run("size", SOLO12, *product.case.options, "--json")
    assert (result.code, result.stderr) == (0, "")
    assert result.stdout == (product.folder / "design.json").read_text()
    assert result.stdout == (tmp_path / "solo12-ocs" / "design.json").read_text()


TEXT_OUTPUT, ERROR_OUTPUT = ("inspect", SOLO12), ("inspect", "nowhere.urdf")


@pytest.mark.slow
@pytest.mark.parametrize(
    ("arguments", "option", "variables"),
    [
        (TEXT_OUTPUT, ("--no-color",), {}),
        (ERROR_OUTPUT, (), {"NO_COLOR": "1"}),
        (TEXT_OUTPUT, (), {"NO_COLOR": "1"}),
        (ERROR_OUTPUT, ("--no-color",), {}),
    ],
)
def test_a_terminal_gets_colour_unless_it_is_declined(arguments, option, variables):
    code, colored = run_in_terminal(*arguments)
    assert SGR.search(colored)
    without_color = run_in_terminal(*arguments, *option, **variables)
    assert without_color == (code, SGR.sub("", colored))
