"""Runs that are killed, disks that are full, two runs at once, other machines: what stands there.

    python benchmarks/faults.py [killed|full|together|same] ... [--moments 50]

Goal: after each fault the old folder or the complete new one, byte for byte; nothing beside it
after the next run; no traceback; the same bytes from the same input on one thread and on two.
"""

import argparse
import errno
import os
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Mapping
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1] / "tests"))

from commands import PROGRAM, SOLO12, run

from ocs_design.device.records.design import read_design
from ocs_design.export.folder import file_hashes, recorded_hashes

QUICK = ("--motor", "none", "--ballistic", "-q")
COMMANDS = {
    "size": ("size", SOLO12, *QUICK, "-o", "out", "--force"),
    "export": ("export", "design", "-q", "-o", "out", "--force"),
    "validate": ("validate", "design", "-q", "-o", "out", "--force"),
}
SIGNALS = (signal.SIGKILL, signal.SIGTERM, signal.SIGINT, signal.SIGHUP)
CLOCK = Path(__file__).with_name("jumping_clock.c")


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("parts", nargs="*", default=["killed", "full", "together", "same"])
    parser.add_argument("--moments", type=int, default=50)
    options = parser.parse_args()
    for number in SIGNALS[1:]:
        # Where this was started by `nohup` or behind an `&`, what it starts would ignore them.
        signal.signal(number, signal.SIG_DFL)
    for part in options.parts:
        with tempfile.TemporaryDirectory() as folder:
            os.chdir(folder)
            print(f"--- {part}", flush=True)
            if part == "killed":
                killed(options.moments)
            else:
                {"full": full, "together": together, "same": same}[part]()
            os.chdir("/")


def killed(moments: int) -> None:
    """Each command, ended at so many moments spread over its time."""
    make_design()
    for name, command in COMMANDS.items():
        old, new, seconds = references(command)
        counts_by_state: Counter[str] = Counter()
        for moment in range(moments):
            signal_number = SIGNALS[moment % len(SIGNALS)]
            renew("old", "out")
            seconds_before = seconds * (moment + 0.5) / moments
            counts_by_state[state_after(command, signal_number, seconds_before, old, new)] += 1
        last = left_over()
        run_to_end(command)
        counts = ", ".join(f"{count} {state}" for state, count in sorted(counts_by_state.items()))
        print(f"{name:9} {seconds:5.1f} s: {counts}")
        print(f"    left by the last one {last}, after the next run {left_over()}", flush=True)


def state_after(
    command: tuple[str, ...],
    number: signal.Signals,
    seconds: float,
    old: Mapping[str, str],
    new: Mapping[str, str],
) -> str:
    """What stands there once the command was sent that signal after so much processor time."""
    process = subprocess.Popen([*PROGRAM, *command], stderr=subprocess.PIPE, text=True)
    while process.poll() is None and processor_time(process.pid) < seconds:
        time.sleep(0.002)
    process.send_signal(number)
    errors = process.communicate()[1]
    ended = {0: "ended before", 130: "told", -number: "killed"}.get(
        process.returncode, "WRONG CODE"
    )
    return f"{ended}: {state(old, new)}{' TRACEBACK' if 'Traceback' in errors else ''}"


def processor_time(process: int) -> float:
    """Of that process so far [s]: unlike the time of day, it is the same on a busy machine."""
    fields = Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def state(old: Mapping[str, str], new: Mapping[str, str]) -> str:
    """By the bytes of all files, and by what the design says of them."""
    hashes = file_hashes(Path("out"))
    if read_design(Path("out/design.json")).files != recorded_hashes(Path("out")):
        return "MIXED BY ITS OWN HASHES"
    return "old" if hashes == old else "new" if hashes == new else "MIXED"


def full() -> None:
    """A disk that is full from the n-th file on, for each n."""
    make_design()
    for name in ("size", "export"):
        command = COMMANDS[name]
        old, _, _ = references(command)
        # What is imported once need not be in each child; and the report names what was typed.
        run(*command)
        new = file_hashes(Path("out"))
        counts: Counter[str] = Counter()
        number, is_over = 0, False
        while not is_over:
            number += 1
            renew("old", "out")
            code, traceback = in_a_child(command, number)
            is_over = code == 0
            counts[f"code {code}: {state(old, new)}{' TRACEBACK' if traceback else ''}"] += 1
        print(f"{name:9} {dict(counts)}; left over {left_over()}", flush=True)


def in_a_child(command: tuple[str, ...], number: int) -> tuple[int, bool]:
    """Exit code, and whether it was a bug, where the disk is full from that file on."""
    child = os.fork()
    if child == 0:
        fill_disk_at(number)
        try:
            os._exit(run(*command).code)
        except BaseException:
            os._exit(99)
    code = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
    return code, code == 99


def fill_disk_at(number: int) -> None:
    """From the n-th file on, none can be opened for writing."""
    opened = 0

    def hook(event: str, arguments: tuple[object, ...]) -> None:
        nonlocal opened
        if event == "open" and isinstance(arguments[2], int) and arguments[2] & os.O_CREAT:
            opened += 1
            if opened >= number:
                raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC), str(arguments[0]))

    sys.addaudithook(hook)


def together() -> None:
    """Two runs into the same folder at once, with --force and without."""
    for name in ("with --force", "without"):
        options = COMMANDS["size"] if "with " in name else COMMANDS["size"][:-1]
        shutil.rmtree("out", ignore_errors=True)
        processes = [
            subprocess.Popen([*PROGRAM, *options], stderr=subprocess.DEVNULL) for _ in range(2)
        ]
        codes = sorted(process.wait() for process in processes)
        consistent = read_design(Path("out/design.json")).files == recorded_hashes(Path("out"))
        print(f"{name}: codes {codes}, whole {consistent}, left over {left_over()}", flush=True)


def same() -> None:
    """All files on one thread and on two, under other clocks, locales, hashes, masks and homes."""
    shutil.copy(SOLO12, "solo12.urdf")
    clock = Path("clock.so").absolute()
    subprocess.run(["cc", "-shared", "-fPIC", "-o", str(clock), str(CLOCK)], check=True)
    path = {name: os.environ[name] for name in ("PATH", "PYTHONPATH") if name in os.environ}
    threads = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")
    usual = {"HOME": "/", "LANG": "C.UTF-8", "PYTHONHASHSEED": "1", "TZ": "UTC"}
    other = {"LC_ALL": "C", "PYTHONUTF8": "0", "PYTHONCOERCECLOCALE": "0", "PYTHONHASHSEED": "2"}
    other |= {"TZ": "Asia/Tokyo", "SOURCE_DATE_EPOCH": "5", "LD_PRELOAD": str(clock)}
    machines = {
        "one": (path | usual | dict.fromkeys(threads, "1"), {0}, 0o022),
        "two": (path | other | dict.fromkeys(threads, "2"), {0, 1}, 0o077),
    }
    for name, (environment, cores, mask) in machines.items():
        Path(name).mkdir()
        for command in (
            ("size", "../solo12.urdf", "--seed", "7", "-q", "-o", "out"),
            ("export", "out", "--formats", "all", "-q", "-o", "all"),
        ):
            subprocess.run(
                [*PROGRAM, *command],
                cwd=name,
                env=environment,
                umask=mask,
                preexec_fn=lambda cores=cores: os.sched_setaffinity(0, cores),
                check=True,
            )
    one, two = (file_hashes(Path(name)) for name in machines)
    differing = sorted(name for name in one.keys() | two.keys() if one.get(name) != two.get(name))
    print(f"{len(one)} files, differing: {differing or 'none'}")


def make_design() -> None:
    """What is exported and flown again."""
    run_to_end(("size", SOLO12, *QUICK, "-o", "design"))


def references(command: tuple[str, ...]) -> tuple[Mapping[str, str], Mapping[str, str], float]:
    """Old folder and new one as they must be, and the processor time of the command [s]."""
    shutil.rmtree("old", ignore_errors=True)
    shutil.rmtree("out", ignore_errors=True)
    run_to_end(("size", SOLO12, *QUICK, "--seed", "1", "-o", "old"))
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    run_to_end(command)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    seconds = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return file_hashes(Path("old")), file_hashes(Path("out")), seconds


def run_to_end(command: tuple[str, ...]) -> None:
    subprocess.run([*PROGRAM, *command], check=True)


def renew(source: str, target: str) -> None:
    shutil.rmtree(target, ignore_errors=True)
    shutil.copytree(source, target)


def left_over() -> list[str]:
    """What stands beside the folders that are meant to be here."""
    return sorted({path.name for path in Path().iterdir()} - {"old", "out", "design"})


if __name__ == "__main__":
    main()
