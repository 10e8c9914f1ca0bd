## SpidarGHand: thin and one-sided surfaces let nothing through, every collider has a width, corners of one body are still.
extends "res://hand_shapes_scene.gd"

const THICKNESSES: PackedFloat32Array = [0.001, 0.002, 0.005, 0.02]
const PEG := Vector3(0.03, 0.06, 0.03)


func test_pressed_deep_nothing_is_fallen_through() -> void:
	for thickness: float in THICKNESSES:
		for kind: String in ["box", "csg", "tiles", "server"]:
			await _press_deep("%s of %d mm" % [kind, roundi(1e3 * thickness)], Solids.plate(kind, thickness))
	for kind: String in ["trimesh 400", "trimesh 25", "two-sided 25", "height map", "boundary"]:
		await _press_deep(kind, Solids.plate(kind))
	await _press_deep("height map of 100 mm", Solids.height_map(0.1))


func test_a_firm_hand_does_not_fall_through() -> void:
	firmness = SpidarG.HAND_FIRM
	await _press_deep("box of 1 mm", Solids.plate("box", 0.001))
	await _press_deep("trimesh 400", Solids.plate("trimesh 400"))
	await _press_deep("height map of 100 mm", Solids.height_map(0.1))


func test_every_collider_has_a_width() -> void:
	for kind: String in ["box", "hull", "trimesh", "two-sided", "csg", "grid", "server"]:
		at = Vector3.ZERO
		angle = 0.0
		await set_up_empty()
		var peg: Node3D = _peg(kind)
		add(peg)
		await until_felt()
		await go(Vector3.ZERO, 60, Basis.IDENTITY, 0.75)
		await physics_frames(30)
		note_depth()
		var expected: float = device.get_grasp_angle_for_gap(PEG.x)
		check_near(hand.get_stop_angle(), expected, 0.01, "%s stops the fingers at its width" % kind)
		check(device.get_grasp_angle() < expected + 0.1, "%s: fingers at %.3f rad" % [kind, device.get_grasp_angle()])
		var felt: PackedFloat64Array = await mean_felt(10)
		check(felt[6] < -0.015, "%s pushes the fingers open: %f N m" % [kind, felt[6]])
		device.free()
		peg.free()
		await physics_frames(2)
	check_shown_outside()


## 10 mm into a floor and 10 mm into a wall behind.
func test_a_corner_of_one_body_is_still() -> void:
	var first := Vector3.ZERO
	for kind: String in ["two bodies", "one body", "trimesh", "csg"]:
		at = Vector3.ZERO
		await set_up_empty()
		var corner: Node3D = _corner(kind)
		add(corner)
		await physics_frames(5)
		await go(Vector3(0.0, FLOOR_Y + PAD_RADIUS - 0.01, 0.06 - PAD_RADIUS + 0.01), 60)
		await until_felt()
		await physics_frames(40)
		var force: Vector3 = force_of(await mean_felt(20))
		first = force if kind == "two bodies" else first
		var moved: float = await tremble(90)
		print("INFO corner of %s: %s N, trembles by %.3f mm" % [kind, force, 1e3 * moved])
		check(force.y > 1.5 and force.z < -1.5, "%s pushes out of both faces: %s" % [kind, force])
		check(force.distance_to(first) <= 0.05 * first.length(), "%s: %s N, %s N is due" % [kind, force, first])
		check(moved < 0.0001, "%s trembles by %.3f mm" % [kind, 1e3 * moved])
		note_depth()
		device.free()
		corner.free()
		await physics_frames(2)
	check_equal(shakes, 0, "nothing shakes")
	check_shown_outside()


## The force rises with the depth up to what the device may give, and stays there. Each has a device with cold motors.
func _press_deep(name: String, node: Node3D) -> void:
	at = Vector3.ZERO
	await set_up_empty()
	node.position.y = FLOOR_Y
	add(node)
	var above := Vector3(0.005, FLOOR_Y + PAD_RADIUS + 0.015, 0.003)
	await go(above, 10)
	await until_felt()
	var before: float = 0.0
	for depth_mm: int in [10, 20, 35, 50]:
		await go(Vector3(0.005, FLOOR_Y + PAD_RADIUS - 0.001 * depth_mm, 0.003), 8)
		await physics_frames(12)
		var up: float = (await mean_felt(3))[1]
		check(up > maxf(before - 0.05, 1.0), "%s, %d mm: %.2f N after %.2f N" % [name, depth_mm, up, before])
		before = up
	await physics_frames(30)
	var stays: float = (await mean_felt(3))[1]
	check_near(stays, before, 0.05 * before, "%s: the force stays" % name)
	check(stays > 0.8 * device.config.max_force, "%s: the force rises to the limit: %.2f N" % [name, stays])
	check_near(hand.get_proxy_transform().origin.y, FLOOR_Y + PAD_RADIUS, MOST_DEPTH_M, "%s: shown on it" % name)
	device.free()
	node.free()
	await physics_frames(2)


func _peg(kind: String) -> Node3D:
	match kind:
		"hull":
			return Solids.static_body(Solids.hull(Solids.box_mesh(PEG).get_faces()))
		"trimesh", "two-sided":
			return Solids.static_body(Solids.faces(Solids.box_mesh(PEG), kind == "two-sided"))
		"csg":
			var csg := CSGBox3D.new()
			csg.size = PEG
			csg.use_collision = true
			return csg
		"grid":
			return Solids.tiles(PEG, 1, 0.5 * PEG.y)
		"server":
			return Solids.server_body(Solids.box(PEG), Transform3D.IDENTITY)
	return Solids.static_body(Solids.box(PEG))


func _corner(kind: String) -> Node3D:
	var sizes: PackedVector3Array = [Vector3(0.4, 0.1, 0.4), Vector3(0.4, 0.4, 0.1)]
	var middles: PackedVector3Array = [Vector3(0.0, FLOOR_Y - 0.05, 0.0), Vector3(0.0, 0.0, 0.11)]
	var all := Node3D.new()
	var one := StaticBody3D.new()
	var together := CSGCombiner3D.new()
	together.use_collision = true
	var tool := SurfaceTool.new()
	tool.begin(Mesh.PRIMITIVE_TRIANGLES)
	for i: int in 2:
		var there := Transform3D(Basis.IDENTITY, middles[i])
		match kind:
			"two bodies":
				all.add_child(Solids.static_body(Solids.box(sizes[i]), there))
			"one body":
				Solids.add_shape(one, Solids.box(sizes[i]), there)
			"trimesh":
				tool.append_from(Solids.box_mesh(sizes[i]), 0, there)
			"csg":
				var csg := CSGBox3D.new()
				csg.size = sizes[i]
				csg.transform = there
				together.add_child(csg)
	if kind == "trimesh":
		Solids.add_shape(one, Solids.faces(tool.commit()))
	all.add_child(one)
	if kind == "csg":
		all.add_child(together)
	else:
		together.free()
	return all
