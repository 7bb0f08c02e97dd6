"""`size --video`, as users run it."""

import pytest
from commands import SOLO12, run

SPEC = """[motor]
name = "none"
[validation]
video = true
[[maneuver]]
kind = "drop"
name = "fall"
height = "0.4 m"
pitch = "10 deg"
"""


@pytest.mark.slow
def test_a_film_of_each_maneuver_or_the_reason_why_not(tmp_path):
    (tmp_path / "fall.toml").write_text(SPEC)
    done = run("size", SOLO12, "--spec", tmp_path / "fall.toml", "-o", tmp_path / "out")
    films = [path.name for path in (tmp_path / "out" / "validation").glob("fall.*")]
    assert done.code in {0, 1}
    assert films in (["fall.mp4"], ["fall.gif"]) or "no video, because" in done.said
