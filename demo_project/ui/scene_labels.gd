extends CanvasLayer
## The names of things in the scene, drawn on the screen above the scene, so that nothing in the scene hides them. Each Label3D
## below the watched node is replaced by a label that keeps clear of the grip, of the panels and of the other labels. A thin
## line leads from a label that had to move to its thing. A label is never nearer to another thing than to its own; one for
## which there is no free place is left out.

const TextSize := preload("res://ui/text_size.gd")

## Between a label and what it keeps clear of.
const GAP_PX := 4.0
## Where the middle of a label is tried, in its own widths and heights from its thing: above, beside, below it, then farther.
const PLACES: Array[Vector2] = [
	Vector2(0.0, -0.5), Vector2(0.0, -1.6), Vector2(-0.6, 0.0), Vector2(0.6, 0.0), Vector2(0.0, 0.8), Vector2(0.0, 2.0),
	Vector2(0.0, -2.7), Vector2(-0.6, -1.1), Vector2(0.6, -1.1), Vector2(-0.6, 1.1), Vector2(0.6, 1.1), Vector2(0.0, 3.2),
	Vector2(0.0, -3.8), Vector2(-0.8, -2.2), Vector2(0.8, -2.2), Vector2(-0.8, 2.2), Vector2(0.8, 2.2), Vector2(0.0, 4.4),
	Vector2(-1.2, 0.0), Vector2(1.2, 0.0), Vector2(0.0, -5.0), Vector2(-1.0, -3.3), Vector2(1.0, -3.3), Vector2(-1.0, 3.3),
	Vector2(1.0, 3.3), Vector2(0.0, 5.6), Vector2(0.0, -6.2), Vector2(0.0, 6.8), Vector2(-0.6, 4.5), Vector2(0.6, 4.5),
	Vector2(-0.6, -4.5), Vector2(0.6, -4.5),
]
const LINE_COLOR := Color(0.925, 0.91, 0.871, 0.6)

## Controls on the screen that no label may touch; called each frame, returns an Array[Control].
var obstacles := Callable()

var _spidar: SpidarG
var _hand: SpidarGHand
var _sources: Array[Label3D] = []
var _labels: Array[Label] = []
## By label: the number of its place in PLACES; -1: it has none.
var _places: Array[int] = []
## By label: where its thing is on the screen, in this frame.
var _at: Array[Vector2] = []

@onready var _screen: Control = $Screen
@onready var _lines: Control = $Lines


func _ready() -> void:
	_lines.draw.connect(_draw_lines)


## Replaces the Label3D nodes below `top`. Call again when others have come.
func watch(top: Node, spidar: SpidarG, hand: SpidarGHand, text_percent: int) -> void:
	_spidar = spidar
	_hand = hand
	_sources.clear()
	_labels.clear()
	_places.clear()
	_at.clear()
	for child in _screen.get_children():
		_screen.remove_child(child)
		child.queue_free()
	for source: Label3D in top.find_children("*", "Label3D", true, false):
		source.visible = false
		var label: Label = ($Pattern as Label).duplicate()
		label.visible = true
		_screen.add_child(label)
		_sources.append(source)
		_labels.append(label)
		_places.append(0)
	set_text_percent(text_percent)


## percent: one of TextSize.CHOICES_PERCENT.
func set_text_percent(percent: int) -> void:
	TextSize.apply(_screen, percent)


## The labels that are on the screen now.
func shown() -> Array[Label]:
	return _labels.filter(func(label: Label) -> bool: return label.is_visible_in_tree())


## Rectangles on the screen around what is drawn of the hand: the grip, and each pad, which a surface can hold back.
func hand_rects() -> Array[Rect2]:
	var camera := get_viewport().get_camera_3d()
	var grip := Rect2(camera.unproject_position(_spidar.get_grip_transform().origin), Vector2.ZERO)
	for string in 8:
		grip = grip.expand(camera.unproject_position(_spidar.get_string_end(string)))
	var rects: Array[Rect2] = [grip.grow(2.0 * GAP_PX)]
	for side in 2:
		var middle := _hand.get_pad_transform(side).origin
		var at := camera.unproject_position(middle)
		var rim := camera.unproject_position(middle + camera.global_basis.x * _hand.get_pad_radius())
		rects.append(Rect2(at, Vector2.ZERO).grow(at.distance_to(rim) + GAP_PX))
	return rects


func _process(_delta: float) -> void:
	var camera := get_viewport().get_camera_3d()
	if _spidar == null or camera == null or not visible:
		return
	var taken := hand_rects()
	if obstacles.is_valid():
		for control: Control in obstacles.call():
			taken.append(control.get_global_rect().grow(GAP_PX))
	_at.assign(_sources.map(func(source: Label3D) -> Vector2: return camera.unproject_position(source.global_position)))
	for index in _in_order(taken[0].get_center()):
		_place(index, taken)
	_lines.queue_redraw()


## Those near the grip choose their places first.
func _in_order(grip: Vector2) -> Array:
	var order := range(_labels.size())
	order.sort_custom(func(one: int, other: int) -> bool:
		return _at[one].distance_squared_to(grip) < _at[other].distance_squared_to(grip))
	return order


func _place(index: int, taken: Array[Rect2]) -> void:
	var label := _labels[index]
	label.text = _sources[index].text
	label.modulate = _sources[index].modulate
	label.size = label.get_combined_minimum_size()
	_places[index] = _free_place(index, label.size, taken)
	label.visible = _places[index] >= 0
	if label.visible:
		label.position = _rect_at(_at[index], label.size, _places[index]).position
		taken.append(Rect2(label.position, label.size).grow(GAP_PX))


## The number of the first free place, the present one before all others so that labels do not jump; -1: there is none.
func _free_place(index: int, size: Vector2, taken: Array[Rect2]) -> int:
	var present := _places[index]
	if _is_free(index, _rect_at(_at[index], size, 0), taken):
		return 0
	if present > 0 and _is_free(index, _rect_at(_at[index], size, present), taken):
		return present
	for number in PLACES.size():
		if _is_free(index, _rect_at(_at[index], size, number), taken):
			return number
	return -1


func _rect_at(at: Vector2, size: Vector2, number: int) -> Rect2:
	return Rect2(at + (PLACES[number] - Vector2(0.5, 0.5)) * size, size)


func _is_free(index: int, rect: Rect2, taken: Array[Rect2]) -> bool:
	if not _screen.get_rect().encloses(rect):
		return false
	for other in taken:
		if other.intersects(rect):
			return false
	var own := _distance(rect, _at[index])
	for other in _at:
		if _distance(rect, other) < own:
			return false
	return true


func _distance(rect: Rect2, point: Vector2) -> float:
	return point.distance_to(point.clamp(rect.position, rect.end))


func _draw_lines() -> void:
	for index in _at.size():
		var rect := _labels[index].get_rect()
		if _labels[index].visible and _distance(rect, _at[index]) > GAP_PX:
			_lines.draw_line(_at[index].clamp(rect.position, rect.end), _at[index], LINE_COLOR, 1.5, true)
