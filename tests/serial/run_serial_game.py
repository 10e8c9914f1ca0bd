#!/usr/bin/env python3
"""A Godot game on serial motor boards that stand on a pseudo-terminal: run_serial_game.py GODOT PROGRAM

PROGRAM is build/bin/spidar_serial_tests. The game finds the boards, zeroes them, arms and pulls; then it is killed,
stopped, or ends by itself. Prints each check, then "N passed, N failed".
"""

import os
import signal
import subprocess
import sys
import tempfile
import threading
import time

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.dirname(HERE))
import godot_project  # noqa: E402

PROJECT = os.path.join(HERE, "game")
PULL_LIMIT_S = 20  # from the start of Godot
TRIES = 5  # a busy machine may hold the loop up until it stops itself
OFF_LIMIT_MS = 50

passed = 0
failed = 0


def check(good, what):
    global passed, failed
    passed += bool(good)
    failed += not good
    print(f"{'ok  ' if good else 'FAIL'} {what}", flush=True)


class Speaker:
    """A process, and the lines that it has said so far."""

    def __init__(self, command, **options):
        self.lines = []
        self.process = subprocess.Popen(
            command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, **options)
        threading.Thread(target=self._listen, daemon=True).start()

    def _listen(self):
        for line in self.process.stdout:
            self.lines.append(line.rstrip())

    def says(self, start, limit_s):
        end = time.monotonic() + limit_s
        while time.monotonic() < end:
            if any(line.startswith(start) for line in list(self.lines)):
                return True
            if self.process.poll() is not None:
                time.sleep(0.1)
                return any(line.startswith(start) for line in self.lines)
            time.sleep(0.01)
        return False

    def end(self):
        if self.process.poll() is None:
            self.process.kill()
        self.process.wait()


def last_number(lines, word):
    found = [int(line.split()[1]) for line in lines if line.startswith(word + " ")]
    return found[-1] if found else None


class Play:
    """Boards, and a game on them that pulls."""

    def __init__(self, godot, program, folder):
        for _ in range(TRIES):
            self.link = os.path.join(folder, "port")
            self.boards = Speaker([program, "--boards", self.link], stdin=subprocess.PIPE)
            self.boards.says("ready", 5)
            self.game = Speaker([godot, "--headless", "--path", PROJECT, "--script",
                                 "res://serial_game.gd", "--", self.link])
            self.pulls = self.game.says("active", PULL_LIMIT_S)
            if self.pulls:
                return
            print("\n".join(self.game.lines[-6:]))
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
        if self.boards.process.poll() is None:
            self.boards.process.stdin.close()
            self.boards.process.wait(10)


def killed(godot, program, folder, number, limit_ms):
    name = signal.Signals(number).name
    play = Play(godot, program, folder)
    check(play.pulls, f"{name}: the game pulls")
    if not play.pulls:
        return
    device = [line for line in play.game.lines if line.startswith("device")]
    check(device and device[0] == f'device B5M with id 1 at {play.link}, rate 2951, remarks ""', f"{name}: {device}")
    sent_ns = time.monotonic_ns()
    play.game.process.send_signal(number)
    off_ms = play.off_after_ms(sent_ns)
    check(off_ms is not None and -5 < off_ms <= limit_ms, f"{name}: currents zero after {off_ms} ms, limit {limit_ms}")
    play.end()


def main():
    godot, program = sys.argv[1:]
    godot_project.prepare_project(PROJECT, godot)
    with tempfile.TemporaryDirectory() as folder:
        killed(godot, program, folder, signal.SIGKILL, OFF_LIMIT_MS)
        killed(godot, program, folder, signal.SIGSTOP, OFF_LIMIT_MS)
        killed(godot, program, folder, signal.SIGSEGV, OFF_LIMIT_MS)
    print(f"{passed} passed, {failed} failed")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
