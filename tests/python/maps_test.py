# SPDX-License-Identifier: Apache-2.0
"""Descriptors and images equal the command's."""
import pathlib
import tempfile
import unittest

import numpy as np

import bodyloom
from support import clip, run_command, tracked


class Folder(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        tracked().save(self.folder / "track.npz")


class Descriptors(Folder):
    def test_whole_and_frame_by_frame_are_the_command_s(self):
        for arguments, words in (
            (dict(), ()),
            (dict(velocity="backward", frame="world", past=2, weighting="angle"),
             ("--velocity", "backward", "--frame", "world", "--past", "2", "--normals", "angle")),
            (dict(frame="body", normals=False, past=3), ("--frame", "body", "--channels", "velocity", "--past", "3")),
            (dict(seen_only=True, gutter=0), ("--seen-only", "--gutter", "0")),
        ):
            with self.subTest(words=words):
                run_command("describe", "--track", self.folder / "track.npz", "--size", "48", *words, "--out",
                            self.folder / "maps.npy")
                expected = np.load(self.folder / "maps.npy")
                whole = bodyloom.describe(tracked(), size=48, **arguments)
                np.testing.assert_array_equal(whole, expected)
                frames = bodyloom.DescriptorFrames(self.folder / "track.npz", size=48, **arguments)
                self.assertEqual(frames.shape, expected.shape[1:])
                np.testing.assert_array_equal(np.stack(list(frames)), expected)
                np.testing.assert_array_equal(frames[-1], expected[-1])

    def test_to_a_file(self):
        run_command("describe", "--track", self.folder / "track.npz", "--size", "48", "--dtype", "f16", "--every", "3",
                    "--out", self.folder / "command.npy")
        maps = bodyloom.describe(tracked(), out=self.folder / "python.npy", size=48, half=True, every=3)
        self.assertIsInstance(maps, np.memmap)
        self.assertEqual(maps.dtype, np.float16)
        self.assertEqual((self.folder / "python.npy").read_bytes(), (self.folder / "command.npy").read_bytes())
        self.assertEqual((self.folder / "python.json").read_bytes(), (self.folder / "command.json").read_bytes())
        self.assertEqual(bodyloom.describe(tracked(), size=48, every=3).shape, maps.shape)

    def test_live(self):
        track = tracked()
        live = bodyloom.LiveDescriptors(size=48, past=2)
        backward = bodyloom.describe(track, size=48, past=2, velocity="backward")
        for t in range(6):
            planes = live.push(track.timestamps[t], track.poses[t], track.trans[t], track.betas)
            if t > 1:  # the first frame of a run looks forward in a file, and has no velocity here
                np.testing.assert_allclose(planes, backward[t], atol=1e-4)
        self.assertFalse(live.push(track.timestamps[6]).any())
        with self.assertRaisesRegex(ValueError, "time"):
            live.push(0.0, track.poses[0])


class Pictures(Folder):
    def test_pictures_are_the_command_s(self):
        track = bodyloom.Track.load(self.folder / "track.npz")  # the sheet's title has the file's name
        for what in ("overlay", "iuv", "parts", "normal", "depth"):
            for name in ("sheet.png", "arrays.npz"):
                with self.subTest(what=what, name=name):
                    run_command("render", "--track", self.folder / "track.npz", "--what", what, "--frames", "5:8", "--out",
                                self.folder / name)
                    expected = (self.folder / name).read_bytes()
                    (self.folder / name).unlink()
                    self.assertIsNone(bodyloom.render(track, (5, 8), out=self.folder / name, what=what))
                    self.assertEqual((self.folder / name).read_bytes(), expected)

    def test_in_memory_and_in_a_file(self):
        bodyloom.render(tracked(), (3, 6), out=self.folder / "pictures.npz")
        with np.load(self.folder / "pictures.npz") as arrays:
            pictures = next(array for array in (arrays[name] for name in arrays.files) if array.ndim == 4)
        in_memory = bodyloom.render(tracked(), (3, 6))
        self.assertEqual(in_memory.shape, (3, 240, 320, 3))
        np.testing.assert_array_equal(in_memory, pictures)
        np.testing.assert_array_equal(bodyloom.render(tracked(), 4), in_memory[1])

    def test_colours_are_red_green_blue(self):
        red = np.zeros((240, 320, 3), np.uint8)
        red[..., 0] = 255
        picture = bodyloom.Renderer(tracked(), "normal").image(5, background=red)
        np.testing.assert_array_equal(picture[0, 0], [255, 0, 0])

    def test_views(self):
        renderer = bodyloom.Renderer(tracked(), view_yaw_deg=90)
        self.assertEqual((len(renderer), renderer.width, renderer.height), (40, 320, 240))
        side = renderer.image(5)
        self.assertTrue((side != bodyloom.render(tracked(), 5)).any())
        self.assertTrue((side != renderer.image(5, turn_deg=90)).any())

    def test_error_colours(self):
        _, truth = clip()
        renderer = bodyloom.Renderer(tracked(), "error", truth=truth)
        self.assertIn("mm", renderer.legend)
        self.assertEqual(renderer.image(5).shape, (240, 320, 3))

    def test_texture_as_array_and_as_file(self):
        bodyloom.render(tracked(), 5, out=self.folder / "any.png")
        by_file = bodyloom.render(tracked(), 5, what="texture", texture=self.folder / "any.png")
        red = np.zeros((16, 16, 3), np.uint8)
        red[..., 0] = 200
        by_array = bodyloom.render(tracked(), 5, what="texture", texture=red)
        self.assertTrue((by_file != by_array).any())
        body = (by_array != by_array[0, 0]).any(axis=2)
        self.assertGreater(by_array[body][:, 0].mean(), by_array[body][:, 2].mean() + 50)


if __name__ == "__main__":
    unittest.main()
