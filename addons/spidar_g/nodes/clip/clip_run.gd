extends RefCounted
## Plays one clip on one device: the servo loop renders the vibration, and each physics tick refreshes it.

## The duration of each refresh, in seconds. If the game hangs, the effect ends after this time and a fade of 50 ms.
const RENEWED_FOR_S: float = 0.05
## The minimum duration of each refresh, in physics ticks. It is longer than the duration above if there are fewer
## than 50 ticks per second.
const RENEWED_FOR_TICKS: float = 2.5
## The time in which the servo loop moves to a new amplitude, in seconds. Each step looks ahead by this
## time, or by one physics tick if a tick is longer. It requests the amplitude that the clip has then, or the peak if the clip
## has one in between.
const CROSS_FADE_S: float = 0.016

var spidar: SpidarG
## If [code]true[/code], the clip starts again at its end, until [method end] is called.
var loops: bool = false

var _clip: SpidarGClip
var _id: int
# Unit vector in world coordinates.
var _direction: Vector3
var _share: float
var _began_s: float = 0.0
var _ends: bool = false
# The amplitude requested in the last step, in newtons.
var _given_n: float = 0.0
# The time of the last step, in seconds from the beginning of the clip.
var _stepped_s: float = -1.0
# Nothing more is requested; the vibration fades.
var _fades: bool = false


# share: of the clip's strength, from 0 to 1. direction: in world coordinates, not zero.
func _init(of: SpidarG, clip: SpidarGClip, id: int, direction: Vector3, share: float, is_loop: bool) -> void:
	spidar = of
	loops = is_loop
	_clip = clip
	_id = id
	_direction = direction.normalized()
	_share = share
	_began_s = of.get_device_time()


## Refreshes the vibration. Returns [code]false[/code] when the clip is over and has faded, and if the device is closed or
## refuses the effect.
func step(tick_s: float) -> bool:
	if not is_instance_valid(spidar) or spidar.get_state() == SpidarG.STATE_CLOSED:
		return false
	var now_s: float = spidar.get_device_time() - _began_s
	if _fades:
		return now_s - _stepped_s < CROSS_FADE_S
	if now_s == _stepped_s: # the device has not rendered the last request yet
		return true
	_stepped_s = now_s
	var lasts_s: float = _clip.get_duration()
	var is_over: bool = _ends or lasts_s <= 0.0 or (now_s >= lasts_s and not loops)
	var at_s: float = fmod(now_s, lasts_s) if lasts_s > 0.0 else 0.0
	var ahead_s: float = maxf(tick_s, CROSS_FADE_S)
	_given_n = 0.0 if is_over else _due(at_s, lasts_s, ahead_s)
	# Requested only once: each refresh would begin the fade anew.
	_fades = is_over or (not loops and now_s + ahead_s >= lasts_s and _given_n <= 0.0)
	var holds_s: float = maxf(RENEWED_FOR_S, RENEWED_FOR_TICKS * tick_s)
	return spidar.set_vibration_effect(
		_id, _given_n * _direction, Vector3.ZERO, 0.0, _clip.get_frequency_at(at_s), holds_s
	)


## Ends the clip: the next [method step] requests the amplitude 0, and the vibration fades.
func end() -> void:
	_ends = true


## Ends the vibration at once: the device lets it fade within 16 ms.
func stop() -> void:
	if is_instance_valid(spidar):
		spidar.clear_effect(_id)


# Returns the amplitude at the end of the tick from `at_s` on. If the clip has a peak within the tick, returns the peak.
func _due(at_s: float, lasts_s: float, tick_s: float) -> float:
	var later_s: float = at_s + tick_s
	var most_n: float = _clip.get_peak_strength(at_s, later_s)
	var last_n: float = _clip.get_strength_at(later_s)
	if loops and later_s >= lasts_s:
		later_s = fmod(later_s, lasts_s)
		last_n = _clip.get_strength_at(later_s)
		most_n = maxf(most_n, _clip.get_peak_strength(0.0, later_s))
	return _share * (most_n if most_n > maxf(_given_n / _share, last_n) else last_n)
