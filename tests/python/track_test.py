# SPDX-License-Identifier: Apache-2.0
"""Tracks made from Python equal the command's and agree with the truth."""
import json
import pathlib
import pickle
import tempfile
import unittest

import numpy as np

import bodyloom
from support import AIST, AIST_CLIP, clip, needs_recordings, run_command, tracked


class SameBytesAsTheCommand(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def expect_same(self, track, *words):
        track.save(self.folder / "python.npz")
        run_command("track", *words, "--out", self.folder / "command.npz", "--quiet")
        self.assertEqual((self.folder / "python.npz").read_bytes(), (self.folder / "command.npz").read_bytes())

    @needs_recordings
    def test_recording_by_files(self):
        detections = AIST / "keypoints2d" / f"{AIST_CLIP}.pkl"
        track = bodyloom.track(detections, view="c01", camera=AIST / "cameras")
        self.expect_same(track, "--detections", detections, "--view", "c01", "--cameras", AIST / "cameras")

    @needs_recordings
    def test_recording_in_memory(self):
        detections = AIST / "keypoints2d" / f"{AIST_CLIP}.pkl"
        camera = bodyloom.Camera.load(AIST / "cameras", view="c01", sequence=AIST_CLIP)
        track = bodyloom.track(bodyloom.Keypoints.load(detections, view="c01"), camera=camera)
        self.expect_same(track, "--detections", detections, "--view", "c01", "--cameras", AIST / "cameras")

    @needs_recordings
    def test_recording_through_numpy(self):
        detections = AIST / "keypoints2d" / f"{AIST_CLIP}.pkl"
        read = bodyloom.Keypoints.load(detections, view="c01")
        keypoints = bodyloom.Keypoints(
            read.points.copy(), names=read.names, timestamps=read.timestamps.copy(), image_size=(1920, 1080))
        track = bodyloom.track(keypoints, threads=1)
        self.expect_same(track, "--detections", detections, "--view", "c01", "--image-size", "1920x1080", "--threads", "1")

    def test_options(self):
        keypoints, truth = clip()
        keypoints.save(self.folder / "observations.npz")
        size = ("--detections", self.folder / "observations.npz", "--image-size", "320x240")
        for arguments, words in (
            (dict(live_lag=4), ("--live", "4")),
            (dict(focal_px=352.0, ground=False), ("--focal", "352", "--no-ground")),
            (dict(focal_35mm=26.0), ("--focal-35mm", "26")),
            (dict(camera_model="weak"), ("--camera", "weak")),
            (dict(estimate_shape=False, uncertainty=False, max_iterations=7),
             ("--no-shape", "--no-uncertainty", "--max-iterations", "7")),
            (dict(stature_m=1.9, lifter="none", prior="none"), ("--stature", "1.9", "--lifter", "none", "--prior", "none")),
            (dict(solver="ceres", skip_unneeded=False, straight_knees=2.0, velocity_weight=0.1, min_confidence=0.2),
             ("--solver", "ceres", "--no-skip", "--straight-knees", "2", "--velocity-weight", "0.1", "--min-confidence",
              "0.2")),
        ):
            with self.subTest(words=words):
                self.expect_same(bodyloom.track(keypoints, **arguments), *size, *words)


class Tracks(unittest.TestCase):
    def test_shapes_and_error(self):
        keypoints, truth = clip()
        track = tracked()
        self.assertEqual(len(track), 40)
        self.assertEqual(track.poses.shape, (40, 72))
        self.assertEqual(track.trans.shape, (40, 3))
        self.assertEqual(track.joints.shape, (40, 24, 3))
        self.assertEqual(track.coco17.shape, (40, 17, 3))
        self.assertEqual(track.joint_sigma.shape, (40, 24))
        self.assertEqual(track.world_from_camera.shape, (4, 4))
        np.testing.assert_array_equal(track.timestamps, keypoints.timestamps)
        error_m = np.linalg.norm(track.joints - truth.joints, axis=2)
        self.assertLess(np.median(error_m), 0.1)
        self.assertEqual(track.summary.frames_by_status["tracked"], 40)
        self.assertEqual(track.summary.frame_px.shape, (40,))
        self.assertIn("2D joints: median", str(track.summary))
        self.assertIsNone(truth.summary)

    def test_save_and_load(self):
        track = tracked()
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder, "track.npz")
            track.save(path)
            again = bodyloom.Track.load(path)
            again.save(pathlib.Path(folder, "again.npz"))
            self.assertEqual(path.read_bytes(), pathlib.Path(folder, "again.npz").read_bytes())
            with np.load(path) as members:
                np.testing.assert_array_equal(members["poses"], track.poses)
                np.testing.assert_array_equal(members["joints"], track.joints)

    def test_arrays_there_and_back(self):
        for track in (tracked(), bodyloom.track(clip()[0], camera_model="weak")):
            with tempfile.TemporaryDirectory() as folder:
                for name, other in (("a", track), ("b", bodyloom.Track.from_arrays(**track.to_arrays())),
                                    ("c", pickle.loads(pickle.dumps(track)))):
                    other.save(pathlib.Path(folder, name))
                whole = pathlib.Path(folder, "a").read_bytes()
                self.assertEqual(whole, pathlib.Path(folder, "b").read_bytes())
                self.assertEqual(whole, pathlib.Path(folder, "c").read_bytes())

    def test_one_array_changed(self):
        track = tracked()
        moved = bodyloom.Track.from_arrays(**{**track.to_arrays(), "trans": track.trans + [0, 0, 1]})
        np.testing.assert_array_equal(moved.trans, track.trans + [0, 0, 1])
        np.testing.assert_array_equal(moved.poses, track.poses)

    def test_a_body_in_memory_is_the_file_s(self):
        keypoints, truth = clip()
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder, "body.npz")
            run_command("body", "make", "--out", path)
            by_file = bodyloom.track(keypoints, camera=truth.camera, body=path)
            in_memory = bodyloom.track(keypoints, camera=truth.camera, body=bodyloom.Body.load(path))
        np.testing.assert_array_equal(by_file.poses, in_memory.poses)

    def test_nothing_to_track(self):
        points = np.zeros((5, 17, 3))
        with self.assertRaisesRegex(RuntimeError, "^keypoints: nothing could be tracked: "):
            bodyloom.track(bodyloom.Keypoints(points, image_size=(320, 240)))

    def test_the_truth_has_no_error(self):
        _, truth = clip()
        evaluation = bodyloom.evaluate(truth, truth)
        self.assertEqual(evaluation.protocol, "known-truth")
        self.assertEqual(evaluation["mpjpe_mm"], 0)
        self.assertEqual(evaluation.values["pve_mm"], 0)
        self.assertIn("mpjpe_mm", str(evaluation))
        self.assertEqual(evaluation.breakdowns["joint_angle_err_deg"]["l_knee"], 0)
        with self.assertRaises(KeyError):
            evaluation["mpjpe"]

    def test_evaluation_is_the_command_s(self):
        _, truth = clip()
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder)
            tracked().save(folder / "track.npz")
            truth.save(folder / "truth.npz")
            table = run_command("evaluate", "--track", folder / "track.npz", "--truth", folder / "truth.npz")
            self.assertEqual(str(bodyloom.evaluate(tracked(), truth)), table)
            self.assertEqual(str(bodyloom.evaluate(folder / "track.npz", folder / "truth.npz")), table)
            alone = run_command("evaluate", "--track", folder / "track.npz")
            self.assertEqual(str(bodyloom.evaluate(tracked())), alone)

    def test_evaluation_by_a_sequence_of_3dpw(self):
        track = tracked()
        frames = len(track.timestamps)
        camera = np.array([[600.0, 0, 480], [0, 600, 360], [0, 0, 1]])
        sequence = {"sequence": "room", "genders": ["m", "m"], "cam_intrinsics": camera,
                    "cam_poses": np.tile(np.eye(4), (frames, 1, 1)),
                    "poses": [np.zeros((frames, 72)), np.array(track.poses)],
                    "trans": [np.ones((frames, 3)), np.array(track.trans)],
                    "betas": [np.zeros(10), np.array(track.betas)], "campose_valid": [np.ones(frames)] * 2}
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder)
            truth = folder / "room.pkl"
            truth.write_bytes(pickle.dumps(sequence, protocol=2))
            track.save(folder / "track.npz")
            table = run_command("evaluate", "--track", folder / "track.npz", "--truth", truth, "--true-person", "1")
            second = bodyloom.evaluate(track, truth, true_person=1)
            self.assertTrue(table.endswith(str(second)), table)  # after the advice on --true-body
            self.assertEqual(second.protocol, "3dpw")
            self.assertGreater(bodyloom.evaluate(track, truth)["mpjpe_mm"], second["mpjpe_mm"] + 50)
            with self.assertRaisesRegex(RuntimeError, "expected one with number 2"):
                bodyloom.evaluate(track, truth, true_person=2)

    def test_exports_are_the_command_s(self):
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder)
            tracked().save(folder / "track.npz")
            for form, name in (("joints", "j.npy"), ("amass", "a.npz"), ("bvh", "m.bvh"), ("glb", "b.glb"), ("fbx", "b.fbx"),
                               ("smplx", "x.npz"), ("trc", "t.trc"), ("c3d", "c.c3d"), ("pose2sim", "Calib.toml"),
                               ("angles", "a.csv"), ("angles", "a.mot")):
                with self.subTest(form=form):
                    run_command("export", "--track", folder / "track.npz", "--what", form, "--out", folder / name)
                    expected = (folder / name).read_bytes()
                    (folder / name).unlink()
                    text = bodyloom.export(tracked(), folder / name, form)
                    self.assertEqual((folder / name).read_bytes(), expected)
                    self.assertTrue(text.endswith(f"wrote {folder / name}\n"))

    def test_joint_angles_are_the_export_s(self):
        track = tracked()
        angles = bodyloom.joint_angles(track)
        self.assertEqual(angles.values.shape, (len(track), len(angles.names)))
        self.assertEqual(angles.sigma_deg.shape, angles.values.shape)
        np.testing.assert_array_equal(angles.timestamps, track.timestamps)
        np.testing.assert_array_equal(angles["knee_angle_l"], angles.values[:, angles.names.index("knee_angle_l")])
        self.assertFalse(angles.values.flags.writeable)
        with self.assertRaises(KeyError):
            angles["knee"]
        with self.assertRaisesRegex(ValueError, "rotation-first"):
            bodyloom.joint_angles(track, pelvis_order="list-first")
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder)
            bodyloom.export(track, folder / "a.csv", "angles", events=folder / "gait.json")
            table = np.genfromtxt(folder / "a.csv", delimiter=",", names=True)
            for name in angles.names:
                np.testing.assert_allclose(table[name], angles[name], rtol=0, atol=6e-5)
            np.testing.assert_allclose(table["knee_angle_r_sigma"], angles.sigma_deg[:, angles.names.index("knee_angle_r")],
                                       rtol=0, atol=6e-5)
            self.assertEqual(json.loads((folder / "gait.json").read_text()), bodyloom.gait(track))
            bodyloom.export(track, folder / "a.mot", "angles")
            rows = np.loadtxt((folder / "a.mot").read_text().split("endheader\n")[1].splitlines()[1:])
            tilted = bodyloom.joint_angles(track, pelvis_order="tilt-first")
            np.testing.assert_allclose(rows[:, 1:], tilted.values, rtol=0, atol=1e-7)


if __name__ == "__main__":
    unittest.main()
