extends "res://tasks/base/demo_task.gd"
## The task: pick every object up and put it on the outline of its own shape, colour and size.
## Kim, Koike and Sato's experiment 2 ("SPIDAR-G", section 7.2), at life size.

const DemoPalette := preload("res://scene/demo_palette.gd")
const ObjectCatalogue := preload("res://tasks/pick_and_place/object_catalogue.gd")
const StandBuilder := preload("res://scene/stand_builder.gd")
const TargetOutline := preload("res://tasks/pick_and_place/target_outline.gd")
const TaskLayout := preload("res://tasks/pick_and_place/task_layout.gd")
const TaskObject := preload("res://tasks/pick_and_place/task_object.gd")


func _lay_out() -> void:
	var specs := ObjectCatalogue.of_level(arguments.level)
	var layout := TaskLayout.make(
		arguments.seed_number, specs, ObjectCatalogue.YAW_RAD[arguments.level - 1]
	)
	for index in specs.size():
		var object := TaskObject.new()
		object.position_tolerance_m = ObjectCatalogue.POSITION_TOLERANCE_M[arguments.level - 1]
		object.rotation_tolerance_rad = ObjectCatalogue.ROTATION_TOLERANCE_RAD[arguments.level - 1]
		var target := TargetOutline.new()
		target.setup(specs[index], layout.targets[index], object.position_tolerance_m)
		_items.add_child(target)
		var stand := StandBuilder.build(specs[index], DemoPalette.STAND)
		if stand != null:
			var pose := layout.starts[index]
			stand.transform = pose.translated_local(Vector3.DOWN * specs[index].rest_height_m())
			_items.add_child(stand)
		object.setup(specs[index], layout.starts[index], target)
		_items.add_child(object)
		bodies.append(object)
