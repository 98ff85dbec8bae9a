# SPDX-License-Identifier: Apache-2.0
"""Projects points through a Blender camera, beside a track's own camera matrix."""
import bpy_extras.object_utils
import mathutils
import numpy


def projection_error_px(scene, camera, track_file, frame, world_points):
    """Largest distance, pixels, between joints of a frame of a track (J×3, Blender's world) as Blender's camera sees them, and
    their projections by K from the camera frame that the track holds."""
    with numpy.load(track_file) as track:
        K, (width, height) = track["K"], track["image_size"]
        in_camera = track["joints"][frame]
        if "camera_from_scene" in track:
            pose = track["camera_from_scene"][frame]
            in_camera = in_camera @ pose[:3, :3].T + pose[:3, 3]
    truth = in_camera @ K.T
    truth = truth[:, :2] / truth[:, 2:]
    scene.render.resolution_x, scene.render.resolution_y = int(width), int(height)
    worst = 0.0
    for point, pixel in zip(world_points, truth):
        view = bpy_extras.object_utils.world_to_camera_view(scene, camera, mathutils.Vector(point))
        # The view is in [0, 1] from the picture's lower left corner; pixel centres are at integers.
        seen = numpy.array([view.x * width - 0.5, (1 - view.y) * height - 0.5])
        worst = max(worst, float(numpy.linalg.norm(seen - pixel)))
    return worst
