#!/usr/bin/env python3
"""The tests of tools/docs and of ./dev release: run_docs_tests.py GODOT

Each check is shown a page or a help text that is right, and one with each fault. The last line is "N passed, N failed".
"""

import os
import sys
import unittest

HERE = os.path.dirname(os.path.abspath(__file__))


def main(godot):
    os.environ["GODOT"] = godot
    suite = unittest.defaultTestLoader.discover(HERE)
    result = unittest.TextTestRunner(stream=sys.stdout).run(suite)
    failed = len(result.failures) + len(result.errors)
    print(f"{result.testsRun - failed} passed, {failed} failed")
    return 1 if failed or not result.testsRun else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]) if len(sys.argv) == 2 else __doc__)
