#!/usr/bin/env python3
"""The examples of the add-on, each in a Godot of its own: run_example_tests.py GODOT [PART_OF_NAME ...] [--pictures FOLDER [--size WxH] | --gallery]

The project tests/godot/examples holds the add-on and Godot's own settings, as a project into which somebody copies the
add-on. Every scene addons/spidar_g/examples/NAME/NAME.tscn is loaded and played: tests/godot/examples/check_example.gd says
what it must have, tests/godot/examples/plays/NAME.gd what is done in it. To add an example, add both files. Nothing may be
printed as a warning or an error. --pictures needs a display (xvfb-run) and saves FOLDER/NAME.png. --gallery needs one too
and makes the gallery's own pictures anew, addons/spidar_g/examples/gallery/pictures/NAME.webp. The gallery itself is no
example: check_gallery.gd opens all of them in it.
"""

import argparse
import glob
import os
import re
import subprocess
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.dirname(HERE))
from godot_project import ADDONS, prepare_project  # noqa: E402

PROJECT = os.path.join(HERE, "examples")
SCENES = os.path.join(ADDONS, "spidar_g", "examples")
GALLERY = "gallery/gallery"
GALLERY_PICTURES = os.path.join(SCENES, "gallery", "pictures")
TIME_LIMIT_S = 120  # a play takes seconds; a script error stops its coroutine for ever
NOISE = re.compile(r"^(?:SCRIPT |USER )?(?:ERROR|WARNING)\b.*(?:\n   .*)*|^Leaked instance.*", re.M)
# What Godot says of itself: of a display without a graphics card, and of a computer with few processors.
NOT_OURS = ("Could not set V-Sync mode", "Jolt Physics job system exceeded the maximum number of jobs")
TOTALS = re.compile(r"^(\d+) passed, (\d+) failed$", re.M)


def scenes(parts):
    """Names of the examples, of all or of those whose name holds one of `parts`."""
    paths = sorted(glob.glob(os.path.join(SCENES, "*", "*.tscn")))
    names = [os.path.relpath(path, SCENES)[:-len(".tscn")].replace(os.sep, "/") for path in paths]
    return [name for name in names if not parts or any(part in name for part in parts)]


def run(godot, name, picture, size):
    """How many checks of an example passed and failed. Prints what is wrong, and what was measured."""
    shown = ["--rendering-driver", "opengl3", "--audio-driver", "Dummy", "--resolution", size]
    check = "check_gallery.gd" if name == GALLERY else "check_example.gd"
    command = [godot, *(shown if picture else ["--headless"]), "--verbose", "--path", PROJECT, "--fixed-fps", "60", "-s",
               f"res://{check}", "--", f"res://addons/spidar_g/examples/{name}.tscn", *([size, picture] if picture else [])]
    try:
        done = subprocess.run(command, timeout=TIME_LIMIT_S, text=True, errors="replace", stdin=subprocess.DEVNULL,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)
        output, code = done.stdout, done.returncode
    except subprocess.TimeoutExpired as late:
        output, code = (late.stdout or b"").decode(errors="replace"), f"none: not finished after {TIME_LIMIT_S} s"
    noise = [match.group(0) for match in NOISE.finditer(output)]
    problems = [text for text in noise if not any(known in text for known in NOT_OURS)]
    totals = TOTALS.findall(output)
    passed, failed = map(int, totals[-1]) if totals else (0, 0)
    if not totals or (code != 0 and not failed):
        problems.append(f"Godot ended with code {code}; the end of its output:\n{output[-3000:]}")
    for line in re.findall(r"^(?:INFO|FAIL).*$", output, re.M) + [f"FAIL {problem}" for problem in problems]:
        print(f"{name.split('/')[0]}: {line}")
    print("FAIL" if failed or problems else "PASS", f"{name} ({passed} checks)", flush=True)
    return passed, failed + len(problems)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("godot")
    parser.add_argument("names", nargs="*", metavar="PART_OF_NAME")
    parser.add_argument("--pictures", metavar="FOLDER", default="")
    parser.add_argument("--size", metavar="WxH", default="1280x720")
    parser.add_argument("--gallery", action="store_true")
    arguments = parser.parse_args()
    folder, ending = (GALLERY_PICTURES, ".webp") if arguments.gallery else (arguments.pictures, ".png")
    prepare_project(PROJECT, arguments.godot)
    if folder:
        os.makedirs(folder, exist_ok=True)
    passed = failed = 0
    for name in scenes(arguments.names):
        if arguments.gallery and name == GALLERY:
            continue
        picture = folder and os.path.abspath(os.path.join(folder, name.split("/")[-1] + ending))
        good, bad = run(arguments.godot, name, picture, arguments.size)
        passed, failed = passed + good, failed + bad
    print(f"{passed} passed, {failed} failed")
    return 0 if passed and not failed else 1


if __name__ == "__main__":
    sys.exit(main())
