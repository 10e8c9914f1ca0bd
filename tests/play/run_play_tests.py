#!/usr/bin/env python3
"""Plays the demo's tasks by script, headless, and reads what they left: python3 run_play_tests.py GODOT [--seeds N]

For every seed: all objects placed, every weight and width felt. The same seed twice gives the same bytes. With the
motors' output cut nothing may be felt; with the encoders frozen nothing may be placed; both must end with code 1.
"""

import argparse
import csv
import json
import os
import re
import shutil
import subprocess
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))
sys.path.insert(0, os.path.join(ROOT, "tests"))

from godot_project import ADDONS, ProjectError, list_extensions, prepare_project  # noqa: E402

DEMO = os.path.join(ROOT, "demo_project")
OUT = os.path.join(ROOT, "build", "play_tests")
TASK = "pick_and_place"
RUN_LIMIT_S = 180  # a run takes seconds; a script error hangs Godot
SIMULATED_LIMIT_S = 180.0  # the demo's own limit, on simulated time
# The demo judges its own checks; these are the figures, judged here a second time from the numbers.
WEIGHT_TOLERANCE = 0.15
WIDTH_TOLERANCE_M = 0.003
SQUEEZE_FELT_NM = 0.015
POSITION_TOLERANCE_MM = 8.0
ROTATION_TOLERANCE_DEG = 10.0
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


def weight_felt(row):
    expected = number(row, "weight_expected_n")
    return abs(number(row, "weight_felt_n") - expected) <= WEIGHT_TOLERANCE * expected


def width_felt(row):
    error = abs(number(row, "width_felt_m") - number(row, "width_m"))
    return error <= WIDTH_TOLERANCE_M and number(row, "squeeze_torque_nm") >= SQUEEZE_FELT_NM


def play(godot, name, seed, *more):
    return Run(godot, name, ["--play", TASK, "--seed", str(seed), "--out", "{out}", *more])


def check_tables(checks, name, run):
    """What every run leaves, good or bad. Returns (the summary's row, the objects' rows)."""
    summary, objects = run.rows("summary.csv"), run.rows("objects.csv")
    checks.check(
        len(summary) == 1 and len(objects) >= 6,
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


def check_good_run(checks, name, run, seed):
    summary, objects = check_tables(checks, name, run)
    checks.check(run.code == 0, f"{name}: exit code {run.code}, not 0")
    checks.check(summary.get("completed") == "1", f"{name}: not completed")
    checks.check(number(summary, "seed") == seed, f"{name}: seed {summary.get('seed')}")
    servo_hz = number(summary, "servo_hz_mean")
    checks.check(abs(servo_hz - 1000.0) <= 2.0, f"{name}: {servo_hz} cycles a simulated second")
    for row in objects:
        label = f"{name}: {row['name']}"
        near = number(row, "position_error_mm") <= POSITION_TOLERANCE_MM
        straight = number(row, "rotation_error_deg") <= ROTATION_TOLERANCE_DEG
        checks.check(row["placed"] == "1" and near and straight, f"{label}: not placed: {row}")
        checks.check(weight_felt(row), f"{label}: weight felt {row['weight_felt_n']} N: {row}")
        checks.check(width_felt(row), f"{label}: width felt {row['width_felt_m']} m: {row}")
    masses = {row["mass_kg"] for row in objects}
    widths = {row["width_m"] for row in objects}
    checks.check(len(masses) >= 3 and len(widths) >= 3, f"{name}: masses {masses} widths {widths}")


def check_output_cut(checks, name, run):
    summary, objects = check_tables(checks, name, run)
    checks.check(run.code == 1, f"{name}: exit code {run.code}, not 1")
    checks.check(summary.get("weight_checks_ok") == "0", f"{name}: {summary}")
    checks.check(summary.get("width_checks_ok") == "0", f"{name}: {summary}")
    for row in objects:
        checks.check(
            not weight_felt(row) and not width_felt(row), f"{name}: felt without strings: {row}"
        )


def check_pose_frozen(checks, name, run):
    summary, objects = check_tables(checks, name, run)
    checks.check(run.code == 1, f"{name}: exit code {run.code}, not 1")
    checks.check(summary.get("objects_placed") == "0", f"{name}: {summary}")
    checks.check(all(row["placed"] == "0" for row in objects), f"{name}: something was placed")


def check_bad_arguments(checks, godot):
    for words, named in (
        (["--play", "no_such_task", "--out", "{out}"], "no_such_task"),
        (["--play", TASK, "--seed", "x", "--out", "{out}"], "--seed"),
        (["--play", TASK, "--seed", "1"], "--out"),
        (["--play", TASK, "--out", "relative/folder"], "--out"),
        (["--frobnicate"], "--frobnicate"),
    ):
        run = Run(godot, "bad_arguments", words)
        checks.check(run.code == 2, f"{words}: exit code {run.code}, not 2")
        checks.check(named in run.output, f"{words}: the message does not name {named}")


def check_parts(checks, godot):
    """The demo's own mathematics, inside Godot; its counts are added."""
    command = [godot, "--headless", "--path", DEMO, "-s", os.path.join(HERE, "check_parts.gd")]
    try:
        output = subprocess.run(
            command, timeout=RUN_LIMIT_S, text=True, stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL, check=False,
        ).stdout
    except subprocess.TimeoutExpired:
        output = "FAIL parts: not finished in time"
    totals = re.findall(r"^(\d+) passed, (\d+) failed$", output, re.M)
    print("\n".join(line for line in output.splitlines() if line.startswith("FAIL")), end="")
    checks.check(len(totals) == 1, f"parts: no totals\n{output[-2000:]}")
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


def run_all(godot, seeds):
    checks = Checks()
    check_parts(checks, godot)
    runs = []
    for seed in range(1, seeds + 1):
        runs.append(play(godot, f"seed_{seed}", seed))
        check_good_run(checks, f"seed {seed}", runs[-1], seed)
    first = runs[0]
    again = play(godot, "seed_1_again", 1)
    for name in ("summary.csv", "objects.csv"):
        same = again.bytes_of(name) == first.bytes_of(name) != b""
        checks.check(same, f"{name} of seed 1 differs from run to run")
    plays = {run.bytes_of("objects.csv") for run in runs}
    checks.check(len(plays) == seeds, f"{seeds} seeds gave {len(plays)} different plays")
    check_output_cut(checks, "output cut", play(godot, "output_cut", 1, "--cut-output"))
    check_pose_frozen(checks, "pose frozen", play(godot, "pose_frozen", 1, "--freeze-pose"))
    check_bad_arguments(checks, godot)
    check_missing_library(checks, godot)
    session = first.bytes_of("session.json").decode("utf-8") or "{}"
    checks.check("written_utc" in json.loads(session), "session.json lacks written_utc")
    return checks


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("godot")
    parser.add_argument("--seeds", type=int, default=2, help="layouts to play: 1 to N")
    arguments = parser.parse_args()
    if arguments.seeds < 1:
        parser.error(f"--seeds {arguments.seeds}: at least 1 is needed")
    try:
        prepare_project(DEMO, arguments.godot)
    except ProjectError as problem:
        print(f"FAIL {problem}\n0 passed, 1 failed")
        return 1
    checks = run_all(arguments.godot, arguments.seeds)
    print(f"{checks.passed} passed, {checks.failed} failed")
    return 1 if checks.failed else 0


if __name__ == "__main__":
    sys.exit(main())
