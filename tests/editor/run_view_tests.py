#!/usr/bin/env python3
"""The add-on in a real editor: run_view_tests.py GODOT [--actions N] [--seed S] [--part view|claims|idle|actions|mouse] [--display]

Part mouse drags the handles with a real mouse on $DISPLAY. The others need no display: the 3-D view's checks, the
claims of devices in the inspector, what an idle editor pays, then N random actions of a user: add, duplicate, delete, undo, redo, change a resource, drag a handle,
save, close and open scenes, switch the plugin off and on, close and open the project. Fails on a failed check, an error,
a crash, a servo thread in the editor or an object left behind. The seed is printed: --seed S repeats a run. The last
line is "N passed, N failed".
"""

import argparse
import os
import re
import shutil
import subprocess
import sys
import threading
import time

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.dirname(HERE))
from godot_project import prepare_project  # noqa: E402

SOURCE = os.path.join(HERE, "view")
PROJECT = os.path.join(os.path.dirname(os.path.dirname(HERE)), "build", "editor", "view")
SCENES = {"stage.tscn": "Stage", "second.tscn": "Second"}
TIME_LIMIT_S = 600
DISPLAYED = ["--rendering-driver", "opengl3", "--audio-driver", "Dummy"]
# What an editor without a display says of itself.
NOT_OURS = re.compile(r"VK_KHR|V-Sync|vulkan|RID allocations|XDG_|could not be found|Audio")
ERRORS = re.compile(r"^(?:SCRIPT )?ERROR:.*(?:\n +.*)*", re.M)
LEAKS = re.compile(r"^Leaked instance: SpidarG.*", re.M)
COUNTS = re.compile(r"^(\d+) passed, (\d+) failed$", re.M)


def copy_project():
    """An editor writes into its project: it gets a copy."""
    shutil.copytree(SOURCE, PROJECT, dirs_exist_ok=True, ignore=shutil.ignore_patterns("addons", ".godot"))
    for name, root in SCENES.items():
        with open(os.path.join(PROJECT, name), "w", encoding="utf-8") as file:
            file.write(f'[gd_scene format=3]\n\n[node name="{root}" type="Node3D"]\n')


def edit(godot, *arguments):
    """The editor with the driver's script: what it printed, its exit code. With a display it is shown there."""
    display = DISPLAYED if "DISPLAY" in os.environ else ["--headless"]
    command = [godot, *display, "--verbose", "--editor", "--path", PROJECT, "--", *arguments]
    try:
        done = subprocess.run(command, timeout=TIME_LIMIT_S, text=True, errors="replace", stdin=subprocess.DEVNULL,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        return done.stdout, done.returncode
    except subprocess.TimeoutExpired as error:
        return (error.stdout or b"").decode(errors="replace"), f"none within {TIME_LIMIT_S} s"


def problems_of(output, code):
    """What went wrong beside the checks that the script itself counts."""
    found = [text for text in ERRORS.findall(output) if not NOT_OURS.search(text)]
    found += LEAKS.findall(output)
    if code != 0 and not COUNTS.search(output):
        found.append(f"the editor ended with {code}:\n{output[-3000:]}")
    return found


def checks(godot, script):
    """A script of the driver that counts its own checks."""
    output, code = edit(godot, script)
    for line in re.findall(r"^idle editor:.*", output, re.M):
        print(line)
    counts = COUNTS.findall(output)
    passed, failed = (int(n) for n in counts[-1]) if counts else (0, 1)
    problems = re.findall(r"^FAIL.*", output, re.M) + problems_of(output, code)
    for problem in problems:
        print(problem)
    return passed, max(failed, len(problems))


def xdotool(*words):
    subprocess.run(["xdotool", *[str(word) for word in words]], check=True, timeout=60)


def drag(x, y, to_x, to_y):
    """With a real mouse, slowly: a busy editor must see where it was pressed."""
    xdotool("mousemove", x, y, "sleep", 1.0, "mousedown", 1, "sleep", 0.5)
    for step in range(1, 11):
        xdotool("mousemove", x + (to_x - x) * step // 10, y + (to_y - y) * step // 10, "sleep", 0.1)
    xdotool("sleep", 0.5, "mouseup", 1)


def mouse_drags(godot, *pictures):
    """The handles under a real mouse: needs a display and xdotool. (passed, failed)"""
    told = subprocess.run(["xdotool", "getdisplaygeometry"], check=True, text=True, capture_output=True).stdout
    # One window: without a window manager nobody would close a dialog's.
    command = [godot, *DISPLAYED, "--editor", "--single-window", "--path", PROJECT, "--position", "0,0",
               "--resolution", "x".join(told.split()), "res://stage.tscn", "--", "mouse_drag", *pictures]
    counts, problems = [], []
    with subprocess.Popen(command, text=True, errors="replace", stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT) as editor:
        stop = threading.Timer(TIME_LIMIT_S, editor.kill)
        stop.start()
        for line in editor.stdout:
            words = line.split()
            if words[:1] == ["MOVE"]:
                x, y = [int(word) for word in words[1:]]
                xdotool("search", "--onlyvisible", "--name", "spidar_g in the editor", "windowfocus")
                xdotool("mousemove", x + 30, y + 30, "sleep", 1.0, "mousemove", x, y)
            elif words[:1] == ["DRAG"]:
                drag(*[int(word) for word in words[1:]])
            elif words[:1] == ["KEY"]:
                xdotool("key", words[1])
            elif words[:1] == ["FAIL"] or "SCRIPT ERROR" in line:
                problems.append(line.strip())
            counts = COUNTS.findall(line) or counts
        stop.cancel()
    for problem in problems:
        print(problem)
    passed, failed = (int(n) for n in counts[-1]) if counts else (0, 1)
    return passed, max(failed, len(problems), editor.returncode != 0)


def random_actions(godot, count, seed):
    """One editor after the other, until all actions are done: an action may close the project."""
    done, editors, kinds, problems = 0, 0, {}, []
    while done < count and not problems:
        output, code = edit(godot, "random_actions", str(seed), str(done), str(count))
        editors += 1
        acted = re.findall(r"^ACTION (\d+) (\w+)", output, re.M)
        for _, kind in acted:
            kinds[kind] = kinds.get(kind, 0) + 1
        problems = re.findall(r"^FAIL.*", output, re.M) + problems_of(output, code)
        if not acted:
            problems.append(f"no action was done; the editor ended with {code}:\n{output[-3000:]}")
            break
        last, done = done, int(acted[-1][0]) + 1
        if problems:
            print(f"actions {last} to {done - 1}: " + " ".join(kind for _, kind in acted))
    effects = dict.fromkeys(("add", "duplicate", "undo", "redo", "resource", "close_scene", "reload_project"), 0)
    missing = [kind for kind in effects if not kinds.get(kind)] if count >= 200 else []
    problems += [f"never drawn: {kind}" for kind in missing]
    for problem in problems:
        print("FAIL", problem)
    told = ", ".join(f"{kind} {number}" for kind, number in sorted(kinds.items()))
    print(f"{done} random actions in {editors} editors, seed {seed}: {told}")
    return (1, 0) if not problems else (0, len(problems))


def main():
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("godot")
    options.add_argument("--actions", type=int, default=200)
    options.add_argument("--seed", type=int, default=int(time.time()) % 1000000)
    options.add_argument("--part", choices=("view", "claims", "idle", "actions", "mouse"))
    options.add_argument("--pictures", nargs=2, default=(), metavar="FILE", help="of the mouse part: editor and view")
    options.add_argument("--display", action="store_true", help="use $DISPLAY in place of --headless")
    chosen = options.parse_args()
    if not chosen.display and chosen.part != "mouse":
        os.environ.pop("DISPLAY", None)
    copy_project()
    prepare_project(PROJECT, chosen.godot)
    passed = failed = 0
    for part, script in (("view", "view_checks"), ("claims", "claim_checks"), ("idle", "idle_cost")):
        if chosen.part in (None, part):
            good, bad = checks(chosen.godot, script)
            print(f"{script}: {good} checks, {bad} failed")
            passed, failed = passed + good, failed + bad
    if chosen.part == "mouse":
        passed, failed = mouse_drags(chosen.godot, *[os.path.abspath(file) for file in chosen.pictures])
        print(f"mouse_drag: {passed} checks, {failed} failed")
    if chosen.part in (None, "actions"):
        good, bad = random_actions(chosen.godot, chosen.actions, chosen.seed)
        passed, failed = passed + good, failed + bad
    print(f"{passed} passed, {failed} failed")
    return 1 if failed or not passed else 0


if __name__ == "__main__":
    sys.exit(main())
