# SPDX-License-Identifier: Apache-2.0
"""Installs the add-on in Blender, opens results with it, and judges picture, camera, video and ground.

usage: blender --background --factory-startup --python-exit-code 1 --python addon_in_blender.py -- JSON
JSON: the request of blender_addon_test.py.
"""
import json
import pathlib
import sys

import bpy
import numpy

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from compare_in_blender import only  # noqa: E402
from project_in_blender import projection_error_px  # noqa: E402

PERCENT, MIN_IOU = 50, 0.95


def check(good, text):
    if not good:
        sys.exit(f"Error: {text}")


def camera_of(scene):
    return only([o for o in scene.objects if o.type == "CAMERA"], "cameras")


def empty_scene():
    for thing in list(bpy.data.objects):
        bpy.data.objects.remove(thing)
    for clip in list(bpy.data.movieclips):
        bpy.data.movieclips.remove(clip)


def silhouette(scene, file):
    """True where the picture has something, rows from the top."""
    scene.render.filepath = file
    bpy.ops.render.render(write_still=True)
    image = bpy.data.images.load(file)
    width, height = image.size
    pixels = numpy.empty(4 * width * height, dtype=numpy.float32)
    image.pixels.foreach_get(pixels)
    return pixels.reshape(height, width, 4)[::-1, :, 3] > 0.5


def judge_silhouettes(scene, form):
    scene.render.engine, scene.cycles.samples, scene.cycles.use_denoising = "CYCLES", 4, False
    scene.render.film_transparent, scene.render.resolution_percentage = True, PERCENT
    scene.render.image_settings.file_format, scene.render.image_settings.color_mode = "PNG", "RGBA"
    for thing in scene.objects:
        thing.hide_render = thing.type == "MESH" and not any(m.type == "ARMATURE" for m in thing.modifiers)
    truth = numpy.load("silhouettes.npy")
    check(len(truth) == scene.frame_end + 1, f"{scene.frame_end + 1} frames, expected {len(truth)}")
    worst = 1.0
    for frame in (0, len(truth) // 2, len(truth) - 1):
        scene.frame_set(frame)
        seen = silhouette(scene, f"{form}_{frame}.png")
        step = 100 // PERCENT
        height, width = (step * (n // step) for n in truth[frame].shape)
        shown = truth[frame][:height, :width].reshape(height // step, step, width // step, step).mean(axis=(1, 3)) >= 0.5
        check(seen.shape == shown.shape, f"picture {seen.shape}, expected {shown.shape}")
        worst = min(worst, float((seen & shown).sum() / (seen | shown).sum()))
    print(f"judge: through {form}: silhouettes agree with the overlay's to IoU {worst:.4f} (limit {MIN_IOU})")
    check(worst >= MIN_IOU, "silhouettes differ")


def judge_moved_track(scene, request):
    empty_scene()
    bpy.ops.bodyloom.open_results(filepath="moved.npz", video="results/clip.mp4")
    with numpy.load("moved.npz") as track:
        joints, start = track["joints"], track["world_from_camera"]
    check(only(list(bpy.data.movieclips), "clips").frame_start == -request["lost"], "the video is not in step")
    check(scene.frame_end == request["frames"] - request["lost"] - 1, f"last frame {scene.frame_end}")
    worst = 0.0
    for frame in (0, scene.frame_end):
        scene.frame_set(frame)
        world = joints[frame + request["lost"]] @ start[:3, :3].T + start[:3, 3]
        worst = max(worst, projection_error_px(scene, camera_of(scene), "moved.npz", frame + request["lost"],
                                               world[:, [0, 2, 1]] * [1, -1, 1]))
    print(f"judge: principal point moved, pixels not square: {worst:.4f} px off")
    check(worst < 0.05, "the camera is another")


def fails(operator, text, **arguments):
    try:
        operator(**arguments)
    except RuntimeError as error:
        check(text in str(error), f"'{error}', expected '{text}'")
        return
    sys.exit(f"Error: no failure with '{text}'")


def main():
    request = json.loads(sys.argv[sys.argv.index("--") + 1])
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.preferences.addon_install(filepath=request["add_on"])
    bpy.ops.preferences.addon_enable(module="bodyloom_blender")
    preferences = bpy.context.preferences.addons["bodyloom_blender"].preferences
    preferences.command = request["command"]
    for form in ("glb", "fbx"):
        empty_scene()
        preferences.form = form
        bpy.ops.bodyloom.open_results(filepath="results")
        scene = bpy.context.scene
        check(abs(scene.render.fps / scene.render.fps_base - 30) < 1e-3, "frame rate")
        clip = only(list(bpy.data.movieclips), "clips")
        check(clip.frame_start == 0 and clip.frame_duration == request["frames"], f"video from {clip.frame_start}")
        check(camera_of(scene).data.background_images[0].clip == clip, "no background")
        check(scene.camera == camera_of(scene) and "ground" in scene.objects, "no camera or ground")
        judge_silhouettes(scene, form)
    judge_moved_track(scene, request)
    empty_scene()
    bpy.ops.bodyloom.run_video(filepath="results/clip.mp4", out="run")
    check(any(o.type == "ARMATURE" for o in scene.objects) and len(bpy.data.movieclips) == 1, "the run was not opened")
    fails(bpy.ops.bodyloom.run_video, "no such file", filepath="none.mp4", out="other")
    fails(bpy.ops.bodyloom.open_results, "expected a results folder", filepath="scripts")
    for garbage in (b"", b"no track", b"PK\x03\x04 and no more"):
        pathlib.Path("garbage.npz").write_bytes(garbage)
        fails(bpy.ops.bodyloom.open_results, "garbage.npz", filepath="garbage.npz")
    fails(bpy.ops.bodyloom.open_results, "one array", filepath="silhouettes.npy")
    fails(bpy.ops.bodyloom.open_results, "no key", filepath="results/observations.npz")
    preferences.command = "/nowhere/bodyloom"
    fails(bpy.ops.bodyloom.open_results, "preferences", filepath="results")
    print("judge: add-on: results, moved track, run and failures as they must be")


main()
