extends RefCounted
## What a person has chosen in the menu; kept in user://settings.cfg.

const DemoSettings := preload("res://ui/demo_settings.gd")
const PictureQuality := preload("res://scene/picture_quality.gd")
const PlayArguments := preload("res://play/play_arguments.gd")
const TextSize := preload("res://ui/text_size.gd")

const PATH := "user://settings.cfg"
const RATES_HZ: PackedInt32Array = [500, 1000, 2000]
const SCALES: PackedFloat64Array = [0.5, 1.0, 2.0]

## What the grip in the scene follows, and grip_source in the results.
const SIMULATED := "simulated" ## The simulated device, its hand moved by mouse and keys; with forces.
const DEVICE := "device" ## A SPIDAR-G on USB.
const SERIAL := "serial" ## A SPIDAR on serial motor boards.
const MOUSE := "mouse" ## The paper's comparison: mouse and keys alone, never a force.
const REPLAY := "replay" ## A recording, in the tasks; the menu needs a live hand.
const SOURCES: PackedStringArray = [SIMULATED, DEVICE, SERIAL, MOUSE, REPLAY]
const CLUTCHES: PackedStringArray = ["held", "switched"]
## Where L puts the recordings.
const RECORDINGS := "user://recordings"

var source := SIMULATED
## USB serial number of the device; empty: the first one found.
var device_serial := ""
## Of the motor boards; empty: the only one of a USB bridge.
var serial_port := ""
## File in RECORDINGS.
var recording := ""
## Whether F may turn the forces on; they are off at the start either way.
var forces_allowed := true
## Scene metres for each metre of the hand.
var workspace_scale := 1.0
var rate_hz := 1000
## One of CLUTCHES: the clutch acts while C is held, or C switches it on and off.
var clutch := CLUTCHES[0]
## A click on a thing, and one on its target, move the grip there: what the paper gave its mouse users.
var auto_animation := false
## One of PictureQuality.CHOICES.
var picture := PictureQuality.AUTOMATIC
## One of TextSize.CHOICES_PERCENT.
var text_percent := 100
## Whether the guided start has been finished or skipped.
var guide_shown := false
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
		spidar.config.device_serial = device_serial
		spidar.config.serial_port = serial_port
		match source:
			DEVICE:
				spidar.config.transport = SpidarGConfig.TRANSPORT_DEVICE
			SERIAL:
				spidar.config.transport = SpidarGConfig.TRANSPORT_SERIAL
			_:
				spidar.config.transport = SpidarGConfig.TRANSPORT_SIMULATED


func may_have_forces() -> bool:
	return forces_allowed and source in [SIMULATED, DEVICE, SERIAL]


## Recordings that L has made, the newest first.
static func recordings() -> PackedStringArray:
	var names := PackedStringArray()
	for name in DirAccess.get_files_at(RECORDINGS) if DirAccess.dir_exists_absolute(RECORDINGS) else names:
		if name.ends_with(".rec"):
			names.append(name)
	names.sort()
	names.reverse()
	return names


## Path for a new recording; the folder is made.
static func new_recording(task: String) -> String:
	DirAccess.make_dir_recursive_absolute(RECORDINGS)
	var now := Time.get_datetime_string_from_system(true).replace(":", "-")
	return RECORDINGS.path_join("%s-%s.rec" % [now, task])


func _clamp() -> void:
	if not SOURCES.has(source):
		source = SIMULATED
	if not CLUTCHES.has(clutch):
		clutch = CLUTCHES[0]
	if not RATES_HZ.has(rate_hz):
		rate_hz = 1000
	if not SCALES.has(workspace_scale):
		workspace_scale = 1.0
	if not PictureQuality.CHOICES.has(picture):
		picture = PictureQuality.AUTOMATIC
	if not TextSize.CHOICES_PERCENT.has(text_percent):
		text_percent = 100
	level = clampi(level, 1, PlayArguments.LEVELS)
	computer_experience = clampi(computer_experience, 0, 5)
	haptic_experience = clampi(haptic_experience, 0, 5)


func _keys() -> PackedStringArray:
	return [
		"source", "device_serial", "recording", "forces_allowed", "workspace_scale", "rate_hz", "clutch", "auto_animation",
		"picture", "text_percent", "guide_shown", "level", "participant", "computer_experience", "haptic_experience",
	]
