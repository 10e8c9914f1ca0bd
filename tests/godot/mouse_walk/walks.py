"""What a newcomer does in each example, by mouse and keys alone. The first line of a walk's help says it for the table.
Places are in meters of the scene, forces in newtons; y is up and z is towards the viewer."""

from walker import GaveUp, dot, minus, plus

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


def first_touch(walker, check):
    """The hand is pushed back by the table and by the ball"""
    walker.bring(at(-0.05, 0.0, 0.0))
    walker.bring(at(-0.05, -0.1, 0.0))
    felt = walker.felt()
    check(felt[1] > FELT_N, f"the table pushes up: {felt[1]:.2f} N")
    walker.bring(at(-0.04, -0.05, 0.0))
    walker.bring(at(0.01, -0.05, 0.0))
    felt = walker.felt()
    check(felt[0] < -FELT_N, f"the ball pushes to the left: {felt[0]:.2f} N")


def touch(walker, check):
    """Closed fingers feel box, ball, cylinder and hills"""
    walker.close_fingers()
    for name, height in (("Box", 0.0225), ("Ball", 0.027), ("Cylinder", 0.025), ("Bumps", 0.01)):
        walker.bring(on(walker, name, y=height + 0.04))
        walker.bring(on(walker, name, y=height + 0.008))
        state = walker.next_state(6)
        felt, touched = walker.device(state)["felt"], walker.device(state)["touched"]
        check(name in touched and felt[1] > FELT_N, f"{name} pushes up by {felt[1]:.2f} N; touched: {touched}")
        walker.bring(on(walker, name, y=height + 0.06))
    walker.open_fingers()


SAMPLES = ("Hard", "Soft", "Damped", "Ice", "Rubber", "Sandpaper", "Ribs", "Rosin", "Magnet", "Glue")


def materials(walker, check):
    """Closed fingers slide over each of the ten samples"""
    walker.close_fingers()
    press, drag, swing, pull, before = {}, {}, {}, {}, {}
    for name in SAMPLES:
        walker.bring(on(walker, name, y=0.075), 0.006, 24)
        if name == "Magnet":
            walker.bring(on(walker, name, y=0.048))
            before[name] = walker.felt()[1]
        walker.bring(on(walker, name, x=-0.008, y=0.028))
        state = walker.next_state(4)
        check(name in walker.device(state)["touched"], f"{name} is touched: {walker.device(state)['touched']}")
        press[name] = walker.device(state)["felt"][1]
        there = walker.meanwhile(lambda name=name: walker.bring(on(walker, name, x=0.008, y=0.028), 0.003, 1))
        drag[name] = max(abs(told["felt"][0]) for told in there)
        swing[name] = max(told["swing"] for told in there[2:])
        up = walker.meanwhile(lambda name=name: walker.bring(on(walker, name, y=0.075), 0.006, 4))
        pull[name] = max(-told["felt"][1] for told in up)
    for told in (("press", press), ("drag", drag), ("swing", swing), ("pull", pull)):
        print("materials: %s, N: %s" % (told[0], {name: round(value, 2) for name, value in told[1].items()}))
    check(press["Hard"] > 2.0 * press["Soft"], "hard pushes more than soft")
    check(drag["Rubber"] > 3.0 * drag["Ice"], "rubber holds more than ice")
    check(before["Magnet"] < -0.2, f"the magnet pulls before it is touched: {before['Magnet']:.2f} N")
    check(pull["Glue"] > 2.0 * max(pull["Hard"], 0.1), f"glue holds the fingers on the way up: {pull['Glue']:.2f} N")
    walker.open_fingers()


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
    felt = walker.felt(6)[1]
    lifted = walker.place(name)[1] - start
    check(lifted > 0.8 * height - 0.005, f"{name} is lifted by {1e3 * lifted:.0f} mm")
    check(abs(felt - before + GRAVITY_M_S2 * mass) < 0.3 * GRAVITY_M_S2 * mass + 0.15,
          f"{name} of {mass} kg is felt as {before - felt:.2f} N")


def door_and_drawer(walker, check):
    """Door and drawer are opened, the knob is turned, the lever is lifted"""
    take(walker, "Door", at(0.08, 0.0, 0.025), at(0.0, 0.0, 0.06))
    walker.bring(plus(walker.device()["wanted"], at(-0.01, 0.0, 0.06)), 0.006)
    spring = walker.felt()[2]
    turn = walker.state["turns"]["Door"][1]
    check(turn < -0.3, f"the door is open by {-turn:.2f} rad")
    check(spring < -0.3, f"its spring pulls: {spring:.2f} N")
    let_go(walker, at(0.0, 0.0, 0.06))
    take(walker, "Drawer", at(0.0, 0.0, 0.02), at(0.0, 0.0, 0.06))
    shut = walker.place("Drawer")[2]
    walker.bring(plus(walker.device()["wanted"], at(0.0, 0.0, 0.05)))
    walker.next_state(4)
    out = walker.place("Drawer")[2] - shut
    check(out > 0.04, f"the drawer is out by {1e3 * out:.0f} mm")
    let_go(walker, at(0.0, 0.02, 0.06))
    take(walker, "Knob", at(0.0, 0.0, 0.0), at(0.0, 0.06, 0.0))
    walker.key("Right", 0.6)
    walker.next_state(4)
    turn = walker.state["turns"]["Knob"][1]
    check(abs(turn) > 0.2, f"the knob is turned by {turn:.2f} rad")
    walker.key("Left", 0.6)
    let_go(walker, at(0.0, 0.06, 0.0))
    take(walker, "Lever", at(0.0, 0.0, 0.085), at(0.0, 0.06, 0.0))
    walker.bring(plus(walker.device()["wanted"], at(0.0, 0.045, -0.01)), 0.006)
    weight = walker.felt()[1]
    turn = walker.state["turns"]["Lever"][0]
    check(turn < -0.3, f"the lever is lifted by {-turn:.2f} rad")
    check(weight < -0.3, f"its weight pulls: {weight:.2f} N")
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
    felt = [told["felt"][1] for told in walker.meanwhile(lambda: walker.next_state(25))]
    check(max(felt) - min(felt) > 0.15, f"its sway is felt as {min(felt):.2f} to {max(felt):.2f} N")
    held = {name: told["held"] for name, told in walker.state["devices"].items()}
    check(set(held.values()) == {"Bar"}, f"both hold it: {held}")


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
    there = walker.meanwhile(lambda: walker.bring(on(walker, "Water", x=0.02, y=0.01), 0.004, 6))
    check(walker.state["zones"]["Water"], "the hand is in the water")
    brake = max(-told["felt"][0] for told in there)
    check(brake > 0.2, f"water brakes by {brake:.2f} N")
    walker.bring(on(walker, "Water", y=0.12))
    calm = walker.felt()
    walker.bring(on(walker, "Wind", y=0.01))
    lift_n = walker.felt(6)[1] - calm[1]
    check(walker.state["zones"]["Wind"] and lift_n > 1.0, f"wind lifts by {lift_n:.2f} N")
    walker.bring(on(walker, "Rail", x=0.012, y=0.01))
    pull = walker.felt(6)[0] - calm[0]
    check(walker.state["zones"]["Rail"] and pull < -0.3, f"the rail pulls by {pull:.2f} N")
    walker.bring(on(walker, "Buzz", y=0.01))
    swing = walker.device(walker.next_state(6))["swing"]
    check(walker.state["zones"]["Buzz"] and swing > 0.4, f"the buzz swings by {swing:.2f} N")


def clip(walker, check):
    """The drum knocks, the motor buzzes, the board creaks"""
    walker.bring(on(walker, "Drum", y=0.09))
    walker.bring(on(walker, "Drum", y=0.01), 0.006, 24)
    walker.next_state(3)
    check(walker.state["clips"]["Knock"] > 0, f"the drum knocks: {walker.state['texts']['Told']}")
    walker.bring(on(walker, "Drum", y=0.09), 0.01)
    walker.bring(on(walker, "Motor", y=0.09), 0.01)
    there = walker.meanwhile(lambda: (walker.bring(on(walker, "Motor", y=0.025), 0.006), walker.next_state(4)))
    swing = max(told["swing"] for told in there[-4:])
    check(walker.state["clips"]["Buzz"] > 0 and swing > 0.3, f"the motor buzzes by {swing:.2f} N")
    walker.bring(on(walker, "Motor", y=0.09), 0.01)
    walker.bring(on(walker, "Board", x=-0.03, y=0.08), 0.01)
    walker.bring(on(walker, "Board", x=-0.03, y=0.015), 0.006)
    walker.bring(on(walker, "Board", x=0.02, y=0.015), 0.006, 2)
    check(walker.state["clips"]["Creak"] > 0, f"the board creaks: {walker.state['texts']['Told']}")


def grip(walker, check):
    """The torch follows the hand, and floor and ball stop it with the fingers"""
    walker.bring(at(-0.05, 0.03, 0.0))
    walker.next_state(4)
    apart = off_grip(walker)
    check(max(map(abs, apart)) < 0.002, f"the torch is in the hand: {[round(1e3 * part, 1) for part in apart]} mm off")
    walker.bring(at(-0.05, -0.14, 0.0), 0.006)
    felt = walker.felt(6)
    check(felt[1] > FELT_N and off_grip(walker)[1] > 0.001, f"the floor stops fingers and torch: {felt[1]:.2f} N")
    walker.bring(on(walker, "Ball", y=0.08), 0.006)
    walker.bring(on(walker, "Ball", y=0.03), 0.006)
    check("Ball" in walker.device(walker.next_state(4))["touched"], f"the ball is felt: {walker.felt()[1]:.2f} N")


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


def with_shift(walker, px):
    walker.xdotool("keydown", "shift")
    walker.actions["keys"] += 1
    walker.next_state()
    walker.move_cursor(plus(walker.cursor, [px, 0]))
    walker.next_state()
    walker.xdotool("keyup", "shift")


WALKS = (
    gallery, first_touch, touch, materials, grasp, door_and_drawer, two_hands, socket, zone, clip, grip, tracker, mouse_hand,
)
