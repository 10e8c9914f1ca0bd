@tool
extends RefCounted
## What a level and a seed put on the table: the same in a trial and in the editor's preview.

const TaskBody := preload("res://scene/task_body.gd")

## The things that have to be placed, in the order in which a script takes them.
var bodies: Array[TaskBody] = []
## What carries sockets, in the order in which it was put on the table.
var carriers: Array[CollisionObject3D] = []


## items: its origin is the middle of the table's top. level: from 1. The same seed gives the same layout.
func lay_out(_items: Node3D, _level: int, _seed_number: int) -> void:
	pass


static func shuffled(things: Array, random: RandomNumberGenerator) -> Array:
	for last in range(things.size() - 1, 0, -1):
		var other := random.randi_range(0, last)
		var kept: Variant = things[last]
		things[last] = things[other]
		things[other] = kept
	return things
