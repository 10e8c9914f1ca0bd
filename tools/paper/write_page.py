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
         "at the center the rank of A is 7 and its null vector strictly positive; for the upright grip this holds in "
         f"{share(CUBE + 'upright')} of the 40 cm cube"),
        ("its string connection is the best by the determinant of A A^T", "III.1", "holds in part",
         f"of {f['connections/all']} connections, {f['connections/better_than_paper']} have a larger determinant "
         f"(up to {n('connections/best_determinant'):.0f} against {n('connections/paper_determinant'):.0f}), but "
         f"none of these has vector closure at the center; of the {f['connections/closed']} connections that have, the paper's is the best"),
        ("near the center all 7 DOF are displayed", "V", "holds",
         f"vector closure up to {n('closure_limit_cm/x'):.1f} cm along X or Y, up to {n('closure_limit_deg/rotation_x'):.1f} "
         "degrees about X, Y or Z, and at every grasp angle up to 89 degrees"),
        ("string error below 3 mm with M2", "VI.1", "holds in part",
         f"the column M2 reaches {10 * n('table1/m2_max_cm'):.1f} mm"),
        ("M2's equation gives M2's lengths", "VI.1", "does not hold",
         f"applied to the counts of M1, the equation differs from the column M2 by up to {10 * n('table1/m2_equation_to_column_max_cm'):.1f} mm "
         f"(and from the real lengths by up to {10 * n('table1/m2_equation_max_cm'):.1f} mm)"),
        ("0.0251327 mm for each count", "VI.1", "holds", f"{n('table1/mm_per_pulse'):.7f} mm for a drum radius of 8 mm; the "
         f"fitted radius is {n('table1/effective_radius_mm'):.2f} mm "
         f"({n('table1/m2_effective_radius_mm'):.2f} mm by the printed slope)"),
        ("X and Y are alike, so Y may be left out", "VI.2", "holds",
         "Figs. 6, 7, 9 and 10: the Y curves differ from the X curves by at most "
         f"{max(largest_difference(t, 'fig6', 'fig6_y', 5), largest_difference(t, 'fig9', 'fig9_y', 0.2)):.1e}"),
        ("workspace of 40 cm for force", "VI.2, Figs. 6-8", "holds in part",
         f"capacity for 5 N away from the center with 10 N in a string, along X: {x_force[7.5]:.2f} at 7.5 cm, {x_force[10]:.2f} at 10, "
         f"{x_force[15]:.2f} at 15, {x_force[20]:.2f} at 20; along Z: {z_force[20]:.2f} at 20 cm. For a force toward the center it is 1 "
         "at all these places"),
        ("rotation of +-90 degrees", "VI.2, Figs. 9-12", "holds in part",
         "capacity for moments that turn the grip back toward rest: 1.00 up to 90 degrees; for moments of 0.2 N m that turn it further, with "
         f"10 N in a string: {outward[30]:.2f} at 30 degrees, {outward[37.5]:.2f} at 37.5, {outward[45]:.2f} from 45 on"),
        ("grasp force is displayed easily within +-45 degrees", "VI.2", "holds",
         f"at the center the smallest capacity is {n('capacity_grasp_smallest'):.5f}, for g up to 0.2 N m "
         "with 5, 10 and 20 N in a string"),
        ("position error below +-4 mm in the 40 cm cube", "VI.3", "holds in part",
         f"with M2's errors {n('position_max_mm/M2 profile; upright'):.1f} mm at most, and "
         f"{within('M2 profile', 'upright')} of upright poses within 4 mm; with an error of +3 or -3 mm at random in each "
         f"string, {within('3 mm each; random signs', 'upright')} within 4 mm"),
        ("rotation is more sensitive to string errors than position", "VI.3", "holds",
         f"with M2's errors, a grip turned by 45 degrees about Y is measured as turned by {n('turned_45_min_deg/M2'):.1f} to "
         f"{n('turned_45_max_deg/M2'):.1f} degrees; the rms error of the rotation of an upright grip over the cube is "
         f"{n('rotation_rms_deg/M2 profile; upright'):.1f} degrees"),
        ("grasp and release at every point of the cube", "VI.3", "holds",
         f"with M2's errors, both are detected at {n('grasp_good_percent/M2; upright'):.0f} % of the points for an upright grip, and at "
         f"{n('grasp_good_percent/M2; Ry 45 deg'):.0f} % for one turned by 45 degrees about Y (with M1's errors: "
         f"{n('grasp_good_percent/M1; upright'):.0f} % and {n('grasp_good_percent/M1; Ry 45 deg'):.0f} %). A requested "
         f"g of 0.1 N m is given in full at {n('grasp_felt/full_percent'):.0f} % of the points, and at the others to at least "
         f"{n('grasp_felt/smallest'):.2f} of it"),
        ("precise position by four operations", "IV, Index 1", "holds in part",
         "true for exact lengths; with errors the two polynomials have no common root "
         "([paper_notes.md](paper_notes.md))"),
        ("smooth force", "abstract", "holds in part",
         f"along X, up to 8 cm from the center, no computed tension changes by more than {gentle:.3f} N in 0.1 mm of motion; at "
         f"the border of vector closure one tension jumps by {n('smooth_step_outside_n'):.1f} N within 0.1 mm, "
         "which the slew limit spreads over time"),
        ("minimized inertia", "abstract", "cannot be judged",
         f"the simulated device has an apparent mass of {1000 * n('centre_inertia/x'):.0f} g along X and Y and "
         f"{1000 * n('centre_inertia/z'):.0f} g along Z; the paper states no mass"),
        ("no backlash", "abstract", "holds in part",
         "the smallest tension at any pose of the cube is "
         f"{n('free_hand_least_tension_n/40 cm cube; tilt 30 deg'):.1f} N, so no string goes slack. These tensions leave a force "
         f"of {n('free_hand_force_rms_n/40 cm cube; tilt 30 deg'):.2f} N rms over the cube on a hand for which no wrench is requested. "
         "Real strings and gears cannot be judged"),
        ("scalability", "abstract", "holds in part",
         "if frame and grip grow in proportion, vector closure reaches half the way to the faces, and the moments grow with d. With the "
         "same grip in a frame of 4 m, the rotation error is "
         f"{n('scaling_rotation_deg_per_mm/frame 4.00 m; 4.0 cm'):.2f} degrees for 1 mm of noise in the lengths "
         f"({n('scaling_rotation_deg_per_mm/frame 0.48 m; 4.0 cm'):.2f} degrees in the paper's frame). The larger stretch of "
         "longer strings is left out"),
        ("safety; users' satisfaction", "abstract, VII", "cannot be judged",
         "this needs the device and people. [Safety](../reference/safety.md) describes the safety functions of this add-on"),
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
    return (table(("20,000 random poses in", "theory 1 holds for", "theory 2 holds for"), shares) + "\n\n" +
            table(("coordinate that is moved from the rest pose, all others at rest", "vector closure up to"), limits))


def connection_table(t):
    rows = [row for row in t.rows("connections") if row["closed"] == "1"][:6]
    rows = t.rows("connections")[:2] + rows
    return table(("place by det(A A^T)", "strings (1 to 8) at +r1 / -r1 / +r2 / -r2", "det(A A^T)", "vector closure at the center",
                  "poses within 5 cm and 10 degrees with vector closure"),
                 [(row["place"], row["strings"] + (" (the paper's)" if row["of_paper"] == "1" else ""),
                   f"{float(row['determinant']):.1f}", "yes" if row["closed"] == "1" else "no",
                   f"{float(row['near_closed_percent']):.0f} %") for row in rows])


def string_tables(t):
    """Two tables: what the paper prints, and what equations make of the same counts."""
    printed, computed = [], []
    for row in t.rows("table1"):
        real = float(row["real_cm"])
        error = {key: f"{10 * (real - float(row[key])):+.1f}"
                 for key in ("m1_cm", "m2_cm", "m2_equation_cm", "affine_cm", "winding_cm")}
        printed.append((f"{real:g}", f"{float(row['pulses']):.0f}", error["m1_cm"], error["m2_cm"]))
        computed.append((f"{real:g}", error["m2_equation_cm"], error["affine_cm"], error["winding_cm"]))
    return (table(("real length (cm)", "counts", "error of M1 (mm)", "error of M2 (mm)"), printed) + "\n\n" +
            table(("real length (cm)", "error of M2's equation (mm)", "error of our straight line (mm)",
                   "error of our winding curve (mm)"), computed))


def position_tables(t):
    """A row for each marker; the paper has one second row, for Y by its label and Z by its text."""
    read = {(axis, key): [f"{float(row[key]):.1f}" for row in t.rows("table2", axis=axis)]
            for axis in "xyz" for key in ("paper_cm", "model_cm")}
    marker = [f"{float(row['marker_cm']):g}" for row in t.rows("table2", axis="x")]
    first = zip(marker, read["x", "paper_cm"], read["x", "model_cm"])
    second = zip(marker, read["y", "paper_cm"], read["y", "model_cm"], read["z", "model_cm"])
    return (table(("position on X (cm)", "measured position, the paper (cm)", "measured position, our model (cm)"), first) + "\n\n" +
            table(("position (cm)", "measured position, the paper's second row (cm)", "measured position along Y, our model (cm)",
                   "measured position along Z, our model (cm)"), second))


def curve_table(head, places, curves):
    rows = [(f"{place:g}", *(f"{abs(curve[place]):.3f}" for curve in curves)) for place in places]
    return table((head, "up to 5 N in a string", "up to 10 N in a string", "up to 20 N in a string"), rows)


def force_tables(t):
    places = (0, 2.5, 5, 7.5, 10, 12.5, 15, 17.5, 20)
    return "\n\n".join(
        curve_table(f"Fig. 6, {weighting}: capacity for +5 N along X, at x (cm)", places,
                    [t.capacity("fig6", weighting, tension, 5) for tension in (5, 10, 20)])
        for weighting in ("plain", "weighted"))


def moment_tables(t):
    places = (0, 7.5, 15, 22.5, 30, 37.5, 45, 60, 90)
    return "\n\n".join(
        curve_table(f"capacity for +0.2 N m about {axis}, turned further by (degrees)", places,
                    [t.capacity(figure, "weighted", tension, 0.2) for tension in (5, 10, 20)])
        for figure, axis in (("fig9", "X or Y"), ("fig11", "Z")))


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
    return table(("DOF", "apparent inertia", "share of the rotors", "friction", "largest wrench with up to 5 / 10 / 20 N in a string"),
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

For researchers who know the paper of Kim, Koike and Sato on SPIDAR-G, and who ask which of its claims hold. After reading, you know for each claim in the table below whether this project's mathematics confirms it, and by which number. Misprints and our readings: [notes on the paper](paper_notes.md). Terms: [glossary](../reference/glossary.md).

`./dev paper` writes this page; do not edit it. The numbers are computed with the kinematics, the wrench matrix and the tension solver of `gdextension/core`, except those that are quoted from the paper.

Symbols: DOF is a degree of freedom, A the wrench matrix, τ the tensions (N), q the requested wrench, d half the length of a pole (4 cm), g the seventh component of q. M1 and M2 are columns of the paper's Table 1: M1 has string lengths computed with the ideal radius of the drum, M2 those computed with an equation that the paper fitted. M1's and M2's errors are the differences between the real lengths and these columns.

What the paper does not state, and what is used here:

* the largest tension: 5, 10 and 20 N;
* the requested moments and their unit: 0.05, 0.1 and 0.2 N m;
* the numbers of Figs. 6 to 12, which are pictures: our *curves could not be compared* with them. We take the figures of each pair (6 and 7, 9 and 10, 11 and 12) as the two signs of one direction.

No device was at hand. Errors of strings come from the paper's Table 1; apart from these, the model of the device has no errors.

## Its claims
{table(("claim", "where", "verdict", "number"), claims(t))}

## Vector closure (section II)
The paper says vector closure; the term of the field is wrench closure.

![closure maps](../pictures/paper/closure_map.png)

Theory 1 of the paper (more strings than DOF) holds at every pose, so it says nothing about a pose. Theory 2 (rank 7 and a strictly positive null vector) is the condition for vector closure. For the upright grip, the region of vector closure is wide in X toward +Z, where the motors of pole 1 are, and wide in Y toward -Z. It is {n('closure_share_percent/' + CUBE + 'upright'):.1f} % of the cube's volume. On a grid of 2 cm that includes the faces of the cube, it is {n('scaling_share_percent/both 0.48 m; 4.0 cm'):.1f} % of the points.

{closure_tables(t)}

## Which strings to which pole end (section III.1)
![all connections](../pictures/paper/connections.png)

All assignments of two strings to each of the four pole ends were ranked by det(A A^T), with moments and g divided by d. By the determinant alone the paper's assignment would not be chosen: {t.figures["connections/better_than_paper"]} assignments have a larger determinant, but with them the strings cannot pull in every direction at the center. Of all assignments, {t.figures["connections/closed"]} meet theory 2. Among these, the paper's assignment and its mirror image ({t.figures["connections/equal_to_paper"]} in all) have the largest determinant at the center. By the mean over poses near the center, {t.figures["connections/better_near_and_closed"]} are better.

{connection_table(t)}

## Error of a string (section VI.1, Table 1)
![string errors](../pictures/paper/table1.png)

An error is the real length minus the measured one. The counts are the lengths of M1 divided by {n("table1/mm_per_pulse"):.7f} mm. A straight line that we fitted to them by least squares is length = {n("table1/affine_offset_cm"):.5f} cm + {n("table1/affine_slope_cm"):.8f} cm for each count, with an error of {10 * n("table1/affine_rms_cm"):.2f} mm rms and {10 * n("table1/affine_max_cm"):.2f} mm at most. The paper prints 0.50744 cm + 0.0026282 cm for each count. This does not give the paper's own column M2; perhaps M2 was measured another time.

{string_tables(t)}

The winding curve is a polynomial, so that the radius of the drum may change with the length that is wound on it. Its degree was chosen by leaving out one row of Table 1 after the other and predicting it: the errors are {held_out[0]:.2f}, {held_out[1]:.2f} and {held_out[2]:.2f} mm rms for degrees 1, 2 and 3. Seven rows are few, and degree {t.figures["table1/winding_degree"]} is only a little better. Therefore the add-on's calibration with a ruler uses a straight line.

## Error of the position (section VI.3, Table 2)
![position errors](../pictures/paper/table2.png)

In our model, all eight strings have M2's errors, and the forward kinematics compute the pose from their lengths. The model differs from the X row of the paper's Table 2 by at most {n("table2/x_model_to_paper_max_mm"):.1f} mm. In the second row of Table 2 (Y by its label, Z by the text), the positions at +-20 cm are measured too far outward, which strings with equal errors cannot cause. The paper prints no result of its experiment at 45 degrees.

{position_tables(t)}

![errors over the cube](../pictures/paper/position_error.png)

Over the 40 cm cube, the error of the position along the axis with the largest error is:

* with M2's errors, {n("position_max_mm/M2 profile; upright"):.1f} mm at most for an upright grip, and {n("position_max_mm/M2 profile; tilt 30 deg"):.1f} mm at most for one tilted by 30 degrees;
* with an error of +3 or -3 mm at random in each string, {n("position_max_mm/3 mm each; random signs; upright"):.0f} mm at most for an upright grip, and {n("position_max_mm/3 mm each; random signs; tilt 30 deg"):.0f} mm for a tilted one, because at a few poses another pose fits the lengths as well and is computed instead;
* with an error of 3 mm, equal in all strings, {n("position_rms_mm/3 mm common; upright"):.1f} mm rms, and {n("rotation_rms_deg/3 mm common; upright"):.0f} degrees rms in rotation, for an upright grip;
* for a grip turned by 45 degrees about Y, up to {n("turned_45_position_max_mm/M1"):.0f} mm with M1's errors and {n("turned_45_position_max_mm/M2"):.1f} mm with M2's errors.

## Capacity to display force (section VI.2, Figs. 6 to 12)
The capacity is the component of the achieved wrench along the requested one, divided by the requested one. "Plain" minimizes |A τ - q|^2 as the paper prints it, with components in newtons and in newton meters. "Weighted" divides moments and g by d, as the add-on does. The plain capacities are larger, but at the cost of a moment that nobody requested: at 15 cm along X, the force is given almost in full, together with a moment that twists the grip (lowest panels of the picture).

![Figs. 6 and 7](../pictures/paper/fig6_fig7.png)

{force_tables(t)}

![Fig. 8](../pictures/paper/fig8.png)
![Figs. 9 and 10](../pictures/paper/fig9_fig10.png)

Moments that turn the grip back toward its rest pose are given in full: up to 90 degrees, the smallest capacity for any of the three largest tensions is {back:.3f}. The tables show the capacity for moments that turn the grip further away from rest:

{moment_tables(t)}

![Figs. 11 and 12](../pictures/paper/fig11_fig12.png)

## Grasp and release
![grasp](../pictures/paper/grasp.png)

At each of 4,913 points, 2.5 cm apart, the grip is opened (0 degrees), grasped (35 degrees) and opened again. The lengths have string errors, and the add-on's grasp detector evaluates the computed pose (grasped from 20 degrees on, open below 15 degrees).

## Scaling
![scaling](../pictures/paper/scaling.png)

With longer poles, the strings give larger moments, and noise of the lengths changes the measured rotation less. A larger frame changes little except the stretch of the strings, which is left out here.

## At the center
The masses, the rotors (an inertia equivalent to 17 g that move with the string) and the friction (0.05 N in each string) are those of the simulated device. Each DOF is moved alone, although X is coupled with the rotation about Y, and Y with the rotation about X. The row of the grasp is for the grasp angle and the grasp torque, which is half the paper's g.

{centre_table(t)}

![smoothness](../pictures/paper/smoothness.png)

If the grip is moved along X and a force of 3 N away from the center is requested, the achieved force is below 2.9 N from {short:.1f} cm on. From {pulled:.1f} cm on, the achieved force points toward the center, because of the minimum tensions of the strings. If no wrench is requested, the minimum tensions leave this force and moment on the hand:

{table(("poses", "force rms (N)", "force max (N)", "moment rms (N m)"), free)}
"""


def main():
    with open(sys.argv[2], "w", encoding="utf-8") as file:
        file.write(page(Tables(sys.argv[1])))
    print(sys.argv[2])


if __name__ == "__main__":
    main()
