# SPDX-License-Identifier: Apache-2.0
"""A person from a photo equals the command's; skipped without the recording or the pose detector's networks."""
import pathlib
import subprocess
import tempfile
import unittest

import numpy as np

import bodyloom
from support import SHARED, SOURCE, run_command, tracked

VIDEO = SHARED / "tfjs_pose" / "pose_squats.mp4"
MODELS = SOURCE / "build" / "models"


@unittest.skipUnless(VIDEO.exists() and MODELS.is_dir(), f"{VIDEO} or {MODELS} is not there")
class FromAPhoto(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = pathlib.Path(folder.name)
        cls.photo = cls.folder / "me.png"
        subprocess.run(["ffmpeg", "-v", "error", "-i", VIDEO, "-frames:v", "1", cls.photo], check=True)
        cls.person = bodyloom.Person.from_photos([cls.photo], texture_size=128, models=MODELS)

    def test_it_is_the_command_s(self):
        run_command("animate", "person", "--image", self.photo, "--keep", self.folder / "kept", "--texture-size", "128",
                    "--models", MODELS)
        kept = bodyloom.Person.load(self.folder / "kept")
        np.testing.assert_array_equal(kept.texture, self.person.texture)
        np.testing.assert_array_equal(kept.betas, self.person.betas)
        np.testing.assert_allclose(kept.body.v_template, self.person.body.v_template, atol=1e-5)
        self.person.save(self.folder / "saved")
        self.assertEqual((self.folder / "saved/texture.png").read_bytes(), (self.folder / "kept/texture.png").read_bytes())

    def test_shares_sum_to_one(self):
        self.assertEqual(self.person.texture.shape, (128, 128, 3))
        self.assertAlmostEqual(sum(self.person.shares.values()), 1, places=9)
        self.assertGreater(self.person.shares["seen"], 0.2)

    def test_says_what_it_shows_and_in_what_light(self):
        self.assertEqual(self.person.labels.shape, (128, 128))
        self.assertEqual(set(np.unique(self.person.labels)), set(range(7)))
        self.assertEqual(self.person.light.shape, (3, 9))
        np.testing.assert_array_equal(self.person.light[0], self.person.light[2])
        self.assertGreater(self.person.light[0, 0], 0)

    def test_in_its_own_clothes_it_is_itself(self):
        same = self.person.wearing(self.person)
        np.testing.assert_allclose(same.body.v_template, self.person.body.v_template, atol=1e-6)
        worn = np.isin(self.person.labels, (1, 2, 6))
        difference = np.abs(same.texture.astype(int) - self.person.texture)[worn]
        self.assertLess((difference.max(axis=1) > 3).mean(), 0.05)

    def test_moves_and_is_drawn(self):
        moved = self.person.moved(tracked())
        self.assertEqual(np.abs(moved.betas).max(), 0)
        np.testing.assert_array_equal(moved.poses, tracked().poses)
        own = self.person.moved(tracked(), own_stature=True)
        step = moved.trans - own.trans
        np.testing.assert_allclose(step, np.broadcast_to(step[0], step.shape), atol=1e-9)
        self.assertGreater(np.abs(step).max(), 1e-4)
        picture = bodyloom.render(moved, 0, what="texture", body=self.person.body, texture=self.person.texture)
        self.assertGreater(picture.std(), 10)


    def test_parsing_is_the_command_s(self):
        labels = bodyloom.parse_photo(self.photo, models=MODELS)
        self.assertEqual(set(np.unique(labels)), set(range(7)))
        run_command("parse", self.photo, "--out", self.folder / "labels.png", "--models", MODELS)
        raw = subprocess.run(["ffmpeg", "-v", "error", "-i", self.folder / "labels.png", "-f", "rawvideo", "-pix_fmt", "gray", "-"],
                             check=True, capture_output=True).stdout
        np.testing.assert_array_equal(labels, np.frombuffer(raw, np.uint8).reshape(labels.shape))


class Refusals(unittest.TestCase):
    def test_say_what_is_wrong(self):
        with self.assertRaisesRegex(ValueError, "images: expected at least one photo"):
            bodyloom.Person.from_photos([])
        with self.assertRaisesRegex(RuntimeError, "nothere.jpg"):
            bodyloom.Person.from_photos(["nothere.jpg"])
        with self.assertRaisesRegex(RuntimeError, "body.npz"):
            bodyloom.Person.load("nowhere")
        with self.assertRaisesRegex(RuntimeError, "nothere.jpg"):
            bodyloom.parse_photo("nothere.jpg")


if __name__ == "__main__":
    unittest.main()
