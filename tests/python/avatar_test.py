# SPDX-License-Identifier: Apache-2.0
"""A Gaussian avatar is trained, rendered and written as by the command."""
import pathlib
import subprocess
import tempfile
import unittest

import numpy as np

import bodyloom
from support import run_command

SIZE = 96


def rgba(png):
    raw = subprocess.run(["ffmpeg", "-v", "error", "-i", png, "-f", "rawvideo", "-pix_fmt", "rgba", "-"], check=True,
                         capture_output=True).stdout
    return np.frombuffer(raw, np.uint8).reshape(SIZE, SIZE, 4)


class Learned(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = pathlib.Path(folder.name)
        cls.person = cls.folder / "person"
        run_command("synth-person", "--motion", "demo", "--frames", "5", "--size", str(SIZE), "--out", cls.person)
        cls.track = bodyloom.Track.load(cls.person / "track.npz")
        cls.avatar = bodyloom.Avatar.train(cls.person, out=cls.folder / "run", steps=4, garment=False, threads=1)

    def test_it_is_the_command_s(self):
        run_command("train", "avatar", "--data", self.person, "--out", self.folder / "command", "--steps", "4", "--without",
                    "garment")
        self.assertEqual((self.folder / "command/avatar.npz").read_bytes(), (self.folder / "run/avatar.npz").read_bytes())
        self.assertGreater(self.avatar.gaussians, 1000)
        self.assertFalse(self.avatar.has_garment)
        self.assertIn("Gaussians", repr(bodyloom.Avatar.load(self.folder / "run/avatar.npz")))

    def test_shown_in_memory_and_in_files(self):
        run_command("animate", "avatar", "--run", self.folder / "run", "--track", self.person / "track.npz", "--view-yaw", "30",
                    "--pictures", self.folder / "command_pictures")
        self.avatar.animate(self.track, pictures=self.folder / "pictures", view_yaw="30")
        shown = self.avatar.show(self.track, view_yaw="30")
        self.assertEqual((len(shown), shown.width, shown.height), (5, SIZE, SIZE))
        for t in (3, 0):
            picture = shown.image(t)
            self.assertEqual(picture.shape, (SIZE, SIZE, 4))
            self.assertGreater((picture[..., 3] > 127).mean(), 0.02)
            seen = picture[..., 3] > 0
            for folder in ("pictures", "command_pictures"):
                written = rgba(self.folder / folder / f"{t:06d}.png")
                np.testing.assert_array_equal(picture[..., 3], written[..., 3])
                np.testing.assert_array_equal(picture[seen], written[seen])

    def test_training_that_was_ended_goes_on(self):
        with self.assertRaises(bodyloom.Cancelled):
            bodyloom.Avatar.train(self.person, out=self.folder / "ended", steps=4, garment=False,
                                  progress=lambda stage, fraction: fraction < 0.4)
        avatar = bodyloom.Avatar.train(self.person, out=self.folder / "ended", steps=4, garment=False, resume=True)
        self.assertEqual(avatar.gaussians, self.avatar.gaussians)

    def test_refusals(self):
        with self.assertRaisesRegex(RuntimeError, "nothere"):
            bodyloom.Avatar.load("nothere")
        with self.assertRaisesRegex(ValueError, "nothing is to be written"):
            self.avatar.animate(self.track)
        with self.assertRaisesRegex(ValueError, "outside the motion's 5 frames"):
            self.avatar.show(self.track).image(5)
        with self.assertRaisesRegex(ValueError, "view-yaw"):
            self.avatar.show(self.track, view_yaw="aside")
        with self.assertRaisesRegex(ValueError, "steps"):
            bodyloom.Avatar.train(self.person, out=self.folder / "none", steps=0)


if __name__ == "__main__":
    unittest.main()
