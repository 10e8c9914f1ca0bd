## SpidarGHand.debug_draw: it draws while it is wanted, what is there, and leaves nothing behind.
extends "res://hand_scene.gd"

const PAD_RADIUS: float = 0.012
const BOX := Vector3(0.06, 0.05, 0.06)
## Of what reaches beyond a body: arrows, rings and the tool itself.
const BEYOND_M: float = 0.2


func test_it_draws_when_on_and_nothing_when_off() -> void:
	await set_up(Vector3.ZERO)
	var box: PhysicsBody3D = add_box(BOX, Vector3(0.08, FLOOR_Y + 0.5 * BOX.y, 0.0), 0.0)
	await move_to(Vector3(0.02, FLOOR_Y + 0.025, 0.0), 0.0, 60)
	check(touched().size() > 0, "the pad lies on the box")
	check(_drawing() == null, "off from the start: nothing is made")
	hand.debug_draw = true
	await physics_frames(2)
	var drawing: MeshInstance3D = _drawing()
	if not check(drawing != null and drawing.is_visible_in_tree(), "on: it is there"):
		return
	check_equal(drawing.mesh.get_surface_count(), 1, "on: it is drawn")
	var bounds: AABB = drawing.mesh.get_aabb()
	check(bounds.grow(1e-5).encloses(AABB(box.position - 0.5 * BOX, BOX)), "the box is in it: %s" % bounds)
	check(bounds.has_point(hand.get_proxy_transform().origin), "so is the tool: %s" % bounds)
	check_equal(hand.get_child_count(), 0, "a script that counts the hand's children does not see it")

	hand.debug_draw = false
	check_equal(drawing.mesh.get_surface_count(), 0, "off: gone at once")
	await physics_frames(3)
	check_equal(drawing.mesh.get_surface_count(), 0, "and it stays so")


func test_the_editors_visible_collision_shapes_draw_it_too() -> void:
	await set_up(Vector3(0.0, FLOOR_Y + 0.03, 0.0))
	tree.debug_collisions_hint = true
	await physics_frames(2)
	tree.debug_collisions_hint = false
	if not check(_drawing() != null, "the tree's hint is enough"):
		return
	check_equal(_drawing().mesh.get_surface_count(), 1, "it is drawn")
	await physics_frames(2)
	check_equal(_drawing().mesh.get_surface_count(), 0, "until the hint goes")


func test_it_is_gone_when_nothing_is_shown_any_more() -> void:
	await set_up(Vector3(0.0, FLOOR_Y + 0.03, 0.0))
	hand.debug_draw = true
	await physics_frames(2)
	var mesh: Mesh = _drawing().mesh
	device.enabled = false
	await physics_frames(2)
	check_equal(mesh.get_surface_count(), 0, "a closed device: nothing")
	device.enabled = true
	await physics_frames(5)
	check_equal(mesh.get_surface_count(), 1, "again, once it is open")
	device.remove_child(hand)
	check_equal(mesh.get_surface_count(), 0, "a hand outside the tree: nothing")
	device.add_child(hand)
	await physics_frames(5)
	check_equal(mesh.get_surface_count(), 1, "and again inside")
	tree.paused = true
	await frames(2)
	hand.debug_draw = false
	check_equal(mesh.get_surface_count(), 0, "switched off in a paused tree: gone at once")
	tree.paused = false
	hand.debug_draw = true
	await physics_frames(2)
	var drawing: WeakRef = weakref(_drawing())
	hand.free()
	check(drawing.get_ref() == null, "it goes with the hand")


## All kinds of colliders, at another scale: each is drawn where it stands.
func test_every_collider_is_drawn_where_it_stands() -> void:
	const Solids := preload("res://solids.gd")
	for scale: float in [1.0, 3.0]:
		for kind: String in Solids.PLATES + PackedStringArray(["ball", "capsule"]):
			device = ideal_device()
			device.workspace_scale = scale
			hand = SpidarGHand.new()
			hand.debug_draw = true
			device.add_child(hand)
			add(device)
			var node: Node3D
			match kind:
				"ball":
					node = Solids.ball("sphere")
				"capsule":
					var capsule := CapsuleShape3D.new()
					capsule.radius = 0.03
					node = Solids.static_body(capsule, Transform3D(Basis.IDENTITY, Vector3(0.0, -0.5, 0.0)))
				_:
					node = Solids.plate(kind)
			node.position.y = -0.02 * scale
			add(node)
			await until(func() -> bool:
				var now: Dictionary = hand.get_touch_statistics()
				return now["shapes_cooking"] == 0 and now["shapes"] > 0)
			await physics_frames(2)
			var bounds: AABB = _drawing().mesh.get_aabb()
			var tool_m: float = scale * 0.0459
			check(bounds.grow(1e-4).encloses(AABB(Vector3(-tool_m, -0.012 * scale, 0.0), Vector3(2.0 * tool_m, 0.0, 0.0))),
				"%s, scale %.0f: the open pads are in it: %s" % [kind, scale, bounds])
			check(bounds.position.y <= node.position.y + 1e-4, "%s, scale %.0f: so is its top: %s" % [kind, scale, bounds])
			if kind in ["trimesh 5", "trimesh 25", "height map", "boundary"]:
				check(bounds.size.x < BEYOND_M * 2.0 * scale + 0.05, "%s, scale %.0f: only what is near: %s" % [kind, scale, bounds])
				check(bounds.position.y > node.position.y - 0.02 * scale, "%s: flat, as it is: %s" % [kind, bounds])
			device.free()
			node.free()
			await physics_frames(2)


func _drawing() -> MeshInstance3D:
	for child: Node in hand.get_children(true):
		if child is MeshInstance3D:
			return child
	return null
