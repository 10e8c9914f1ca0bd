#!/usr/bin/env python3
"""Runs stages of the tests: run_stages.py list | check NAME... | run NAME_OR_GROUP...

The stages are the lines of stages.txt. Each runs as a process of its own, in a session of its own, under its time
limit; its output goes to build/logs/NAME.log too. A stage notes what it checked in build/logs/NAME.result, as lines
"PASSED FAILED" and a last line "ended": one that ends early, or notes nothing, fails. After several stages, a last
check compares the files that git knows or would add with what they were before. The last line is "N passed, N failed".
"""

import collections
import hashlib
import os
import resource
import signal
import subprocess
import sys
import threading
import time

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))
TABLE = os.path.join(HERE, "stages.txt")
LOGS = os.path.join("build", "logs")
GROUPS = ("quick", "rest", "release", "by-hand")
END_LIMIT_S = 10  # what a stage may take to end when it is told to
POLL_S = 0.1

Stage = collections.namedtuple("Stage", "name group limit_s checks")
# Of the wall clock, and of the processors: on a busy machine only the latter tells what a stage costs.
Verdict = collections.namedtuple("Verdict", "name passed failed seconds processor_s")


class StageError(Exception):
    """A table or a name that is wrong; the text says how."""


def read_table(path=TABLE):
    stages = []
    with open(path, encoding="utf-8") as file:
        for number, line in enumerate(file, 1):
            if not line.strip() or line.startswith("#"):
                continue
            words = line.split(None, 3)
            if len(words) != 4 or words[1] not in GROUPS or not words[2].isdigit():
                raise StageError(f"{path}:{number}: not a line of NAME GROUP LIMIT_S WHAT: {line.strip()}")
            stages.append(Stage(words[0], words[1], int(words[2]), words[3].strip()))
    return stages


def select(stages, names):
    """The stages of these names and groups, in the order of the table within a group."""
    chosen = []
    for name in names:
        found = [stage for stage in stages if name in (stage.name, stage.group)]
        if not found:
            raise StageError(f"no stage {name}; ./dev stages lists them")
        chosen += found
    return chosen


# --- Processes -----------------------------------------------------------------------------------


def processes_of(session):
    """Ids of the processes in a session. `timeout` and shells give their children process groups of their own, so a
    group would not be enough."""
    found = []
    for name in os.listdir("/proc") if os.path.isdir("/proc/self") else ():
        try:
            # The state follows the program's name, which may hold anything, in brackets; Z has ended already.
            with open(f"/proc/{name}/stat", encoding="utf-8", errors="replace") as file:
                fields = file.read().rpartition(")")[2].split()
        except OSError:
            continue
        if fields[0] != "Z" and int(fields[3]) == session:
            found.append(int(name))
    return found


def end_session(session):
    """Ends every process of the session: politely, then not."""
    for number, patience_s in ((signal.SIGTERM, END_LIMIT_S), (signal.SIGKILL, 1)):
        for process in processes_of(session):
            try:
                os.kill(process, number)
            except ProcessLookupError:
                pass
        deadline = time.monotonic() + patience_s
        while processes_of(session) and time.monotonic() < deadline:
            time.sleep(POLL_S)


def copy_output(source, log):
    for line in source:
        sys.stdout.buffer.write(line)
        sys.stdout.buffer.flush()
        log.write(line)
        log.flush()


def run_limited(command, limit_s, log_path):
    """Runs the command with its output here and in the log. False: it was ended at its limit."""
    with open(log_path, "wb") as log:
        process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                                   start_new_session=True)
        copier = threading.Thread(target=copy_output, args=(process.stdout, log), daemon=True)
        copier.start()
        try:
            process.wait(limit_s)
        except subprocess.TimeoutExpired:
            return False
        finally:
            # Whatever ended the wait: a stage leaves nothing behind.
            end_session(process.pid)
            process.kill()
            process.wait()
            copier.join(END_LIMIT_S)
    return True


# --- Stages --------------------------------------------------------------------------------------


def read_result(path):
    """(passed, failed, whether the stage reached its end)"""
    passed = failed = 0
    ended = False
    with open(path, encoding="utf-8") as file:
        for line in file.read().splitlines():
            words = line.split()
            if line == "ended":
                ended = True
            elif len(words) == 2:
                passed, failed = passed + int(words[0]), failed + int(words[1])
    return passed, failed, ended


def run_stage(stage, command):
    """Runs `command` NAME and prints the verdict."""
    print(f"\n=== {stage.name}", flush=True)
    clock = Clock()
    result = os.path.join(LOGS, f"{stage.name}.result")
    open(result, "w", encoding="utf-8").close()
    in_time = run_limited([*command, stage.name], stage.limit_s, os.path.join(LOGS, f"{stage.name}.log"))
    passed, failed, ended = read_result(result)
    if not in_time:
        print(f"dev: the stage did not end within {stage.limit_s} s")
    elif not ended:
        print("dev: the stage broke off before its end")
    elif passed + failed == 0:
        print("dev: the stage checked nothing")
    if failed == 0 and (not in_time or not ended or passed == 0):
        failed = 1
    return print_verdict(Verdict(stage.name, passed, failed, *clock.times()))


class Clock:
    """Both times since it was made."""

    def __init__(self):
        self.started = self.now()

    @staticmethod
    def now():
        used = resource.getrusage(resource.RUSAGE_CHILDREN)
        return time.monotonic(), used.ru_utime + used.ru_stime

    def times(self):
        return [now - then for now, then in zip(self.now(), self.started)]


def print_verdict(verdict):
    word = "FAIL" if verdict.failed else "PASS"
    print(f"--- {verdict.name}: {word}, {verdict.passed} passed, {verdict.failed} failed, {verdict.seconds:.0f} s",
          flush=True)
    return verdict


# --- The files of the checkout ---------------------------------------------------------------------


def changed_files():
    """What git would commit here, as path -> (status, digest of the content). None without git."""
    try:
        done = subprocess.run(["git", "--no-optional-locks", "status", "--porcelain", "-z", "--no-renames",
                               "--untracked-files=all"], check=True, capture_output=True)
    except (OSError, subprocess.CalledProcessError):
        return None
    files = {}
    for entry in done.stdout.decode(errors="surrogateescape").split("\0"):
        if entry:
            state, path = entry[:2], entry[3:]
            content = b""
            if os.path.isfile(path):
                with open(path, "rb") as file:
                    content = file.read()
            files[path] = (state, hashlib.sha256(content).hexdigest())
    return files


def check_files(before):
    """A build or a test leaves no tracked file changed, and no file that git does not ignore."""
    print("\n=== clean_tree", flush=True)
    clock = Clock()
    after = changed_files()
    touched = sorted(path for path in before.keys() | after.keys() if before.get(path) != after.get(path))
    with open(os.path.join(LOGS, "clean_tree.log"), "w", encoding="utf-8", errors="surrogateescape") as log:
        for path in touched:
            line = f"FAIL {path}: changed or left by the run ({after.get(path, ('as committed',))[0].strip()})"
            print(line)
            print(line, file=log)
    return print_verdict(Verdict("clean_tree", 0 if touched else 1, len(touched), *clock.times()))


# --- Entry ---------------------------------------------------------------------------------------


def run(stages, command):
    """Runs the stages; whether all passed."""
    os.makedirs(LOGS, exist_ok=True)
    before = changed_files() if len(stages) > 1 else None
    verdicts = [run_stage(stage, command) for stage in stages]
    if before is not None:
        verdicts.append(check_files(before))
    elif len(stages) > 1:
        print("\ndev: not a git checkout: whether the run left files is not checked")
    print()
    for verdict in verdicts:
        word = "FAIL" if verdict.failed else "PASS"
        print(f"{verdict.name:<20} {word} {verdict.passed:6} passed {verdict.failed:4} failed "
              f"{verdict.seconds:5.0f} s {verdict.processor_s:5.0f} s of processor time")
    failed = sum(verdict.failed for verdict in verdicts)
    print(f"{sum(verdict.passed for verdict in verdicts)} passed, {failed} failed", flush=True)
    return failed == 0


def list_stages(stages):
    for stage in stages:
        print(f"{stage.name:<18} {stage.group:<8} {stage.limit_s:4} s  {stage.checks}")


def interrupted(*_):
    raise KeyboardInterrupt


def main(arguments):
    os.chdir(ROOT)
    action, names = arguments[0], arguments[1:]
    try:
        stages = read_table()
        if action == "list":
            list_stages(stages)
            return 0
        chosen = select(stages, names)
    except StageError as problem:
        print(f"dev: {problem}", file=sys.stderr)
        return 1
    if action == "check":
        return 0
    signal.signal(signal.SIGTERM, interrupted)
    try:
        return 0 if run(chosen, [os.path.join(".", "dev"), "in-stage"]) else 1
    except KeyboardInterrupt:
        print("\ndev: interrupted", file=sys.stderr)
        return 130


if __name__ == "__main__":
    if len(sys.argv) < 2 or sys.argv[1] not in ("list", "check", "run"):
        sys.exit(__doc__)
    sys.exit(main(sys.argv[1:]))
