#!/usr/bin/env python3
"""A newcomer with a real mouse goes through the gallery of examples: run_mouse_walk.py GODOT [PART_OF_NAME ...]

Under an X server (Xvfb) and with xdotool, each example is opened by a click, its purpose is reached by mouse and keys alone,
and Esc leads back. What happened is judged by what the hand feels and by what the running game reports. Prints a row of
docs/why/mouse_walk.md for each example: seconds and actions. The last line is "N passed, N failed".
"""

import argparse
import os
import subprocess
import sys
import tempfile
import time

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path[:0] = [os.path.dirname(HERE), os.path.join(HERE, "mouse_walk")]
from godot_project import prepare_project  # noqa: E402
from walker import GaveUp, Walker  # noqa: E402
from walks import WALKS  # noqa: E402

PROJECT = os.path.join(HERE, "examples")


class Checks:
    passed = 0
    failed = 0

    def __call__(self, good, what):
        print("     ok:" if good else "FAIL", what, flush=True)
        self.passed += bool(good)
        self.failed += not good


def walk_through(walker, walk, check, pictures):
    """One example; its row of the table, or None where it was not finished."""
    name = walk.__name__
    in_gallery = name == "gallery"
    try:
        if not in_gallery:
            walker.open_example(name)
        walker.picture(pictures, name + "_begin")
        began = time.monotonic()
        walk(walker, check)
        seconds = time.monotonic() - began
        actions = ", ".join(f"{count} {kind}" for kind, count in walker.actions.items() if count)
        walker.picture(pictures, name + "_end")
        if not in_gallery:
            walker.leave_example()
        return f"| {name} | {walk.__doc__} | {seconds:.1f} | {actions} |"
    except (GaveUp, subprocess.SubprocessError, KeyError, StopIteration) as problem:
        check(False, f"{name}: {type(problem).__name__} {problem}; the devices: {(walker.state or {}).get('devices')}")
        return None


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("godot")
    parser.add_argument("names", nargs="*", metavar="PART_OF_NAME")
    parser.add_argument("--display", default=os.environ.get("DISPLAY", ""))
    parser.add_argument("--pictures", metavar="FOLDER", help="NAME_begin.png and NAME_end.png (needs ImageMagick's import)")
    parser.add_argument("--size", metavar="WxH", default="640x360", help="a small window costs a computer without a GPU little")
    arguments = parser.parse_args()
    if not arguments.display:
        parser.error("no display: run under xvfb-run, or give --display")
    prepare_project(PROJECT, arguments.godot)
    if arguments.pictures:
        os.makedirs(arguments.pictures, exist_ok=True)
    check = Checks()
    rows = []
    walks = [walk for walk in WALKS if not arguments.names or any(part in walk.__name__ for part in arguments.names)]
    with tempfile.TemporaryDirectory(prefix="spidar_walk_") as folder:
        walker = None
        for number, walk in enumerate(walks):
            walker = walker or start(arguments, os.path.join(folder, f"{number}.txt"), check)
            print(walk.__name__, flush=True)
            rows.append(walk_through(walker, walk, check, arguments.pictures) if walker else None)
            if walker and rows[-1] is None:  # the next example begins in a game of its own
                close(walker, check)
                walker = None
        if walker:
            close(walker, check)
    print("\n".join(row for row in rows if row))
    print(f"{check.passed} passed, {check.failed} failed")
    return 1 if check.failed or not check.passed else 0


def start(arguments, log_path, check):
    """A game that shows the gallery, or None."""
    walker = Walker(arguments.godot, PROJECT, arguments.display, arguments.size, log_path)
    try:
        walker.enter()
        return walker
    except (GaveUp, subprocess.SubprocessError) as problem:
        check(False, f"the gallery: {problem}")
        close(walker, check)
        return None


def close(walker, check):
    log = walker.close()
    errors = [line for line in log.splitlines() if line.startswith(("ERROR", "SCRIPT ERROR", "USER ERROR"))]
    check(not errors, f"no error in the game's output: {errors[:3]}")


if __name__ == "__main__":
    sys.exit(main())
