"""The page as a text, read by the standard library's parser."""

import base64
import hashlib
import json
import re
from dataclasses import replace

import pytest
from pages import Page
from stories import design, story

from ocs_design.device.answers import CONFIDENCE, MonteCarloRecord
from ocs_design.monte_carlo.outcomes import share
from ocs_design.report.html.page import report_page
from ocs_design.report.html.sections import sizes_section

HOSTILE = "</script><script>alert(1)</script>\"'<img src=x onerror=alert(2)>&"


@pytest.fixture(scope="module")
def page():
    text = report_page(story())
    assert text == report_page(story()), "equal stories make equal pages"
    return Page(text)


def test_no_name_gets_out_of_its_place(page):
    told = story(HOSTILE)
    robot = replace(told.design.robot, name=HOSTILE, warnings=(HOSTILE,), trunk=HOSTILE)
    found = Page(
        report_page(replace(told, design=replace(told.design, robot=robot), command=HOSTILE))
    )
    assert found.named("script") == page.named("script")
    assert len(found.named("img")) == len(page.named("img"))
    assert json.loads(found.inside["design"])["robot"]["name"] == HOSTILE


def test_only_what_is_written_here_may_run(page):
    (policy,) = [m["content"] for m in page.named("meta") if "http-equiv" in m]
    assert policy.startswith("default-src 'none'; img-src data:;")
    for kind, name in (("style-src", "style"), ("script-src", "script")):
        digest = base64.b64encode(hashlib.sha256(page.inside[name].encode()).digest()).decode()
        assert f"{kind} 'sha256-{digest}'" in policy


def test_nothing_points_out_of_the_file(page):
    for _, attributes in page.elements:
        for name in ("src", "href", "action", "data", "poster"):
            assert re.match(r"#|data:|$", attributes.get(name) or "")
        assert not any(name.startswith("on") or name == "style" for name in attributes)


def test_every_link_leads_somewhere_and_no_name_is_there_twice(page):
    names = [attributes["id"] for _, attributes in page.elements if "id" in attributes]
    assert len(names) == len(set(names))
    for _, attributes in page.elements:
        for pointing in ("aria-labelledby", "aria-describedby", "for"):
            assert set(attributes.get(pointing, "").split()) <= set(names)
        if attributes.get("href", "").startswith("#"):
            assert attributes["href"][1:] in names


def test_a_campaign_has_its_place_in_the_contents_and_says_how_many_were_flown():
    success = share(20, 20)
    campaign = MonteCarloRecord(
        seed=0, samples=20, asked=10_000, confidence=CONFIDENCE, reality={}, success=success,
        scenarios=(),
    )  # fmt: skip
    found = Page(report_page(replace(story(), monte_carlo=campaign)))
    links = [each["href"][1:] for each in found.named("a") if each.get("class") != "skip"]
    listed = [link for link in links if link in ("assembly", "samples")]
    sections = [each.get("id") for each in found.named("section")]
    assert listed == ["samples", "assembly"]
    assert [each for each in sections if each in listed] == listed
    said = "20 of 10,000 sampled robots, seed 0; that was enough for the interval"
    assert any(text.startswith(said) for text in found.texts)


def test_the_wheel_is_told_with_what_its_hub_is_bored_to_and_how_thick_its_web_is():
    """H7 of 3 to 6 mm: 12 um (ISO 286-2)."""
    told = story()
    web = told.design.ocs.flywheel.web
    assert web is not None
    web = replace(web, hub=replace(web.hub, bore_radius=2e-3), thickness=1.25e-3)
    wheel = replace(told.design.ocs.flywheel, web=web)
    text = sizes_section(replace(told.design, ocs=replace(told.design.ocs, flywheel=wheel)))
    assert re.search(r"hub, bore</td>\s*<td[^>]*>Ø4 H7 \(0/\+0\.012\)", text)
    assert re.search(r"web, thickness</td>\s*<td[^>]*>1\.25", text)


def test_without_flights_it_says_that_nothing_is_proved():
    text = report_page(replace(story(), design=design(), flights=()))
    assert "no flight was simulated" in text
    assert "No flight was simulated" in text
    assert "canvas" not in {name for name, _ in Page(text).elements}


def test_the_verdict_says_for_which_maneuver_the_modules_are_turned_by_hand():
    told = story()
    (first, *_) = told.design.requirement.demands
    turned = replace(first, source="back-flip", incidence=told.design.ocs.incidence + 0.3)
    requirement = replace(told.design.requirement, demands=(turned,))
    page = report_page(replace(told, design=replace(told.design, requirement=requirement)))
    verdict = page.partition('class="verdict')[2].partition("</p>")[0]
    assert "back-flip: sized and flown with the modules turned by hand" in verdict
