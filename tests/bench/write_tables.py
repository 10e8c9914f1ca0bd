#!/usr/bin/env python3
"""write_tables.py RESULTS PAGE: puts the tables of a bench's results between the marks of PAGE,
<!-- bench NAME --> and <!-- end -->. Nothing else of the page changes."""

import os
import re
import sys

import bench_rows
from bench_rows import DAQP, find

MARK = re.compile(r"(<!-- bench (\w+) -->\n)(.*?)(<!-- end -->)", re.DOTALL)
SETS = (
    ("S2 shipped", "warm", "S2, a 1 kHz trajectory, at the shipped settings"),
    ("S2", "warm", "S2, ridge 1e-6"),
    ("S1", "cold", "S1, random and feasible"),
    ("S3", "cold", "S3, saturated"),
    ("S4a", "cold", "S4a, rank-deficient"),
    ("S4b", "cold", "S4b, zero wrench"),
    ("S4c", "cold", "S4c, ridge 1e-12"),
    ("S4d", "cold", "S4d, one to three broken strings"),
    ("S4e", "cold", "S4e, rank-deficient and ridge 1e-12"),
)
POSES = (
    ("ours", "warm"), ("ours", "cold"), ("ours, plain", "1 step"), ("ours, plain", "2 steps"),
    ("ours, plain", "3 steps"), ("dense damped Gauss-Newton 1e-3", "2 steps"),
    ("dense damped Gauss-Newton 1e-9", "2 steps"), ("paper, polynomial division", "cold"), ("paper, cubic", "cold"),
    ("closed form, upright pair", "cold"), ("closed form, best of four", "cold"),
)


def number(value, form):
    return "-" if value is None else form.format(value)


def table(header, lines):
    rule = "|".join("---" for _ in header)
    return "\n".join(f"| {' | '.join(cells)} |" for cells in (header,)) + f"\n|{rule}|\n" + \
        "".join(f"| {' | '.join(cells)} |\n" for cells in lines)


def error_and_failures(row):
    if row is None:
        return "-"
    error = number(row["worst_error"], "{:.0e}") if row["worst_error"] is not None else "no bound"
    return error + (f", {row['failures']} failed" if row["failures"] else "")


def tension(results):
    """Three tables: our builds and DAQP's time, the other peers, the errors."""
    rows = results["tension"]
    builds = [(method, text) for method, text in (("ours, AVX2", "AVX2"), ("ours, 16-byte vectors", "SSE2"))
              if find(rows, method, "S1", "cold")]
    others = (("bounded least squares", "QR"), ("eiquadprog", "eiquadprog"), ("quadprog", "quadprog"),
              ("qpOASES", "qpOASES"))
    ratio = lambda row: number(row and row["ratio_to_daqp"], "{:.2f}")  # noqa: E731
    times, peers, errors = [], [], []
    for of_set, mode, text in SETS:
        name = f"{text}, {mode}"
        row_of = [find(rows, method, of_set, mode) for method, _ in builds]
        peer = find(rows, DAQP, of_set, mode)
        best = min(row_of, key=lambda row: row["median_ns"])
        times.append([name, *(ratio(row) for row in row_of), number(peer and peer["median_ns"], "{:.0f}")])
        peers.append([name, *(ratio(find(rows, method, of_set, mode)) for method, _ in others)])
        errors.append([name, error_and_failures(best), error_and_failures(peer)])
    return (table(["set", *(f"ours, {text} (ratio)" for _, text in builds), "DAQP's median (ns)"], times) + "\n" +
            table(["set", *(f"{text} (ratio)" for _, text in others)], peers) + "\n" +
            table(["set", "worst error, ours (N)", "worst error, DAQP (N)"], errors))


def fk(results):
    """Two tables: lengths without and with noise."""
    rows = results["fk"]
    parts = []
    for sets in ((("T1 clean", "exact lengths"), ("T1 counts", "encoder counts")),
                 (("T1 0.1 mm", "0.1 mm of noise"), ("T1 1 mm", "1 mm of noise"), ("T1 3 mm", "3 mm of noise"))):
        lines = []
        for method, mode in POSES:
            cells = [f"{method}, {mode}"]
            for of_set, _ in sets:
                row = next((one for one in rows if bench_rows.key(one) == (method, of_set, mode)), None)
                cells.append("-" if row is None else f"{row['median_ns']:.0f}; {error_and_failures(row)}")
            lines.append(cells)
        parts.append(table(["method", *(f"{text} (ns; m)" for _, text in sets)], lines))
    return "\n".join(parts)


def step(results):
    lines = []
    for row in results["step"]:
        if row["set"] == "step":
            name = row["method"] + ("" if row["mode"] == "-" else ", " + row["mode"])
            lines.append([name, number(row["median_ns"] / 1e3, "{:.2f}"), number(row["p999_ns"] / 1e3, "{:.2f}"),
                          number(row["ratio_to_daqp"], "{:.2f}")])
    return table(["part", "median (µs)", "p99.9 (µs)", "median / DAQP's warm solve"], lines)


def contacts(results):
    rows = results["contacts"]
    methods = list(dict.fromkeys(row["method"] for row in rows))
    lines = []
    for of_set in dict.fromkeys(row["set"] for row in rows):
        cells = [of_set]
        for method in methods:
            gap, normal = (find(rows, method, of_set, mode) for mode in ("gap (m)", "normal (rad)"))
            if gap is None:
                cells.append("-")
            elif "sliding" in of_set:  # its error is that against a fresh answer of ours; stress_shapes has the true one
                cells.append(f"{gap['median_ns']:.0f} (p99.9 {gap['p999_ns']:.0f})")
            else:
                wrong = f"; {gap['failures']} wrong" if gap["failures"] else ""
                cells.append(f"{gap['median_ns']:.0f}; {gap['worst_error']:.0e} m, {normal['worst_error']:.0e} rad{wrong}")
        lines.append(cells)
    return table(["pair", *(f"{method} (ns; m, rad)" for method in methods)], lines)


def fill(page, folder):
    """The page with its tables made anew from a folder of results."""
    results = {problem: bench_rows.read_rows(os.path.join(folder, problem + ".json"))
               for problem in bench_rows.PROBLEMS + bench_rows.APART}
    with open(os.path.join(folder, "bars.md"), encoding="utf-8") as file:
        bars = file.read()
    tables = {"bars": bars, "tension": tension(results), "fk": fk(results), "step": step(results),
              "contacts": contacts(results)}
    return MARK.sub(lambda found: found[1] + tables[found[2]] + found[4], page)


def main():
    folder, path = sys.argv[1:3]
    with open(path, encoding="utf-8") as file:
        page = file.read()
    with open(path, "w", encoding="utf-8") as file:
        file.write(fill(page, folder))


if __name__ == "__main__":
    main()
