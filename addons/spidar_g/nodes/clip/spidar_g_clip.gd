@tool
@icon("../../icons/spidar_g_clip.svg")
class_name SpidarGClip
extends Resource
## A vibration of limited length, such as a knock, a buzz or a creak, that a [SpidarGClipPlayer] plays in the hand.
##
## A clip is described by numbers or made from a sound.
## [codeblock]
## var knock := SpidarGClip.new()
## knock.frequency = 50.0
## knock.strength = 1.5
## knock.hold = 0.02
## knock.release = 0.08
## print(knock.get_duration()) # Prints 0.1.
## [/codeblock]
## [b]By numbers.[/b] The amplitude rises from 0 to [member strength] in [member attack], stays for [member hold] and falls to
## 0 in [member release]. The frequency is [member frequency] from the beginning to the end.[br]
## [b]From a sound.[/b] The loudness of [member stream] becomes the amplitude, with [member strength] where the sound is
## loudest. The frequency follows the dominant frequency of the sound. If the mean of this frequency is outside 5 to 250 Hz,
## the whole sound is moved by octaves until the mean is inside: 440 Hz becomes 220 Hz. A frequency that is still outside is
## set to 5 or 250 Hz. The sound itself is not played: use an [AudioStreamPlayer] for it.[br]
## [b]Accuracy.[/b] The servo loop renders a sine, and the game changes its amplitude and frequency in each physics tick.
## Amplitudes between two ticks are interpolated. A rise or a fall therefore takes at least 16 ms, and a clip that is shorter
## than a tick lasts one tick. If the clip is shorter than half a period of its frequency, the sine does not reach its
## peak.[br]
## [b]Strength.[/b] [member strength] is the requested amplitude. Because the strings are elastic, the achieved amplitude
## differs from it. On the simulated device with its default strings, the achieved amplitude is within 10 % of the requested
## one at 20 to 40 Hz. It is 1.2 times as large at 60 Hz, 1.8 times at 80 Hz, 2 to 3.6 times at 100 to 120 Hz, and a tenth at
## 250 Hz. With rigid strings ([member SpidarGConfig.simulated_elastic] off) it is within 10 % up to 120 Hz, 13 % smaller at
## 150 Hz and 27 % smaller at 250 Hz. This was not measured on a real device: begin with weak clips.

const _InRange := preload("../values/in_range.gd")
const _WavFeel := preload("wav_feel.gd")

## The largest amplitude that the servo loop gives to a vibration, in newtons. [member strength] times [member gain] is
## clamped to it.
const MOST_N: float = 2.0

## Sets the sound that the clip is made from: 8 or 16 bits, mono or stereo. If it is [code]null[/code], the clip is described
## by [member frequency], [member attack], [member hold] and [member release].[br]
## A clip is not played if its sound is compressed (QOA or IMA ADPCM), has no samples, or has a mix rate below 1000 Hz. An
## error and [method get_problem] then state the remedy. A sound longer than 5 s is cut there with a warning. The sound is
## converted when the clip is first used. Set the property again after you have changed the samples of the same stream.
@export var stream: AudioStreamWAV:
	set(value):
		stream = value
		_sound = null
		if stream != null and not _WavFeel.problem(stream).is_empty():
			push_error("%s is not played: %s" % [_label(), _WavFeel.problem(stream)])
		notify_property_list_changed()
		emit_changed()
## Sets the requested amplitude where the clip is strongest, in newtons, from 0 to 2. Another value is refused with an error,
## and the old one stays.
@export_range(0.0, 2.0, 0.05, "suffix:N") var strength: float = 1.0:
	set(value):
		strength = _checked("strength", value, strength, "N", 0.0, MOST_N)
		emit_changed()
## Sets a factor for [member strength], from 0 to 10, such as a volume setting of the game. The product is clamped to 2 N.
## Another value is refused with an error, and the old one stays.
@export_range(0.0, 10.0, 0.05) var gain: float = 1.0:
	set(value):
		gain = _checked("gain", value, gain, "", 0.0, 10.0)
		emit_changed()
## Sets the frequency of the vibration, in hertz, from 5 to 250. A frequency above a quarter of the servo rate is lowered to
## it. In a clip with a [member stream], this property is used only if no frequency is found in the sound. Another value is
## refused with an error, and the old one stays.
@export_range(5.0, 250.0, 0.1, "suffix:Hz") var frequency: float = 50.0:
	set(value):
		frequency = _checked("frequency", value, frequency, "Hz", _WavFeel.LEAST_HZ, _WavFeel.MOST_HZ)
		_sound = null
		emit_changed()
@export_group("Envelope")
## Sets the time in which the amplitude rises to [member strength], in seconds, from 0 to 5. Ignored if there is a
## [member stream]. Another value is refused with an error, and the old one stays.
@export_range(0.0, 5.0, 0.001, "suffix:s") var attack: float = 0.0:
	set(value):
		attack = _checked("attack", value, attack, "s", 0.0, _WavFeel.LONGEST_S)
		emit_changed()
## Sets the time for which the amplitude stays at [member strength], in seconds, from 0 to 5. Ignored if there is a
## [member stream]. Another value is refused with an error, and the old one stays.
@export_range(0.0, 5.0, 0.001, "suffix:s") var hold: float = 0.05:
	set(value):
		hold = _checked("hold", value, hold, "s", 0.0, _WavFeel.LONGEST_S)
		emit_changed()
## Sets the time in which the amplitude falls to 0, in seconds, from 0 to 5. Ignored if there is a [member stream]. Another
## value is refused with an error, and the old one stays.
@export_range(0.0, 5.0, 0.001, "suffix:s") var release: float = 0.05:
	set(value):
		release = _checked("release", value, release, "s", 0.0, _WavFeel.LONGEST_S)
		emit_changed()
@export_group("Direction")
## If [code]true[/code], the hand is shaken along the normal of the surface that it touches, or along the axis of its jaws if
## it grasps or lets go of a body. If [code]false[/code], or if the hand does none of these, it is shaken along
## [member direction].
@export var along_normal: bool = true:
	set(value):
		along_normal = value
		emit_changed()
## Sets the direction in which the hand is shaken, in world coordinates. The length does not matter. A zero vector or one that
## is not finite is refused with an error, and the old one stays.
@export var direction: Vector3 = Vector3.UP:
	set(value):
		if not value.is_finite() or value.is_zero_approx():
			push_error("%s: direction = %s: give a finite direction that is not zero; the old one stays." % [_label(), value])
			return
		direction = value
		emit_changed()

var _sound: _WavFeel = null


## Returns the length of the clip in seconds. Returns 0 if the clip has a [method get_problem].
func get_duration() -> float:
	if stream == null:
		return attack + hold + release
	return _hear().duration_s if get_problem().is_empty() else 0.0


## Returns why the clip cannot be played, as a sentence with the remedy. Returns an empty string if it can be played.
func get_problem() -> String:
	if stream == null:
		return "" if attack + hold + release > 0.0 else "attack, hold and release are 0 s: make one of them longer."
	# This method is called in each tick: a stream that was converted is not examined again.
	var problem: String = _WavFeel.problem(stream) if _sound == null else ""
	if problem.is_empty() and _hear().loudness.is_empty():
		problem = "its stream is silent: give a louder sound."
	return problem


## Returns the amplitude at [param time_s] seconds after the beginning, in newtons, including [member gain]. Returns 0 before
## the beginning, at the end and after it, and if the clip has a [method get_problem].
func get_strength_at(time_s: float) -> float:
	if not (time_s >= 0.0 and time_s < get_duration()):
		return 0.0
	return _full_n() * (_level(time_s) if stream == null else _hear().loudness_at(time_s))


## Returns the largest amplitude from [param from_s] to [param to_s] seconds after the beginning, in newtons, including
## [member gain].
func get_peak_strength(from_s: float, to_s: float) -> float:
	var first: float = maxf(from_s, 0.0)
	var last: float = minf(to_s, get_duration())
	if not first < last:
		return get_strength_at(from_s)
	if stream != null:
		return _full_n() * _hear().loudest_between(first, last)
	if first <= attack + hold and last >= attack:
		return _full_n()
	return _full_n() * maxf(_level(first), _level(last))


## Returns the frequency at [param time_s] seconds after the beginning, in hertz, from 5 to 250.
func get_frequency_at(time_s: float) -> float:
	if stream == null or not get_problem().is_empty():
		return frequency
	return _hear().frequency_at(time_s)


func _validate_property(property: Dictionary) -> void:
	var of_numbers: bool = ["attack", "hold", "release"].has(property["name"])
	if of_numbers and stream != null:
		property["usage"] = PROPERTY_USAGE_NO_EDITOR


func _full_n() -> float:
	return minf(strength * gain, MOST_N)


# Returns the level of the envelope by numbers, from 0 to 1.
func _level(time_s: float) -> float:
	if time_s < attack:
		return time_s / attack
	var fallen: float = time_s - attack - hold
	return clampf(1.0 - fallen / release, 0.0, 1.0) if fallen > 0.0 and release > 0.0 else 1.0


# Returns what can be felt of the stream, converted at the first call. The stream must have no problem.
func _hear() -> _WavFeel:
	if _sound == null:
		_sound = _WavFeel.make(stream, frequency)
		if _sound.was_cut:
			push_warning("%s is cut after %s s: its stream is longer. Give a shorter sound." % [_label(), _WavFeel.LONGEST_S])
	return _sound


func _label() -> String:
	var named: String = resource_name if not resource_name.is_empty() else resource_path.get_file()
	return "SpidarGClip" if named.is_empty() else "SpidarGClip \"%s\"" % named


func _checked(field: String, value: float, old: float, unit: String, least: float, most: float) -> float:
	return _InRange.checked(_label(), field, value, old, unit, least, most)
