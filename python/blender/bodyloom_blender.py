# SPDX-License-Identifier: Apache-2.0
"""Blender add-on (3.4 or later) that opens what `bodyloom run` and `bodyloom track` write: bodies, camera, video, ground.

Operators, also without a window (`blender --background --python-expr ...`):
  bpy.ops.bodyloom.open_results(filepath=)  a results folder, or one track (.npz)
  bpy.ops.bodyloom.run_video(filepath=, out=)  runs `bodyloom run` on a video and opens the folder
Scene frame 0 is the first frame that shows somebody; z is up, the ground at z = 0, metres. docs/blender.md has the rest.
"""
import json
import math
import pathlib
import shlex
import subprocess
import tempfile
import zipfile

import bpy
import numpy
from bpy.props import EnumProperty, StringProperty
from bpy_extras.io_utils import ImportHelper

bl_info = {
    "name": "Bodyloom",
    "author": "Bodyloom",
    "version": (1, 0, 0),
    "blender": (3, 4, 0),
    "location": "File > Import",
    "description": "Opens people tracked in video: bodies, camera, video, ground",
    "category": "Import-Export",
}

SENSOR_WIDTH_MM = 36.0
GROUND_SIZE_M = 6.0


def preferences():
    return bpy.context.preferences.addons[__name__].preferences


def run_command(words):
    """Runs bodyloom; raises RuntimeError with its line on stderr."""
    try:
        done = subprocess.run([preferences().command, *words], capture_output=True, text=True, check=False)
    except OSError as error:
        raise RuntimeError(f"{preferences().command}: {error.strerror}; set the command in the add-on's preferences") from error
    if done.returncode != 0:
        lines = done.stderr.strip().splitlines() or [f"{preferences().command} {words[0]}: exit code {done.returncode}"]
        raise RuntimeError(lines[-1])


class Track:
    """Camera and times of a track. Raises RuntimeError for a file that is none."""

    def __init__(self, path):
        self.path = path
        try:
            file = numpy.load(path, allow_pickle=False)
        except (OSError, ValueError, EOFError, zipfile.BadZipFile) as error:
            raise RuntimeError(f"{path}: {error}, expected a track of bodyloom") from error
        if not isinstance(file, numpy.lib.npyio.NpzFile):
            raise RuntimeError(f"{path}: one array, expected a track of bodyloom")
        with file as arrays:
            for key in ("trans", "K", "image_size", "timestamps", "mocap_framerate", "camera_model"):
                if key not in arrays:
                    raise RuntimeError(f"{path}: no key '{key}', expected a track of bodyloom")
            self.K = arrays["K"].astype(float)
            self.width, self.height = (int(n) for n in arrays["image_size"])
            self.fps = float(arrays["mocap_framerate"])
            self.is_pinhole = str(arrays["camera_model"]) == "pinhole"
            self.distorts = "distortion" in arrays and bool(numpy.any(arrays["distortion"]))
            seen = numpy.isfinite(arrays["trans"]).all(axis=1)
            self.seconds = arrays["timestamps"][seen]
        if len(self.seconds) == 0:
            raise RuntimeError(f"{path}: every frame is lost, there is nobody to show")


def tracks_in(path):
    """The track files of a results folder, or the one given."""
    if path.is_file():
        return [path]
    people = sorted(path.glob("person_*.npz"), key=lambda p: (len(p.name), p.name))
    found = people or sorted(path.glob("track.npz"))
    if not found:
        raise RuntimeError(f"{path}: no person_0.npz and no track.npz, expected a results folder of bodyloom")
    return found


def video_of(folder):
    """The video that the folder's summary names, or clip.mp4 in it; None without one."""
    names = []
    summary = folder / "summary.json"
    if summary.is_file():
        names.append(json.loads(summary.read_text(encoding="utf-8")).get("video") or "")
    for name in filter(None, [*names, "clip.mp4"]):
        for candidate in (pathlib.Path(name), folder / name, folder.parent / name, folder / pathlib.Path(name).name,
                          folder.parent / pathlib.Path(name).name):
            if candidate.is_file():
                return candidate.resolve()
    return None


def import_bodies(tracks, form, body):
    """Exports the tracks and imports the file; returns the new objects. Its first key lies on frame 0."""
    with tempfile.TemporaryDirectory() as folder:
        out = pathlib.Path(folder) / f"people.{form}"
        words = ["export", "--what", form, "--out", str(out)]
        for track in tracks:
            words += ["--track", str(track.path)]
        textures = [track.path.with_suffix(".png") for track in tracks]
        if all(texture.is_file() for texture in textures):
            for texture in textures:
                words += ["--texture", str(texture)]
        run_command([*words, "--body", body] if body else words)
        before = set(bpy.data.objects)
        if form == "fbx":
            bpy.ops.import_scene.fbx(filepath=str(out), anim_offset=0.0)
        else:
            if "bool" not in vars(numpy):
                numpy.bool = bool  # Blender 3.4's glTF importer names what NumPy 1.24 no longer has
            bpy.ops.import_scene.gltf(filepath=str(out))
        for image in bpy.data.images:
            if image.filepath.startswith(folder) and not image.packed_file:
                image.pack()
    return [thing for thing in bpy.data.objects if thing not in before]


def set_lens(camera, track, render):
    """Focal length and principal point of the track's K; pixels of the video are the picture's."""
    fx, fy, cx, cy = track.K[0, 0], track.K[1, 1], track.K[0, 2], track.K[1, 2]
    render.resolution_x, render.resolution_y, render.resolution_percentage = track.width, track.height, 100
    render.pixel_aspect_x, render.pixel_aspect_y = max(1.0, fy / fx), max(1.0, fx / fy)
    camera.sensor_fit, camera.sensor_width = "HORIZONTAL", SENSOR_WIDTH_MM
    camera.lens = fx / track.width * SENSOR_WIDTH_MM
    # Pixel centres are at integers: the picture's middle is at (width - 1) / 2. Both shifts are in picture widths.
    camera.shift_x = ((track.width - 1) / 2 - cx) / track.width
    camera.shift_y = (cy - (track.height - 1) / 2) / track.width * fx / fy
    camera.clip_start = 0.01


def show_video(camera, video, first_frame):
    """The video behind the camera's picture; scene frame 0 shows the video's frame `first_frame`, counted from 0."""
    clip = bpy.data.movieclips.load(str(video))
    clip.frame_start = -first_frame
    background = camera.background_images.new()
    background.source, background.clip, background.frame_method, background.alpha = "MOVIE_CLIP", clip, "STRETCH", 1.0
    camera.show_background_images = True
    return clip


def add_ground(collection):
    half = GROUND_SIZE_M / 2
    mesh = bpy.data.meshes.new("ground")
    mesh.from_pydata([(-half, -half, 0), (half, -half, 0), (half, half, 0), (-half, half, 0)], [], [(0, 1, 2, 3)])
    collection.objects.link(bpy.data.objects.new("ground", mesh))


def open_results(path, form, body="", video=""):
    """Opens a results folder or a track in the current scene; returns lines on what is missing. Raises RuntimeError."""
    path = pathlib.Path(bpy.path.abspath(path)).resolve()
    tracks = [Track(file) for file in tracks_in(path)]
    start_s = min(track.seconds[0] for track in tracks)
    end_s = max(track.seconds[-1] for track in tracks)
    fps, scene, notes = tracks[0].fps, bpy.context.scene, []
    scene.render.fps, scene.render.fps_base = max(1, round(fps)), max(1, round(fps)) / fps
    new = import_bodies(tracks, form, body)
    scene.render.fps, scene.render.fps_base = max(1, round(fps)), max(1, round(fps)) / fps
    scene.frame_start, scene.frame_end = 0, math.ceil((end_s - start_s) * fps - 1e-6)
    scene.frame_set(0)
    if not any(thing.type == "MESH" and thing.name.startswith("ground") for thing in new):
        add_ground(scene.collection)
    cameras = [thing for thing in new if thing.type == "CAMERA"]
    if not cameras or not tracks[0].is_pinhole:
        return [*notes, "no camera: the track's is of weak perspective, or its image size is not known"]
    scene.camera = cameras[0]
    set_lens(cameras[0].data, tracks[0], scene.render)
    if tracks[0].distorts:
        notes.append("the lens distorts, which Blender's camera does not: the video is a little off at the edges")
    source = pathlib.Path(bpy.path.abspath(video)) if video else video_of(path if path.is_dir() else path.parent)
    if source is None or not source.is_file():
        return [*notes, f"no video: {source} does not exist" if source else "no video beside the track"]
    clip = show_video(cameras[0].data, source, round(start_s * fps))
    if (clip.size[0] > clip.size[1]) != (tracks[0].width > tracks[0].height):
        notes.append("the video is stored turned, which Blender does not undo: turn the camera's background")
    return notes


class BodyloomPreferences(bpy.types.AddonPreferences):
    bl_idname = __name__
    command: StringProperty(name="Command", subtype="FILE_PATH", default="bodyloom", description="The program bodyloom")
    form: EnumProperty(name="Bodies through", default="glb", description="File that bodies come through",
                       items=[("glb", "glTF", "Bones of one scale"), ("fbx", "FBX", "All joints of each vertex")])

    def draw(self, _context):
        self.layout.prop(self, "command")
        self.layout.prop(self, "form")


class BODYLOOM_OT_open_results(bpy.types.Operator, ImportHelper):
    """Open a results folder of bodyloom, or one of its tracks"""
    bl_idname = "bodyloom.open_results"
    bl_label = "Bodyloom results"
    bl_options = {"REGISTER", "UNDO"}
    filename_ext = ".npz"
    filter_glob: StringProperty(default="*.npz", options={"HIDDEN"})
    body: StringProperty(name="Body", subtype="FILE_PATH", description="The tracks' body; empty: the built-in one")
    video: StringProperty(name="Video", subtype="FILE_PATH", description="Empty: the one that the summary names")

    def execute(self, _context):
        try:
            for note in open_results(self.filepath, preferences().form, self.body, self.video):
                self.report({"WARNING"}, note)
        except (RuntimeError, OSError, ValueError) as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        return {"FINISHED"}


class BODYLOOM_OT_run_video(bpy.types.Operator, ImportHelper):
    """Track everybody in a video with bodyloom and open the results"""
    bl_idname = "bodyloom.run_video"
    bl_label = "Track a video with Bodyloom"
    filename_ext = ".mp4"
    filter_glob: StringProperty(default="*.mp4;*.mov;*.mkv;*.avi;*.webm", options={"HIDDEN"})
    out: StringProperty(name="Folder", subtype="DIR_PATH", description="For the results; empty: beside the video")
    options: StringProperty(name="Options", description="Further options of bodyloom run, such as --people 1")

    _process = _timer = _log = None

    def execute(self, context):
        video = pathlib.Path(bpy.path.abspath(self.filepath)).resolve()
        self._folder = bpy.path.abspath(self.out) if self.out else str(video.with_name(video.stem + "_bodyloom"))
        words = ["run", str(video), "--out", self._folder, *shlex.split(self.options)]
        try:
            if bpy.app.background:
                run_command(words)
                return self._open()
            self._log = tempfile.NamedTemporaryFile()
            self._process = subprocess.Popen([preferences().command, *words], stdout=self._log, stderr=self._log)
        except (RuntimeError, OSError) as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        self._timer = context.window_manager.event_timer_add(0.5, window=context.window)
        context.window_manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context, event):
        if event.type == "ESC":
            self._process.terminate()
        if event.type != "TIMER":
            return {"PASS_THROUGH"}
        code = self._process.poll()
        log = pathlib.Path(self._log.name).read_text(encoding="utf-8", errors="replace")
        last = (log.strip().splitlines() or [""])[-1]
        context.workspace.status_text_set(f"Bodyloom (Esc stops it): {last}" if code is None else None)
        if code is None:
            return {"PASS_THROUGH"}
        context.window_manager.event_timer_remove(self._timer)
        self._log.close()
        if code == 0:
            return self._open()
        self.report({"ERROR"}, last or f"bodyloom run: exit code {code}")
        return {"CANCELLED"}

    def _open(self):
        try:
            for note in open_results(self._folder, preferences().form):
                self.report({"WARNING"}, note)
        except (RuntimeError, OSError, ValueError) as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        return {"FINISHED"}


CLASSES = (BodyloomPreferences, BODYLOOM_OT_open_results, BODYLOOM_OT_run_video)


def draw_menu(self, _context):
    self.layout.operator(BODYLOOM_OT_open_results.bl_idname)
    self.layout.operator(BODYLOOM_OT_run_video.bl_idname)


def register():
    for each in CLASSES:
        bpy.utils.register_class(each)
    bpy.types.TOPBAR_MT_file_import.append(draw_menu)


def unregister():
    bpy.types.TOPBAR_MT_file_import.remove(draw_menu)
    for each in reversed(CLASSES):
        bpy.utils.unregister_class(each)
