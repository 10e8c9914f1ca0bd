@tool
extends Node3D
## A place on a body, or on a fixed thing, where another one snaps in. Two sockets that fit are linked when they lie on
## each other: origin on origin and, unless the link turns freely, axes on axes.

const LinkSocket := preload("res://scene/link_socket.gd")

## Sockets fit when their keys are equal and one is a plug and the other not.
@export var key: StringName = &""
@export var is_plug := false
## Plugs fit plugs too, and any number of them meet in one place: ends of matches.
@export var meets_many := false
## A ball: only the place counts, not the turn.
@export var turns_freely := false


## The body or fixed thing that it sits on.
func carrier() -> CollisionObject3D:
	return get_parent() as CollisionObject3D


func fits(other: LinkSocket) -> bool:
	return key == other.key and (meets_many or is_plug != other.is_plug)
