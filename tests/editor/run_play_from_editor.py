#!/usr/bin/env python3
"""Games started from a real editor by its keys F5 and F6: run_play_from_editor.py GODOT

Needs a display and xdotool. The editor starts its own program again to run a game; a game that ran has written what it
is into a file, and has ended. The last line is "N passed, N failed".
"""

import json
import os
import queue
import re
import shutil
import subprocess
import sys
import threading
import time

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.dirname(HERE))
from godot_project import prepare_project  # noqa: E402

SOURCE = os.path.join(HERE, "play")
PROJECT = os.path.join(os.path.dirname(os.path.dirname(HERE)), "build", "editor", "play")
PLAYED = os.path.join(PROJECT, "..", "played.json")
WINDOW = "spidar_g played from the editor"
START_LIMIT_S = 150
GAME_LIMIT_S = 90  # on a loaded machine; some seconds otherwise
ERRORS = re.compile(r"SCRIPT ERROR|handle_crash|Failed loading|Could not create child process", re.I)
# The scene that is open in the editor is second.tscn; main.tscn is the project's.
KEYS = (("F5", "Main"), ("F6", "Second"))

passed = failed = 0


def check(good, what):
    global passed, failed
    passed, failed = passed + bool(good), failed + (not good)
    print("ok  " if good else "FAIL", what, flush=True)


class Editor:
    """An editor with second.tscn open; its plugin prints lines that start with EDITOR."""

    def __init__(self, godot):
        command = [godot, "--editor", "--rendering-driver", "opengl3", "--audio-driver", "Dummy", "--disable-vsync",
                   "--path", PROJECT, "--position", "0,0", "--resolution", "1280x800", "res://second.tscn"]
        self.process = subprocess.Popen(command, env=dict(os.environ, SPIDAR_G_PLAYED=os.path.realpath(PLAYED)),
                                        text=True, errors="replace", stdin=subprocess.DEVNULL,
                                        stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        self.output = []
        self.told = queue.Queue()
        threading.Thread(target=self._read, daemon=True).start()

    def _read(self):
        for line in self.process.stdout:
            self.output.append(line)
            if line.startswith("EDITOR "):
                self.told.put(line.split(maxsplit=2)[1:])

    def wait_for(self, word, limit_s):
        """The rest of the line EDITOR `word`; None when it does not come."""
        end = time.monotonic() + limit_s
        while (left := end - time.monotonic()) > 0:
            try:
                told = self.told.get(timeout=left)
            except queue.Empty:
                break
            if told[0] == word:
                return told[1].strip() if len(told) > 1 else ""
        return None

    def press(self, key):
        # No window manager gives the keyboard to the window.
        subprocess.run(["xdotool", "search", "--onlyvisible", "--name", WINDOW, "windowfocus", "sleep", "0.5",
                        "key", key], check=True, timeout=60)

    def close(self):
        self.process.terminate()
        try:
            self.process.wait(timeout=30)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()


def starts_again(program):
    """Whether the path that Godot gives for itself can be started, and is a Godot."""
    try:
        done = subprocess.run([program, "--headless", "--version"], timeout=60, text=True, capture_output=True)
    except (OSError, subprocess.TimeoutExpired):
        return False
    return done.returncode == 0 and re.match(r"\d+\.\d+", done.stdout.strip().splitlines()[-1]) is not None


def play(editor, key, scene):
    """One key, one game: it draws, writes and ends."""
    if os.path.exists(PLAYED):
        os.remove(PLAYED)
    editor.press(key)
    check(editor.wait_for("playing", GAME_LIMIT_S) is not None, f"{key} starts a game")
    check(editor.wait_for("stopped", GAME_LIMIT_S) is not None, f"{key}: the game ends by itself")
    if not os.path.exists(PLAYED):
        check(False, f"{key}: the game ran and wrote its file")
        return
    with open(PLAYED, encoding="utf-8") as file:
        played = json.load(file)
    check(played["scene"] == scene, f"{key} runs {scene}: {played['scene']}")
    check(played["display"] != "headless" and played["frames"] > 0, f"{key}: the game draws on {played['display']}")
    check(played["add_on"], f"{key}: the game has the add-on")


def main(godot):
    shutil.rmtree(PROJECT, ignore_errors=True)
    shutil.copytree(SOURCE, PROJECT, ignore=shutil.ignore_patterns("addons", ".godot"))
    prepare_project(PROJECT, godot)
    editor = Editor(godot)
    try:
        program = editor.wait_for("ready", START_LIMIT_S)
        check(program is not None, "the editor opens the project")
        if program is not None:
            check(starts_again(program), f"OS.get_executable_path() is a Godot that starts: {program}")
            for key, scene in KEYS:
                play(editor, key, scene)
    finally:
        editor.close()
    output = "".join(editor.output)
    errors = [line for line in output.splitlines() if ERRORS.search(line)]
    check(not errors, f"no error of a script or of a start: {errors[:3]}")
    if failed:
        print(output[-3000:])


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    main(os.path.abspath(sys.argv[1]))
    print(f"{passed} passed, {failed} failed")
    sys.exit(1 if failed or not passed else 0)
