"""A small git repository with pages, for the tests of the checks; and the folder of the checks on Python's path."""

import contextlib
import os
import subprocess
import sys
import tempfile

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
sys.path.insert(0, os.path.join(ROOT, "tools", "docs"))

DEV = """case $command in
help | -h | --help) cat help ;;
test) run_stages quick ;;
stage) run_stages "$@" ;;
esac
"""
FILES = {
    "dev": DEV,
    "tools/dev/stages.txt": "# name group limit what\nbuild quick 900 everything compiles\n",
    "docs/pictures/view.png": "a picture",
    "README.md": "# Home\n\n![The view](docs/pictures/view.png)\n\n[Page](docs/start/page.md#second-part)\n",
    "docs/start/page.md": "# Page\n\n## Second part\n\n```sh\n./dev test\n./dev stage build # all\n```\n\n[Up](../../README.md) and `./dev help`\n",
}


def git(folder, *words):
    command = ["git", "-c", "user.name=test", "-c", "user.email=test@localhost", *words]
    return subprocess.run(command, cwd=folder, check=True, text=True, capture_output=True).stdout


def write(folder, files):
    for path, text in files.items():
        os.makedirs(os.path.join(folder, os.path.dirname(path)), exist_ok=True)
        with open(os.path.join(folder, path), "w", encoding="utf-8") as file:
            file.write(text)


@contextlib.contextmanager
def repository(changed=None):
    """The files above, with those of `changed` in place of them or beside them."""
    with tempfile.TemporaryDirectory() as folder:
        git(folder, "init", "-q")
        write(folder, {**FILES, **(changed or {})})
        yield folder
