# The add-on for Linux on arm64: cross-compiled here, and run here by qemu's user mode in Debian's own Godot for arm64.

cross_needs=(aarch64-linux-gnu-g++:g++-aarch64-linux-gnu)
user_qemu_needs=(qemu-aarch64:qemu-user)
arm64_copy=$cache/arm64
arm64_hidapi=$arm64_copy/hidapi/usr/lib/aarch64-linux-gnu/libhidapi-hidraw.a

# What `scons arch=arm64` takes from outside: hidapi's static library of the suite that this machine has. That of a newer
# one would ask for its newer C library.
find_arm64_hidapi() {
    [[ -e $arm64_hidapi ]] || is_debian ||
        die "give hidapi's static library for arm64: scons arch=arm64 hidapi=FILE"
    fetch_once "$arm64_hidapi" "hidapi for arm64" fetch_arm64 "$arm64_copy/hidapi" \
        "$(sed -nE 's/^VERSION_CODENAME=//p' /etc/os-release)" download libhidapi-dev
}

# Sets arm64_godot: Debian's Godot for arm64, of the suite that the private one comes from.
find_arm64_godot() {
    arm64_godot=$arm64_copy/run_godot
    fetch_once "$arm64_godot" "Godot for arm64" fetch_arm64_godot
}

fetch_arm64_godot() {
    fetch_arm64 "$arm64_copy/root" "$godot_suite" "-y --download-only install" godot
    ln -sfn usr/lib "$arm64_copy/root/lib" # where programs look for their loader
    under_qemu "$arm64_copy/root" "$arm64_copy/root/usr/bin/godot" "$arm64_godot"
}

fetch_arm64() { # fetch_arm64 FOLDER SUITE "APT-GET COMMAND" PACKAGE: unpacks it, and what the command fetches with it
    local work configuration package
    work=$(mktemp -d)
    # shellcheck disable=SC2064 # this folder, not one of a later call
    trap "rm -rf '$work'" EXIT
    configuration=$(private_apt "$work" "$2" arm64)
    # shellcheck disable=SC2086 # a command of several words
    (cd "$work/archives" && APT_CONFIG=$configuration apt-get -qq $3 "$4")
    rm -rf "$1"
    mkdir -p "$1"
    for package in "$work"/archives/*.deb; do
        dpkg-deb --extract "$package" "$1"
    done
}

under_qemu() { # under_qemu ROOT PROGRAM SCRIPT: a script that is like the program; ROOT holds its C library
    printf '#!/bin/sh\nexec qemu-aarch64 -L "%s" "%s" "$@"\n' "$1" "$2" >"$3"
    chmod +x "$3"
}

# The stage runs on x86-64. On arm64 ./dev test is this test.
stage_arm64() {
    local program seed
    [[ $(uname -m) == x86_64 ]] || die "the stage arm64 is for x86-64: here ./dev test-all runs all on arm64 itself"
    need "${cross_needs[@]}" "${user_qemu_needs[@]}"
    find_arm64_hidapi
    find_arm64_godot
    scons -Q -j"$jobs" bits_digest
    scons -Q -j"$jobs" arch=arm64 hidapi="$arm64_hidapi" addon spidar_tests bits_digest
    for program in spidar_tests bits_digest; do
        under_qemu /usr/aarch64-linux-gnu "build/arm64/bin/$program" "build/arm64/$program"
    done
    doctest build/arm64/spidar_tests
    for seed in {1..10}; do
        checked same_digest "$seed"
    done
    counted python3 tests/arm64/run_arm64_tests.py "$arm64_godot" "$GODOT"
}

same_digest() { # same_digest SEED: the servo step gives the same bits on both processors
    local here there
    here=$(build/bin/bits_digest --cases 10000 --seed "$1")
    there=$(build/arm64/bits_digest --cases 10000 --seed "$1")
    echo "seed $1: x86-64: ${here//$'\n'/, }; arm64: ${there//$'\n'/, }"
    [[ -n $here && $here == "$there" ]]
}
