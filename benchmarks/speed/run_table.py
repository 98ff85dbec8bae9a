#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Time and memory of `bodyloom run`: networks, masks, overlay and length; and how the cost grows with frames, people and
pixels.

usage: run_table.py COMMAND DATA [--rounds N] [--only WORD ...] [--json F] [--markdown F] [--plot F] [--scratch FOLDER]
  COMMAND   the program `bodyloom` of a build; run it with `nice -n -20` where others use the machine
  DATA      the folder of real recordings (shared/data)
  --only    rows whose section (table, frames, people, pixels, length) or clip contains one of the words
  --scratch where videos are made and kept (default: a folder that is removed)

Every row is a `run` with the arguments beside it, all rows in turn in each round; medians, and half the range as spread.
Needs ffmpeg; --plot needs matplotlib. People side by side are pictures of one video beside each other. Prints markdown.
"""
import argparse
import json
import os
import pathlib
import platform
import statistics
import subprocess
import sys
import tempfile

DANCE = "vid2densepose/input_video.mp4"
TWO = "pose2sim/two_people/cam01.mp4"


def ffmpeg(*arguments):
    subprocess.run(["ffmpeg", "-v", "error", "-y", *map(str, arguments)], check=True)


class Videos:
    """Makes the videos of the rows, each once."""

    def __init__(self, data, scratch):
        self.data, self.scratch = data, scratch

    def _made(self, name, *arguments):
        path = self.scratch / name
        if not path.exists():
            ffmpeg(*arguments, "-an", "-c:v", "libx264", "-preset", "veryfast", "-crf", 20, path)
        return path

    def dance(self):
        return self.data / DANCE

    def two(self):
        return self.data / TWO

    def long(self, source, seconds):
        """Forwards and backwards, 30 frames a second, so many seconds."""
        loop = self._made(f"{source.stem}_loop.mp4", "-i", source, "-filter_complex",
                          "[0]split[a][b];[b]reverse[r];[a][r]concat,setpts=N/30/TB", "-r", 30)
        path = self.scratch / f"{source.stem}_{seconds}s.mp4"
        if not path.exists():
            ffmpeg("-stream_loop", -1, "-i", loop, "-t", seconds, "-c", "copy", path)
        return path

    def beside(self, people):
        """So many dancing men in a picture of 8 × 288 pixels, so that only their number differs."""
        parts = ["[0]scale=288:512,split=%d" % people + "".join(f"[p{i}]" for i in range(people))]
        names = [f"[p{i}]" for i in range(people)]
        for i in range(people, 8):
            parts.append(f"color=gray:size=288x512:rate=30[e{i}]")
            names.append(f"[e{i}]")
        parts.append("".join(names) + "hstack=inputs=8:shortest=1")
        return self._made(f"people_{people}.mp4", "-i", self.dance(), "-filter_complex", ";".join(parts), "-t", 3)

    def scaled(self, width):
        return self._made(f"width_{width}.mp4", "-i", self.dance(), "-vf", f"scale={width}:-2", "-t", 6)


def rows_of(videos):
    """(section, label, x, function that makes the video, arguments)"""
    rows = []
    for name, video in (("dancing man", videos.dance), ("two people, 1088x1920", videos.two)):
        for arguments in ([], ["--detector", "full"], ["--detector", "lite"], ["--no-mask"], ["--no-overlay"],
                          ["--no-mask", "--no-overlay"]):
            rows.append(("table", name, None, video, arguments))
    rows.append(("table", "60 s of the dancing man", None, lambda: videos.long(videos.dance(), 60), []))
    for frames in (90, 180, 360, 720):
        rows.append(("frames", f"{frames} frames", frames, lambda f=frames: videos.long(videos.dance(), f // 30), []))
    for people in (1, 2, 4, 8):
        rows.append(("people", f"{people}", people, lambda p=people: videos.beside(p), []))
    for width in (288, 576, 1152, 2304):
        rows.append(("pixels", f"{width} wide", 1e-6 * width * (width * 16 / 9), lambda w=width: videos.scaled(w), []))
    for minutes in (1, 2, 4, 10):
        rows.append(("length", f"{minutes} min, 1088x1920", minutes, lambda m=minutes: videos.long(videos.two(), 60 * m),
                     ["--people", "1", "--detector", "lite", "--no-overlay"]))
    return rows


def measure(command, video, arguments, out):
    subprocess.run([command, "run", video, "--out", out, "--quiet", *arguments], check=True)
    summary = json.loads((out / "summary.json").read_text(encoding="utf-8"))
    return {"seconds": summary["total_seconds"], "frames": summary["frames"], "people": len(summary["people"]),
            "processor_seconds": sum(summary["processor_seconds"].values()),
            "stages": summary["processor_seconds"], "memory_mb": summary["peak_memory_bytes"] / 1e6}


def middle(values):
    return statistics.median(values), (max(values) - min(values)) / 2


def text_of(values, digits):
    median, spread = middle(values)
    return f"{median:.{digits}f} ± {spread:.{digits}f}" if len(values) > 1 else f"{median:.{digits}f}"


def markdown(results):
    lines = []
    for section in dict.fromkeys(r["section"] for r in results):
        lines += [f"### {section}", "",
                  "| clip | arguments | frames, people | wall s | processor s | detect / track / overlay | ms a frame | MB |",
                  "|---|---|---|---|---|---|---|---|"]
        for r in results:
            if r["section"] != section:
                continue
            runs = r["runs"]
            stages = " / ".join(f"{statistics.median(run['stages'].get(stage, 0) for run in runs):.1f}"
                                for stage in ("detect", "track", "overlay"))
            a_frame = [1e3 * run["processor_seconds"] / run["frames"] for run in runs]
            lines.append(f"| {r['label']} | {' '.join(r['arguments'])} | {runs[0]['frames']}, {runs[0]['people']} | "
                         f"{text_of([run['seconds'] for run in runs], 1)} | "
                         f"{text_of([run['processor_seconds'] for run in runs], 1)} | {stages} | "
                         f"{text_of(a_frame, 1)} | {text_of([run['memory_mb'] for run in runs], 0)} |")
        lines.append("")
    return "\n".join(lines)


def draw(results, path):
    import matplotlib

    matplotlib.use("svg")
    matplotlib.rcParams.update({"svg.hashsalt": "bodyloom", "svg.fonttype": "none"})
    import matplotlib.pyplot as plt

    sections = [("frames", "frames"), ("people", "people"), ("pixels", "megapixels")]
    figure, axes = plt.subplots(1, 3, figsize=(10, 3.2), layout="constrained")
    for plot, (section, label) in zip(axes, sections):
        rows = [r for r in results if r["section"] == section]
        x = [r["x"] for r in rows]
        for stage in ("detect", "track", "overlay"):
            plot.plot(x, [statistics.median(run["stages"].get(stage, 0) for run in r["runs"]) for r in rows], marker="o",
                      markersize=4, label=stage)
        plot.set(xlabel=label, ylim=(0, None), xlim=(0, None))
        plot.grid(color="0.9")
    axes[0].set_ylabel("processor seconds")
    axes[0].legend(frameon=False)
    figure.savefig(path, metadata={"Date": None})


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("command", type=pathlib.Path)
    parser.add_argument("data", type=pathlib.Path)
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--only", nargs="+", default=[""])
    parser.add_argument("--json", type=pathlib.Path)
    parser.add_argument("--markdown", type=pathlib.Path)
    parser.add_argument("--plot", type=pathlib.Path)
    parser.add_argument("--scratch", type=pathlib.Path)
    o = parser.parse_args()
    with tempfile.TemporaryDirectory() as removed:
        scratch = o.scratch or pathlib.Path(removed)
        scratch.mkdir(parents=True, exist_ok=True)
        rows = [row for row in rows_of(Videos(o.data, scratch))
                if any(word in row[0] or word in row[1] for word in o.only)]
        results = [{"section": s, "label": label, "x": x, "arguments": a, "runs": []} for s, label, x, _, a in rows]
        for number in range(o.rounds):
            for (_, label, _, video, arguments), result in zip(rows, results):
                result["runs"].append(measure(o.command, video(), arguments, pathlib.Path(removed) / "out"))
                print(f"round {number + 1}: {label} {' '.join(arguments)}: {result['runs'][-1]['seconds']:.1f} s",
                      file=sys.stderr)
    text = markdown(results)
    print(text)
    report = {"machine": platform.processor() or platform.machine(), "cores": os.cpu_count(), "rounds": o.rounds,
              "rows": results}
    if o.json:
        o.json.write_text(json.dumps(report, indent=1) + "\n", encoding="utf-8")
    if o.markdown:
        o.markdown.write_text(text, encoding="utf-8")
    if o.plot:
        draw(results, o.plot)


if __name__ == "__main__":
    main()
