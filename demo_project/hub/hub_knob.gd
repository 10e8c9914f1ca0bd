extends StaticBody3D
## One choice of the menu in the scene: a block that the grip touches and closes on, and its name.

const DemoPalette := preload("res://scene/demo_palette.gd")
const HubKnob := preload("res://hub/hub_knob.gd")
const StandBuilder := preload("res://scene/stand_builder.gd")

const SIZE_M := Vector3(0.026, 0.044, 0.026)
const PLATE_M := Vector3(0.078, 0.003, 0.060)
const TEXT_Y_M := 0.060

var entry: StringName = &""

var _material: StandardMaterial3D
var _label: Label3D


static func make(entry_: StringName, colour: Color) -> HubKnob:
	var knob := HubKnob.new()
	knob.entry = entry_
	knob.name = String(entry_).to_pascal_case()
	StandBuilder.add_block(knob, SIZE_M, Vector3(0.0, 0.5 * SIZE_M.y, 0.0), colour)
	for child in knob.get_children():
		if child is MeshInstance3D:
			knob._material = ((child as MeshInstance3D).mesh as BoxMesh).material
	var plate := MeshInstance3D.new()
	var mesh := BoxMesh.new()
	mesh.size = PLATE_M
	mesh.material = DemoPalette.matte(DemoPalette.STAND)
	plate.mesh = mesh
	plate.position.y = 0.5 * PLATE_M.y
	knob.add_child(plate)
	knob._label = Label3D.new()
	knob._label.billboard = BaseMaterial3D.BILLBOARD_ENABLED
	knob._label.position = Vector3(0.0, TEXT_Y_M, 0.0)
	knob._label.pixel_size = 0.00026
	knob._label.font_size = 48
	knob._label.outline_size = 0
	knob._label.modulate = DemoPalette.TEXT
	knob.add_child(knob._label)
	knob.show_text(String(entry_).replace("_", " ").capitalize())
	return knob


func show_text(text: String) -> void:
	_label.text = text


## Of the block's middle, where the fingers go.
func distance_to(point: Vector3) -> float:
	return point.distance_to(to_global(Vector3(0.0, 0.5 * SIZE_M.y, 0.0)))


func show_touched(touched: bool) -> void:
	_material.emission_enabled = touched
	_material.emission = _material.albedo_color
	_material.emission_energy_multiplier = 0.5
	_label.modulate = DemoPalette.ACCENT if touched else DemoPalette.TEXT
