# SPDX-License-Identifier: Apache-2.0
"""Images and videos as NumPy arrays, by ffmpeg; masks."""
import subprocess

import numpy as np


def decoded(source, width, height, channels=3):
    """(T, height, width, channels) bytes, RGB or RGBA, of a video, an image, or numbered images (%06d.png)."""
    raw = subprocess.run(["ffmpeg", "-v", "error", "-i", str(source), "-f", "rawvideo", "-pix_fmt",
                          "rgba" if channels == 4 else "rgb24", "-"], check=True, capture_output=True).stdout
    return np.frombuffer(raw, np.uint8).reshape(-1, height, width, channels)


def write(path, pixels, options=()):
    """Writes an image of (height, width, 3) bytes, in the format of its name; `options` are ffmpeg's."""
    subprocess.run(["ffmpeg", "-v", "error", "-y", "-f", "rawvideo", "-pix_fmt", "rgb24", "-s",
                    f"{pixels.shape[1]}x{pixels.shape[0]}", "-i", "-", "-frames:v", "1", *options, str(path)],
                   input=pixels.tobytes(), check=True)


def write_numbered(folder, frames):
    """000000.png, 000001.png …: frames of (height, width, 3) bytes, all of one size."""
    height, width = frames[0].shape[:2]
    subprocess.run(["ffmpeg", "-v", "error", "-y", "-f", "rawvideo", "-pix_fmt", "rgb24", "-s", f"{width}x{height}",
                    "-i", "-", "-start_number", "0", str(folder / "%06d.png")],
                   input=b"".join(f.tobytes() for f in frames), check=True)


def masks(path):
    """(T, H, W), 1 where the person is: data_tools/observations/part_labels.h."""
    with np.load(path) as file:
        width, height = file["image_size"]
        pictures = np.zeros((len(file["mask_box"]), height, width), np.uint8)
        ends, all_runs = np.cumsum(file["mask_count"]), file["mask_runs"]
        for picture, (x, y, w, h), end, count in zip(pictures, file["mask_box"], ends, file["mask_count"]):
            runs = all_runs[end - count:end]
            picture[y:y + h, x:x + w] = np.repeat(np.arange(count) % 2, runs).reshape(h, w)
    return pictures
