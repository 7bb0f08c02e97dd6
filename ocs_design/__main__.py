"""`ocs-design` and `python -m ocs_design`: to be told to end is an interrupt at any moment."""

import os
import signal
import sys
import time
from collections.abc import Callable
from contextlib import suppress
from types import FrameType

from ocs_design.common.errors import INTERRUPTED

# Seconds; impatient people press twice, and what is being tidied up is not to be left half done.
_SAME_INTERRUPT = 1.0


class _Interrupts:
    """Makes interrupts of signals, one of those that come at once."""

    def __init__(self) -> None:
        self._last = -_SAME_INTERRUPT

    def __call__(self, number: int, frame: FrameType | None) -> None:  # noqa: ARG002  a handler's
        before, self._last = self._last, time.monotonic()
        if self._last - before >= _SAME_INTERRUPT:
            raise KeyboardInterrupt


def _on_signals(handler: Callable[[int, FrameType | None], None] | signal.Handlers) -> None:
    for name in ("SIGINT", "SIGTERM", "SIGHUP"):
        number = getattr(signal, name, None)
        # Windows has no SIGHUP; `nohup` has it ignored, and shells SIGINT behind an `&`.
        if number is not None and signal.getsignal(number) != signal.SIG_IGN:
            signal.signal(number, handler)


def _open_closed_streams() -> None:
    """What is printed to a closed stream would end up in the next file that is opened."""
    for number, name in enumerate(("stdin", "stdout", "stderr")):
        if getattr(sys, name) is None:
            # The lowest number that is free is taken, which is this stream's own.
            os.open(os.devnull, os.O_RDWR)
            mode = "w" if number else "r"
            setattr(sys, name, open(number, mode, encoding="utf-8"))  # noqa: SIM115, PTH123  kept


def main() -> None:
    """Run the command line and end with its exit code."""
    try:
        _open_closed_streams()
        _on_signals(_Interrupts())
        # Importing it takes a tenth of a second, in which people change their mind.
        from ocs_design.cli.app import main as run  # noqa: PLC0415

        code = run()
        # All is done; Python tidies up, and would complain of an interrupt.
        _on_signals(signal.SIG_IGN)
    except KeyboardInterrupt:
        code = INTERRUPTED
    if code == INTERRUPTED:
        _on_signals(signal.SIG_IGN)
        # Whoever has not come to load it has nothing to remove.
        if folder := sys.modules.get("ocs_design.export.folder"):
            folder.remove_unfinished()
        # The terminal may be what has ended.
        with suppress(OSError):
            print("interrupted; nothing half done is left", file=sys.stderr, flush=True)
        # CPython ends by the signal if that came in an `eval`, whatever code it is to end with.
        os._exit(code)
    sys.exit(code)


if __name__ == "__main__":
    main()
