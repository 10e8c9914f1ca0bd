# How a stage of the tests notes what it checked: lines "PASSED FAILED" in the file $result, "ended" at its end.

run_stages() { # run_stages NAME_OR_GROUP...
    need python3:python3
    python3 tools/dev/run_stages.py check "$@" # a wrong name is told before anything is installed
    need "${build_needs[@]}" "${test_needs[@]}"
    need_tidy
    find_godot
    find_jolt
    echo "Godot: $GODOT"
    exec python3 tools/dev/run_stages.py run "$@"
}

in_stage() { # in the stage's own process, which has found Godot already
    declare -F "stage_$1" >/dev/null || die "tools/dev/stages.sh has no stage_$1"
    result=build/logs/$1.result
    "stage_$1"
    echo ended >>"$result"
}

note() { echo "$1 $2" >>"$result"; }

checked() { # one check: the command ends with 0
    if "$@"; then note 1 0; else note 0 1 && echo "dev: failed: $*"; fi
}

counted() { # a runner whose last line is "N passed, N failed"
    local code=0 output=$result.output
    "$@" 2>&1 | tee "$output" || code=$?
    note_counts "$code" "$(tail -n 1 "$output" | sed -nE 's/^([0-9]+) passed, ([0-9]+) failed$/\1 \2/p')" "$*"
}

doctest() { # a doctest program: doctest PROGRAM [filter]; without a filter nothing may be skipped
    local code=0 output=$result.output line passed failed skipped
    "$@" 2>&1 | tee "$output" || code=$?
    line=$(sed -nE 's/^\[doctest\] test cases: +([0-9]+) \| +([0-9]+) passed \| +([0-9]+) failed \| +([0-9]+) skipped.*/\2 \3 \4/p' "$output" | tail -n 1)
    read -r passed failed skipped <<<"${line:-0 1 0}"
    (($# > 1)) || failed=$((failed + skipped))
    note_counts "$code" "$passed $failed" "$*"
}

note_counts() { # note_counts EXIT_CODE "PASSED FAILED" COMMAND
    local passed failed
    read -r passed failed <<<"${2:-0 1}"
    if (($1 != 0 && failed == 0)); then failed=1; fi # it failed, whatever it counted
    if ((passed + failed == 0)); then failed=1; fi   # it tested nothing
    ((failed == 0)) || echo "dev: failed: $3 (exit code $1)"
    note "$passed" "$failed"
}
