"""How many processors this process may use."""

import os


def processors() -> int:
    """At least one; not every system can tell which of them are allowed."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1
