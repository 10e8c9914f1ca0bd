#!/usr/bin/env python3
"""Plays the demo's tasks by script, headless, and reads what they left: python3 run_play_tests.py GODOT [--seeds N]

For every task and seed: everything placed, every weight, width and detent felt, nothing dropped, no pad inside a
body. Things carried about and shaken may not be dropped. The same seed twice gives the same bytes. With the motors'
output cut nothing may be felt; with the encoders frozen nothing may be placed; both must end with code 1.
--all-levels plays every level of every task, with a trembling and a clumsy hand too, seed after seed, until --limit-s is
used up, and says how many seeds that were; then it carries 100 things about.
"""

import argparse
import csv
import json
import os
import re
import shutil
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))
sys.path.insert(0, os.path.join(ROOT, "tests"))

from godot_project import ADDONS, ProjectError, list_extensions, prepare_project  # noqa: E402

DEMO = os.path.join(ROOT, "demo_project")
OUT = os.path.join(ROOT, "build", "play_tests")
TASKS = ("pick_and_place", "robot_linking", "match_linking")
LEVELS = (1, 2, 3)
# The demo's mathematics, free play, and what is seen of the demo and worked by keys.
SCRIPTS = ("check_parts.gd", "check_free_play.gd", "check_hidden.gd", "check_labels.gd", "check_hand_shadow.gd",
           "check_guide.gd", "check_frame_rate.gd", "check_layout.gd", "check_keyboard.gd", "check_texts.gd")
RUN_LIMIT_S = 300  # a run takes seconds; a script error hangs Godot
SIMULATED_LIMIT_S = 240.0  # the demo's own limit, on simulated time
CARRIES_IN_ALL = 100
CARRIES_A_RUN = 25
# The demo judges its own checks; these are the figures, judged here a second time from the numbers.
WEIGHT_TOLERANCE = 0.05
WIDTH_TOLERANCE_MM = 1.0
# A soft thing pushes back by 0.0012 N m a millimetre, no more than what the strings' friction hides.
SOFT_WIDTH_TOLERANCE_MM = 1.5
SQUEEZE_FELT_NM = 0.010
DETENT_TOLERANCE = {"match": 0.2, "arm": 0.2, "leg": 0.2}  # by kind of thing; see felt_record.gd
DETENT_TOLERANCE_ELSE = 0.1
RELEASE_TOLERANCE = 0.25
# By task: of the things with their target, and by level where the levels differ.
POSITION_TOLERANCE_MM = {
    "pick_and_place": (8.0, 8.0, 5.0), "robot_linking": (4.0, 4.0, 3.0), "match_linking": (5.0, 4.0, 4.0)}
ROTATION_TOLERANCE_DEG = {
    "pick_and_place": (10.0, 10.0, 6.0), "robot_linking": (6.0, 6.0, 4.0), "match_linking": (8.0, 6.0, 6.0)}
# Of the pads as they were drawn.
PENETRATION_LIMIT_MM = 0.5
JITTER_LIMIT_MM = 0.2
# The device counts as grasping between these angles.
GRASPED_DEG = (20.0, 55.0)
SUMMARY_COLUMNS = """schema_version session_id participant_id task condition grip_source auto_animation trial seed
    started_utc completed abort_reason task_time_s time_to_first_grasp_s grasp_attempts grasp_successes drops
    wrong_placements collisions position_error_mm rotation_error_deg path_length_m path_ratio peak_force_n
    mean_force_n peak_torque_nm peak_grasp_moment_nm wrench_residual_rms tension_saturated_pct servo_hz_mean
    servo_period_p99_us missed_deadlines addon_version godot_version""".split()


class Checks:
    """Counts what holds and prints what does not."""

    def __init__(self):
        self.passed = 0
        self.failed = 0

    def check(self, condition, message):
        if condition:
            self.passed += 1
        else:
            self.failed += 1
            print(f"FAIL {message}")


class Run:
    """One scripted run and its files."""

    def __init__(self, godot, name, arguments):
        self.folder = os.path.join(OUT, name)
        shutil.rmtree(self.folder, ignore_errors=True)
        command = [
            godot, "--headless", "--audio-driver", "Dummy", "--path", DEMO, "--fixed-fps", "60",
            "--", *[word.replace("{out}", self.folder) for word in arguments],
        ]
        try:
            done = subprocess.run(
                command, timeout=RUN_LIMIT_S, text=True, stdout=subprocess.PIPE,
                stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL, check=False,
            )
            self.code, self.output = done.returncode, done.stdout
        except subprocess.TimeoutExpired as expired:
            text = expired.stdout or b""
            self.code, self.output = None, text.decode(errors="replace")

    def bytes_of(self, name):
        try:
            with open(os.path.join(self.folder, name), "rb") as file:
                return file.read()
        except OSError:
            return b""

    def rows(self, name):
        text = self.bytes_of(name).decode("utf-8")
        return list(csv.DictReader(text.splitlines()))


def number(row, column):
    """NaN for an empty cell: it compares false with everything."""
    text = row.get(column) or ""
    return float(text) if text else float("nan")


def within(value, expected, share):
    return abs(value - expected) <= share * abs(expected)


def weight_felt(row):
    return within(number(row, "weight_felt_n"), number(row, "weight_expected_n"), WEIGHT_TOLERANCE)


def width_felt(row):
    tolerance = SOFT_WIDTH_TOLERANCE_MM if row["name"].startswith("soft_") else WIDTH_TOLERANCE_MM
    near = abs(number(row, "width_felt_error_mm")) <= tolerance
    return near and number(row, "squeeze_torque_nm") >= SQUEEZE_FELT_NM


def detent_felt(row):
    tolerance = DETENT_TOLERANCE.get(row["kind"], DETENT_TOLERANCE_ELSE)
    return within(number(row, "detent_felt_n_m"), number(row, "detent_expected_n_m"), tolerance)


class Play(Run):
    """One scripted play of a task."""

    def __init__(self, godot, task, level, seed, *more, name=""):
        self.task, self.level, self.seed = task, level, seed
        self.name = name or f"{task}-{level}-{seed}" + "".join(more)
        self.steady = "--hand" not in more
        super().__init__(godot, self.name, [
            "--play", task, "--level", str(level), "--seed", str(seed), "--out", "{out}", *more])


def check_tables(checks, run):
    """What every run leaves, good or bad. Returns (the summary's row, the objects' rows)."""
    name, summary, objects = run.name, run.rows("summary.csv"), run.rows("objects.csv")
    checks.check(
        len(summary) == 1 and len(objects) >= 4,
        f"{name}: summary.csv has {len(summary)} rows, objects.csv {len(objects)}",
    )
    if not summary:
        print(run.output[-2000:])
        return {}, objects
    missing = [column for column in SUMMARY_COLUMNS if column not in summary[0]]
    checks.check(not missing, f"{name}: summary.csv lacks {missing}")
    checks.check("SCRIPT ERROR" not in run.output, f"{name}: script error\n{run.output[-2000:]}")
    time_s = number(summary[0], "task_time_s")
    checks.check(0.0 < time_s <= SIMULATED_LIMIT_S + 5.0, f"{name}: task_time_s {time_s}")
    checks.check(summary[0]["started_utc"] == "", f"{name}: a clock time in summary.csv")
    return summary[0], objects


def check_good_run(checks, run):
    """Everything placed; with a steady hand everything felt, too: a trembling one feels its own tremble."""
    summary, objects = check_tables(checks, run)
    name = run.name
    checks.check(summary.get("completed") == "1", f"{name}: not completed")
    checks.check(number(summary, "seed") == run.seed, f"{name}: seed {summary.get('seed')}")
    checks.check(number(summary, "level") == run.level, f"{name}: level {summary.get('level')}")
    servo_hz = number(summary, "servo_hz_mean")
    checks.check(abs(servo_hz - 1000.0) <= 2.0, f"{name}: {servo_hz} cycles a simulated second")
    checks.check(summary.get("drops") == "0", f"{name}: {summary.get('drops')} dropped")
    for row in objects:
        label = f"{name}: {row['name']}"
        near = number(row, "position_error_mm") <= POSITION_TOLERANCE_MM[run.task][run.level - 1]
        straight = number(row, "rotation_error_deg") <= ROTATION_TOLERANCE_DEG[run.task][run.level - 1]
        checks.check(row["placed"] == "1" and near and straight, f"{label}: not placed: {row}")
    if not run.steady:
        return
    checks.check(run.code == 0, f"{name}: exit code {run.code}, not 0")
    inside = number(summary, "max_penetration_mm")
    checks.check(inside <= PENETRATION_LIMIT_MM, f"{name}: a pad {inside} mm inside a body")
    linking = run.task != "pick_and_place"
    checks.check(
        not linking or any(row["release_felt_n"] for row in objects), f"{name}: nothing pulled off")
    for row in objects:
        label = f"{name}: {row['name']}"
        light = row["kind"] == "match"
        checks.check(light or weight_felt(row), f"{label}: weight felt {row['weight_felt_n']} N: {row}")
        checks.check(width_felt(row), f"{label}: width felt {row['width_felt_m']} m: {row}")
        checks.check(not linking or detent_felt(row), f"{label}: detent {row['detent_felt_n_m']} N/m: {row}")
        torn = not row["release_expected_n"] or within(
            number(row, "release_felt_n"), number(row, "release_expected_n"), RELEASE_TOLERANCE)
        checks.check(torn, f"{label}: let go at {row['release_felt_n']} N: {row}")
        checks.check(number(row, "jitter_mm") <= JITTER_LIMIT_MM, f"{label}: jitter: {row}")
        angle = number(row, "grasp_angle_deg")
        checks.check(GRASPED_DEG[0] <= angle <= GRASPED_DEG[1], f"{label}: held at {angle} degrees")
    if run.task == "pick_and_place":
        masses = {row["mass_kg"] for row in objects}
        widths = {row["width_m"] for row in objects}
        checks.check(len(masses) >= 3 and len(widths) >= 3, f"{name}: masses {masses} widths {widths}")


def check_carries(checks, run, carries):
    """So many things picked up, led about, shaken and put back; none left the fingers before they opened."""
    summary, objects = (run.rows("summary.csv") or [{}])[0], run.rows("objects.csv")
    checks.check(run.code == 0, f"{run.name}: exit code {run.code}, not 0: {summary.get('abort_reason')}")
    checks.check("SCRIPT ERROR" not in run.output, f"{run.name}: script error\n{run.output[-2000:]}")
    checks.check(summary.get("drops") == "0", f"{run.name}: {summary.get('drops')} dropped")
    tries = sum(int(row["attempts"]) for row in objects)
    checks.check(tries >= carries, f"{run.name}: went for {tries} things, not {carries}")
    checks.check(number(summary, "grasp_successes") >= carries, f"{run.name}: {summary.get('grasp_successes')} held")
    inside = number(summary, "max_penetration_mm")
    checks.check(inside <= PENETRATION_LIMIT_MM, f"{run.name}: a pad {inside} mm inside a body")


def check_output_cut(checks, run):
    summary, objects = check_tables(checks, run)
    checks.check(run.code == 1, f"{run.name}: exit code {run.code}, not 1")
    checks.check(summary.get("width_checks_ok") == "0", f"{run.name}: {summary}")
    weighed = [row for row in objects if row["kind"] != "match"]
    checks.check(
        not weighed or summary.get("weight_checks_ok") == "0", f"{run.name}: {summary}")
    checks.check(
        run.task == "pick_and_place" or summary.get("detent_checks_ok") == "0", f"{run.name}: {summary}")
    for row in objects:
        checks.check(
            not weight_felt(row) and not width_felt(row) and not detent_felt(row),
            f"{run.name}: felt without strings: {row}")


def check_rigid(checks, run):
    """A rigid grip whose fingers the hand closes: all is placed and weighed; nothing pushes the fingers, so no width is felt."""
    summary, objects = check_tables(checks, run)
    checks.check(summary.get("objects_placed") == str(len(objects)), f"{run.name}: {summary}")
    for row in objects:
        # A match is too light to be judged.
        light = row["weight_expected_n"] == ""
        checks.check(light or weight_felt(row), f"{run.name}: weight of {row['name']}: {row}")
        checks.check(row["width_felt_m"] == "", f"{run.name}: a width was felt: {row}")


def check_pose_frozen(checks, run):
    summary, objects = check_tables(checks, run)
    checks.check(run.code == 1, f"{run.name}: exit code {run.code}, not 1")
    checks.check(summary.get("objects_placed") == "0", f"{run.name}: {summary}")
    checks.check(all(row["placed"] == "0" for row in objects), f"{run.name}: something was placed")


def check_bad_arguments(checks, godot):
    for words, named in (
        (["--play", "no_such_task", "--out", "{out}"], "no_such_task"),
        (["--play", TASKS[0], "--seed", "x", "--out", "{out}"], "--seed"),
        (["--play", TASKS[0], "--seed", "1"], "--out"),
        (["--play", TASKS[0], "--out", "relative/folder"], "--out"),
        (["--play", TASKS[0], "--level", "4", "--out", "{out}"], "--level"),
        (["--play", TASKS[0], "--device", "x9", "--out", "{out}"], "--device"),
        (["--play", TASKS[0], "--hand", "third", "--out", "{out}"], "--hand"),
        (["--play", TASKS[0], "--carries", "0", "--out", "{out}"], "--carries"),
        (["--play", TASKS[1], "--carries", "2", "--out", "{out}"], "--carries"),
        (["--frobnicate"], "--frobnicate"),
    ):
        run = Run(godot, "bad_arguments", words)
        checks.check(run.code == 2, f"{words}: exit code {run.code}, not 2")
        checks.check(named in run.output, f"{words}: the message does not name {named}")


def check_parts(checks, godot, script):
    """One of the scripts below, run in the demo's project; its counts are added."""
    command = [godot, "--headless", "--audio-driver", "Dummy", "--fixed-fps", "60", "--path", DEMO,
               "-s", os.path.join(HERE, script)]
    # The settings that a check saves are nobody's.
    user = os.path.join(OUT, "user")
    own = dict(os.environ, XDG_DATA_HOME=user, APPDATA=user)
    try:
        output = subprocess.run(
            command, timeout=RUN_LIMIT_S, text=True, stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL, check=False, env=own,
        ).stdout
    except subprocess.TimeoutExpired:
        output = f"FAIL {script}: not finished in time"
    totals = re.findall(r"^(\d+) passed, (\d+) failed$", output, re.M)
    print("\n".join(line for line in output.splitlines() if line.startswith("FAIL")), end="")
    checks.check(len(totals) == 1, f"{script}: no totals\n{output[-2000:]}")
    checks.check("SCRIPT ERROR" not in output, f"{script}: script error\n{output[-2000:]}")
    for passed, failed in totals:
        checks.passed += int(passed)
        checks.failed += int(failed)


def check_missing_library(checks, godot):
    """The demo beside an add-on without its library, never imported: a sentence that says what to do, code 2."""
    project = os.path.join(OUT, "missing_library")
    shutil.rmtree(project, ignore_errors=True)
    shutil.copytree(DEMO, project, ignore=shutil.ignore_patterns(".godot", "addons"), symlinks=True)
    shutil.copytree(ADDONS, os.path.join(project, "addons"), ignore=shutil.ignore_patterns("*.so"))
    list_extensions(project)
    done = subprocess.run(
        [godot, "--headless", "--path", project, "--quit-after", "600"], timeout=RUN_LIMIT_S,
        text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL,
        check=False,
    )
    checks.check(done.returncode == 2, f"missing library: exit code {done.returncode}, not 2")
    checks.check("./dev build" in done.stdout, f"missing library: no remedy in\n{done.stdout[-1500:]}")
    checks.check("SCRIPT ERROR" not in done.stdout, f"missing library:\n{done.stdout[-1500:]}")
    shutil.rmtree(project, ignore_errors=True)


def in_parallel(calls):
    """The results of these calls, in their order; a play is one thread of its own."""
    with ThreadPoolExecutor(max_workers=os.cpu_count() or 1) as pool:
        return [future.result() for future in [pool.submit(call) for call in calls]]


def run_some(godot, seeds):
    """What a change is tested with: one level of each task."""
    checks = Checks()
    for script in SCRIPTS:
        check_parts(checks, godot, script)
    good = [(task, level, seed) for task, level in zip(TASKS, LEVELS) for seed in range(1, seeds + 1)]
    calls = [lambda key=key: Play(godot, *key) for key in good]
    calls.append(lambda: Play(godot, *good[0], name="again"))
    for task in TASKS:
        calls.append(lambda task=task: Play(godot, task, 1, 1, "--cut-output"))
        calls.append(lambda task=task: Play(godot, task, 1, 1, "--freeze-pose"))
    calls.append(lambda: Play(godot, TASKS[0], 1, 1, "--hand", "trembling"))
    # In layout 1 the leg that a clumsy hand knocks out of its fingers falls behind the robot, where the script cannot reach it.
    calls.append(lambda: Play(godot, TASKS[1], 1, 2, "--hand", "clumsy"))
    plays = in_parallel(calls)
    first, again = plays[0], plays[len(good)]
    for run in plays[: len(good)] + plays[-2:]:
        check_good_run(checks, run)
    check_carries(checks, Play(godot, TASKS[0], 3, 1, "--carries", "4"), 4)
    for name in ("summary.csv", "objects.csv"):
        same = again.bytes_of(name) == first.bytes_of(name) != b""
        checks.check(same, f"{name} of {first.name} differs from run to run")
    different = {run.bytes_of("objects.csv") for run in plays[: len(good)]}
    checks.check(len(different) == len(good), f"{len(good)} plays, {len(different)} of them different")
    faulty = plays[len(good) + 1 : -2]
    for cut, frozen in zip(faulty[::2], faulty[1::2]):
        check_output_cut(checks, cut)
        check_pose_frozen(checks, frozen)
    for run in in_parallel([lambda task=task: Play(godot, task, 1, 1, "--device", "x5r") for task in TASKS]):
        check_rigid(checks, run)
    check_bad_arguments(checks, godot)
    check_missing_library(checks, godot)
    session = first.bytes_of("session.json").decode("utf-8") or "{}"
    checks.check("written_utc" in json.loads(session), "session.json lacks written_utc")
    return checks


def run_all_levels(godot, seeds, limit_s):
    """Every level of every task, and a clumsy hand, as many seeds as fit."""
    checks, carries, began, seed = Checks(), 0, time.monotonic(), 0
    worst = {"weight_pct": 0.0, "width_mm": 0.0, "detent_pct": 0.0, "penetration_mm": 0.0, "jitter_mm": 0.0}
    while seed < seeds and (seed == 0 or (time.monotonic() - began) * (seed + 1) / seed < limit_s):
        seed += 1
        calls = [
            lambda task=task, level=level: Play(godot, task, level, seed) for task in TASKS for level in LEVELS]
        for shift, hand in enumerate(("trembling", "clumsy")):
            key = TASKS[(seed + shift) % 3], LEVELS[seed // 3 % 3], seed
            calls.append(lambda key=key, hand=hand: Play(godot, *key, "--hand", hand))
        for run in in_parallel(calls):
            check_good_run(checks, run)
            carries += sum(int(row["attempts"]) for row in run.rows("objects.csv"))
            if run.steady:
                note_worst(worst, run)
    carry_calls = [
        lambda number=number: Play(godot, TASKS[0], LEVELS[number % 3], number + 1, "--carries", str(CARRIES_A_RUN))
        for number in range(CARRIES_IN_ALL // CARRIES_A_RUN)]
    for run in in_parallel(carry_calls):
        check_carries(checks, run, CARRIES_A_RUN)
    print(f"{seed} of {seeds} seeds within {limit_s:.0f} s, {carries} carries; worst: " + ", ".join(
        f"{key} {value:.3f}" for key, value in worst.items()))
    return checks


def note_worst(worst, run):
    def grow(key, value):
        worst[key] = max(worst[key], value) if value == value else worst[key]

    for row in run.rows("summary.csv"):
        grow("penetration_mm", number(row, "max_penetration_mm"))
    for row in run.rows("objects.csv"):
        grow("width_mm", abs(number(row, "width_felt_error_mm")))
        grow("jitter_mm", number(row, "jitter_mm"))
        for key, felt, expected in (
            ("weight_pct", "weight_felt_n", "weight_expected_n"),
            ("detent_pct", "detent_felt_n_m", "detent_expected_n_m"),
        ):
            grow(key, 100.0 * abs(number(row, felt) / number(row, expected) - 1.0))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("godot")
    parser.add_argument("--seeds", type=int, default=3, help="layouts to play: 1 to N")
    parser.add_argument("--all-levels", action="store_true", help="every level, until the time is used up")
    parser.add_argument("--limit-s", type=float, default=200.0, help="with --all-levels")
    arguments = parser.parse_args()
    if arguments.seeds < 1:
        parser.error(f"--seeds {arguments.seeds}: at least 1 is needed")
    try:
        prepare_project(DEMO, arguments.godot)
    except ProjectError as problem:
        print(f"FAIL {problem}\n0 passed, 1 failed")
        return 1
    if arguments.all_levels:
        checks = run_all_levels(arguments.godot, arguments.seeds, arguments.limit_s)
    else:
        checks = run_some(arguments.godot, arguments.seeds)
    print(f"{checks.passed} passed, {checks.failed} failed")
    return 1 if checks.failed else 0


if __name__ == "__main__":
    sys.exit(main())
