# SPDX-License-Identifier: Apache-2.0
"""Bodyloom tracks people in a single-camera video with a parametric body. docs/python.md is the manual.

    import bodyloom
    track = bodyloom.track("openpose_json/", image_size=(1920, 1080))
    print(track.summary, track.joints.shape)
    track.save("track.npz")

Everything is in metres, seconds and radians, in the camera frame (x right, y down, z forward), unless a name says
otherwise.
"""
from ._bodyloom import (
    FRAME_STATUS,
    Avatar,
    Body,
    Camera,
    Cancelled,
    DescriptorFrames,
    Evaluation,
    JointAngles,
    Keypoints,
    LiveDescriptors,
    LiveFrame,
    LiveTracker,
    Person,
    PersonKeypoints,
    Renderer,
    RigCamera,
    ShownAvatar,
    Track,
    TrackSummary,
    __version__,
    describe,
    detect,
    evaluate,
    export,
    gait,
    joint_angles,
    parse_photo,
    read_rig,
    render,
    run,
    synthetic_clip,
    track,
    track_views,
    write_rig,
)

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

for _name in __all__:
    if isinstance(globals()[_name], type):
        globals()[_name].__module__ = __name__  # where users import it from, also in pickles
del _name
