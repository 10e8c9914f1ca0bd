# ./dev docs: the pages checked, and the site of them built into build/site.

docs_pins=tools/docs/site/requirements.txt
docs_limit_s=600

# Sets docs_python: a Python of its own, with what the site is built by. Other pins are another environment.
find_docs_python() {
    local folder
    folder=$cache/docs-$(cksum <"$docs_pins" | cut -d' ' -f1)
    python3 -c 'import ensurepip, venv' 2>/dev/null ||
        need "/usr/lib/$(python3 -c 'import sys; print("python%d.%d" % sys.version_info[:2])')/ensurepip/__init__.py:python3-venv"
    fetch_once "$folder/made" "the tools that build the site" make_docs_python "$folder"
    docs_python=$folder/bin/python
}

make_docs_python() { # make_docs_python FOLDER
    rm -rf "$1"
    python3 -m venv "$1"
    timeout -k 10 "$docs_limit_s" "$1/bin/python" -m pip install --quiet --disable-pip-version-check -r "$docs_pins"
    touch "$1/made"
}

build_site() {
    find_docs_python
    python3 tools/docs/build_site.py "$GODOT" "$docs_python" build/site
}

docs() {
    local failed=0
    need python3:python3 git:git
    find_godot
    build_if_missing
    python3 tools/docs/check_pages.py || failed=1
    python3 tools/docs/check_blocks.py "$GODOT" || failed=1
    python3 tools/docs/check_help.py "$GODOT" --strict || failed=1
    build_site || failed=1
    echo "dev: the site: $root/build/site/index.html"
    ((failed == 0)) || die "the documentation has faults, which are listed above"
}

# The class help of the add-on's scripts names the library's classes: Godot must have loaded it.
build_if_missing() {
    [[ -e addons/spidar_g/spidar_g.gdextension ]] && compgen -G "addons/spidar_g/bin/*spidar_g.*" >/dev/null || build
}

# Needs no network: the site is built by the stage site.
stage_docs() {
    counted python3 tools/docs/check_pages.py
    counted python3 tools/docs/check_blocks.py "$GODOT"
    counted python3 tools/docs/check_help.py "$GODOT" --strict
    counted python3 tools/docs/settings_page.py "$GODOT" --check
    counted python3 tests/docs/run_docs_tests.py "$GODOT"
}

stage_site() {
    checked build_site
    counted python3 tests/docs/check_site.py build/site
}
