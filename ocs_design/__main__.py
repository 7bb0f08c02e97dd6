"""`ocs-design` and `python -m ocs_design`: a termination signal counts as an interrupt."""

import os
import signal
import sys
import time
from collections.abc import Callable
from contextlib import suppress
from types import FrameType

from ocs_design.common.errors import INTERRUPTED

# Seconds; impatient people press twice, and that must not interrupt the clean-up.
_SAME_INTERRUPT = 1.0


class _Interrupts:
    """Turns signals into KeyboardInterrupt; repeats within a second count once."""

    def __init__(self) -> None:
        self._last = -_SAME_INTERRUPT

    def __call__(self, number: int, frame: FrameType | None) -> None:  # noqa: ARG002  a handler's
        before, self._last = self._last, time.monotonic()
        if self._last - before >= _SAME_INTERRUPT:
            raise KeyboardInterrupt


def _on_signals(handler: Callable[[int, FrameType | None], None] | signal.Handlers) -> None:
    for name in ("SIGINT", "SIGTERM", "SIGHUP"):
        number = getattr(signal, name, None)
        # Windows has no SIGHUP; `nohup` makes it ignored, and a shell's `&` does so for SIGINT.
        if number is not None and signal.getsignal(number) != signal.SIG_IGN:
            signal.signal(number, handler)


def _open_closed_streams() -> None:
    """Open closed standard streams: output to them would go to the next file that is opened."""
    for number, name in enumerate(("stdin", "stdout", "stderr")):
        if getattr(sys, name) is None:
            # The system takes the lowest free descriptor, which is this stream's own.
            os.open(os.devnull, os.O_RDWR)
            mode = "w" if number else "r"
            setattr(sys, name, open(number, mode, encoding="utf-8"))  # noqa: SIM115, PTH123  kept


def main() -> None:
    """Run the command line and end with its exit code."""
    try:
        _open_closed_streams()
        _on_signals(_Interrupts())
        # Importing takes a tenth of a second, during which an interrupt may come.
        from ocs_design.cli.app import main as run  # noqa: PLC0415

        code = run()
        # Everything is done; Python would complain of an interrupt during its shutdown.
        _on_signals(signal.SIG_IGN)
    except KeyboardInterrupt:
        code = INTERRUPTED
    if code == INTERRUPTED:
        _on_signals(signal.SIG_IGN)
        # If it has not been loaded, there is nothing to remove.
        if folder := sys.modules.get("ocs_design.export.folder"):
            folder.remove_unfinished()
        # The terminal itself may have closed.
        with suppress(OSError):
            print("interrupted; no unfinished files are left", file=sys.stderr, flush=True)
        # After a signal during an `eval`, CPython ends by that signal, whatever the exit code.
        os._exit(code)
    sys.exit(code)


if __name__ == "__main__":
    main()
