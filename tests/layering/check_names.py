#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Checks that the source files of a library can be compiled together (CMAKE_UNITY_BUILD): a name in an unnamed namespace
is that file's alone among the files of its library, and no header of the library declares it. Tests: each x_test.cc has
a namespace of its own.

usage: check_names.py [ROOT]      exit 0 when all is well, 1 with one line a fault, 2 when there is nothing to check

Functions may share a name when their parameters' types differ, and namespace aliases when they mean the same. Faults read "file:line: name, also in file:line".
"""
import pathlib
import re
import sys

LIBRARIES = ["geometry", "render", "tracking", "data_tools", "neural", "pipelines", "apps", "python"]
# Folders with libraries or programs of their own, besides those of LIBRARIES.
OWN = ["render/lighting", "render/photo_avatar", "tracking/detection", "data_tools/synthesis", "data_tools/evaluation",
       "pipelines/neural", "apps/neural", "apps/cgal"]

LITERAL = re.compile(r'R"(\w*)\(.*?\)\1"|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])+\'|//[^\n]*|/\*.*?\*/|^[ \t]*#(?:\\\n|[^\n])*', re.S | re.M)
WORD = r"[A-Za-z_]\w*"


def blanked(text):
    """The text without comments, literals and preprocessor lines; lines keep their numbers."""
    def blank(match):
        return re.sub(r"[^\n]", " ", match.group()) if not match.group().startswith(('"', "'", "R")) else '""' + "\n" * match.group().count("\n")
    return LITERAL.sub(blank, text)


def closing(text, start):
    """Index of the brace that closes the one at `start`."""
    depth = 0
    for i in range(start, len(text)):
        depth += {"{": 1, "}": -1}.get(text[i], 0)
        if depth == 0:
            return i
    return len(text)


def split_at_commas(text):
    """The parts between commas that are in no brackets."""
    parts, depth, part = [], 0, ""
    for c in text + ",":
        depth += {"<": 1, "(": 1, "{": 1, "[": 1, ">": -1, ")": -1, "}": -1, "]": -1}.get(c, 0)
        if c == "," and depth == 0:
            parts.append(part)
            part = ""
        else:
            part += c
    return parts if depth == 0 else [text]  # a comparison, not a bracket


def types_of(parameters):
    """The types of a parameter list, without names and defaults."""
    types = []
    for part in split_at_commas(parameters):
        part = part.split("=")[0].strip()
        named = re.match(rf"(.*[\w>&*\]:)]\s*[\s&*])({WORD})(\[\w*\])?$", part, re.S)
        types.append(re.sub(r"\s+", "", named.group(1) + (named.group(3) or "") if named else part))
    return ",".join(t for t in types if t != "void")


def declared(text, start, end):
    """(name, kind, position) of what is declared directly between the two positions. Kind: "(types)" of a function,
    "=type" of an alias, "type" of a class, "" of a value."""
    i = statement = start
    while i < end:
        c = text[i]
        if c == ";":
            yield from names_of(text[statement:i], statement)
            statement = i + 1
        elif c == "{":
            close = closing(text, i)
            head = text[statement:i]
            if re.match(r"\s*(inline\s+)?namespace\b", head):
                statement = close + 1
            elif re.search(r"\benum\b", head) or re.match(r"\s*(template\s*<[^{}]*>\s*)?(struct|class|union)\b", head):
                yield from names_of(head, statement)
                if re.match(rf"\s*enum\s+(?!class|struct)", head):
                    for match in re.finditer(rf"(?:^|,)\s*({WORD})", text[i + 1:close]):
                        yield match.group(1), "", i + 1 + match.start(1)
                statement = close + 1
            elif re.search(r"\)\s*(const|noexcept|override|->[^;{]*)?\s*$", head) or re.search(r"\)\s*:\s", head):
                yield from names_of(head, statement)
                statement = close + 1
            else:  # an initialiser: the statement ends at its semicolon
                pass
            i = close
        i += 1


def names_of(head, offset):
    if re.match(r"\s*(template\s*<.*>\s*)?(friend|static_assert|using\s+namespace|namespace\s|using\s+[\w:]+$|TEST|HWY_|TORCH_|extern)", head, re.S):
        return
    head_without_attributes = re.sub(r"\[\[.*?\]\]|alignas\s*\([^)]*\)", lambda m: " " * len(m.group()), head)
    kind = re.match(rf"\s*(?:template\s*<.*?>\s*)?(?:struct|class|union|enum(?:\s+class|\s+struct)?)\s+({WORD})\s*(?::[^:].*|final.*)?$",
                    head_without_attributes, re.S)
    if kind:
        yield kind.group(1), "type", offset + kind.start(1)
        return
    alias = re.match(rf"\s*(?:template\s*<.*?>\s*)?using\s+({WORD})\s*=(.*)", head_without_attributes, re.S)
    if alias:
        yield alias.group(1), "=" + re.sub(r"\s+", "", alias.group(2)), offset + alias.start(1)
        return
    first, *others = split_at_commas(head_without_attributes)
    before_value = re.split(r"(?<![<>=!])=(?!=)", head_without_attributes)[0]
    function = re.match(rf"\s*(?:template\s*<.*?>\s*)?[^()]*?[\w>&*\]]\s*[\s&*]({WORD})\s*\((.*)\)[^()]*$", before_value, re.S)
    if function and "{" not in before_value and function.group(1) not in ("decltype", "alignas"):
        if "::" + function.group(1) not in before_value:
            yield function.group(1), "(" + types_of(function.group(2)) + ")", offset + function.start(1)
        return
    variable = re.match(rf"\s*(?:[\w:<>,*&\s()]|\[\w*\])*?[\w>&*]\s*[\s&*]({WORD})\s*(\[[^\]]*\]\s*)*(\{{.*)?$", before_value, re.S)
    if variable:
        yield variable.group(1), "", offset + variable.start(1)
        at = offset + len(first)
        for other in others:
            name = re.match(rf"\s*[*&]?\s*({WORD})\s*(\[[^\]]*\])?\s*(=|\{{|$)", other)
            if name:
                yield name.group(1), "", at + 1 + name.start(1)
            at += 1 + len(other)


def namespaces(text, start, end, unnamed):
    """(start, end) of bodies of namespace bodyloom (unnamed: of unnamed namespaces in it), not of named ones below."""
    for match in re.finditer(r"\b(?:inline\s+)?namespace\s*([\w:]*)\s*\{", text[start:end]):
        name, brace = match.group(1), start + match.end() - 1
        if (name == "" and unnamed) or (name == "bodyloom" and not unnamed):
            yield brace + 1, closing(text, brace)


def collide(first, second):
    """Whether one namespace cannot have both: overloads and equal aliases it can."""
    if first.startswith("(") and second.startswith("("):
        return first == second
    return not (first.startswith("=") and first == second)


def library_of(path):
    best = ""
    for room in LIBRARIES + OWN:
        if str(path).startswith(room + "/") and len(room) > len(best):
            best = room
    return best


def check_tests(root):
    """Faults of tests/FOLDER/…/x_test.cc, which are compiled together: each has a namespace of its own, ending in
    ::x_test, and the only file of its name in FOLDER."""
    faults, seen = [], {}
    for path in sorted(p.relative_to(root) for p in (root / "tests").rglob("*_test.cc")) if (root / "tests").is_dir() else []:
        text = blanked((root / path).read_text(encoding="utf-8"))
        if "TEST" in text and not re.search(rf"^namespace bodyloom(::\w+)*::{path.stem} \{{$", text, re.M):
            faults.append(f"{path}: no namespace bodyloom::{path.stem}")
        other = seen.setdefault((path.parts[1], path.stem), path)
        if other != path:
            faults.append(f"{path}: {path.stem}, also {other}; give it a name of its own")
    return faults


def main():
    root = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ".")
    public, private, faults = {}, {}, []
    files = sorted(p.relative_to(root) for f in LIBRARIES if (root / f).is_dir() for p in (root / f).rglob("*") if p.suffix in (".h", ".cc"))
    if not files:
        print(f"{root}: no source files")
        return 2
    count = 0
    for path in files:
        text = blanked((root / path).read_text(encoding="utf-8"))
        if path.suffix == ".h":
            for start, end in namespaces(text, 0, len(text), False):
                for name, kind, position in declared(text, start, end):
                    public.setdefault((library_of(path), name), (kind, f"{path}:{text.count(chr(10), 0, position) + 1}"))
        elif not path.name.endswith("_simd.cc"):
            for start, end in namespaces(text, 0, len(text), True):
                for name, kind, position in declared(text, start, end):
                    count += 1
                    place = f"{path}:{text.count(chr(10), 0, position) + 1}"
                    private.setdefault((library_of(path), name), []).append((kind, place))
    for (library, name), places in sorted(private.items()):
        for n, (kind, place) in enumerate(places):
            other = next((p for k, p in places[:n] if collide(k, kind) and p.split(":")[0] != place.split(":")[0]), None)
            declared_kind, declared_at = public.get((library, name), (None, None))
            if other is None and declared_at and collide(declared_kind, kind):
                other = declared_at
            if other:
                faults.append(f"{place}: {name}{kind if kind.startswith('(') else ''}, also in {other}; give it a name of its own")
    faults += check_tests(root)
    print("\n".join(faults + [f"{len(files)} files, {count} names in unnamed namespaces, {len(faults)} faults"]))
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
