#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs check_names.py on small libraries with and without colliding names."""
import pathlib
import subprocess
import sys
import tempfile
import unittest

CHECKER = pathlib.Path(__file__).with_name("check_names.py")


def check(files):
    with tempfile.TemporaryDirectory() as root:
        for name, text in files.items():
            path = pathlib.Path(root, name)
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text)
        done = subprocess.run([sys.executable, str(CHECKER), root], capture_output=True, text=True, check=False)
        return done.returncode, done.stdout


def private(text):
    return "namespace bodyloom {\nnamespace {\n" + text + "\n}  // namespace\n}  // namespace bodyloom\n"


class CheckNames(unittest.TestCase):
    def expect_collision(self, name, first, second):
        code, out = check({"geometry/a.cc": private(first), "geometry/b.cc": private(second)})
        self.assertEqual(code, 1, out)
        self.assertRegex(out, rf"geometry/b\.cc:\d+: {name}.*, also in geometry/a\.cc:\d+;")

    def expect_allowed(self, files):
        code, out = check(files)
        self.assertEqual(code, 0, out)
        self.assertIn(" 0 faults", out)

    def test_values(self):
        self.expect_collision("kSize", "constexpr int kOther = 1, kThird = 2;\nconst double kSize = f(1);", "constexpr int kSize = 3;")
        self.expect_collision("kThird", "constexpr double kFirst = f(1, 2), kThird = 2;", "constexpr int kOther = 3, kThird = 4;")
        self.expect_collision("kTable", "constexpr int kTable[] = {1, 2};", "constexpr std::array<int, 2> kTable = {1, 2};")
        self.expect_collision("kText", 'constexpr const char* kText = "{;";', 'constexpr const char* kText = R"(")";};)";')

    def test_tests_have_namespaces_of_their_own(self):
        def test(name):
            return f"namespace bodyloom::{name} {{\nnamespace {{\nTEST(A, B) {{}}\n}}  // namespace\n}}  // namespace bodyloom::{name}\n"
        files = {"geometry/a.cc": "", "tests/geometry/a_test.cc": test("a_test")}
        self.expect_allowed(files)
        code, out = check({**files, "tests/geometry/b_test.cc": test("a_test")})
        self.assertEqual(code, 1, out)
        self.assertIn("tests/geometry/b_test.cc: no namespace bodyloom::b_test", out)
        code, out = check({**files, "tests/geometry/body/a_test.cc": test("a_test")})
        self.assertEqual(code, 1, out)
        self.assertIn("a_test, also tests/geometry/a_test.cc", out)

    def test_types(self):
        self.expect_collision("Reader", "class Reader {\n int F() { return 1; }\n};", "struct Reader final : Base {\n};")
        self.expect_collision("Kind", "enum class Kind { kA };", "using Kind = int;")
        self.expect_collision("kFirst", "enum Stream { kZero, kFirst = 3 };", "int kFirst = 0;")

    def test_functions(self):
        self.expect_collision("Mean", "double Mean(const std::vector<double>& x) { return x[0]; }",
                              "double Mean(const std::vector<double>& values) {\n  return values[1];\n}")
        self.expect_collision("Twice", "template <typename T>\nT Twice(T x) { return 2 * x; }", "template <class T>\nT Twice(T y) { return y + y; }")

    def test_what_one_namespace_can_have(self):
        self.expect_allowed({
            "geometry/a.cc": private("int F(int x) { return x; }\nusing Eigen::Vector3d;\nnamespace fs = std::filesystem;\nusing Json = nlohmann::json;"),
            "geometry/b.cc": private("int F(double x) { return 1; }\nusing Eigen::Vector3d;\nnamespace fs = std::filesystem;\nusing Json = nlohmann::json;"),
        })

    def test_members_and_locals_are_no_names_of_the_namespace(self):
        self.expect_allowed({
            "geometry/a.cc": private("struct A {\n  int size = 0;\n  void Run() { const int count = 1; }\n};"),
            "geometry/b.cc": private("class B {\n  int size = 0;\n  void Run() { const int count = 1; }\n};\nint G() { int count = 2; return count; }"),
        })

    def test_other_libraries_and_single_files(self):
        same = private("constexpr int kSize = 3;")
        self.expect_allowed({"geometry/a.cc": same, "render/b.cc": same, "data_tools/c.cc": same,
                             "data_tools/synthesis/d.cc": same, "geometry/loop_simd.cc": same})

    def test_headers_of_the_library(self):
        code, out = check({"geometry/a.h": "namespace bodyloom {\ninline constexpr int kSize = 3;\n}\n",
                           "geometry/b.cc": private("constexpr int kSize = 3;")})
        self.assertEqual(code, 1, out)
        self.assertIn("geometry/b.cc:3: kSize, also in geometry/a.h:2", out)

    def test_nothing_to_check(self):
        self.assertEqual(check({"docs/a.md": ""})[0], 2)


if __name__ == "__main__":
    unittest.main()
