extends RefCounted
## One unilateral contact plane between the tool and the world, as SpidarGHand finds it.
## World coordinates, SI: the tool may still move by separation_m against normal before it touches.

## Unit, points from the body to the tool.
var normal: Vector3 = Vector3.UP
## Scene metres left until touch along -normal; negative inside.
var separation_m: float = 0.0
## On the body's surface: where the reaction acts.
var point: Vector3 = Vector3.ZERO
## Velocity of the body's surface, in scene metres per second of device time. A jump of the body is left out.
var velocity: Vector3 = Vector3.ZERO
## The velocity with jumps, as seen in this tick and in the one before.
var seen_velocity: Vector3 = Vector3.ZERO
var earlier_velocity: Vector3 = Vector3.ZERO
## True for a body that physics steps do not move. Its velocity is seen only by the places of its node; `place` is the newest.
var is_static: bool = false
var place: Transform3D = Transform3D.IDENTITY
## Velocity that the closing jaws add.
var closing: Vector3 = Vector3.ZERO
var stiffness_n_m: float = 350.0
var damping_n_s_m: float = 2.0
var friction: float = 0.4
## The body that the plane stands for; its rid tells planes of different bodies apart.
var rid: RID
## The body itself when the tool's push moves it; null for walls, tables and kinematic bodies.
var pushed_body: RigidBody3D = null
## True when the held body touches, not the tool: its push goes through the joint already.
var through_held_body: bool = false
## Given by the contact set; the same surface keeps it from frame to frame.
var id: int = 0
