#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Mean of the faces that `bodyloom detect` found, as tracking/hands/face_shape.cc holds it, and how far faces differ.

usage: mean_face.py DETECTIONS.npz...

Each face's 68 points (x, y and depth in pixels) are moved, turned and scaled onto the mean, which is mirrored onto
itself; people count alike. Axes: x to the person's left, y down, z to the back of the head; eyes level, the bridge of
the nose to the chin upright; the root mean square distance from the middle is 1. Also printed: how far the rotation of
a face without depth is from its own.
"""
import sys

import numpy as np

MIRROR = np.array([16 - i for i in range(17)]
                  + [26, 25, 24, 23, 22, 21, 20, 19, 18, 17, 27, 28, 29, 30, 35, 34, 33, 32, 31]
                  + [45, 44, 43, 42, 47, 46, 39, 38, 37, 36, 41, 40, 54, 53, 52, 51, 50, 49, 48, 59, 58, 57, 56, 55]
                  + [64, 63, 62, 61, 60, 67, 66, 65])


def normal(face):
    face = face - face.mean(0)
    return face / np.sqrt((face**2).sum(-1).mean())


def turn_onto(face, onto):
    u, _, vt = np.linalg.svd(onto.T @ face)
    return u @ np.diag([1, 1, np.linalg.det(u @ vt)]) @ vt


def turn_of_flat(points, face, rounds):
    """The rotation of the mean face that lies on points (x, y) without the jaw's, as tracking/hands/turn_head.cc finds it."""
    face, seen = (p[17:] - p[17:].mean(0) for p in (face, np.c_[points, np.zeros(len(points))]))
    turn = turn_onto(face, seen)
    for _ in range(rounds):
        laid = face @ turn.T
        seen[:, 2] = laid[:, 2] * (laid[:, :2] * seen[:, :2]).sum() / (laid[:, :2]**2).sum()
        turn = turn_onto(face, seen)
    return turn


def mean(faces):
    middle = normal(faces.mean(0))
    for _ in range(20):
        middle = normal(np.mean([face @ turn_onto(face, middle).T for face in faces], 0))
    return middle


def main():
    people = []
    for path in sys.argv[1:]:
        z = np.load(path)
        faces = np.concatenate([z["face_keypoints"][..., :2], z["face_depth_px"][..., None]], -1)
        people.append(np.array([normal(face) for face in faces if np.isfinite(face).all()]))
    face = mean(np.array([mean(faces) for faces in people]))
    mirrored = face[MIRROR] * [-1, 1, 1]
    face = normal((face + mirrored @ turn_onto(mirrored, face).T) / 2)
    x = face[42:48].mean(0) - face[36:42].mean(0)
    x /= np.linalg.norm(x)
    y = face[8] - face[27]
    y -= x * (x @ y)
    y /= np.linalg.norm(y)
    face = face @ np.array([x, y, np.cross(x, y)]).T
    for path, faces in zip(sys.argv[1:], people):
        away = [np.sqrt(((f @ turn_onto(f, face).T - face)**2).sum(-1).mean()) for f in faces]
        print(f"// {len(faces)} faces of {path.split('/')[-1]}: {np.median(away):.3f} away", file=sys.stderr)
        for rounds in (10, 50):
            turns = [turn_onto(face, f).T @ turn_of_flat(f[:, :2], face, rounds) for f in faces]
            off = np.degrees([np.arccos(np.clip((np.trace(t) - 1) / 2, -1, 1)) for t in turns])
            far = np.percentile(off, 90)
            print(f"// without depth and jaw, {rounds} rounds: {np.median(off):.1f} deg off, 90 % within {far:.1f}", file=sys.stderr)
    for k in range(0, 68, 4):
        print("    " + " ".join("{%.3f, %.3f, %.3f}," % tuple(p) for p in face[k:k + 4]))


if __name__ == "__main__":
    main()
