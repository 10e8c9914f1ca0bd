extends RefCounted
## Connects a [SpidarGClipPlayer] to the signals of its source, and emits its events.

## Emitted when the event occurs. `direction` is a unit vector: the normal of the touch, or the axis of the jaws for a grasp.
## It is zero if it is unknown. `speed` is the speed of an Event.IMPACT in meters of device motion per second, and 0 for other
## events.
signal occurred(hand: SpidarGHand, direction: Vector3, speed: float)
## Emitted when the hand no longer presses on the surface, for Event.TOUCH and Event.IMPACT alone.
signal left(hand: SpidarGHand)
## Emitted when the hand no longer slips along the surface, for Event.SLIP alone.
signal slip_ended(hand: SpidarGHand)
## Emitted when the children of the source have changed: a surface may have come or gone.
signal source_changed

const Event := SpidarGClipPlayer.Event
const Approach := preload("approach.gd")
const Source := preload("clip_source.gd")

## The weight of a normal is the force at its point plus this value, in newtons, so that a point without force counts too.
const LEAST_WEIGHT_N: float = 0.001
## Normals oppose each other if the length of their weighted sum is at most this share of the sum of their weights.
const OPPOSED: float = 0.3

var source: Source = null

var _event := Event.NONE
var _approach := Approach.new()
# The connected signals. The callable of each one has the same place in _answers.
var _signals: Array[Signal] = []
var _answers: Array[Callable] = []


## Connects the signals that report `event` at the source `from`. `hands` are all hands of the scene tree.
func connect_to(event: Event, from: Source, hands: Array[SpidarGHand]) -> void:
	var is_same: bool = source != null and source.surface == from.surface and _event == event
	leave()
	if not is_same:
		_approach.forget()
	source = from
	_event = event
	if source.node != null:
		_answer(source.node.child_order_changed, source_changed.emit)
	match event:
		Event.TOUCH, Event.IMPACT:
			if source.surface != null:
				_answer(source.surface.touched, _on_touched)
				_answer(source.surface.touch_ended, left.emit)
		Event.TOUCH_END:
			if source.surface != null:
				_answer(source.surface.touch_ended, _on_touch_ended)
		Event.SLIP:
			if source.surface != null:
				_answer(source.surface.slip_started, _on_slip_started)
				_answer(source.surface.slip_ended, _on_slip_ended)
		Event.GRASP, Event.RELEASE:
			for hand: SpidarGHand in hands:
				if hand == source.hand or source.body != null:
					var told: Signal = hand.body_grasped if event == Event.GRASP else hand.body_released
					_answer(told, _on_body.bind(hand.get_instance_id()))


## Disconnects everything, and forgets the source.
func leave() -> void:
	for i: int in _signals.size():
		if _signals[i].get_object() != null and _signals[i].is_connected(_answers[i]):
			_signals[i].disconnect(_answers[i])
	_signals.clear()
	_answers.clear()
	source = null


## Returns [code]true[/code] if the source has a surface, and the surface is in the scene tree.
func has_surface() -> bool:
	return source != null and is_instance_valid(source.surface) and source.surface.is_inside_tree()


## Records the motion of the body and of the hands, from which the speed of an Event.IMPACT is computed. Call it once per
## physics tick.
func note_motion(hands: Array[SpidarGHand]) -> void:
	if has_surface() and source.body != null:
		_approach.note(source.body, hands)


## Returns the mean normal of the points at which `hand` touches `body`, or any body if `body` is [code]null[/code], as a unit
## vector. Returns zero if nothing is touched. If the normals oppose each other, as for a body between the pads, returns the
## axis of the jaws.
static func normal_at(hand: SpidarGHand, body: Node) -> Vector3:
	var sum := Vector3.ZERO
	var weights: float = 0.0
	for point: Dictionary in hand.get_touch_points():
		var force: Vector3 = point["force"]
		if (body == null and force.is_zero_approx()) or (body != null and point["collider"] != body):
			continue
		var weight: float = force.length() + LEAST_WEIGHT_N
		sum += weight * (point["normal"] as Vector3)
		weights += weight
	if weights <= 0.0:
		return Vector3.ZERO
	return sum.normalized() if sum.length() > OPPOSED * weights else jaw_axis(hand)


## Returns the axis of the jaws in the world, as a unit vector.
static func jaw_axis(hand: SpidarGHand) -> Vector3:
	return hand.get_proxy_transform().basis.x.normalized()


func _answer(told: Signal, by: Callable) -> void:
	told.connect(by)
	_signals.append(told)
	_answers.append(by)


func _on_touched(hand: SpidarGHand, point: Vector3, _force: float) -> void:
	var normal: Vector3 = normal_at(hand, source.body)
	occurred.emit(hand, normal, _approach.speed(hand, point, normal) if _event == Event.IMPACT else 0.0)


func _on_touch_ended(hand: SpidarGHand) -> void:
	if is_instance_valid(hand) and hand.is_inside_tree():
		occurred.emit(hand, normal_at(hand, source.body), 0.0)


func _on_slip_started(hand: SpidarGHand, _speed: float) -> void:
	occurred.emit(hand, normal_at(hand, source.body), 0.0)


func _on_slip_ended(hand: SpidarGHand) -> void:
	slip_ended.emit(hand)


func _on_body(body: Node, hand_id: int) -> void:
	var hand: SpidarGHand = instance_from_id(hand_id) as SpidarGHand
	if hand != null and hand.is_inside_tree() and (source.body == null or source.body == body):
		occurred.emit(hand, jaw_axis(hand), 0.0)
