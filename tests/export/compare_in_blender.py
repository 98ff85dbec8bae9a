# SPDX-License-Identifier: Apache-2.0
"""Opens an exported glTF or BVH in Blender, poses it at several frames, and compares the glTF's vertices, or the heads of the BVH's
bones, with what `bodyloom export --what vertices|joints --axes world` writes; draws a picture of the glTF from the side.

usage: blender --background --factory-startup --python-exit-code 1 --python compare_in_blender.py -- GLB|BVH TRUTH.npy FPS LIMIT_MM [PICTURE.png]

The writer knows nothing of Blender, and Blender nothing of the body. UV seams double vertices, so distances are to the nearest
vertex, in both directions; bones have other names than our joints, so each is compared with the nearest one.

exit 0: no vertex further off than LIMIT_MM at any frame looked at; 1: further, or the file does not open.
"""
import builtins
import sys

import bpy
import mathutils
import numpy

numpy.bool = bool  # Debian 12's add-on for glTF names what Debian 12's NumPy no longer has


def posed_vertices(body):
    """Where Blender puts the mesh's vertices now, in its own axes (z up)."""
    evaluated = body.evaluated_get(bpy.context.evaluated_depsgraph_get())
    mesh = evaluated.to_mesh()
    points = numpy.empty(3 * len(mesh.vertices))
    mesh.vertices.foreach_get("co", points)
    matrix = numpy.array(evaluated.matrix_world)
    evaluated.to_mesh_clear()
    return points.reshape(-1, 3) @ matrix[:3, :3].T + matrix[:3, 3]


def furthest(from_points, to_points):
    """Distance to the nearest of `to_points`, the largest over all `from_points`."""
    tree = mathutils.kdtree.KDTree(len(to_points))
    for index, point in enumerate(to_points):
        tree.insert(point, index)
    tree.balance()
    return max(tree.find(point)[2] for point in from_points)


def draw(body, picture):
    """The body from its side, 4 m away, by Blender's path tracer, which needs no display."""
    scene = bpy.context.scene
    centre = posed_vertices(body).mean(axis=0)
    camera = bpy.data.objects.new("side", bpy.data.cameras.new("side"))
    scene.collection.objects.link(camera)
    camera.location = centre + numpy.array([4.0, 0.0, 0.4])
    camera.rotation_euler = (numpy.pi / 2 - 0.1, 0, numpy.pi / 2)
    scene.camera = camera
    scene.world = bpy.data.worlds.new("light")
    scene.world.color = (0.4, 0.4, 0.4)
    sun = bpy.data.objects.new("sun", bpy.data.lights.new("sun", "SUN"))
    sun.data.energy = 2
    sun.rotation_euler = (0.5, 0.6, 0)
    scene.collection.objects.link(sun)
    scene.render.engine, scene.cycles.samples, scene.cycles.use_denoising = "CYCLES", 32, False
    scene.render.resolution_x, scene.render.resolution_y = 640, 640
    scene.render.filepath = picture
    bpy.ops.render.render(write_still=True)


def only(objects, what):
    if len(objects) != 1:
        sys.exit(f"{len(objects)} {what}, expected 1")
    return objects[0]


def open_gltf(path):
    """A function that gives the two distances to the true vertices, and the body."""
    bpy.ops.import_scene.gltf(filepath=path)
    objects = bpy.context.scene.objects
    only([o for o in objects if o.type == "CAMERA"], "cameras")
    body = only([o for o in objects if o.type == "MESH" and any(m.type == "ARMATURE" for m in o.modifiers)], "skinned meshes")

    def distance(truth):
        points = posed_vertices(body)
        return max(furthest(points, truth), furthest(truth, points))
    return distance, body


def open_bvh(path):
    """A function that gives the distance of the bones' heads to the true joints."""
    import io_anim_bvh.import_bvh as add_on
    add_on.open = lambda name, mode: builtins.open(name, "r")  # a mode that Debian 12's Python no longer has
    bpy.ops.import_anim.bvh(filepath=path, global_scale=0.01)
    skeleton = only([o for o in bpy.context.scene.objects if o.type == "ARMATURE"], "skeletons")
    return (lambda truth: furthest([skeleton.matrix_world @ bone.head for bone in skeleton.pose.bones], truth)), skeleton


def main():
    path, truth_file, fps, limit, *picture = sys.argv[sys.argv.index("--") + 1:]
    truth = numpy.load(truth_file)[:, :, [0, 2, 1]] * [1, -1, 1]  # y up -> z up
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    scene.render.fps, scene.render.fps_base = round(float(fps)), round(float(fps)) / float(fps)
    is_bvh = path.endswith(".bvh")
    distance, shown = open_bvh(path) if is_bvh else open_gltf(path)
    first = 1 if is_bvh else 0  # where the importers put the first frame
    worst = 0.0
    for frame in sorted({0, len(truth) // 3, 2 * len(truth) // 3, len(truth) - 1}):
        scene.frame_set(first + frame)
        worst = max(worst, 1000 * distance(truth[frame]))
    if picture:
        draw(shown, picture[0])
    print(f"judge: {path}: at most {worst:.3f} mm off (limit {limit})")
    if worst > float(limit):
        sys.exit(1)


if __name__ == "__main__":
    main()
