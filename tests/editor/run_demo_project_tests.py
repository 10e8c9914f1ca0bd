#!/usr/bin/env python3
"""The demo's project in a real editor, as after a double click: run_demo_project_tests.py GODOT

It starts an X server of its own (Xvfb). The project is copied with its committed link to the add-on, as a fresh clone has
it, and a plugin that drives the editor and closes it is added. In the editor's very first start, without any preparation,
each scene is opened: its things must be drawn in the 3-D view, and what the editor alone shows must not be saved into the
scene. Then come a second start, and a first start after what `./dev build` prepares. No start may print an error. The pictures stay in build/editor/demo/pictures. The last line is "N passed, N failed".
"""

import argparse
import os
import re
import shutil
import subprocess
import sys
from unittest import mock

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))
sys.path.insert(0, os.path.dirname(HERE))
from godot_project import ProjectError, import_assets, link_addons, list_extensions  # noqa: E402

PLACE = os.path.join(ROOT, "build", "editor", "demo")
PROJECT = os.path.join(PLACE, "demo_project")
TRIES = 3  # of a start that ends in a crash of Godot's own
TIME_LIMIT_S = 600
DISPLAYED = ["--rendering-driver", "opengl3", "--audio-driver", "Dummy"]
FOR_PICTURES = ["--resolution", "1920x1080"]
FOR_STARTS = ["--resolution", "960x540"]
SCENES = ("hub/hub", "tasks/pick_and_place/pick_and_place", "tasks/robot_linking/robot_linking",
          "tasks/match_linking/match_linking", "tasks/free_play/free_play")
# What an editor says of a machine without Vulkan, before it uses OpenGL.
NOT_OURS = re.compile(r"VK_KHR|_vulkan\.cpp|V-Sync|XDG_")
ERRORS = re.compile(r"^(?:[A-Z]+ )?ERROR:.*(?:\n +.*)*", re.M)
COUNTS = re.compile(r"^(\d+) passed, (\d+) failed$", re.M)

passed = failed = 0


def check(good, what):
    global passed, failed
    passed, failed = passed + bool(good), failed + (not good)
    print("ok  " if good else "FAIL", what)


def start_display():
    """An X server as large as a usual screen: (process, its display)."""
    reading, writing = os.pipe()
    server = subprocess.Popen(["Xvfb", "-displayfd", str(writing), "-screen", "0", "1920x1080x24", "-nolisten", "tcp"],
                              pass_fds=(writing,), stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    os.close(writing)
    with os.fdopen(reading) as number:
        return server, ":" + number.readline().strip()


def works_without_links():
    """A git that makes no links checks the committed one out as text: it becomes a copy, and git sees no change."""
    clone = os.path.join(PLACE, "no_links")
    subprocess.run(["git", "clone", "-q", "-c", "core.symlinks=false", ROOT, clone], check=True)
    link = os.path.join(clone, "demo_project", "addons")
    check(os.path.isfile(link) and not os.path.islink(link), "without links, the committed link is a text file")
    with mock.patch("os.symlink", side_effect=OSError("no links here")):
        link_addons(os.path.dirname(link))
        link_addons(os.path.dirname(link))
    check(os.path.isfile(os.path.join(link, "spidar_g", "plugin.cfg")), "it becomes a copy of the add-on")
    status = subprocess.run(["git", "-C", clone, "status", "--porcelain"], check=True, capture_output=True, text=True).stdout
    check(status == "", f"git sees no change: {status!r}")


def copy_project():
    """As a fresh clone with a built add-on has it: no caches, the link as it is committed."""
    shutil.rmtree(PLACE, ignore_errors=True)
    os.makedirs(os.path.join(PLACE, "pictures"))
    shutil.copytree(os.path.join(ROOT, "addons"), os.path.join(PLACE, "addons"))
    shutil.copytree(os.path.join(ROOT, "demo_project"), PROJECT, symlinks=True, ignore=shutil.ignore_patterns(".godot"))


def edit(godot, *arguments):
    """The editor on the copy: what it printed, and its exit code."""
    # A user who has never started Godot has no settings of it.
    settings = dict(os.environ, **{f"XDG_{kind}_HOME": os.path.join(PLACE, "user") for kind in ("CONFIG", "DATA", "CACHE")})
    command = [godot, *DISPLAYED, "--editor", "--path", PROJECT, *arguments]
    try:
        done = subprocess.run(command, timeout=TIME_LIMIT_S, text=True, errors="replace", stdin=subprocess.DEVNULL,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, env=settings, check=False)
        return done.stdout, done.returncode
    except subprocess.TimeoutExpired as error:
        return (error.stdout or b"").decode(errors="replace"), f"none within {TIME_LIMIT_S} s"


def errors_of(output):
    return [text for text in ERRORS.findall(output) if not NOT_OURS.search(text)]


def add_driver():
    """A plugin that runs a script in the editor and closes it; only the copy has it."""
    driver = os.path.join(PROJECT, "driver")
    os.makedirs(driver)
    for folder, names in (("view/driver", ("driver.gd", "editor_case.gd", "plugin.cfg")),
                          ("demo", ("only_start.gd", "show_scenes.gd"))):
        for name in names:
            shutil.copy(os.path.join(HERE, folder, name), driver)
    with open(os.path.join(PROJECT, "project.godot"), "a", encoding="utf-8") as file:
        file.write('\n[editor_plugins]\n\nenabled=PackedStringArray("res://driver/plugin.cfg")\n')


def crashed_by_itself(output, code):
    """Godot 4.6 now and then crashes in a worker thread of its own when it is closed soon after its start: the
    backtrace then has no frame of the add-on."""
    return code in (-6, -11, 134, 139) and "handle_crash" in output and "libspidar_g" not in output.split("handle_crash")[1]


def starts(godot, which, *arguments):
    """Runs a script of the driver; counts its checks, its errors and its exit code."""
    global passed, failed
    for _ in range(TRIES):
        output, code = edit(godot, *arguments)
        if not crashed_by_itself(output, code):
            break
        print(f"{which}: Godot crashed in a thread of its own; started again")
    with open(os.path.join(PLACE, "pictures", re.sub(r"\W+", "_", which) + ".log"), "w", encoding="utf-8") as log:
        log.write(output)
    for line in re.findall(r"^(?:FAIL.*|\w+: .* things)$", output, re.M):
        print(line)
    counts = COUNTS.findall(output)
    good, bad = (int(number) for number in counts[-1]) if counts else (0, 1)
    passed, failed = passed + good, failed + bad
    errors = errors_of(output)
    check(code == 0 and not errors, f"{which}: exit code {code}, {len(errors)} errors")
    if errors or code != 0 or not counts:
        print("\n".join(errors) or output[-3000:])


def run(godot):
    copy_project()
    works_without_links()
    check(os.path.samefile(os.path.join(PROJECT, "addons"), os.path.join(PLACE, "addons")), "the committed link leads to the add-on")
    add_driver()
    pictures = os.path.join(PLACE, "pictures")
    scenes = [f"res://{scene}.tscn" for scene in SCENES]
    starts(godot, "first start, not prepared: scenes", *FOR_PICTURES, "--", "show_scenes", pictures, *scenes)
    print(f"pictures: {pictures}")
    starts(godot, "second start", *FOR_STARTS, "--", "only_start")
    shutil.rmtree(os.path.join(PROJECT, ".godot"))
    try:
        list_extensions(PROJECT)
        import_assets(godot, PROJECT)
    except ProjectError as problem:
        check(False, str(problem))
    starts(godot, "first start after ./dev build", *FOR_STARTS, "--", "only_start")


def main():
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("godot")
    chosen = options.parse_args()
    server, os.environ["DISPLAY"] = start_display()
    try:
        run(chosen.godot)
    finally:
        server.terminate()
        server.wait()
    print(f"{passed} passed, {failed} failed")
    return 1 if failed or not passed else 0


if __name__ == "__main__":
    sys.exit(main())
