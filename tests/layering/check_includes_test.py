#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs check_includes.py on small trees that break one rule each, and expects each fault to be named."""
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


def include(*headers):
    return "".join(f'#include "{header}"\n' for header in headers)


class CheckIncludes(unittest.TestCase):
    def expect_fault(self, files, text):
        code, out = check(files)
        self.assertEqual(code, 1, out)
        self.assertIn(text, out)
        self.assertIn(" 1 faults", out)

    def expect_allowed(self, files):
        code, out = check(files)
        self.assertEqual(code, 0, out)
        self.assertIn(f"{len(files)} files checked, 0 faults; circles 0, upward includes 0", out)

    def test_allowed(self):
        self.expect_allowed({
            "geometry/b.h": "", "geometry/base/check.h": "", "tracking/a.h": "", "pipelines/c.h": "", "tests/d.h": "",
            "tracking/a.cc": "#include <ceres/ceres.h>\n" + include("geometry/b.h", "geometry/base/check.h", "tracking/a.h"),
            "apps/verb.cc": "#include <CLI/CLI.hpp>\n" + include("tracking/a.h", "pipelines/c.h"),
            "tests/d_test.cc": '#include "tests/d.h"\n'})

    def test_python_binds_what_the_pipelines_reach(self):
        self.expect_allowed({"pipelines/c.h": "", "python/a.h": "#include <pybind11/pybind11.h>\n",
                             "python/a.cc": '#include "python/a.h"\n' + include("pipelines/c.h")})
        self.expect_fault({"neural/b.h": "", "python/a.cc": include("neural/b.h")}, "python/a.cc:1")
        self.expect_fault({"apps/b.h": "", "python/a.cc": '#include "apps/b.h"\n'}, "python/a.cc:1")
        self.expect_fault({"pipelines/a.cc": "#include <pybind11/numpy.h>\n"}, "expected only in python")

    def test_upward_include(self):
        self.expect_fault({"tracking/b.h": "", "geometry/a.cc": "#include <vector>\n" + include("tracking/b.h")},
                          'geometry/a.cc:2: geometry/ includes "tracking/b.h"')

    def test_the_bottom_knows_nobody(self):
        self.expect_fault({"geometry/b.h": "", "geometry/base/a.cc": include("geometry/b.h")},
                          'geometry/base/a.cc:1: geometry/base/ includes "geometry/b.h"')

    def test_siblings_do_not_know_each_other(self):
        for one, other in (("tracking/sub", "data_tools"), ("data_tools", "tracking"), ("neural", "tracking"),
                           ("data_tools/synthesis", "data_tools/evaluation"), ("data_tools/formats", "data_tools/evaluation")):
            self.expect_fault({f"{other}/b.h": "", f"{one}/a.cc": include(f"{other}/b.h")}, f"{one}/a.cc:1")

    def test_evaluation_and_synthesis_stand_above_tracking(self):
        self.expect_allowed({"tracking/b.h": "", "data_tools/evaluation/a.cc": include("tracking/b.h"),
                             "data_tools/synthesis/a.cc": include("tracking/b.h")})

    def test_the_face_of_tracking_knows_the_built_in_body(self):
        self.expect_allowed({"data_tools/b.h": "", "tracking/a.cc": include("data_tools/b.h")})
        self.expect_fault({"data_tools/b.h": "", "tracking/clip/a.cc": include("data_tools/b.h")}, "tracking/clip/a.cc:1")

    def test_detection_stands_above_data_tools_and_beside_tracking(self):
        self.expect_allowed({"data_tools/b.h": "", "tracking/detection/a.cc": include("data_tools/b.h")})
        self.expect_fault({"tracking/b.h": "", "tracking/detection/a.cc": include("tracking/b.h")},
                          "tracking/detection/a.cc:1: tracking/detection/ includes")
        self.expect_fault({"tracking/detection/b.h": "", "data_tools/a.cc": include("tracking/detection/b.h")},
                          "data_tools/a.cc:1: data_tools/ includes")

    def test_networks_of_opencv_are_for_detection(self):
        self.expect_allowed({"tracking/detection/a.cc": "#include <opencv2/dnn.hpp>\n"})
        self.expect_fault({"data_tools/a.cc": "#include <opencv2/dnn.hpp>\n"}, "data_tools/ includes <opencv2/dnn.hpp>")
        self.expect_fault({"tracking/detection/a.h": "#include <opencv2/dnn.hpp>\n"}, "a header includes <opencv2/dnn.hpp>")

    def test_pipelines_stand_below_the_command(self):
        self.expect_fault({"apps/b.h": "", "pipelines/a.cc": '#include "apps/b.h"\n'}, 'pipelines/ includes "apps/b.h"')
        self.expect_fault({"pipelines/neural/b.h": "", "pipelines/a.cc": include("pipelines/neural/b.h")},
                          "pipelines/a.cc:1: pipelines/ includes")
        self.expect_allowed({"neural/motion/motion_config.h": "", "pipelines/a.cc": include("neural/motion/motion_config.h")})

    def test_only_users_programs_have_a_prefix(self):
        self.expect_fault({"geometry/b.h": "", "geometry/a.cc": '#include "bodyloom/geometry/b.h"\n'},
                          'expected "geometry/b.h"')
        self.expect_fault({"geometry/b.h": "", "examples/a.cc": include("geometry/b.h")}, 'expected "bodyloom/geometry/b.h"')
        self.expect_allowed({"geometry/b.h": "", "examples/a.cc": '#include "bodyloom/geometry/b.h"\n#include "bodyloom/bodyloom.h"\n'})
        self.expect_fault({"geometry/a.cc": '#include "bodyloom/bodyloom.h"\n'}, "which is for users' programs")
        self.expect_fault({"tests/b.h": "", "tests/a.cc": '#include "b.h"\n'}, "expected a path from the project root")

    def test_missing_header(self):
        self.expect_fault({"geometry/a.cc": include("geometry/b.h")}, 'includes "geometry/b.h", which is not there')

    def test_circle_of_units(self):
        self.expect_fault({
            "tracking/a.h": "void Fit();\n", "tracking/a.cc": include("tracking/b.h") + "void Fit() { Step(); }\n",
            "tracking/b.h": "void Step();\n", "tracking/b.cc": include("tracking/a.h") + "void Step() { Fit(); }\n"},
            "circle: tracking/a -> tracking/b -> tracking/a")

    def test_helpers_may_take_what_a_facade_declares(self):
        self.expect_allowed({
            "tracking/a.h": "struct Options {};\nvoid Fit();\n",
            "tracking/a.cc": include("tracking/b.h") + "void Fit() { Step({}); }\n",
            "tracking/b.h": include("tracking/a.h") + "void Step(Options options);\n",
            "tracking/b.cc": include("tracking/b.h") + "void Step(Options options) {}\n"})

    def test_circle_of_sub_folders(self):
        self.expect_fault({"tracking/x/a.h": "", "tracking/x/b.h": include("tracking/y/c.h"), "tracking/y/c.h": "",
                           "tracking/y/d.h": include("tracking/x/a.h")},
                          "circle: tracking/x -> tracking/y -> tracking/x")

    def test_circle_of_a_root_and_its_sub_folder(self):
        self.expect_fault({"tracking/a.h": "", "tracking/b.h": include("tracking/x/c.h"), "tracking/x/c.h": "",
                           "tracking/x/d.h": include("tracking/a.h")}, "circle: tracking -> tracking/x -> tracking")

    def test_comments_fit_the_page(self):
        self.expect_fault({"geometry/a.h": "/// " + "x" * 117 + "\n"}, "geometry/a.h:1: a comment 121 columns wide")
        self.expect_fault({"geometry/a.h": "int a;  ///< " + "x" * 108 + "\n"}, "a comment 121 columns wide")
        self.expect_allowed({"geometry/a.h": "/// " + "x" * 116 + "\n// https://example.org/" + "x" * 120 + "\n"})

    def test_third_party_outside_its_home(self):
        self.expect_fault({"geometry/a.cc": "#include <ceres/jet.h>\n"}, "expected only in benchmarks, examples, render/lighting")
        self.expect_fault({"tracking/a.cc": "#  include <torch/torch.h>\n"}, "tracking/a.cc:1")

    def test_third_party_of_one_folder_of_a_room(self):
        self.expect_allowed({"data_tools/video/a.cc": "#include <libavcodec/avcodec.h>\n"})
        self.expect_fault({"data_tools/formats/a.cc": "#include <libavcodec/avcodec.h>\n"}, "data_tools/formats/a.cc:1")
        self.expect_fault({"pipelines/a.cc": "#include <libswscale/swscale.h>\n"}, "pipelines/a.cc:1")
        self.expect_fault({"data_tools/video/a.h": "#include <libavutil/frame.h>\n"}, "expected only in .cc files")
        self.expect_fault({"data_tools/synthesis/a.cc": "#include <zlib.h>\n"}, "data_tools/synthesis/a.cc:1")

    def test_heavy_header_in_a_header(self):
        self.expect_fault({"data_tools/a.h": "#include <nlohmann/json.hpp>\n"}, "expected only in .cc files")

    def test_vector_code_is_named_for_it(self):
        self.expect_fault({"tracking/a.cc": "#include <hwy/highway.h>\n"}, "expected only in *_simd.cc and -inl.h files")
        self.expect_allowed({"tracking/a_simd.cc": "#include <hwy/highway.h>\n"})

    def test_relative_include(self):
        self.expect_fault({"geometry/a.cc": '#include "../render/b.h"\n'}, "expected a path from the project root")

    def test_comments_name_files_that_exist(self):
        self.expect_fault({"geometry/a.cc": "int a;  // as geometry/gone.h says\n"}, "names geometry/gone.h, which is not there")
        self.expect_allowed({"geometry/b.h": "// geometry/b, geometry/b.h, geometry/{a,b}.h and geometry/*.h\n"})

    def test_a_verb_is_short(self):
        text = '#include <CLI/CLI.hpp>\nvoid A() { app.add_subcommand("a", ""); }\n'
        self.expect_fault({"apps/verb_a.cc": text + "//\n" * 119}, "a verb of 121 lines, expected at most 120")
        self.assertIn("longest verb 120", check({"apps/verb_a.cc": text + "//\n" * 118})[1])

    def test_tests_link_libraries(self):
        self.expect_fault({"apps/a.cc": "", "tests/CMakeLists.txt": "target_sources(t PRIVATE ${PROJECT_SOURCE_DIR}/apps/a.cc)\n"},
                          "tests/CMakeLists.txt:1: compiles apps/a, expected a library")

    def test_nothing_to_check(self):
        self.assertEqual(check({"README.md": "no sources"})[0], 2)


if __name__ == "__main__":
    unittest.main()
