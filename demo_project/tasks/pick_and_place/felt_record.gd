class_name FeltRecord
extends RefCounted
## What the hand felt of one object, all of it from the strings' pull on the grip, and whether that is
## what the object really is.

const WEIGHT_TOLERANCE := 0.15
const WIDTH_TOLERANCE_M := 0.003
## A squeeze weaker than this at the fingers is not felt as a thing between them.
const SQUEEZE_FELT_NM := 0.015

var weight_expected_n := NAN
var weight_felt_n := NAN
var width_expected_m := NAN
var width_felt_m := NAN
var squeeze_torque_nm := NAN


## NaN compares false, so what was never felt is never right.
func weight_ok() -> bool:
	return absf(weight_felt_n - weight_expected_n) <= WEIGHT_TOLERANCE * weight_expected_n


func width_ok() -> bool:
	return (
		absf(width_felt_m - width_expected_m) <= WIDTH_TOLERANCE_M
		and squeeze_torque_nm >= SQUEEZE_FELT_NM
	)
