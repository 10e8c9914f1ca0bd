#!/usr/bin/env python3
"""A Godot game on serial motor boards that stand on a pseudo-terminal: run_serial_game.py GODOT PROGRAM

PROGRAM is build/bin/spidar_board_model. The game finds the boards, zeroes them, arms and pulls; then it is killed,
stopped, or ends by itself. Prints each check, then "N passed, N failed".
"""

import os
import signal
import subprocess
import sys
import tempfile
import time

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.dirname(HERE))
import godot_project  # noqa: E402
from board_model.board_model import BoardModel, Speaker  # noqa: E402

PROJECT = os.path.join(HERE, "game")
DEMO = os.path.join(os.path.dirname(os.path.dirname(HERE)), "demo_project")
PULL_LIMIT_S = 20  # from the start of Godot
TRIES = 5  # a busy machine may hold the loop up until it stops itself
OFF_LIMIT_MS = 50
CALIBRATION_LIMIT_S = 150
PARAMETERS_LIMIT_S = 40
PLAY_LIMIT_S = 120
PLAY_TRIES = 3
PLAY_THINGS = 1
# A node looks for its boards each half second, and a look at a port that nobody answers at takes as long again.
SOFTER_S = 1.0  # the caps move within 0.3 s
FIND_LIMIT_S = 2.0
SEARCH_S = 2.5  # several looks
# Of the game's time. A look in the game's own thread would take 40 %.
SHARE_LIMIT = 10

passed = 0
failed = 0


def check(good, what):
    global passed, failed
    passed += bool(good)
    failed += not good
    print(f"{'ok  ' if good else 'FAIL'} {what}", flush=True)


def last_number(lines, word):
    found = [int(line.split()[1]) for line in lines if line.startswith(word + " ")]
    return found[-1] if found else None


class Play:
    """Boards, and a game on them that pulls: a command that takes the port as its last argument."""

    def __init__(self, game, program, folder, tries=TRIES):
        for number in range(1, tries + 1):
            self.link = os.path.join(folder, "port")
            self.boards = BoardModel(program, self.link)
            self.game = Speaker([*game, self.link])
            self.pulls = self.game.says("active", PULL_LIMIT_S)
            if self.pulls:
                return
            print("\n".join(self.game.lines[-6:]))
            if number < tries:
                self.end()

    def off_after_ms(self, sent_ns):
        """From this moment until no board has a current; None: some still has."""
        end = time.monotonic() + 2
        while time.monotonic() < end:
            off, on = last_number(self.boards.lines, "off"), last_number(self.boards.lines, "on")
            if off is not None and on is not None and off > on:
                return (off - sent_ns) / 1e6
            time.sleep(0.01)
        return None

    def end(self):
        self.game.end()
        time.sleep(0.1)
        self.boards.end()


def killed(game, program, folder, number, limit_ms):
    name = signal.Signals(number).name
    play = Play(game, program, folder)
    check(play.pulls, f"{name}: the game pulls")
    if not play.pulls:
        play.end()
        return
    device = [line for line in play.game.lines if line.startswith("device")]
    check(device and device[0] == f'device B5M with id 1 at {play.link}, rate 2951, remarks ""', f"{name}: {device}")
    sent_ns = time.monotonic_ns()
    play.game.process.send_signal(number)
    off_ms = play.off_after_ms(sent_ns)
    check(off_ms is not None and -5 < off_ms <= limit_ms, f"{name}: currents zero after {off_ms} ms, limit {limit_ms}")
    play.end()


def found_later(godot, program, folder, before, after, name):
    """A game that starts without its boards. before, after: orders that take them away and bring them."""
    link = os.path.join(folder, "port")
    with BoardModel(program, link) as boards:
        boards.tell(before)
        game = Speaker([godot, "--headless", "--path", PROJECT, "--script", "res://serial_game.gd", "--", link])
        check(game.says("refused", PULL_LIMIT_S), f"{name}: the game is told that there is no device")
        time.sleep(SEARCH_S)
        refused = [line for line in game.lines if line.startswith("refused")]
        check(len(refused) == 1, f"{name}: told once, though looked for again and again: {refused}")
        boards.tell(after)
        began = time.monotonic()
        found = game.says("device", PULL_LIMIT_S)
        took_s = time.monotonic() - began
        check(found and took_s <= FIND_LIMIT_S, f"{name}: found by itself after {took_s:.2f} s, limit {FIND_LIMIT_S}")
        share = last_number(game.lines, "share")
        check(share is not None and share <= SHARE_LIMIT,
              f"{name}: the node took {share} % of the game's time while it looked, limit {SHARE_LIMIT} %")
        pulls = game.says("active", PULL_LIMIT_S)
        check(pulls, f"{name}: zeroed, armed, and pulls")
        if not pulls:
            print("\n".join(game.lines))
        game.end()


def slow_link(godot, program, folder):
    """Behind a bridge that keeps its bytes for 5 ms every wall is softer."""
    stiffness = []
    for delay_ms in (0, 5):
        link = os.path.join(folder, "port")
        with BoardModel(program, link) as boards:
            boards.tell(f"slow {delay_ms}")
            game = Speaker([godot, "--headless", "--path", PROJECT, "--script", "res://serial_game.gd", "--", link])
            game.says("device", PULL_LIMIT_S)
            time.sleep(SOFTER_S)
            game.end()
        stiffness.append(last_number(game.lines, "stiffness"))
        latency_us = last_number(game.lines, "latency_us")
        check(latency_us is not None and latency_us > 1000 * (delay_ms + 1),
              f"link of {delay_ms} ms: latency {latency_us} us")
    check(None not in stiffness and stiffness[1] < 0.5 * stiffness[0],
          f"the stiffest wall falls from {stiffness[0]} to {stiffness[1]} N/m")


def worked(godot, program, folder, script, options, last, limit_s):
    """A script that works the calibrator and does the comparing; last: the word at its end."""
    link = os.path.join(folder, "port")
    with BoardModel(program, link, *options) as boards:
        game = Speaker([godot, "--headless", "--path", PROJECT, "--script", f"res://{script}.gd", "--", link,
                        str(boards.port)])
        check(game.says(last, limit_s), f"{script}: goes to its end")
        game.end()
    for line in game.lines:
        if line.startswith(("ok", "FAIL")):
            check(line.startswith("ok"), line[5:])
        elif "SCRIPT ERROR" in line:
            check(False, line)


def played(godot, program, folder):
    """The demo's pick and place on the boards: the scripted hand moves the grip of the model."""
    told = ""
    for _ in range(PLAY_TRIES):
        link = os.path.join(folder, "port")
        with BoardModel(program, link) as boards:
            game = Speaker([godot, "--headless", "--audio-driver", "Dummy", "--path", DEMO, "--", "--play",
                            "pick_and_place", "--things", str(PLAY_THINGS), "--out", os.path.join(folder, "play"),
                            "--source", "serial", "--serial-port", link, "--model-port", str(boards.port)])
            game.says("results:", PLAY_LIMIT_S)
            told = [line for line in game.lines if line.startswith("pick_and_place")]
            try:
                code = game.process.wait(10)
            except subprocess.TimeoutExpired:
                code = None
            game.end()
        if code == 0:
            break
        print("\n".join(game.lines[-8:]))
    check(code == 0, f"pick and place: {told}")


def main():
    godot, program = sys.argv[1:]
    godot_project.prepare_project(PROJECT, godot)
    godot_project.prepare_project(DEMO, godot)
    game = [godot, "--headless", "--path", PROJECT, "--script", "res://serial_game.gd", "--"]
    with tempfile.TemporaryDirectory() as folder:
        found_later(godot, program, folder, "unplug", "plug", "unplugged")
        found_later(godot, program, folder, "mute 1", "mute 0", "boards without power")
        slow_link(godot, program, folder)
        worked(godot, program, folder, "calibrate", ["--errors", "7"], "calibrated", CALIBRATION_LIMIT_S)
        worked(godot, program, folder, "parameters", ["--mask", "0"], "done", PARAMETERS_LIMIT_S)
        played(godot, program, folder)
        killed(game, program, folder, signal.SIGKILL, OFF_LIMIT_MS)
        killed(game, program, folder, signal.SIGSTOP, OFF_LIMIT_MS)
        killed(game, program, folder, signal.SIGSEGV, OFF_LIMIT_MS)
    print(f"{passed} passed, {failed} failed")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
