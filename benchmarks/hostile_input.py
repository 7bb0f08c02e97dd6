"""Mutated files for every reader: what escapes, how long it takes, how much memory, what it writes.

    python benchmarks/hostile_input.py [INPUTS] [READER ...]
    python benchmarks/hostile_input.py 300 size
    python benchmarks/hostile_input.py --guided SECONDS READER

Goal: 20,000 inputs, and no exception but those that name their cure, none above 10 s, none above
1 GiB, nothing written outside. `size` is the whole chain, and has 120 s. Guided search needs
`atheris`; what is found is kept in the folder that HOSTILE names.
"""

import faulthandler
import hashlib
import os
import random
import resource
import subprocess
import sys
import tempfile
import time
import traceback
import warnings
from collections import Counter
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1] / "tests"))

HANG, LONG_HANG, MEMORY, AT_ONCE = 10.0, 120.0, 2**30, 250


def run_reader(name, seed, count):
    """Read `count` mutated files in this process; prints a line for each that does it harm."""
    from hostile_readers import READERS, SLOW_READERS, mutated

    reader, draw = (READERS | SLOW_READERS)[name], random.Random(seed)
    hang = LONG_HANG if name in SLOW_READERS else HANG
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        _watch_writing(folder)
        slowest, refused = 0.0, 0
        for index in range(count):
            path = Path(folder, reader.file)
            content = mutated(reader.seeds, reader.words, draw)
            path.write_bytes(content)
            Path(folder, "last").write_text(f"{name} {seed} {index}")
            faulthandler.dump_traceback_later(hang, exit=True)
            start = time.perf_counter()
            was_refused, fault = outcome(reader, path)
            refused += was_refused
            if fault:
                keep(name, content, fault)
            faulthandler.cancel_dump_traceback_later()
            slowest = max(slowest, time.perf_counter() - start)
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024
    print(f"DONE {slowest:.3f} {peak} {refused}", flush=True)


def outcome(reader, path):
    """Whether it is refused with its cure, and the fault where anything else escapes."""
    from ocs_design.common.errors import OcsError

    try:
        with warnings.catch_warnings():
            # Numpy's warnings of what overflows would reach the user's terminal.
            warnings.simplefilter("error", RuntimeWarning)
            reader.read(path)
    except OcsError:
        return True, ""
    except BaseException as error:
        return False, fault_of(error)
    return False, ""


def keep(name, content, fault):
    """Print it, and keep the file where HOSTILE says."""
    print(f"FAULT {name}: {fault}", flush=True)
    if "HOSTILE" in os.environ:
        digest = hashlib.sha1(fault.encode()).hexdigest()[:10]
        Path(os.environ["HOSTILE"], f"{name}-{digest}").write_bytes(content)


def fault_of(error):
    """The exception and the last lines of the program that it came through."""
    frames = traceback.extract_tb(error.__traceback__)
    ours = [f"{Path(f.filename).name}:{f.name}" for f in frames if "ocs_design" in f.filename]
    return f"{type(error).__name__} in {' > '.join(ours[-3:])}: {str(error)[:90]!r}"


def _watch_writing(folder):
    """Tells of whatever is written, started or connected to outside of the folder."""

    def hook(event, arguments):
        opened = (
            event == "open"
            and isinstance(arguments[2], int)
            and arguments[2] & (os.O_WRONLY | os.O_RDWR)
        )
        other = event.startswith(("os.rename", "os.remove", "os.mkdir", "os.system", "os.exec"))
        # Xacro files are expanded by a Python of our own.
        if event == "subprocess.Popen" and arguments[0] == sys.executable:
            return
        if not opened and not other and event not in {"subprocess.Popen", "socket.connect"}:
            return
        place = os.path.realpath(str(arguments[0]))
        kept = os.path.realpath(os.environ.get("HOSTILE", folder))
        if not place.startswith((os.path.realpath(folder), kept, "/dev/null")):
            print(f"OUTSIDE {event} {arguments[0]}", flush=True)

    sys.addaudithook(hook)


def guided(name, seconds):
    """Search for inputs that reach new code, for so long."""
    import atheris

    with atheris.instrument_imports(include=["ocs_design"]):
        from hostile_readers import NUMBERS, READERS
    reader = READERS[name]
    folder = tempfile.mkdtemp()
    os.chdir(folder)
    _watch_writing(folder)
    corpus = Path(os.environ.get("HOSTILE", folder), f"corpus-{name}")
    corpus.mkdir(exist_ok=True)
    for index, seed in enumerate(reader.seeds):
        (corpus / f"seed{index}").write_bytes(seed)
    (Path(folder) / "words").write_text(
        "".join('"' + "".join(f"\\x{b:02x}" for b in w) + '"\n' for w in (*reader.words, *NUMBERS))
    )
    seen = Counter()

    def once(content):
        path = Path(folder, reader.file)
        path.write_bytes(content)
        _, fault = outcome(reader, path)
        if fault:
            seen[fault] += 1
            if seen[fault] == 1:
                keep(name, content, fault)

    atheris.Setup(
        [
            sys.argv[0],
            str(corpus),
            f"-max_total_time={seconds}",
            "-timeout=10",
            "-rss_limit_mb=1024",
            f"-dict={folder}/words",
            "-max_len=20000",
            "-verbosity=1",
            "-print_final_stats=1",
            f"-artifact_prefix={os.environ.get('HOSTILE', folder)}/{name}-",
        ],
        once,
    )
    atheris.Fuzz()


def main():
    if sys.argv[1:2] == ["--guided"]:
        guided(sys.argv[3], int(sys.argv[2]))
        return
    if sys.argv[1:2] == ["--reader"]:
        run_reader(sys.argv[2], int(sys.argv[3]), int(sys.argv[4]))
        return
    from hostile_readers import READERS

    names = sys.argv[2:] or list(READERS)
    each = (int(sys.argv[1]) if len(sys.argv) > 1 else 20_000) // len(names)
    for name in names:
        print_reader(name, each)


def print_reader(name, count):
    """Read so many in processes of their own, for a reader may take the process with it."""
    faults, slowest, peak, refused, died = Counter(), 0.0, 0, 0, 0
    for first in range(0, count, AT_ONCE):
        number = min(AT_ONCE, count - first)
        done = subprocess.run(
            [sys.executable, __file__, "--reader", name, str(first), str(number)],
            capture_output=True,
            text=True,
            check=False,
            errors="replace",
        )
        lines = done.stdout.splitlines()
        faults.update(line for line in lines if line.startswith(("FAULT", "OUTSIDE")))
        ends = [line.split() for line in lines if line.startswith("DONE")]
        if not ends:
            died += 1
            faults[f"DIED {name} seed {first}: {done.returncode} {done.stderr[-1500:]}"] += 1
            continue
        slowest = max(slowest, float(ends[0][1]))
        peak = max(peak, int(ends[0][2]))
        refused += int(ends[0][3])
    print(
        f"{name:14} {count:6} read, {refused:6} refused, {sum(faults.values()):4} faults of "
        f"{len(faults)} kinds, slowest {slowest:.2f} s, peak {peak / 2**20:.0f} MiB",
        flush=True,
    )
    for fault, times in faults.most_common():
        print(f"    {times} x {fault}", flush=True)


if __name__ == "__main__":
    main()
