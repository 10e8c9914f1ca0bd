"""Rows of spidar_bench: read, combined over several runs, and set against the bars of the project."""

import csv
import json
import statistics

PROBLEMS = ("fk", "tension", "step")
APART = ("contacts", "motions")  # ./dev bench NAME of the first runs them; no bar is set for them
FIGURES = ("median_ns", "p99_ns", "p999_ns", "max_ns", "ratio_to_daqp", "worst_error")
COLUMNS = ("method", "set", "mode", *FIGURES, "failures")
DAQP = "DAQP"


def read_rows(path):
    with open(path, encoding="utf-8") as file:
        return [json.loads(line) for line in file if line.strip()]


def write_rows(rows, json_path, csv_path):
    with open(json_path, "w", encoding="utf-8") as file:
        file.writelines(json.dumps(row) + "\n" for row in rows)
    with open(csv_path, "w", encoding="utf-8", newline="") as file:
        table = csv.DictWriter(file, COLUMNS, lineterminator="\n")
        table.writeheader()
        table.writerows(rows)


def key(row):
    return row["method"], row["set"], row["mode"]


def combine(runs):
    """One list of rows from those of several runs: times and ratios are medians over the runs, errors and
    failures the worst. A figure that one run lacks (null) is lacking."""
    if any([key(row) for row in rows] != [key(row) for row in runs[0]] for rows in runs):
        raise ValueError("the runs have different rows: they are of different builds")
    combined = []
    for same in zip(*runs):
        row = {name: same[0][name] for name in ("method", "set", "mode")}
        for name in FIGURES:
            values = [one[name] for one in same]
            worst_of = max if name == "worst_error" else statistics.median
            row[name] = None if None in values else worst_of(values)
        row["failures"] = max(one["failures"] for one in same)
        combined.append(row)
    return combined


def find(rows, method, of_set, mode):
    """The row of a method whose name starts so; of several, the one with the least median."""
    found = [row for row in rows
             if row["method"].startswith(method) and row["set"] == of_set and row["mode"] == mode]
    return min(found, key=lambda row: row["median_ns"], default=None)


def quotient(above, below, name="median_ns"):
    if above is None or below is None or not below[name]:
        return None
    return above[name] / below[name]


# --- The bars: what is asked of each, how it is measured -------------------------------------------------------------


def to_daqp(problem, method, of_set, mode):
    def figure(runs):
        row = find(runs[problem], method, of_set, mode)
        return row and row["ratio_to_daqp"]
    return figure


def tail_to_daqp(of_set, mode):
    def figure(runs):
        rows = runs["tension"]
        return quotient(find(rows, "ours", of_set, mode), find(rows, DAQP, of_set, mode), "p999_ns")
    return figure


def to_method(problem, method, of_set, mode, other, other_mode):
    def figure(runs):
        rows = runs[problem]
        return quotient(find(rows, method, of_set, mode), find(rows, other, of_set, other_mode))
    return figure


BARS = (
    ("warm pose on quantised lengths / DAQP's warm solve", 0.25, to_daqp("fk", "ours", "T1 counts", "warm")),
    ("cold pose on quantised lengths / DAQP's cold S1 solve", 0.7, to_daqp("fk", "ours", "T1 counts", "cold")),
    ("cold pose on exact lengths / DAQP's cold S1 solve", 0.7, to_daqp("fk", "ours", "T1 clean", "cold")),
    ("tensions, S2 shipped warm / DAQP", 0.22, to_daqp("tension", "ours", "S2 shipped", "warm")),
    ("the same, p99.9 / p99.9", 0.4, tail_to_daqp("S2 shipped", "warm")),
    ("tensions, S2 warm, ridge 1e-6 / DAQP", 0.20, to_daqp("tension", "ours", "S2", "warm")),
    ("the same, p99.9 / p99.9", 0.4, tail_to_daqp("S2", "warm")),
    ("tensions, S1 cold / DAQP", 0.25, to_daqp("tension", "ours", "S1", "cold")),
    ("the same, p99.9 / p99.9", 1.0, tail_to_daqp("S1", "cold")),
    ("tensions, S3 cold / DAQP", 0.145, to_daqp("tension", "ours", "S3", "cold")),
    ("step at rest with nothing new / whole step, 4 contacts", 0.05,
     to_method("step", "step, nothing asked", "step", "at rest", "step, wrench and 4 contacts", "moving")),
    ("tensions, forces alone (DOF mask) / all DOF", 0.5,
     to_method("step", "forces alone, tension solver", "step", "warm", "tension solver", "warm")),
    ("a servo cycle with recording / without", 1.15, to_method("step", "cycle", "recording", "on", "cycle", "off")),
)


def judge(all_runs):
    """all_runs: one {problem: rows} a run. For each bar (text, bar, median figure or None)."""
    verdicts = []
    for text, bar, figure in BARS:
        values = [figure(runs) for runs in all_runs]
        verdicts.append((text, bar, None if None in values else statistics.median(values)))
    return verdicts
