"""Questions of docs/questions.md: each command line gives the answer on the page."""

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
"""Numbers, but not those within a name such as MN5006."""

RELATIVE = 0.05
"""Relative tolerance: figures change with the catalogue and the defaults."""

SLOW_QUESTIONS = {
    "Can it turn to face the other way in the air?",
    "How can 90 g be saved?",
    "I have only 12 V and these two motors: does one do?",
    "My Go2 is kicked with 12 N s at the hip during a 0.4 m jump: which wheel and motor?",
    "Steel, and a lathe up to 120 mm: what do I turn?",
    "Tilted by 3 degrees on the line of its feet, does it get back upright?",
    "What does more time save?",
    "Which of the paper's maneuvers costs the most?",
}
"""Asked before a release only: they take the longest, and `tests/sizing` has smaller problems."""

ABSOLUTE = 0.1
"""Absolute tolerance, for small figures such as 0.1 deg off level."""


def questions():
    for match in QUESTION.finditer(PAGE):
        marks = [pytest.mark.exhaustive] * (match["title"] in SLOW_QUESTIONS)
        yield pytest.param(match, id=match["title"], marks=marks)


def figures(text):
    return [float(number.replace(",", "")) for number in NUMBER.findall(text)]


def is_in(line, output):
    """Whether a line of the answer is in the output, with approximately the same figures."""
    words = " ".join(line.split())
    pattern = r"\d[\d,]*(?:\.\d+)?".join(map(re.escape, NUMBER.split(words)[::2]))
    return any(
        figures(match[1]) == pytest.approx(figures(words), rel=RELATIVE, abs=ABSOLUTE)
        for match in re.finditer(f"(?=({pattern}))", output)
    )


def test_there_are_sixteen_questions_without_specification_files():
    commands = [found["command"] for found in QUESTION.finditer(PAGE)]
    assert len(commands) == len(re.findall("^## ", PAGE, re.MULTILINE)) == 16
    assert not any("--spec" in command for command in commands)
    assert {found["title"] for found in QUESTION.finditer(PAGE)} >= SLOW_QUESTIONS


@pytest.fixture(scope="module")
def terminal_alone():
    """Robots are read once, and no report is written."""
    robots, read = {}, size.read_specified_robot

    def read_once(specification, **options):
        key = str(specification.robot)
        robots[key] = robots.get(key) or read(specification, **options)
        return robots[key]

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(size, "read_specified_robot", read_once)
        patch.setattr(size, "_write_report", lambda design, *_: design)
        yield


@pytest.mark.slow
@pytest.mark.usefixtures("terminal_alone", "no_files")
@pytest.mark.parametrize("question", list(questions()))
def test_a_question_has_its_answer(question, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    # No question asks for the savings by single changes.
    monkeypatch.setattr(alternatives, "variants", lambda *_: ())
    monkeypatch.setattr(alternatives, "alternative_construction", lambda *_: ())
    if not re.search("driven by|Trade-offs to save", question["answer"]):
        monkeypatch.setattr(alternatives, "find_driving_maneuver", lambda *_: None)
    monkeypatch.setenv("COLUMNS", "200")
    (tmp_path / "examples").symlink_to(ROOT / "examples")
    exit_code = re.search(r"[Ee]xit code (\d)", question["prose"] + question["after"])
    output, code = "", 0
    for command in question["command"].replace("$GO2", str(GO2)).split("&&"):
        result = run(*shlex.split(command)[1:])
        output, code = f"{output} {result.output}", result.code
    assert code == (int(exit_code[1]) if exit_code else 0), output
    missing = [line for line in question["answer"].splitlines() if not is_in(line, output)]
    assert not missing, output
