#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Pose2Sim's balancing trial turned by known rotations: tracks against its calibration, the motion found against the
true one.

usage: turned_clips.py BODYLOOM POSE2SIM CLIPS [--turns tremor-1.5 ...] [--joints trial] [--focal known]
                       [--modes found still path] [--out DIR]
  BODYLOOM: the program; POSE2SIM: the folder with calib_refined.json and balancing/
  CLIPS: a folder that `bodyloom_bench_camera_motion --write` filled with cam01_TURN.mp4 and cam02_TURN.mp4 and their
  true paths; cam0N_still.mp4 is the original

The clips are played forwards and backwards, and so is the truth. A turned camera's scene is the frame of its first
picture, which is not turned: in it the track is one of the original's camera, and is scored as such (`bodyloom
evaluate --view cam_0N`: g, WA and tilt in the room, PA). Modes: `found` searches for the motion, `still` does not, and
`path` is told the true one, `no-lines` searches and leaves the lines of the picture out. --joints: `video`, by
`bodyloom run`, or `trial`, the trial's own 2D joints, which are turned exactly, by `bodyloom track`, which tells the
lines as well. rms: of the rotations found, degrees; focal: of the track, over the original's.
"""
import argparse
import json
import pathlib
import subprocess

import numpy as np

# Focal lengths in the video's pixels (calib_refined.json, video_to_calib_affine.json).
FOCAL_PX = {"cam01": 1669, "cam02": 1661}
VALUES = ("room_g_mpjpe_mm", "room_wa_mpjpe_mm", "pa_mpjpe_mm", "tilt_deg")


def at_frame(frame, count):
    """The file of joints of a video's frame, played forwards and backwards; those of the video are one later."""
    period = 2 * count - 2
    return max(0, min(frame % period, period - frame % period) - 1)


def played_back_and_forth(pose2sim, frames, out):
    """A folder like POSE2SIM whose balancing trial has so many frames, forwards and backwards."""
    for name in ("calib_refined.json", "video_to_calib_affine.json"):
        out.mkdir(parents=True, exist_ok=True)
        (out / name).write_bytes((pose2sim / name).read_bytes())
    for camera in ("cam01", "cam02"):
        files = sorted((pose2sim / "balancing" / "json_single" / f"{camera}_json").glob("*.json"))
        folder = out / "balancing" / "json_single" / f"{camera}_json"
        folder.mkdir(parents=True, exist_ok=True)
        for frame in range(frames):
            (folder / f"frame_{frame:06d}.json").write_bytes(files[at_frame(frame, len(files))].read_bytes())


def turned_joints(pose2sim, camera, clip, true_path, out):
    """The trial's joints in the turned clip's pixels, one file a frame; those that leave the picture are unseen."""
    width, height = json.loads(subprocess.run(
        ["ffprobe", "-v", "error", "-select_streams", "v", "-show_entries", "stream=width,height", "-of", "json", clip],
        check=True, capture_output=True).stdout)["streams"][0].values()
    K = np.array([[FOCAL_PX[camera], 0, (width - 1) / 2], [0, FOCAL_PX[camera], (height - 1) / 2], [0, 0, 1]])
    affine = json.loads((pose2sim / "video_to_calib_affine.json").read_text(encoding="utf-8"))
    video_from_calib = np.linalg.inv(np.vstack([affine[camera]["video_to_calib_affine"], [0, 0, 1]]))
    files = sorted((pose2sim / "balancing" / "json_single" / f"{camera}_json").glob("*.json"))
    out.mkdir(parents=True, exist_ok=True)
    for frame, rotation in enumerate(rotations(true_path).values()):
        seen = json.loads(files[at_frame(frame, len(files))].read_text(encoding="utf-8"))
        turn = K @ matrix(rotation) @ np.linalg.inv(K) @ video_from_calib
        for person in seen["people"]:
            points = np.array(person["pose_keypoints_2d"], float).reshape(-1, 3)
            turned = np.column_stack([points[:, :2], np.ones(len(points))]) @ turn.T
            points[:, :2] = turned[:, :2] / turned[:, 2:]
            points[(points[:, :2] < 0).any(1) | (points[:, :2] > [width, height]).any(1)] = 0
            person["pose_keypoints_2d"] = points.ravel().tolist()
        (out / f"frame_{frame:06d}.json").write_text(json.dumps(seen), encoding="utf-8")


def rotations(path):
    frames = json.loads(path.read_text(encoding="utf-8"))["frames"]
    return {round(frame["time"], 6): np.array(frame["rotation"], float) for frame in frames}


def matrix(rotation):
    if rotation.shape == (3, 3):
        return rotation
    angle = np.linalg.norm(rotation)
    x, y, z = rotation / max(angle, 1e-12)
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross


def rotation_rms(found, true):
    found, true = rotations(found), rotations(true)
    times = np.array(list(true))
    squares = []
    for time, rotation in found.items():
        other = true[times[np.argmin(np.abs(times - time))]]
        cosine = (np.trace(matrix(rotation) @ matrix(other).T) - 1) / 2
        squares.append(np.degrees(np.arccos(np.clip(cosine, -1, 1))) ** 2)
    return np.sqrt(np.mean(squares))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("bodyloom")
    parser.add_argument("pose2sim", type=pathlib.Path)
    parser.add_argument("clips", type=pathlib.Path)
    parser.add_argument("--turns", nargs="+", default=["still", "tremor-0.5", "tremor-1.5", "tremor-3", "pan", "zoom"])
    parser.add_argument("--cameras", nargs="+", default=list(FOCAL_PX))
    parser.add_argument("--modes", nargs="+", default=["found", "still"])
    parser.add_argument("--focal", choices=["known", "unknown"], default="unknown")
    parser.add_argument("--joints", choices=["video", "trial"], default="video")
    parser.add_argument("--person", default="0", help="number of the man in the clips")
    parser.add_argument("--out", type=pathlib.Path, default=pathlib.Path("turned"))
    given = parser.parse_args()
    print(f"{'clip':20} {'mode':6} {'g':>6} {'WA':>6} {'PA':>6} {'tilt':>6} {'rms':>7} {'focal':>6}  motion; lines")
    for camera in given.cameras:
        for turn in given.turns:
            clip = given.clips / f"{camera}_{turn}.mp4"
            true_path = clip.with_suffix(".json")
            for mode in given.modes:
                if turn == "still" and mode in ("still", "path"):
                    continue
                out = given.out / f"{camera}_{turn}_{mode}_{given.focal}_{given.joints}"
                found_path = out / "path.json"
                options = {"found": ["--camera-path-out", found_path], "still": ["--still"],
                           "no-lines": ["--no-lines"], "path": ["--camera-path", true_path]}[mode]
                if given.focal == "known":
                    options += ["--focal", str(FOCAL_PX[camera])]
                track, errors = out / "scene.npz", out / "errors.json"
                if not errors.exists():
                    out.mkdir(parents=True, exist_ok=True)
                    if given.joints == "video":
                        command = ["run", clip, "--person", given.person, "--detector", "full", "--no-overlay", "--out",
                                   out]
                    else:
                        turned_joints(given.pose2sim, camera, clip, true_path, out / "joints")
                        command = ["track", "--detections", out / "joints", "--video", clip, "--fps", "60", "--json",
                                   out / "summary.json", "--out", out / f"person_{given.person}.npz"]
                    subprocess.run([given.bodyloom, *command, "--quiet", *options], check=True)
                    found = dict(np.load(out / f"person_{given.person}.npz"))
                    found.pop("camera_from_scene", None)
                    np.savez(track, **found)
                    truth = given.out / "truth"
                    played_back_and_forth(given.pose2sim, len(found["timestamps"]), truth)
                    subprocess.run([given.bodyloom, "evaluate", "--track", track, "--truth", truth, "--view",
                                    f"cam_{camera[-2:]}", "--json", errors], check=True, stdout=subprocess.DEVNULL)
                values = json.loads(errors.read_text(encoding="utf-8"))["values"]
                summary = json.loads((out / "summary.json").read_text(encoding="utf-8"))
                motion = summary.get("camera_path", {}).get("motion", "not looked for").split(":")[0]
                lines = next((step["why"] for step in summary.get("ran", []) + summary.get("skipped", [])
                              if step["what"] == "vertical from lines"),
                             "")
                rms = rotation_rms(found_path, true_path) if found_path.exists() else np.nan
                print(f"{clip.stem:20} {mode:6} " + " ".join(f"{values[name]:6.1f}" for name in VALUES) +
                      f" {rms:7.3f} {np.load(track)['K'][0, 0] / FOCAL_PX[camera]:6.3f}  "
                      f"{motion}; {lines}", flush=True)


if __name__ == "__main__":
    main()
