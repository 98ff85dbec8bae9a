#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Checks what the words of the project point at and how they begin: links of pages resolve, their #headings included; headers
and sources that comments and pages name exist; a comment states its subject instead of asking for it ("True if the frame
has a pose", not "Whether …").

usage: check_words.py [ROOT]      exit 0 when all is well, 1 with one line a fault, 2 when there is nothing to check

A file may be named by the end of its path (`problem/frame_term.h`). The changelog names what was; it has its links alone
checked.
"""
import pathlib
import re
import sys

from check_includes import FOLDERS

OPENING = re.compile(r"(What|How|Whether|Which|Whose|Who|Where|When|Why)\b")
COMMENT = re.compile(r"\s*//[/!]*<?[ \t]*(.*)")
FILE_NAME = re.compile(r"(?<![\w<./@-])((?:[A-Za-z][\w.-]*/)*[A-Za-z][\w-]*\.(?:h|cc))(?!\w)")
LINK = re.compile(r"\[[^\]]*\]\(([^)\s]+)\)")
SCHEME = re.compile(r"[a-z]+:")
# Highway's own, Eigen's, and headers of other projects that a comment cites with their project's name beside them.
OTHERS = {"foreach_target.h", "PlainObjectBase.h", "scene/reconstruction_io_text.cc", "sensor/models.h", "NAME.cc", "x_test.cc"}


def anchors(text):
    """The anchors of a page's headings, as GitHub makes them."""
    found = set()
    fenced = False
    for line in text.splitlines():
        fenced ^= line.startswith("```")
        heading = None if fenced else re.match(r"#+\s+(.*)", line)
        if heading is None:
            continue
        words = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading.group(1)).strip().lower()
        name = re.sub(r"[^\w\- ]", "", words).replace(" ", "-")
        again = 0
        while name + (f"-{again}" if again else "") in found:
            again += 1
        found.add(name + (f"-{again}" if again else ""))
    return found


def broken_links(page, text, root):
    """(line, message) of each relative link of a page that leads nowhere."""
    fenced = False
    for number, line in enumerate(text.splitlines(), 1):
        fenced ^= line.startswith("```")
        if fenced:
            continue
        for target in LINK.findall(re.sub(r"`[^`]*`", "", line)):
            path, _, anchor = target.partition("#")
            if SCHEME.match(target):
                continue
            to = (page.parent / path).resolve() if path else page.resolve()
            if not to.exists() or root.resolve() not in [to, *to.parents]:
                yield number, f"a link to {target}, which is not there"
            elif anchor and to.suffix == ".md" and anchor not in anchors(to.read_text(encoding="utf-8")):
                yield number, f"a link to {target}: no such heading"


def missing_files(text, is_source, names):
    """(line, message) of each source that a comment or a page names and nobody has."""
    for number, line in enumerate(text.splitlines(), 1):
        if is_source:
            comment = COMMENT.search(line, line.find("//")) if "//" in line else None
            if comment is None or line.lstrip().startswith("#include"):
                continue
            line = line[line.find("//"):]
        for name in FILE_NAME.findall(line):
            if name.startswith(("bodyloom/", "ceres/", "torch/", "tests/CMakeFiles/")) or any(name.endswith(other) for other in OTHERS):
                continue
            if not any(path == name or path.endswith("/" + name) for path in names.get(name.rsplit("/", 1)[-1], ())):
                yield number, f"names {name}, which is not there"


def asking_comments(text):
    """(line, message) of each comment that opens with a question word."""
    inside = False
    for number, line in enumerate(text.splitlines(), 1):
        comment = COMMENT.match(line)
        words = comment.group(1) if comment else ""
        if words and not inside and OPENING.match(words):
            yield number, f'a comment opens with "{words.split()[0]}", expected a statement'
        inside = bool(words) and "SPDX" not in words


def main():
    root = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ".")
    sources = [path for folder in FOLDERS for path in sorted(root.glob(f"{folder}/**/*")) if path.suffix in (".h", ".cc")]
    pages = [*sorted(root.glob("*.md")), *sorted(root.glob("docs/**/*.md"))]
    names = {}
    for path in sources:
        names.setdefault(path.name, []).append(path.relative_to(root).as_posix())
    faults = 0
    for path in [*sources, *pages]:
        text = path.read_text(encoding="utf-8")
        found = []
        if path.suffix == ".md":
            found += broken_links(path, text, root)
        else:
            found += asking_comments(text)
        if path.name != "CHANGELOG.md":
            found += missing_files(text, path.suffix != ".md", names)
        for number, message in found:
            print(f"{path.relative_to(root)}:{number}: {message}")
        faults += len(found)
    print(f"{len(sources)} sources and {len(pages)} pages, {faults} faults")
    return 2 if not sources and not pages else min(faults, 1)


if __name__ == "__main__":
    sys.exit(main())
