#!/usr/bin/env python3
"""draw.py CSV_FOLDER PICTURE_FOLDER: the pictures of docs/why/paper_reproduction.md. Needs matplotlib."""

import os
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

from tables import Tables  # noqa: E402

TENSIONS = {20: ("#cc6677", 5), 10: ("#228833", 3), 5: ("#4477aa", 1.4)}  # N: colour, line width
PAPER = {"color": "black", "marker": "x", "linestyle": "none", "label": "the paper"}
CAPACITY = "capacity: displayed / target"


def save(figure, folder, name):
    # The same data give the same bytes: no name of a version inside.
    figure.savefig(os.path.join(folder, name + ".png"), dpi=90, metadata={"Software": None})
    plt.close(figure)
    print(os.path.join(folder, name + ".png"))


def closure_map(tables, folder):
    planes = (
        ("x_y", "x (cm)", "y (cm)", "z = 0, upright"),
        ("x_z", "x (cm)", "z (cm)", "y = 0, upright"),
        ("y_z", "y (cm)", "z (cm)", "x = 0, upright"),
        ("rx_ry", "rotation about X (degrees)", "rotation about Y (degrees)", "at the centre, Ry Rx"),
        ("rx_rz", "rotation about X (degrees)", "rotation about Z (degrees)", "at the centre, Rz Rx"),
        ("rz_grasp", "rotation about Z (degrees)", "grasp angle (degrees)", "at the centre"),
    )
    figure, axes = plt.subplots(2, 3, figsize=(12, 7.6), constrained_layout=True)
    for axis, (plane, u_name, v_name, title) in zip(axes.flat, planes):
        u, v, margin, closed = tables.columns("closure_map", "u", "v", "margin", "closed",
                                              plane=plane)
        side = round(len(u) ** 0.5)
        grid = [[max(0.0, margin[i * side + j]) if closed[i * side + j] else float("nan")
                 for i in range(side)] for j in range(side)]
        edge = max(u) + 0.5 * (max(u) - min(u)) / (side - 1)
        image = axis.imshow(grid, origin="lower", extent=(-edge, edge, -edge, edge), vmin=0,
                            vmax=1, cmap="viridis", aspect="equal", interpolation="nearest")
        axis.set_facecolor("#dddddd")
        axis.set_xlabel(u_name)
        axis.set_ylabel(v_name)
        axis.set_title(title, fontsize=10)
    bar = figure.colorbar(image, ax=axes, shrink=0.85)
    bar.set_label("closure margin: smallest / largest tension of the null vector")
    figure.suptitle("Vector closure. Coloured: theory 2 holds (any wrench, given tension enough). "
                    "Grey: only theory 1 (8 strings > 7 DOF).", fontsize=11)
    save(figure, folder, "closure_map")


def connections(tables, folder):
    rows = tables.rows("connections")
    figure, axis = plt.subplots(figsize=(9, 4.6), constrained_layout=True)
    for closed, colour, size, text in (("0", "#bbbbbb", 8, "no vector closure at the centre"),
                                       ("1", "#4477aa", 26, "vector closure at the centre")):
        picked = [row for row in rows if row["closed"] == closed]
        axis.scatter([int(row["place"]) for row in picked],
                     [max(float(row["determinant"]), 1e-3) for row in picked],
                     s=size, color=colour, label=f"{text} ({len(picked)})")
    paper = next(row for row in rows if row["of_paper"] == "1")
    axis.scatter([int(paper["place"])], [float(paper["determinant"])], s=120, marker="x",
                 color="black", label=f"the paper's: {paper['strings']}", zorder=3)
    axis.set_yscale("log")
    axis.set_xlabel("connection, sorted by determinant (of 2,520)")
    axis.set_ylabel("det(A A$^T$), moments / d (dimensionless)\n0 is drawn at 0.001")
    axis.legend()
    axis.set_title("Which two strings at each pole end: all 2,520 ways, grip at rest")
    save(figure, folder, "connections")


def table1(tables, folder):
    names = (("m1_cm", "M1, the paper", "x-", "#999999"), ("m2_cm", "M2, the paper's column", "x-", "black"),
             ("m2_equation_cm", "M2 by its printed equation", "s--", "#cc6677"),
             ("affine_cm", "our affine fit", "o-", "#4477aa"),
             ("winding_cm", f"our winding curve, degree {tables.figures['table1/winding_degree']}",
              "^-", "#228833"))
    real, = tables.columns("table1", "real_cm")
    figure, (left, right) = plt.subplots(1, 2, figsize=(11, 4.4), constrained_layout=True)
    for column, label, style, colour in names:
        values, = tables.columns("table1", column)
        errors = [r - v for r, v in zip(real, values)]
        if column in ("m1_cm", "m2_cm"):
            left.plot(real, errors, style, color=colour, label=label)
        if column != "m1_cm":
            right.plot(real, [10 * error for error in errors], style, color=colour, label=label)
    left.set_ylabel("real - measured (cm)")
    right.set_ylabel("real - measured (mm)")
    right.axhspan(-3, 3, color="#eeeeee", label="the paper's limit of 3 mm", zorder=0)
    for axis in (left, right):
        axis.set_xlabel("real length of the string (cm)")
        axis.axhline(0, color="grey", linewidth=0.6)
        axis.legend(fontsize=8)
    figure.suptitle("Table 1: error of a string's length")
    save(figure, folder, "table1")


def table2(tables, folder):
    figure, axes = plt.subplots(1, 3, figsize=(13, 4.4), constrained_layout=True)
    for axis, (row, label) in zip(axes, ((("x",), "X: first row"), (("y", "z"), "Y or Z: second row"))):
        marker, paper = tables.columns("table2", "marker_cm", "paper_cm", axis=row[0])
        axis.plot(marker, [10 * (p - m) for p, m in zip(paper, marker)], **PAPER)
        for name, style in zip(row, ("o-", "^--")):
            marker, model = tables.columns("table2", "marker_cm", "model_cm", axis=name)
            axis.plot(marker, [10 * (r - m) for r, m in zip(model, marker)], style,
                      label=f"our model along {name.upper()}")
        axis.axhspan(-4, 4, color="#eeeeee", label="$\\pm$4 mm", zorder=0)
        axis.set_xlabel("marker (cm)")
        axis.set_ylabel("read - marker (mm)")
        axis.set_ylim(-6, 6)
        axis.set_title(label, fontsize=10)
        axis.legend(fontsize=8)
    last = axes[2]
    for name, style in (("x", "o-"), ("z", "^--")):
        marker, read = tables.columns("turned_45", "marker_cm", "read_deg", axis=name, strings="M2")
        last.plot(marker, read, style, markersize=3, label=f"our model along {name.upper()}")
    last.axhline(45, color="black", linewidth=0.8, label="true: 45 degrees")
    last.set_xlabel("position (cm)")
    last.set_ylabel("rotation read (degrees)")
    last.set_title("turned by 45 degrees about Y", fontsize=10)
    last.legend(fontsize=8)
    figure.suptitle("Table 2 and the 45-degree experiment. Our model: strings with Table 1's M2 errors, "
                    "through the forward kinematics", fontsize=11)
    save(figure, folder, "table2")


def position_error(tables, folder):
    figure, axis = plt.subplots(figsize=(8, 4.4), constrained_layout=True)
    for poses, style in (("upright", "-"), ("tilt 30 deg", "--")):
        for strings, colour in (("M2 profile", "#4477aa"), ("3 mm each; random signs", "#cc6677"),
                                ("3 mm common", "#228833")):
            part, error = tables.columns("position_error", "part", "position_error_mm",
                                         strings=strings, poses=poses)
            axis.plot(error, [100 * p for p in part], style, color=colour,
                      label=f"{strings.replace(';', ',')}, {poses.replace('deg', 'degrees')}")
    axis.axvline(4, color="black", linewidth=0.8, label="the paper's 4 mm")
    axis.set_xlim(0, 12)
    axis.set_xlabel("error of the position read, worst axis (mm)")
    axis.set_ylabel("poses with no more (%)")
    axis.set_title("Position error over the 40 cm cube, by error of the strings")
    axis.legend(fontsize=8)
    save(figure, folder, "position_error")


def capacity(tables, folder, name, title, sides, asked, at_name, unwanted):
    """Rows: plain W, weighted W, what comes along unasked. Columns: the two figures of the paper."""
    column, unit_name = unwanted
    figure, axes = plt.subplots(3, 2, figsize=(11, 9.5), sharex=True, constrained_layout=True)
    for side, (curve, curve_y, sign, heading) in enumerate(sides):
        for row, (weighting, text) in enumerate((("plain", "plain (SI units, as printed)"),
                                                 ("weighted", "moments and g divided by d"))):
            axis = axes[row][side]
            for tension, (colour, width) in TENSIONS.items():
                wanted = dict(weighting=weighting, max_tension_n=tension, asked=sign * asked)
                at, values = tables.columns("capacity", "at", "capacity", figure=curve, **wanted)
                axis.plot(at, values, color=colour, linewidth=width,
                          label=f"{'X' if curve_y else 'Z'}, up to {tension} N a string")
                if curve_y:
                    at, values = tables.columns("capacity", "at", "capacity", figure=curve_y, **wanted)
                    axis.plot(at, values, ":", color="black", linewidth=1,
                              label="Y (each lies on X)" if tension == 5 else None)
                if tension == 10:
                    at, values = tables.columns("capacity", "at", column, figure=curve, **wanted)
                    axes[2][side].plot(at, values, color="#cc6677" if row == 0 else "#4477aa",
                                       linestyle="--" if row == 0 else "-",
                                       linewidth=3 if row == 0 else 1.4, label=text)
            axis.set_ylim(-0.15, 1.1)
            axis.set_ylabel(CAPACITY)
            axis.set_title(f"{heading}; {text}", fontsize=9)
            axis.axhline(0, color="grey", linewidth=0.6)
        axes[2][side].set_title("unasked at 10 N a string", fontsize=9)
        axes[2][side].set_ylabel(unit_name)
        axes[2][side].set_xlabel(at_name)
        # Rounding is not to be blown up to the height of the panel.
        axes[2][side].set_ylim(-0.01, max(0.1, axes[2][side].get_ylim()[1]))
        axes[2][side].legend(fontsize=8)
    axes[0][0].legend(fontsize=7, loc="lower center")
    figure.suptitle(title + "\nour curves; the values of the paper's are not in its text", fontsize=11)
    save(figure, folder, name)


def capacities(tables, folder):
    moment = ("unwanted_moment_nm", "unasked moment (N m)")
    force = ("unwanted_force_n", "unasked force (N)")
    capacity(tables, folder, "fig6_fig7", "Figs. 6 and 7: force of 5 N along X (Y beside it)",
             (("fig6", "fig6_y", 1, "Fig. 6: +5 N"), ("fig7", "fig7_y", -1, "Fig. 7: -5 N")), 5,
             "position along the force's axis (cm)", moment)
    capacity(tables, folder, "fig8", "Fig. 8: force of 5 N along Z",
             (("fig8", None, 1, "Fig. 8: +5 N"), ("fig8_negative", None, -1, "Fig. 8: -5 N")), 5,
             "position along Z (cm)", moment)
    capacity(tables, folder, "fig9_fig10", "Figs. 9 and 10: moment of 0.2 N m about X (Y beside it)",
             (("fig9", "fig9_y", 1, "Fig. 9: +0.2 N m"), ("fig10", "fig10_y", -1, "Fig. 10: -0.2 N m")),
             0.2, "rotation about the moment's axis (degrees)", force)
    capacity(tables, folder, "fig11_fig12", "Figs. 11 and 12: moment of 0.2 N m about Z",
             (("fig11", None, 1, "Fig. 11: +0.2 N m"), ("fig12", None, -1, "Fig. 12: -0.2 N m")), 0.2,
             "rotation about Z (degrees)", force)


def grasp(tables, folder):
    figure, (left, right) = plt.subplots(1, 2, figsize=(11, 4.4), constrained_layout=True)
    for g, style in ((0.05, "-"), (0.1, "--"), (0.2, ":")):
        for sign in (1, -1):
            at, values = tables.columns("capacity", "at", "capacity", figure="grasp",
                                        weighting="weighted", max_tension_n=5, asked=sign * g)
            left.plot(at, values, style, linewidth=2, color="#4477aa" if sign > 0 else "#cc6677",
                      label=f"g = {sign * g:+} N m")
    left.set_ylim(-0.15, 1.15)
    left.set_xlabel("grasp angle at the centre (degrees)")
    left.set_ylabel(CAPACITY)
    left.set_title("Grasp force, 5 N a string (all six lie on 1)", fontsize=10)
    left.legend(fontsize=8, ncol=2, loc="lower center")
    rows = tables.rows("grasp_and_release")
    for place, row in enumerate(rows):
        for state, colour in (("open", "#4477aa"), ("closed", "#228833")):
            low, high = float(row[f"{state}_low_deg"]), float(row[f"{state}_high_deg"])
            right.plot([low, high], [place, place], "|-", color=colour, linewidth=5,
                       markersize=14, solid_capstyle="butt",
                       label=("open, true 0 degrees" if state == "open" else "grasped, true 35 degrees")
                       if place == 0 else None)
    right.axvspan(20, 50, color="#eeeeee", label="the paper's grasp: 20 to 50 degrees", zorder=0)
    right.set_yticks(range(len(rows)))
    right.set_yticklabels([f"{row['strings']} strings, "
                           f"{'upright' if float(row['rotation_y_deg']) == 0 else 'Ry 45'}: "
                           f"{100 * int(row['good']) / int(row['points']):.0f} %" for row in rows])
    right.set_xlabel("grasp angle read (degrees), range over 4,913 points")
    right.set_title("Grasp and release over the 40 cm cube: points that work", fontsize=10)
    right.set_ylim(len(rows) + 1.4, -0.6)
    right.legend(fontsize=8, loc="lower center")
    save(figure, folder, "grasp")


def scaling(tables, folder):
    figure, axes = plt.subplots(2, 2, figsize=(11, 7), constrained_layout=True)
    for column, (sweep, x, factor, x_name, ours) in enumerate((
            ("frame", "frame_m", 1, "edge of the frame (m), poles as the paper's", 0.48),
            ("pole", "pole_half_length_m", 100, "half length d of a pole (cm), frame as the paper's", 4))):
        top, bottom = axes[0][column], axes[1][column]
        for y, scale, style, label in (("force_x_n", 1, "o-", "force along X (N)"),
                                       ("moment_x_nm", 10, "s-", "moment about X (0.1 N m)"),
                                       ("grasp_torque_nm", 10, "x--", "grasp torque (0.1 N m)")):
            at, values = tables.columns("scaling", x, y, sweep=sweep)
            top.plot([factor * a for a in at], [scale * v for v in values], style, label=label)
        top.set_ylabel("largest at the centre, 10 N a string")
        top.set_ylim(bottom=0)
        for y, scale, style, label in (("position_mm_per_mm", 1, "o-", "position (mm per mm)"),
                                       ("rotation_deg_per_mm", 1, "s-", "rotation (degrees per mm)"),
                                       ("grasp_deg_per_mm", 1, "x--", "grasp angle (degrees per mm)")):
            at, values = tables.columns("scaling", x, y, sweep=sweep)
            bottom.plot([factor * a for a in at], [scale * v for v in values], style, label=label)
        bottom.set_ylabel("rms for 1 mm rms of string noise")
        bottom.set_ylim(bottom=0)
        for axis in (top, bottom):
            axis.set_xlabel(x_name)
            axis.axvline(ours, color="black", linewidth=0.8, label="the paper's device")
            axis.legend(fontsize=8)
    figure.suptitle("Scaling: frame and grip apart. Vector closure reaches half way to the wall in every case",
                    fontsize=11)
    save(figure, folder, "scaling")


def smoothness(tables, folder):
    figure, (left, right) = plt.subplots(1, 2, figsize=(11, 4), constrained_layout=True)
    x, force, step = tables.columns("smoothness", "x_cm", "force_x_n", "largest_step_n")
    left.plot(x, force)
    left.set_ylabel("force along X given (N), 3 N asked for")
    right.semilogy(x[1:], [max(value, 1e-6) for value in step[1:]])
    right.set_ylabel("largest change of a tension in 0.1 mm (N)")
    for axis in (left, right):
        axis.set_xlabel("position along X (cm)")
        axis.axvspan(-12, 12, color="#eeeeee", label="vector closure", zorder=0)
        axis.legend(fontsize=8)
    figure.suptitle("Smoothness: moving along X at 0.1 m/s, 1 kHz, shipped settings, slew limit off")
    save(figure, folder, "smoothness")


def main():
    tables, folder = Tables(sys.argv[1]), sys.argv[2]
    os.makedirs(folder, exist_ok=True)
    for draw in (closure_map, connections, table1, table2, position_error, capacities, grasp,
                 scaling, smoothness):
        draw(tables, folder)


if __name__ == "__main__":
    main()
