# SPDX-License-Identifier: Apache-2.0
"""C-BLK and D-BLK of the motion-dependent renderer in PyTorch, for the peers of all networks that are made of them."""
import torch.nn.functional as F
from torch import nn


def lrelu(x):
    return F.leaky_relu(x, 0.2)


def norm(x):
    return lrelu(F.instance_norm(x))


class Down(nn.Module):
    def __init__(self, i, o):
        super().__init__()
        self.a, self.b = nn.Conv2d(i, o, 3, 1, 1, bias=False), nn.Conv2d(o, o, 3, 1, 1, bias=False)
        self.c = nn.Conv2d(o, o, 4, 2, 1, bias=False)

    def forward(self, x):
        return norm(self.c(norm(self.b(norm(self.a(x))))))


class Up(nn.Module):
    def __init__(self, i, m, o):
        super().__init__()
        self.a = nn.Conv2d(i, m, 3, 1, 1, bias=False)
        self.b, self.c = (nn.Conv2d(m, m, 3, 1, 1, bias=False) for _ in range(2))
        self.d = nn.ConvTranspose2d(m, o, 4, 2, 1)

    def forward(self, x):
        return lrelu(self.d(norm(self.c(norm(self.b(norm(self.a(x))))))))
