#!/usr/bin/env python3
"""Figures of an experiment: python3 results.py FOLDER [--out FOLDER]

FOLDER holds one folder a participant, or is one, with the demo's summary.csv, trace.csv and ratings.csv. Written to
OUT (FOLDER/results): figures in the manner of the paper's Figs 17 to 19, of time, errors and peak force, and
numbers.csv with every number that a figure shows.
"""

import argparse
import csv
import math
import os
import re
import statistics
import sys

TASKS = ("pick_and_place", "robot_linking", "match_linking")
CONDITIONS = ("forces_on", "forces_off", "mouse", "mouse_auto")
ASPECTS = ("grasp", "translation", "rotation", "overall", "against_mouse")
COLOURS = {"forces_on": "#e0694f", "forces_off": "#e3ae3c", "mouse": "#4f83d1", "mouse_auto": "#9a6bb8"}
# What the paper reports of its 12 subjects (section 7.2): 60 to 70 % in the match task, 80 % overall.
PAPER_MATCHES = (60.0, 70.0)
PAPER_OVERALL = 80.0
NOT_COMPARABLE = "dotted: the paper's 60-70 % (matches) and 80 % (overall); other device, tasks and people: not comparable"
DECIMAL_COMMA = re.compile(r"^(-?\d*),(\d+(?:[eE][-+]?\d+)?)$")
SATISFIED_FROM = 4  # of 5: "good" and "best"


def read(folder, name):
    """The rows of all files of this name below folder; a torn last line, left by a killed run, is not one."""
    rows = []
    for place, _, names in sorted(os.walk(folder)):
        if name not in names:
            continue
        with open(os.path.join(place, name), encoding="utf-8-sig", newline="") as file:
            text = file.read()
        rows += rows_of(text[: text.rfind("\n") + 1])
    return rows


def rows_of(text):
    """The rows of a CSV file, also of one that a spreadsheet saved where the comma is the decimal mark: fields are then
    parted by semicolons, and 0,5 is read as 0.5."""
    lines = text.splitlines()
    if not lines or lines[0].count(";") <= lines[0].count(","):
        return list(csv.DictReader(lines))
    return [{key: DECIMAL_COMMA.sub(r"\1.\2", value) if value else value for key, value in row.items()}
            for row in csv.DictReader(lines, delimiter=";")]


def numbers_of(rows, column, **where):
    return [
        float(row[column]) for row in rows
        if row.get(column) and all(row[key] == value for key, value in where.items())]


def mean_and_error(values):
    """Mean and standard error; NaN where there is nothing."""
    if not values:
        return math.nan, math.nan
    error = statistics.stdev(values) / math.sqrt(len(values)) if len(values) > 1 else 0.0
    return statistics.fmean(values), error


def summarize(trials, ratings):
    """[(figure, task, condition, measure, count, mean, standard error)]"""
    whole = [row for row in trials if row["completed"] == "1"]
    for row in trials:
        row["errors"] = str(sum(int(row[key] or 0) for key in ("drops", "wrong_placements")))
    table = []
    for task in TASKS:
        for condition in CONDITIONS:
            key = {"task": task, "condition": condition}
            for measure, rows in (("task_time_s", whole), ("errors", trials), ("peak_force_n", trials)):
                values = numbers_of(rows, measure, **key)
                table.append(("trials", task, condition, measure, len(values), *mean_and_error(values)))
            for aspect in ASPECTS:
                values = numbers_of(ratings, aspect, **key)
                satisfied = [100.0 * (value >= SATISFIED_FROM) for value in values]
                table.append(("ratings", task, condition, aspect, len(values), *mean_and_error(values)))
                table.append(("satisfied_pct", task, condition, aspect, len(values), *mean_and_error(satisfied)))
    return table


def pick(table, figure, task, condition, measure):
    for row in table:
        if row[:4] == (figure, task, condition, measure):
            return row[5], row[6]
    return math.nan, math.nan


def draw(table, out):
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    def bars(axes, figure, measure, title, unit):
        width = 0.8 / len(CONDITIONS)
        rows = {}
        for condition in CONDITIONS:
            values = [(place, *pick(table, figure, task, condition, measure)) for place, task in enumerate(TASKS)]
            values = [one for one in values if not math.isnan(one[1])]  # the mouse is not compared with itself
            if values:
                rows[condition] = values
        for index, (condition, values) in enumerate(rows.items()):
            beside = (index - 0.5 * (len(rows) - 1)) * width
            axes.bar([place + beside for place, _, _ in values], [value for _, value, _ in values],
                     width, yerr=[error for _, _, error in values], color=COLOURS[condition],
                     label=condition.replace("_", " "), capsize=2)
        axes.set_ylim(0, None if any(value > 0 for values in rows.values() for _, value, _ in values) else 1)
        axes.set_xticks(range(len(TASKS)), [task.replace("_", " ") for task in TASKS])
        axes.set_title(title)
        axes.set_ylabel(unit)

    def paper_lines(axes):
        axes.axhspan(*PAPER_MATCHES, xmin=2 / 3, color="grey", alpha=0.25, linestyle=":")
        axes.axhline(PAPER_OVERALL, color="grey", linestyle=":")
        axes.set_ylim(0, 105)

    def save(figure, name, note=""):
        handles, labels = max((axes.get_legend_handles_labels() for axes in figure.axes), key=lambda both: len(both[0]))
        figure.legend(handles, labels, fontsize=8, ncol=len(CONDITIONS), loc="upper center", frameon=False)
        if note:
            figure.text(0.5, 0.005, note, ha="center", fontsize=7)
        figure.tight_layout(rect=(0, 0.03, 1, 0.94))
        figure.savefig(os.path.join(out, name), dpi=110)
        pyplot.close(figure)

    for name, aspects in (
        ("fig17_grasp.png", ("grasp",)), ("fig18_translation_rotation.png", ("translation", "rotation")),
        ("fig19_against_mouse.png", ("against_mouse", "overall")),
    ):
        figure, axes = pyplot.subplots(1, len(aspects), figsize=(6.5 * len(aspects), 4.2), squeeze=False)
        for place, aspect in zip(axes[0], aspects):
            bars(place, "satisfied_pct", aspect, aspect.replace("_", " "), "satisfied (4 or 5 of 5), %")
            paper_lines(place)
        save(figure, name, NOT_COMPARABLE)
    figure, axes = pyplot.subplots(1, 3, figsize=(16, 4.2))
    for place, (measure, title, unit) in zip(axes, (
        ("task_time_s", "Time of completed trials", "s"), ("errors", "Drops and wrong placements", "a trial"),
        ("peak_force_n", "Peak force given", "N"),
    )):
        bars(place, "trials", measure, title, unit)
    save(figure, "time_errors_force.png", "bars: standard error of the mean")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder")
    parser.add_argument("--out", default="")
    arguments = parser.parse_args()
    out = arguments.out or os.path.join(arguments.folder, "results")
    trials, ratings = read(arguments.folder, "summary.csv"), read(arguments.folder, "ratings.csv")
    if not trials:
        print(f"results: no summary.csv with a trial below {arguments.folder}", file=sys.stderr)
        return 1
    os.makedirs(out, exist_ok=True)
    table = summarize(trials, ratings)
    with open(os.path.join(out, "numbers.csv"), "w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(["figure", "task", "condition", "measure", "count", "mean", "standard_error"])
        writer.writerows(table)
    draw(table, out)
    people = {row["participant_id"] for row in trials}
    print(f"results: {len(people)} participants, {len(trials)} trials, {len(ratings)} ratings: {out}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
