"""The questions of docs/questions.md: each command line is run and answers what the page says."""

import re
import shlex

import pytest
from commands import ROOT, run
from robots import ROBOTS

from ocs_design.sizing import alternatives
from ocs_design.workflows import size

GO2 = ROBOTS / "go2_description" / "urdf" / "go2.urdf"
PAGE = (ROOT / "docs" / "questions.md").read_text()
QUESTION = re.compile(
    r"^## (?P<title>[^\n]+)\n(?P<between>.*?)```sh\n(?P<command>[^\n]+)\n```\n"
    r"(?P<prose>.*?)```text\n(?P<answer>.*?)```\n(?P<after>.*?)(?=^## |\Z)",
    re.MULTILINE | re.DOTALL,
)
NUMBER = re.compile(r"(?<![\w.])(\d[\d,]*(?:\.\d+)?)(?!\w)")
"""Not those within a name, such as MN5006."""

ABOUT = 0.05
"""A figure moves with the catalogue and the defaults; more than this is another answer."""

BEFORE_A_RELEASE = {
    "How can 90 g be saved?",
    "I have only 12 V and these two motors: does one do?",
    "My Go2 is kicked with 12 N s at the hip during a 0.4 m jump: which wheel and motor?",
    "Steel, and a lathe up to 120 mm: what do I turn?",
    "Which of the paper's maneuvers costs the most?",
}
"""They take the longest, and ask what `tests/sizing` asks of smaller problems."""

A_TENTH = 0.1
"""A figure below two moves by more than its share: 0.1 deg off level."""


def questions():
    for found in QUESTION.finditer(PAGE):
        marks = [pytest.mark.exhaustive] * (found["title"] in BEFORE_A_RELEASE)
        yield pytest.param(found, id=found["title"], marks=marks)


def figures(text):
    return [float(each.replace(",", "")) for each in NUMBER.findall(text)]


def told(line, said):
    """Whether a line of the answer was said, its words as they are and its figures about so."""
    words = " ".join(line.split())
    pattern = r"\d[\d,]*(?:\.\d+)?".join(map(re.escape, NUMBER.split(words)[::2]))
    return any(
        figures(found[1]) == pytest.approx(figures(words), rel=ABOUT, abs=A_TENTH)
        for found in re.finditer(f"(?=({pattern}))", said)
    )


def test_there_are_sixteen_and_none_needs_a_file_of_its_own():
    commands = [found["command"] for found in QUESTION.finditer(PAGE)]
    assert len(commands) == len(re.findall("^## ", PAGE, re.MULTILINE)) == 16
    assert not any("--spec" in command for command in commands)
    assert {found["title"] for found in QUESTION.finditer(PAGE)} >= BEFORE_A_RELEASE


@pytest.fixture(scope="module")
def answers_alone():
    """A robot is read once, and no report is written: the terminal answers."""
    robots, read = {}, size.read_specified_robot

    def read_once(specified, **options):
        key = str(specified.robot)
        robots[key] = robots.get(key) or read(specified, **options)
        return robots[key]

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(size, "read_specified_robot", read_once)
        patch.setattr(size, "_write_report", lambda design, *_: design)
        yield


@pytest.mark.slow
@pytest.mark.usefixtures("answers_alone", "no_files")
@pytest.mark.parametrize("question", list(questions()))
def test_a_question_has_its_answer(question, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    # What one change would save is asked by none.
    monkeypatch.setattr(alternatives, "variants", lambda *_: ())
    monkeypatch.setattr(alternatives, "alternative_construction", lambda *_: ())
    if not re.search("driven by|Trade-offs to save", question["answer"]):
        monkeypatch.setattr(alternatives, "find_driving_maneuver", lambda *_: None)
    monkeypatch.setenv("COLUMNS", "200")
    (tmp_path / "examples").symlink_to(ROOT / "examples")
    specified = re.search(r"[Ee]xit code (\d)", question["prose"] + question["after"])
    said, code = "", 0
    for command in question["command"].replace("$GO2", str(GO2)).split("&&"):
        result = run(*shlex.split(command)[1:])
        said, code = f"{said} {result.output}", result.code
    assert code == (int(specified[1]) if specified else 0), said
    missing = [line for line in question["answer"].splitlines() if not told(line, said)]
    assert not missing, said
