"""A second process that works out one answer while this one goes on with something else.

Selections are Python on small arrays: a thread would only take turns with the one that asked. The
pools of the standard library run the caller's main module once more, and a user's script need not
bear that.
"""

import pickle
import subprocess
import sys
from collections.abc import Callable
from contextlib import suppress
from functools import partial
from importlib import import_module
from typing import ParamSpec, TypeVar

from ocs_design.common.files import processors

Arguments = ParamSpec("Arguments")
Found = TypeVar("Found")


class Beside:
    """A process that imports a module and then waits for one call; as a context it ends with it.

    With one processor, without a module, or where a process cannot be started or fails, the call
    is made in this process, once its answer is asked for.

    Args:
        module: that the process imports at once, as in "package.module"; None: no process.
    """

    def __init__(self, module: str | None = None) -> None:
        self._process: subprocess.Popen[bytes] | None = None
        if module is None or processors() == 1:
            return
        warnings = [word for each in sys.warnoptions for word in ("-W", each)]
        with suppress(OSError):
            self._process = subprocess.Popen(
                [sys.executable, *warnings, "-m", __name__, module],
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=subprocess.DEVNULL,
                # An interrupt at the terminal is for the process that asks.
                start_new_session=True,
            )

    def __enter__(self) -> "Beside":
        return self

    def __exit__(self, *_: object) -> None:
        if self._process is not None:
            self._process.kill()
            self._process.communicate()

    def call(
        self,
        function: Callable[Arguments, Found],
        *args: Arguments.args,
        **kwargs: Arguments.kwargs,
    ) -> Callable[[], Found]:
        """Begin a call; the function that is returned waits for its answer, or raises its error.

        Args:
            function: of a module, so that it is found there; arguments and answer are pickled.
        """
        here = partial(function, *args, **kwargs)
        process = self._process
        if process is None:
            return here
        assert process.stdin is not None, "it was opened as a pipe"
        with suppress(OSError):
            pickle.dump(here, process.stdin)
            process.stdin.flush()

        def answer() -> Found:
            """What the process found; found here if it failed."""
            written, _ = process.communicate()
            if process.returncode != 0:
                return here()
            found: Found = pickle.loads(written)
            return found

        return answer


if __name__ == "__main__":
    # Import the module that is named, take one call from the standard input and answer it.
    with suppress(EOFError, BrokenPipeError):
        # What is printed on the way is not to get among the bytes of the answer.
        answer, sys.stdout = sys.stdout.buffer, sys.stderr
        import_module(sys.argv[1])
        call = pickle.load(sys.stdin.buffer)
        pickle.dump(call(), answer)
        answer.flush()
