# The stages of the tests, one function stage_NAME each. tools/dev/stages.txt lists them with their limits;
# tools/dev/run_stages.py runs each as a process of its own.

stage_build() {
    local library
    checked scons -Q -j"$jobs" addon tests bench
    for library in addons/spidar_g/bin/libspidar_g.*.template_debug.*.so; do
        checked shows_only_its_entry "$library"
    done
    checked python3 tests/package/told_folders.py addons/spidar_g/bin/*.template_debug.*.so addons/spidar_g/bin/spidar_g_guard.*
}

shows_only_its_entry() { # nothing of the C++ runtime inside may meet the engine's own
    [[ $(nm -D --defined-only "$1" | awk '{print $NF}') == spidar_g_library_init ]]
}

stage_format() {
    local version
    version=$(clang-format --version | grep -oE 'version [0-9]+')
    [[ $version == "version 14" ]] || echo "dev: clang-format $version; 14 is the project's"
    our_sources >"$result.files"
    [[ -s $result.files ]]
    checked xargs -a "$result.files" clang-format --dry-run -Werror
}

stage_tidy() {
    [[ -e compile_commands.json ]] || scons -Q compile_commands.json
    find gdextension/core gdextension/device -name '*.cpp' | sort >"$result.files"
    [[ -s $result.files ]]
    checked tidy "$result.files"
}

tidy() { # without its count of what it found in other people's headers
    local program
    program=$(command -v clang-tidy-22 || command -v clang-tidy)
    xargs -a "$1" -P "$jobs" -n 2 "$program" -p . --quiet 2>&1 |
        { grep -v 'warnings\? generated' || true; }
}

stage_boundaries() {
    counted python3 tests/check_boundaries.py
    counted python3 tests/boundaries/test_rooms.py
    counted python3 tests/hid/check_protocol_page.py
}

stage_dev() {
    counted python3 tests/dev/test_dev.py
    counted python3 tests/mutate/test_run_mutants.py
}

stage_cpp_tests() {
    doctest build/bin/spidar_tests
    counted python3 tests/test_spidar_record.py build/bin
    checked build/bin/stress_recordings --cases 3000 --seed 1
}

stage_reference_data() {
    checked build/bin/spidar_check fk tests/data/fk_public.csv
    checked build/bin/spidar_check tension tests/data/tension_public.csv
    checked python3 tests/test_spidar_check.py build/bin/spidar_check
}

# The rows of the bench on few problems, and what becomes of them; ./dev bench is the whole.
stage_bench() { counted python3 tests/bench/test_bench_rows.py build/bin/spidar_bench; }

stage_paper() {
    paper_numbers build/paper_check
    counted python3 tests/paper/check_paper.py build/paper_check docs/why/paper_reproduction.md
}

stage_binding_tests() {
    scons -Q -j"$jobs" probe
    counted python3 tests/binding/run_binding_tests.py "$GODOT" \
        build/binding/probe/libbinding_probe.so
}

stage_godot_tests() {
    counted python3 tests/godot/run_godot_tests.py "$GODOT"
    counted python3 tests/godot/run_example_tests.py "$GODOT"
    counted python3 tests/godot/check_class_reference.py "$GODOT"
}

stage_serial() {
    scons -Q -j"$jobs" addon spidar_serial_tests
    doctest build/bin/spidar_serial_tests --test-suite=quick
    counted python3 tests/serial/run_serial_game.py "$GODOT" build/bin/spidar_board_model
}

stage_serial_long() {
    scons -Q -j"$jobs" spidar_serial_tests
    doctest build/bin/spidar_serial_tests --test-suite=long
    need "${picture_needs[@]}" xdotool:xdotool
    counted python3 tests/editor/run_serial_calibration_tests.py "$GODOT" build/bin/spidar_board_model
}

stage_play() {
    counted python3 tests/play/run_play_tests.py "$GODOT" --seeds 3
    counted python3 tests/play/run_experiment_tests.py "$GODOT" "$(plotting_python)" --participants 1
}

stage_play_seeds() { counted python3 tests/play/run_play_tests.py "$GODOT" --all-levels --seeds 20 --limit-s 60; }

stage_experiment() {
    counted python3 tests/play/run_experiment_tests.py "$GODOT" "$(plotting_python)" --participants 12
}

stage_editor() { # handles and calibration are worked by mouse and keyboard, games started by keys
    need "${picture_needs[@]}" xdotool:xdotool
    counted python3 tests/editor/run_view_tests.py "$GODOT" --actions 200 --seed 1
    counted python3 tests/editor/run_demo_project_tests.py "$GODOT"
    start_xvfb
    counted python3 tests/editor/run_view_tests.py "$GODOT" --part mouse
    counted python3 tests/editor/run_calibration_tests.py "$GODOT"
    counted python3 tests/editor/run_play_from_editor.py "$GODOT"
}

# Packs, away from their projects, with the library and without.
stage_pack() {
    counted python3 tests/package/run_pack_tests.py "$GODOT"
    counted python3 tests/package/run_missing_library_tests.py "$GODOT"
}

# Programs, away from their projects.
stage_export() {
    find_templates
    scons -Q -j"$jobs" addon board_model
    scons -Q -j"$jobs" target=template_release addon
    counted python3 tests/package/run_export_tests.py "$GODOT" "$templates" build/bin/spidar_board_model
}

stage_mouse() { # a user with a real mouse, under an X server of its own
    need "${picture_needs[@]}" xdotool:xdotool
    start_xvfb
    counted python3 tests/play/run_mouse_tests.py "$GODOT" --quick
}

stage_mouse_walk() { # under an X server of its own, too
    need "${picture_needs[@]}" xdotool:xdotool
    start_xvfb
    counted python3 tests/godot/run_mouse_walk.py "$GODOT"
}

sanitizer() { # sanitizer NAMES [doctest filter]
    scons -Q -j"$jobs" spidar_tests sanitize="$1"
    doctest "build/${1//,/-}/bin/spidar_tests" "${@:2}"
}

# Threads are watched at fifty times the price: where all is done in one thread, long searches and simulated hours are left
# to the others.
one_thread='fault table: each*,recording: a flipped bit*,recording: cut at every*,replay: a memory*,touch: *,string faults: *'
one_thread+=',tension problem: the best of all*,mesh contacts: as every*,closest points: any tool*,proxy: *'
stage_sanitize() {
    local folder folders=()
    for folder in loop threads recording hid simulation; do folders+=("*tests/device/$folder/*"); done
    sanitizer address,undefined
    sanitizer thread --source-file="$(IFS=,; echo "${folders[*]}")" --test-case-exclude="$one_thread"
}

# Every stress program of a build. A case of stress_servo is seconds of a simulated device, of stress_replay a minute,
# one of the others a single problem: hence other counts.
stress() { # stress BIN_FOLDER PROBLEMS DEVICE_RUNS
    local program cases
    for program in "$1"/stress_*; do
        cases=$2
        # Microseconds a case.
        [[ $program != */stress_kinematics && $program != */stress_wrench_matrix &&
            $program != */stress_servo_step ]] || cases=$((5 * cases))
        [[ $program != */stress_servo ]] || cases=$3
        [[ $program != */stress_replay ]] || cases=1
        [[ $program != */stress_shapes ]] || cases=200 # 1200 tools on 200 fields, against all triangles
        [[ $program != */stress_recordings ]] || ((cases <= 20000)) || cases=20000
        # A case is ten seconds of motion for each of six kinds of errors; the time of sanitized code is nobody's bar.
        [[ $program != */stress_tracking ]] || { [[ $1 == build/bin ]] && cases=20 || continue; }
        [[ $program != */stress_tension_quick ]] || ((cases *= 5)) # some us each
        # 500 reports a case; 20000 cases also try every short error pattern.
        [[ $program != */stress_hid ]] || ((cases <= 20000)) || cases=20000
        checked "$program" --cases "$cases" --seed 1
    done
}

# What the short round left out: the stress programs, and all tests with threads watched.
stage_sanitize_stress() {
    scons -Q -j"$jobs" tests sanitize=address,undefined
    stress build/address-undefined/bin 1000 60
}
stage_sanitize_thread() { # the core has no threads
    sanitizer thread --source-file='*tests/device/*' --test-case-exclude="$one_thread"
}

# What the servo thread must not do: allocate, lock or wait inside a cycle. Only clang has this sanitizer, from 20 on;
# Debian 12 brings 22 with its security updates.
stage_sanitize_realtime() {
    need clang++-22:clang-22 \
        /usr/lib/llvm-22/lib/clang/22/lib/linux/libclang_rt.rtsan-"$(uname -m)".a:libclang-rt-22-dev
    CXX=clang++-22 scons -Q -j"$jobs" realtime sanitize=realtime warnings_as_errors=no
    checked build/realtime/bin/realtime_check
    checked fails build/realtime/bin/realtime_check --provoke # the sanitizer itself works
}

fails() { ! "$@"; }

stage_hid() {
    need "${machine_needs[@]}"
    find_kernel
    scons -Q -j"$jobs" hid_vm addon
    counted python3 tests/hid/run_vm_tests.py build/bin/spidar_hid_vm "$kernel" "$GODOT"
}

stage_windows() {
    need "${windows_needs[@]}" "${wine_needs[@]}"
    python3 tools/fetch/fetch_hidapi.py
    scons -Q -j"$jobs" platform=windows windows_tests addon
    scons -Q -j"$jobs" platform=windows target=template_release addon
    counted python3 tests/windows/run_windows_tests.py build/windows addons/spidar_g/bin/spidar_g.windows.*.dll
}

stage_package() {
    package
    counted python3 tests/package/run_package_tests.py "$GODOT" "$(newest_package)"
}

stage_stress() {
    stress build/bin 200000 2000
    # A case is five seconds of a device here; the whole is docs/why/calibration_mathematics.md.
    checked build/bin/string_faults --cases 60 --seed 5 --healthy_s 600
    checked build/bin/error_budget --cases 1 --seed 2
    # The long run is documented in docs/reference/safety.md: an hour with each hand, ten thousand unplugs, a million commands.
    checked build/bin/safety_hours --minutes 3 --cycles 500 --commands 50000 --stall_minutes 2
    checked build/bin/soak --minutes 0.5
    checked build/bin/passivity_gates --cases 6 --seed 1
    checked build/bin/stiffness_limit --quick
}
