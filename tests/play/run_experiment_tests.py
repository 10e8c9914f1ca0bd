#!/usr/bin/env python3
"""Simulated participants of the experiment: python3 run_experiment_tests.py GODOT PYTHON [--participants N]

Each does the whole plan by script, one thing a trial. One of them is killed in the middle of a trial (SIGKILL) and goes
on: only that trial may be lost. Then the figures are made with PYTHON (it has matplotlib), and their numbers are
computed a second time here.
"""

import argparse
import csv
import os
import shutil
import statistics
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))
sys.path.insert(0, os.path.join(ROOT, "tests"))

from godot_project import prepare_project  # noqa: E402

DEMO = os.path.join(ROOT, "demo_project")
OUT = os.path.join(ROOT, "build", "experiment_tests")
RUN_LIMIT_S = 400
TRIALS = 12  # 3 tasks, 4 conditions, one counted trial each
KILLED = 1


def start(godot, participant):
    command = [
        godot, "--headless", "--audio-driver", "Dummy", "--path", DEMO, "--fixed-fps", "60", "--",
        "--participant", str(participant), "--things", "1", "--out", os.path.join(OUT, f"participant_{participant}")]
    return subprocess.Popen(command, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                            stdin=subprocess.DEVNULL)


def run(godot, participant):
    process = start(godot, participant)
    try:
        output, _ = process.communicate(timeout=RUN_LIMIT_S)
    except subprocess.TimeoutExpired:
        process.kill()
        output, _ = process.communicate()
    return process.returncode, output


def text_of(participant, name):
    try:
        with open(os.path.join(OUT, f"participant_{participant}", name), encoding="utf-8") as file:
            return file.read()
    except OSError:
        return ""


def rows_of(participant, name):
    return list(csv.DictReader(text_of(participant, name).splitlines()))


def kill_in_a_trial(godot, participant):
    """Lets it finish two trials and kills it in a later one. Returns what was on file then."""
    process = start(godot, participant)
    end = time.monotonic() + RUN_LIMIT_S
    while len(rows_of(participant, "summary.csv")) < 2 and process.poll() is None and time.monotonic() < end:
        time.sleep(0.05)
    time.sleep(0.3)
    process.kill()
    process.communicate()
    # As if the kill had come in the middle of a write, too.
    for name in ("trace.csv", "ratings.csv"):
        with open(os.path.join(OUT, f"participant_{participant}", name), "a", encoding="utf-8") as file:
            file.write("participant-1,pick_and_pl")
    return text_of(participant, "summary.csv")


def check_participant(check, participant, code, output):
    name = f"participant {participant}"
    check(code == 0, f"{name}: exit code {code}\n{output[-1500:]}")
    check("SCRIPT ERROR" not in output, f"{name}: script error\n{output[-1500:]}")
    trials, ratings = rows_of(participant, "summary.csv"), rows_of(participant, "ratings.csv")
    keys = [(row["task"], row["condition"], row["trial"]) for row in trials]
    check(len(keys) == TRIALS == len(set(keys)), f"{name}: trials {keys}")
    check(len(ratings) == TRIALS, f"{name}: {len(ratings)} ratings")
    check(all(row["participant_id"] == str(participant) for row in trials), f"{name}: another's trials")
    check(all(row["completed"] == "1" for row in trials), f"{name}: not completed: {trials}")
    traced = {(row["task"], row["condition"], row["trial"]) for row in rows_of(participant, "trace.csv")}
    check(traced == set(keys), f"{name}: traces of {sorted(traced ^ set(keys))} too many or missing")
    for row in trials:
        forces = float(row["peak_force_n"]) > 0.05
        check(forces == (row["condition"] == "forces_on"), f"{name}: {row['condition']}: {row['peak_force_n']} N")
        check((row["auto_animation"] == "1") == (row["condition"] == "mouse_auto"), f"{name}: {row}")


def check_balance(check, participants):
    """Each condition comes first equally often, in whole rounds of four."""
    firsts = [rows_of(participant, "summary.csv")[0]["condition"] for participant in participants]
    if len(firsts) % 4 == 0:
        counts = {condition: firsts.count(condition) for condition in firsts}
        check(len(counts) == 4 and len(set(counts.values())) == 1, f"first conditions: {counts}")


def check_spreadsheets(check):
    """A file that a German spreadsheet saved (a byte order mark, semicolons, decimal commas) reads like the original."""
    folder = os.path.join(OUT, "spreadsheet")
    os.makedirs(folder, exist_ok=True)
    with open(os.path.join(folder, "summary.csv"), "w", encoding="utf-8-sig", newline="") as file:
        file.write("task;condition;task_time_s;note\r\npick_and_place;mouse;12,5;a, b\r\n")
    sys.path.insert(0, os.path.join(ROOT, "tools", "results"))
    import results

    read = results.read(folder, "summary.csv")
    wanted = [{"task": "pick_and_place", "condition": "mouse", "task_time_s": "12.5", "note": "a, b"}]
    check(read == wanted, f"a spreadsheet's file: {read}")
    shutil.rmtree(folder)


def check_figures(check, python, participants):
    figures = os.path.join(OUT, "results")
    done = subprocess.run([python, os.path.join(ROOT, "tools", "results", "results.py"), OUT, "--out", figures],
                          text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)
    check(done.returncode == 0, f"results: {done.stdout}")
    for name in ("fig17_grasp", "fig18_translation_rotation", "fig19_against_mouse", "time_errors_force"):
        path = os.path.join(figures, name + ".png")
        check(os.path.exists(path) and os.path.getsize(path) > 5000, f"{name}.png is missing")
    with open(os.path.join(figures, "numbers.csv"), encoding="utf-8") as file:
        table = list(csv.DictReader(file))
    trials = [row for who in participants for row in rows_of(who, "summary.csv")]
    ratings = [row for who in participants for row in rows_of(who, "ratings.csv")]
    for row in table:
        rows = trials if row["figure"] == "trials" else ratings
        here = [one for one in rows if (one["task"], one["condition"]) == (row["task"], row["condition"])]
        if row["measure"] == "errors":
            values = [float(one["drops"]) + float(one["wrong_placements"]) for one in here]
        else:
            values = [float(one[row["measure"]]) for one in here if one[row["measure"]]]
        if row["figure"] == "satisfied_pct":
            values = [100.0 if value >= 4 else 0.0 for value in values]
        check(int(row["count"]) == len(values), f"numbers.csv: count of {row}")
        if values:
            check(abs(float(row["mean"]) - statistics.fmean(values)) < 1e-6, f"numbers.csv: mean of {row}")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("godot")
    parser.add_argument("python")
    parser.add_argument("--participants", type=int, default=12)
    arguments = parser.parse_args()
    prepare_project(DEMO, arguments.godot)
    shutil.rmtree(OUT, ignore_errors=True)
    counts = [0, 0]

    def check(condition, message):
        counts[0 if condition else 1] += 1
        if not condition:
            print(f"FAIL {message}")

    participants = list(range(1, arguments.participants + 1))
    before = kill_in_a_trial(arguments.godot, KILLED)
    check(len(before.splitlines()) >= 3, "the killed run had finished fewer than two trials")
    with ThreadPoolExecutor(max_workers=os.cpu_count() or 1) as pool:
        ended = list(pool.map(lambda who: run(arguments.godot, who), participants))
    check(text_of(KILLED, "summary.csv").startswith(before), "a finished trial was lost or changed by the kill")
    for participant, (code, output) in zip(participants, ended):
        check_participant(check, participant, code, output)
    check_balance(check, participants)
    check_spreadsheets(check)
    check_figures(check, arguments.python, participants)
    print(f"{counts[0]} passed, {counts[1]} failed")
    return 1 if counts[1] else 0


if __name__ == "__main__":
    sys.exit(main())
