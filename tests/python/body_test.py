# SPDX-License-Identifier: Apache-2.0
"""The body's surface and joints equal the command's; cameras project as computed in NumPy."""
import pathlib
import tempfile
import unittest

import numpy as np

import bodyloom
from support import run_command, tracked


class Bodies(unittest.TestCase):
    def test_vertices_are_the_command_s(self):
        track = tracked()
        body = bodyloom.Body.builtin()
        vertices = body.vertices(track.poses, track.betas, track.trans)
        self.assertEqual(vertices.shape, (40, 7874, 3))
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder)
            track.save(folder / "track.npz")
            run_command("export", "--track", folder / "track.npz", "--what", "vertices", "--out", folder / "v.npy")
            exported = np.load(folder / "v.npy")
        np.testing.assert_allclose(vertices, exported, rtol=0, atol=1e-6)

    def test_hands(self):
        hands = bodyloom.Body.builtin(hands=True)
        self.assertEqual((hands.num_joints, hands.num_vertices, hands.name), (52, 7874, "bodyloom_hands"))
        self.assertEqual(hands.joint_names[22], "l_index1")
        self.assertIn("right_thumb_tip", hands.landmark_names)
        track = tracked()
        same = hands.vertices(track.poses[:, :66], track.betas, track.trans)
        without = bodyloom.Body.builtin().vertices(track.poses[:, :66], track.betas, track.trans)
        np.testing.assert_allclose(same, without, rtol=0, atol=1e-6)

    def test_joints_are_the_track_s(self):
        track = tracked()
        joints = bodyloom.Body.builtin().joints(track.poses, track.betas, track.trans)
        np.testing.assert_allclose(joints, track.joints, rtol=0, atol=1e-9)

    def test_rest_pose(self):
        body = bodyloom.Body.builtin()
        at_rest = body.vertices(np.zeros((1, 72)))
        np.testing.assert_allclose(at_rest[0], body.v_template, rtol=0, atol=1e-6)
        shaped = body.vertices(np.zeros((1, 72)), betas=[0, 2.0])
        np.testing.assert_allclose(shaped[0], body.v_template + 2 * body.shapedirs[:, :, 1], rtol=0, atol=1e-6)
        moved = body.vertices(np.zeros((1, 3)), trans=[[1, 2, 3]])
        np.testing.assert_allclose(moved[0], body.v_template + [1, 2, 3], rtol=0, atol=1e-6)

    def test_some_vertices_any_threads(self):
        track = tracked()
        body = bodyloom.Body.builtin()
        all_of_them = body.vertices(track.poses, track.betas, track.trans, threads=1)
        np.testing.assert_array_equal(body.vertices(track.poses, track.betas, track.trans, threads=3), all_of_them)
        chosen = [7000, 3, 3]
        np.testing.assert_array_equal(
            body.vertices(track.poses, track.betas, track.trans, vertices=chosen), all_of_them[:, chosen])

    def test_a_lost_frame_is_nan(self):
        poses = np.zeros((3, 72))
        poses[1, 5] = np.nan
        vertices = bodyloom.Body.builtin().vertices(poses)
        self.assertTrue(np.isnan(vertices[1]).all())
        self.assertTrue(np.isfinite(vertices[[0, 2]]).all())

    def test_what_a_body_has(self):
        body = bodyloom.Body.builtin()
        self.assertEqual((body.name, body.num_joints, body.num_betas), ("bodyloom", 24, 10))
        self.assertEqual(body.joint_names[0], "pelvis")
        self.assertEqual(body.parents[0], -1)
        self.assertEqual(body.faces.shape, (15744, 3))
        self.assertEqual(body.ft.shape, (15744, 3))
        self.assertIn("left_heel", body.landmark_names)
        np.testing.assert_allclose(body.joints(np.zeros((1, 72)))[0], body.rest_joints, atol=1e-12)


class Cameras(unittest.TestCase):
    def test_projection(self):
        camera = bodyloom.Camera(640, 480, K=[[500, 0, 320], [0, 510, 240], [0, 0, 1]])
        points = np.array([[0.1, -0.2, 2], [1, 1, 4], [0, 0, -1]])
        pixels = camera.project(points)
        homogeneous = points @ camera.K.T
        np.testing.assert_allclose(pixels[:2], homogeneous[:2, :2] / homogeneous[:2, 2:])
        self.assertTrue(np.isnan(pixels[2]).all())
        np.testing.assert_allclose(camera.unproject(pixels[:2]), points[:2, :2] / points[:2, 2:])

    def test_distortion_there_and_back(self):
        camera = bodyloom.Camera(640, 480, K=[[500, 0, 320], [0, 500, 240], [0, 0, 1]], distortion=[-0.2, 0.05, 1e-3, 0])
        rays = np.array([[0.2, 0.1], [-0.3, 0.2]])
        pixels = camera.project(np.c_[rays, np.ones(2)])
        np.testing.assert_allclose(camera.unproject(pixels), rays, atol=1e-10)
        np.testing.assert_array_equal(camera.distortion, [-0.2, 0.05, 1e-3, 0, 0, 0, 0, 0])

    def test_a_centred_camera(self):
        camera = bodyloom.Camera(640, 480, focal_px=700)
        self.assertEqual((camera.width, camera.height, camera.model), (640, 480, "pinhole"))
        np.testing.assert_array_equal(camera.K, [[700, 0, 319.5], [0, 700, 239.5], [0, 0, 1]])


if __name__ == "__main__":
    unittest.main()
