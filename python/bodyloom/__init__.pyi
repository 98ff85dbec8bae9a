# SPDX-License-Identifier: Apache-2.0
# Types of the package; the docstrings are in the module (help(bodyloom.track)), the manual is docs/python.md.
# tests/python/stub_test.py holds this file and the module to each other.
import os
from collections.abc import Callable, Sequence
from typing import Any, Final, Literal, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

__all__ = [
    "FRAME_STATUS",
    "Avatar",
    "Body",
    "Camera",
    "Cancelled",
    "DescriptorFrames",
    "Evaluation",
    "JointAngles",
    "Keypoints",
    "LiveDescriptors",
    "LiveFrame",
    "LiveTracker",
    "Person",
    "PersonKeypoints",
    "Renderer",
    "RigCamera",
    "ShownAvatar",
    "Track",
    "TrackSummary",
    "__version__",
    "describe",
    "detect",
    "evaluate",
    "export",
    "gait",
    "joint_angles",
    "parse_photo",
    "read_rig",
    "render",
    "run",
    "synthetic_clip",
    "track",
    "track_views",
    "write_rig",
]

_Path = str | os.PathLike[str]
_Progress = Callable[[str, float], bool | None]
_Doubles = NDArray[np.float64]
_Floats = NDArray[np.float32]
_Images = NDArray[np.uint8]
_Status = Literal["tracked", "weak", "interpolated", "lost"]
_Velocity = Literal["savgol", "central", "backward", "analytic"]
_Axes = Literal["camera", "world", "body"]
_Weighting = Literal["area", "angle"]
_Network = Literal["lite", "full", "heavy"]
_What = Literal["overlay", "iuv", "parts", "normal", "depth", "texture", "error"]

__version__: Final[str]
FRAME_STATUS: Final[tuple[str, str, str, str]]

class Cancelled(RuntimeError): ...

class Keypoints:
    def __init__(
        self,
        points: ArrayLike,
        *,
        names: str | Sequence[str] = "coco17",
        timestamps: ArrayLike | None = None,
        fps: float = 30.0,
        image_size: tuple[int, int] = (0, 0),
    ) -> None: ...
    @staticmethod
    def load(
        path: _Path,
        *,
        view: str = "",
        person: int = 0,
        fps: float | None = None,
        image_size: tuple[int, int] | None = None,
        min_confidence: float = 0.0,
        convention: str = "",
    ) -> Keypoints: ...
    def save(self, path: _Path) -> None: ...
    @property
    def points(self) -> _Floats: ...
    @property
    def timestamps(self) -> _Doubles: ...
    @property
    def names(self) -> list[str]: ...
    @property
    def convention(self) -> str: ...
    @property
    def image_size(self) -> tuple[int, int]: ...
    def __len__(self) -> int: ...

class PersonKeypoints(Keypoints):
    @property
    def hands(self) -> _Floats: ...
    @property
    def hand_sigma_px(self) -> _Floats: ...
    @property
    def hand_metres(self) -> _Floats: ...
    @property
    def face(self) -> _Floats: ...
    @property
    def face_sigma_px(self) -> _Floats: ...
    @property
    def face_depth_px(self) -> _Floats: ...

class Camera:
    def __init__(
        self,
        width: int,
        height: int,
        *,
        focal_px: float | None = None,
        K: ArrayLike | None = None,
        distortion: ArrayLike | None = None,
    ) -> None: ...
    @staticmethod
    def load(path: _Path, *, view: str = "", sequence: str = "") -> Camera: ...
    def project(self, points: ArrayLike) -> _Doubles: ...
    def unproject(self, pixels: ArrayLike) -> _Doubles: ...
    @property
    def model(self) -> Literal["pinhole", "weak"]: ...
    @property
    def width(self) -> int: ...
    @property
    def height(self) -> int: ...
    @property
    def K(self) -> _Doubles: ...
    @property
    def distortion(self) -> _Doubles: ...
    @property
    def weak(self) -> tuple[float, float, float]: ...

class RigCamera:
    def __init__(
        self,
        name: str,
        camera: Camera,
        camera_from_rig: ArrayLike | None = None,
        *,
        offset_s: float = 0.0,
        rate: float = 0.0,
        middle_s: float = 0.0,
        rotation_sigma_rad: float = 0.0,
        translation_sigma_m: float = 0.0,
        focal_log_sigma: float = 0.0,
        offset_sigma_s: float = 0.0,
        rate_sigma: float = 0.0,
    ) -> None: ...
    def time_at(self, first_s: float) -> float: ...
    def first_time_at(self, own_s: float) -> float: ...
    @property
    def name(self) -> str: ...
    @property
    def camera(self) -> Camera: ...
    @property
    def camera_from_rig(self) -> _Doubles: ...
    @property
    def offset_s(self) -> float: ...
    @property
    def rate(self) -> float: ...
    @property
    def middle_s(self) -> float: ...
    @property
    def rotation_sigma_rad(self) -> float: ...
    @property
    def translation_sigma_m(self) -> float: ...
    @property
    def focal_log_sigma(self) -> float: ...
    @property
    def offset_sigma_s(self) -> float: ...
    @property
    def rate_sigma(self) -> float: ...

class Body:
    @staticmethod
    def builtin(*, hands: bool = False) -> Body: ...
    @staticmethod
    def load(path: _Path, *, max_betas: int = 0, flat_hand_mean: bool = False) -> Body: ...
    def vertices(
        self,
        poses: ArrayLike,
        betas: ArrayLike | None = None,
        trans: ArrayLike | None = None,
        *,
        vertices: ArrayLike | None = None,
        threads: int = 0,
    ) -> _Doubles: ...
    def joints(
        self, poses: ArrayLike, betas: ArrayLike | None = None, trans: ArrayLike | None = None
    ) -> _Doubles: ...
    @property
    def name(self) -> str: ...
    @property
    def num_vertices(self) -> int: ...
    @property
    def num_joints(self) -> int: ...
    @property
    def num_betas(self) -> int: ...
    @property
    def joint_names(self) -> list[str]: ...
    @property
    def landmark_names(self) -> list[str]: ...
    @property
    def parents(self) -> NDArray[np.int32]: ...
    @property
    def v_template(self) -> _Doubles: ...
    @property
    def shapedirs(self) -> _Floats: ...
    @property
    def faces(self) -> NDArray[np.int32]: ...
    @property
    def vt(self) -> _Floats: ...
    @property
    def ft(self) -> NDArray[np.int32]: ...
    @property
    def rest_joints(self) -> _Doubles: ...

class TrackSummary:
    @property
    def status(self) -> str: ...
    @property
    def message(self) -> str: ...
    @property
    def solver(self) -> str: ...
    @property
    def iterations(self) -> int: ...
    @property
    def initial_cost(self) -> float: ...
    @property
    def final_cost(self) -> float: ...
    @property
    def cost_by_term(self) -> dict[str, float]: ...
    @property
    def num_observations(self) -> int: ...
    @property
    def frames_by_status(self) -> dict[str, int]: ...
    @property
    def reprojection_median_px(self) -> float: ...
    @property
    def reprojection_p95_px(self) -> float: ...
    @property
    def dense_median_px(self) -> float: ...
    @property
    def frame_px(self) -> _Doubles: ...
    @property
    def focal_px(self) -> float: ...
    @property
    def focal_log_sigma(self) -> float: ...
    @property
    def stature_m(self) -> float: ...
    @property
    def num_swaps_repaired(self) -> int: ...
    @property
    def seconds(self) -> dict[str, float]: ...
    @property
    def plan(self) -> list[tuple[str, bool, str]]: ...

class Track:
    @staticmethod
    def load(path: _Path) -> Track: ...
    @staticmethod
    def from_arrays(**kwargs: Any) -> Track: ...
    def to_arrays(self) -> dict[str, Any]: ...
    def save(self, path: _Path) -> None: ...
    @property
    def poses(self) -> _Doubles: ...
    @property
    def trans(self) -> _Doubles: ...
    @property
    def betas(self) -> _Doubles: ...
    @property
    def timestamps(self) -> _Doubles: ...
    @property
    def frame_status(self) -> NDArray[np.uint8]: ...
    @property
    def joints(self) -> _Doubles: ...
    @property
    def coco17(self) -> _Doubles: ...
    @property
    def joint_sigma(self) -> _Doubles: ...
    @property
    def root_sigma(self) -> _Doubles: ...
    @property
    def camera(self) -> Camera: ...
    def camera_at(self, frame: int) -> Camera: ...
    @property
    def world_from_camera(self) -> _Doubles | None: ...
    @property
    def world_source(self) -> str: ...
    @property
    def world_level(self) -> _Doubles: ...
    @property
    def body(self) -> str: ...
    @property
    def summary(self) -> TrackSummary | None: ...
    def __len__(self) -> int: ...

class LiveFrame:
    @property
    def index(self) -> int: ...
    @property
    def timestamp(self) -> float: ...
    @property
    def status(self) -> _Status: ...
    @property
    def cut_before(self) -> bool: ...
    @property
    def poses(self) -> _Doubles: ...
    @property
    def rotations(self) -> _Doubles: ...
    @property
    def trans(self) -> _Doubles: ...
    @property
    def joints(self) -> _Doubles: ...
    @property
    def betas(self) -> _Doubles: ...
    @property
    def joint_sigma(self) -> _Doubles: ...
    @property
    def root_sigma(self) -> float: ...
    @property
    def camera(self) -> Camera: ...

class LiveTracker:
    def __init__(
        self,
        names: str | Sequence[str] = "coco17",
        *,
        camera: Camera | None = None,
        image_size: tuple[int, int] | None = None,
        weak: bool = False,
        body: Body | _Path | None = None,
        lag: int = 4,
        iterations: int = 2,
        threads: int = 0,
        prior: bool = True,
        lifter: bool = True,
        estimate_shape: bool = True,
        uncertainty: bool = True,
    ) -> None: ...
    def push(self, timestamp: float, keypoints: ArrayLike | None = None) -> LiveFrame | None: ...
    def finish(self) -> list[LiveFrame]: ...

class DescriptorFrames:
    def __init__(
        self,
        track: Track | _Path,
        *,
        body: Body | _Path | None = None,
        size: int = 128,
        past: int = 10,
        normals: bool = True,
        velocity: _Velocity = "savgol",
        frame: _Axes = "camera",
        weighting: _Weighting = "area",
        seen_only: bool = False,
        gutter: int = 1,
        threads: int = 0,
    ) -> None: ...
    @property
    def shape(self) -> tuple[int, int, int]: ...
    def has_fit(self, frame: int) -> bool: ...
    def planes(self, frame: int, out: _Floats | None = None) -> _Floats: ...
    def __len__(self) -> int: ...
    def __getitem__(self, frame: int) -> _Floats: ...

class LiveDescriptors:
    def __init__(
        self,
        *,
        body: Body | _Path | None = None,
        size: int = 128,
        past: int = 10,
        normals: bool = True,
        weighting: _Weighting = "area",
        gutter: int = 1,
    ) -> None: ...
    def push(
        self,
        timestamp: float,
        poses: ArrayLike | None = None,
        trans: ArrayLike | None = None,
        betas: ArrayLike | None = None,
    ) -> _Floats: ...

class Renderer:
    def __init__(
        self,
        track: Track | _Path,
        what: _What = "overlay",
        *,
        body: Body | _Path | None = None,
        view_yaw_deg: float | None = None,
        texture: _Images | _Path | None = None,
        truth: Track | _Path | None = None,
        error_maximum: float | None = None,
        threads: int = 0,
    ) -> None: ...
    def image(self, frame: int, *, background: _Images | None = None, turn_deg: float = 0.0) -> _Images: ...
    @property
    def width(self) -> int: ...
    @property
    def height(self) -> int: ...
    @property
    def legend(self) -> str: ...
    def __len__(self) -> int: ...

class Person:
    @staticmethod
    def from_photos(
        images: Sequence[_Path],
        *,
        who: int = 0,
        texture_size: int = 1024,
        body: _Path | None = None,
        focal_px: float | None = None,
        stature_m: float | None = None,
        models: _Path | None = None,
        loose_garment: bool = True,
        progress: _Progress | None = None,
    ) -> Person: ...
    @staticmethod
    def load(folder: _Path, *, body: _Path | None = None) -> Person: ...
    def save(self, folder: _Path) -> None: ...
    def moved(self, track: Track | _Path, *, own_stature: bool = False) -> Track: ...
    def wearing(self, other: Person) -> Person: ...
    @property
    def body(self) -> Body: ...
    @property
    def texture(self) -> _Images: ...
    @property
    def labels(self) -> _Images: ...
    @property
    def light(self) -> _Doubles: ...
    @property
    def betas(self) -> _Doubles: ...
    @property
    def shares(self) -> dict[str, float]: ...

class ShownAvatar:
    def image(self, frame: int) -> _Images: ...
    @property
    def width(self) -> int: ...
    @property
    def height(self) -> int: ...
    def __len__(self) -> int: ...

class Avatar:
    @staticmethod
    def train(
        data: _Path,
        *,
        out: _Path,
        track: _Path | None = None,
        mask: _Path | None = None,
        body: _Path | None = None,
        steps: int = 6000,
        minutes: float | None = None,
        seed: int = 1,
        garment: bool = True,
        all_steps: bool = False,
        refine: bool = False,
        refined_track: _Path | None = None,
        resume: bool = False,
        threads: int = 0,
        progress: _Progress | None = None,
    ) -> Avatar: ...
    @staticmethod
    def load(run: _Path, *, body: _Path | None = None) -> Avatar: ...
    def show(
        self,
        track: Track | _Path,
        *,
        view_yaw: str = "",
        freeze: str = "",
        size: int | None = None,
        keep_shape: bool = False,
        threads: int = 0,
        progress: _Progress | None = None,
    ) -> ShownAvatar: ...
    def animate(
        self,
        track: Track | _Path,
        *,
        out: _Path | None = None,
        pictures: _Path | None = None,
        report: _Path | None = None,
        ply: _Path | None = None,
        background: _Path | None = None,
        view_yaw: str = "",
        freeze: str = "",
        size: int | None = None,
        keep_shape: bool = False,
        threads: int = 0,
        progress: _Progress | None = None,
    ) -> None: ...
    @property
    def gaussians(self) -> int: ...
    @property
    def has_garment(self) -> bool: ...
    @property
    def betas(self) -> _Doubles: ...

class Evaluation:
    @property
    def protocol(self) -> str: ...
    @property
    def description(self) -> str: ...
    @property
    def frames(self) -> int: ...
    @property
    def frames_without_result(self) -> int: ...
    @property
    def values(self) -> dict[str, float]: ...
    @property
    def meanings(self) -> dict[str, str]: ...
    @property
    def breakdowns(self) -> dict[str, dict[str, float]]: ...
    def __getitem__(self, name: str) -> float: ...

class JointAngles:
    @property
    def names(self) -> list[str]: ...
    @property
    def timestamps(self) -> _Doubles: ...
    @property
    def values(self) -> _Doubles: ...
    @property
    def sigma_deg(self) -> _Doubles: ...
    def __getitem__(self, name: str) -> _Doubles: ...

def track(
    keypoints: Keypoints | _Path | None = None,
    *,
    dense: _Path | None = None,
    dense_uv_sigma: float | None = None,
    part_labels: _Path | None = None,
    video: _Path | None = None,
    view: str = "",
    person: int = 0,
    fps: float | None = None,
    min_confidence: float = 0.0,
    convention: str = "",
    camera: Camera | _Path | None = None,
    focal_px: float | None = None,
    focal_35mm: float | None = None,
    camera_model: Literal["pinhole", "unknown-focal", "weak"] | None = None,
    image_size: tuple[int, int] | None = None,
    still: bool = False,
    camera_path_out: _Path | None = None,
    body: Body | _Path | None = None,
    stature_m: float | None = None,
    init: _Path | None = None,
    init_weight: float = 0.1,
    prior: _Path | None = None,
    lifter: _Path | None = None,
    live_lag: int | None = None,
    solver: Literal["chain+ceres", "chain", "ceres"] = "chain+ceres",
    threads: int = 0,
    max_iterations: int = 50,
    estimate_shape: bool = True,
    uncertainty: bool = True,
    ground: bool = True,
    skip_unneeded: bool = True,
    rendered_weight: float = 1.0,
    velocity_weight: float = 0.0,
    straight_knees: float | None = None,
    detector: _Network = "heavy",
    pose_model: _Path | None = None,
    box_model: _Path | None = None,
    models: _Path | None = None,
    detect_rate: float | None = None,
    mask: bool = True,
    begin_s: float = 0.0,
    end_s: float | None = None,
    rotate: int | Literal["auto"] = 0,
    captured_fps: float | None = None,
    hands: Literal["auto", "on", "off"] | None = None,
    progress: _Progress | None = None,
) -> Track: ...
def track_views(
    keypoints: Sequence[Keypoints | _Path] | _Path,
    *,
    views: Sequence[str] = [],
    cameras: Sequence[RigCamera] | _Path | None = None,
    known: Literal["intrinsics", "poses", "clocks"] = "clocks",
    same_lens: bool = False,
    image_size: tuple[int, int] | None = None,
    fps: float | None = None,
    focal_px: float | None = None,
    focal_35mm: float | None = None,
    min_confidence: float = 0.0,
    convention: str = "",
    body: _Path | None = None,
    stature_m: float | None = None,
    prior: _Path | None = None,
    lifter: _Path | None = None,
    solver: Literal["chain+ceres", "chain", "ceres"] = "chain+ceres",
    threads: int = 0,
    max_iterations: int = 50,
    estimate_shape: bool = True,
    uncertainty: bool = True,
    ground: bool = True,
    progress: _Progress | None = None,
) -> tuple[Track, list[RigCamera]]: ...
def read_rig(path: _Path) -> list[RigCamera]: ...
def write_rig(path: _Path, rig: Sequence[RigCamera]) -> None: ...
def run(
    video: _Path | Sequence[_Path],
    *,
    out: _Path | None = None,
    people: int = 0,
    person: int | None = None,
    min_seconds: float = 0.5,
    fps: float | None = None,
    min_confidence: float = 0.0,
    view: str = "",
    known: Literal["intrinsics", "poses", "clocks"] = "clocks",
    same_lens: bool = False,
    camera: Camera | _Path | None = None,
    focal_px: float | None = None,
    focal_35mm: float | None = None,
    still: bool = False,
    camera_path_out: _Path | None = None,
    body: Body | _Path | None = None,
    stature_m: float | None = None,
    prior: _Path | None = None,
    lifter: _Path | None = None,
    detector: _Network = "heavy",
    pose_model: _Path | None = None,
    box_model: _Path | None = None,
    models: _Path | None = None,
    detect_rate: float | None = None,
    mask: bool = True,
    begin_s: float = 0.0,
    end_s: float | None = None,
    rotate: int | Literal["auto"] = 0,
    captured_fps: float | None = None,
    hands: Literal["auto", "on", "off"] | None = None,
    solver: Literal["chain+ceres", "chain", "ceres"] = "chain+ceres",
    threads: int = 0,
    uncertainty: bool = True,
    ground: bool = True,
    overlay: bool = True,
    side_view: bool = False,
    masks: bool = False,
    coarse_masks: bool = False,
    report: bool = False,
    progress: _Progress | None = None,
) -> list[Track]: ...
def detect(
    video: _Path,
    *,
    fps: float | None = None,
    detector: _Network = "heavy",
    pose_model: _Path | None = None,
    box_model: _Path | None = None,
    models: _Path | None = None,
    hands: Literal["auto", "on", "off"] = "auto",
    people: int = 0,
    detect_rate: float | None = None,
    begin_s: float = 0.0,
    end_s: float | None = None,
    rotate: int | Literal["auto"] = 0,
    captured_fps: float | None = None,
    threads: int = 0,
    progress: _Progress | None = None,
) -> list[Keypoints]: ...
def parse_photo(
    image: _Path,
    *,
    weights: str = "builtin",
    who: int = 0,
    body: _Path | None = None,
    focal_px: float | None = None,
    stature_m: float | None = None,
    models: _Path | None = None,
    progress: _Progress | None = None,
) -> _Images: ...

def synthetic_clip(
    frames: int = 180,
    *,
    fps: float = 30.0,
    image_size: tuple[int, int] = (960, 720),
    seed: int = 1,
    elevation_deg: float = 8.0,
) -> tuple[Keypoints, Track]: ...
@overload
def describe(
    track: Track | _Path,
    *,
    out: None = None,
    body: Body | _Path | None = None,
    size: int = 128,
    past: int = 10,
    normals: bool = True,
    velocity: _Velocity = "savgol",
    frame: _Axes = "camera",
    weighting: _Weighting = "area",
    seen_only: bool = False,
    gutter: int = 1,
    every: int = 1,
    half: bool = False,
    threads: int = 0,
    progress: _Progress | None = None,
) -> _Floats: ...
@overload
def describe(
    track: Track | _Path,
    *,
    out: _Path,
    body: Body | _Path | None = None,
    size: int = 128,
    past: int = 10,
    normals: bool = True,
    velocity: _Velocity = "savgol",
    frame: _Axes = "camera",
    weighting: _Weighting = "area",
    seen_only: bool = False,
    gutter: int = 1,
    every: int = 1,
    half: bool = False,
    threads: int = 0,
    progress: _Progress | None = None,
) -> NDArray[np.floating[Any]]: ...
@overload
def render(
    track: Track | _Path,
    frames: int | tuple[int, int] | None = None,
    *,
    out: None = None,
    what: _What = "overlay",
    body: Body | _Path | None = None,
    video: _Path | None = None,
    view_yaw_deg: float | None = None,
    turntable: bool = False,
    texture: _Images | _Path | None = None,
    truth: Track | _Path | None = None,
    error_maximum: float | None = None,
    threads: int = 0,
    progress: _Progress | None = None,
) -> _Images: ...
@overload
def render(
    track: Track | _Path,
    frames: int | tuple[int, int] | None = None,
    *,
    out: _Path,
    what: _What = "overlay",
    body: Body | _Path | None = None,
    video: _Path | None = None,
    view_yaw_deg: float | None = None,
    turntable: bool = False,
    texture: _Path | None = None,
    truth: Track | _Path | None = None,
    error_maximum: float | None = None,
    threads: int = 0,
    progress: _Progress | None = None,
) -> None: ...
def evaluate(
    track: Track | _Path,
    truth: Track | _Path | None = None,
    *,
    body: Body | _Path | None = None,
    true_body: _Path | None = None,
    true_person: int = 0,
    joint_regressor: _Path | None = None,
    cameras: _Path | None = None,
    sequence: str = "",
    view: str = "",
    rig: Sequence[RigCamera] | _Path | None = None,
    equal_clocks: bool = False,
    progress: _Progress | None = None,
) -> Evaluation: ...
def export(
    tracks: Track | _Path | Sequence[Track | _Path],
    out: _Path,
    form: Literal[
        "vertices", "joints", "obj", "amass", "bvh", "glb", "fbx", "smplx", "trc", "c3d", "colmap", "pose2sim", "angles"
    ],
    *,
    body: Body | _Path | None = None,
    world_axes: bool = False,
    frame: int | None = None,
    rig: str = "smpl",
    textures: Sequence[_Path] = [],
    correctives: int = 8,
    events: _Path | None = None,
    progress: _Progress | None = None,
) -> str: ...
def joint_angles(
    track: Track | _Path,
    *,
    body: Body | _Path | None = None,
    pelvis_order: Literal["rotation-first", "tilt-first"] = "rotation-first",
) -> JointAngles: ...
def gait(track: Track | _Path, *, body: Body | _Path | None = None) -> dict[str, Any]: ...
