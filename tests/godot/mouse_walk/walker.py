"""A user with a real mouse and keyboard in the gallery of examples: what is pressed are X events, and nothing is called in
the game. What is seen are the lines that tests/godot/examples/report_gallery.gd prints. Lengths in meters of the scene."""

import json
import math
import os
import subprocess
import threading
import time

WINDOW = "spidar_g examples"
START_LIMIT_S = 60
STEP_LIMIT_S = 15
NEAR_M = 0.004  # of the device; more than half a notch of the wheel
GLIDE_REPORTS = 30
CURSOR_STEP_PX = 12
CURSOR_STEP_S = 0.016
MOVING_KEYS = ("a", "d", "q", "e", "w", "s")
LEFT, RIGHT, WHEEL_UP, WHEEL_DOWN = 1, 3, 4, 5


class GaveUp(Exception):
    """Something did not happen in time; the text says what."""


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def plus(a, b):
    return [x + y for x, y in zip(a, b)]


def minus(a, b):
    return [x - y for x, y in zip(a, b)]


class Walker:
    """The game, a mouse and a keyboard."""

    def __init__(self, godot, project, display, size, log_path):
        self.environment = dict(os.environ, DISPLAY=display)
        self.log_path = log_path
        self.size = [int(part) for part in size.split("x")]
        self.cursor = None
        self.window = None
        self.actions = {"moves": 0, "buttons": 0, "wheel": 0, "keys": 0}
        self.state = None
        self.mouse_taken = False  # in this example
        self.keeps_distance = False  # the grip to the cursor: after the clutch, and after keys that move it
        self.history = []  # the states since it was emptied last
        self.changed = threading.Condition()
        self.game = subprocess.Popen(
            [godot, "--audio-driver", "Dummy", "--rendering-driver", "opengl3", "--path", project,
             "--resolution", size, "-s", "res://report_gallery.gd"],
            env=self.environment, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
            errors="replace")
        self.reader = threading.Thread(target=self._read, daemon=True)
        self.reader.start()

    def _read(self):
        with open(self.log_path, "w", encoding="utf-8") as log:
            for line in self.game.stdout:
                if line.startswith("STATE "):
                    with self.changed:
                        self.state = json.loads(line[len("STATE "):])
                        self.history.append(self.state)
                        self.changed.notify_all()
                else:
                    log.write(line)
                    log.flush()

    def close(self):
        """Ends the game; what it printed beside its states. Nothing stays pressed for the next one."""
        self.xdotool("mouseup", LEFT, "mouseup", RIGHT, "keyup", "shift")
        self.game.terminate()
        self.game.wait(timeout=20)
        self.reader.join(5)
        with open(self.log_path, encoding="utf-8") as log:
            return log.read()

    # --- Seeing ---

    def next_state(self, reports=1):
        """The state after so many further reports."""
        with self.changed:
            first = self.state["tick"] if self.state else -1
            seen = 0
            while seen < reports:
                if not self.changed.wait(10):
                    raise GaveUp("the game reports nothing any more")
                if self.state["tick"] > first:
                    first, seen = self.state["tick"], seen + 1
            return self.state

    def next_state_at_rest(self):
        """The first state in which the grip is wanted where it was a report before: it does not glide to the cursor."""
        for _ in range(GLIDE_REPORTS):
            before = self.device()["wanted"]
            state = self.next_state()
            if math.dist(before, self.device(state)["wanted"]) < 1e-5:
                return state
        raise GaveUp("the grip glides and glides")

    def wait(self, what, condition, limit_s=STEP_LIMIT_S):
        """The first state for which the condition holds."""
        end = time.monotonic() + limit_s
        while time.monotonic() < end:
            state = self.next_state()
            if condition(state):
                return state
        raise GaveUp(f"not within {limit_s} s: {what}")

    def device(self, state=None):
        """The device that the mouse moves."""
        return next(told for told in (state or self.state)["devices"].values() if told["wanted"])

    def place(self, name):
        return self.state["places"][name]

    def felt(self, reports=4):
        """Mean force on the hand over the last fifth of a second, N, once the hand has come to rest."""
        return self.device(self.next_state(reports))["felt"]

    def meanwhile(self, work):
        """What the device was like in all reports while something was done."""
        self.history = []
        work()
        self.next_state(2)
        return [self.device(state) for state in self.history if state["devices"]]

    # --- Doing ---

    def xdotool(self, *words):
        subprocess.run(["xdotool", *map(str, words)], env=self.environment, check=True, stdout=subprocess.DEVNULL)

    def move_cursor(self, to, px_a_step=CURSOR_STEP_PX):
        """As a hand moves it: not in one jump."""
        start = self.cursor or [0.5 * size for size in self.size]
        steps = max(1, math.ceil(math.dist(start, to) / px_a_step))
        words = []
        for step in range(1, steps + 1):
            at = [here + (there - here) * step / steps for here, there in zip(start, to)]
            words += ["mousemove", "--window", self.window, round(at[0]), round(at[1]), "sleep", CURSOR_STEP_S]
        self.xdotool(*words)
        self.cursor = list(to)
        self.actions["moves"] += 1

    def click(self, at):
        self.move_cursor(at, 60)
        self.button(LEFT, True)
        time.sleep(0.08)
        self.button(LEFT, False)

    def button(self, number, pressed):
        self.xdotool("mousedown" if pressed else "mouseup", number)
        self.actions["buttons"] += pressed

    def wheel(self, notches):
        """Away from the viewer, or towards him."""
        if notches:
            self.xdotool("click", "--repeat", abs(notches), "--delay", 30, WHEEL_UP if notches > 0 else WHEEL_DOWN)
            self.actions["wheel"] += abs(notches)

    def key(self, name, time_s=0.06):
        """Holds the key down so long."""
        self.xdotool("keydown", name, "sleep", round(time_s, 3), "keyup", name)
        self.actions["keys"] += 1
        self.keeps_distance = self.keeps_distance or name in MOVING_KEYS

    def close_fingers(self, on=""):
        """Left button down; until the body of this name is held."""
        self.button(LEFT, True)
        if on:
            self.wait(f"{on} held", lambda state: self.device(state)["held"] == on, 5)
            self.next_state(3)  # until the fingers press
        else:
            self.wait("closed fingers", lambda state: self.device(state)["angle"] > 0.3, 5)
            self.next_state(2)

    def open_fingers(self):
        self.button(LEFT, False)
        self.wait("open fingers", lambda state: not self.device(state)["held"] and self.device(state)["angle"] < 0.2, 5)

    def bring(self, goal, near=None, px_a_step=CURSOR_STEP_PX):
        """The place where the hand wants the grip to be, to a point: depth by the wheel and the rest by the cursor; what a
        notch of the wheel leaves of the depth, by the keys W and S. Without `near` that is left as it is."""
        near = near or NEAR_M * self.device()["scale"]
        if not self.mouse_taken:  # before keys: they would keep the grip away from the cursor
            self.move_cursor(self.on_screen(self.state, goal), px_a_step)
            self.mouse_taken = True
        for _ in range(6):
            state = self.next_state_at_rest()
            off = minus(goal, self.device(state)["wanted"])
            if math.hypot(*off) < near:
                return
            self._bring_nearer(state, goal, off, near, px_a_step)
        off = minus(goal, self.device(self.next_state_at_rest())["wanted"])
        if math.hypot(*off) > 2.0 * near:
            raise GaveUp(f"the mouse does not bring the grip to {goal}: off by {off}")

    def _bring_nearer(self, state, goal, off, near, px_a_step):
        camera, device = state["camera"], self.device(state)
        right, up, back = camera["axes"]
        away = [-back[0], 0.0, -back[2]]
        away = [part / math.hypot(*away) for part in away]
        # off = a right + b up + c away: up x right, dotted with both sides, leaves c.
        depth = dot(off, back) / dot(away, back)
        step = device["wheel_step"] * device["scale"]
        notches = round(depth / step)
        if abs(notches) >= 1:
            self.wheel(notches)
        elif abs(depth) > 0.8 * near:
            self.key_along(device, [part * depth for part in away])
        state = self.next_state(2)
        off = minus(goal, self.device(state)["wanted"])
        if max(abs(dot(off, right)), abs(dot(off, up))) > 0.0005:
            to = self.on_screen(state, goal)
            if self.keeps_distance:
                to = plus(self.cursor, minus(to, self.on_screen(state, self.device(state)["wanted"])))
            self.move_cursor(to, px_a_step)

    def key_along(self, device, way):
        """A key press for the longest part of a way in the device's axes."""
        parts = [dot(way, axis) for axis in device["axes"]]
        axis = max(range(3), key=lambda number: abs(parts[number]))
        name = MOVING_KEYS[2 * axis + (parts[axis] > 0.0)]
        self.key(name, abs(parts[axis]) / (device["key_speed"] * device["scale"]))

    @staticmethod
    def on_screen(state, point):
        """Where in the window a point is seen, px."""
        camera = state["camera"]
        off = minus(point, camera["at"])
        x, y, z = (dot(off, axis) for axis in camera["axes"])
        width, height = camera["size"]
        px = 0.5 * height / math.tan(math.radians(0.5 * camera["fov_deg"]))
        return [0.5 * width - px * x / z, 0.5 * height + px * y / z]

    def picture(self, folder, name):
        if folder:
            self.next_state(3)
            path = os.path.join(folder, name + ".png")
            subprocess.run(["import", "-window", self.window, path], env=self.environment, check=True)

    # --- The gallery ---

    def enter(self):
        """The window is there, and takes clicks and keys: the first click after it has come up can be lost."""
        self.wait_for_game()
        found = subprocess.run(["xdotool", "search", "--onlyvisible", "--name", WINDOW], env=self.environment, check=True,
                               text=True, stdout=subprocess.PIPE)
        self.window = found.stdout.split()[-1]
        self.xdotool("windowfocus", self.window)
        count = self.state["inputs"]
        for _ in range(10):
            self.click([0.5 * self.size[0], 10])  # beside every button
            if self.next_state(5)["inputs"] >= count + 3:
                break
        self.actions = {kind: 0 for kind in self.actions}
        self.next_state(5)

    def wait_for_game(self):
        with self.changed:
            self.changed.wait_for(lambda: self.state, START_LIMIT_S)
        self.wait("the gallery", lambda state: state["buttons"])

    def open_example(self, name):
        state = self.wait("the gallery", lambda now: name in now["buttons"])
        self.click(state["buttons"][name])
        self.actions = {kind: 0 for kind in self.actions}
        self.keeps_distance = self.mouse_taken = False
        return self.wait(f"{name} with forces", lambda now: now["example"] == name and now["devices"]
                         and all(device["active"] for device in now["devices"].values()))

    def leave_example(self):
        self.key("Escape")
        self.wait("the gallery", lambda now: not now["example"] and now["buttons"])
