# Jolt's sources, of which the contacts use the builders of hulls and trees and the search for a way out of an overlap.
# They are those of Debian's source package of Godot, of the suite that the private Godot comes from.

jolt_version=5.4.0
jolt_copy=$cache/jolt-$jolt_version # where SConstruct looks when jolt= is not given

# Nothing is done when they are there, or when the caller names a checkout by jolt=PATH among the arguments.
find_jolt() {
    local argument
    for argument in "$@"; do
        [[ $argument != jolt=* ]] || return 0
    done
    [[ -e $jolt_copy ]] || is_debian ||
        die "Jolt $jolt_version is needed: give a checkout of its sources by ./dev build jolt=PATH"
    fetch_once "$jolt_copy" "Jolt's sources" fetch_jolt
}

fetch_jolt() {
    local work configuration
    work=$(mktemp -d)
    # shellcheck disable=SC2064 # this folder, not one of a later call
    trap "rm -rf '$work'" EXIT
    configuration=$(private_apt "$work")
    (cd "$work" && APT_CONFIG=$configuration apt-get -qq source --download-only --only-source godot)
    python3 tools/fetch/unpack_jolt.py "$work"/godot_*.orig.tar.xz "$jolt_copy"
}
