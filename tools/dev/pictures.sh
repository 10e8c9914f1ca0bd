# The pictures of the documents that a scripted play or an example makes: ./dev pictures [--out DIR]

# By task: the picture of its play that the documents show, and its name there. The movie of a play is TASK.webp.
task_pictures=(pick_and_place:carry:pick_and_place_carry robot_linking:done:robot_linking_done
    match_linking:linked:match_linking_linked)
# By example: the name of its picture in the documents.
example_pictures=(gallery:examples_gallery door_and_drawer:door_and_drawer)

pictures() { # pictures [--out DIR]: into docs/pictures and the examples' gallery, or all into DIR
    local out=docs/pictures frames=build/pictures entry task picture name python
    if [[ ${1:-} == --out ]]; then
        out=$(absolute "${2:?dev: --out needs a folder}")
        shift 2
    fi
    (($# == 0)) || die "pictures takes --out DIR alone: $*"
    need "${build_needs[@]}" "${picture_needs[@]}"
    python=$(imaging_python)
    build
    prepare_demo
    start_xvfb
    rm -rf "$frames"
    mkdir -p "$out"
    for entry in "${task_pictures[@]}"; do
        IFS=: read -r task picture name <<<"$entry"
        mkdir -p "$frames/$task"
        run_demo --rendering-driver opengl3 --disable-vsync --resolution 1280x720 -- --play "$task" --level 1 --seed 1 \
            --out "$root/$frames/$task" --pictures --movie
        cp "$frames/$task/$picture.png" "$out/$name.png"
        "$python" tools/pictures/make_movie.py "$frames/$task" "$out/$task.webp"
    done
    python3 tests/godot/run_example_tests.py "$GODOT" gallery door_and_drawer --pictures "$frames/examples" --size 1280x720
    for entry in "${example_pictures[@]}"; do
        "$python" -c 'import sys; from PIL import Image
Image.open(sys.argv[1]).convert("RGB").resize((960, 540), Image.LANCZOS).save(sys.argv[2], optimize=True)' \
            "$frames/examples/${entry%%:*}.png" "$out/${entry#*:}.png"
    done
    if [[ $out == docs/pictures ]]; then
        python3 tests/godot/run_example_tests.py "$GODOT" --gallery
    fi
    echo "dev: pictures in $out"
}

imaging_python() { # a Python with Pillow
    if python3 -c 'import PIL' 2>/dev/null; then
        echo python3
        return
    fi
    need /usr/lib/python3/dist-packages/PIL/__init__.py:python3-pil >&2
    echo /usr/bin/python3
}
