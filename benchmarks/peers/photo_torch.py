#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""A frame of the two one-photo renderers in PyTorch, as one would write them there: to be laid beside
bodyloom_bench_photo.

usage: photo_torch.py [cpu|tiny] [threads]      needs Debian's python3-torch

Same layers, widths and sizes, random weights; the photo is encoded already. Processor time beside the clock's.
"""
import sys
import time

import torch
import torch.nn.functional as F
from torch import nn

from torch_blocks import Down, Up, lrelu

PHOTO = {"cpu": (256, 256, 16, 16, 6), "tiny": (128, 128, 16, 16, 6)}  # window, texture, features, width, blocks
# window, widths of SilNet and GarNet, of RenderNet's encoders and decoder, full size, modulation, latent
GUIDED = {
    "cpu": (256, [8, 16, 32, 64, 64], [8, 16, 32, 64, 64], [16, 32, 64, 96, 96], 8, 16, 32),
    "tiny": (128, [8, 16, 32, 32], [8, 16, 32, 32], [8, 16, 32, 32], 8, 8, 16),
}
LABELS = 7


def project(features, uv, body):
    grid = torch.stack([2 * uv[:, 0] - 1, 1 - 2 * uv[:, 1]], -1)
    return body * F.grid_sample(features, grid, align_corners=False, padding_mode="border")


def pull_push(x, mask, levels):
    known = x * mask
    if levels == 0 or x.shape[2] % 2 or x.shape[3] % 2:
        return known
    share = F.avg_pool2d(mask, 2)
    coarse = (share > 0).float()
    filled = pull_push(F.avg_pool2d(known, 2) / (share + 1 - coarse), coarse, levels - 1)
    return known + (1 - mask) * F.interpolate(filled, scale_factor=2, mode="bilinear", align_corners=False)


class Residual(nn.Module):
    def __init__(self, c):
        super().__init__()
        self.a, self.b = (nn.Conv2d(c, c, 3, padding=1, padding_mode="reflect") for _ in range(2))

    def forward(self, x):
        return x + F.instance_norm(self.b(F.relu(F.instance_norm(self.a(x)))))


class PhotoRender(nn.Module):
    def __init__(self, channels, n, blocks):
        super().__init__()
        self.first = nn.Conv2d(channels, n, 7, padding=3, padding_mode="reflect")
        self.down = nn.ModuleList(nn.Conv2d(n << i, n << i + 1, 3, 2, 1) for i in range(3))
        self.blocks = nn.Sequential(*(Residual(8 * n) for _ in range(blocks)))
        self.up = nn.ModuleList(nn.ConvTranspose2d(n << i + 1, n << i, 4, 2, 1) for i in (2, 1, 0))
        self.last = nn.Conv2d(n + 3 + channels + 1, 4, 7, padding=3, padding_mode="reflect")

    def forward(self, r, body):
        x = F.relu(F.instance_norm(self.first(r)))
        for conv in self.down:
            x = F.relu(F.instance_norm(conv(x)))
        x = self.blocks(x)
        for conv in self.up:
            x = F.relu(F.instance_norm(conv(x)))
        x = self.last(torch.cat([x, pull_push(r[:, :3], body, 5), r, body], 1))
        return torch.sigmoid(x[:, 3:]) * (0.5 * (torch.tanh(x[:, :3]) + 1))


class Encoder(nn.Module):
    def __init__(self, i, widths):
        super().__init__()
        self.blocks = nn.ModuleList(Down(a, b) for a, b in zip([i] + widths[:-1], widths))

    def forward(self, x):
        maps = []
        for block in self.blocks:
            x = block(x)
            maps.append(x)
        return maps


class Decoder(nn.Module):
    def __init__(self, code, widths, i, o):
        super().__init__()
        self.up = nn.ModuleList()
        for level, w in enumerate(widths):
            to = widths[max(0, level - 1)]
            self.up.append(Up(code if level == len(widths) - 1 else 2 * w, w, to))
        self.head = nn.Conv2d(widths[0] + i, o, 3, 1, 1)

    def forward(self, x, seen, maps):
        for level in reversed(range(len(self.up))):
            x = self.up[level](x if level == len(self.up) - 1 else torch.cat([x, maps[level]], 1))
        return self.head(torch.cat([x, seen], 1))


class Shape(nn.Module):
    """SilNet and GarNet, the target's side."""

    def __init__(self, i, widths, o):
        super().__init__()
        self.encoder, self.decoder = Encoder(i, widths), Decoder(2 * widths[-1], widths, i, o)

    def forward(self, code, x):
        maps = self.encoder(x)
        return self.decoder(torch.cat([maps[-1], code], 1), x, maps)


class Modulation(nn.Module):
    def __init__(self, channels, maps, hidden):
        super().__init__()
        self.first = nn.ModuleList(nn.Conv2d(m, hidden, 3, 1, 1) for m in maps)
        self.second = nn.ModuleList(nn.Conv2d(hidden, 2 * channels, 3, 1, 1) for _ in maps)

    def forward(self, x, maps):
        x = F.instance_norm(x)
        for first, second, m in zip(self.first, self.second, maps):
            if m.shape[2:] != x.shape[2:]:
                m = F.interpolate(m, x.shape[2:], mode="bilinear", align_corners=False)
            gamma, beta = second(F.relu(first(m))).chunk(2, 1)
            x = (1 + gamma) * x + beta
        return x


class Block(nn.Module):
    def __init__(self, i, o, maps, hidden):
        super().__init__()
        self.m1, self.m2 = Modulation(i, maps, hidden), Modulation(o, maps, hidden)
        self.c1, self.c2 = nn.Conv2d(i, o, 3, 1, 1), nn.Conv2d(o, o, 3, 1, 1)
        self.shortcut = nn.Conv2d(i, o, 1, bias=False) if i != o else nn.Identity()

    def forward(self, x, maps):
        y = self.c1(lrelu(self.m1(x, maps)))
        return self.c2(lrelu(self.m2(y, maps))) + self.shortcut(x)


class GuidedRender(nn.Module):
    def __init__(self, encoder, decoder, full, modulation, latent):
        super().__init__()
        guide, pseudo = LABELS + 1, 4
        self.guide, self.pseudo = Encoder(guide, encoder), Encoder(pseudo, encoder)
        self.first = nn.Conv2d(latent, decoder[-1], 3, 1, 1)
        self.blocks = nn.ModuleList()
        for level in range(len(decoder)):
            i = decoder[min(level + 1, len(decoder) - 1)]
            self.blocks.append(Block(i, decoder[level], [encoder[level]] * 2, min(modulation, decoder[level])))
        self.full = Block(decoder[0], full, [guide, pseudo], min(modulation, full))
        self.last = nn.Conv2d(full + pseudo, 3, 3, 1, 1)

    def forward(self, code, guide, pseudo):
        maps = list(zip(self.guide(guide), self.pseudo(pseudo)))
        x = self.first(code)
        for block, pair in zip(reversed(self.blocks), reversed(maps)):
            x = F.interpolate(block(x, pair), scale_factor=2, mode="nearest")
        x = self.full(x, (guide, pseudo))
        return self.last(torch.cat([lrelu(x), pseudo], 1))


class Guided(nn.Module):
    def __init__(self, p):
        super().__init__()
        _, shape, encoder, decoder, full, modulation, latent = p
        self.sil, self.gar = Shape(6 + LABELS, shape, 1), Shape(4 + LABELS, shape, LABELS)
        self.render = GuidedRender(encoder, decoder, full, modulation, latent)

    def forward(self, codes, pose, known_labels, known):
        clothes = torch.cat([pose, known_labels, pose], 1)  # in place of their extent and the body
        silhouette = torch.sigmoid(self.sil(codes[0], clothes))
        logits = self.gar(codes[1], torch.cat([pose, silhouette, known_labels], 1))
        labels = F.one_hot(logits.argmax(1), LABELS).permute(0, 3, 1, 2).float()
        return silhouette * torch.sigmoid(self.render(codes[2], torch.cat([labels, silhouette], 1), known))


def parameters(module):
    return sum(p.numel() for p in module.parameters())


def show(what, work):
    work()
    processor, clock = [], []
    for _ in range(15):
        start, used = time.perf_counter(), time.process_time()
        work()
        processor.append(1e3 * (time.process_time() - used))
        clock.append(1e3 * (time.perf_counter() - start))
    processor.sort(), clock.sort()
    print("| %-44s | %7.1f | %7.1f | %7.1f |" % (what, processor[7], processor[0], clock[7]), flush=True)


def main():
    profile = sys.argv[1] if len(sys.argv) > 1 else "cpu"
    threads = int(sys.argv[2]) if len(sys.argv) > 2 else 1
    torch.set_num_threads(threads)
    torch.manual_seed(1)
    side, texels, d, n, blocks = PHOTO[profile]
    p = GUIDED[profile]
    photo, guided = PhotoRender(d, n, blocks).eval(), Guided(p).eval()
    print(f"\n## PyTorch {torch.__version__}, profile {profile}, {threads} threads; RenderNet of photo has "
          f"{parameters(photo)} parameters, the chain of guided {parameters(guided)} without the photo's encoders\n")
    print("| what | processor ms | least | clock ms |")
    print("|---|---|---|---|")
    cells = 1 << len(p[1])
    for w, h, what in ((side, side, "a frame, the whole window"), (side * 5 // 8, side, "the person's window")):
        body = torch.zeros(1, 1, h, w)
        body[:, :, h // 10:h * 9 // 10, w // 4:w * 3 // 4] = 1
        features, uv = torch.randn(1, d, texels, texels), torch.rand(1, 2, h, w)
        known_labels, known = body * torch.rand(1, LABELS, h, w), body * torch.rand(1, 4, h, w)
        pose = body * torch.rand(1, 3, h, w)
        codes = [torch.randn(1, c, h // cells, w // cells) for c in (p[1][-1], p[1][-1], p[6])]
        with torch.no_grad():
            show(f"photo: {what}, {w}x{h}", lambda: photo(project(features, uv, body), body))
            show(f"guided: {what}, {w}x{h}", lambda: guided(codes, pose, known_labels, known))


if __name__ == "__main__":
    main()
