"""A file that appears whole or not at all."""

import re

import pytest
from commands import everything_in

from ocs_design.common.errors import OutputError
from ocs_design.export.folder import write_whole


def test_it_is_written(tmp_path):
    write_whole(tmp_path / "a.toml", "ä\n", force=False)
    assert (tmp_path / "a.toml").read_bytes() == "ä\n".encode()
    assert everything_in(tmp_path) == ["a.toml"]


def test_what_is_there_stays_without_force(tmp_path):
    file = tmp_path / "a.toml"
    file.write_text("mine")
    with pytest.raises(OutputError, match="exists already"):
        write_whole(file, "new", force=False)
    assert file.read_text() == "mine"
    write_whole(file, "new", force=True)
    assert file.read_text() == "new"


@pytest.mark.parametrize(
    ("place", "why"),
    [(".", "is not a file"), ("none/a.toml", "no such folder"), (300 * "a", "too long.*shorter")],
)
def test_where_no_file_can_be_is_told(tmp_path, place, why):
    with pytest.raises(OutputError) as refused:
        write_whole(tmp_path / place, "new", force=place == ".")
    assert re.search(why, f"{refused.value.message} {refused.value.hint}")


def test_a_failure_leaves_everything_as_it_was(tmp_path):
    file = tmp_path / "a.toml"
    file.write_text("mine")
    # A surrogate has no UTF-8; any failure while writing would do.
    with pytest.raises(UnicodeEncodeError):
        write_whole(file, "half \ud800", force=True)
    assert file.read_text() == "mine"
    assert everything_in(tmp_path) == ["a.toml"]
