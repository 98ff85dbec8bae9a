#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes ONNX networks with random weights and the layers of well-known ones, to time runtimes on
(docs/lab/run_speed.md): yolo.onnx as YOLOv8n-pose, depthwise.onnx as MobileNetV2 without its head, both for 640x640
pixels.

usage: network_files.py FOLDER
Needs numpy and Debian's python3-onnx.
"""
import pathlib
import sys

import numpy as np
import onnx
from onnx import helper, numpy_helper

SIZE = 640


class Network:
    def __init__(self):
        self.random = np.random.default_rng(1)
        self.nodes, self.constants, self.channels = [], [], {"images": 3}

    def constant(self, values):
        name = f"c{len(self.constants)}"
        self.constants.append(numpy_helper.from_array(np.asarray(values), name))
        return name

    def add(self, op, inputs, channels, outputs=1, **attributes):
        """The names of an operator's results, each of so many channels."""
        names = [f"t{len(self.channels)}_{i}" for i in range(outputs)]
        self.nodes.append(helper.make_node(op, inputs, names, **attributes))
        self.channels.update((name, channels) for name in names)
        return names if outputs > 1 else names[0]

    def conv(self, x, out, size=3, stride=1, groups=1, activation="swish"):
        fan_in = self.channels[x] // groups * size * size
        weights = self.random.standard_normal((out, self.channels[x] // groups, size, size)) * np.sqrt(2 / fan_in)
        y = self.add("Conv", [x, self.constant(weights.astype(np.float32)), self.constant(np.zeros(out, np.float32))],
                     out, kernel_shape=[size, size], strides=[stride, stride], pads=[size // 2] * 4, group=groups)
        if activation == "swish":
            return self.add("Mul", [y, self.add("Sigmoid", [y], out)], out)
        if activation == "relu6":
            return self.add("Clip", [y, self.constant(np.float32(0)), self.constant(np.float32(6))], out)
        return y

    def concat(self, images):
        return self.add("Concat", images, sum(self.channels[x] for x in images), axis=1)

    def c2f(self, x, out, blocks, shortcut=True):
        """YOLOv8's block: half of the channels pass through convolutions, all stages are joined."""
        halves = self.constant(np.array([out // 2, out // 2], np.int64))
        parts = self.add("Split", [self.conv(x, out, 1), halves], out // 2, outputs=2, axis=1)
        for _ in range(blocks):
            y = self.conv(self.conv(parts[-1], out // 2), out // 2)
            parts.append(self.add("Add", [parts[-1], y], out // 2) if shortcut else y)
        return self.conv(self.concat(parts), out, 1)

    def twice(self, x):
        scales = self.constant(np.array([1, 1, 2, 2], np.float32))
        return self.add("Resize", [x, "", scales], self.channels[x], mode="nearest", nearest_mode="floor",
                        coordinate_transformation_mode="asymmetric")

    def inverted(self, x, out, stride, expansion):
        """MobileNetV2's block: wide, by channel, narrow."""
        y = self.conv(x, self.channels[x] * expansion, 1, activation="relu6") if expansion > 1 else x
        y = self.conv(y, self.channels[y], 3, stride, self.channels[y], "relu6")
        y = self.conv(y, out, 1, activation=None)
        return self.add("Add", [x, y], out) if stride == 1 and self.channels[x] == out else y

    def write(self, path, output):
        image = helper.make_tensor_value_info("images", onnx.TensorProto.FLOAT, [1, 3, SIZE, SIZE])
        result = helper.make_tensor_value_info(output, onnx.TensorProto.FLOAT, None)
        model = helper.make_model(helper.make_graph(self.nodes, path.stem, [image], [result], self.constants),
                                  opset_imports=[helper.make_opsetid("", 13)])
        model.ir_version = 8
        onnx.save(model, str(path))


def yolo(path):
    n = Network()
    p2 = n.c2f(n.conv(n.conv("images", 16, stride=2), 32, stride=2), 32, 1)
    p3 = n.c2f(n.conv(p2, 64, stride=2), 64, 2)
    p4 = n.c2f(n.conv(p3, 128, stride=2), 128, 2)
    pooled = [n.conv(n.c2f(n.conv(p4, 256, stride=2), 256, 1), 128, 1)]
    for _ in range(3):
        pooled.append(n.add("MaxPool", [pooled[-1]], 128, kernel_shape=[5, 5], strides=[1, 1], pads=[2] * 4))
    p5 = n.conv(n.concat(pooled), 256, 1)
    q4 = n.c2f(n.concat([n.twice(p5), p4]), 128, 1, False)
    q3 = n.c2f(n.concat([n.twice(q4), p3]), 64, 1, False)
    r4 = n.c2f(n.concat([n.conv(q3, 64, stride=2), q4]), 128, 1, False)
    r5 = n.c2f(n.concat([n.conv(r4, 128, stride=2), p5]), 256, 1, False)
    rows = []
    for x, side in ((q3, SIZE // 8), (r4, SIZE // 16), (r5, SIZE // 32)):
        heads = [n.conv(n.conv(n.conv(x, width), width), width, 1, activation=None) for width in (64, 51)]
        shape = n.constant(np.array([1, 115, side * side], np.int64))
        rows.append(n.add("Reshape", [n.concat(heads), shape], 115))
    n.write(path, n.add("Concat", rows, 115, axis=2))


def depthwise(path):
    n = Network()
    x = n.conv("images", 32, stride=2, activation="relu6")
    for out, stride, expansion, times in ((16, 1, 1, 1), (24, 2, 6, 2), (32, 2, 6, 3), (64, 2, 6, 4), (96, 1, 6, 3),
                                          (160, 2, 6, 3), (320, 1, 6, 1)):
        for i in range(times):
            x = n.inverted(x, out, stride if i == 0 else 1, expansion)
    n.write(path, x)


if __name__ == "__main__":
    if len(sys.argv) != 2 or sys.argv[1].startswith("-"):
        sys.exit(__doc__)
    folder = pathlib.Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    yolo(folder / "yolo.onnx")
    depthwise(folder / "depthwise.onnx")
