"""Full or read-only disks and failed runs: existing files stay as they were."""

import errno
import os
import re
import shutil
import subprocess
from contextlib import contextmanager
from pathlib import Path

import pytest
from commands import BOUND, SOLO12, all_paths_in, failure, run


@contextmanager
def small_disk(folder, kib):
    """A disk of that size mounted at `folder`; skips the test where mounting is not allowed."""
    mount = shutil.which("mount")
    mounted = mount and subprocess.run(
        [mount, "-t", "tmpfs", "-o", f"size={kib}k", "none", str(folder)],
        capture_output=True,
        check=False,
    )
    if not mounted or mounted.returncode:
        pytest.skip("a disk of its own can be mounted by root only")
    try:
        yield lambda *options: subprocess.run([mount, *options, str(folder)], check=True)
    finally:
        subprocess.run(["umount", str(folder)], check=True)


@pytest.mark.slow
def test_a_full_disk(folder):
    (folder / "disk").mkdir()
    with small_disk(folder / "disk", kib=256):
        result = run("size", SOLO12, *BOUND, "--no-validate", "-o", "disk/out")
        assert (result.code, result.stdout) == (3, "")
        assert re.search("No space left on device.*free some space", result.output)
        assert all_paths_in(folder) == ["disk"]


def test_a_disk_that_fills_up_anywhere(folder, monkeypatch):
    written = []

    def write_bytes(path, content, original=Path.write_bytes):
        written.append(path)
        if len(written) == 5:
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC), str(path))
        return original(path, content)

    monkeypatch.setattr(Path, "write_bytes", write_bytes)
    result = run("size", SOLO12, *BOUND, "--no-validate", "--json")
    assert result.code == 3
    assert result.document["error"]["kind"] == "output"
    assert str(written[-1]) in result.document["error"]["message"]
    assert all_paths_in(folder) == []


def test_an_unwritable_folder_is_reported_before_the_search(folder):
    if not Path("/proc/self").exists():
        pytest.skip("there is no such place")
    result = run("size", SOLO12, "-o", "/proc/x")
    assert (result.code, result.stdout) == (3, "")
    assert "/proc: cannot be written to" in result.output
    assert "size the device" not in result.output


def test_a_read_only_parent_is_an_error(folder):
    parent = folder / "locked"
    parent.mkdir()
    if os.geteuid() == 0:
        with small_disk(parent, kib=64) as mount:
            mount("-o", "remount,ro")
            message = failure(3, "size", SOLO12, *BOUND, "-o", "locked/out")
    else:
        parent.chmod(0o555)
        message = failure(3, "size", SOLO12, *BOUND, "-o", "locked/out")
    assert re.search("cannot be written to: .* choose a folder .* with -o", message)
    assert all_paths_in(folder) == ["locked"]
