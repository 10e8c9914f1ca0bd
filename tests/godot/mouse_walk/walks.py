"""What a newcomer does in each example, by mouse and keys alone. The first line of a walk's help says it for the table.
Places are in meters of the scene, forces in newtons; y is up and z is towards the viewer."""

from walker import GaveUp, minus, plus

FELT_N = 0.5  # that a push counts as felt
GRAVITY_M_S2 = 9.8


def at(x, y, z):
    return [x, y, z]


def on(walker, body, x=0.0, y=0.0, z=0.0):
    return plus(walker.place(body), [x, y, z])


def gallery(walker, check):
    """Arrow keys and Enter open an example, Esc comes back"""
    for key in ("Right", "Down", "Return"):
        walker.key(key)
        walker.next_state(3)
    opened = walker.wait("an example by Enter", lambda state: state["example"])["example"]
    check(opened, f"Enter opens {opened}")
    walker.leave_example()
    check(True, "Esc shows all examples")


def expect(walker, check, what, value_of, least):
    """That a value comes to be at least so large. A loaded computer may take its time."""
    try:
        state = walker.wait(what, lambda now: value_of(now) >= least, 5)
    except GaveUp:
        state = walker.state
    value = value_of(state)
    check(value >= least, f"{what}: {value:.2f}, at least {least:.2f}")


def felt(walker, state, axis):
    """Mean force on the hand along an axis, N."""
    return walker.device(state)["felt"][axis]


def push(walker, state, name):
    """Mean force upward while the body of this name is touched, else 0, N."""
    return felt(walker, state, 1) if name in walker.device(state)["touched"] else 0.0


def first_touch(walker, check):
    """The hand is pushed back by the table and by the ball"""
    walker.bring(at(-0.05, 0.0, 0.0))
    walker.bring(at(-0.05, -0.1, 0.0))
    expect(walker, check, "the table pushes up, N", lambda state: felt(walker, state, 1), FELT_N)
    walker.bring(at(-0.04, -0.05, 0.0))
    walker.bring(at(0.01, -0.05, 0.0))
    expect(walker, check, "the ball pushes to the left, N", lambda state: -felt(walker, state, 0), FELT_N)


def touch(walker, check):
    """Closed fingers feel box, ball, cylinder and hills"""
    walker.close_fingers()
    for name, height in (("Box", 0.0225), ("Ball", 0.027), ("Cylinder", 0.025), ("Bumps", 0.01)):
        walker.bring(on(walker, name, y=height + 0.04))
        walker.bring(on(walker, name, y=height + 0.008))
        expect(walker, check, f"{name} is touched and pushes up, N", lambda state: push(walker, state, name), FELT_N)
        walker.bring(on(walker, name, y=height + 0.06))
    walker.bring(plus(walker.device()["wanted"], at(0.0, 0.06, 0.0)))  # open fingers have no room beside the cylinder
    walker.open_fingers()


SAMPLES = ("Hard", "Soft", "Damped", "Ice", "Rubber", "Sandpaper", "Ribs", "Rosin", "Magnet", "Glue")
TOUCHING_M = 0.039  # of the closed fingers' middle over that of a sample, where they just touch
CLEAR_M = 0.075


def materials(walker, check):
    """Closed fingers slide over each of the ten samples"""
    walker.close_fingers()
    told = {name: slide_over(walker, check, name) for name in SAMPLES}
    check(told["Hard"]["stiffness"] > 2.0 * told["Soft"]["stiffness"], "hard is stiffer than soft: "
          f"{told['Hard']['stiffness']:.0f} and {told['Soft']['stiffness']:.0f} N/m")
    check(told["Rubber"]["drag"] > 2.0 * told["Ice"]["drag"], "rubber holds more than ice: "
          f"{told['Rubber']['drag']:.2f} and {told['Ice']['drag']:.2f} N")
    check(told["Glue"]["hold"] > told["Hard"]["hold"] + 0.4, "glue holds the fingers on the way up: "
          f"{told['Glue']['hold']:.2f} N, hard {told['Hard']['hold']:.2f} N")
    walker.open_fingers()


def slide_over(walker, check, name):
    """What is felt of a sample: pressed, slid over, and left."""
    found = {}
    walker.bring(on(walker, name, y=CLEAR_M), 0.01, 24)
    if name == "Magnet":
        walker.bring(on(walker, name, y=TOUCHING_M + 0.01))
        expect(walker, check, "the magnet pulls before it is touched, N", lambda state: -felt(walker, state, 1), 0.2)
    walker.bring(on(walker, name, x=-0.008, y=TOUCHING_M - 0.011))
    expect(walker, check, f"{name} is touched and pushes up, N", lambda state: push(walker, state, name), 0.3)
    told = walker.device(walker.next_state(4))
    depth = (walker.place(name)[1] + TOUCHING_M - told["grip"][1]) / told["scale"]
    found["stiffness"] = told["felt"][1] / max(depth, 1e-4)
    there = walker.meanwhile(lambda: walker.bring(on(walker, name, x=0.008, y=TOUCHING_M - 0.011), None, 1))
    found["drag"] = max(abs(told["felt"][0]) for told in there)
    way = there[-1]["grip"][0] - there[0]["grip"][0]
    check(way > 0.004 and any(name in told["touched"] for told in there), f"slid {1e3 * way:.0f} mm over {name}, which holds by {found['drag']:.2f} N")
    slowly = 2 if name in ("Hard", "Glue") else 24
    up = walker.meanwhile(lambda: walker.bring(on(walker, name, x=0.008, y=CLEAR_M), 0.01, slowly))
    found["hold"] = max(-told["least"][1] for told in up)
    return found


def grasp(walker, check):
    """Box, can and ball are lifted, and weigh what they weigh"""
    for name, mass in (("Box", 0.1), ("Can", 0.15), ("Ball", 0.05)):
        lift(walker, check, name, mass)
        walker.bring(plus(walker.device()["wanted"], at(0.0, -0.05, 0.0)))
        walker.open_fingers()
        walker.bring(plus(walker.device()["wanted"], at(0.0, 0.07, 0.0)), 0.01)


def lift(walker, check, name, mass, height=0.05):
    walker.bring(on(walker, name, y=0.06))
    walker.bring(walker.place(name))
    before = walker.felt()[1]
    start = walker.place(name)[1]
    walker.close_fingers(name)
    walker.bring(plus(walker.device()["wanted"], at(0.0, height, 0.0)))
    expect(walker, check, f"{name} is lifted, m", lambda state: state["places"][name][1] - start, 0.8 * height - 0.005)
    weight = GRAVITY_M_S2 * mass
    expect(walker, check, f"the weight of {name} ({weight:.2f} N) is felt, less its error, N",
           lambda state: weight - abs(before - felt(walker, state, 1) - weight), 0.7 * weight - 0.15)


def door_and_drawer(walker, check):
    """Door and drawer are opened, the knob is turned, the lever is lifted"""
    take(walker, "Door", at(0.08, 0.0, 0.025), at(0.0, 0.0, 0.06))
    walker.bring(plus(walker.device()["wanted"], at(-0.01, 0.0, 0.06)), 0.006)
    expect(walker, check, "the door is open, rad", lambda state: -state["turns"]["Door"][1], 0.3)
    expect(walker, check, "its spring pulls, N", lambda state: -felt(walker, state, 2), 0.3)
    let_go(walker, at(0.0, 0.0, 0.06))
    take(walker, "Drawer", at(0.0, 0.0, 0.02), at(0.0, 0.0, 0.06))
    shut = walker.place("Drawer")[2]
    walker.bring(plus(walker.device()["wanted"], at(0.0, 0.0, 0.05)))
    expect(walker, check, "the drawer is out, m", lambda state: state["places"]["Drawer"][2] - shut, 0.04)
    let_go(walker, at(0.0, 0.02, 0.06))
    take(walker, "Knob", at(0.0, 0.0, 0.0), at(0.0, 0.06, 0.0))
    for _ in range(4):  # as long as it takes to see it turned
        walker.key("Right", 0.3)
    expect(walker, check, "the knob is turned, rad", lambda state: -state["turns"]["Knob"][1], 0.2)
    turn_upright(walker)
    let_go(walker, at(0.0, 0.06, 0.0))
    take(walker, "Lever", at(0.0, 0.0, 0.085), at(0.0, 0.06, 0.0))
    walker.bring(plus(walker.device()["wanted"], at(0.0, 0.045, -0.01)), 0.006)
    expect(walker, check, "the lever is lifted, rad", lambda state: -state["turns"]["Lever"][0], 0.3)
    expect(walker, check, "its weight pulls, N", lambda state: -felt(walker, state, 1), 0.3)
    let_go(walker, at(0.0, 0.06, 0.0))


def take(walker, name, handle, side):
    """The fingers come to a handle (in the frame of a body that is not turned) from a side, and close on it."""
    walker.bring(plus(on(walker, name, *handle), side), 0.006)
    walker.bring(on(walker, name, *handle))
    walker.close_fingers(name)


def let_go(walker, away):
    walker.open_fingers()
    walker.bring(plus(walker.device()["wanted"], away), 0.01)


def two_hands(walker, check):
    """The left hand takes its end of the bar, and feels the right hand"""
    right = walker.wait("the right hand on the bar", lambda state: state["devices"]["Right"]["held"] == "Bar")
    check(right, "the right hand holds the bar by itself")
    walker.bring(on(walker, "Bar", x=-0.06, y=0.07))
    walker.bring(on(walker, "Bar", x=-0.06))
    walker.close_fingers("Bar")
    forces = [told["felt"][1] for told in walker.meanwhile(lambda: walker.next_state(25))]
    check(max(forces) - min(forces) > 0.15, f"its sway is felt as {min(forces):.2f} to {max(forces):.2f} N")
    held = {name: told["held"] for name, told in walker.state["devices"].items()}
    check(set(held.values()) == {"Bar"}, f"both hold it: {held}")
    walker.open_fingers()


def socket(walker, check):
    """The plug clicks on the stand, comes off by force, and clicks below the arm"""
    lift(walker, check, "Plug", 0.08)
    carry(walker, "Foot", "Top", 0.03)
    carry(walker, "Foot", "Top", 0.0)
    walker.wait("a click on the stand", lambda state: state["links"]["Foot"] == "Top")
    check("linked" in walker.state["texts"]["Told"], f"it says: {walker.state['texts']['Told']}")
    walker.bring(plus(walker.device()["wanted"], at(0.0, 0.045, 0.0)))
    walker.wait("it comes off", lambda state: not state["links"]["Foot"])
    check("off" in walker.state["texts"]["Told"], f"it says: {walker.state['texts']['Told']}")
    carry(walker, "Head", "Hook", -0.03)
    carry(walker, "Head", "Hook", 0.0)
    walker.wait("a click below the arm", lambda state: state["links"]["Head"] == "Hook")
    let_go(walker, at(0.0, -0.01, 0.05))
    check(walker.next_state(4)["links"]["Head"] == "Hook", "let go, it hangs there")


def carry(walker, name, mate, height):
    """A socket of the held body to above its mate."""
    walker.next_state(4)
    off = minus(on(walker, mate, y=height), walker.place(name))
    walker.bring(plus(walker.device()["wanted"], off))
    walker.next_state(4)


def zone(walker, check):
    """Water brakes, wind lifts, the rail pulls to itself, the buzz shakes"""
    walker.bring(on(walker, "Water", x=-0.02, y=0.01))
    still = walker.felt()[0]
    check(walker.state["zones"]["Water"], "the hand is in the water")
    there = walker.meanwhile(lambda: walker.bring(on(walker, "Water", x=0.02, y=0.01), None, 3))
    brake = max(still - told["felt"][0] for told in there)
    check(brake > 0.2, f"water brakes by {brake:.2f} N")
    walker.bring(on(walker, "Water", y=0.12))
    calm = walker.felt(6)
    for name, x, what, value_of, least in (
        ("Wind", 0.0, "the wind lifts, N", lambda state: felt(walker, state, 1) - calm[1], 1.0),
        ("Rail", 0.012, "the rail pulls to itself, N", lambda state: calm[0] - felt(walker, state, 0), 0.3),
        ("Buzz", 0.0, "the buzz swings, N", lambda state: walker.device(state)["swing"], 0.4),
    ):
        walker.bring(on(walker, name, x=x, y=0.01))
        walker.wait(f"the hand in {name}", lambda state, name=name: state["zones"][name])
        expect(walker, check, what, value_of, least)


def clip(walker, check):
    """The drum knocks, the motor buzzes, the board creaks"""
    walker.bring(on(walker, "Drum", y=0.09))
    walker.bring(on(walker, "Drum", y=0.01), 0.006, 24)
    walker.next_state(3)
    check(walker.state["clips"]["Knock"] > 0, f"the drum knocks: {walker.state['texts']['Told']}")
    walker.bring(on(walker, "Drum", y=0.09), 0.01)
    walker.bring(on(walker, "Motor", y=0.09), 0.01)
    there = walker.meanwhile(lambda: (walker.bring(on(walker, "Motor", y=0.025), 0.006), walker.next_state(6)))
    swing = max(told["swing"] for told in there[-6:])
    check(walker.state["clips"]["Buzz"] > 0 and swing > 0.3, f"the motor buzzes by {swing:.2f} N")
    walker.bring(on(walker, "Motor", y=0.09), 0.01)
    walker.bring(on(walker, "Board", x=-0.03, y=0.08), 0.01)
    walker.bring(on(walker, "Board", x=-0.03, y=0.015), 0.006)
    walker.bring(on(walker, "Board", x=0.02, y=0.015), 0.006, 2)
    check(walker.state["clips"]["Creak"] > 0, f"the board creaks: {walker.state['texts']['Told']}")


def grip(walker, check):
    """The torch follows the hand, and table and ball stop it with the fingers"""
    walker.bring(at(-0.05, 0.03, 0.0))
    walker.next_state(4)
    apart = off_grip(walker)
    check(max(map(abs, apart)) < 0.002, f"the torch is in the hand: {[round(1e3 * part, 1) for part in apart]} mm off")
    walker.bring(at(-0.05, -0.11, 0.0), 0.006)
    expect(walker, check, "the table stops the fingers, N", lambda state: felt(walker, state, 1), FELT_N)
    expect(walker, check, "and the torch, m above the grip", lambda state: off_grip(walker)[1], 0.001)
    walker.bring(on(walker, "Ball", x=-0.09), 0.006)
    walker.bring(on(walker, "Ball", x=-0.05))
    expect(walker, check, "the ball pushes to the left, N", lambda state: -felt(walker, state, 0), FELT_N)


def off_grip(walker):
    return minus(walker.place("SpidarGGrip"), walker.device()["grip"])


def tracker(walker, check):
    """The controller follows the hand; closed fingers are its grip and trigger"""
    walker.bring(at(-0.03, 0.03, 0.02))
    state = walker.next_state(4)
    told = state["controllers"]["XRController3D"]
    apart = max(map(abs, minus(told["at"], walker.device(state)["grip"])))
    check(told["active"] and apart < 0.003, f"the controller is at the grip: {1e3 * apart:.1f} mm off")
    walker.close_fingers()
    told = walker.wait("grip_click", lambda now: now["controllers"]["XRController3D"]["grip_click"])
    text = told["texts"]["Label3D"]
    check("pressed" in text, f"it says: {text}")
    check(told["controllers"]["XRController3D"]["trigger"] > 0.3, "and the trigger is pulled")
    walker.open_fingers()
    check("released" in walker.next_state(3)["texts"]["Label3D"], f"it says: {walker.state['texts']['Label3D']}")


def mouse_hand(walker, check):
    """Every line of the board is tried; the block is put on the step"""
    walker.bring(plus(walker.device()["wanted"], at(0.0, 0.02, 0.0)))
    for key, axis, sign in (("a", 0, -1), ("d", 0, 1), ("q", 1, -1), ("e", 1, 1), ("w", 2, -1), ("s", 2, 1)):
        way = changed(walker, "wanted", lambda key=key: walker.key(key, 0.2))
        check(sign * way[axis] > 0.005, f"key {key} moves by {[round(1e3 * part) for part in way]} mm")
    for keys, axis in ((("Left", "Right"), 1), (("Up", "Down"), 0), (("Prior", "Next"), 2)):
        turns = [changed(walker, "turn", lambda key=key: walker.key(key, 0.2))[axis] for key in keys]
        check(min(turns) < -0.05 and max(turns) > 0.05, f"{keys} turn by {[round(turn, 2) for turn in turns]} rad")
    way = changed(walker, "wanted", lambda: walker.wheel(3))
    check(way[2] < -0.01, f"three notches move away by {-1e3 * way[2]:.0f} mm")
    walker.wheel(-3)
    turn = changed(walker, "turn", lambda: drag(walker, 40))
    check(abs(turn[1]) > 0.05, f"dragging turns by {turn[1]:.2f} rad")
    drag(walker, -40)
    way = changed(walker, "wanted", lambda: with_shift(walker, 60))
    check(max(map(abs, way)) < 0.002, "Shift holds it")
    with_shift(walker, -60)
    walker.key("Left", 0.2)
    turn_upright(walker)
    check(True, "Home turns it upright")
    lift(walker, check, "Block", 0.1)
    walker.bring(on(walker, "Step", y=0.09))
    walker.bring(on(walker, "Step", y=0.045), 0.006)
    walker.open_fingers()
    walker.next_state(4)
    off = minus(walker.place("Block"), walker.place("Step"))
    check(abs(off[0]) < 0.04 and off[1] > 0.02, f"the block lies on the step: {[round(1e3 * part) for part in off]} mm off its middle")


def changed(walker, field, work):
    before = walker.device(walker.next_state(2))[field]
    work()
    return minus(walker.device(walker.next_state(2))[field], before)


def drag(walker, px):
    walker.button(3, True)
    walker.next_state()
    walker.xdotool("mousemove_relative", "--", px, 0)
    walker.next_state()
    walker.button(3, False)


def turn_upright(walker):
    walker.key("Home")
    walker.wait("an upright grip", lambda state: not any(walker.device(state)["turn"]))


def with_shift(walker, px):
    walker.xdotool("keydown", "shift")
    walker.actions["keys"] += 1
    walker.next_state()
    walker.move_cursor(plus(walker.cursor, [px, 0]))
    walker.next_state()
    walker.xdotool("keyup", "shift")
    walker.keeps_distance = True


WALKS = (
    gallery, first_touch, touch, materials, grasp, door_and_drawer, two_hands, socket, zone, clip, grip, tracker, mouse_hand,
)
