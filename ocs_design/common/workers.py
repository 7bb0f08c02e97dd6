"""Worker processes that compute answers while this one continues.

Selections are Python on small arrays: a thread would only take turns with the caller. The pools of
the standard library run the caller's main module again, which a user's script may not be made for.
"""

import gc
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
Answer = TypeVar("Answer")


class WorkerPool:
    """Processes that import a module and then answer calls; as a context they end with it.

    Calls are started in the order in which they are made. A call that no process has started when
    its answer is needed runs in this process; so does one at which a process fails, and every call
    if there is one processor, no module, or no process can be started.

    Args:
        module: imported by each process at its start, as in "package.module"; None: no processes.
        most: largest number of processes; one processor is left for this process.
    """

    def __init__(self, module: str | None = None, most: int = 1) -> None:
        count = 0 if module is None else min(most, processors() - 1)
        self._processes: list[subprocess.Popen[bytes]] = []
        # Streams to and from each idle process.
        self._idle: SimpleQueue[tuple[pickle.Pickler, IO[bytes], IO[bytes]]] = SimpleQueue()
        # Each thread waits for one process.
        self._threads = ThreadPoolExecutor(count) if count else None
        warnings = [word for option in sys.warnoptions for word in ("-W", option)]
        with suppress(OSError):
            for _ in range(count):
                process = subprocess.Popen(
                    [sys.executable, *warnings, "-m", __name__, str(module)],
                    stdin=subprocess.PIPE,
                    stdout=subprocess.PIPE,
                    stderr=subprocess.DEVNULL,
                    # Interrupts at the terminal go to the calling process only.
                    start_new_session=True,
                )
                requests, answers = process.stdin, process.stdout
                assert requests is not None and answers is not None, "they are pipes"
                self._processes.append(process)
                self._idle.put((pickle.Pickler(requests), requests, answers))

    def __enter__(self) -> "WorkerPool":
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
        function: Callable[Arguments, Answer],
        *args: Arguments.args,
        **kwargs: Arguments.kwargs,
    ) -> Callable[[], Answer]:
        """Start a call; the returned function waits for its answer, or raises its error.

        Args:
            function: importable from a module; arguments and answer are pickled.
        """
        compute = partial(function, *args, **kwargs)
        if self._threads is None:
            return compute
        future = self._threads.submit(self._answered, compute)

        def answer() -> Answer:
            """Answer of a process; computed here if none has started the call, or if it failed."""
            if future.cancel():
                return compute()
            try:
                return future.result()
            except (Empty, EOFError, OSError, pickle.UnpicklingError):
                return compute()

        return answer

    def _answered(self, call: Callable[[], Answer]) -> Answer:
        """Answer of an idle process; a process that ends without an answer is not used again."""
        pickler, requests, answers = idle = self._idle.get_nowait()
        pickler.dump(call)
        requests.flush()
        answer: Answer = pickle.load(answers)
        self._idle.put(idle)
        return answer


if __name__ == "__main__":
    # Import the named module, then answer the calls from standard input.
    with suppress(EOFError, BrokenPipeError):
        # Printed output must not mix with the bytes of the answers.
        answers, sys.stdout = sys.stdout.buffer, sys.stderr
        # Imports leave hardly any garbage; without collecting they take a tenth less time.
        gc.disable()
        import_module(sys.argv[1])
        gc.enable()
        # Objects shared by several calls are sent once, and keep their cached results.
        calls = pickle.Unpickler(sys.stdin.buffer)
        while True:
            pickle.dump(calls.load()(), answers)
            answers.flush()
