extends RefCounted
## Computes what can be felt of a recorded sound: its loudness and its dominant frequency over time. Both are computed once
## from the samples.

## The sound is divided into frames of this length, in seconds. Each frame has a loudness and a frequency.
const FRAME_S: float = 0.005
## A longer sound is cut to this length, in seconds.
const LONGEST_S: float = 5.0
## The servo loop renders no frequency below this one, in hertz.
const LEAST_HZ: float = 5.0
## The servo loop renders no frequency above this one, in hertz.
const MOST_HZ: float = 250.0
## Changes of the samples that are slower than this, in hertz, are an offset of the recording and not sound. They are removed.
const OFFSET_HZ: float = 2.0
## A zero crossing counts only if the wave then exceeds this share of its recent peak, so that noise adds no crossings.
const CLEAR_OF_ZERO: float = 0.25
## The time constant with which the recent peak falls, in seconds.
const PEAK_FORGOTTEN_S: float = 0.05
## The frequency of a frame is computed from the zero crossings up to this time before and after its middle, in seconds.
const HEARD_WITHIN_S: float = 0.02
## The weights of a frame (the middle one) and of its two neighbors on each side in its loudness. The loudness of one frame
## alone would follow the wave itself.
const SMOOTHING: Array[float] = [1.0, 2.0, 3.0, 2.0, 1.0]
## A sound whose loudest frame has less than this share of the full scale counts as silence.
const SILENCE: float = 1e-3
const SIXTEEN_BITS: float = 1.0 / 32768.0
const EIGHT_BITS: float = 1.0 / 128.0

## The length of the sound after the cut, in seconds.
var duration_s: float = 0.0
## The loudness of each frame, from 0 to 1 in the loudest frame. The array is empty if the sound is silent.
var loudness: PackedFloat32Array = []
## The frequency of each frame, in hertz, clamped to 5 to 250 Hz.
var frequencies: PackedFloat32Array = []
## If [code]true[/code], the sound was longer than [constant LONGEST_S].
var was_cut: bool = false

var _energies: PackedFloat64Array = []
# The times of the upward zero crossings, in seconds.
var _crossings: PackedFloat64Array = []


## Returns why this sound cannot be felt, with a remedy. Returns an empty string if it can be felt.
static func problem(stream: AudioStreamWAV) -> String:
	const REMEDY: String = "select the file, set Import > Compress > Mode to PCM (Uncompressed) and press Reimport."
	match stream.format:
		AudioStreamWAV.FORMAT_QOA:
			return "its stream is compressed as QOA: " + REMEDY
		AudioStreamWAV.FORMAT_IMA_ADPCM:
			return "its stream is compressed as IMA ADPCM: " + REMEDY
	if stream.mix_rate < 1000:
		return "its stream has a mix_rate of %d Hz: give a sound of 1000 Hz or more." % stream.mix_rate
	if stream.data.size() < _bytes_a_sample(stream):
		return "its stream has no samples: give a sound."
	return ""


## Returns the loudness and the frequencies of `stream` as a new object of this class. Call it only if [method problem]
## returns an empty string for `stream`. `otherwise_hz` is the frequency if none is found in the sound.
static func make(stream: AudioStreamWAV, otherwise_hz: float) -> RefCounted:
	var feel: RefCounted = new()
	feel._take(stream, otherwise_hz)
	return feel


## Returns the loudness at `time_s` seconds after the beginning, from 0 to 1, interpolated between the middles of two frames.
func loudness_at(time_s: float) -> float:
	return _at(loudness, time_s)


## Returns the frequency at `time_s` seconds after the beginning, in hertz, interpolated like the loudness.
func frequency_at(time_s: float) -> float:
	return _at(frequencies, time_s)


## Returns the largest loudness between two times, in seconds after the beginning.
func loudest_between(from_s: float, to_s: float) -> float:
	var most: float = maxf(loudness_at(from_s), loudness_at(to_s))
	var first: int = maxi(0, ceili(from_s / FRAME_S - 0.5))
	for frame: int in range(first, mini(loudness.size(), floori(to_s / FRAME_S - 0.5) + 1)):
		most = maxf(most, loudness[frame])
	return most


static func _at(values: PackedFloat32Array, time_s: float) -> float:
	if values.is_empty():
		return 0.0
	var place: float = clampf(time_s / FRAME_S - 0.5, 0.0, values.size() - 1.0)
	var before: int = floori(place)
	return lerpf(values[before], values[mini(before + 1, values.size() - 1)], place - before)


static func _bytes_a_sample(stream: AudioStreamWAV) -> int:
	return (2 if stream.stereo else 1) * (2 if stream.format == AudioStreamWAV.FORMAT_16_BITS else 1)


func _take(stream: AudioStreamWAV, otherwise_hz: float) -> void:
	var rate: float = stream.mix_rate
	var data: PackedByteArray = stream.data
	var whole: int = data.size() / _bytes_a_sample(stream)
	var count: int = mini(whole, int(LONGEST_S * rate))
	was_cut = count < whole
	duration_s = count / rate
	_listen(_samples(data, count, stream.format == AudioStreamWAV.FORMAT_16_BITS, stream.stereo), rate)
	_weigh()
	if not loudness.is_empty():
		_tune(otherwise_hz)
	_energies.clear()
	_crossings.clear()


# Returns the samples as floats, with both channels mixed.
static func _samples(data: PackedByteArray, count: int, has_16_bits: bool, stereo: bool) -> PackedFloat32Array:
	var samples: PackedFloat32Array = []
	samples.resize(count)
	if has_16_bits and stereo:
		for i: int in count:
			samples[i] = 0.5 * SIXTEEN_BITS * (data.decode_s16(4 * i) + data.decode_s16(4 * i + 2))
	elif has_16_bits:
		for i: int in count:
			samples[i] = SIXTEEN_BITS * data.decode_s16(2 * i)
	elif stereo:
		for i: int in count:
			samples[i] = 0.5 * EIGHT_BITS * (data.decode_s8(2 * i) + data.decode_s8(2 * i + 1))
	else:
		for i: int in count:
			samples[i] = EIGHT_BITS * data.decode_s8(i)
	return samples


# Computes the mean square of each frame, and the upward zero crossings.
func _listen(samples: PackedFloat32Array, rate: float) -> void:
	var keeps: float = 1.0 - TAU * OFFSET_HZ / rate
	var peak_keeps: float = exp(-1.0 / (PEAK_FORGOTTEN_S * rate))
	var last: float = samples[0]
	var wave: float = 0.0
	var peak: float = 0.0
	var crossing: float = 0.0
	var was_below: bool = false
	var a_frame: float = FRAME_S * rate
	for frame: int in ceili(samples.size() / a_frame):
		var first: int = int(frame * a_frame)
		var end: int = mini(int((frame + 1) * a_frame), samples.size())
		var energy: float = 0.0
		for i: int in range(first, end):
			var before: float = wave
			wave = keeps * (wave + samples[i] - last)
			last = samples[i]
			energy += wave * wave
			peak = maxf(absf(wave), peak * peak_keeps)
			if before < 0.0 and wave >= 0.0:
				crossing = (i - wave / (wave - before)) / rate
			if was_below and wave > CLEAR_OF_ZERO * peak:
				_crossings.append(crossing)
				was_below = false
			elif wave < -CLEAR_OF_ZERO * peak:
				was_below = true
		if end > first:
			_energies.append(energy / (end - first))


# Computes the loudness of the frames from their energies.
func _weigh() -> void:
	var most: float = 0.0
	loudness.resize(_energies.size())
	for frame: int in _energies.size():
		var sum: float = 0.0
		var weights: float = 0.0
		for k: int in SMOOTHING.size():
			var at: int = frame + k - SMOOTHING.size() / 2
			if at >= 0 and at < _energies.size():
				sum += SMOOTHING[k] * _energies[at]
				weights += SMOOTHING[k]
		loudness[frame] = sqrt(2.0 * sum / weights) # the amplitude of a sine
		most = maxf(most, loudness[frame])
	if most < SILENCE:
		loudness.clear()
	for frame: int in loudness.size():
		loudness[frame] /= most


# Computes the frequency of each frame. All frames are moved by the same number of octaves, so that a rising tone still
# rises.
func _tune(otherwise_hz: float) -> void:
	var found: PackedFloat64Array = _heard()
	var pitch: float = 0.0
	var weights: float = 0.0
	for frame: int in found.size():
		if found[frame] > 0.0:
			var weight: float = loudness[frame] * loudness[frame]
			pitch += weight * log(found[frame])
			weights += weight
	var middle_hz: float = exp(pitch / weights) if weights > 0.0 else otherwise_hz
	var factor: float = 1.0
	while middle_hz * factor > MOST_HZ:
		factor *= 0.5
	while middle_hz * factor < LEAST_HZ:
		factor *= 2.0
	frequencies.resize(loudness.size())
	var hz: float = middle_hz
	for frame: int in loudness.size():
		hz = found[frame] if found[frame] > 0.0 else hz
		frequencies[frame] = clampf(hz * factor, LEAST_HZ, MOST_HZ)


# Returns the frequency around the middle of each frame before it is moved by octaves, or 0 if none is found.
func _heard() -> PackedFloat64Array:
	var found: PackedFloat64Array = []
	found.resize(loudness.size())
	for frame: int in loudness.size():
		var middle_s: float = (frame + 0.5) * FRAME_S
		var first: int = _crossings.bsearch(middle_s - HEARD_WITHIN_S)
		var last: int = _crossings.bsearch(middle_s + HEARD_WITHIN_S, false) - 1
		if last <= first: # a low tone: its crossings on both sides
			first = _crossings.bsearch(middle_s, false) - 1
			last = first + 1
		if first < 0 or last >= _crossings.size() or last <= first:
			continue
		var hz: float = (last - first) / (_crossings[last] - _crossings[first])
		found[frame] = hz if hz >= LEAST_HZ else 0.0
	return found
