#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs check_draws.py on calls whose draws have a defined order, and on calls whose draws have none."""
import pathlib
import subprocess
import sys
import tempfile
import unittest

CHECKER = pathlib.Path(__file__).with_name("check_draws.py")


def check(text):
    with tempfile.TemporaryDirectory() as root:
        path = pathlib.Path(root, "geometry/a.cc")
        path.parent.mkdir()
        path.write_text(f"void F(HashRandom* random, std::mt19937* rng) {{\n{text}\n}}\n")
        done = subprocess.run([sys.executable, str(CHECKER), root], capture_output=True, text=True, check=False)
        return done.returncode, done.stdout


class CheckDraws(unittest.TestCase):
    def test_two_draws_of_one_call(self):
        for text in ("Vector3d v(random->Normal(), 0, random->Normal());", "p = q + Vector2d(normal(rng), normal(rng));",
                     "Put(uniform(),\n    uniform());", "Turn(Draw(&random, 0, 1), Draw(&random, 0, 2));", "f(g(random), h(random, 1));",
                     "v = Vector2d(2 * noise.Normal(), std::max(0.0, noise.Uniform()));"):
            code, out = check(text)
            self.assertEqual(code, 1, text)
            self.assertIn("geometry/a.cc:2: two arguments", out)

    def test_draws_on_both_sides_of_an_operator(self):
        for text in ("q = TurnBy(Draw(random, 0, 1)) * TurnBy(Draw(random, 0, 2));", "const double x = 1 + random->Normal() - 2 * random->Normal();",
                     "f(random->Uniform() * (random->Uniform() < 0.5 ? -1 : 1));", "return a[i] + normal(rng) * b +\n    normal(rng) * c;"):
            code, out = check(text)
            self.assertEqual(code, 1, text)
            self.assertIn("geometry/a.cc:2: two operands", out)

    def test_draws_in_order(self):
        for text in ("Vector3d v{random->Normal(), 0, random->Normal()};", "const double x = random->Normal(), y = random->Normal();",
                     "f(random->Normal(), 1);", "// Vector2d(normal(rng), normal(rng))", "Log(\"normal(rng), normal(rng)\");",
                     "for (double a = random->Uniform(), b = random->Uniform(); a < b; ++a) {\n}", "f({random->Normal(), random->Normal()}, 1);",
                     "if (random->Uniform() < 0.5 && random->Uniform() < a * b) c = random->Normal() * d;",
                     "x = random->Uniform() < 0.5 ? -random->Normal() : random->Normal();", "{\n  a = random->Normal();\n}\n*b = random->Normal();",
                     "std::vector<int>& c = F(random);\nint* d = G(random) + 1;", "const auto e = random->Below(3), f = 4 * random->Below(5);",
                     "void G(HashRandom* random, double normal(double x));"):
            code, out = check(text)
            self.assertEqual(code, 0, text + "\n" + out)

    def test_nothing_to_check(self):
        with tempfile.TemporaryDirectory() as root:
            self.assertEqual(subprocess.run([sys.executable, str(CHECKER), root], capture_output=True, check=False).returncode, 2)


if __name__ == "__main__":
    unittest.main()
