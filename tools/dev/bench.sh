# ./dev bench: times against errors, beside peers.

bench_limit_s=300

# bench contacts [publish] [--runs N] [--rows N]: closest points of shapes, beside those peers that are installed; hand
# motions over shapes, beside contacts as planes of the game
bench_contacts() {
    local publish="" python problem
    [[ ${1:-} != publish ]] || { publish=yes && shift; }
    need "${build_needs[@]}"
    find_jolt
    scons -Q -j"$jobs" bench
    python3 tests/bench/peers/fetch_peers.py --contacts
    need pip3:python3-pip
    python=$(plotting_python)
    for problem in contacts motions; do
        python3 tests/bench/run_bench.py build/bench --problem "$problem" "$@"
    done
    "$python" tests/bench/draw_bench.py build/bench motions
    if [[ -n $publish ]]; then
        cp build/bench/{contacts,motions}.{json,csv} build/bench/motions.png tests/bench/results/
        python3 tests/bench/write_tables.py tests/bench/results docs/why/accuracy_and_speed.md
    fi
}

bench() { # bench [publish] [--runs N] [--rows N]: figures and pictures into build/bench
    local publish=""
    if [[ ${1:-} == contacts ]]; then
        bench_contacts "${@:2}"
        return
    fi
    [[ ${1:-} != publish ]] || { publish=yes && shift; }
    need "${build_needs[@]}"
    need pip3:python3-pip
    [[ -d /usr/include/eigen3 ]] || ! is_debian || need /usr/include/eigen3:libeigen3-dev # for one of the peers
    local python
    python=$(plotting_python)
    build addon bench
    python3 tests/bench/peers/fetch_peers.py
    python3 tests/bench/run_bench.py build/bench "$@"
    "$python" tests/bench/draw_bench.py build/bench
    if [[ -n $publish ]]; then
        cp build/bench/*.{json,csv,png,md,txt} tests/bench/results/
        python3 tests/bench/write_tables.py tests/bench/results docs/why/accuracy_and_speed.md
    fi
    python3 tests/godot_project.py "$GODOT" tests/godot/project
    timeout --foreground -k 10 "$bench_limit_s" "$GODOT" --headless --path tests/godot/project --fixed-fps 60 \
        --script "$root/tests/bench/godot/bench_node.gd"
    timeout --foreground -k 10 "$bench_limit_s" "$GODOT" --headless --path tests/godot/project \
        --script "$root/tests/bench/godot/bench_hand.gd"
    python3 tests/editor/run_view_tests.py "$GODOT" --part idle
    bench_demo
}

# What the demo's scripts and the add-on cost a frame, from a scripted play; without drawing.
bench_demo() {
    prepare_demo
    run_demo --headless -- --play pick_and_place --seed 1 --display --out "$root/build/bench_demo" >/dev/null
    python3 -c 'import json, sys
for name, cost in json.load(open(sys.argv[1]))["frame_ms"].items():
    print(f"demo, {name}: median {cost[0]:.3f} ms, 99 % {cost[1]:.3f} ms")' build/bench_demo/session.json
}
