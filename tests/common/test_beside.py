"""A second process answers what this one would, and nothing hangs on whether it can."""

import math
import os
import signal
import sys
import time

import pytest

from ocs_design.common import beside
from ocs_design.common.beside import Beside
from ocs_design.common.files import safe_name


def own_process(asked):
    """Number of the process that asked; any other one ends."""
    if os.getpid() != asked:
        sys.exit(1)
    return asked


@pytest.fixture(autouse=True)
def two_processors(monkeypatch):
    monkeypatch.setattr(beside, "processors", lambda: 2)


def test_another_process_answers():
    with Beside("os") as other:
        assert other.call(os.getpid)() != os.getpid()


def test_more_than_a_pipe_holds_goes_both_ways():
    with Beside("ocs_design.common.files") as other:
        assert len(other.call(safe_name, "a" * 1_000_000)()) == 1_000_000


def test_what_it_raises_is_raised_here():
    with Beside("math") as other, pytest.raises(ValueError, match="math domain error"):
        other.call(math.sqrt, -1.0)()


@pytest.mark.parametrize("module", [None, "no.such.module"])
def test_without_a_process_this_one_answers(module):
    with Beside(module) as other:
        assert other.call(os.getpid)() == os.getpid()


def test_with_one_processor_this_one_answers(monkeypatch):
    monkeypatch.setattr(beside, "processors", lambda: 1)
    with Beside("os") as other:
        assert other.call(os.getpid)() == os.getpid()


def test_where_no_process_can_be_started_this_one_answers(monkeypatch):
    monkeypatch.setattr(beside.sys, "executable", "/no/such/python")
    with Beside("os") as other:
        assert other.call(os.getpid)() == os.getpid()


def test_a_process_that_fails_is_made_up_for():
    with Beside("os") as other:
        assert other.call(own_process, os.getpid())() == os.getpid()


def test_nothing_runs_on_when_nobody_waits_for_it():
    with Beside("time") as other:
        other.call(time.sleep, 600.0)
        process = other._process
    assert process.returncode == -signal.SIGKILL
