#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Checks the layering: which room includes which, cycles, where third-party headers may be, and that comments name files
that exist.

usage: check_includes.py [ROOT]      exit 0 when all is well, 1 with one line a fault, 2 when there is nothing to check

A room is a folder with a library of its own, or a top-level folder of programs. The rules are the tables below
(CONTRIBUTING.md, "Layers"). Faults read "file:line: what, expected what"; the last line counts what was found, so that
two trees can be compared.
"""
import pathlib
import re
import sys

BASE = {"geometry"}
SEEN = BASE | {"render"}
JUDGED = SEEN | {"tracking", "data_tools"}
WHOLE = JUDGED | {"render/lighting", "render/photo_avatar", "tracking/detection", "data_tools/synthesis",
                  "data_tools/evaluation"}
# Room -> rooms whose headers it may include (always its own). A file belongs to the longest path that fits.
ROOMS = {
    "geometry/base": set(),
    "geometry": {"geometry/base"},
    "render": BASE,
    "render/lighting": SEEN,
    "render/photo_avatar": SEEN | {"render/lighting"},
    "tracking": SEEN,
    "data_tools": SEEN,
    "tracking/detection": SEEN | {"data_tools"},
    "data_tools/synthesis": JUDGED,
    "data_tools/evaluation": JUDGED,
    "neural": SEEN,
    "pipelines": WHOLE,
    "pipelines/neural": WHOLE | {"pipelines", "neural"},
    "apps": WHOLE | {"pipelines"},
    "apps/neural": WHOLE | {"pipelines", "pipelines/neural", "neural", "apps"},
    "apps/cgal": WHOLE | {"pipelines", "apps"},
    "examples": WHOLE | {"pipelines"},
    "python": WHOLE | {"pipelines"},
    "benchmarks": WHOLE | {"pipelines", "pipelines/neural", "neural", "tests"},
    "tests": WHOLE | {"pipelines", "pipelines/neural", "neural", "apps", "benchmarks"},
}
for room in ROOMS:
    if room != "geometry/base":
        ROOMS[room] = ROOMS[room] | {"geometry/base"}
# What files in a room's root may include besides: tracking's face fills in the built-in body, prior and lifter.
ROOTS = {"tracking": {"data_tools"}}
# Headers of a room above that hold plain data and need no LibTorch: room -> pattern of their paths.
EXCEPTIONS = {"pipelines": r"neural/\w+/(\w+_config|motion_frame)\.h$"}
WIDTH = 120  # columns of a comment

PROGRAMS = ("apps", "tests", "benchmarks", "examples", "python")
FOLDERS = sorted({room.split("/")[0] for room in ROOMS})
TEST_CODE = {"tests", "benchmarks"}
LIBRARIES = {room for room in ROOMS if not room.startswith(PROGRAMS)}

# Third-party header -> (rooms or folders of theirs that may include it, whether a header file of ours may).
THIRD_PARTY = [
    (r"ceres/", {"tracking", "render/lighting", "examples"} | TEST_CODE, True),
    (r"opencv2/dnn", {"tracking/detection"} | TEST_CODE, False),
    (r"opencv2/calib3d", {"tracking/camera_motion"} | TEST_CODE, False),
    (r"opencv2/(?!calib3d)", {"render", "render/lighting", "render/photo_avatar", "data_tools", "tracking/detection", "data_tools/synthesis",
                   "data_tools/evaluation", "pipelines", "pipelines/neural"} | TEST_CODE, True),
    (r"(torch|ATen|c10|caffe2)/", {"neural", "pipelines/neural"} | TEST_CODE, True),
    (r"CGAL/", {"apps/cgal"} | TEST_CODE, False),
    (r"embree3/", TEST_CODE, False),
    (r"OpenMesh/", {"data_tools"} | TEST_CODE, False),
    (r"nlohmann/(?!json_fwd)", {"data_tools", "data_tools/synthesis", "data_tools/evaluation", "pipelines",
                                "pipelines/neural"} | TEST_CODE, False),
    (r"(matio|zlib)\.h", {"data_tools"} | TEST_CODE, False),
    (r"lo/lo", {"data_tools"}, False),
    (r"httplib\.h", {"pipelines"} | TEST_CODE, False),
    (r"toml\+\+/", {"data_tools"}, False),
    (r"lib(av\w+|swscale|swresample)/(?!(sha|mem)\.h)", {"data_tools/video"} | TEST_CODE, False),
    (r"libavutil/(sha|mem)\.h", {"data_tools"} | TEST_CODE, False),
    (r"CLI/", {"apps", "apps/neural", "apps/cgal"}, False),
    (r"pybind11/", {"python"}, True),
    (r"hwy/", LIBRARIES | TEST_CODE, False),
    (r"(gtest|gmock)/", TEST_CODE, True),
    (r"benchmark/", {"benchmarks"}, True),
]
LONGEST_VERB = 120

# What a source defines for others: functions, and members by their names, that begin in the first column.
DEFINITION = re.compile(r"^(?:[\w:<>,&*\[\]]+ )*[*&]*(?:\w+::)*(\w+)\(", re.MULTILINE)
UNNAMED_NAMESPACE = re.compile(r"^namespace \{\n.*?^\}  // namespace\n", re.MULTILINE | re.DOTALL)

INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]')
TORCH = re.compile(r"#\s*include\s*<(torch|ATen|c10|caffe2)/")
NAMED_PATH = re.compile(r"(?<![\w/.<-])((?:" + "|".join(FOLDERS + ["docs", "assets", "cmake"]) + r")/[\w./{},*-]*\w[/*]?)")


def room_of(path):
    """The room that a path relative to the root lies in; None outside all of them."""
    parts = path.split("/")
    for length in (2, 1):
        if len(parts) > length and "/".join(parts[:length]) in ROOMS:
            return "/".join(parts[:length])
    return None


def circles_of(graph):
    """Lists of nodes, one a back edge of a depth-first walk."""
    circles, state, stack = [], {}, []

    def visit(node):
        state[node] = "open"
        stack.append(node)
        for following in sorted(graph.get(node, ())):
            if state.get(following) == "open":
                circles.append(stack[stack.index(following):])
            elif following not in state:
                visit(following)
        stack.pop()
        state[node] = "closed"

    for node in sorted(graph):
        if node not in state:
            visit(node)
    return circles


class Tree:
    """The sources below a root, and what is wrong with them."""

    def __init__(self, root):
        self.root = root
        self.files = sorted(p for f in FOLDERS for e in ("*.h", "*.cc") for p in (root / f).rglob(e))
        self.text = {str(p.relative_to(root)): p.read_text(encoding="utf-8") for p in self.files}
        self.faults = []
        self.upward = 0
        self.includes = {}  # file -> project files that it includes

    def fault(self, text):
        self.faults.append(text)

    def check(self):
        for name, text in self.text.items():
            self.includes[name] = []
            for number, line in enumerate(text.splitlines(), 1):
                match = INCLUDE.match(line)
                if match:
                    self.check_include(name, f"{name}:{number}", match.group(1), match.group(2))
                elif "//" in line:
                    self.check_comment(f"{name}:{number}", line[line.index("//"):])
                    if len(line) > WIDTH and re.match(r"\s*//|[^\"]*[;,{}]\s+//", line) and "://" not in line:
                        self.fault(f"{name}:{number}: a comment {len(line)} columns wide, expected at most {WIDTH}")
        circles = self.find_circles() + self.find_folder_circles()
        for circle in circles:
            self.fault("circle: " + " -> ".join(circle + circle[:1]))
        return {"circles": len(circles), "upward includes": self.upward, "longest verb": self.check_verbs(),
                "sources of apps compiled by tests": self.check_test_sources()}

    def check_include(self, name, place, bracket, header):
        room = room_of(name)
        for pattern, homes, in_headers in THIRD_PARTY:
            if re.match(pattern, header):
                inner = tuple(home + "/" for home in homes if home not in ROOMS)
                if room not in homes and not name.startswith(inner):
                    self.fault(f"{place}: {room}/ includes <{header}>, expected only in {', '.join(sorted(homes))}")
                elif name.endswith(".h") and not in_headers and room not in TEST_CODE:
                    self.fault(f"{place}: a header includes <{header}>, expected only in .cc files")
                elif header.startswith("hwy/") and room not in TEST_CODE and not re.search(r"(_simd\.cc|-inl\.h)$", name):
                    self.fault(f"{place}: includes <{header}>, expected only in *_simd.cc and -inl.h files")
        if bracket != '"':
            return
        if header.startswith("."):
            self.fault(f"{place}: includes \"{header}\", expected a path from the project root")
            return
        prefixed = header.startswith("bodyloom/")
        target = header[len("bodyloom/"):] if prefixed else header
        for_users = name.startswith(("examples/", "tests/consumer/"))
        if target == "bodyloom.h":
            if not for_users:
                self.fault(f"{place}: includes \"{header}\", which is for users' programs")
            return
        other = room_of(target)
        if other is None:
            if "/" not in header and (self.root / pathlib.Path(name).parent / header).exists():
                self.fault(f"{place}: includes \"{header}\", expected a path from the project root")
            return
        if prefixed != (for_users and not target.startswith(PROGRAMS)):
            expected = target if prefixed else "bodyloom/" + target
            self.fault(f"{place}: includes \"{header}\", expected \"{expected}\"")
        if target not in self.text:
            self.fault(f"{place}: includes \"{header}\", which is not there")
            return
        self.includes[name].append(target)
        allowed = ROOMS[room] | (ROOTS.get(room, set()) if name.rsplit("/", 1)[0] == room else set())
        if other != room and other not in allowed and not re.match(EXCEPTIONS.get(room, "$"), target):
            self.upward += 1
            others = ", ".join(sorted(allowed)) or "none"
            self.fault(f"{place}: {room}/ includes \"{target}\", expected only its own headers and those of: {others}")
        if other == "neural" and room not in TEST_CODE | {"neural", "pipelines/neural"} and TORCH.search(self.text[target]):
            self.fault(f"{place}: includes \"{target}\", which includes LibTorch and is for neural/ alone")

    def check_comment(self, place, comment):
        if "://" in comment:
            return
        for path in NAMED_PATH.findall(comment):
            if not self.exists(path):
                self.fault(f"{place}: names {path}, which is not there")

    def exists(self, path):
        """A file or folder, a header without its ending, or a pattern that something fits."""
        pattern = re.sub(r"\{[^}]*\}|\{.*", "*", path).rstrip("/")
        name = pattern.split("/")[-1]
        candidates = [pattern, pattern + ".h", pattern + ".cc"]
        if any((self.root / c).exists() for c in candidates if "*" not in c):
            return True
        if "*" in pattern:
            return any(self.root.glob(c) for c in candidates if list(self.root.glob(c)))
        # "render/texture/uv_sample's", "geometry/scene/camera.Project", a test's name "tracking/Chain.Converges"
        return "." in name and self.exists(path[:path.rindex(".")]) or "." in name and name[0].isupper()

    def find_circles(self):
        """Circles of units (a header and its source are one) that cannot be linked or tested without each other: each
        includes the next one's header and uses something that the next one's source defines. A facade whose header
        declares the options that its helpers take makes no circle."""
        defined = {}
        for file, text in self.text.items():
            if file.endswith(".cc") and not file.startswith(PROGRAMS):
                defined[file[:-3]] = set(re.findall(DEFINITION, re.sub(UNNAMED_NAMESPACE, "", text)))
        graph = {}
        for file, targets in self.includes.items():
            if file.startswith(PROGRAMS):
                continue
            words = set(re.findall(r"\w+", self.text[file]))
            unit = file.rsplit(".", 1)[0]
            uses = {t[:-2] for t in targets if words & defined.get(t[:-2], set())}
            graph.setdefault(unit, set()).update(uses - {unit})
        return circles_of(graph)

    def find_folder_circles(self):
        """Circles among folders, the root of each room among them."""
        graph = {}
        for file, targets in self.includes.items():
            folder = file.rsplit("/", 1)[0]
            if not file.startswith(PROGRAMS):
                graph.setdefault(folder, set()).update({t.rsplit("/", 1)[0] for t in targets} - {folder})
        return circles_of(graph)

    def check_verbs(self):
        """Lines of the longest verb: a verb parses, calls a pipeline and prints."""
        longest = 0
        for name, text in self.text.items():
            if name.startswith("apps/") and name.endswith(".cc") and "add_subcommand" in text and "main.cc" not in name:
                lines = len(text.splitlines())
                longest = max(longest, lines)
                if lines > LONGEST_VERB:
                    self.fault(f"{name}: a verb of {lines} lines, expected at most {LONGEST_VERB}")
        return longest

    def check_test_sources(self):
        """How many sources of apps/ are compiled into tests instead of linked."""
        count = 0
        for path in sorted((self.root / "tests").rglob("CMakeLists.txt")):
            for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
                for source in re.findall(r"(?<![\w/])(?:\$\{PROJECT_SOURCE_DIR\}/)?(apps/[\w/]+)(?=[\s).])", line):
                    if (self.root / (source.removesuffix(".cc") + ".cc")).exists() and not line.lstrip().startswith("#"):
                        count += 1
                        self.fault(f"{path.relative_to(self.root)}:{number}: compiles {source}, expected a library")
        return count


def main():
    root = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ".").resolve()
    tree = Tree(root)
    if not tree.files:
        print(f"{root}: no source files found, expected the project's root folder", file=sys.stderr)
        return 2
    counts = tree.check()
    for fault in tree.faults:
        print(fault)
    print(f"{len(tree.files)} files checked, {len(tree.faults)} faults; " +
          ", ".join(f"{what} {count}" for what, count in counts.items()))
    return 1 if tree.faults else 0


if __name__ == "__main__":
    sys.exit(main())
