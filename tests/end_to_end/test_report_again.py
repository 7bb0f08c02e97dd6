"""The report and its figures by `export`, as in `docs/report.md`."""

import json
import re
import shutil
from pathlib import Path

import pytest
from browser import browser
from commands import files_in, run
from pages import Page

from ocs_design.common.errors import OcsError
from ocs_design.common.files import to_json
from ocs_design.device.answers import CONFIDENCE, MonteCarloRecord
from ocs_design.device.records.design import read_design
from ocs_design.monte_carlo.outcomes import share
from ocs_design.report.story import read_campaign, read_story

DOC = (Path(__file__).parents[2] / "docs" / "report.md").read_text()

pytestmark = pytest.mark.parametrize("product", ["motor"], indirect=True)


def blocks(language):
    """Code blocks of the page in a language."""
    return re.findall(rf"^```{language}\n(.*?)^```", DOC, re.MULTILINE | re.DOTALL)


@pytest.fixture
def design(product, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return Path(shutil.copytree(product.folder, "solo12-ocs"))


@pytest.mark.slow
def test_the_commands_of_the_page_work(design, capsys):
    for line in "".join(blocks("sh")).splitlines():
        result = run(*line.replace("--samples 200", "--samples 8").split()[1:])
        assert result.code == 0, result.output
    exec(blocks("python")[0], {})
    assert float(capsys.readouterr().out) == read_design(design / "design.json").ocs.incidence
    pictures = {Path(name).suffix for name in files_in("figures-as-png/figures")}
    assert pictures == {".svg", ".png"}
    page = Path("with-samples/report.html").read_text()
    assert 'id="samples"' in page
    assert "8 sampled robots" in page


@pytest.mark.slow
def test_an_exported_report_has_view_and_time_series_but_no_replay(design):
    assert run("export", design, "-o", "again", "-q", "--formats", "report").code == 0
    again = files_in("again")
    assert set(again) == {"design.json", "report.html"}
    assert json.loads(again["design.json"])["files"] == {}
    with browser() as tab:
        tab.open(Path("again/report.html"))
        tab.wait("document.documentElement.classList.contains('orbits')")
        tab.value("document.querySelector('[data-look=device]').click()")
        assert tab.value("document.querySelectorAll('#maneuvers svg').length") == 12
        assert tab.value("document.getElementById('scene-choice')") is None
        assert tab.of_kind("Runtime.exceptionThrown", "Log.entryAdded") == []


@pytest.mark.slow
def test_a_report_into_the_folder_of_the_design_keeps_other_files(design):
    before = files_in(design)
    assert run("export", design, "-o", design, "--force", "-q", "--formats", "report").code == 0
    after = files_in(design)
    assert {name for name in after if after[name] != before.get(name)} == {"report.html"}
    page = Page(after["report.html"].decode())
    files = json.loads(after["design.json"])["files"]
    assert json.loads(page.inside["design"])["files"] == files
    html = after["report.html"].decode()
    assert all(digest in html for digest in files.values())


def test_flights_of_the_story_are_read_from_their_files(product):
    folder = product.folder
    story = read_story([Path("/nowhere"), folder], read_design(folder / "design.json"))
    assert [flight.record for flight in story.flights] == list(story.design.validation)
    for flight in story.flights:
        assert flight.time[-1] >= flight.record.metrics["touchdown_time"]


def test_an_unreadable_campaign_is_an_error(tmp_path, product):
    assert read_campaign([product.folder, tmp_path]) is None
    (tmp_path / "monte_carlo.json").write_text("{")
    with pytest.raises(OcsError, match=r"monte_carlo\.json"):
        read_campaign([tmp_path])


def test_samples_precede_the_certificate(tmp_path, product):
    for name, samples in (("certificate", 40), ("samples", 20)):
        success = share(samples, samples)
        record = MonteCarloRecord(
            seed=0, samples=samples, asked=samples, confidence=CONFIDENCE, reality={},
            success=success, scenarios=(),
        )  # fmt: skip
        (tmp_path / name).mkdir()
        (tmp_path / name / "monte_carlo.json").write_bytes(to_json(record))
        assert read_campaign([product.folder, tmp_path]) == record
