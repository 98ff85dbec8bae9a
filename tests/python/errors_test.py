# SPDX-License-Identifier: Apache-2.0
"""Invalid arguments are rejected in one line that names them; garbage files raise and never crash."""
import pathlib
import random
import tempfile
import unittest

import numpy as np

import bodyloom
from support import clip, tracked

GOOD = np.ones((2, 17, 3))


class Arguments(unittest.TestCase):
    def expect(self, error, text, call, *arguments, **keywords):
        with self.assertRaises(error) as raised:
            call(*arguments, **keywords)
        self.assertEqual(str(raised.exception), text)

    def test_arrays_by_shape(self):
        body = bodyloom.Body.builtin()
        self.expect(ValueError, "points: expected numbers of shape (T, 17, 3), found shape (2, 16, 3)",
                    bodyloom.Keypoints, GOOD[:, :16])
        self.expect(ValueError, "points: expected numbers of shape (T, 25, 3), found shape (2, 17, 3)",
                    bodyloom.Keypoints, GOOD, names="body25")
        self.expect(ValueError, "points: expected numbers of shape (T, 17, 3), found shape ()", bodyloom.Keypoints, 3.0)
        self.expect(ValueError, "timestamps: expected numbers of shape (2,), found shape (3,)",
                    bodyloom.Keypoints, GOOD, timestamps=[0, 1, 2])
        self.expect(ValueError, "poses: expected numbers of shape (T, 3J), found shape (72,)", body.vertices, np.zeros(72))
        self.expect(ValueError, "poses: expected numbers of shape (T, 72) or fewer joints, found shape (1, 75)",
                    body.vertices, np.zeros((1, 75)))
        self.expect(ValueError, "trans: expected numbers of shape (4, 3), found shape (3, 3)",
                    body.vertices, np.zeros((4, 72)), trans=np.zeros((3, 3)))
        self.expect(ValueError, "betas: expected at most 10 shape components, found 11",
                    body.vertices, np.zeros((1, 72)), np.zeros(11))
        self.expect(ValueError, "vertices: entry 1 is 7874, expected a vertex from 0 to 7873",
                    body.vertices, np.zeros((1, 72)), vertices=[0, 7874])
        tracker = bodyloom.LiveTracker(image_size=(320, 240))
        self.expect(ValueError, "keypoints: expected numbers of shape (17, 3), found shape (17, 2)",
                    tracker.push, 0.0, np.zeros((17, 2)))
        self.expect(ValueError, "background: expected shape (240, 320, 3), found shape (3, 4, 3)",
                    bodyloom.Renderer(tracked()).image, 0, background=np.zeros((3, 4, 3), np.uint8))

    def test_arrays_by_type(self):
        self.expect(TypeError, "points: expected numbers of shape (T, 17, 3), found complex128",
                    bodyloom.Keypoints, GOOD * 1j)
        self.expect(TypeError, "points: expected numbers of shape (T, 17, 3), found str", bodyloom.Keypoints, "nose")
        self.expect(TypeError, "points: expected numbers of shape (T, 17, 3), found list that makes no array",
                    bodyloom.Keypoints, [[1, 2], [3]])
        self.expect(TypeError, "background: expected uint8 of shape (H, W, 3) (red, green, blue), found float64",
                    bodyloom.Renderer(tracked()).image, 0, background=np.zeros((240, 320, 3)))
        frames = bodyloom.DescriptorFrames(tracked(), size=16, past=0)
        self.expect(TypeError,
                    "out: expected a writable float32 array of shape (3, 16, 16) in C order, found another kind of array",
                    frames.planes, 0, np.zeros((3, 16, 16)))
        read_only = np.zeros((3, 16, 16), np.float32)
        read_only.flags.writeable = False
        self.expect(ValueError, "out: expected a writable float32 array of shape (3, 16, 16) in C order, found shape "
                    "(3, 16, 16) that is read-only", frames.planes, 0, read_only)

    def test_values(self):
        self.expect(ValueError, "timestamps: entry 1 is 0, expected finite seconds that grow",
                    bodyloom.Keypoints, GOOD, timestamps=[0, 0])
        self.expect(ValueError, 'names: "nose" stands there twice', bodyloom.Keypoints, GOOD, names=["nose"] * 17)
        self.expect(ValueError, 'names: "coco18", expected a list of landmarks or one of coco17, body25, body25b, '
                    "openpose_coco18, coco_wholebody23, halpe26, mediapipe33, human36m17", bodyloom.Keypoints, GOOD, names="coco18")
        self.expect(ValueError, "expected focal_px or K, and not both", bodyloom.Camera, 640, 480)
        self.expect(ValueError, "focal_px: expected pixels above 0, found -5", bodyloom.Camera, 640, 480, focal_px=-5)
        self.expect(ValueError, "expected camera or image_size, and not both", bodyloom.LiveTracker)
        self.expect(ValueError, "frame 40 is outside the track's 40 frames", bodyloom.Renderer(tracked()).image, 40)
        self.expect(ValueError, "frame -1 is outside the track's 40 frames", tracked().camera_at, -1)
        self.expect(ValueError, "frames: expected (begin, end) within (0, 40), found (5, 50)",
                    bodyloom.render, tracked(), (5, 50))
        with self.assertRaises(IndexError):
            bodyloom.DescriptorFrames(tracked(), size=16)[40]

    def test_requests(self):
        keypoints, truth = clip()
        for error, text, keywords in (
            (ValueError, "--cameras and --focal both give the focal length", dict(camera=truth.camera, focal_px=300)),
            (ValueError, "focal_px: expected a number above 0, found 0", dict(focal_px=0)),
            (ValueError, "threads: expected 0 to 256, found -1", dict(threads=-1)),
            (ValueError, 'camera_model: "fisheye", expected pinhole', dict(camera_model="fisheye")),
            (ValueError, "engine|solver", dict(solver="simplex")),
            (ValueError, "person, fps and convention are of a file", dict(fps=25)),
            (ValueError, "max_iterations", dict(max_iterations=-1)),
            (RuntimeError, "body.pkl", dict(body="/nowhere/body.pkl")),
            (RuntimeError, "keypoints: made for images of 320x240, the camera is for 100x100",
             dict(camera=bodyloom.Camera(100, 100, focal_px=90))),
        ):
            with self.subTest(**keywords):
                with self.assertRaisesRegex(error, text) as raised:
                    bodyloom.track(keypoints, **keywords)
                self.assertNotIn("\n", str(raised.exception))
        with self.assertRaisesRegex(ValueError, "--video is required"):
            bodyloom.track()
        with self.assertRaisesRegex(ValueError, 'velocity "fast", expected one of'):
            bodyloom.describe(tracked(), velocity="fast")
        with self.assertRaisesRegex(ValueError, "a UV map of 0x0 texels"):
            bodyloom.describe(tracked(), size=0)
        with self.assertRaisesRegex(ValueError, "truth: goes with"):
            bodyloom.Renderer(tracked(), "error")
        with self.assertRaisesRegex(ValueError, "is not a form of a track"):
            bodyloom.export(tracked(), "/tmp/never", "usd")

    def test_messages_are_the_command_s(self):
        keypoints, _ = clip()
        unknown = bodyloom.Keypoints(keypoints.points, names=keypoints.names)
        with self.assertRaisesRegex(RuntimeError, "^keypoints: does not say how large the images are; "):
            bodyloom.track(unknown)

    def test_a_refused_push_changes_nothing(self):
        keypoints, _ = clip()
        first, second = (bodyloom.LiveTracker(keypoints.names, image_size=(320, 240), lag=1) for _ in range(2))
        for t in range(6):
            a = first.push(keypoints.timestamps[t], keypoints.points[t])
            b = second.push(keypoints.timestamps[t], keypoints.points[t])
            with self.assertRaises(ValueError):
                second.push(keypoints.timestamps[t], keypoints.points[t])  # time does not grow
        np.testing.assert_array_equal(a.rotations, b.rotations)

    def test_arrays_of_a_track(self):
        arrays = tracked().to_arrays()
        for name, value in (("poses", np.zeros((40, 70))), ("trans", np.zeros((39, 3))), ("K", np.zeros((2, 2))),
                            ("timestamps", np.zeros(40)), ("frame_status", np.full(40, 9, np.uint8))):
            with self.subTest(name=name):
                with self.assertRaisesRegex(ValueError, f"^arrays: .*{name}"):
                    bodyloom.Track.from_arrays(**{**arrays, name: value})


class Garbage(unittest.TestCase):
    """Bytes of files, changed, cut off and made up."""

    def loaders(self):
        return (bodyloom.Keypoints.load, bodyloom.Camera.load, bodyloom.Body.load, bodyloom.Track.load,
                lambda path: bodyloom.track(path, image_size=(320, 240)), bodyloom.evaluate, bodyloom.describe)

    def test_garbage(self):
        rng = random.Random(1)
        with tempfile.TemporaryDirectory() as folder:
            good = pathlib.Path(folder, "good.npz")
            tracked().save(good)
            bytes_of_good = good.read_bytes()
            pieces = [b"", b"\0", b"PK\x03\x04", b"\x80\x02", b"{", b"[" * 100000, b"\x93NUMPY", rng.randbytes(4000)]
            for _ in range(20):
                piece = bytearray(bytes_of_good[:rng.randrange(len(bytes_of_good))])
                for _ in range(rng.randrange(5)):
                    piece[rng.randrange(len(piece))] = rng.randrange(256)
                pieces.append(bytes(piece))
            count = 0
            for number, piece in enumerate(pieces):
                for extension in ("npz", "json", "pkl"):
                    path = pathlib.Path(folder, f"piece_{number}.{extension}")
                    path.write_bytes(piece)
                    for load in self.loaders():
                        with self.assertRaises((ValueError, RuntimeError)) as raised:
                            load(path)
                        self.assertNotIn("\n", str(raised.exception))
                        count += 1
            self.assertEqual(count, 28 * 3 * 7)

    def test_missing(self):
        for load in self.loaders():
            with self.assertRaisesRegex((ValueError, RuntimeError), "/nowhere/at_all.npz"):
                load("/nowhere/at_all.npz")

    def test_no_place_to_write(self):
        with self.assertRaisesRegex(RuntimeError, "^/nowhere/track.npz: "):
            tracked().save("/nowhere/track.npz")
        with self.assertRaisesRegex(RuntimeError, "^/nowhere/maps.npy: "):
            bodyloom.describe(tracked(), out="/nowhere/maps.npy")
        with self.assertRaisesRegex(RuntimeError, "^/nowhere/motion.bvh: "):
            bodyloom.export(tracked(), "/nowhere/motion.bvh", "bvh")


if __name__ == "__main__":
    unittest.main()
