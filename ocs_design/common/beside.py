"""Other processes that work out answers while this one goes on with something else.

Selections are Python on small arrays: a thread would only take turns with the one that asked. The
pools of the standard library run the caller's main module once more, and a user's script need not
bear that.
"""

import pickle
import subprocess
import sys
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from functools import partial
from importlib import import_module
from queue import Empty, SimpleQueue
from typing import IO, ParamSpec, TypeVar

from ocs_design.common.files import processors

Arguments = ParamSpec("Arguments")
Found = TypeVar("Found")


class Beside:
    """Processes that import a module and then answer calls; as a context they end with it.

    Calls are begun in the order in which they are made. What none has begun when its answer is
    asked for is worked out in this process; so is what a process fails at, and everything with one
    processor, without a module, or where no process can be started.

    Args:
        module: that each process imports at once, as in "package.module"; None: no process.
        most: number of processes at most; there are fewer than processors, as this one works too.
    """

    def __init__(self, module: str | None = None, most: int = 1) -> None:
        count = 0 if module is None else min(most, processors() - 1)
        self._processes: list[subprocess.Popen[bytes]] = []
        # Of each process that is idle, where it is written to and read from.
        self._idle: SimpleQueue[tuple[pickle.Pickler, IO[bytes], IO[bytes]]] = SimpleQueue()
        # Each thread waits for one process.
        self._threads = ThreadPoolExecutor(count) if count else None
        warnings = [word for each in sys.warnoptions for word in ("-W", each)]
        with suppress(OSError):
            for _ in range(count):
                process = subprocess.Popen(
                    [sys.executable, *warnings, "-m", __name__, str(module)],
                    stdin=subprocess.PIPE,
                    stdout=subprocess.PIPE,
                    stderr=subprocess.DEVNULL,
                    # An interrupt at the terminal is for the process that asks.
                    start_new_session=True,
                )
                asked, answers = process.stdin, process.stdout
                assert asked is not None and answers is not None, "they are pipes"
                self._processes.append(process)
                self._idle.put((pickle.Pickler(asked), asked, answers))

    def __enter__(self) -> "Beside":
        return self

    def __exit__(self, *_: object) -> None:
        for process in self._processes:
            process.kill()
        if self._threads is not None:
            self._threads.shutdown(cancel_futures=True)
        for process in self._processes:
            process.communicate()

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
        if self._threads is None:
            return here
        begun = self._threads.submit(self._answered, here)

        def answer() -> Found:
            """What a process found; found here if none has begun, or if it failed."""
            if begun.cancel():
                return here()
            try:
                return begun.result()
            except (Empty, EOFError, OSError, pickle.UnpicklingError):
                return here()

        return answer

    def _answered(self, call: Callable[[], Found]) -> Found:
        """Answer of a process that is idle; one that ends without an answer is not asked again."""
        pickler, asked, answers = idle = self._idle.get_nowait()
        pickler.dump(call)
        asked.flush()
        found: Found = pickle.load(answers)
        self._idle.put(idle)
        return found


if __name__ == "__main__":
    # Import the module that is named, then answer the calls on the standard input.
    with suppress(EOFError, BrokenPipeError):
        # What is printed on the way is not to get among the bytes of the answers.
        answers, sys.stdout = sys.stdout.buffer, sys.stderr
        import_module(sys.argv[1])
        # What several calls share is sent once, and what it has worked out for itself is kept.
        calls = pickle.Unpickler(sys.stdin.buffer)
        while True:
            pickle.dump(calls.load()(), answers)
            answers.flush()
