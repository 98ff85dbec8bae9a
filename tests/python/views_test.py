# SPDX-License-Identifier: Apache-2.0
"""Several cameras from Python: their track and rig are the command's, and judge the track of one camera."""
import functools
import math
import pathlib
import tempfile
import unittest

import numpy as np

import bodyloom
from support import AIST, AIST_CLIP, clip, needs_recordings, run_command

FRAMES = 60


def side_pose():
    """Camera from rig of a camera 70 degrees aside that looks at a point 3 m in front of the first."""
    angle = math.radians(70)
    pose = np.eye(4)
    pose[:3, :3] = [[math.cos(angle), 0, math.sin(angle)], [0, 1, 0], [-math.sin(angle), 0, math.cos(angle)]]
    pose[:3, 3] = [0, 0, 3] - pose[:3, :3] @ [0, 0, 3]
    return pose


@functools.lru_cache(maxsize=None)
def two_views():
    """(two views' Keypoints of one motion, its truth, the second camera); the second clock is 2 s ahead."""
    _, truth = clip(FRAMES)
    pose = side_pose()
    noise = np.random.default_rng(3)
    views = []
    for move, ahead in ((np.eye(4), 0.0), (pose, 2.0)):
        points = np.ones((FRAMES, 17, 3))
        for t in range(FRAMES):
            inside = truth.coco17[t] @ move[:3, :3].T + move[:3, 3]
            points[t, :, :2] = truth.camera.project(inside) + noise.normal(0, 0.5, (17, 2))
        views.append(bodyloom.Keypoints(points, timestamps=truth.timestamps + ahead, image_size=(320, 240)))
    return views, truth, bodyloom.RigCamera("side", truth.camera, pose, offset_s=2.0)


class Rigs(unittest.TestCase):
    def test_there_and_back(self):
        camera = bodyloom.Camera(320, 240, focal_px=300)
        rig = [bodyloom.RigCamera("front", camera, focal_log_sigma=math.nan),
               bodyloom.RigCamera("side", camera, side_pose(), offset_s=2.5, rate=1e-3, middle_s=4.0,
                                  rotation_sigma_rad=0.01)]
        self.assertEqual(rig[1].time_at(4.0), 6.5)
        self.assertAlmostEqual(rig[1].first_time_at(rig[1].time_at(7.0)), 7.0, places=12)
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder, "rig.json")
            bodyloom.write_rig(path, rig)
            read = bodyloom.read_rig(path)
        self.assertEqual([one.name for one in read], ["front", "side"])
        np.testing.assert_array_equal(read[0].camera_from_rig, np.eye(4))
        np.testing.assert_allclose(read[1].camera_from_rig, side_pose(), atol=1e-14)
        for name in ("offset_s", "rate", "middle_s", "rotation_sigma_rad", "translation_sigma_m", "offset_sigma_s"):
            self.assertEqual(getattr(read[1], name), getattr(rig[1], name))
        self.assertTrue(math.isnan(read[0].focal_log_sigma))
        self.assertEqual(read[1].camera.K[0, 0], 300)

    def test_refused(self):
        camera = bodyloom.Camera(320, 240, focal_px=300)
        for arguments, text in ((dict(camera_from_rig=2 * np.eye(4)), "camera_from_rig"), (dict(rate=-1.0), "rate"),
                                (dict(camera_from_rig=np.eye(3)), "shape"), (dict(rate_sigma=-1.0), "deviation")):
            with self.subTest(text=text), self.assertRaisesRegex(ValueError, text):
                bodyloom.RigCamera("a", camera, **arguments)
        with tempfile.TemporaryDirectory() as folder:
            with self.assertRaisesRegex(ValueError, "without cameras"):
                bodyloom.write_rig(pathlib.Path(folder, "rig.json"), [])
            with self.assertRaisesRegex(RuntimeError, "No such file"):
                bodyloom.read_rig(pathlib.Path(folder, "rig.json"))


class Views(unittest.TestCase):
    def test_a_truth_for_one_view(self):
        views, truth, side = two_views()
        track, rig = bodyloom.track_views(views, focal_px=float(truth.camera.K[0, 0]), threads=2)
        self.assertEqual(len(track), FRAMES)
        self.assertEqual([camera.name for camera in rig], ["view1", "view2"])
        self.assertLess(abs(rig[1].offset_s - side.offset_s), 0.02)
        error_deg = np.degrees(np.arccos((np.trace(rig[1].camera_from_rig[:3, :3] @ side_pose()[:3, :3].T) - 1) / 2))
        self.assertLess(error_deg, 5)
        self.assertEqual(track.summary.frames_by_status["tracked"], FRAMES)

        alone = bodyloom.track(views[1], focal_px=float(truth.camera.K[0, 0]), threads=2)
        evaluation = bodyloom.evaluate(alone, track, rig=rig, view="view2")
        self.assertEqual(evaluation.protocol, "rig-track")
        self.assertEqual(evaluation.frames + evaluation["frames_without_truth"], FRAMES)
        self.assertGreater(evaluation["other_views_mean_px"], evaluation["own_view_mean_px"])
        self.assertGreater(evaluation["truth_joint_sigma_mm"], 0)
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder)
            for name, one in (("alone.npz", alone), ("truth.npz", track)):
                one.save(folder / name)
            bodyloom.write_rig(folder / "rig.json", rig)
            table = run_command("evaluate", "--track", folder / "alone.npz", "--truth", folder / "truth.npz", "--rig",
                                folder / "rig.json", "--view", "view2")
            self.assertEqual(str(evaluation), table)
            by_file = bodyloom.evaluate(alone, folder / "truth.npz", rig=folder / "rig.json", view="view2")
            self.assertEqual(str(by_file), table)

        itself = bodyloom.evaluate(track, track, rig=rig)
        self.assertAlmostEqual(itself["joint_err_mm"], 0, places=6)
        with self.assertRaisesRegex(RuntimeError, "no camera 'top', expected one of view1, view2"):
            bodyloom.evaluate(alone, track, rig=rig, view="top")
        with self.assertRaisesRegex(ValueError, "--rig"):
            bodyloom.evaluate(alone, rig=rig)

    def test_known_cameras_in_memory(self):
        views, truth, side = two_views()
        first = bodyloom.RigCamera("front", truth.camera)
        track, rig = bodyloom.track_views(views, views=["front", "side"], cameras=[first, side], threads=2)
        self.assertEqual([camera.name for camera in rig], ["front", "side"])
        np.testing.assert_allclose(rig[1].camera_from_rig, side_pose(), atol=1e-9)
        self.assertEqual(rig[1].offset_s, 2.0)
        error_m = np.linalg.norm(track.joints - truth.joints, axis=2)
        self.assertLess(np.median(error_m), 0.05)

    def test_refused(self):
        views, truth, side = two_views()
        with self.assertRaisesRegex(ValueError, "lenses"):
            bodyloom.track_views(views, known="lenses")
        with self.assertRaisesRegex(ValueError, "threads"):
            bodyloom.track_views(views, threads=-1)
        with self.assertRaises(ValueError):
            bodyloom.track_views(views[:1])
        with self.assertRaises(bodyloom.Cancelled):
            bodyloom.track_views(views, progress=lambda stage, fraction: False)

    @needs_recordings
    def test_a_recording_is_the_command_s(self):
        detections = AIST / "keypoints2d" / f"{AIST_CLIP}.pkl"
        track, rig = bodyloom.track_views(detections, views=["c01", "c03"], image_size=(1920, 1080), threads=2)
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder)
            track.save(folder / "python.npz")
            run_command("track", "--detections", detections, "--view", "c01,c03", "--image-size", "1920x1080",
                        "--threads", "2", "--out", folder / "track.npz", "--quiet")
            self.assertEqual((folder / "python.npz").read_bytes(), (folder / "track.npz").read_bytes())
            command_rig = bodyloom.read_rig(folder / "rig.json")
        for one, other in zip(rig, command_rig, strict=True):
            np.testing.assert_array_equal(one.camera_from_rig, other.camera_from_rig)
            np.testing.assert_array_equal(one.camera.K, other.camera.K)
            self.assertEqual((one.name, one.offset_s, one.rate), (other.name, other.offset_s, other.rate))


if __name__ == "__main__":
    unittest.main()
