#!/usr/bin/env python3
"""write_page.py CSV_FOLDER PAGE: docs/why/paper_reproduction.md from the CSV files. Needs no matplotlib."""

import sys

from tables import Tables

CUBE = "40 cm cube; "


def table(head, rows):
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows])


def largest_difference(t, figure, other, asked):
    """Between two figures' curves, over all weightings and tensions."""
    return max(abs(value - t.capacity(other, weighting, tension, asked)[at])
               for weighting in ("plain", "weighted") for tension in (5, 10, 20)
               for at, value in t.capacity(figure, weighting, tension, asked).items())


def claims(t):
    """(what the paper says, where, verdict, the number)."""
    n, f = t.number, t.figures
    share = lambda poses: f"{n('closure_share_percent/' + poses):.1f} %"  # noqa: E731
    outward = t.capacity("fig9", "weighted", 10, 0.2)
    x_force = t.capacity("fig6", "weighted", 10, 5)
    z_force = t.capacity("fig8", "weighted", 10, 5)
    x, step = t.columns("smoothness", "x_cm", "largest_step_n")
    gentle = max(value for at, value in zip(x, step) if abs(at) <= 8)
    within = lambda strings, poses: f"{n(f'within_4_mm_percent/{strings}; {poses}'):.1f} %"  # noqa: E731
    return (
        ("8 strings can give 7 DOF", "II", "holds",
         f"at the centre the rank is 7 and the null vector strictly positive; {share(CUBE + 'upright')} of the "
         "40 cm cube, upright"),
        ("its string connection is the best by the determinant", "III.1", "holds in part",
         f"of {f['connections/all']} ways, {f['connections/better_than_paper']} have a larger determinant "
         f"(up to {n('connections/best_determinant'):.0f} against {n('connections/paper_determinant'):.0f}), but "
         f"none of those has vector closure; of the {f['connections/closed']} that have, it is the best"),
        ("near the centre all 7 DOF are displayed", "V", "holds",
         f"closure to {n('closure_limit_cm/x'):.1f} cm along X and Y, {n('closure_limit_deg/rotation_x'):.1f} "
         "degrees about any axis, and all of the grasp angle"),
        ("string error below 3 mm with M2", "VI.1", "holds in part",
         f"its column reaches {10 * n('table1/m2_max_cm'):.1f} mm: at most, not below"),
        ("M2's equation gives M2's lengths", "VI.1", "does not",
         f"on the counts behind M1 it is up to {10 * n('table1/m2_equation_to_column_max_cm'):.1f} mm away from "
         f"M2's column (and up to {10 * n('table1/m2_equation_max_cm'):.1f} mm from the true lengths)"),
        ("0.0251327 mm a count", "VI.1", "holds", f"{n('table1/mm_per_pulse'):.7f} mm for a radius of 8 mm; the "
         f"fitted radius is {n('table1/effective_radius_mm'):.2f} mm "
         f"({n('table1/m2_effective_radius_mm'):.2f} mm by the printed slope)"),
        ("X and Y are alike, so Y may be left out", "VI.2", "holds",
         "Figs. 6, 7, 9 and 10: the Y curves lie on the X curves to "
         f"{max(largest_difference(t, 'fig6', 'fig6_y', 5), largest_difference(t, 'fig9', 'fig9_y', 0.2)):.1e}"),
        ("workspace of 40 cm for force", "VI.2, Figs. 6-8", "holds in part",
         f"5 N along X at 10 N a string: {x_force[7.5]:.2f} at 7.5 cm, {x_force[10]:.2f} at 10, "
         f"{x_force[15]:.2f} at 15, {x_force[20]:.2f} at 20 (pulling back inwards: 1 everywhere); along Z "
         f"{z_force[20]:.2f} at 20 cm"),
        ("rotation of +-90 degrees", "VI.2, Figs. 9-12", "holds in part",
         "moments that turn the grip back: 1.00 to 90 degrees. Moments that turn it on, 0.2 N m at 10 N a "
         f"string: {outward[30]:.2f} at 30 degrees, {outward[37.5]:.2f} at 37.5, {outward[45]:.2f} from 45 on"),
        ("grasp force is displayed easily within +-45 degrees", "VI.2", "holds",
         f"at the centre the smallest capacity is {n('capacity_grasp_smallest'):.5f}, for g up to 0.2 N m "
         "at 5, 10 and 20 N a string"),
        ("position error below +-4 mm in the 40 cm cube", "VI.3", "holds in part",
         f"with the M2 errors {n('position_max_mm/M2 profile; upright'):.1f} mm at most and "
         f"{within('M2 profile', 'upright')} of upright poses within 4 mm; with 3 mm of random sign in each "
         f"string {within('3 mm each; random signs', 'upright')}"),
        ("rotation is more sensitive to string errors than position", "VI.3", "holds",
         f"a true 45 degrees about Y reads as {n('turned_45_min_deg/M2'):.1f} to "
         f"{n('turned_45_max_deg/M2'):.1f}; rms over the upright cube "
         f"{n('rotation_rms_deg/M2 profile; upright'):.1f} degrees"),
        ("grasp and release at every point of the cube", "VI.3", "holds",
         f"read with M2's errors: {n('grasp_good_percent/M2; upright'):.0f} % of points upright, "
         f"{n('grasp_good_percent/M2; Ry 45 deg'):.0f} % turned by 45 degrees (M1: "
         f"{n('grasp_good_percent/M1; upright'):.0f} % and {n('grasp_good_percent/M1; Ry 45 deg'):.0f} %). That the "
         f"grasp is *felt* in full (g = 0.1 N m) is so at {n('grasp_felt/full_percent'):.0f} % of them, at the "
         f"others at least {n('grasp_felt/smallest'):.2f} of it"),
        ("precise position by four operations", "IV, Index 1", "holds in part",
         "with exact lengths; with errors the two polynomials have no common root "
         "([paper_notes.md](paper_notes.md))"),
        ("smooth force", "abstract", "holds in part",
         f"in the simulation tensions change by at most {gentle:.3f} N in 0.1 mm within 8 cm of the centre; at "
         f"the closure border along X one string jumps by {n('smooth_step_outside_n'):.1f} N within 0.1 mm, "
         "which the slew limit spreads over time"),
        ("minimized inertia", "abstract", "cannot be judged",
         f"the simulated device has {1000 * n('centre_inertia/x'):.0f} g along X and Y and "
         f"{1000 * n('centre_inertia/z'):.0f} g along Z; the paper gives no mass"),
        ("no backlash", "abstract", "holds in part",
         "the least tension over the cube is "
         f"{n('free_hand_least_tension_n/40 cm cube; tilt 30 deg'):.1f} N, so no string goes slack; the price is a "
         f"force on the free hand, {n('free_hand_force_rms_n/40 cm cube; tilt 30 deg'):.2f} N rms over the cube. "
         "Real strings and gears cannot be judged"),
        ("scalability", "abstract", "holds in part",
         "in proportion everything scales: closure stays at half the way to the wall, moments grow with d. A large "
         "frame with the same grip turns "
         f"{n('scaling_rotation_deg_per_mm/frame 4.00 m; 4.0 cm'):.2f} degrees for 1 mm of string noise "
         f"(paper's: {n('scaling_rotation_deg_per_mm/frame 0.48 m; 4.0 cm'):.2f}), and its longer strings "
         "stretch more, which is not in this sweep"),
        ("safety; users' satisfaction", "abstract, VII", "cannot be judged",
         "needs the device and people. What this add-on does about safety: [safety.md](safety.md)"),
    )


def closure_tables(t):
    shares = [(row["poses"].replace(";", ",").replace("deg", "degrees"), "100 %",
               f"{float(row['theory_2_percent']):.1f} %") for row in t.rows("closure_share")]
    limits = []
    for row in t.rows("closure_limit"):
        limit, end = float(row["positive"]), float(row["searched_to"])
        unit = row["unit"].replace("deg", "degrees")
        limits.append((row["coordinate"].replace("_", " about ", 1) if "rotation" in row["coordinate"]
                       else row["coordinate"].replace("_", " "),
                       f"not lost up to {end:g} {unit}" if limit >= end - 1e-6 else f"{limit:.1f} {unit}"))
    return (table(("20,000 random poses", "theory 1", "theory 2"), shares) + "\n\n" +
            table(("along or about one axis, the rest at rest", "closure up to"), limits))


def connection_table(t):
    rows = [row for row in t.rows("connections") if row["closed"] == "1"][:6]
    rows = t.rows("connections")[:2] + rows
    return table(("place", "strings at +r1 / -r1 / +r2 / -r2", "det(A A^T)", "closure at the centre",
                  "poses within 5 cm and 10 degrees that are closed"),
                 [(row["place"], row["strings"] + (" (the paper's)" if row["of_paper"] == "1" else ""),
                   f"{float(row['determinant']):.1f}", "yes" if row["closed"] == "1" else "no",
                   f"{float(row['near_closed_percent']):.0f} %") for row in rows])


def string_table(t):
    rows = []
    for row in t.rows("table1"):
        real = float(row["real_cm"])
        rows.append((f"{real:g}", f"{float(row['pulses']):.0f}",
                     *(f"{10 * (real - float(row[key])):+.1f}"
                       for key in ("m1_cm", "m2_cm", "m2_equation_cm", "affine_cm", "winding_cm"))))
    return table(("real (cm)", "counts", "M1 (mm)", "M2 (mm)", "M2's equation (mm)", "our affine fit (mm)",
                  "our winding curve (mm)"), rows)


def position_table(t):
    rows = []
    for axis, text in (("x", "X"), ("y", "Y"), ("z", "Z")):
        for name, key in (("the paper", "paper_cm"), ("our model", "model_cm")):
            values = [float(row[key]) for row in t.rows("table2", axis=axis)]
            rows.append((f"{text}, {name}", *(f"{value:.1f}" for value in values)))
    rows.pop(4)  # the paper has one second row for Y and Z
    rows[2] = ("Y by its label, Z by its text, the paper", *rows[2][1:])
    marker = [f"{float(row['marker_cm']):g}" for row in t.rows("table2", axis="x")]
    return table(("read (cm) at marker", *marker), rows)


def force_table(t):
    places = (0, 2.5, 5, 7.5, 10, 12.5, 15, 17.5, 20)
    rows = []
    for weighting in ("plain", "weighted"):
        for tension in (5, 10, 20):
            curve = t.capacity("fig6", weighting, tension, 5)
            rows.append((f"{weighting}, {tension} N", *(f"{abs(curve[place]):.3f}" for place in places)))
    return table(("Fig. 6: +5 N along X, at x (cm)", *(f"{place:g}" for place in places)), rows)


def moment_table(t):
    places = (0, 7.5, 15, 22.5, 30, 37.5, 45, 60, 90)
    rows = []
    for figure, axis in (("fig9", "X or Y"), ("fig11", "Z")):
        for tension in (5, 10, 20):
            curve = t.capacity(figure, "weighted", tension, 0.2)
            rows.append((f"about {axis}, {tension} N", *(f"{abs(curve[place]):.3f}" for place in places)))
    return table(("+0.2 N m, turned on by (degrees)", *(f"{place:g}" for place in places)), rows)


def centre_table(t):
    rows = []
    for row in t.rows("centre"):
        linear = row["unit_wrench"] == "N"
        scale, unit = (1000, "g") if linear else (1e6, "kg mm^2")
        total = float(row["grip_inertia"]) + float(row["rotor_inertia"])
        most = [f"{float(row[key]):.3g}" for key in ("largest_5_n", "largest_10_n", "largest_20_n")]
        rows.append((row["dof"].replace("_", " "), f"{scale * total:.0f} {unit}",
                     f"{100 * float(row['rotor_inertia']) / total:.0f} %",
                     f"{float(row['coulomb_friction']):.2g} {row['unit_wrench']}",
                     " / ".join(most) + " " + row["unit_wrench"]))
    return table(("DOF", "apparent inertia", "of it rotors", "friction", "largest wrench at 5 / 10 / 20 N a string"),
                 rows)


def page(t):
    n = t.number
    back = min(value for figure in ("fig9", "fig11") for tension in (5, 10, 20)
               for at, value in t.capacity(figure, "weighted", tension, 0.2).items() if at <= 0)
    x, force = t.columns("smoothness", "x_cm", "force_x_n")
    short = min(at for at, value in zip(x, force) if value < 2.9)
    pulled = min(at for at, value in zip(x, force) if value < 0)
    held_out = [float(row["held_out_rms_cm"]) * 10 for row in t.rows("table1_models")]
    free = [(row["poses"].replace(";", ",").replace("deg", "degrees"), f"{float(row['force_rms_n']):.3f}",
             f"{float(row['force_max_n']):.2f}", f"{float(row['moment_rms_nm']):.4f}")
            for row in t.rows("free_hand")]
    return f"""# The paper, recomputed

Written by `./dev paper`; not to be edited. The core's own kinematics, wrench matrix and tension solver recompute the tables, figures and
claims of Kim, Koike and Sato's paper on SPIDAR-G. Its errors, and how they are read here, are in [paper_notes.md](paper_notes.md).

What the paper leaves open: the largest tension (5, 10 and 20 N here), the moments asked for (0.05, 0.1 and 0.2 N m), the unit of moments,
and the values of Figs. 6 to 12, which are pictures: their *shapes could not be compared*, and their two parts (6 and 7, 9 and 10,
11 and 12) are taken to be the two signs. No device was at hand: what is said of strings is its Table 1, the rest is the ideal model.

## Its claims
{table(("claim", "where", "verdict", "number"), claims(t))}

## Vector closure (section II)
![closure maps](pictures/paper/closure_map.png)

Theory 1 (more strings than DOF) holds everywhere and decides nothing. Theory 2 (rank 7 and a strictly positive null vector) is the condition.
The region is a wedge: wide in X towards +Z, where pole 1 hangs, and in Y towards -Z. It is {n('closure_share_percent/' + CUBE + 'upright'):.1f} % of
the cube's volume; counted on a 2 cm grid with its faces, it is {n('scaling_share_percent/both 0.48 m; 4.0 cm'):.1f} % of the points.

{closure_tables(t)}

## Which strings to which pole end (section III.1)
![all connections](pictures/paper/connections.png)

Every assignment of two strings to each of the four pole ends, by det(A A^T) with moments and g divided by d. The determinant alone does not
pick the paper's: {t.figures["connections/better_than_paper"]} score higher, and cannot pull in every direction at the centre. With theory 2
required, {t.figures["connections/closed"]} remain; the paper's and its mirror image ({t.figures["connections/equal_to_paper"]} in all) share the
first place, at the centre and as the mean over poses near it ({t.figures["connections/better_near_and_closed"]} better).

{connection_table(t)}

## Error of a string (section VI.1, Table 1)
![string errors](pictures/paper/table1.png)

Real minus measured. Counts are M1's lengths over {n("table1/mm_per_pulse"):.7f} mm. Our least squares on them:
length = {n("table1/affine_offset_cm"):.5f} cm + {n("table1/affine_slope_cm"):.8f} cm a count, rms {10 * n("table1/affine_rms_cm"):.2f} mm, at most
{10 * n("table1/affine_max_cm"):.2f} mm. The paper prints 0.50744 + 0.0026282, which does not give its own M2 column; perhaps that was measured anew.

{string_table(t)}

The winding curve (the radius changes with what is wound) is the polynomial that best predicts rows left out: {held_out[0]:.2f}, {held_out[1]:.2f}
and {held_out[2]:.2f} mm rms for degrees 1, 2 and 3. Seven rows are few: degree {t.figures["table1/winding_degree"]} wins by little, and a straight
line is what the add-on's calibration uses.

## Error of the position (section VI.3, Table 2)
![position errors](pictures/paper/table2.png)

Eight strings with Table 1's M2 errors, read by the forward kinematics. Of the 45-degree experiment the
paper prints no result. The model follows the paper's X row to
{n("table2/x_model_to_paper_max_mm"):.1f} mm. Its second row errs outwards at +-20 cm, which equal strings cannot do.

{position_table(t)}

![errors over the cube](pictures/paper/position_error.png)

Over the 40 cm cube, error on the worst axis: M2's errors {n("position_max_mm/M2 profile; upright"):.1f} mm at most, and
{n("position_max_mm/M2 profile; tilt 30 deg"):.1f} mm tilted; 3 mm with random signs {n("position_max_mm/3 mm each; random signs; upright"):.0f} mm,
tilted {n("position_max_mm/3 mm each; random signs; tilt 30 deg"):.0f} mm, where a few poses read as another that fits the lengths as well; all strings 3 mm
long {n("position_rms_mm/3 mm common; upright"):.1f} mm rms and {n("rotation_rms_deg/3 mm common; upright"):.0f} degrees rms. Turned by 45 degrees about
Y, M1's lengths read up to {n("turned_45_position_max_mm/M1"):.0f} mm wrong, M2's {n("turned_45_position_max_mm/M2"):.1f} mm.

## Capacity to display force (section VI.2, Figs. 6 to 12)
Capacity = displayed part along the target / target. "plain" minimises |A tau - q|^2 as printed, newtons and newton metres side by side;
"weighted" divides moments and g by d, as the add-on does. Plain looks better and is worse: at 15 cm along X it keeps the force and adds a moment
that twists the grip (lowest panels).

![Figs. 6 and 7](pictures/paper/fig6_fig7.png)

{force_table(t)}

![Fig. 8](pictures/paper/fig8.png)
![Figs. 9 and 10](pictures/paper/fig9_fig10.png)

Moments that turn the grip back are given in full: {back:.3f} at least, over all tensions, to 90 degrees. Turning it on:

{moment_table(t)}

![Figs. 11 and 12](pictures/paper/fig11_fig12.png)

## Grasp and release
![grasp](pictures/paper/grasp.png)

4,913 points, every 2.5 cm: the grip is open (0), grasped (35 degrees) and open again, read with string errors, and judged by the add-on's detector
(in at 20 degrees, out at 15).

## Scaling
![scaling](pictures/paper/scaling.png)

Longer poles give larger moments and a steadier rotation; a larger frame changes little but the strings' stretch, which is not in this sweep.

## At the centre
Masses, rotors (17 g at the string) and friction (0.05 N a string) are those of the simulated device, each DOF moved alone; X is coupled with rotation
about Y, and Y with rotation about X. Grasp is in terms of grasp angle and torque (half the paper's g).

{centre_table(t)}

![smoothness](pictures/paper/smoothness.png)

Asked for 3 N outwards, the device gives less than 2.9 N from {short:.1f} cm on, and from {pulled:.1f} cm on the strings' least tension
pulls back instead. With no wrench asked for, the
least tensions leave:

{table(("poses", "force rms (N)", "force max (N)", "moment rms (N m)"), free)}
"""


def main():
    with open(sys.argv[2], "w", encoding="utf-8") as file:
        file.write(page(Tables(sys.argv[1])))
    print(sys.argv[2])


if __name__ == "__main__":
    main()
