# ./dev paper and ./dev results: numbers, figures and pages.

# A Python that has matplotlib: the one on PATH, or Debian's own.
plotting_python() {
    if python3 -c 'import matplotlib' 2>/dev/null; then
        echo python3
        return
    fi
    need /usr/lib/python3/dist-packages/matplotlib/__init__.py:python3-matplotlib >&2
    echo /usr/bin/python3
}

paper_numbers() { # paper_numbers FOLDER: the CSV files alone
    scons -Q -j"$jobs" paper
    mkdir -p "$1"
    build/bin/spidar_paper --data tools/paper/data --out "$1"
}

paper() {
    need "${build_needs[@]}"
    find_jolt
    local python
    python=$(plotting_python)
    paper_numbers build/paper
    "$python" tools/paper/draw.py build/paper docs/pictures/paper
    python3 tools/paper/write_page.py build/paper docs/why/paper_reproduction.md
    python3 tests/paper/check_paper.py build/paper docs/why/paper_reproduction.md
}

results() { # results DIR
    local folder=${1:?dev: results needs the folder of an experiment} python
    python=$(plotting_python)
    "$python" tools/results/results.py "$(absolute "$folder")"
}
