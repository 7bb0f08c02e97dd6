"""Folders and files appear complete or not at all."""

import errno
import re

import pytest
from commands import everything_in

from ocs_design.common.errors import OutputError
from ocs_design.device.records.design import DESIGN_FILE
from ocs_design.export.folder import check_target, staged_folder, write_whole


def make_output(folder, text="old"):
    folder.mkdir()
    (folder / DESIGN_FILE).write_text(text)


def names(folder):
    return sorted(path.name for path in folder.iterdir())


def test_a_finished_block_puts_the_folder_in_place_and_leaves_nothing_else(tmp_path):
    target = tmp_path / "robot-ocs"
    with staged_folder(target, force=False) as folder:
        (folder / DESIGN_FILE).write_text("new")
        assert not target.exists()
    assert (target / DESIGN_FILE).read_text() == "new"
    assert names(tmp_path) == ["robot-ocs"]


def test_a_failed_block_leaves_nothing(tmp_path):
    with pytest.raises(RuntimeError), staged_folder(tmp_path / "x", force=False) as folder:
        (folder / DESIGN_FILE).write_text("half")
        raise RuntimeError
    assert names(tmp_path) == []


def test_an_existing_folder_is_kept_without_force(tmp_path):
    target = tmp_path / "robot-ocs"
    make_output(target)
    with (
        pytest.raises(OutputError, match="exists already") as caught,
        staged_folder(target, force=False),
    ):
        pass
    assert "--force" in caught.value.hint
    assert (target / DESIGN_FILE).read_text() == "old"


def test_force_replaces_all_of_an_old_output(tmp_path):
    target = tmp_path / "robot-ocs"
    make_output(target)
    (target / "stale.stl").write_text("stale")
    with staged_folder(target, force=True) as folder:
        (folder / DESIGN_FILE).write_text("new")
    assert names(target) == [DESIGN_FILE]
    assert (target / DESIGN_FILE).read_text() == "new"
    assert names(tmp_path) == ["robot-ocs"]


def test_force_keeps_the_old_output_if_the_block_fails(tmp_path):
    target = tmp_path / "robot-ocs"
    make_output(target)
    with pytest.raises(RuntimeError), staged_folder(target, force=True):
        raise RuntimeError
    assert (target / DESIGN_FILE).read_text() == "old"
    assert names(tmp_path) == ["robot-ocs"]


def test_force_never_replaces_a_folder_that_is_no_output(tmp_path):
    target = tmp_path / "photographs"
    target.mkdir()
    (target / "one.png").write_text("precious")
    with pytest.raises(OutputError, match=r"holds no design\.json"):
        check_target(target, force=True)
    assert (target / "one.png").read_text() == "precious"


@pytest.mark.parametrize("make", ["file", "link"])
def test_force_never_replaces_what_is_no_folder(tmp_path, make):
    target = tmp_path / "target"
    if make == "file":
        target.write_text("a file")
    else:
        make_output(tmp_path / "real")
        target.symlink_to(tmp_path / "real")
    with pytest.raises(OutputError, match="not a folder"):
        check_target(target, force=True)


def test_a_missing_parent_is_named(tmp_path):
    with pytest.raises(OutputError, match="no such folder") as caught:
        check_target(tmp_path / "nowhere" / "robot-ocs", force=False)
    assert str(tmp_path / "nowhere") in caught.value.message


def test_a_full_disk_is_an_error_with_a_cure_and_leaves_nothing(tmp_path):
    full = OSError(errno.ENOSPC, "No space left on device", "flywheel.stl")
    with (
        pytest.raises(OutputError, match="No space left") as caught,
        staged_folder(tmp_path / "x", force=False),
    ):
        raise full
    assert "free some space" in caught.value.hint
    assert names(tmp_path) == []


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
