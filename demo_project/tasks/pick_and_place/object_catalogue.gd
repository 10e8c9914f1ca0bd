class_name ObjectCatalogue
extends RefCounted
## The seven things of this task: 3 masses (50, 120, 250 g), 3 widths (20, 35, 50 mm) and a thin stick.


static func all() -> Array[ObjectSpec]:
	var box := ObjectSpec.Shape.BOX
	var cylinder := ObjectSpec.Shape.CYLINDER
	var sphere := ObjectSpec.Shape.SPHERE
	var table := ObjectSpec.Stand.TABLE
	return [
		ObjectSpec.make(
			"blue_box", box, Vector3(0.035, 0.060, 0.035), 0.120, DemoPalette.BLUE, table
		),
		ObjectSpec.make(
			"teal_cylinder", cylinder, Vector3(0.050, 0.058, 0.050), 0.250, DemoPalette.TEAL, table
		),
		ObjectSpec.make(
			"coral_slab", box, Vector3(0.020, 0.062, 0.036), 0.050, DemoPalette.CORAL, table
		),
		ObjectSpec.make(
			"mustard_cylinder", cylinder, Vector3(0.035, 0.064, 0.035), 0.050,
			DemoPalette.MUSTARD, table
		),
		ObjectSpec.make(
			"plum_brick", box, Vector3(0.050, 0.058, 0.030), 0.250, DemoPalette.PLUM, table
		),
		ObjectSpec.make(
			"sage_ball", sphere, Vector3.ONE * 0.050, 0.120, DemoPalette.SAGE,
			ObjectSpec.Stand.RING
		),
		ObjectSpec.make(
			"bone_stick", box, Vector3(0.012, 0.012, 0.060), 0.050, DemoPalette.BONE,
			ObjectSpec.Stand.RACK
		),
	]
