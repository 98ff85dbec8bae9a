# SPDX-License-Identifier: Apache-2.0
"""The type stub matches the module: every name, every argument, every default, and a docstring for each."""
import ast
import inspect
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

import bodyloom
from support import SOURCE

PACKAGE = SOURCE / "python" / "bodyloom"
EXAMPLES = sorted((SOURCE / "python" / "examples").glob("*.py"))


def arguments_of(node):
    """[(name, keyword only, default as text or None)] of an ast function, without self."""
    a = node.args
    positional = a.posonlyargs + a.args
    defaults = [None] * (len(positional) - len(a.defaults)) + a.defaults
    found = [(arg.arg, False, default) for arg, default in zip(positional, defaults)]
    found += [(arg.arg, True, default) for arg, default in zip(a.kwonlyargs, a.kw_defaults)]
    found += [("**" + a.kwarg.arg, True, None)] if a.kwarg else []
    return [(name, keyword, None if default is None else ast.literal_eval(default))
            for name, keyword, default in found if name != "self"]


def stub_items():
    """(names of the stub, {"function" or "Class.method": [its signatures]}, {"Class.property"})."""
    names, functions, properties = set(), {}, set()
    for node in ast.parse((PACKAGE / "__init__.pyi").read_text(encoding="utf-8")).body:
        if isinstance(node, ast.FunctionDef):
            functions.setdefault(node.name, []).append(arguments_of(node))
        elif isinstance(node, ast.ClassDef):
            names.add(node.name)
            for item in node.body:
                if not isinstance(item, ast.FunctionDef):
                    continue
                path = f"{node.name}.{item.name}"
                if any(isinstance(d, ast.Name) and d.id == "property" for d in item.decorator_list):
                    properties.add(path)
                else:
                    functions.setdefault(path, []).append(arguments_of(item))
        elif isinstance(node, ast.AnnAssign):
            names.add(node.target.id)
    return names | {name for name in functions if "." not in name}, functions, properties


def module_arguments(function):
    """The same of a function of the module, from the first line of its docstring."""
    line = function.__doc__.splitlines()[0]
    text = re.sub(r"=\s*<[^>]*>", "=None", line)
    return arguments_of(ast.parse(f"def {text}: ...").body[0])


def own_methods(cls):
    skipped = {"__new__", "__repr__", "__str__", "__getstate__", "__setstate__", "__module__", "__doc__", "__dict__",
               "__weakref__"}
    return {name for name, value in vars(cls).items()
            if name not in skipped and not name.startswith("__pybind11") and not name.startswith("_pybind11")
            and (inspect.isroutine(value) or isinstance(value, (staticmethod, property)))}


class Stub(unittest.TestCase):
    def setUp(self):
        self.names, self.functions, self.properties = stub_items()

    def test_names(self):
        self.assertEqual(set(bodyloom.__all__), self.names)
        self.assertGreater(len(self.functions), 30)
        public = {name for name in vars(bodyloom._bodyloom) if not name.startswith("_")}
        self.assertEqual(public, self.names - {"__version__"})

    def test_members(self):
        for name in bodyloom.__all__:
            value = getattr(bodyloom, name)
            if not isinstance(value, type) or issubclass(value, Exception):
                continue
            with self.subTest(name=name):
                in_stub = {path.split(".")[1] for path in [*self.functions, *self.properties] if path.startswith(name + ".")}
                in_module = own_methods(value)
                if "__init__" not in in_stub:  # pybind11 gives every class one, which raises
                    in_module.discard("__init__")
                self.assertEqual(in_module, in_stub)

    def test_signatures(self):
        compared = 0
        for path, signatures in self.functions.items():
            *owner, name = path.split(".")
            function = getattr(getattr(bodyloom, owner[0]), name) if owner else getattr(bodyloom, name)
            for signature in signatures:
                with self.subTest(path=path):
                    found = module_arguments(function)
                    if path.endswith(("__len__", "__getitem__")):
                        found = [argument for argument in found if argument[0] != "arg0"]
                    # An overload's `out` has no default where its presence makes the difference.
                    expected = [(n, k, None) if n == "out" else (n, k, d) for n, k, d in signature]
                    self.assertEqual([(n, k, str(d)) for n, k, d in found], [(n, k, str(d)) for n, k, d in expected])
                    compared += 1
        self.assertGreater(compared, 30)

    def test_docstrings(self):
        for path in [*self.functions, *self.properties]:
            *owner, name = path.split(".")
            if name.startswith("__"):
                continue
            value = getattr(getattr(bodyloom, owner[0]), name) if owner else getattr(bodyloom, name)
            with self.subTest(path=path):
                text = value.__doc__ or ""
                if path in self.functions:
                    text = "\n".join(text.splitlines()[1:]).strip()
                    self.assertGreater(len(text), 20)


class Types(unittest.TestCase):
    def mypy(self, *words, expected=0):
        done = subprocess.run([sys.executable, "-m", "mypy", *words], capture_output=True, text=True, check=False,
                              cwd=SOURCE / "python", env={"PATH": "/usr/bin:/bin", "MYPY_CACHE_DIR": self.cache.name})
        if "No module named mypy" in done.stderr:
            self.skipTest("no mypy here (Debian package mypy)")
        self.assertEqual(done.returncode, expected, done.stdout + done.stderr)
        return done.stdout

    def setUp(self):
        self.cache = tempfile.TemporaryDirectory()
        self.addCleanup(self.cache.cleanup)

    def test_strict(self):
        self.assertGreater(len(EXAMPLES), 1)
        # Debian's matplotlib has no types.
        self.mypy("--strict", "--ignore-missing-imports", "bodyloom/__init__.pyi", *map(str, EXAMPLES))

    def test_a_wrong_call_is_found(self):
        wrong = pathlib.Path(self.cache.name, "wrong.py")
        wrong.write_text("import bodyloom\nbodyloom.track(solver='simplex')\nbodyloom.Body.builtin().vertices()\n"
                         "x: int = bodyloom.Track.load('t.npz').poses\n")
        found = self.mypy("--strict", str(wrong), expected=1)
        for line in (2, 3, 4):
            self.assertIn(f"wrong.py:{line}: error", found)


if __name__ == "__main__":
    unittest.main()
