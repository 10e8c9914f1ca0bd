"""Runs of the doctest program on a mutant: one process for each test file, the nearest first, under a time limit.

A process for each file gives each a limit of its own, so that an endless loop in a quick test ends soon. Limits come
from the unmutated program, measured once for each build.
"""

import collections
import json
import os
import re
import signal
import subprocess
import time

# Beyond what the unmutated program needs: the machine may be busy with other things.
CPU_LIMIT_S, CPU_FACTOR = 5.0, 4.0
WALL_LIMIT_S, WALL_FACTOR = 20.0, 10.0
FIRST_LIMIT_S = 900.0  # for the unmutated program
MOST_MEMORY = 8 << 30
MOST_FILE = 1 << 30
COUNT = re.compile(r"^\[doctest\] test cases: +(\d+) \| +(\d+) passed \| +(\d+) failed", re.MULTILINE)
CASE = re.compile(r"^TEST CASE: +(.*)$", re.MULTILINE)


class NoTests(Exception):
    """No test file passes without a mutant."""


Run = collections.namedtuple("Run", "verdict case cases wall_s cpu_s")  # verdict: passed, failed, crashed or endless


# The limits are set by a shell: a fork of this program, which has threads, might not get as far as to set them.
LIMITED = (f'ulimit -c 0 && ulimit -t "$1" && ulimit -v {MOST_MEMORY >> 10} && ulimit -f {MOST_FILE >> 9} '
           '&& shift && exec "$@"')


def wait_for(process, wall_s):
    """(exit status, CPU seconds); kills the process and its children when the time is over."""
    until = time.monotonic() + wall_s
    pause_s = 0.002
    while True:
        pid, status, usage = os.wait4(process.pid, os.WNOHANG)
        if pid:
            process.returncode = os.waitstatus_to_exitcode(status)
            return process.returncode, usage.ru_utime + usage.ru_stime
        if time.monotonic() > until:
            end_group(process)
            os.wait4(process.pid, 0)
            process.returncode = -signal.SIGKILL
            return None, 0.0
        time.sleep(pause_s)
        pause_s = min(0.05, 1.5 * pause_s)


def end_group(process):
    """Ends what this process started too: it leads a process group of its own."""
    try:
        os.killpg(process.pid, signal.SIGKILL)
    except ProcessLookupError:
        pass


def run_file(program, test_file, cwd, temporary, cpu_s, wall_s):
    """The test cases of one source file, up to the first failure."""
    log = os.path.join(temporary, "output.txt")
    started = time.monotonic()
    with open(log, "wb") as output:
        process = subprocess.Popen(
            ["sh", "-c", LIMITED, "sh", str(int(cpu_s) + 1), program, f"--source-file={test_file}", "--abort-after=1",
             "--no-colors=true"],
            cwd=cwd, stdin=subprocess.DEVNULL, stdout=output, stderr=subprocess.STDOUT, start_new_session=True,
            env={**os.environ, "TMPDIR": temporary})
        try:
            code, used_s = wait_for(process, wall_s)
        finally:
            end_group(process)
    took_s = time.monotonic() - started
    with open(log, encoding="utf-8", errors="replace") as file:
        text = file.read()
    named = CASE.findall(text)
    count = COUNT.search(text)
    case = named[-1].strip() if named else ""
    if code is None or code in (-signal.SIGXCPU, -signal.SIGKILL):
        return Run("endless", case, 0, took_s, used_s)
    if code == 0 and count:
        return Run("passed", "", int(count[1]), took_s, used_s)
    return Run("failed" if count and code > 0 else "crashed", case, 0, took_s, used_s)


# --- Which file first ------------------------------------------------------------------------------


def room_of(path):
    """gdextension/core/tension/x.cpp and tests/core/tension/test_x.cpp are both of the room core/tension."""
    return os.path.dirname(path).split(os.sep, 1)[-1]


def distance(room, other):
    """0: the same room; 1: one lies in the other; 2: the same top folder; 3: elsewhere."""
    if room == other:
        return 0
    inside = (room + "/").startswith(other + "/") or (other + "/").startswith(room + "/")
    if inside and "/" in room and "/" in other:
        return 1
    return 2 if room.split("/")[0] == other.split("/")[0] else 3


NEAR = 1  # up to this distance, a test file mirrors the mutated one


class Suite:
    """The test files of the unmutated program and how long each takes; files that fail by themselves are left out."""

    def __init__(self, base, temporary, log):
        self.files = {}  # path: (wall seconds, CPU seconds)
        self.failing = []
        sources = sorted(path for path in base.objects if path.startswith("tests/"))
        memory = os.path.join(temporary, "suite.json")
        if os.path.isfile(memory):
            with open(memory, encoding="utf-8") as file:
                kept = json.load(file)
            if kept["digest"] == base.digest:
                self.files, self.failing = kept["files"], kept["failing"]
                return
        log(f"timing {len(sources)} test files without a mutant")
        for path in sources:
            run = run_file(base.program, path, base.tree, temporary, FIRST_LIMIT_S, FIRST_LIMIT_S)
            if run.verdict != "passed":
                run = run_file(base.program, path, base.tree, temporary, FIRST_LIMIT_S, FIRST_LIMIT_S)
            if run.verdict != "passed":
                log(f"NOT USED: {path} {run.verdict} without a mutant ({run.case})")
                self.failing.append(path)
            elif run.cases:
                self.files[path] = (run.wall_s, run.cpu_s)
        if not self.files:
            raise NoTests("no test file passes without a mutant")
        with open(memory, "w", encoding="utf-8") as file:
            json.dump({"digest": base.digest, "files": self.files, "failing": self.failing}, file)

    def ordered(self, path):
        """Test files in the order in which they try a mutant of `path`: nearest first, then the quickest."""
        room = room_of(path)
        return sorted(self.files, key=lambda file: (distance(room, room_of(file)), self.files[file], file))

    def near(self, path):
        room = room_of(path)
        return [file for file in self.ordered(path) if distance(room, room_of(file)) <= NEAR]

    def try_file(self, program, test_file, cwd, temporary):
        """One run; a failure must happen twice, for a busy machine may upset a test of real time."""
        wall_s, cpu_s = self.files[test_file]
        allowed = (CPU_LIMIT_S + CPU_FACTOR * cpu_s, WALL_LIMIT_S + WALL_FACTOR * wall_s)
        run = run_file(program, test_file, cwd, temporary, *allowed)
        if run.verdict in ("failed", "crashed"):
            again = run_file(program, test_file, cwd, temporary, *allowed)
            if again.verdict == "passed":
                return Run("unsteady", run.case, 0, run.wall_s, run.cpu_s)
        return run
