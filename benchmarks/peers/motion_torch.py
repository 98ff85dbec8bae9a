#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The networks of the motion-dependent renderer in PyTorch, as one would write them there: time of a frame and of a
training step, to be laid beside bodyloom_bench_motion.

usage: motion_torch.py [cpu|tiny] [threads]      needs Debian's python3-torch

Same blocks, widths, sizes, losses, batch and optimizers; the batch lies ready in memory, so no time goes into data.
"""
import sys
import time

import torch
import torch.nn.functional as F
from torch import nn

from torch_blocks import Down, Up

PROFILES = {  # image, uv, features, encoder, decoders, discriminator, divisor of VGG's channels, learned texture
    "cpu": (256, 128, 16, [16, 32, 64], [16, 32, 64, 128], 16, 4, (8, 256)),
    "tiny": (128, 64, 8, [8, 16, 32], [8, 16, 32, 64], 8, 8, (8, 128)),
}


class UNet(nn.Module):
    def __init__(self, i, heads, widths):
        super().__init__()
        sizes = [i] + widths
        self.down = nn.ModuleList(Down(a, b) for a, b in zip(sizes[:-1], sizes[1:]))
        self.up = nn.ModuleList()
        for level, w in enumerate(widths):
            deepest = level == len(widths) - 1
            self.up.append(Up(w if deepest else 2 * w, w, widths[max(0, level - 1)]))
        self.heads = nn.ModuleList(nn.Conv2d(widths[0], o, 3, 1, 1) for o in heads)

    def forward(self, x):
        maps = []
        for block in self.down:
            x = block(x)
            maps.append(x)
        for level in reversed(range(len(self.up))):
            x = self.up[level](x if level == len(self.up) - 1 else torch.cat([x, maps[level]], 1))
        return [head(x) for head in self.heads]


class Model(nn.Module):
    def __init__(self, p):
        super().__init__()
        _, _, d, encoder, decoders, _, _, (c, s) = p
        self.encoder = UNet(33, [d], encoder)
        self.shape = UNet(d + 3 + c + 7, [7], decoders)
        self.appearance = UNet(d + 3 + c + 7 + 3 + 3, [3, 3], decoders)
        self.texture = nn.Parameter(torch.zeros(1, c, s, s))
        self.texel_labels = nn.Conv2d(c, 7, 1, bias=False)
        self.texel_colour = nn.Conv2d(c, 3, 1, bias=False)

    def forward(self, motion, uv, body, past):
        f = self.encoder(motion)[0]
        grid = torch.stack([2 * uv[:, 0] - 1, 1 - 2 * uv[:, 1]], -1)
        f = body * F.grid_sample(f, grid, align_corners=False, padding_mode="border")
        texture = 10 * self.texture.expand(len(uv), -1, -1, -1)
        texel = body * F.grid_sample(texture, grid, align_corners=False, padding_mode="border")
        f = torch.cat([f, body * uv, body, texel], 1)
        logits = self.shape(torch.cat([f, past[0]], 1))[0] + self.texel_labels(texel)
        labels = logits.softmax(1)
        a, n = self.appearance(torch.cat([f, labels, past[1], past[2]], 1))
        foreground = 1 - labels[:, :1]
        a, n = a + self.texel_colour(texel), torch.tanh(n)
        return (logits, labels, foreground * torch.sigmoid(a),
                foreground * n / n.norm(dim=1, keepdim=True).clamp_min(1e-6))


def vgg(divisor):
    layers, last = nn.ModuleList(), 3
    for w in [64, 64, "M", 128, 128, "M", 256, 256, "M", 512, 512]:
        if w == "M":
            layers.append(nn.MaxPool2d(2))
        else:
            layers.append(nn.Conv2d(last, w // divisor, 3, 1, 1))
            last = w // divisor
    for p in layers.parameters():
        p.requires_grad_(False)
    return layers


def features(layers, x):
    taps, convs = [], 0
    for layer in layers:
        x = layer(x)
        if isinstance(layer, nn.Conv2d):
            convs += 1
            if convs % 2 == 0:
                taps.append(x)
            x = F.relu(x)
    return taps


def discriminator(i, n):
    sizes, layers = [i, n, 2 * n, 4 * n], []
    for k in range(3):
        layers += [nn.Conv2d(sizes[k], sizes[k + 1], 4, 2, 1, bias=k == 0)] + ([nn.InstanceNorm2d(1)] if k else [])
        layers += [nn.LeakyReLU(0.2)]
    layers += [nn.Conv2d(4 * n, 8 * n, 4, 1, 1, bias=False), nn.InstanceNorm2d(1), nn.LeakyReLU(0.2)]
    return nn.Sequential(*layers, nn.Conv2d(8 * n, 1, 4, 1, 1))


def milliseconds(work, repetitions):
    work()
    times = []
    for _ in range(repetitions):
        start = time.perf_counter()
        work()
        times.append(1e3 * (time.perf_counter() - start))
    times.sort()
    return times[len(times) // 2], times[0]


def main():
    profile = sys.argv[1] if len(sys.argv) > 1 else "cpu"
    threads = int(sys.argv[2]) if len(sys.argv) > 2 else 1
    torch.set_num_threads(threads)
    torch.manual_seed(1)
    p = PROFILES[profile]
    side, uv_side = p[0], p[1]
    model, eyes, critic = Model(p), vgg(p[6]), discriminator(10, p[5])

    def frame(batch):
        body = torch.zeros(batch, 1, side, side)
        body[:, :, side // 10:side * 9 // 10, side // 4:side * 3 // 4] = 1
        return (torch.randn(batch, 33, uv_side, uv_side), torch.rand(batch, 2, side, side), body,
                [torch.rand(batch, c, side, side) for c in (7, 3, 3)])

    print(f"| what (PyTorch {torch.__version__}, profile {profile}, {threads} threads) | median ms | least ms |")
    print("|---|---|---|")
    one = frame(1)
    with torch.no_grad():
        print("| a frame, %dx%d | %.1f | %.1f |" % (side, side, *milliseconds(lambda: model(*one), 15)), flush=True)

    batch = frame(4)
    image, normals = torch.rand(4, 3, side, side), F.normalize(torch.randn(4, 3, side, side))
    classes = torch.randint(0, 7, (4, side, side))
    onehot = F.one_hot(classes, 7).permute(0, 3, 1, 2).float()
    g = torch.optim.Adam(model.parameters(), 1e-3, (0.5, 0.999))
    d = torch.optim.Adam(critic.parameters(), 2e-4, (0.5, 0.999))

    def step():
        logits, _, a, n = model(*batch)
        d.zero_grad(set_to_none=True)
        real, fake = critic(torch.cat([onehot, image], 1)), critic(torch.cat([onehot, a.detach()], 1))
        (0.5 * (F.softplus(-real).mean() + F.softplus(fake).mean())).backward()
        d.step()
        g.zero_grad(set_to_none=True)
        with torch.no_grad():
            target = features(eyes, image)
        loss = (a - image).abs().mean() + 10 * F.cross_entropy(logits, classes) + (n - normals).abs().mean()
        loss = loss + sum((x - y).abs().mean() for x, y in zip(features(eyes, a), target))
        critic.requires_grad_(False)
        loss = loss + 0.01 * F.softplus(-critic(torch.cat([onehot, a], 1))).mean()
        loss.backward()
        critic.requires_grad_(True)
        g.step()

    print("| a training step, batch 4, data in memory | %.1f | %.1f |" % milliseconds(step, 7), flush=True)


if __name__ == "__main__":
    main()
