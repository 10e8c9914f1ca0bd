#!/usr/bin/env python3
"""The Z-width plot from what stiffness_limit --csv wrote: plot_z_width.py Z_WIDTH.CSV OUT.PNG"""

import csv
import sys

import matplotlib

matplotlib.use("Agg")
from matplotlib import pyplot  # noqa: E402

STYLES = {"plain": "o--", "resonance observer": "s-.", "shipped": "D-"}
LABELS = {
    "plain": "plain spring-damper, 60 Hz velocity filter",
    "resonance observer": "with resonance observer",
    "shipped": "shipped: with delay compensation too",
}


def main(source, target):
    lines = {}
    with open(source, newline="", encoding="utf-8") as file:
        for row in csv.DictReader(file):
            point = (float(row["damping_n_s_m"]), float(row["limit_n_m"]))
            lines.setdefault(row["renderer"], []).append(point)
    figure, axes = pyplot.subplots(figsize=(7, 4.2), dpi=110)
    for name, points in lines.items():
        axes.plot(*zip(*points), STYLES[name], label=LABELS[name])
    axes.axhline(900, color="0.6", linewidth=1, linestyle=":", label="wanted: 900 N/m")
    axes.set_xlabel("damping of the wall (N s/m)")
    axes.set_ylabel("stiffest still wall (N/m), worst of three hands")
    axes.set_ylim(bottom=0)
    axes.set_title("Z-width of a plane along x: 1 kHz, 1 ms latency, no friction", fontsize=10)
    axes.grid(alpha=0.3)
    axes.legend(fontsize=8)
    figure.tight_layout()
    figure.savefig(target)


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(*sys.argv[1:])
