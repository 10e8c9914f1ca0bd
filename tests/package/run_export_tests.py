#!/usr/bin/env python3
"""Exported programs, debug and release, away from any checkout: run_export_tests.py GODOT TEMPLATES BOARD_MODEL

TEMPLATES holds godot-template-debug and godot-template-release, BOARD_MODEL is build/bin/spidar_board_model. The demo
plays a task; a game on serial boards is killed, and the guard beside it switches the motors off; and with the library
deleted the demo says what is missing. The last line is "N passed, N failed".
"""

import os
import shutil
import signal
import sys
import tempfile

import exported
from exported import ROOT, check, godot_project

sys.path.insert(0, os.path.join(ROOT, "tests", "serial"))
import run_serial_game  # noqa: E402

OUT = os.path.join(ROOT, "build", "export")
LIBRARY = "libspidar_g.linux.template_{}.x86_64.so"
GUARD = "spidar_g_guard.x86_64"
SENTENCE = "The SPIDAR-G add-on is not loaded: addons/spidar_g/bin holds no library for this system."
OFF_LIMIT_MS = 50
# A release program keeps its words for itself until it ends, unless it is told to say them at once.
MAIN_LOOP = """run/main_scene="res://empty.tscn"
run/main_loop_type="SerialGame"
run/flush_stdout_on_print=true"""


def demo(godot, templates, kind, folder):
    """The demo's program in `folder`, and nothing else of the project."""
    project = os.path.join(OUT, "demo")
    exported.copy_project("demo_project", project, templates=templates)
    godot_project.prepare_project(project, godot)
    program = os.path.join(folder, "demo")
    exported.export(godot, project, kind, program)
    shutil.rmtree(project)
    return program


def check_demo(godot, templates, kind, folder):
    program = demo(godot, templates, kind, folder)
    files = sorted(os.listdir(folder))
    check(files == sorted(["demo", "demo.pck", LIBRARY.format(kind), GUARD]), f"{kind}: the program's folder holds {files}")
    exported.check_play([program], folder, kind)
    os.remove(os.path.join(folder, LIBRARY.format(kind)))
    code, output = exported.run([program, *exported.PLAY, os.path.join(folder, "none")], folder)
    check(code == 2 and output.count(SENTENCE) == 1 and "SCRIPT ERROR" not in output,
          f"{kind}: without its library the demo says what is missing and ends (exit code {code})")


def check_guard(godot, templates, kind, folder, board_model):
    """The game on serial boards as a program: its class is the main loop, for a program runs no script by name."""
    project = os.path.join(OUT, "serial")
    exported.copy_project(os.path.join("tests", "serial", "game"), project, templates=templates)
    script = os.path.join(project, "serial_game.gd")
    with open(script, encoding="utf-8") as file:
        text = file.read()
    with open(script, "w", encoding="utf-8") as file:
        file.write(text.replace("extends SceneTree", "class_name SerialGame\nextends SceneTree"))
    with open(os.path.join(project, "empty.tscn"), "w", encoding="utf-8") as file:
        file.write('[gd_scene format=3]\n\n[node name="Empty" type="Node"]\n')
    settings = os.path.join(project, "project.godot")
    with open(settings, encoding="utf-8") as file:
        text = file.read()
    with open(settings, "w", encoding="utf-8") as file:
        file.write(text.replace('run/main_scene=""', MAIN_LOOP))
    godot_project.prepare_project(project, godot)
    program = os.path.join(folder, "serial")
    exported.export(godot, project, kind, program)
    shutil.rmtree(project)
    guard = os.path.join(folder, GUARD)
    print(f"{kind}: the guard's file is {'' if os.access(guard, os.X_OK) else 'not '}marked as a program")
    with tempfile.TemporaryDirectory() as ports:
        play = run_serial_game.Play([program, "--headless", "--"], board_model, ports)
        check(play.pulls, f"{kind}: the exported game pulls on serial boards")
        sent_ns = run_serial_game.time.monotonic_ns()
        play.game.process.send_signal(signal.SIGKILL)
        off_ms = play.off_after_ms(sent_ns)
        check(play.pulls and off_ms is not None and off_ms <= OFF_LIMIT_MS,
              f"{kind}: killed, its guard has the currents at zero after {off_ms} ms, limit {OFF_LIMIT_MS}")
        play.end()
        os.remove(guard)
        play = run_serial_game.Play([program, "--headless", "--"], board_model, ports, tries=1)
        check(not play.pulls and any("guard" in line and "missing" in line for line in play.game.lines),
              f"{kind}: without its guard it does not pull, and says so")
        play.end()


def main(godot, templates, board_model):
    shutil.rmtree(OUT, ignore_errors=True)
    for kind in ("debug", "release"):
        check_demo(godot, templates, kind, os.path.join(OUT, kind))
        check_guard(godot, templates, kind, os.path.join(OUT, kind + "_serial"), board_model)


if __name__ == "__main__":
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    main(*map(os.path.abspath, sys.argv[1:]))
    sys.exit(exported.end())
