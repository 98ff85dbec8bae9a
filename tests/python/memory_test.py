# SPDX-License-Identifier: Apache-2.0
"""Arrays are read-only views of the module's memory: nothing is copied, and the memory outlives the views."""
import gc
import unittest
import weakref

import numpy as np

import bodyloom
from support import clip, tracked


def address(array):
    return array.__array_interface__["data"][0]


class Views(unittest.TestCase):
    def views(self):
        """(owner, name of the property) of every view there is."""
        keypoints, _ = clip()
        track = tracked()
        body = bodyloom.Body.builtin()
        tracker = bodyloom.LiveTracker(keypoints.names, image_size=keypoints.image_size, lag=0)
        frame = tracker.push(0.0, keypoints.points[0])
        for name in ("points", "timestamps"):
            yield keypoints, name
        for name in ("poses", "trans", "betas", "timestamps", "frame_status", "joints", "coco17", "joint_sigma"):
            yield track, name
        yield track.summary, "frame_px"
        for name in ("parents", "v_template", "shapedirs", "faces", "vt", "ft", "rest_joints"):
            yield body, name
        for name in ("rotations", "trans", "betas", "joint_sigma"):
            yield frame, name

    def test_no_copy(self):
        for owner, name in self.views():
            with self.subTest(owner=type(owner).__name__, name=name):
                first, second = getattr(owner, name), getattr(owner, name)
                self.assertIsNot(first, second)
                self.assertEqual(address(first), address(second))
                self.assertTrue(np.shares_memory(first, second))
                self.assertIs(first.base, owner)
                self.assertFalse(first.flags.owndata)

    def test_read_only(self):
        for owner, name in self.views():
            with self.subTest(owner=type(owner).__name__, name=name):
                array = getattr(owner, name)
                with self.assertRaises(ValueError):
                    array[...] = 0
                with self.assertRaises(ValueError):
                    array.flags.writeable = True

    def test_views_outlive_their_parents(self):
        track = bodyloom.track(clip()[0], max_iterations=2)
        expected = track.joints.copy()
        joints, frame_px = track.joints, track.summary.frame_px
        expected_px = frame_px.copy()
        del track
        for _ in range(3):
            gc.collect()
            bodyloom.synthetic_clip(20)  # other memory is taken and given back
        np.testing.assert_array_equal(joints, expected)
        np.testing.assert_array_equal(frame_px, expected_px)

    def test_memory_goes_with_the_last_view(self):
        keypoints, _ = bodyloom.synthetic_clip(5)
        points = keypoints.points
        alive = weakref.ref(points)
        del keypoints, points
        gc.collect()
        self.assertIsNone(alive())

    def test_rotations_are_those_of_the_pose(self):
        keypoints, _ = clip()
        tracker = bodyloom.LiveTracker(keypoints.names, image_size=keypoints.image_size, lag=0)
        frame = tracker.push(0.0, keypoints.points[0])
        angle = np.linalg.norm(frame.poses.reshape(-1, 3), axis=1)
        trace = np.trace(frame.rotations, axis1=1, axis2=2)
        np.testing.assert_allclose(np.cos(angle), (trace - 1) / 2, atol=1e-9)
        # Axis-angle's skew part is that of the matrix: rows and columns are not exchanged.
        axis = np.stack([frame.rotations[:, 2, 1] - frame.rotations[:, 1, 2],
                         frame.rotations[:, 0, 2] - frame.rotations[:, 2, 0],
                         frame.rotations[:, 1, 0] - frame.rotations[:, 0, 1]], axis=1)
        np.testing.assert_allclose(axis * angle[:, None], 2 * np.sin(angle)[:, None] * frame.poses.reshape(-1, 3), atol=1e-9)

    def test_input_is_not_kept(self):
        points = np.ones((2, 17, 3), np.float32)
        keypoints = bodyloom.Keypoints(points)
        points[...] = 5
        self.assertTrue((keypoints.points == 1).all())


class Maps(unittest.TestCase):
    def test_maps_go_into_the_caller_s_memory(self):
        frames = bodyloom.DescriptorFrames(tracked(), size=32)
        out = np.empty(frames.shape, np.float32)
        self.assertIs(frames.planes(3, out), out)
        np.testing.assert_array_equal(out, frames[3])

    def test_pictures_own_their_memory(self):
        picture = bodyloom.render(tracked(), 3)
        self.assertEqual(picture.dtype, np.uint8)
        self.assertTrue(picture.flags.c_contiguous and picture.flags.writeable)
        kept = picture.copy()
        gc.collect()
        bodyloom.render(tracked(), 4)
        np.testing.assert_array_equal(picture, kept)


if __name__ == "__main__":
    unittest.main()
