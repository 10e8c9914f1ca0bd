class_name DemoSettings
extends RefCounted
## What a person has chosen in the menu; kept in user://settings.cfg.

const PATH := "user://settings.cfg"
const RATES_HZ: PackedInt32Array = [500, 1000, 2000]
const SCALES: PackedFloat64Array = [0.5, 1.0, 2.0]

## Serial number or path of a real device; empty: the simulated one.
var device_name := ""
## Whether F may turn the forces on; they are off at the start either way.
var forces_allowed := true
## Scene metres for each metre of the hand.
var workspace_scale := 1.0
var rate_hz := 1000
## A click on a thing, and one on its target, move the grip there: what the paper gave its mouse users.
var auto_animation := false
var level := 1
var participant := ""
## 1 none to 5 a lot; 0 not asked.
var computer_experience := 0
var haptic_experience := 0


static func load_or_default() -> DemoSettings:
	var settings := DemoSettings.new()
	var file := ConfigFile.new()
	if file.load(PATH) != OK:
		return settings
	for key in settings._keys():
		var value: Variant = file.get_value("demo", key, settings.get(key))
		if typeof(value) == typeof(settings.get(key)):
			settings.set(key, value)
	settings._clamp()
	return settings


func save() -> Error:
	var file := ConfigFile.new()
	for key in _keys():
		file.set_value("demo", key, get(key))
	return file.save(PATH)


## Before the device opens.
func apply(spidar: SpidarG) -> void:
	spidar.workspace_scale = workspace_scale
	if spidar.config != null:
		spidar.config.rate_hz = rate_hz
		spidar.config.device_name = device_name


func grip_source() -> String:
	return "mouse" if device_name == "" else "device"


func _clamp() -> void:
	if not RATES_HZ.has(rate_hz):
		rate_hz = 1000
	if not SCALES.has(workspace_scale):
		workspace_scale = 1.0
	level = clampi(level, 1, PlayArguments.LEVELS)
	computer_experience = clampi(computer_experience, 0, 5)
	haptic_experience = clampi(haptic_experience, 0, 5)


func _keys() -> PackedStringArray:
	return [
		"device_name", "forces_allowed", "workspace_scale", "rate_hz", "auto_animation", "level",
		"participant", "computer_experience", "haptic_experience",
	]
