"""The page of the report, read by the standard library's parser."""

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


def test_hostile_names_add_no_elements(page):
    hostile = story(HOSTILE)
    robot = replace(hostile.design.robot, name=HOSTILE, warnings=(HOSTILE,), trunk=HOSTILE)
    hostile_page = Page(
        report_page(replace(hostile, design=replace(hostile.design, robot=robot), command=HOSTILE))
    )
    assert hostile_page.named("script") == page.named("script")
    assert len(hostile_page.named("img")) == len(page.named("img"))
    assert json.loads(hostile_page.inside["design"])["robot"]["name"] == HOSTILE


def test_the_content_policy_allows_only_embedded_style_and_script(page):
    (policy,) = [m["content"] for m in page.named("meta") if "http-equiv" in m]
    assert policy.startswith("default-src 'none'; img-src data:;")
    for kind, name in (("style-src", "style"), ("script-src", "script")):
        digest = base64.b64encode(hashlib.sha256(page.inside[name].encode()).digest()).decode()
        assert f"{kind} 'sha256-{digest}'" in policy


def test_the_page_refers_to_nothing_outside(page):
    for _, attributes in page.elements:
        for name in ("src", "href", "action", "data", "poster"):
            assert re.match(r"#|data:|$", attributes.get(name) or "")
        assert not any(name.startswith("on") or name == "style" for name in attributes)


def test_links_have_targets_and_ids_are_unique(page):
    names = [attributes["id"] for _, attributes in page.elements if "id" in attributes]
    assert len(names) == len(set(names))
    for _, attributes in page.elements:
        for reference in ("aria-labelledby", "aria-describedby", "for"):
            assert set(attributes.get(reference, "").split()) <= set(names)
        if attributes.get("href", "").startswith("#"):
            assert attributes["href"][1:] in names


def test_a_campaign_is_in_the_contents_with_its_number_of_samples():
    success = share(20, 20)
    campaign = MonteCarloRecord(
        seed=0, samples=20, asked=10_000, confidence=CONFIDENCE, reality={}, success=success,
        scenarios=(),
    )  # fmt: skip
    campaign_page = Page(report_page(replace(story(), monte_carlo=campaign)))
    links = [link["href"][1:] for link in campaign_page.named("a") if link.get("class") != "skip"]
    listed = [link for link in links if link in ("assembly", "samples")]
    sections = [section.get("id") for section in campaign_page.named("section")]
    assert listed == ["samples", "assembly"]
    assert [name for name in sections if name in listed] == listed
    summary = "20 of 10,000 sampled robots, seed 0; that was enough for the interval"
    assert any(text.startswith(summary) for text in campaign_page.texts)


def test_sizes_include_the_bore_of_the_hub_and_the_thickness_of_the_web():
    """H7 of 3 to 6 mm: 12 um (ISO 286-2)."""
    original = story()
    web = original.design.ocs.flywheel.web
    assert web is not None
    web = replace(web, hub=replace(web.hub, bore_radius=2e-3), thickness=1.25e-3)
    wheel = replace(original.design.ocs.flywheel, web=web)
    text = sizes_section(replace(original.design, ocs=replace(original.design.ocs, flywheel=wheel)))
    assert re.search(r"hub, bore</td>\s*<td[^>]*>Ø4 H7 \(0/\+0\.012\)", text)
    assert re.search(r"web, thickness</td>\s*<td[^>]*>1\.25", text)


def test_without_flights_the_page_says_so():
    text = report_page(replace(story(), design=design(), flights=()))
    assert "no flight was simulated" in text
    assert "No flight was simulated" in text
    assert "canvas" not in {name for name, _ in Page(text).elements}


def test_the_verdict_says_for_which_maneuver_the_modules_are_turned_by_hand():
    original = story()
    (first, *_) = original.design.requirement.demands
    turned = replace(first, source="back-flip", incidence=original.design.ocs.incidence + 0.3)
    requirement = replace(original.design.requirement, demands=(turned,))
    page = report_page(replace(original, design=replace(original.design, requirement=requirement)))
    verdict = page.partition('class="verdict')[2].partition("</p>")[0]
    assert "back-flip: sized and flown with the modules turned by hand" in verdict
