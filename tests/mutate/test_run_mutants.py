#!/usr/bin/env python3
"""The mutation runner on a tiny tree: what it draws, and what it says of five known mutants.

The last line is "N passed, N failed".
"""

import os
import re
import subprocess
import sys
import tempfile
import unittest

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, HERE)
import mutants  # noqa: E402
import scratch_build  # noqa: E402
import test_runs  # noqa: E402

SOURCE = """#include "core/sum/sum.h"

int sum_to(int n) {
    int sum = 0;
    int unused = 0;
    for (int i = 1; i <= n; ++i) {
        sum += i;
    }
    unused = 1;
    while (n > 100) {
        n -= 1;
    }
    if (n > 50) {
        sum = 0;
    }
    return kStep * add(sum, "");
}
"""
HEADER = """#pragma once

inline constexpr int kStep = 1;

inline int add(int sum, const char *text) { return text[0] == 0 ? sum : 0; }

int sum_to(int n);
"""
TEST = """#define DOCTEST_CONFIG_IMPLEMENT_WITH_MAIN
#include <doctest/doctest.h>

#include "core/sum/sum.h"

TEST_CASE("a small sum") { CHECK(sum_to(3) == 6 * kStep); }
"""
OTHER_TEST = """#include <doctest/doctest.h>

#include "core/sum/sum.h"

TEST_CASE("a sum of another room") { CHECK(sum_to(4) == 10); }
"""
BUILD = """env = Environment(CPPPATH=["#gdextension"], CXXFLAGS=["-std=c++20", "-O1"])
library = env.StaticLibrary("build/lib/core", [env.SharedObject("build/obj/sum", "gdextension/core/sum/sum.cpp")])
names = ("core/sum/test_sum", "device/test_other")
nodes = [env.SharedObject("build/obj/" + name, f"tests/{name}.cpp") for name in names]
Alias("spidar_tests", env.Program("build/bin/spidar_tests", nodes, LIBS=library))
"""
SUM = "gdextension/core/sum/sum.cpp"
SUM_H = "gdextension/core/sum/sum.h"
TREE = {
    SUM: SOURCE, SUM_H: HEADER, "tests/core/sum/test_sum.cpp": TEST, "tests/device/test_other.cpp": OTHER_TEST,
    "SConstruct": BUILD, ".gitignore": "/build/\n",
}
KILLED = f"{SUM}:7:9:drop-statement"
SURVIVING = f"{SUM}:14:9:drop-reset"
EQUIVALENT = f"{SUM}:9:5:drop-reset"
NOT_COMPILED = f"{SUM}:16:24:swap-arguments"
ENDLESS = f"{SUM}:10:12:negate-condition"
HEADER_KILLED = f"{SUM_H}:5:44:early-return"
SHARED_CONSTANT = f"{SUM_H}:3:30:constant+1"  # the near test says the same constant: the other one notices


def kinds(text):
    """What is made of a function's body: {changed text: kind}."""
    source = "void f() {\n" + text + "\n}\n"
    found = {}
    for mutant in mutants.all_mutants("x.cpp", source):
        changed = mutant.text.splitlines()
        found["\n".join(changed[1:-1])] = mutant.kind
    return found


class Generator(unittest.TestCase):
    def test_statements_are_dropped_and_declarations_are_not(self):
        found = kinds("int a = b;\nstd::array<int, 3> c{};\nd.e(f,\n  g);\nh = i;")
        dropped = [text for text, kind in found.items() if kind.startswith("drop")]
        self.assertEqual(dropped, ["int a = b;\nstd::array<int, 3> c{};\n;\n\nh = i;",
                                   "int a = b;\nstd::array<int, 3> c{};\nd.e(f,\n  g);\n;"])

    def test_resets_are_told_from_other_statements(self):
        for text in ("a = 0.0;", "a_ = {};", "a.reset();", "b = State::off;", "c = Wrench();", "clear_all();"):
            self.assertEqual(kinds(text)[";"], "drop-reset", text)
        for text in ("a = b;", "a = b();", "set(1);", "a += 1;"):
            self.assertEqual(kinds(text)[";"], "drop-statement", text)

    def test_conditions(self):
        self.assertEqual(kinds("if (a) {\n}")["if (!(a)) {\n}"], "negate-condition")
        self.assertEqual(kinds("while (a.b()) {\n}")["while (!(a.b())) {\n}"], "negate-condition")
        self.assertEqual(kinds("x(a ? b : c);")["x(!(a) ? b : c);"], "negate-condition")
        self.assertEqual(kinds("x(!a);")["x(a);"], "drop-not")
        self.assertEqual(kinds("x(a && b);")["x(a || b);"], "logical")

    def test_operators(self):
        self.assertEqual(kinds("x(a < b);")["x(a > b);"], "flip-relation")
        self.assertEqual(kinds("x(a < b);")["x(a <= b);"], "boundary")
        self.assertEqual(kinds("x(a == b);")["x(a != b);"], "flip-relation")
        self.assertEqual(kinds("x(a * b);")["x(a / b);"], "operator")
        self.assertEqual(kinds("x(-a);")["x(a);"], "drop-minus")
        self.assertEqual(kinds("++a;")["--a;"], "step")

    def test_references_and_templates_are_no_operators(self):
        text = "const std::vector<double> &a = *b;\nauto &&c = d;"
        self.assertFalse({"operator", "logical", "boundary", "flip-relation"} & set(kinds(text).values()))

    def test_values_and_arguments(self):
        self.assertEqual(kinds("x(3U);")["x(4U);"], "constant+1")
        self.assertEqual(kinds("x(1'000);")["x(999);"], "constant-1")
        self.assertEqual(kinds("x(0.5);")["x((0.5 * 2.0));"], "constant*2")
        self.assertEqual(kinds("x(0.0);")["x(1.0);"], "constant+1")
        self.assertEqual(kinds("x(a, b(c));")["x(b(c), a);"], "swap-arguments")
        self.assertNotIn("swap-arguments", kinds("x = std::min(a, b);").values())
        self.assertNotIn("constant+1", kinds("std::array<int, 3> a;").values())

    def test_early_returns_by_result(self):
        def ways(text):
            made = mutants.all_mutants("x.cpp", text + " { x(); }\n")
            return {mutant.text.split("{ ")[1].split(";")[0] for mutant in made if mutant.family == "early-return"}

        self.assertEqual(ways("void A::f(int) const noexcept"), {"return"})
        self.assertEqual(ways("[[nodiscard]] bool f()"), {"return true", "return false"})
        self.assertEqual(ways("template <typename T> Wrench g(T t)"), {"return {}"})
        self.assertEqual(ways("A::A(int x) : x_(x)"), set())

    def test_strings_comments_and_preprocessor_lines_are_left_alone(self):
        self.assertEqual(mutants.all_mutants("x.cpp", '#if A + 1\n#endif\nvoid f() { /* a + 1; */ } // b = 0;\n'), [])
        self.assertEqual({"drop-statement", "early-return"}, {
            mutant.kind for mutant in mutants.all_mutants("x.cpp", 'void f() { x("a + 1, 2 && !c"); }\n')})

    def test_lines_keep_their_numbers(self):
        for mutant in mutants.all_mutants(SUM, SOURCE):
            self.assertEqual(mutant.text.count("\n"), SOURCE.count("\n"), mutant.name)

    def test_the_draw_is_the_seeds(self):
        made = mutants.all_mutants(SUM, SOURCE)
        names = [[mutant.name for mutant in mutants.in_drawn_order(made, seed)] for seed in (1, 1, 2)]
        self.assertEqual(names[0], names[1])
        self.assertNotEqual(names[0], names[2])
        self.assertEqual(sorted(names[0]), sorted(names[2]))
        self.assertEqual(len(set(names[0])), len(made))


class Rooms(unittest.TestCase):
    def test_the_nearest_tests_come_first(self):
        self.assertEqual(test_runs.room_of("gdextension/core/tension/fast/x.h"), "core/tension/fast")
        order = ["core/tension/fast", "core/tension", "core/geometry", "device/step"]
        self.assertEqual([test_runs.distance("core/tension/fast", room) for room in order], [0, 1, 2, 3])


class Plan(unittest.TestCase):
    def test_libraries_are_linked_as_their_objects_once(self):
        objects, link = scratch_build.read_plan([
            "g++ -o a.os -c -g1 -Wall -Werror -O2 -ffile-prefix-map=/x=. a.cpp", "ar rc liba.a a.os", "ranlib liba.a",
            "g++ -o bin/spidar_tests t.os liba.a -lhid liba.a"])
        command = ["g++", "-w", "-o", "a.os", "-c", "-O2", "a.cpp"]
        self.assertEqual(objects, [scratch_build.Object("a.cpp", "a.os", command)])
        self.assertEqual(link, ["g++", "-o", "bin/spidar_tests", "t.os", "a.os", "-lhid"])


class TinyTree(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.root = cls.folder.name
        for path, text in TREE.items():
            scratch_build.put(os.path.join(cls.root, path), text.encode())
        subprocess.run(["git", "init", "-q", cls.root], check=True)
        cls.code, cls.output = cls.run_mutants(
            "--only", KILLED, SURVIVING, EQUIVALENT, NOT_COMPILED, ENDLESS, HEADER_KILLED, SHARED_CONSTANT)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    @classmethod
    def run_mutants(cls, *arguments):
        done = subprocess.run([sys.executable, os.path.join(HERE, "run_mutants.py"), "--root", cls.root, *arguments],
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=600)
        return done.returncode, done.stdout

    def outcome(self, name):
        line = r"^ *\d+/\d+ (.*?)  +[\d.]+ s  " + re.escape(name) + r"\n(?:        (.*))?"
        found = re.search(line, self.output, re.MULTILINE)
        self.assertTrue(found, f"{name} in:\n{self.output}")
        return found[1], found[2] or ""

    def test_killed_names_the_test_case(self):
        self.assertEqual(self.outcome(KILLED), ("killed", "a small sum (tests/core/sum/test_sum.cpp), failed"))

    def test_survivor_is_shown_with_its_change(self):
        self.assertEqual(self.outcome(SURVIVING), ("survived", ""))
        self.assertIn(f"survived: {SURVIVING}\n-        sum = 0;\n+        ;\n", self.output)

    def test_equivalent(self):
        self.assertEqual(self.outcome(EQUIVALENT)[0], "equivalent")

    def test_not_compiled(self):
        self.assertEqual(self.outcome(NOT_COMPILED)[0], "not compiled")

    def test_endless(self):
        outcome, by = self.outcome(ENDLESS)
        self.assertEqual(outcome, "killed")
        self.assertIn("endless", by)

    def test_headers_reach_everything_that_includes_them(self):
        self.assertEqual(self.outcome(HEADER_KILLED)[0], "killed")
        self.assertEqual(self.outcome(SHARED_CONSTANT),
                         ("killed", "a sum of another room (tests/device/test_other.cpp), failed"))

    def test_totals(self):
        self.assertEqual(self.code, 0)
        self.assertEqual(self.output.splitlines()[-1], "killed 4 of 5 real mutants (80 %)")
        self.assertIn("1 equivalent, 1 not compiled", self.output)

    def test_the_tree_itself_is_not_touched(self):
        for path, text in TREE.items():
            self.assertEqual(scratch_build.read_bytes(os.path.join(self.root, path)).decode(), text)

    def test_one_alone_and_too_few_killed(self):
        code, output = self.run_mutants("--only", SURVIVING, "--at-least", "90")
        self.assertEqual(code, 1)
        self.assertEqual(output.splitlines()[-1], "killed 0 of 1 real mutants (0 %)")

    def test_a_draw_counts_those_that_compile(self):
        code, output = self.run_mutants("--count", "4", "--seed", "3", "--jobs", "2")
        self.assertEqual(code, 0, output)
        outcomes = re.findall(r"^ *\d+/4 (killed|survived|equivalent|not compiled)", output, re.MULTILINE)
        self.assertEqual(len([outcome for outcome in outcomes if outcome != "not compiled"]), 4, output)
        again = self.run_mutants("--count", "4", "--seed", "3", "--again")[1]
        self.assertEqual(output.splitlines()[-1], again.splitlines()[-1])

    def test_an_unknown_name_lists_those_of_its_line(self):
        code, output = self.run_mutants("--only", f"{SUM}:9:5:no-such-kind")
        self.assertEqual(code, 1)
        self.assertIn(EQUIVALENT, output)


def main():
    result = unittest.TextTestRunner(stream=sys.stdout).run(
        unittest.defaultTestLoader.loadTestsFromModule(sys.modules[__name__]))
    failed = len(result.failures) + len(result.errors)
    print(f"{result.testsRun - failed} passed, {failed} failed")
    return 1 if failed or not result.testsRun else 0


if __name__ == "__main__":
    sys.exit(main())
