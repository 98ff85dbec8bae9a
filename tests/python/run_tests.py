#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs the unittest cases of one file and writes a report in GoogleTest's format for `./dev test`.

usage: run_tests.py FILE REPORT.xml     exit 0: all passed or skipped, 1: not
"""
import importlib.util
import pathlib
import sys
import time
import unittest
from xml.sax.saxutils import quoteattr


class Reporting(unittest.TextTestResult):
    """Keeps a line of XML a case."""

    def __init__(self, *arguments):
        super().__init__(*arguments)
        self.lines = []

    def startTest(self, test):
        self.outcome = ""
        self.begun = time.monotonic()
        super().startTest(test)

    def addFailure(self, test, error):
        super().addFailure(test, error)
        self.outcome = "<failure message=\"failed\"/>"

    def addError(self, test, error):
        super().addError(test, error)
        self.outcome = "<failure message=\"error\"/>"

    def addSkip(self, test, reason):
        super().addSkip(test, reason)
        self.outcome = f"<skipped message={quoteattr(reason)}/>"

    def addSubTest(self, test, subtest, error):
        super().addSubTest(test, subtest, error)
        if error is not None:
            self.outcome = "<failure message=\"failed\"/>"

    def stopTest(self, test):
        super().stopTest(test)
        _, suite, name = test.id().rsplit(".", 2)
        self.lines.append(f'<testcase name={quoteattr(name)} time="{time.monotonic() - self.begun:.3f}" '
                          f"classname={quoteattr(suite)}>{self.outcome}</testcase>\n")


def main():
    file, report = map(pathlib.Path, sys.argv[1:3])
    sys.path.insert(0, str(file.parent))
    spec = importlib.util.spec_from_file_location(file.stem, file)
    module = importlib.util.module_from_spec(spec)
    sys.modules[file.stem] = module
    spec.loader.exec_module(module)
    suite = unittest.defaultTestLoader.loadTestsFromModule(module)
    result = unittest.TextTestRunner(sys.stdout, verbosity=2, resultclass=Reporting).run(suite)
    report.parent.mkdir(parents=True, exist_ok=True)
    report.write_text("<testsuites>\n" + "".join(result.lines) + "</testsuites>\n", encoding="utf-8")
    return 0 if result.wasSuccessful() and result.testsRun + len(result.skipped) > 0 else 1


if __name__ == "__main__":
    sys.exit(main())
