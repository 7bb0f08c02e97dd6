"""The docs agree with the program."""

import ast
import json
import os
import re
import shlex
import subprocess
import sys
from pathlib import Path
from urllib.parse import urlsplit

import numpy as np
import pytest
import typer
from products import CASES
from scripts import script_at
from stories import design

import ocs_design
from ocs_design.catalogue.motors import motors
from ocs_design.common.files import to_json
from ocs_design.requirement.reading import parse_specification
from ocs_design.requirement.specification import Specification
from ocs_design.simulation.run import Series

ROOT = Path(__file__).parents[1]
DOCS = ROOT / "docs"
PAGES = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", ROOT / "CHANGELOG.md", *DOCS.glob("*.md")]

LINK = re.compile(r"(?<!\!)\[[^\]]*\]\((?P<target>[^)\s]+)\)")
HEADING = re.compile(r"^#{1,6} +(.+?) *$", re.MULTILINE)
FENCE = re.compile(r"^```.*?^```", re.MULTILINE | re.DOTALL)


@pytest.fixture(scope="module")
def generate():
    return script_at(DOCS / "generate.py")


def test_generated_pages_are_up_to_date(generate):
    assert generate.stale_pages() == []


def test_a_stale_block_is_refreshed(generate):
    stale = "<!-- begin keys: motor -->\nold\n<!-- end -->"
    fresh = generate.blocks.filled(stale, generate.QUICK)
    assert "old" not in fresh
    assert "torque_max" in fresh
    assert generate.blocks.filled(fresh, generate.QUICK) == fresh


def test_every_command_has_its_section(generate):
    text = (DOCS / "cli.md").read_text()
    assert generate.commands()
    for command in generate.commands():
        assert f"## `ocs-design {command}`" in text


def test_every_section_of_the_specification_has_its_table(generate):
    text = (DOCS / "specification.md").read_text()
    for section in generate.SECTIONS:
        assert f"<!-- begin keys: {section} -->" in text
    for kind in generate.MANEUVER_KINDS:
        assert f"<!-- begin maneuver keys: {kind} -->" in text


def anchors(page):
    """Anchors of a page's headings, as GitHub and Sphinx make them."""
    titles = HEADING.findall(FENCE.sub("", page.read_text()))
    return {re.sub(r"[^\w\- ]", "", title.lower()).replace(" ", "-") for title in titles}


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_links_within_the_repository_exist(page):
    for target in LINK.findall(FENCE.sub("", page.read_text())):
        if target.startswith(("http://", "https://")):
            continue
        file, _, anchor = target.partition("#")
        linked = page.parent / file if file else page
        assert linked.exists(), target
        assert not anchor or anchor in anchors(linked), target


def test_the_gallery_shows_each_of_its_pictures_and_all_are_small():
    shown = re.findall(r"\(_static/gallery/([\w-]+\.webp)\)", (DOCS / "gallery.md").read_text())
    pictures = list((DOCS / "_static" / "gallery").iterdir())
    assert sorted(shown) == sorted(path.name for path in pictures)
    assert len(shown) >= 8
    assert max(path.stat().st_size for path in pictures) < 60_000


DOI, ARXIV = re.compile(r"10\.\d{4,9}/\S+"), re.compile(r"\d{4}\.\d{5}")


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_external_links_are_well_formed(page):
    """Without opening them: the tests need no network."""
    for target in LINK.findall(FENCE.sub("", page.read_text())):
        address = urlsplit(target)
        if not address.scheme:
            continue
        assert address.scheme == "https", target
        assert re.fullmatch(r"[\w-]+(\.[\w-]+)+", address.netloc), target
        if address.netloc == "doi.org":
            assert DOI.fullmatch(address.path[1:]), target
        if address.netloc == "arxiv.org":
            assert ARXIV.fullmatch(address.path.removeprefix("/abs/")), target


TOML = re.compile(r"^```toml\n(.*?)^```", re.MULTILINE | re.DOTALL)


def test_files_that_the_docs_show_are_valid(tmp_path):
    """Specifications and catalogues of motors."""
    shown = [text for page in DOCS.glob("*.md") for text in TOML.findall(page.read_text())]
    assert len(shown) > 4
    for text in shown:
        if "[[motor]]" in text:
            (tmp_path / "motors.toml").write_text(text)
            assert len(motors(tmp_path / "motors.toml")) > len(motors())
        else:
            assert parse_specification(text, "shown") != Specification()


SHELL = re.compile(r"^```sh\n(.*?)^```", re.MULTILINE | re.DOTALL)


def test_commands_that_the_docs_show_have_valid_options(generate):
    """They are only parsed: what they print is tested where it is quoted."""
    group = typer.main.get_command(generate.app)
    known, tried = generate.commands(), 0
    for page in PAGES:
        for line in "\n".join(SHELL.findall(page.read_text())).replace("\\\n", " ").splitlines():
            words = shlex.split(re.split(r" [>|&]", line)[0], comments=True)
            if words[:1] != ["ocs-design"] or not {*words[1:2], " ".join(words[1:3])} & set(known):
                continue
            name = words[1] if words[1] in known else " ".join(words[1:3])
            context = group.context_class(group, info_name="ocs-design")
            known[name].make_context(name, words[1 + len(name.split()) :], parent=context)
            tried += 1
    assert tried > 20


OF_COMMAND = re.compile(r"`(?:ocs-design )?([a-z]+)\b[^`]*?(--[a-z][a-z-]+)")


def test_options_that_messages_and_exported_files_name_are_of_that_command(generate):
    """A controller's README told `size --desaturate`, which only `validate` has."""
    known = generate.commands()
    files = [*(ROOT / "ocs_design").rglob("*.py"), *(ROOT / "templates").rglob("*.md")]
    told = [pair for each in files for pair in OF_COMMAND.findall(each.read_text())]
    told = [(name, option) for name, option in told if name in known]
    options = {
        name: {"--help", *(option for each in of.params for option in each.opts)}
        for name, of in known.items()
    }
    assert [(name, option) for name, option in told if option not in options[name]] == []
    assert len(told) > 10


def test_no_message_points_to_a_page_that_the_wheel_lacks():
    for path in (ROOT / "ocs_design").rglob("*.py"):
        if "docs/" not in (source := path.read_text()):
            continue
        tree = ast.parse(source)
        prose = {id(node.value) for node in ast.walk(tree) if isinstance(node, ast.Expr)}
        texts = [
            node.value
            for node in ast.walk(tree)
            if isinstance(node, ast.Constant) and isinstance(node.value, str)
            if id(node) not in prose
        ]
        assert [text for text in texts if "docs/" in text] == [], path


CITED = re.compile(r"docs/([\w-]+\.md), ([A-Z].{60})")


def test_every_section_that_the_code_cites_exists():
    cited = {
        citation
        for path in (ROOT / "ocs_design").rglob("*.py")
        for citation in CITED.findall(" ".join(path.read_text().split()))
    }
    titles = {page: tuple(HEADING.findall((DOCS / page).read_text())) for page in dict(cited)}
    assert {(page, text) for page, text in cited if not text.startswith(titles[page])} == set()
    assert len(cited) > 20


NAMED = re.compile(r"((?:`\w+`(?:, | and | ))+)in `([\w/]+\.py)`")


def defined_in(path):
    """Names of the functions, classes and constants of a module."""
    body = ast.parse(path.read_text()).body
    constants = [line.targets[0] for line in body if isinstance(line, ast.Assign)]
    others = [line for line in body if isinstance(line, ast.FunctionDef | ast.ClassDef)]
    return {name.id for name in constants if isinstance(name, ast.Name)} | {
        each.name for each in others
    }


def test_functions_that_the_docs_name_are_in_the_named_module():
    named = 0
    for page in DOCS.glob("*.md"):
        for names, path in NAMED.findall(" ".join(page.read_text().split())):
            defined = defined_in(ROOT / "ocs_design" / path)
            assert set(re.findall(r"`(\w+)`", names)) <= defined, (page.name, path)
            named += 1
    assert named > 40


@pytest.mark.parametrize("page", PAGES, ids=lambda path: path.name)
def test_files_of_the_package_that_a_page_names_exist(page):
    named = re.findall(r"`([a-z_]+/[a-z_/]+\.py)`", page.read_text())
    homes = ROOT, ROOT / "ocs_design", ROOT / "docs"
    assert [name for name in named if not any((home / name).is_file() for home in homes)] == []


def test_every_file_that_size_writes_is_on_the_page_of_the_output():
    """Charts and time series by their folder only."""
    text = (DOCS / "output.md").read_text()
    for file in CASES["motor"].files:
        folder, name = file.rsplit("/", 1)
        known = f"{folder}/" if folder in ("figures", "validation") else name
        assert known.replace("solo12_ocs", "<name>_ocs") in text, file


def test_every_column_of_a_time_series_is_on_the_page_of_the_output():
    text, one = (DOCS / "output.md").read_text(), np.zeros(1)
    each, pair = np.zeros((1, 3)), np.zeros((1, 2))
    series = Series(
        one, each, one, one, one, each, pair, pair, pair, pair, one, ("a", "b"), one, one
    )
    for column in series.columns():
        assert f"`{re.sub('_[ab]_', '_<module>_', column)}`" in text


def records_in(value, place=""):
    """Objects in a JSON document, each with its place; `[]` stands for the entries of a list."""
    if isinstance(value, list):
        for entry in value:
            yield from records_in(entry, f"{place}[]")
    elif isinstance(value, dict):
        yield place, value
        for key, entry in value.items():
            yield from records_in(entry, f"{place}.{key}".lstrip("."))


def test_every_key_of_a_design_has_its_meaning():
    text = (DOCS / "design.md").read_text()
    sections = {
        place: re.findall(r"^\| `(\w+)` \| \S", table, re.MULTILINE)
        for heading, table in re.findall(r"^## (.+)\n((?:.*\n)+?)(?=##|<!--)", text, re.MULTILINE)
        for place in re.findall(r"`(.+?)`", heading)
    }
    # Their keys are names: of joints, metrics, criteria and the like.
    tables = {f"ocs.incidence_by_criterion{of}" for of in ("", "_robot_alone")} | {
        "robot.posture",
        "robot.package_paths",
        "requirement.maneuvers[].parameters",
        "sizing.shadow_prices",
        "reality",
        "files",
    }
    records = dict(records_in(json.loads(to_json(design()))))
    listed = (
        (DOCS / "output.md").read_text().partition("\n## design.json\n")[2].partition("\n## ")[0]
    )
    cells = re.findall(r"^\| (`.+?`) \|", listed, re.MULTILINE)
    assert set(records.pop("")) == set(re.findall(r"`(\w+)`", "".join(cells)))
    for place, record in records.items():
        assert place in tables or sections[place] == list(record)
    assert len(set(records) - tables) > 20


def test_every_reference_of_the_theory_is_listed():
    headings = anchors(DOCS / "references.md")
    cited = set(re.findall(r"references\.md#([a-z0-9]+)", (DOCS / "theory.md").read_text()))
    assert cited <= headings
    assert len(cited) > 10


def test_every_public_name_has_its_entry():
    page = (DOCS / "api.md").read_text()
    entries = re.findall(r"^\.\. auto(?:function|class):: ocs_design\.(\w+)", page, re.MULTILINE)
    assert sorted(entries) == sorted(ocs_design.__all__)


@pytest.mark.parametrize(
    "command",
    [
        pytest.param("inspect", marks=pytest.mark.slow),
        pytest.param("size", marks=pytest.mark.slow),
        pytest.param("pareto", marks=pytest.mark.exhaustive),
    ],
)
def test_a_command_that_the_docs_show_still_prints_that(generate, command):
    """Except for the times of steps; scripts are tested below."""
    shown = [
        block
        for path in generate.PAGES
        for block in generate.blocks.BLOCK.finditer(path.read_text())
        if block["kind"] in generate.SLOW and block["argument"].startswith(f"ocs-design {command} ")
    ]
    assert shown
    for block in shown:
        printed = generate.KINDS[block["kind"]](block["argument"])
        assert untimed(printed) == untimed(block["body"])


def test_every_command_that_the_docs_show_is_tested(generate):
    shown = {
        block["argument"].split()[1]
        for path in generate.PAGES
        for block in generate.blocks.BLOCK.finditer(path.read_text())
        if block["kind"] in generate.SLOW and block["argument"].startswith("ocs-design ")
    }
    assert shown == {"inspect", "size", "pareto"}


MACHINE_NUMBERS = range(7)


@pytest.mark.exhaustive
@pytest.mark.parametrize("number", MACHINE_NUMBERS)
@pytest.mark.usefixtures("no_alternatives", "no_files")
def test_the_comparison_of_machines_prints_its_page(number, monkeypatch, capsys):
    """Without alternatives and files, which the table does not show."""
    script = script_at(ROOT / "examples" / "machines" / "compare.py")
    assert len(script.MACHINES) == len(MACHINE_NUMBERS)
    monkeypatch.setattr(script, "MACHINES", script.MACHINES[number : number + 1])
    script.main()
    lines = [line.rstrip() for line in capsys.readouterr().out.strip().splitlines()]
    assert len(lines) > 10
    assert "\n".join(lines) in (DOCS / "machines.md").read_text()


def untimed(text):
    return [line for line in text.splitlines() if not re.match(r" *\d+\.\d+ s ", line)]


@pytest.mark.exhaustive  # The gate builds them as a step of its own.
def test_the_docs_build_without_a_warning(tmp_path):
    pytest.importorskip("sphinx", reason="the docs extra is not installed")
    command = [
        sys.executable,
        "-m",
        "sphinx",
        "-n",
        "-W",
        "--keep-going",
        "-q",
        str(DOCS),
        str(tmp_path),
    ]
    environment = {**os.environ, "PYTHONWARNINGS": "default"}
    done = subprocess.run(command, capture_output=True, text=True, env=environment, check=False)
    assert done.returncode == 0, done.stderr
    page = (tmp_path / "theory.html").read_text()
    assert "<math" in page
    assert not re.search(r'(src|href)="https?://[^"]+\.(js|css|woff2?)"', page)
