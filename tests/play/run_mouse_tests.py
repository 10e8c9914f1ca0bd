#!/usr/bin/env python3
"""A scripted user with real mouse events: python3 run_mouse_tests.py GODOT [--display :N]

Under an X server of its own (Xvfb) and with xdotool it works the hub by the simulated grip (touch a knob, close on it)
and by keys, and completes each task twice: thing by thing with mouse and keys, and with auto-animation, two clicks a thing.
What it cannot see it reads from the file that the demo's --report leaves.
"""

import argparse
import functools
import json
import os
import shutil
import subprocess
import sys
import tempfile
import time

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))
sys.path.insert(0, os.path.join(ROOT, "tests"))

from godot_project import prepare_project  # noqa: E402

DEMO = os.path.join(ROOT, "demo_project")
WINDOW = "spidar_g demo"
SETTINGS = "godot/app_userdata/spidar_g demo/settings.cfg"
START_LIMIT_S = 180
STEP_LIMIT_S = 200  # a loaded machine without a GPU draws few frames a second, and the game waits for them
TRAVEL_Y_M = 0.035  # world: a held thing passes over the others
OPEN_DEG = 6.0
RESOLUTION = "640x400"  # a small window costs a computer without a GPU a third of a large one
PIXELS_M = 500.0  # fewer than the picture has: the loop then comes in without swinging
WHEEL_STEP_M = 0.006  # the demo's own
KEY_M_S = 0.12  # the demo's own
KEY_DEG_S = 51.0  # the demo's own
TURN_DEG = 3.0
FINE_M = 0.002  # two or three pixels: a match is 3 mm thick
SCENES = {"pick_and_place": "PickAndPlace", "robot_linking": "RobotLinking", "match_linking": "MatchLinking"}


class GaveUp(Exception):
    """Something did not happen in time; the text says what."""


class User:
    """The demo, a display, a mouse and a keyboard."""

    def __init__(self, godot, display, arguments, settings):
        self.window_id = None
        self.cursor = None
        self.keeps_distance = False  # the grip to the cursor, after keys that move it
        self.folder = tempfile.mkdtemp(prefix="spidar_mouse_")
        self.report_path = os.path.join(self.folder, "report.json")
        path = os.path.join(self.folder, SETTINGS)
        os.makedirs(os.path.dirname(path))
        with open(path, "w", encoding="utf-8") as file:
            rows = {"guide_shown": "true", **settings}  # the menu first, as for everybody but a newcomer
            file.write("[demo]\n\n" + "".join(f"{key}={value}\n" for key, value in rows.items()))
        self.environment = dict(os.environ, DISPLAY=display, XDG_DATA_HOME=self.folder)
        with open(os.path.join(self.folder, "log.txt"), "w", encoding="utf-8") as log:
            self.demo = subprocess.Popen(
                [godot, "--audio-driver", "Dummy", "--rendering-driver", "opengl3", "--path", DEMO,
                 "--resolution", RESOLUTION, "--", "--report", self.report_path, *arguments],
                env=self.environment, stdout=log, stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL)

    def close(self):
        self.demo.terminate()
        self.demo.wait(timeout=20)
        with open(os.path.join(self.folder, "log.txt"), encoding="utf-8", errors="replace") as log:
            text = log.read()
        return text

    def results(self):
        """The rows of all summary.csv files that the demo has left."""
        rows = []
        for folder, _, names in os.walk(self.folder):
            if "summary.csv" in names:
                with open(os.path.join(folder, "summary.csv"), encoding="utf-8") as file:
                    lines = file.read().splitlines()
                rows += [dict(zip(lines[0].split(","), line.split(","))) for line in lines[1:]]
        return rows

    def xdotool(self, *words):
        subprocess.run(["xdotool", *map(str, words)], env=self.environment, check=True)

    def move(self, screen):
        self.cursor = (round(screen[0]), round(screen[1]))
        self.xdotool("mousemove", "--window", self.window(), *self.cursor)

    def window(self):
        """X's number of the demo's window, which may lie anywhere on the screen."""
        if self.window_id is None:
            found = subprocess.run(["xdotool", "search", "--onlyvisible", "--name", WINDOW], env=self.environment,
                                   check=True, text=True, stdout=subprocess.PIPE)
            self.window_id = found.stdout.split()[-1]
        return self.window_id

    def click(self, screen):
        self.move(screen)
        time.sleep(0.1)
        self.xdotool("click", 1)

    def press(self, key, what, condition):
        """Presses a key once and waits for what it does. Godot takes a press less than 5 ms after the same key's release
        for the keyboard's own repeat, and the demo ignores repeats: hence two reports between any two keys."""
        self.wait_for_reports(2)
        self.xdotool("key", key)
        return self.wait(f"{what} by {key}", condition)

    def see(self):
        with open(self.report_path, encoding="utf-8") as file:
            return json.load(file)

    def wait(self, what, condition, limit_s=STEP_LIMIT_S):
        """The report for which condition holds."""
        end = time.monotonic() + limit_s
        while time.monotonic() < end:
            if self.demo.poll() is not None:
                raise GaveUp(f"the demo has ended while waiting: {what}")
            try:
                report = self.see()
                if condition(report):
                    return report
            except (OSError, ValueError):
                pass
            time.sleep(0.1)
        raise GaveUp(f"not within {limit_s} s: {what}")

    def wait_for_reports(self, how_many, since=None):
        count = (since or self.see())["count"] + how_many
        self.wait("the next report", lambda now: now["count"] >= count)

    def bring_grip(self, world_of, near_m=0.005):
        """Closed loop by cursor, wheel and, nearer than a notch, keys: the grip to the point (m) that world_of gives."""
        end = time.monotonic() + STEP_LIMIT_S
        while time.monotonic() < end:
            report = self.see()
            goal, grip = world_of(report), report["grip"]
            off = [there - here for there, here in zip(goal, grip["world"])]
            if max(map(abs, off)) < near_m:
                return
            if abs(off[0]) > near_m or abs(off[1]) > near_m:  # before keys: they keep the grip away from the cursor
                here = self.cursor if self.keeps_distance and self.cursor else grip["screen"]
                self.move((here[0] + PIXELS_M * off[0], here[1] - PIXELS_M * off[1]))
            clicks = round(-off[2] / WHEEL_STEP_M)
            if abs(off[2]) > near_m and not clicks:
                self.hold_key("s" if off[2] > 0.0 else "w", abs(off[2]) / KEY_M_S)
                self.keeps_distance = True
            elif abs(off[2]) > near_m:
                self.xdotool("click", "--repeat", min(abs(clicks), 5), "--delay", 20, 4 if clicks > 0 else 5)
            self.wait_for_reports(4, report)
        raise GaveUp("the grip does not come to its place")

    def hold_key(self, key, time_s):
        self.xdotool("keydown", key, "sleep", round(time_s, 3), "keyup", key)

    def turn_held(self, name):
        """By the arrow keys until the held thing lies as in its place, or the other way round, which looks the same."""
        end = time.monotonic() + STEP_LIMIT_S
        while time.monotonic() < end:
            turn = (named(self.see(), "bodies", name)["turn_deg"] + 90.0) % 180.0 - 90.0
            if abs(turn) < TURN_DEG:
                return
            key = "Left" if turn > 0.0 else "Right"
            self.hold_key(key, abs(turn) / KEY_DEG_S)
            self.wait_for_reports(4)
        raise GaveUp(f"{name} cannot be turned into its place")

    def pick_up(self, name, y_m):
        self.xdotool("mousedown", 1)
        self.wait(f"{name} held", lambda report: report["held"] == name, 60)
        self.rise(y_m)

    def open_fingers(self):
        self.xdotool("mouseup", 1)
        self.wait("open fingers", lambda report: report["grasp_angle_deg"] < OPEN_DEG and not report["held"])

    def rise(self, y_m):
        """Straight up to this height."""
        here = self.see()["grip"]["world"]
        self.bring_grip(lambda report: at_height(here, y_m), 0.012)


def named(report, kind, name):
    return next(item for item in report[kind] if item["name"] == name)


def plus(point_m, way_m):
    return [here + way for here, way in zip(point_m, way_m)]


def above(point_m, height_m):
    return [point_m[0], point_m[1] + height_m, point_m[2]]


def at_height(point_m, y_m):
    return [point_m[0], y_m, point_m[2]]


def hub_by_grip(godot, display, check):
    """The menu by touch and grasp alone; its keys and buttons; what stops and what goes on."""
    user = User(godot, display, [], {})
    try:
        user.wait("the hub", lambda report: report["scene"] == "Hub", START_LIMIT_S)
        check(not user.see()["forces"], "forces are on at the start")

        def knob(report):
            return named(report, "knobs", "RobotLinking")["at"]["world"]

        user.bring_grip(lambda report: above(knob(report), 0.05), 0.008)
        user.bring_grip(knob, 0.008)
        user.xdotool("mousedown", 1)
        user.wait("robot linking by a grasp of its knob", lambda report: report["scene"] == "RobotLinking")
        user.xdotool("mouseup", 1)
        user.press("h", "help", lambda report: report["help"] and "robot" in report["goal"])
        user.press("h", "no help", lambda report: not report["help"])
        for mode in (0, 1, 2):  # off, short, full; full at the start
            user.press("Tab", f"display {mode}", lambda report, mode=mode: report["hud"] == mode)
        user.press("p", "pause", lambda report: report["paused"] and "Paused" in report["hint"])
        user.press("p", "no pause", lambda report: not report["paused"])
        user.press("Escape", "back in the hub", lambda report: report["scene"].startswith("Hub"))
        panic_with_a_button_in_focus(user)
        user.press("3", "match linking by a key", lambda report: report["scene"].startswith("MatchLinking"))
        check(True, "")
    finally:
        check("SCRIPT ERROR" not in user.close(), "script errors in the hub")
        shutil.rmtree(user.folder)


def panic_with_a_button_in_focus(user):
    """Space once pressed the button that was clicked last, and the forces stayed on."""
    level = user.see()["level"]
    user.click(next(at for text, at in user.see()["buttons"].items() if "Level" in text))
    clicked = user.wait("another level by a click", lambda report: report["level"] != level)["level"]
    user.press("f", "forces on", lambda report: report["forces"])
    user.press("space", "forces off", lambda report: not report["forces"])
    user.wait("the level as it was", lambda report: report["level"] == clicked)


def trial_broken_off(godot, display, check):
    """The experiment's first screens by mouse; Backspace breaks a trial off, and it is done again."""
    user = User(godot, display, [], {"participant": '"5"'})
    try:
        user.wait("the hub", lambda report: report["scene"] == "Hub", START_LIMIT_S)
        user.press("7", "the instruction", lambda report: "Start" in report["buttons"])
        user.click(user.see()["buttons"]["Start"])
        task = user.wait("the practice", lambda report: report.get("task"))["task"]
        user.press("BackSpace", "the end of the practice", lambda report: "Go on" in report["buttons"])
        check("task" not in user.see(), "the task is still open")
        user.click(user.see()["buttons"]["Go on"])
        again = user.wait("the practice again", lambda report: report.get("task"))
        check(again["task"] == task and not again["finished"], f"{task} was broken off, not {again['task']}")
        user.press("Escape", "back in the hub", lambda report: report["scene"].startswith("Hub"))
    finally:
        check("SCRIPT ERROR" not in user.close(), "script errors in the experiment")
        shutil.rmtree(user.folder)


def task_by_hand(godot, display, check, task, how_many=None):
    """The mouse condition without the paper's animations: things to their places by mouse and keys alone, no forces."""
    began = time.monotonic()
    user = User(godot, display, ["--task", task], {"source": '"mouse"', "participant": '"p6"'})
    place = place_object if task == "pick_and_place" else link_thing
    try:
        names = [body["name"] for body in user.wait("the task", lambda report: report["bodies"], START_LIMIT_S)["bodies"]]
        started = time.monotonic()
        user.xdotool("key", "f")
        for number, name in enumerate(names[:how_many], 1):
            by_hand(user, name, place)
            print(f"{task} by mouse: {number} in {time.monotonic() - started:.0f} s, {started - began:.0f} s after the start")
        check(not user.see()["forces"], "F turns forces on although the source is the mouse")
        if how_many is None:
            user.wait(f"{task} complete", lambda report: report["finished"])
            check_row(check, user, task, "p6", auto_animation="0")
        check(True, "")
    finally:
        check("SCRIPT ERROR" not in user.close(), f"script errors in {task} by hand")
        shutil.rmtree(user.folder)


def by_hand(user, name, place):
    """Picked up, placed, and opened fingers up again before anything is brushed; three attempts."""
    for attempt in range(3):
        try:
            place(user, name)
            user.wait(f"{name} placed", lambda report: named(report, "bodies", name)["placed"], 60)
            return
        except GaveUp as lost:
            report = user.see()
            body = named(report, "bodies", name)
            print(f"attempt {attempt + 1}: {lost}; grip {report['grip']['world']}, {name} {body['at']['world']}, "
                  f"its place {body['goal']['world']}, {body['turn_deg']} degrees to turn")
            user.xdotool("mouseup", 1)
    raise GaveUp(f"{name} was not placed in three attempts")


def place_object(user, name):
    """Down on it from above, closed, up, over its outline, down, opened."""
    def at(report):
        return named(report, "bodies", name)["at"]["world"]

    def goal(report):
        return named(report, "bodies", name)["goal"]["world"]

    user.rise(TRAVEL_Y_M)
    user.bring_grip(lambda report: at_height(at(report), TRAVEL_Y_M))
    user.bring_grip(at)
    user.pick_up(name, TRAVEL_Y_M)
    user.bring_grip(lambda report: at_height(goal(report), TRAVEL_Y_M))
    user.bring_grip(lambda report: above(goal(report), 0.003), 0.004)
    user.open_fingers()
    user.rise(TRAVEL_Y_M)


def link_thing(user, name):
    """In from where its fingers come, closed, up, turned, before its seat, in until it snaps, opened, and out the same way."""
    def body(report):
        return named(report, "bodies", name)

    def to_grip(report, point):
        """Where the grip has to be for the held thing to come there."""
        return [here + there - at for here, there, at in zip(report["grip"]["world"], point, body(report)["at"]["world"])]

    def before(report):
        return plus(body(report)["goal"]["world"], body(report)["way_out"])

    travel_y = body(user.see())["travel_y"]
    user.rise(travel_y)
    user.bring_grip(lambda report: at_height(plus(body(report)["at"]["world"], body(report)["from"]), travel_y))
    user.bring_grip(lambda report: plus(body(report)["at"]["world"], body(report)["from"]))
    user.bring_grip(lambda report: body(report)["at"]["world"], FINE_M)
    user.pick_up(name, travel_y)
    user.turn_held(name)
    user.bring_grip(lambda report: to_grip(report, at_height(before(report), travel_y)))
    user.bring_grip(lambda report: to_grip(report, before(report)))
    user.bring_grip(lambda report: to_grip(report, body(report)["goal"]["world"]), FINE_M)
    user.open_fingers()
    seat = user.see()["grip"]["world"]
    user.bring_grip(lambda report: plus(seat, body(report)["way_out"]))
    user.rise(travel_y)


def check_row(check, user, task, participant, auto_animation):
    """The one row that a completed task leaves."""
    end = time.monotonic() + 20
    while not user.results() and time.monotonic() < end:
        time.sleep(0.1)
    rows = user.results()
    check(len(rows) == 1 and rows[0]["completed"] == "1", f"{task}: results {rows}")
    row = rows[0] if rows else {}
    check(row.get("task") == task and row.get("auto_animation") == auto_animation, f"{task}: {row}")
    check(row.get("participant_id") == participant and row.get("grip_source") == "mouse", f"{task}: {row}")


def task_by_clicks(godot, display, check, task):
    user = User(godot, display, ["--task", task], {"source": '"mouse"', "auto_animation": "true", "participant": '"p7"'})
    try:
        report = user.wait(task, lambda report: report["scene"] == SCENES[task] and report["bodies"], START_LIMIT_S)
        for body in report["bodies"]:
            name = body["name"]
            for _ in range(3):  # a click can be lost while the window is still coming up
                user.click(named(user.see(), "bodies", name)["at"]["screen"])
                try:
                    user.wait(f"{name} chosen", lambda now: now["busy"] or now["held"], 60)
                    break
                except GaveUp as lost:
                    print(lost)
            user.wait(f"{name} picked up", lambda now: now["held"] == name and not now["busy"])
            user.click(named(user.see(), "bodies", name)["goal"]["screen"])
            user.wait(f"{name} placed", lambda now: named(now, "bodies", name)["placed"] and not now["busy"])
        user.wait(f"{task} complete", lambda now: now["finished"])
        check_row(check, user, task, "p7", auto_animation="1")
    finally:
        check("SCRIPT ERROR" not in user.close(), f"script errors in {task}")
        shutil.rmtree(user.folder)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("godot")
    parser.add_argument("--display", default=os.environ.get("DISPLAY", ""))
    parser.add_argument("--only", default="", help="a part of the name of what to run")
    parser.add_argument("--quick", action="store_true", help="one thing of each task by hand, not all; every task by clicks")
    arguments = parser.parse_args()
    if not arguments.display:
        parser.error("no display: run under Xvfb, or give --display")
    prepare_project(DEMO, arguments.godot)
    counts = [0, 0]

    def check(condition, message):
        counts[0 if condition else 1] += 1
        if not condition:
            print(f"FAIL {message}")

    parts = {"hub_by_grip": hub_by_grip, "trial_broken_off": trial_broken_off}
    for task in SCENES:
        parts[f"{task}_by_clicks"] = functools.partial(task_by_clicks, task=task)
        parts[f"{task}_by_hand"] = functools.partial(task_by_hand, task=task, how_many=1 if arguments.quick else None)
    for name, part in parts.items():
        if arguments.only not in name:
            continue
        try:
            part(arguments.godot, arguments.display, check)
        except (GaveUp, OSError, StopIteration, subprocess.SubprocessError) as problem:
            check(False, f"{name}: {problem}")
    print(f"{counts[0]} passed, {counts[1]} failed")
    return 1 if counts[1] else 0


if __name__ == "__main__":
    sys.exit(main())
