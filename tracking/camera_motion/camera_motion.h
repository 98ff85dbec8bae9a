// SPDX-License-Identifier: Apache-2.0
/// Finds how a camera moved during a clip, from points of the background (BackgroundTracks), before anybody is fitted.
///
/// *Still*: a sight of an anchor's points counts as moved when six tenths of them lie more than a pixel of a picture
/// 640 pixels long from where they were, at most a quarter rests within 0.6, a similarity explains half of the way of
/// half of them (leaves and water do not move together), and they lie in five of the picture's 12 parts or more. The
/// camera is still unless three sights moved: what moves in a picture of a camera that stands are people, whom
/// detections cover, and things in some part of it. Motions below 0.1° are called still; at 4 m they are 6 mm.
///
/// *Turning*: the points of moved sights are where the infinite homographies of one path of rotations put them
/// (turning_camera.h): a share of 0.7 within 1.5 small pixels. An epipolar geometry does not explain them better by
/// Torr's criterion (GRIC, "An assessment of information criteria for motion model selection", 1997), which counts
/// what its parameters may explain by chance:
///   Σ min(e²/σ², 2 (4 − d)) + n d log 4 + k log 4n   d = 2, k = 3: a rotation;  d = 3, k = 7: an epipolar geometry
/// A zoom is a path instead if points in space leave half as many unexplained.
/// *Moving*: anything else that moves. Its path is that of background_structure.h where that explains a share of 0.65
/// of the points seen in three key frames or more within 1.5 small pixels, under a median angle of 0.3° at least, with
/// centres whose deviation (median) is at most a third of the path's extent. *Unknown*: fewer than 16 points of
/// background in half of the sights or, of what moves, in the mean, or three anchors in ten begin after a loss.
#pragma once

#include <string>
#include <vector>

#include "geometry/scene/background_tracks.h"
#include "geometry/scene/camera_path.h"
#include "tracking/camera_motion/unseen_frames.h"
#include "tracking/problem/camera_knowledge.h"

namespace bodyloom {

enum class CameraMotionKind {
  kUnknown,  ///< too little background was seen
  kStill,
  kTurning,  ///< in place
  kMoving,   ///< from place to place, or with cuts
};
/// "unknown", "still", "turning", "moving".
std::string ToString(CameraMotionKind kind);

struct CameraMotionOptions {
  FocalPrior focal;
  bool focal_known = false;
  int num_threads = 1;
};

struct CameraMotion {
  CameraMotionKind kind = CameraMotionKind::kUnknown;
  std::string why;      ///< the evidence
  double shift_px = 0;  ///< median way of the background from its anchor's frame, the largest over the clip
  /// Times of the frames looked at. Of a turning camera translations are 0, of a moving one in units: 1 is the median
  /// distance of the points from the camera.
  CameraPath path;
  std::vector<double> sigma_rad;        ///< of each pose, standard deviation about an axis
  std::vector<double> sigma_place;      ///< of a moving camera: of each centre along an axis, units
  PoseSigmas of_frames;                 ///< of the path's poses in every frame of the clip, also where none was seen
  double turned_deg = 0;                ///< largest rotation from the first frame
  double extent = 0;                    ///< of a moving camera: largest distance from the first frame's place, units
  std::vector<Eigen::Vector3d> points;  ///< of a moving camera: the background in the first frame's axes, units
  double log_focal = 0, log_focal_sigma = 0;  ///< of a path that is found; σ 0: it was known
  double zoom = 1;                            ///< largest over smallest focal length

  [[nodiscard]] bool has_path() const { return !path.poses.empty(); }
};

/// Throws std::invalid_argument when the tracks contradict themselves (sizes, frames out of range or order).
CameraMotion FindCameraMotion(const BackgroundTracks& tracks, const CameraMotionOptions& options);

}  // namespace bodyloom
