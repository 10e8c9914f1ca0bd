"""What the tests of exported games share: counted checks, projects copied out of the checkout, and runs of programs."""

import csv
import os
import re
import shutil
import subprocess
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
sys.path.insert(0, os.path.join(ROOT, "tests"))
import godot_project  # noqa: E402

LIMIT_S = 300
PRESET = """[preset.0]

name="game"
platform="{platform}"
runnable=true
export_filter="all_resources"
include_filter=""
exclude_filter=""
export_path=""

[preset.0.options]

custom_template/debug="{templates}/godot-template-debug"
custom_template/release="{templates}/godot-template-release"
debug/export_console_wrapper=0
binary_format/embed_pck=false
binary_format/architecture="x86_64"
"""
# To play a task by script: goes after the program, before the folder of its results.
PLAY = ["--headless", "--audio-driver", "Dummy", "--fixed-fps", "60", "--",
        "--play", "pick_and_place", "--level", "1", "--seed", "1", "--out"]

# On a busy machine Godot's own physics may run out of job slots for a moment. And Debian's release template says the
# other of every container that loses a child, in a project of three nodes too.
NOISE = ("Jolt Physics job system", "Attempt to disconnect a nonexistent connection")

_counts = [0, 0]


def check(good, what):
    _counts[0 if good else 1] += 1
    print("ok  " if good else "FAIL", what, flush=True)


def end():
    """The exit code of a runner, whose last line this prints."""
    passed, failed = _counts
    print(f"{passed} passed, {failed} failed")
    return 1 if failed or not passed else 0


def run(command, folder):
    """Exit code and output."""
    try:
        done = subprocess.run(command, cwd=folder, timeout=LIMIT_S, text=True, errors="replace",
                              stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    except subprocess.TimeoutExpired:
        return None, f"not done in {LIMIT_S} s"
    return done.returncode, done.stdout


def errors_of(output):
    """What nobody expects: without Godot's own noise."""
    lines = re.findall(r"^.*(?:ERROR|WARNING).*$", output, re.M)
    return [line for line in lines if not any(noise in line for noise in NOISE)]


def copy_project(source, target, platform="Linux", templates=""):
    """A project without Godot's caches, as a fresh clone has it, and a preset for its export."""
    shutil.rmtree(target, ignore_errors=True)
    shutil.copytree(os.path.join(ROOT, source), target, ignore=shutil.ignore_patterns("addons", ".godot"))
    with open(os.path.join(target, "export_presets.cfg"), "w", encoding="utf-8") as file:
        file.write(PRESET.format(platform=platform, templates=templates))


def export(godot, project, kind, target, expected=None):
    """kind: pack, debug or release. Checks that it ends well and says nothing but what is expected, a regular expression;
    the caller looks at what is there."""
    os.makedirs(os.path.dirname(target), exist_ok=True)
    code, output = run([godot, "--headless", "--path", project, f"--export-{kind}", "game", target], project)
    check(code == 0 and os.path.exists(target), f"{kind}: exported (exit code {code})")
    errors = [line for line in errors_of(output) if not (expected and expected.search(line))]
    check(not errors, f"{kind}: no warning, no error of the export: {errors[:3]}")
    if not os.path.exists(target):
        print(output[-2000:])


def check_play(command, folder, name):
    """The command plays a task by script; its results go to the folder."""
    results = os.path.join(folder, "results")
    code, output = run([*command, *PLAY, results], folder)
    check(code == 0, f"{name}: the game plays its task (exit code {code})")
    check(not errors_of(output), f"{name}: no warning, no error of the game: {errors_of(output)[:3]}")
    if code != 0:
        print(output[-2000:])
        return
    rows = {}
    for table in ("summary", "objects"):
        with open(os.path.join(results, table + ".csv"), encoding="utf-8", newline="") as file:
            rows[table] = list(csv.DictReader(file))
    check(len(rows["summary"]) == 1 and rows["summary"][0]["completed"] == "1", f"{name}: the task is completed")
    check(rows["objects"] and all(row["placed"] == "1" for row in rows["objects"]),
          f"{name}: all {len(rows['objects'])} objects are placed")
