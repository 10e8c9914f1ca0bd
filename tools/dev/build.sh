# The add-on built, formatted and packed for a release.

build() {
    local word arguments=()
    for word in "$@"; do
        if [[ $word == binding=* ]]; then
            GODOT_CPP=${word#binding=}
            [[ $GODOT_CPP == in_tree ]] || GODOT_CPP=$(absolute "$GODOT_CPP")
            mkdir -p "${chosen_binding%/*}"
            echo "$GODOT_CPP" >"$chosen_binding"
        else
            arguments+=("$word")
        fi
    done
    need "${build_needs[@]}"
    find_godot
    find_jolt "$@"
    scons -Q -j"$jobs" "${arguments[@]}"
    # The demo then opens by a double click: Godot's list of extensions and its import are there.
    if compgen -G "addons/spidar_g/bin/*spidar_g.*" >/dev/null; then prepare_demo; fi
}

# The release: libraries for Linux on x86-64 and arm64 and for Windows, against the API in $GODOT_API (an extension_api.json of the lowest Godot
# supported), else that of the Godot in use. The tree's own libraries and manifest are then those of the release.
package() {
    local target options=()
    need "${build_needs[@]}" "${windows_needs[@]}" "${cross_needs[@]}"
    find_godot
    find_jolt
    find_arm64_hidapi
    python3 tools/fetch/fetch_hidapi.py
    if [[ -n ${GODOT_API:-} ]]; then
        [[ -e $GODOT_API ]] || die "GODOT_API=$GODOT_API: no such file"
        # The engine's C interface only grows: the newest header serves every API.
        mkdir -p build/api/header
        (cd build/api/header && "$GODOT" --headless --dump-gdextension-interface >/dev/null)
        options=(binding=in_tree "api=$(readlink -f "$GODOT_API")" interface=build/api/header/gdextension_interface.h)
    else
        echo "dev: GODOT_API is not set: the release is for the Godot in use and newer ones"
    fi
    for target in template_debug template_release; do
        scons -Q -j"$jobs" platform=windows target=$target "${options[@]}" addon
        scons -Q -j"$jobs" arch=arm64 hidapi="$arm64_hidapi" target=$target "${options[@]}" addon
    done
    scons -Q -j"$jobs" "${options[@]}" with_others=yes package
}

package_and_try() {
    package
    python3 tests/package/run_package_tests.py "$GODOT" "$(newest_package)"
}

newest_package() { find dist -name 'spidar_g-*.zip' -printf '%T@ %p\n' | sort -n | tail -n 1 | cut -d' ' -f2; }

our_sources() { find gdextension tests tools -name '*.cpp' -o -name '*.h' -o -name '*.hpp' | sort; }

format() {
    need "${test_needs[@]}"
    our_sources | xargs clang-format -i
}
