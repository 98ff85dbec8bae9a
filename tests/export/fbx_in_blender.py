# SPDX-License-Identifier: Apache-2.0
"""Opens an exported FBX in Blender and compares it with what `bodyloom export --what joints|vertices --axes world` writes.

usage: blender --background --factory-startup --python-exit-code 1 --python fbx_in_blender.py -- JSON
JSON: the request of fbx_test.py. exit 0: names, rest pose, frame rate, joints, surface and camera are as they must be.
"""
import json
import math
import pathlib
import sys

import bpy
import numpy

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from compare_in_blender import furthest, only, posed_vertices  # noqa: E402
from project_in_blender import projection_error_px  # noqa: E402

LEFT_SHOULDER, LEFT_WRIST = 16, 20


def check(good, text):
    if not good:
        sys.exit(f"Error: {text}")


def main():
    request = json.loads(sys.argv[sys.argv.index("--") + 1])
    joints = numpy.load(request["joints"])[:, :, [0, 2, 1]] * [1, -1, 1]  # y up -> z up
    vertices = numpy.load(request["vertices"])[:, :, [0, 2, 1]] * [1, -1, 1]
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    bpy.ops.import_scene.fbx(filepath=request["fbx"])
    check(abs(scene.render.fps / scene.render.fps_base - request["fps"]) < 1e-3, "frame rate")
    armatures = [o for o in scene.objects if o.type == "ARMATURE"]
    meshes = [o for o in scene.objects if o.type == "MESH" and any(m.type == "ARMATURE" for m in o.modifiers)]
    camera = only([o for o in scene.objects if o.type == "CAMERA"], "cameras")
    check(len(armatures) == 2 and len(meshes) == 2, f"{len(armatures)} armatures and {len(meshes)} skinned meshes, expected 2")
    for armature in armatures:
        bones = armature.data.bones
        check(not set(request["names"]) - set(bones.keys()), f"bones {sorted(bones.keys())}")
        rest = [armature.matrix_world @ bones[name].head_local for name in request["names"]]
        arm = rest[LEFT_WRIST] - rest[LEFT_SHOULDER]
        down_deg = math.degrees(math.atan2(-arm.z, arm.x))
        check(abs(down_deg - request["arm_down_deg"]) < 3, f"arm {down_deg:.1f} deg down at rest")
        check(len(bones) == joints.shape[1], f"{len(bones)} bones, expected {joints.shape[1]}")
    off, surface, pixels = 0.0, 0.0, 0.0
    for frame in sorted({0, len(joints) // 3, 2 * len(joints) // 3, len(joints) - 1}):
        scene.frame_set(1 + frame)  # where the importer puts the first frame
        for armature in armatures:
            for j, name in enumerate(request["names"]):
                head = numpy.array(armature.matrix_world @ armature.pose.bones[name].head)
                off = max(off, 1000 * float(numpy.linalg.norm(head - joints[frame, j])))
        for mesh in meshes:
            points = posed_vertices(mesh)
            check(len(points) == vertices.shape[1], f"{len(points)} vertices, expected {vertices.shape[1]}")
            surface = max(surface, 1000 * max(furthest(points, vertices[frame]), furthest(vertices[frame], points)))
        pixels = max(pixels, projection_error_px(scene, camera, request["track"], frame, joints[frame]))
    print(f"judge: {request['fbx']}: joints at most {off:.4f} mm off, surface {surface:.3f} mm, camera {pixels:.3f} px")
    check(off <= request["joint_limit_mm"] and surface <= request["surface_limit_mm"] and pixels < 0.1, "too far off")


main()
