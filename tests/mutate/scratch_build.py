"""A scratch copy of the tree, and spidar_tests built in it without SCons, one object at a time.

SCons needs seconds to look at the whole tree; a mutant changes one source. A dry run of SCons therefore gives the
commands that make spidar_tests, once for each run of this program, and they are run here. The compiler writes beside
each object a list of the files that it was made of. The flags are those of the build, without debug information and
without warnings: neither changes the code of an object. A static library is linked as its objects.
"""

import collections
import concurrent.futures
import hashlib
import json
import os
import re
import shlex
import shutil
import subprocess
import tempfile

PROGRAM = "spidar_tests"
LEFT_OUT = ("demo_project/", "addons/", "tests/bench/results/")  # nothing that spidar_tests is made of or reads
GENERATED = "build/generated"

Object = collections.namedtuple("Object", "source target command")


class BuildError(Exception):
    """The unmutated tree does not build, or its commands were not understood."""


# --- The copy --------------------------------------------------------------------------------------


def tree_files(root):
    """Paths of what the tree holds: committed, or about to be."""
    command = ["git", "ls-files", "--cached", "--others", "--exclude-standard", "-z"]
    done = subprocess.run(command, cwd=root, check=True, capture_output=True)
    paths = set(os.fsdecode(done.stdout).split("\0")) - {""}
    return sorted(path for path in paths
                  if not path.startswith(LEFT_OUT) and os.path.isfile(os.path.join(root, path)))


def read_bytes(path):
    with open(path, "rb") as file:
        return file.read()


def put(path, content):
    """Writes a file, unless it holds this already."""
    if os.path.isfile(path) and read_bytes(path) == content:
        return
    os.makedirs(os.path.dirname(path), exist_ok=True)
    with open(path, "wb") as file:
        file.write(content)


def copy_tree(root, copy, paths):
    """Makes `copy` hold these files of `root` and no others, but for its folder build/."""
    wanted = set(paths)
    for folder, folders, names in os.walk(copy):
        if folder == copy and "build" in folders:
            folders.remove("build")
        for name in names:
            path = os.path.join(folder, name)
            if os.path.relpath(path, copy) not in wanted:
                os.remove(path)
    for path in paths:
        put(os.path.join(copy, path), read_bytes(os.path.join(root, path)))


# --- The commands ----------------------------------------------------------------------------------


def without_noise(arguments):
    """The compiler's arguments without debug information, warnings and the folder of the tree."""
    kept = [word for word in arguments if not re.match(r"-g\d?$|-W(?!a,|l,|p,)|-ffile-prefix-map=", word)]
    return [*kept[:1], "-w", *kept[1:]]


def read_plan(lines):
    """(objects, link command) from the lines of SCons's dry run. In the link command objects stand for libraries."""
    objects, archives, link = [], {}, None
    for line in lines:
        try:
            words = shlex.split(line)
        except ValueError:
            continue
        if len(words) > 3 and words[0].endswith("ar") and words[2].endswith(".a"):
            archives[words[2]] = words[3:]
        elif "-o" in words:
            target = words[words.index("-o") + 1]
            if "-c" in words:
                objects.append(Object(words[-1], target, without_noise(words)))
            elif os.path.basename(target) == PROGRAM:
                link = words
    if not objects or not link:
        raise BuildError("SCons's dry run shows no command that makes " + PROGRAM)
    seen, whole = set(), []
    for word in link:
        if word not in archives:
            whole.append(word)
        elif word not in seen:
            whole += archives[word]
            seen.add(word)
    return objects, whole


def ask_scons(tree):
    done = subprocess.run(["scons", "-Q", "-n", "verbose=yes", PROGRAM], cwd=tree, capture_output=True, text=True)
    if done.returncode != 0:
        raise BuildError(f"scons -n {PROGRAM} fails:\n{done.stdout[-2000:]}{done.stderr[-2000:]}")
    return read_plan(done.stdout.splitlines())


def read_dependencies(path):
    """The files that a compiler's list (-MMD) names."""
    with open(path, encoding="utf-8") as file:
        text = file.read().replace("\\\n", " ")
    return [os.path.normpath(word) for word in shlex.split(text.split(":", 1)[1])]


# --- Objects ---------------------------------------------------------------------------------------


def code_of(path):
    """What the linker takes from an object: code, data and the symbols that they refer to. GCC numbers the names of
    its tables by how many declarations came before; these numbers are left out."""
    with tempfile.TemporaryDirectory() as folder:
        stripped = os.path.join(folder, "stripped.o")
        subprocess.run(["objcopy", "--strip-unneeded", path, stripped], check=True, capture_output=True)
        content = read_bytes(stripped)
    return re.sub(rb"(CSWTCH)\.\d+", rb"\1", content)


def compiler_prefix():
    return ["ccache"] if shutil.which("ccache") else []


class BaseBuild:
    """The unmutated tree: `objects` by source, `users` of a file, `link`. Objects lie in home/tree/build."""

    def __init__(self, root, home, jobs):
        self.tree = os.path.join(home, "tree")
        self.paths = tree_files(root)
        copy_tree(root, self.tree, self.paths)
        objects, self.link_command = ask_scons(self.tree)
        self.objects = {item.source: item for item in objects}
        self.stamps_path = os.path.join(self.tree, "build", "stamps.json")
        self.build(jobs)
        self.digest = hashlib.sha256(read_bytes(self.program)).hexdigest()
        self.users = collections.defaultdict(list)
        for item in objects:
            for path in read_dependencies(self.path(item.target) + ".d"):
                self.users[path].append(item)

    def path(self, target):
        return os.path.join(self.tree, target)

    @property
    def program(self):
        return self.path(os.path.join("build", PROGRAM))

    def stamp(self, item, hashes):
        """What an object was made of; None before it was made."""
        if not os.path.isfile(self.path(item.target)) or not os.path.isfile(self.path(item.target) + ".d"):
            return None
        digest = hashlib.sha256(json.dumps(item.command).encode())
        for path in read_dependencies(self.path(item.target) + ".d"):
            if path not in hashes:
                whole = os.path.join(self.tree, path)
                hashes[path] = hashlib.sha256(read_bytes(whole)).digest() if os.path.isfile(whole) else b""
            digest.update(path.encode() + hashes[path])
        return digest.hexdigest()

    def build(self, jobs):
        stamps, hashes = {}, {}
        if os.path.isfile(self.stamps_path):
            with open(self.stamps_path, encoding="utf-8") as file:
                stamps = json.load(file)
        old = [item for item in self.objects.values()
               if stamps.get(item.target) is None or stamps[item.target] != self.stamp(item, hashes)]
        try:
            with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
                for item, error in zip(old, pool.map(lambda item: compile_object(self.tree, item), old)):
                    if error:
                        raise BuildError(f"{item.source} does not compile:\n{error}")
                    stamps[item.target] = self.stamp(item, hashes)
        finally:
            put(self.stamps_path, json.dumps(stamps).encode())
        if old or not os.path.isfile(self.program):
            self.link(self.program, {}, self.tree)

    def link(self, program, replaced, cwd):
        """Links with the object files in `replaced` (by target) in place of those of the base."""
        targets = {item.target for item in self.objects.values()}
        words = list(self.link_command)
        words[words.index("-o") + 1] = program
        words = [replaced.get(word, self.path(word)) if word in targets else word for word in words]
        if shutil.which("ld.gold"):
            words.append("-fuse-ld=gold")
        done = subprocess.run(words, cwd=cwd, capture_output=True, text=True)
        if done.returncode != 0:
            raise BuildError(f"{PROGRAM} does not link:\n{done.stderr[-2000:]}")


def compile_object(tree, item):
    """Compiles one object in this copy of the tree; returns the compiler's complaint, or nothing."""
    target = os.path.join(tree, item.target)
    os.makedirs(os.path.dirname(target), exist_ok=True)
    command = [*compiler_prefix(), *item.command, "-MMD", "-MF", item.target + ".d"]
    done = subprocess.run(command, cwd=tree, capture_output=True, text=True)
    return "" if done.returncode == 0 else done.stderr[-2000:] or "the compiler failed"


# --- Mutants ---------------------------------------------------------------------------------------


class Worker:
    """A copy of the tree in which one mutant at a time is compiled. `base` lends it the objects that do not change."""

    def __init__(self, base, folder):
        self.base = base
        self.tree = folder
        copy_tree(base.tree, folder, base.paths)
        generated = os.path.join(base.tree, GENERATED)
        for name in sorted(os.listdir(generated)) if os.path.isdir(generated) else ():
            put(os.path.join(folder, GENERATED, name), read_bytes(os.path.join(generated, name)))
        self.program = os.path.join(folder, "build", PROGRAM)
        self.temporary = os.path.join(folder, "build", "temporary")
        self.replaced = {}
        self.begin(None, None)

    def begin(self, path, text):
        """Takes back the last mutant and applies the next: `path` then holds `text`."""
        if getattr(self, "path", None):
            put(os.path.join(self.tree, self.path), read_bytes(os.path.join(self.base.tree, self.path)))
        self.path = path
        self.replaced = {}
        shutil.rmtree(self.temporary, ignore_errors=True)
        os.makedirs(self.temporary)
        if path:
            put(os.path.join(self.tree, path), text.encode())

    def compile(self, items):
        """Compiles these; the objects whose code differs from the base's will be linked. Returns a complaint or ""."""
        for item in items:
            complaint = compile_object(self.tree, item)
            if complaint:
                return complaint
            made = os.path.join(self.tree, item.target)
            if code_of(made) != code_of(self.base.path(item.target)):
                self.replaced[item.target] = made
        return ""

    def link(self):
        self.base.link(self.program, self.replaced, self.tree)
