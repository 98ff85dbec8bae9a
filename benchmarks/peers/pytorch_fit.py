#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Fits the problem of a .npz file (written by bodyloom_bench_work_precision) with PyTorch, as a user would: batched
over frames, vectorised, only the vertices that keypoints touch are posed, gradients by autograd.

  pytorch_fit.py PROBLEM.npz OUT.npz --method adam|lbfgs --rate LR --iterations N [--threads 2] [--decay]

OUT holds, for about twenty moments of the run, seconds (wall and processor time), poses (T*J*3 axis-angle), trans,
betas: who fitted better is judged by the program that wrote the problem. Cost: keypoints (Geman-McClure), accelerations
of rotations and translation, the nearest component of the pose prior, shape and stature prior; the same numbers as the
C++ engines minimise.
"""
import argparse
import time

import numpy as np
import torch


MOMENTS = (0.02, 0.05, 0.1, 0.15, 0.2, 0.25, 0.3, 0.35, 0.4, 0.45, 0.5, 0.55, 0.6, 0.65, 0.7, 0.75, 0.8, 0.85, 0.9,
           0.95, 1)


def exp_so3(w):
    """...x3 -> ...x3x3, Rodrigues with series near zero."""
    s = (w * w).sum(-1, keepdim=True)
    small = s < 1e-8
    angle = torch.sqrt(torch.where(small, torch.ones_like(s), s))
    a = torch.where(small, 1 - s / 6, torch.sin(angle) / angle)[..., None]
    b = torch.where(small, 0.5 - s / 24, (1 - torch.cos(angle)) / (angle * angle))[..., None]
    zero = torch.zeros_like(w[..., 0])
    k = torch.stack([zero, -w[..., 2], w[..., 1], w[..., 2], zero, -w[..., 0], -w[..., 1], w[..., 0], zero], -1)
    k = k.reshape(w.shape[:-1] + (3, 3))
    return torch.eye(3, dtype=w.dtype) + a * k + b * (k @ k)


def log_so3(r):
    """Valid for angles well below pi, as between neighbouring frames."""
    v = torch.stack([r[..., 2, 1] - r[..., 1, 2], r[..., 0, 2] - r[..., 2, 0], r[..., 1, 0] - r[..., 0, 1]], -1) / 2
    s = (v * v).sum(-1, keepdim=True)  # sin^2
    small = s < 1e-8
    sine = torch.sqrt(torch.where(small, torch.ones_like(s), s))
    cosine = ((r[..., 0, 0] + r[..., 1, 1] + r[..., 2, 2] - 1) / 2)[..., None]
    return v * torch.where(small, 1 + s / 6, torch.atan2(sine, cosine) / sine)


class Problem:
    def __init__(self, path):
        data = np.load(path)
        get = lambda name: torch.from_numpy(np.ascontiguousarray(data[name]))
        real = lambda name: get(name).float()
        self.parents = [int(parent) for parent in data["parents"]]
        self.corners = get("corners").long()  # T x K x 3, vertex indices; a keypoint that is missing has weight 0
        self.barycentric, self.pixel = real("barycentric"), real("pixel")
        self.inverse_sigma = real("inverse_sigma")  # T x K
        self.v_template, self.shapedirs = real("v_template"), real("shapedirs")  # V x 3, V x 3 x B
        self.joint_template, self.joint_shapedirs = real("joint_template"), real("joint_shapedirs")  # J x 3, J x 3 x B
        self.influence_joint, self.influence_weight = get("influence_joint").long(), real("influence_weight")
        # V x C, V x C x 3 x 9
        self.corrective_joint, self.corrective = get("corrective_joint").long(), real("corrective")
        self.camera = data["camera"].tolist()  # fx, fy, cx, cy
        self.kernel = float(data["kernel"])
        self.factors = real("acceleration_factors")  # T-2 x 2
        self.joint_inverse_sigma, self.root_inverse_sigma = real("joint_inverse_sigma"), real("root_inverse_sigma")
        self.prior_weight = float(data["prior_weight"])
        self.prior_joints = get("prior_joints").long()
        self.prior_means, self.prior_sqrt, self.prior_offset = (
            real("prior_means"), real("prior_sqrt"), real("prior_offset"))
        self.shape_rows, self.shape_offset = real("shape_rows"), real("shape_offset")
        self.poses, self.trans, self.betas = real("poses"), real("trans"), real("betas")  # the start

    def cost(self, poses, trans, betas):
        frames, joints = poses.shape[:2]
        rotation = exp_so3(poses)
        rest = self.joint_template + self.joint_shapedirs @ betas
        world, position = [rotation[:, 0]], [rest[0] + trans]
        for j in range(1, joints):
            parent = self.parents[j]
            world.append(world[parent] @ rotation[:, j])
            position.append(position[parent] + world[parent] @ (rest[j] - rest[parent]))
        world, position = torch.stack(world, 1), torch.stack(position, 1)
        offset = position - (world @ rest[..., None])[..., 0]
        feature = (rotation - torch.eye(3)).reshape(frames, joints, 9)

        index = self.corners.reshape(frames, -1)  # T x 3K
        shaped = self.v_template + self.shapedirs @ betas
        batch = torch.arange(frames)[:, None, None]
        driven = feature[batch, self.corrective_joint[index]]  # T x 3K x C x 9
        vertex = shaped[index] + (self.corrective[index] * driven[..., None, :]).sum((-1, -3))
        influence = self.influence_joint[index]
        moved = (world[batch, influence] @ vertex[:, :, None, :, None])[..., 0] + offset[batch, influence]
        posed = (moved * self.influence_weight[index][..., None]).sum(2)
        point = (posed.reshape(frames, -1, 3, 3) * self.barycentric[..., None]).sum(2)
        fx, fy, cx, cy = self.camera
        pixel = torch.stack([fx * point[..., 0] / point[..., 2] + cx, fy * point[..., 1] / point[..., 2] + cy], -1)
        s = ((pixel - self.pixel) ** 2).sum(-1) * self.inverse_sigma**2
        c2 = self.kernel**2
        total = 0.5 * (c2 * s / (c2 + s)).sum()

        if frames > 2:
            step = log_so3(rotation[:-1].transpose(-1, -2) @ rotation[1:])
            earlier, later = self.factors[:, :1, None], self.factors[:, 1:, None]
            r = (later * step[1:] - earlier * step[:-1]) * self.joint_inverse_sigma[None, :, None]
            move = trans[1:] - trans[:-1]
            q = (later[..., 0] * move[1:] - earlier[..., 0] * move[:-1]) * self.root_inverse_sigma
            total = total + 0.5 * (r * r).sum() + 0.5 * (q * q).sum()

        x = poses[:, self.prior_joints].reshape(frames, -1)
        centred = x[:, None] - self.prior_means  # T x M x D
        energy = (torch.einsum("mde,tme->tmd", self.prior_sqrt, centred) ** 2).sum(-1) + self.prior_offset
        total = total + 0.5 * self.prior_weight * energy.min(-1).values.sum()
        shape = self.shape_rows @ betas + self.shape_offset
        return total + 0.5 * (shape * shape).sum()


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("problem")
    parser.add_argument("out")
    parser.add_argument("--method", choices=["adam", "lbfgs"], default="adam")
    parser.add_argument("--rate", type=float, default=0.02)
    parser.add_argument("--iterations", type=int, default=500)
    parser.add_argument("--history", type=int, default=20, help="of L-BFGS")
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--decay", action="store_true", help="cosine decay of the rate to zero")
    arguments = parser.parse_args()
    torch.set_num_threads(arguments.threads)
    problem = Problem(arguments.problem)
    unknowns = [problem.poses.clone(), problem.trans.clone(), problem.betas.clone()]
    for x in unknowns:
        x.requires_grad_(True)
    marks = sorted({max(1, round(arguments.iterations * f)) for f in MOMENTS})
    record = {"seconds": [], "cpu_seconds": [], "iterations": [], "cost": [], "poses": [], "trans": [], "betas": []}
    problem.cost(*unknowns).backward()  # the first call warms up what PyTorch prepares lazily
    for x in unknowns:
        x.grad = None
    spent, start = 0.0, time.perf_counter()
    cpu_spent, cpu_start = 0.0, time.process_time()
    if arguments.method == "adam":
        optimiser = torch.optim.Adam(unknowns, lr=arguments.rate)
        schedule = (torch.optim.lr_scheduler.CosineAnnealingLR(optimiser, arguments.iterations)
                    if arguments.decay else None)
    else:
        optimiser = torch.optim.LBFGS(unknowns, lr=arguments.rate, max_iter=1, history_size=arguments.history,
                                      line_search_fn="strong_wolfe")
        schedule = None

    def closure():
        optimiser.zero_grad()
        value = problem.cost(*unknowns)
        value.backward()
        return value

    for i in range(1, arguments.iterations + 1):
        value = optimiser.step(closure)
        if schedule is not None:
            schedule.step()
        if i in marks:
            spent += time.perf_counter() - start
            cpu_spent += time.process_time() - cpu_start
            record["seconds"].append(spent)
            record["cpu_seconds"].append(cpu_spent)
            record["iterations"].append(i)
            record["cost"].append(float(value))
            for name, x in zip(("poses", "trans", "betas"), unknowns):
                record[name].append(x.detach().double().numpy().copy())
            start, cpu_start = time.perf_counter(), time.process_time()
    np.savez(arguments.out, **{name: np.asarray(values, dtype=np.float64) for name, values in record.items()})


if __name__ == "__main__":
    main()
