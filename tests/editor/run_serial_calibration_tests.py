#!/usr/bin/env python3
"""The calibration panel on serial motor boards, worked by a real mouse: run_serial_calibration_tests.py GODOT MODEL [--pictures DIR]

In a real editor, under an X server of its own. MODEL is build/bin/spidar_board_model: boards on a pseudo-terminal, with
errors that only they know, the factory's quadrature mask, and a hand that this program moves. The mask is read, written
to flash after the question, and read again; then every step of the calibration is done, and what was found is compared
with the model's truth. The last line is "N passed, N failed".
"""

import argparse
import math
import os
import sys
import tempfile
import time

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, HERE)
sys.path.insert(0, os.path.dirname(HERE))
import run_calibration_tests as panel  # noqa: E402
from board_model.board_model import BoardModel  # noqa: E402
from godot_project import prepare_project  # noqa: E402

SCENE = """[gd_scene load_steps=2 format=3]

[sub_resource type="SpidarGConfig" id="Boards"]
transport = 3
serial_port = "{link}"

[node name="Device" type="SpidarG"]
config = SubResource("Boards")
"""
ERRORS_SEED = 11
LENGTH_LIMIT_M = 0.2e-3  # of all strings at eight places, rms
GAIN_LIMIT = 0.02
WEIGHT_N = 2.0  # what the panel proposes
TRIES = 4  # a busy computer holds the boards' answers up, and the task ends


def message(report):
    return report["controls"].get("Message", {"text": ""})["text"]


def done(report):
    return "(done)" in report["controls"]["Title"]["text"]


def go(boards, order):
    """The hand goes there, and is still."""
    boards.tell(order)
    time.sleep(0.7)
    end = time.monotonic() + 5.0
    while time.monotonic() < end and not boards.tell()["still"]:
        time.sleep(0.05)
    time.sleep(0.3)
    return boards.tell()


def set_mask(editor, boards, pictures, check):
    editor.click("ReadBoards")
    editor.wait("the boards", lambda report: "mask 0x00" in report["controls"].get("Boards", {"text": ""})["text"])
    editor.click("WriteBoard")
    editor.wait("the question", lambda report: "Write to flash/Write" in report["controls"])
    check(boards.tell()["flash_writes"] == 0, "nothing is written before the question is answered")
    if pictures:
        editor.whole_picture(pictures, "serial_parameters_question")
    editor.click("Write to flash/Write")
    editor.wait("the answer", lambda report: "was read back and is equal" in message(report))
    now = boards.tell()
    check(now["flash_writes"] == 1 and now["masks"] == [255], f"written once: mask {now['masks']}")
    editor.click("ReadBoards")
    editor.wait("read again", lambda report: "mask 0xff" in report["controls"].get("Boards", {"text": ""})["text"])


def until_done(editor, button, what, before=lambda: None):
    """Pressed again when a busy computer ended the task."""
    for attempt in range(TRIES):
        before()
        editor.click(button)
        ended = editor.wait(what, lambda report: done(report) or message(report))
        if done(ended):
            return
        print(f"again: {message(ended)}")
        time.sleep(1.0)
    raise panel.GaveUp(f"{what}: not in {TRIES} tries")


def calibrate(editor, boards, pictures, check):
    editor.wait("the scene", lambda report: report["scene"].endswith("stage.tscn") and report["count"] > 5,
                panel.START_LIMIT_S)
    editor.focus()
    editor.click("spidar_g calibration/Script")
    editor.click_at(90, 136)  # the root, in the scene's tree
    editor.wait("the device selected", lambda report: report["selected"] == "SpidarG")
    editor.click("Fold")
    set_mask(editor, boards, pictures, check)
    go(boards, "script home")
    editor.click("Open")
    until_done(editor, "CheckWiring", "wiring checked")
    editor.click("Next")
    for _ in range(3):
        editor.click("ReadZero")
        editor.wait("home read", done)
    editor.click("Next")  # lengths by ruler: may be left out
    editor.click("Next")
    editor.click("Taut")
    editor.click("Motion")
    boards.tell("script free")
    editor.wait("half of the motion", lambda report: report["controls"]["Progress"]["value"] > 0.5)
    editor.picture(pictures, "serial_calibration_motion")
    editor.wait("calibrated", lambda report: message(report).startswith("The calibration is complete"))
    go(boards, "script home")
    editor.click("Taut")
    editor.click("Next")
    boards.tell(f"hang 0 {WEIGHT_N}")
    time.sleep(0.5)
    for attempt in range(TRIES):
        editor.click("Weigh")
        told = editor.wait("weighed", lambda report: "1  gain" in report["controls"].get("Weights", {"text": ""})["text"]
                           or message(report))
        if "1  gain" in told["controls"]["Weights"]["text"]:
            break
        print(f"again: {message(told)}")
    boards.tell("hang -1 0")
    editor.click("Next")
    editor.click("Accept")
    editor.wait("accepted", lambda report: panel.device(report)["calibrated"])
    editor.picture(pictures, "serial_calibration_result")


def compare(boards, found, check):
    square_m = 0.0
    for place in range(8):
        true = go(boards, f"script place {place}")
        for i in range(8):
            read_m = found["offsets"][i] + found["scales"][i] * (true["counts"][i] - found["zero_counts"][i])
            square_m += (read_m - true["lengths_m"][i]) ** 2 / 64.0
    rms_m = math.sqrt(square_m)
    check(rms_m <= LENGTH_LIMIT_M, f"lengths at 8 places: {1e3 * rms_m:.4f} mm rms, limit {1e3 * LENGTH_LIMIT_M:.1f}")
    gain, truth = found["found_gains"][0], boards.tell()["tension_gains"][0]
    check(abs(gain / truth - 1.0) <= GAIN_LIMIT, f"motor gain of string 1: {gain:.3f}, truth {truth:.3f}")
    check(boards.tell()["flash_writes"] == 1, "the calibration itself wrote nothing to flash")


def run(godot, display, program, link, pictures, check):
    with BoardModel(program, link, "--errors", str(ERRORS_SEED), "--mask", "0") as boards:
        editor = panel.Editor(godot, display)
        try:
            calibrate(editor, boards, pictures, check)
            found = panel.device(editor.see())
            editor.click("Open")  # closes the device
            editor.wait("closed", lambda report: report["controls"]["Open"]["text"] == "Open device")
            compare(boards, found, check)
            check(boards.tell()["strongest"] == 0, "no motor pulls any more")
        finally:
            log = editor.close()
        panel.check_log(log, check)


def main():
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("godot")
    options.add_argument("model")
    options.add_argument("--pictures", help="a folder for pictures of the panel (needs ImageMagick's import)")
    chosen = options.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        link = os.path.join(folder, "port")
        panel.copy_project(SCENE.format(link=link))
        prepare_project(panel.PROJECT, chosen.godot)
        return panel.on_a_screen(
            "calibration of serial boards in the editor",
            lambda display, check: run(chosen.godot, display, chosen.model, link, chosen.pictures, check),
        )


if __name__ == "__main__":
    sys.exit(main())
