// SPDX-License-Identifier: Apache-2.0
/// Track files: one .npz that AMASS readers understand and that suffices to evaluate a track without this project.
///
/// T frames of a body with J joints; metres, camera frame (x right, y down, z forward), radians, seconds:
///   poses T×3J axis-angle    trans T×3      betas B        gender 'neutral'   mocap_framerate 1 / median time step
///   body text ("bodyloom", "smpl", …)       timestamps T   frame_status uint8 T (0 tracked, 1 weak, 2 interpolated,
///   3 lost: values NaN)      joints T×J×3   coco17 T×17×3 (not for bodies without these landmarks)
///   joint_sigma T×J standard deviation of a joint's position (NaN: unknown)
///   camera_model 'pinhole' or 'weak'        K 3×3          distortion 8 (OpenCV: k1 k2 p1 p2 k3 k4 k5 k6)
///   image_size [width, height], pixels      camera T×3     (s, tx, ty), only with 'weak':
///                                                          pixel = s·(X + tx, Y + ty) + (cx, cy), s in pixels a metre,
///                                                          cx and cy from K
///   camera_from_scene T×4×4  [R t; 0 0 0 1] of each frame, only if the camera moves: poses, trans, joints and coco17
///                          are then in a static scene (geometry/scene/camera_path.h), and points are projected as
///                          R · point in the scene + t; world_from_camera is then of the scene
///   world_from_camera 4×4  [R t; 0 0 0 1]: a point of the clip's world (y up, the ground at y = 0, the camera above
///                          the origin and heading for −z; geometry/scene/world_frame.h) is R · point in the camera
///                          frame + t
///   world_source           source: 'ground', 'several people', 'vertical', 'given', 'level camera assumed'
///   world_sigma            [degrees of the vertical, metres of the ground's height]: standard deviations, NaN: unknown
///   world_level T          height of the level that supports the person over the world's ground, metres: 0 on the
///                          ground, else on a box, stairs or a stage; only if any is not 0
///   video_turn_deg         degrees by which the video's frames are turned clockwise to be seen by the camera, 90, 180
///                          or 270; only if turned
///   video_slowdown         seconds of the video per second of `timestamps`; only if not 1
/// Files without world_from_camera have no world frame. If only world_from_camera exists, its source is 'given'. There
/// is no `camera` member for a pinhole camera: K and trans suffice.
///
/// The reader also accepts tracks of other programs. Required are poses, trans and a camera (K, or camera T×3); missing
/// timestamps follow from mocap_framerate or mocap_frame_rate, else 30 frames per second are assumed; betas may be T×B
/// (their mean is taken); K may be T×3×3 when all frames agree; distortion may have 4, 5 or 8 values; frames whose pose
/// or trans is NaN count as lost; `body` follows from the number of columns (72 smpl, 156 smplh, 165 smplx); an
/// image_size of 0×0 means unknown.
#pragma once

#include <string>

#include "data_tools/formats/npz.h"
#include "geometry/scene/track.h"

namespace bodyloom {

/// Throws std::invalid_argument when the track's arrays contradict each other (both sizes are named), and
/// std::runtime_error when the file cannot be written.
void WriteTrack(const std::string& path, const Track& track);

/// Support of a reader's caller for tracks with a moving camera. Without it they would be drawn at wrong positions, or
/// the camera's motion taken for the person's.
enum class MovingCamera {
  kRefuse,
  kTake,
};

/// Throws std::runtime_error naming file, member, what it holds and what was expected.
Track ReadTrack(const std::string& path, MovingCamera moving = MovingCamera::kRefuse);

/// The same from a file's bytes or arrays; `where` names it in messages.
Track TrackFromArrays(const NpzArrays& arrays, const std::string& where, MovingCamera moving = MovingCamera::kRefuse);
Track ReadTrackBytes(const std::string& bytes, const std::string& where, MovingCamera moving = MovingCamera::kRefuse);

}  // namespace bodyloom
