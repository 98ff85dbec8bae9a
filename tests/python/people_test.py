# SPDX-License-Identifier: Apache-2.0
"""People in a video are those of the command; skipped without the recording or the pose detector's networks."""
import pathlib
import tempfile
import unittest

import numpy as np

import bodyloom
from support import SHARED, SOURCE, run_command

VIDEO = SHARED / "pose2sim" / "two_people" / "cam01.mp4"
MODELS = SOURCE / "build" / "models"
SPAN = {"begin_s": 0.5, "end_s": 0.6, "detector": "full", "models": MODELS}


@unittest.skipUnless(VIDEO.exists() and MODELS.is_dir(), f"{VIDEO} or {MODELS} is not there")
class TwoPeople(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = pathlib.Path(folder.name)
        run_command("run", VIDEO, "--out", cls.folder / "command", "--no-overlay", "--min-seconds", "0.05", "--from", "0.5",
                    "--to", "0.6", "--detector", "full", "--models", MODELS)

    def test_run_in_memory_and_in_files(self):
        tracks = bodyloom.run(VIDEO, min_seconds=0.05, **SPAN)
        self.assertEqual(len(tracks), 2)
        self.assertIn("person 1", repr(tracks[1]))
        files = bodyloom.run(VIDEO, out=self.folder / "module", overlay=False, masks=True, min_seconds=0.05, **SPAN)
        self.assertTrue((self.folder / "module" / "mask_1.npz").exists())
        self.assertFalse((self.folder / "module" / "overlay.mp4").exists())
        for i in range(2):
            written = bodyloom.Track.load(self.folder / "command" / f"person_{i}.npz")
            for track in (tracks[i], files[i]):
                np.testing.assert_array_equal(track.poses, written.poses)
                self.assertGreater(track.summary.focal_px, 0)
        self.assertEqual(tracks[0].camera.K[0, 0], tracks[1].camera.K[0, 0])

    def test_run_leaves_the_body_as_it_is_without_hands(self):
        usual = bodyloom.run(VIDEO, min_seconds=0.05, **SPAN)
        without = bodyloom.run(VIDEO, hands="off", min_seconds=0.05, **SPAN)
        self.assertEqual(len(usual), len(without))
        for a, b in zip(usual, without):
            self.assertEqual(b.poses.shape[1], 72)
            np.testing.assert_array_equal(a.trans, b.trans)
            np.testing.assert_array_equal(a.poses[:, :45], b.poses[:, :45])
        with self.assertRaisesRegex(ValueError, "off, auto or on"):
            bodyloom.run(VIDEO, hands="yes")

    def test_detect_gives_everybody_s_landmarks(self):
        people = bodyloom.detect(VIDEO, **SPAN)
        self.assertEqual(len(people), 2)
        for i, person in enumerate(people):
            written = bodyloom.Keypoints.load(self.folder / "command" / "detections.npz", person=i)
            np.testing.assert_array_equal(person.points, written.points)
            np.testing.assert_array_equal(person.timestamps, written.timestamps)
        track = bodyloom.track(people[1])
        self.assertEqual(len(track), len(people[1]))

    def test_hands_and_faces_are_those_of_the_command(self):
        out = self.folder / "hands.npz"
        run_command("detect", "--video", VIDEO, "--hands", "on", "--from", "0.5", "--to", "0.6", "--detector", "full",
                    "--models", MODELS, "--out", out)
        people = bodyloom.detect(VIDEO, hands="on", **SPAN)
        found = 0
        for i, person in enumerate(people):
            written = bodyloom.Keypoints.load(out, person=i)
            self.assertIs(type(person), type(written))
            if not isinstance(person, bodyloom.PersonKeypoints):
                continue
            found += np.count_nonzero(person.hands[:, :, 0, 2])
            frames = len(person)
            for name, shape in (("hands", (2, 21, 3)), ("hand_sigma_px", (2, 21)), ("hand_metres", (2, 21, 3)),
                                ("face", (68, 3)), ("face_sigma_px", ()), ("face_depth_px", (68,))):
                self.assertEqual(getattr(person, name).shape, (frames, *shape))
                np.testing.assert_array_equal(getattr(person, name), getattr(written, name))
        self.assertGreater(found, 0)
        for person in bodyloom.detect(VIDEO, hands="off", **SPAN):
            self.assertIs(type(person), bodyloom.Keypoints)

    def test_a_progress_function_ends_it(self):
        with self.assertRaises(bodyloom.Cancelled):
            bodyloom.run(VIDEO, progress=lambda stage, fraction: False, **SPAN)


class Refusals(unittest.TestCase):
    def test_say_what_is_wrong(self):
        with self.assertRaisesRegex(RuntimeError, "nothere.mp4"):
            bodyloom.run("nothere.mp4")
        with self.assertRaisesRegex(RuntimeError, "nothere.mp4"):
            bodyloom.detect("nothere.mp4")
        with self.assertRaisesRegex(ValueError, "expected out"):
            bodyloom.run("nothere.mp4", report=True)
        with self.assertRaisesRegex(ValueError, "lite, full or heavy"):
            bodyloom.detect("nothere.mp4", detector="huge")
        with self.assertRaisesRegex(ValueError, "off, auto or on"):
            bodyloom.detect("nothere.mp4", hands="yes")
        with self.assertRaisesRegex(ValueError, "both choose"):
            bodyloom.run("nothere.mp4", person=0, people=2)


if __name__ == "__main__":
    unittest.main()
