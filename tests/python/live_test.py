# SPDX-License-Identifier: Apache-2.0
"""The live tracker from Python is that of `bodyloom track --live`."""
import unittest

import numpy as np

import bodyloom
from support import clip


class Live(unittest.TestCase):
    def run_live(self, keypoints, **arguments):
        tracker = bodyloom.LiveTracker(keypoints.names, **arguments)
        frames = []
        for time, points in zip(keypoints.timestamps, keypoints.points):
            frame = tracker.push(time, points)
            if frame is not None:
                frames.append(frame)
        return frames + tracker.finish()

    def test_poses_are_those_of_track(self):
        keypoints, truth = clip()
        for arguments, same in ((dict(camera=truth.camera), dict(camera=truth.camera)),
                                (dict(image_size=(320, 240)), dict()),
                                (dict(image_size=(320, 240), weak=True), dict(camera_model="weak"))):
            with self.subTest(**arguments):
                frames = self.run_live(keypoints, **arguments)
                track = bodyloom.track(keypoints, live_lag=4, **same)
                self.assertEqual(len(frames), 40)
                self.assertEqual([frame.index for frame in frames], list(range(40)))
                np.testing.assert_allclose([frame.poses for frame in frames], track.poses, atol=1e-9)
                status = [bodyloom.FRAME_STATUS[code] for code in track.frame_status]
                self.assertEqual([frame.status for frame in frames], status)
                if "weak" not in arguments:
                    np.testing.assert_allclose([frame.trans for frame in frames], track.trans, atol=1e-9)

    def test_a_frame(self):
        keypoints, truth = clip()
        frame = self.run_live(keypoints, camera=truth.camera)[20]
        self.assertEqual(frame.rotations.shape, (24, 3, 3))
        self.assertEqual(frame.joints.shape, (24, 3))
        self.assertEqual(frame.joint_sigma.shape, (24,))
        self.assertEqual(frame.camera.width, 320)
        self.assertFalse(frame.cut_before)
        self.assertEqual(frame.timestamp, keypoints.timestamps[20])
        self.assertLess(np.linalg.norm(frame.joints - truth.joints[20], axis=1).max(), 0.3)
        body = bodyloom.Body.builtin()
        np.testing.assert_allclose(
            frame.joints, body.joints(frame.poses[None], frame.betas, frame.trans[None])[0], atol=1e-9)

    def test_nothing_seen(self):
        keypoints, _ = clip()
        tracker = bodyloom.LiveTracker(keypoints.names, image_size=(320, 240), lag=0)
        frame = tracker.push(0.0)
        self.assertEqual(frame.status, "lost")
        self.assertTrue(np.isnan(frame.poses).all() and np.isnan(frame.joints).all())
        for t in range(3):
            frame = tracker.push(1.0 + keypoints.timestamps[t], keypoints.points[t])
        self.assertEqual(frame.status, "tracked")


if __name__ == "__main__":
    unittest.main()
