"""./dev release in a clone: a trial goes through, and each thing that forbids a release is named."""

import os
import shutil
import subprocess
import tempfile
import unittest
import zipfile

import repository
from repository import ROOT, git

VERSION = "7.8.9"
LIMIT_S = 120
MANIFEST = '[libraries]\n\nlinux.debug.x86_64 = "bin/lib.so"\n'


def copy_of_checkout(folder):
    """A clone with what is not committed yet, and a version of its own."""
    names = git(ROOT, "ls-files", "-z", "--cached", "--others", "--exclude-standard").split("\0")
    kept = ("dev", "version.py", "CHANGELOG.md", "tools/dev/", ".gitignore", ".gitattributes", "addons/spidar_g/plugin.cfg")
    for name in names:
        if name.startswith(kept) and os.path.isfile(os.path.join(ROOT, name)):
            os.makedirs(os.path.join(folder, os.path.dirname(name)), exist_ok=True)
            shutil.copy(os.path.join(ROOT, name), os.path.join(folder, name))
    repository.write(folder, {
        "version.py": f'version = "{VERSION}"\n',
        "addons/spidar_g/plugin.cfg": f'[plugin]\nversion="{VERSION}"\n',
        "CHANGELOG.md": f"# Changelog\n\n## [{VERSION}] - unreleased\n\n### Added\n- A thing.\n\n## [0.1.0] - 2020-01-01\n- Old.\n",
    })
    git(folder, "init", "-q")
    commit(folder)


def commit(folder):
    git(folder, "add", "-A")
    git(folder, "commit", "-qm", "test")


def write_zip(path, left_out=()):
    files = {"plugin.cfg": f'version="{VERSION}"\n', "spidar_g.gdextension": MANIFEST, "README.md": "", "LICENSE.md": "",
             "bin/lib.so": ""}
    with zipfile.ZipFile(path, "w") as archive:
        for name, text in files.items():
            if name not in left_out:
                archive.writestr("addons/spidar_g/" + name, text)


class Release(unittest.TestCase):
    def setUp(self):
        place = tempfile.TemporaryDirectory()
        self.addCleanup(place.cleanup)
        self.folder = os.path.join(place.name, "clone")
        self.zip = os.path.join(place.name, f"spidar_g-{VERSION}.zip")
        copy_of_checkout(self.folder)
        write_zip(self.zip)

    def release(self, *words):
        done = subprocess.run(["./dev", "release", *words], cwd=self.folder, timeout=LIMIT_S, text=True, check=False,
                              stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        return done.returncode, done.stdout

    def refused(self, text, *words):
        code, output = self.release(*(words or (VERSION, "--skip-tests", "--zip", self.zip)))
        self.assertNotEqual(code, 0, output)
        self.assertIn(text, output)
        self.assertNotIn("Left to do", output)

    def test_trial(self):
        code, output = self.release(VERSION, "--skip-tests", "--zip", self.zip)
        self.assertEqual(code, 0, output)
        with open(os.path.join(self.folder, "dist", f"release_notes-{VERSION}.md"), encoding="utf-8") as file:
            self.assertEqual(file.read(), f"# spidar_g {VERSION}\n\n### Added\n- A thing.\n")
        for part in ("This was a trial", f"git tag -a v{VERSION}", "sha256 "):
            self.assertIn(part, output)
        self.assertEqual(git(self.folder, "status", "--porcelain"), "")

    def test_words(self):
        self.refused("needs a version", "--skip-tests")
        self.refused("no version of the form", "seven", "--skip-tests", "--zip", self.zip)
        self.refused("has no option --frobnicate", VERSION, "--frobnicate")

    def test_another_version(self):
        self.refused(f"version.py says {VERSION}", "7.9.0", "--skip-tests", "--zip", self.zip)

    def test_without_a_trial_the_changelog_needs_a_date(self):
        self.refused("has no date", VERSION, "--zip", self.zip)

    def test_tests_that_fail_end_it(self):
        dated = f"# Changelog\n\n## [{VERSION}] - 2020-02-02\n- A thing.\n"
        for code in (1, 0):
            repository.write(self.folder, {"CHANGELOG.md": dated, "tools/dev/run_stages.py":
                                           f"import sys\nprint('stages', *sys.argv[1:])\nsys.exit({code} if 'run' in sys.argv else 0)\n"})
            commit(self.folder)
            done, output = self.release(VERSION, "--zip", self.zip)
            self.assertIn("stages run quick", output)
            self.assertEqual((done, "Left to do" in output), (code, code == 0), output)
            self.assertNotIn("trial", output)

    def test_no_section(self):
        repository.write(self.folder, {"CHANGELOG.md": "# Changelog\n"})
        commit(self.folder)
        self.refused("CHANGELOG.md has no section")

    def test_changes_that_are_not_committed(self):
        repository.write(self.folder, {"left.txt": "x"})
        self.refused("not committed")

    def test_a_tag_that_is_there(self):
        git(self.folder, "tag", f"v{VERSION}")
        self.refused("has a tag")

    def test_a_zip_that_is_not_whole(self):
        write_zip(self.zip, left_out=("bin/lib.so",))
        self.refused("has no addons/spidar_g/bin/lib.so")
