extends "res://tasks/base/demo_task.gd"
## A task of things that link: what robot and matches have in common.

const CameraRig := preload("res://scene/camera_rig.gd")
const Linker := preload("res://scene/linker.gd")

var linker := Linker.new()


func _ready() -> void:
	add_child(linker)
	linker.setup($SpidarG as SpidarG, $SpidarG/SpidarGHand as SpidarGHand)
	super()
	linker.sound_with(sound)
	var view := _view()
	($CameraRig as CameraRig).see(view.x, view.y)


## Of the camera, nearer than in pick and place: how wide (degrees) and how far down (m).
func _view() -> Vector2:
	return Vector2.ZERO
