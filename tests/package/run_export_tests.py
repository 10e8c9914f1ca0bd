#!/usr/bin/env python3
"""The demo as a shipped game: run_export_tests.py GODOT

Exports a pack (--export-pack), puts it into an empty folder with nothing but the extension's library beside it, and lets
it play a task by script. The last line is "N passed, N failed".
"""

import csv
import os
import re
import shutil
import subprocess
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))
sys.path.insert(0, os.path.join(ROOT, "tests"))
import godot_project  # noqa: E402

OUT = os.path.join(ROOT, "build", "export")
LIBRARIES = os.path.join("addons", "spidar_g", "bin")
LIMIT_S = 300
PRESET = """[preset.0]

name="pack"
platform="Linux"
runnable=true
export_filter="all_resources"
include_filter=""
exclude_filter=""
export_path=""

[preset.0.options]

binary_format/architecture="x86_64"
"""

passed = failed = 0


def check(good, what):
    global passed, failed
    passed, failed = passed + bool(good), failed + (not good)
    print("ok  " if good else "FAIL", what)


def run(command, folder):
    """Exit code and output."""
    try:
        done = subprocess.run(command, cwd=folder, timeout=LIMIT_S, text=True, errors="replace",
                              stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    except subprocess.TimeoutExpired:
        return None, f"not done in {LIMIT_S} s"
    return done.returncode, done.stdout


def errors_of(output):
    """Of ours: on a busy machine Godot's own physics may run out of job slots for a moment, and says so."""
    lines = re.findall(r"^.*(?:ERROR|WARNING).*$", output, re.M)
    return [line for line in lines if "Jolt Physics job system" not in line]


def copy_demo():
    """The demo without Godot's caches: what a fresh clone has."""
    project = os.path.join(OUT, "demo")
    shutil.rmtree(OUT, ignore_errors=True)
    shutil.copytree(os.path.join(ROOT, "demo_project"), project,
                    ignore=shutil.ignore_patterns("addons", ".godot"))
    with open(os.path.join(project, "export_presets.cfg"), "w", encoding="utf-8") as file:
        file.write(PRESET)
    return project


def main(godot):
    project = copy_demo()
    godot_project.prepare_project(project, godot)
    pack = os.path.join(OUT, "game", "demo.pck")
    os.makedirs(os.path.dirname(pack))
    code, output = run([godot, "--headless", "--path", project, "--export-pack", "pack", pack], OUT)
    check(code == 0 and os.path.exists(pack), f"the pack is exported (exit code {code})")
    check(not errors_of(output), f"no warning, no error of the export: {errors_of(output)[:3]}")
    if not os.path.exists(pack):
        print(output[-2000:])
        return
    # The project is out of reach from here on.
    shutil.rmtree(project)
    game = os.path.dirname(pack)
    shutil.copytree(os.path.join(ROOT, LIBRARIES), os.path.join(game, LIBRARIES))
    results = os.path.join(game, "results")
    code, output = run([godot, "--headless", "--audio-driver", "Dummy", "--main-pack", pack, "--fixed-fps", "60", "--",
                        "--play", "pick_and_place", "--level", "1", "--seed", "1", "--out", results], game)
    check(code == 0, f"the game plays its task from the pack (exit code {code})")
    check(not errors_of(output), f"no warning, no error of the game: {errors_of(output)[:3]}")
    if code != 0:
        print(output[-2000:])
        return
    with open(os.path.join(results, "summary.csv"), encoding="utf-8", newline="") as file:
        summary = list(csv.DictReader(file))
    with open(os.path.join(results, "objects.csv"), encoding="utf-8", newline="") as file:
        objects = list(csv.DictReader(file))
    check(len(summary) == 1 and summary[0]["completed"] == "1", "the task is completed")
    check(objects and all(row["placed"] == "1" for row in objects), f"all {len(objects)} objects are placed")
    # What the pack must not need: the add-on's library is the only file of ours outside it.
    outside = [name for _, _, names in os.walk(game) for name in names if name.endswith((".gd", ".tscn", ".svg"))]
    check(not outside, f"nothing but the library is beside the pack: {outside[:3]}")


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    main(os.path.abspath(sys.argv[1]))
    print(f"{passed} passed, {failed} failed")
    sys.exit(1 if failed or not passed else 0)
