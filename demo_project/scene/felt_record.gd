extends RefCounted
## What the hand felt of one thing, all of it from the strings' pull on the grip, and whether that is
## what the thing really is.

const WEIGHT_TOLERANCE := 0.05
const WIDTH_TOLERANCE_M := 0.001
## A soft thing pushes back by 0.0012 N m a millimetre, no more than what the strings' friction hides.
const WIDTH_TOLERANCE_SOFT_M := 0.0015
## Of a detent's slope; of something thin more: with jaws all but closed the strings, none of them below its least tension,
## cannot give all of the squeeze and all of the pull at once. Of the slope asked for they give 82 to 106 %.
const DETENT_TOLERANCE := 0.1
const DETENT_TOLERANCE_THIN := 0.2
## One way only, so that the strings' friction, up to 0.3 N, is in it.
const RELEASE_TOLERANCE := 0.25
## A squeeze weaker than this at the fingers is not felt as a thing between them.
const SQUEEZE_FELT_NM := 0.010

## What this thing is checked for; set when it is laid out, so that a play cannot skip a check.
var checks_weight := true
var checks_width := true
var checks_detent := false
var checks_release := false
var width_tolerance_m := WIDTH_TOLERANCE_M
var detent_tolerance := DETENT_TOLERANCE

var weight_expected_n := NAN
var weight_felt_n := NAN
var width_expected_m := NAN
var width_felt_m := NAN
var squeeze_torque_nm := NAN
## Slope of the pull of a socket against the way out of it.
var detent_expected_n_m := NAN
var detent_felt_n_m := NAN
## The pull at which the socket let go.
var release_expected_n := NAN
var release_felt_n := NAN
## Greatest angle at which it was held, and how far it moved in the still hand (peak to peak).
var grasp_angle_rad := NAN
var jitter_m := NAN


## For a play whose touch nobody judges.
func check_nothing() -> void:
	checks_weight = false
	checks_width = false
	checks_detent = false
	checks_release = false


## NaN compares false, so what was never felt is never right.
func weight_ok() -> bool:
	return not checks_weight or _within(weight_felt_n, weight_expected_n, WEIGHT_TOLERANCE)


func width_ok() -> bool:
	return not checks_width or (
		absf(width_felt_m - width_expected_m) <= width_tolerance_m
		and squeeze_torque_nm >= SQUEEZE_FELT_NM
	)


func detent_ok() -> bool:
	return (
		not checks_detent or _within(detent_felt_n_m, detent_expected_n_m, detent_tolerance)
	) and (
		not checks_release or _within(release_felt_n, release_expected_n, RELEASE_TOLERANCE)
	)


func all_ok() -> bool:
	return weight_ok() and width_ok() and detent_ok()


func _within(value: float, expected: float, share: float) -> bool:
	return absf(value - expected) <= share * absf(expected)
