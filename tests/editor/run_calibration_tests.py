#!/usr/bin/env python3
"""The calibration panel worked by a real mouse and keyboard: run_calibration_tests.py GODOT [--pictures DIR]

In a real editor, under an X server of its own (Xvfb) and with xdotool: adds a SpidarG node, chooses a preset, lets the
panel give the simulated device errors that are drawn anew each run, goes through every step, accepts, undoes, redoes,
saves, and opens the project again. Then what was found is compared with what was drawn. Where the controls are is
read from the file that the project's watch plugin leaves. The last line is "N passed, N failed".
"""

import argparse
import json
import math
import os
import shutil
import subprocess
import sys
import time

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))
sys.path.insert(0, os.path.dirname(HERE))
from godot_project import prepare_project  # noqa: E402

SOURCE = os.path.join(HERE, "calibration")
PROJECT = os.path.join(ROOT, "build", "editor", "calibration")
SCENE = '[gd_scene format=3]\n\n[node name="Stage" type="Node3D"]\n'
SCREEN = (1280, 1000)
PANEL = "290x890+990+44"  # of the screen
START_LIMIT_S = 150
STEP_LIMIT_S = 150  # a loaded machine draws few frames a second
# Of the research on self-calibration, for 300 poses with 0.1 mm of noise: rms of the offsets (m), of the scales.
OFFSET_LIMIT_M = 0.117e-3
SCALE_LIMIT = 5.7e-4
TEXT_PRECISION = 1e-14  # of Godot's text form of a double
GAIN_LIMIT = 0.02  # of a motor: friction and ramp
NOMINAL_M_PER_COUNT = 2.0 * math.pi * 0.008 / 2000.0
HOME_LENGTH_M = math.sqrt(0.24 ** 2 + 0.24 ** 2 + 0.2 ** 2)  # half sizes of the paper's frame, one less the pole


class GaveUp(Exception):
    """Something did not happen in time; the text says what."""


class Editor:
    """A display, an editor on it, a mouse and a keyboard."""

    def __init__(self, godot, display):
        self.watch = os.path.join(PROJECT, "..", "watch.json")
        if os.path.exists(self.watch):
            os.remove(self.watch)
        self.environment = dict(os.environ, DISPLAY=display, SPIDAR_G_WATCH=os.path.realpath(self.watch))
        self.log_path = os.path.join(PROJECT, "..", "editor.log")
        with open(self.log_path, "w", encoding="utf-8") as log:
            self.process = subprocess.Popen(
                [godot, "--editor", "--single-window", "--audio-driver", "Dummy", "--rendering-driver", "opengl3",
                 "--disable-vsync", "--resolution", "%dx%d" % SCREEN, "--position", "0,0", "--path", PROJECT,
                 "res://stage.tscn"],
                env=self.environment, stdout=log, stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL)

    def close(self):
        """Ends the editor; what it printed."""
        self.process.terminate()
        try:
            self.process.wait(timeout=30)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()
        with open(self.log_path, encoding="utf-8", errors="replace") as log:
            return log.read()

    def xdotool(self, *words):
        subprocess.run(["xdotool", *map(str, words)], env=self.environment, check=True, stdout=subprocess.DEVNULL)

    def focus(self):
        """No window manager gives the keyboard to the window."""
        found = subprocess.run(["xdotool", "search", "--onlyvisible", "--name", "Godot"], env=self.environment,
                               stdout=subprocess.PIPE, text=True, check=False).stdout.split()
        for window in found:
            subprocess.run(["xdotool", "windowfocus", window], env=self.environment, check=False,
                           stderr=subprocess.DEVNULL)

    def see(self):
        with open(self.watch, encoding="utf-8") as file:
            return json.load(file)

    def wait(self, what, condition, limit_s=STEP_LIMIT_S):
        """The report for which condition holds."""
        end = time.monotonic() + limit_s
        while time.monotonic() < end:
            if self.process.poll() is not None:
                raise GaveUp(f"the editor has ended while waiting: {what}")
            try:
                report = self.see()
                if condition(report):
                    return report
            except (OSError, ValueError, KeyError):
                pass
            time.sleep(0.1)
        raise GaveUp(f"not within {limit_s} s: {what}")

    def frames(self, number=2):
        """Until the editor has drawn on."""
        now = self.wait("a report", lambda report: True)["count"]
        self.wait("further reports", lambda report: report["count"] >= now + number)

    def click_at(self, x, y):
        self.xdotool("mousemove", round(x), round(y))
        time.sleep(0.2)
        self.xdotool("click", 1)

    def click(self, name):
        """A control of the panel, or DIALOG/TEXT, once it can be pressed."""
        def ready(report):
            return name in report["controls"] and not report["controls"][name]["disabled"]

        self.wait(f"{name} to be pressed", ready)
        self.frames()  # the layout has come to rest
        at = self.wait(f"{name} to be pressed", ready)["controls"][name]
        self.click_at(at["x"], at["y"])
        self.frames()

    def key(self, *keys):
        for key in keys:
            self.xdotool("key", key)
            time.sleep(0.15)
        self.frames()

    def text(self, name):
        return self.see()["controls"][name]["text"]

    def picture(self, folder, name, part=("-crop", PANEL, "+repage")):
        if folder:
            self.frames(3)
            subprocess.run(["import", "-window", "root", *part, os.path.join(folder, name + ".png")],
                           env=self.environment, check=True)

    def whole_picture(self, folder, name):
        self.picture(folder, name, part=())


def device(report):
    return next(iter(report["nodes"].values()))


def calibrate(editor, pictures):
    """Every step, as a user who never saw the panel would do it."""
    editor.wait("the scene", lambda report: report["scene"].endswith("stage.tscn") and report["count"] > 5, START_LIMIT_S)
    editor.focus()
    editor.click("spidar_g calibration/Script")  # the 3-D view is slow without a graphics card
    editor.xdotool("mousemove", 140, 300)
    editor.click_at(90, 136)  # the root, in the scene's tree
    editor.wait("the root selected", lambda report: report["selected"] == "Node3D")
    editor.key("ctrl+a")
    editor.wait("the dialog for a new node", lambda report: any("Create New Node" in name for name in report["controls"]))
    editor.xdotool("type", "--delay", 80, "SpidarG")
    editor.frames(3)
    editor.key("Return")
    editor.wait("the node", lambda report: report["selected"] == "SpidarG")
    editor.click("Fold")
    editor.click("Preset")
    editor.click("menu/Paper")
    editor.wait("the paper's preset", lambda report: device(report)["preset"] == 1)
    editor.click("Practice")
    editor.wait("errors", lambda report: len(device(report)["offset_errors"]) == 8)
    editor.click("Open")
    editor.click("CheckWiring")
    editor.wait("wiring checked", lambda report: "(done)" in report["controls"]["Title"]["text"])
    editor.picture(pictures, "calibration_wiring")
    editor.click("Next")
    for reading in range(1, 4):
        editor.click("ReadZero")
        editor.wait("home read", lambda report: "Zero" in report["controls"]["Title"]["text"]
                    and "(done)" in report["controls"]["Title"]["text"])
    editor.click("Next")
    for _ in range(2):
        editor.click("MoveHand")
        time.sleep(3.0)  # the simulated hand; a length read too early is a reading like any other
        for _ in range(2):
            editor.click("LookAtRuler")
            editor.click("ReadLength")
    editor.click("Next")
    editor.click("Motion")
    editor.wait("half of the motion", lambda report: report["controls"]["Progress"]["value"] > 0.5)
    editor.picture(pictures, "calibration_motion")
    editor.wait("calibrated", lambda report: report["controls"]["Message"]["text"].startswith("The calibration is complete"))
    editor.click("Next")
    editor.click("WeighAll")
    editor.wait("all weighed", lambda report: "(done)" in report["controls"]["Title"]["text"])
    editor.click("Next")
    editor.click("Accept")
    editor.wait("accepted", lambda report: device(report)["calibrated"])
    editor.picture(pictures, "calibration_result")


def errors_of(found):
    """Rms of the lengths read at home (m), rms of the scales (relative), worst motor gain (relative)."""
    square_m = square = worst = 0.0
    for i in range(8):
        gain = 1.0 + found["gain_errors"][i]
        count = round((HOME_LENGTH_M * gain + found["offset_errors"][i]) / NOMINAL_M_PER_COUNT)
        read_m = found["offsets"][i] + found["scales"][i] * (count - found["zero_counts"][i])
        square_m += (read_m - HOME_LENGTH_M) ** 2 / 8.0
        square += (found["scales"][i] * gain / NOMINAL_M_PER_COUNT - 1.0) ** 2 / 8.0
        worst = max(worst, abs(found["found_gains"][i] / found["tension_gains"][i] - 1.0))
    return math.sqrt(square_m), math.sqrt(square), worst


def start_xvfb():
    """A display of its own: (process, name)."""
    read_end, write_end = os.pipe()
    process = subprocess.Popen(["Xvfb", "-displayfd", str(write_end), "-screen", "0", "%dx%dx24" % SCREEN, "-nolisten",
                                "tcp"], pass_fds=[write_end], stderr=subprocess.DEVNULL)
    os.close(write_end)
    with os.fdopen(read_end) as pipe:
        number = pipe.readline().strip()
    if not number:
        raise GaveUp("Xvfb did not start")
    return process, ":" + number


class Checks:
    passed = 0
    failed = 0

    def __call__(self, good, what):
        print("PASS" if good else "FAIL", what)
        self.passed += bool(good)
        self.failed += not good


def run(godot, display, pictures, check):
    editor = Editor(godot, display)
    try:
        calibrate(editor, pictures)
        accepted = device(editor.see())
        offset_m, scale, gain = errors_of(accepted)
        check(offset_m <= OFFSET_LIMIT_M, f"offsets: {1e3 * offset_m:.4f} mm rms, limit {1e3 * OFFSET_LIMIT_M:.3f}")
        check(scale <= SCALE_LIMIT, f"scales: {scale:.1e} rms, limit {SCALE_LIMIT:.1e}")
        check(gain <= GAIN_LIMIT, f"motor gains: worst {100 * gain:.2f} %, limit {100 * GAIN_LIMIT:.0f} %")
        editor.key("ctrl+z")
        undone = editor.wait("undone", lambda report: not device(report)["calibrated"])
        check(undone["nodes"], "undo takes the calibration away, and nothing else")
        editor.key("ctrl+shift+z")
        redone = device(editor.wait("redone", lambda report: device(report)["calibrated"]))
        check(redone["scales"] == accepted["scales"], "redo brings it back")
        editor.click("Save")
        editor.wait("the dialog", lambda report: any(name.endswith("/Save") for name in report["controls"]))
        editor.key("Return")
        editor.wait("saved as a file", lambda report: device(report).get("path", "").endswith(".tres"))
        editor.click("Open")  # closes the device
        editor.wait("closed", lambda report: report["controls"]["Open"]["text"] == "Open device")
        editor.key("ctrl+s")
        scene = os.path.join(PROJECT, "stage.tscn")
        end = time.monotonic() + STEP_LIMIT_S
        while "spidar_g_calibration.tres" not in open(scene, encoding="utf-8").read():
            if time.monotonic() > end:
                raise GaveUp("the scene was not saved with the calibration")
            time.sleep(0.2)
        check(True, "saved as .tres and used by the scene")
    finally:
        log = editor.close()
    check_log(log, check)
    again = Editor(godot, display)
    try:
        loaded = again.wait("the project opened again", lambda report: report["nodes"], START_LIMIT_S)
        same = all(math.isclose(read, kept, rel_tol=TEXT_PRECISION) for name in ("scales", "offsets", "found_gains")
                   for read, kept in zip(device(loaded)[name], accepted[name], strict=True))
        check(same, "the same calibration after the project was opened again")
    finally:
        again.close()


def check_log(log, check):
    errors = [line for line in log.splitlines() if "SCRIPT ERROR" in line or ("ERROR" in line and "spidar" in line.lower())]
    check(not errors, f"no error of ours in the editor: {errors[:3]}")


def copy_project(scene=SCENE):
    """An editor writes into its project: it gets a fresh copy."""
    shutil.rmtree(PROJECT, ignore_errors=True)
    shutil.copytree(SOURCE, PROJECT, ignore=shutil.ignore_patterns("addons", ".godot"))
    with open(os.path.join(PROJECT, "stage.tscn"), "w", encoding="utf-8") as file:
        file.write(scene)


def on_a_screen(what, work):
    """Calls work(display, check) with a screen of its own, and prints what came of it. The exit code."""
    check = Checks()
    began = time.monotonic()
    xvfb, display = start_xvfb()
    try:
        work(display, check)
    except GaveUp as reason:
        check(False, str(reason))
    finally:
        xvfb.terminate()
        xvfb.wait()
    print(f"{what}: {time.monotonic() - began:.0f} s")
    print(f"{check.passed} passed, {check.failed} failed")
    return 1 if check.failed or not check.passed else 0


def main():
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("godot")
    options.add_argument("--pictures", help="a folder for pictures of the panel (needs ImageMagick's import)")
    chosen = options.parse_args()
    copy_project()
    prepare_project(PROJECT, chosen.godot)
    return on_a_screen(
        "calibration in the editor", lambda display, check: run(chosen.godot, display, chosen.pictures, check)
    )


if __name__ == "__main__":
    sys.exit(main())
