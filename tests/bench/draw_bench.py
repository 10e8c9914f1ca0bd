#!/usr/bin/env python3
"""draw_bench.py FOLDER [motions]: fk.png, tension.png and step.png, or motions.png alone, beside the JSON files of
run_bench.py. Needs matplotlib.

Time against error, a panel a set. Best is the lower left corner. Of several builds of a method, the fastest is shown.
"""

import os
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
from matplotlib.lines import Line2D  # noqa: E402
from matplotlib.ticker import FuncFormatter, LogLocator, NullLocator  # noqa: E402

import bench_rows  # noqa: E402

# Name in the legend: start of the method's name, mode or None, colour, marker.
FK_METHODS = {
    "ours, warm": ("ours", "warm", "#d62728", "*"),
    "ours, cold": ("ours", "cold", "#ff9896", "*"),
    "plain Gauss-Newton, 1 step": ("ours, plain", "1 step", "#1f77b4", "v"),
    "plain Gauss-Newton, 2 steps": ("ours, plain", "2 steps", "#1f77b4", "s"),
    "plain Gauss-Newton, 3 steps": ("ours, plain", "3 steps", "#1f77b4", "^"),
    "dense damped, 1e-3, 2 steps": ("dense damped Gauss-Newton 1e-3", None, "#8c564b", "o"),
    "dense damped, 1e-9, 2 steps": ("dense damped Gauss-Newton 1e-9", None, "#8c564b", "D"),
    "paper, polynomial division": ("paper, polynomial division", None, "#2ca02c", "P"),
    "paper, cubic": ("paper, cubic", None, "#2ca02c", "X"),
    "trigonometric closed form": ("closed form, upright pair", None, "#9467bd", "d"),
    "closed form, best of 4 branches": ("closed form, best of four", None, "#9467bd", "h"),
}
TENSION_METHODS = {
    "ours, AVX2": ("ours, AVX2", None, "#d62728", "*"),
    "ours, SSE2": ("ours, 16-byte vectors", None, "#ff9896", "*"),
    "ours, safe search alone": ("ours, safe search", None, "#e377c2", "s"),
    "DAQP 0.11.0, fastest build": ("DAQP", None, "#1f77b4", "o"),
    "eiquadprog": ("eiquadprog", None, "#2ca02c", "D"),
    "quadprog": ("quadprog", None, "#9467bd", "P"),
    "qpOASES": ("qpOASES", None, "#8c564b", "X"),
    "bounded least squares, QR": ("bounded least squares", None, "#17becf", "^"),
    "clamp": ("clamp", None, "#7f7f7f", "v"),
    "projected Gauss-Seidel": ("projected Gauss-Seidel", None, "#bcbd22", "h"),
}
# Errors below this are drawn at it; above (or without bound) at the other.
SCALES = {"fk": (1e-16, 1e1, "m, grip centre and pole ends"), "tension": (1e-16, 1e2, "N, any string")}


def save(figure, folder, name):
    # The same data give the same bytes: no name of a version inside.
    path = os.path.join(folder, name + ".png")
    figure.savefig(path, dpi=100, metadata={"Software": None})
    plt.close(figure)
    print(path)


def panel(axis, rows, of_set, mode, methods, scale, peer_ns):
    low, high, _ = scale
    drawn = []
    for begin, own_mode, colour, marker in methods.values():
        row = bench_rows.find(rows, begin, of_set, own_mode or mode) if own_mode or mode else \
            next((r for r in rows if r["method"].startswith(begin) and r["set"] == of_set), None)
        if row is None:
            continue
        error = high if row["worst_error"] is None else min(max(row["worst_error"], low), high)
        drawn.append(error)
        failed = row["failures"] > 0
        axis.plot([1e-3 * row["median_ns"], 1e-3 * row["p999_ns"]], [error, error], color=colour, linewidth=1, alpha=0.6)
        axis.plot(1e-3 * row["median_ns"], error, marker=marker, color=colour, linestyle="none",
                  markersize=15 if marker == "*" else 8, markerfacecolor="white" if failed else colour,
                  zorder=3 if marker == "*" else 2)
    if peer_ns:
        axis.axvline(1e-3 * peer_ns, color="#1f77b4", linestyle="--", linewidth=1)
    axis.set_xscale("log")
    axis.set_yscale("log")
    axis.set_ylim(min(drawn) / 10, max(drawn) * 10)
    axis.xaxis.set_major_locator(LogLocator(subs=(1, 2, 5)))
    axis.xaxis.set_major_formatter(FuncFormatter(lambda us, _place: f"{us:g}"))
    axis.xaxis.set_minor_locator(NullLocator())
    axis.grid(True, which="major", color="#dddddd", linewidth=0.6)
    axis.set_axisbelow(True)


def errors_against_times(folder, problem, panels, methods, title, peer):
    """peer: text and function of the rows, the time of something to compare with; or None."""
    rows = bench_rows.read_rows(os.path.join(folder, problem + ".json"))
    panels = [entry for entry in panels if any(row["set"] == entry[0] for row in rows)]
    columns = 3
    lines = -(-len(panels) // columns)
    figure, axes = plt.subplots(lines, columns, figsize=(13, 3.6 * lines + 1.3), sharex=True, squeeze=False)
    for axis in axes.flat[len(panels):]:
        axis.set_visible(False)
    for axis, (of_set, mode, text) in zip(axes.flat, panels):
        panel(axis, rows, of_set, mode, methods, SCALES[problem], peer and peer[1](rows))
        axis.set_title(text, fontsize=10)
        axis.tick_params(axis="x", labelbottom=True)
        axis.set_xlabel("time of one solution (\u00b5s)")
        axis.set_ylabel(f"worst error ({SCALES[problem][2]})", fontsize=9)
    figure.suptitle(title, fontsize=12)
    figure.legend(handles=marks(methods, peer and peer[0]), loc="lower center", ncol=4, fontsize=9, frameon=False)
    legend_lines = -(-(len(methods) + 3) // 4)
    figure.tight_layout(rect=(0, (0.21 * legend_lines + 0.15) / figure.get_figheight(), 1, 0.99))
    save(figure, folder, problem)


def marks(methods, peer_text):
    found = [Line2D([], [], color=colour, marker=marker, linestyle="none",
                    markersize=13 if marker == "*" else 8, label=name)
             for name, (_, _, colour, marker) in methods.items()]
    found.append(Line2D([], [], color="#555555", linewidth=1, label="line: from the median to p99.9"))
    found.append(Line2D([], [], color="#555555", marker="o", markerfacecolor="white", linestyle="none",
                        markersize=8, label="hollow: failed in some cases"))
    if peer_text:
        found.append(Line2D([], [], color="#1f77b4", linestyle="--", linewidth=1, label=peer_text))
    return found


def warm_daqp_ns(rows):
    row = bench_rows.find(rows, bench_rows.DAQP, "S2 shipped", "warm")
    return row and row["median_ns"]


def draw_step(folder):
    rows = [row for row in bench_rows.read_rows(os.path.join(folder, "step.json")) if row["set"] == "step"]
    peer = bench_rows.find(bench_rows.read_rows(os.path.join(folder, "step.json")), bench_rows.DAQP,
                           "S2 shipped", "warm")
    figure, axis = plt.subplots(figsize=(10, 0.42 * len(rows) + 1.6))
    names = [row["method"] + ("" if row["mode"] == "-" else f" ({row['mode']})") for row in rows]
    places = range(len(rows))
    axis.barh(places, [row["median_ns"] for row in rows], color="#d62728", height=0.6, label="ours, median")
    for place, row in zip(places, rows):
        axis.plot([row["median_ns"], row["p999_ns"]], [place, place], color="black", linewidth=1,
                  label="to p99.9" if place == 0 else None)
        axis.text(max(row["median_ns"], row["p999_ns"]), place, f"  {row['median_ns']:.0f} ns", va="center",
                  fontsize=8)
    if peer:
        axis.axvline(peer["median_ns"], color="#1f77b4", linestyle="--",
                     label="DAQP 0.11.0: one warm tension solve")
    axis.set_yticks(list(places), names, fontsize=9)
    axis.invert_yaxis()
    axis.set_xlabel("time (ns); a servo cycle at 1 kHz has 1,000,000")
    axis.set_title("One servo step, and its parts")
    axis.margins(x=0.12)
    axis.legend(loc="lower right", fontsize=9)
    axis.grid(True, axis="x", color="#dddddd", linewidth=0.6)
    axis.set_axisbelow(True)
    figure.tight_layout()
    save(figure, folder, "step")


MOTIONS = {"planes of the game": ("#1f77b4", "o"), "real shapes": ("#d62728", "*"), "without a game": ("#2ca02c", "D")}


def draw_motions(folder):
    """Time against error; a mark a frame rate, the larger the faster the game."""
    rows = bench_rows.read_rows(os.path.join(folder, "motions.json"))
    names = list(dict.fromkeys(row["set"].rpartition(", ")[0] for row in rows))
    panels = [(name, "force") for name in names] + [(names[-1], "moment")]
    figure, axes = plt.subplots(2, 3, figsize=(13, 8))
    least = {"force": 1e-5, "moment": 1e-6}
    for axis, (name, mode) in zip(axes.flat, panels):
        for method, (colour, marker) in MOTIONS.items():
            for row in rows:
                if row["method"] != method or row["mode"] != mode or row["set"].rpartition(", ")[0] != name:
                    continue
                rate = row["set"].rpartition(", ")[2].partition(" ")[0]
                size = 6 + (float(rate) / 12 if rate.isdigit() else 4)
                error = max(row["worst_error"], least[mode])
                axis.plot([1e-3 * row["median_ns"], 1e-3 * row["p99_ns"]], [error, error], color=colour, linewidth=1, alpha=0.4)
                axis.plot(1e-3 * row["median_ns"], error, marker=marker, color=colour, linestyle="none", markersize=size,
                          markerfacecolor="none" if rate.isdigit() else colour)
        axis.set_xscale("log")
        axis.set_yscale("log")
        axis.set_title(f"{name}: {mode}", fontsize=10)
        axis.set_xlabel("time of one servo cycle (\u00b5s)")
        axis.set_ylabel("error, root mean square (" + {"force": "N", "moment": "N m"}[mode] + ")", fontsize=9)
        axis.grid(True, which="major", color="#dddddd", linewidth=0.6)
        axis.set_axisbelow(True)
    marks_of = [Line2D([], [], color=colour, marker=marker, linestyle="none", markersize=9, label=method)
                for method, (colour, marker) in MOTIONS.items()]
    marks_of.append(Line2D([], [], color="#555555", marker="o", markerfacecolor="none", linestyle="none", markersize=7,
                           label="size: games of 30, 60, 90 and 144 frames a second"))
    marks_of.append(Line2D([], [], color="#555555", linewidth=1, label="line: from the median to p99"))
    axes.flat[-1].axis("off")
    axes.flat[-1].legend(handles=marks_of, loc="center", fontsize=10, frameon=False)
    figure.suptitle("What the hand feels of shapes: time against error (best: lower left)", fontsize=12)
    figure.tight_layout(rect=(0, 0, 1, 0.98))
    save(figure, folder, "motions")


def main():
    folder = sys.argv[1]
    if sys.argv[2:] == ["motions"]:
        draw_motions(folder)
        return
    errors_against_times(
        folder, "fk",
        [("T1 clean", None, "exact lengths"), ("T1 counts", None, "lengths in encoder counts of 0.025 mm"),
         ("T1 0.1 mm", None, "0.1 mm noise"), ("T1 1 mm", None, "1 mm noise"), ("T1 3 mm", None, "3 mm noise")],
        FK_METHODS, "Pose from eight string lengths: time against error along trajectory T1 (best: lower left)",
        ("DAQP 0.11.0: one warm tension solve", warm_daqp_ns))
    errors_against_times(
        folder, "tension",
        [("S2 shipped", "warm", "S2 at the shipped settings, warm"), ("S2", "warm", "S2, ridge 1e-6, warm"),
         ("S1", "cold", "S1 random feasible, cold"), ("S3", "cold", "S3 saturated, cold"),
         ("S4a", "cold", "S4a rank-deficient"), ("S4b", "cold", "S4b zero wrench"),
         ("S4c", "cold", "S4c ridge 1e-12"), ("S4d", "cold", "S4d one to three broken strings"),
         ("S4e", "cold", "S4e rank-deficient, ridge 1e-12")],
        TENSION_METHODS, "Tensions of eight strings for a wrench: time against error (best: lower left)", None)
    draw_step(folder)


if __name__ == "__main__":
    main()
