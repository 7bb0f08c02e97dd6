"""The top of the page: what it is about, the verdict, and the figures that everyone asks for."""

from ocs_design.design_file import OcsDesign
from ocs_design.drive.gear import DIRECT
from ocs_design.report.doubts import turned_by_hand
from ocs_design.report.flights import summary
from ocs_design.report.html.elements import Markup, element
from ocs_design.report.quantities import degrees, grams, rpm, tenths
from ocs_design.report.terminal import recorded_margins
from ocs_design.sizing.margins.margins import HOOP_STRESS

_WORDS = {"pass": "Pass", "fail": "Fail", "open": "Not proved"}


def title_of(design: OcsDesign) -> str:
    """Of the page."""
    return f"Orientation control system for {design.robot.name}"


def page_head(design: OcsDesign) -> Markup:
    """Title, verdict and key figures."""
    return element(
        "header",
        element("p", f"{design.tool.name} {design.tool.version}", class_="eyebrow"),
        element("h1", title_of(design)),
        _verdict(design),
        _tiles(design),
    )


def _verdict(design: OcsDesign) -> Markup:
    verdicts = [run.passed for run in design.validation if run.ocs]
    state = "open" if not verdicts else "pass" if all(verdicts) else "fail"
    return element(
        "p",
        element("strong", _WORDS[state]),
        element("span", summary(verdicts).plain),
        *(element("span", told) for told in turned_by_hand(design)),
        class_=f"verdict {state}",
    )


def _tiles(design: OcsDesign) -> Markup:
    ocs, wheel = design.ocs, design.ocs.flywheel
    gear = "" if ocs.motor.gear == DIRECT.name else f", {ocs.motor.gear}"
    share = f"{ocs.mass_total / design.robot.mass:.1%} of the robot"
    lengths = " / ".join(map(tenths, (wheel.outer_radius, wheel.inner_radius, wheel.height)))
    tiles = (
        ("Mass of both modules", grams(ocs.mass_total), share),
        ("Incidence α*", degrees(ocs.incidence), ocs.incidence_criterion),
        ("Motor", ocs.motor.name, _drive(design) + gear),
        ("Rim R / r / h", f"{lengths} mm", wheel.material),
        ("Spin inertia", f"{1e6 * ocs.spin_inertia:.4g} kg mm²", "of each wheel"),
        ("Wheel speed, by design", rpm(design.requirement.wheel_speed_max), _stress(design)),
    )
    return element("ul", *(_tile(*tile) for tile in tiles), class_="tiles")


def _tile(name: str, value: str, note: str) -> Markup:
    parts = (("span", "name", name), ("strong", "value", value), ("span", "note", note))
    return element("li", *(element(kind, text, class_=look) for kind, look, text in parts))


def _drive(design: OcsDesign) -> str:
    voltage = design.ocs.motor.bus_voltage
    return "no motor chosen" if voltage is None else f"at {voltage:g} V"


def _stress(design: OcsDesign) -> str:
    """The figure of the table of margins, where the drive may run away; else at this speed."""
    stress = next((each for each in recorded_margins(design) if each.name == HOOP_STRESS), None)
    if stress is not None and stress.factor is not None:
        return f"stress margin {stress.factor:.2f} {stress.note}"
    margin = design.ocs.flywheel.stress_margin
    return "stress not checked" if margin is None else f"stress margin {margin:.2f}"
