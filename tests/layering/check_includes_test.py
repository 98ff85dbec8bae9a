#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Feeds check_includes.py small trees that break one rule each and expects each fault to be named."""
import pathlib
import subprocess
import sys
import tempfile
import unittest

CHECKER = pathlib.Path(__file__).with_name("check_includes.py")


def check(files):
    with tempfile.TemporaryDirectory() as root:
        for name, text in files.items():
            path = pathlib.Path(root, name)
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text)
        done = subprocess.run([sys.executable, str(CHECKER), root], capture_output=True, text=True, check=False)
        return done.returncode, done.stdout


class CheckIncludes(unittest.TestCase):
    def expect_fault(self, files, text):
        code, out = check(files)
        self.assertEqual(code, 1, out)
        self.assertIn(text, out)
        self.assertIn("1 faults", out)

    def test_allowed(self):
        code, out = check({
            "tracking/a.cc": '#include <ceres/ceres.h>\n#include "bodyloom/geometry/b.h"\n#include "bodyloom/tracking/a.h"\n',
            "apps/verb.cc": '#include <CLI/CLI.hpp>\n#include "bodyloom/tracking/a.h"\n#include "bodyloom/data_tools/c.h"\n'})
        self.assertEqual((code, out), (0, "2 files checked, 0 faults\n"))

    def test_upward_include(self):
        self.expect_fault({"geometry/a.cc": '#include <vector>\n#include "bodyloom/tracking/b.h"\n'},
                          'geometry/a.cc:2: geometry/ includes "tracking/b.h"')

    def test_siblings_do_not_know_each_other(self):
        self.expect_fault({"tracking/sub/a.cc": '#include "bodyloom/data_tools/b.h"\n'}, "tracking/sub/a.cc:1")
        self.expect_fault({"data_tools/a.cc": '#include "bodyloom/tracking/b.h"\n'}, "data_tools/a.cc:1")
        self.expect_fault({"neural/a.cc": '#include "bodyloom/tracking/b.h"\n'}, "neural/a.cc:1")

    def test_evaluation_measures_with_tracking(self):
        code, out = check({"data_tools/evaluation/a.cc": '#include "bodyloom/data_tools/evaluation/metrics.h"\n'})
        self.assertEqual((code, out), (0, "1 files checked, 0 faults\n"))
        self.expect_fault({"data_tools/formats/a.cc": '#include "bodyloom/data_tools/evaluation/metrics.h"\n'}, "data_tools/formats/a.cc:1")

    def test_third_party_outside_its_home(self):
        self.expect_fault({"geometry/a.cc": "#include <ceres/jet.h>\n"}, "expected only in benchmarks, tests, tracking")
        self.expect_fault({"tracking/a.cc": "#  include <torch/torch.h>\n"}, "tracking/a.cc:1")

    def test_heavy_header_in_a_header(self):
        self.expect_fault({"data_tools/a.h": "#include <nlohmann/json.hpp>\n"}, "expected only in .cc files")

    def test_relative_include(self):
        self.expect_fault({"geometry/a.cc": '#include "../render/b.h"\n'}, "expected a path from the project root")

    def test_nothing_to_check(self):
        self.assertEqual(check({"README.md": "no sources"})[0], 2)


if __name__ == "__main__":
    unittest.main()
