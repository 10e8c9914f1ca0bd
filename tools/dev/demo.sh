# The demo: opened, or played by script.

# A run takes seconds; a script error would let Godot run for ever.
play_limit_s=600

prepare_demo() { python3 tests/godot_project.py "$GODOT" demo_project; }

play() { # play TASK [--level L] [--seed N] [--out DIR] [--source serial] [more arguments for the demo]
    local task=${1:?dev: play needs a task: ./dev play pick_and_place} level=1 seed=1 out="" more=() source=""
    shift
    while (($#)); do
        case $1 in
        --level) level=${2:?dev: --level needs a number} && shift 2 ;;
        --seed) seed=${2:?dev: --seed needs a number} && shift 2 ;;
        --source) source=${2:?dev: --source needs simulated or serial} && shift 2 ;;
        --out) out=$(absolute "${2:?dev: --out needs a folder}") && shift 2 ;;
        *) more+=("$1") && shift ;;
        esac
    done
    out=${out:-$root/build/play/$task-$level-$seed}
    mkdir -p "$out"
    build
    if [[ $source == serial ]]; then
        start_board_model
        more+=("${model_words[@]}")
        in_simulated_time=()
    fi
    run_demo --headless -- --play "$task" --level "$level" --seed "$seed" --out "$out" "${more[@]}"
}

in_simulated_time=(--fixed-fps 60) # but motor boards live in real time
model_words=()                     # for the demo, once the model of the boards runs

start_board_model() { # serial motor boards on a pseudo-terminal; sets model_words; ends with this script
    local said=build/board-model link=build/board-model-port
    scons -Q -j"$jobs" board_model >/dev/null || die "the model of the boards was not built"
    rm -f "$said" "$link"
    mkfifo "$said.input.$$"
    build/bin/spidar_board_model "$root/$link" >"$said" <"$said.input.$$" &
    exec {model_input}>"$said.input.$$" # the model ends with its input
    rm "$said.input.$$"
    for _ in {1..50}; do
        grep -q ready "$said" && break
        sleep 0.1
    done
    model_words=(--source serial --serial-port "$root/$link"
        --model-port "$(sed -n 's/ready //p' "$said")")
}

run_demo() { # run_demo [Godot arguments] -- [demo arguments]: in simulated time; Godot's exit code
    local code=0
    timeout --foreground -k 10 "$play_limit_s" "$GODOT" --audio-driver Dummy --path demo_project \
        "${in_simulated_time[@]}" "$@" || code=$?
    ((code != 124)) || echo "dev: the run did not end within $play_limit_s s" >&2
    return "$code"
}

demo() { # demo [--source serial] [more arguments for the demo]
    local more=()
    while (($#)); do
        if [[ $1 == --source && ${2:-} == serial && $* != *--serial-port* ]]; then
            start_board_model
            in_simulated_time=()
            shift 2
        else
            more+=("$1") && shift
        fi
    done
    if [[ -n ${DISPLAY:-}${WAYLAND_DISPLAY:-} ]]; then
        build
        ((${#model_words[@]} == 0)) || more+=(-- "${model_words[@]}")
        "$GODOT" --path demo_project "${more[@]}"
        return
    fi
    echo "dev: no display; the demo is played by script, and pictures are taken"
    need "${build_needs[@]}" "${picture_needs[@]}"
    local out=$root/build/demo code=0 kind
    rm -rf "$out"
    mkdir -p "$out"
    build
    start_xvfb
    run_demo --rendering-driver opengl3 --disable-vsync -- \
        --play pick_and_place --seed 1 --out "$out" --pictures "${more[@]}" "${model_words[@]}" || code=$?
    echo "dev: results and pictures of the run:"
    find build/demo -name '*.csv' -o -name '*.png' | sort
    ((code == 0)) || die "the scripted run failed (exit code $code)"
    for kind in csv png; do
        compgen -G "$out/*.$kind" >/dev/null || die "the scripted run left no $kind file in $out"
    done
}

start_xvfb() { # sets DISPLAY; ends with this script
    local number=build/xvfb-display
    mkdir -p build
    : >"$number"
    Xvfb -displayfd 3 -screen 0 1280x800x24 -nolisten tcp 3>"$number" 2>build/xvfb.log &
    xvfb=$!
    trap 'kill "$xvfb" 2>/dev/null || true' EXIT
    for _ in {1..100}; do
        [[ -s $number ]] && break
        sleep 0.1
    done
    [[ -s $number ]] || die "Xvfb did not start: $(tail -n 3 build/xvfb.log)"
    DISPLAY=:$(tr -d '[:space:]' <"$number")
    export DISPLAY
}
