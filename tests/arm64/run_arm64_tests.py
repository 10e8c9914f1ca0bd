#!/usr/bin/env python3
"""The arm64 library in a Godot for arm64: run_arm64_tests.py GODOT_ARM64 GODOT [PART_OF_NAME]

GODOT_ARM64 runs under qemu's user mode, about twenty times slower than the machine. GODOT is the machine's own and imports
the projects. Runs the headless tests but for those of NOT_RUN, each file in a project of its own so that no other is
loaded, and one scripted play. The last line is "N passed, N failed".
"""

import csv
import os
import shutil
import subprocess
import sys
import tempfile
import time

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
sys.path[:0] = [os.path.join(ROOT, "tests"), os.path.join(ROOT, "tests", "godot")]
import run_godot_tests  # noqa: E402
from godot_project import prepare_project  # noqa: E402

LIMIT_S = 1500
# Files of tests that are not run, and why. timed_*.gd are never run here: they need a game in real time.
NOT_RUN = {}


def run_file(godot, native, name):
    """One file of tests: how many passed and failed."""
    started = time.monotonic()
    # As deep below the checkout as the project itself: a test reads docs/.
    with tempfile.TemporaryDirectory(dir=os.path.join(ROOT, "build", "arm64")) as project:
        skip = [file for file in os.listdir(run_godot_tests.PROJECT)
                if file.startswith(("test_", "timed_")) and file not in ("test_case.gd", name + ".gd")]
        shutil.copytree(run_godot_tests.PROJECT, project, dirs_exist_ok=True,
                        ignore=shutil.ignore_patterns("addons", ".godot", "*.uid", *skip))
        prepare_project(project, native)
        passed, failed = run_godot_tests.run_scripts(godot, project=project)
    print(f"INFO {name}: {passed} passed, {failed} failed, {time.monotonic() - started:.0f} s", flush=True)
    return passed, failed


def play(godot, native):
    """The demo plays a task by script: (1, 0) when it is completed."""
    demo = os.path.join(ROOT, "demo_project")
    prepare_project(demo, native)
    with tempfile.TemporaryDirectory(prefix="spidar_g_arm64_") as results:
        command = [godot, "--headless", "--audio-driver", "Dummy", "--path", demo, "--fixed-fps", "60", "--",
                   "--play", "pick_and_place", "--level", "1", "--seed", "1", "--out", results]
        try:
            done = subprocess.run(command, timeout=LIMIT_S, text=True, errors="replace", check=False,
                                  stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
            with open(os.path.join(results, "summary.csv"), encoding="utf-8", newline="") as file:
                completed = [row["completed"] for row in csv.DictReader(file)] == ["1"]
        except (OSError, subprocess.TimeoutExpired) as error:
            print(f"FAIL play: {error}")
            return 0, 1
    good = done.returncode == 0 and completed
    print("PASS" if good else "FAIL", f"play: pick_and_place, exit code {done.returncode}, completed {completed}")
    if not good:
        print(done.stdout[-2000:])
    return (1, 0) if good else (0, 1)


def main(godot, native, part=""):
    run_godot_tests.TIME_LIMIT_S = LIMIT_S
    run_godot_tests.FROZEN_S = LIMIT_S
    files = sorted(file[:-len(".gd")] for file in os.listdir(run_godot_tests.PROJECT)
                   if file.startswith("test_") and file.endswith(".gd") and file != "test_case.gd")
    for name in sorted(set(NOT_RUN) - set(files)):
        sys.exit(f"run_arm64_tests: NOT_RUN names {name}, which is not there")
    passed = failed = 0
    for name in files:
        if part not in name:
            continue
        if name in NOT_RUN and part != name:
            print(f"INFO {name}: not run, for it {NOT_RUN[name]}")
            continue
        good, bad = run_file(godot, native, name)
        passed, failed = passed + good, failed + bad
    if not part:
        good, bad = play(godot, native)
        passed, failed = passed + good, failed + bad
    print(f"{passed} passed, {failed} failed")
    return 0 if passed and not failed else 1


if __name__ == "__main__":
    if len(sys.argv) not in (3, 4):
        sys.exit(__doc__)
    sys.exit(main(*sys.argv[1:]))
