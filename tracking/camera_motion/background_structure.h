// SPDX-License-Identifier: Apache-2.0
/// Path of a camera that goes from place to place, places of the background's points, and focal length, from points
/// that are followed (BackgroundTracks): structure from motion of one video.
///
/// The minimum of
///   Σ ρ(‖q − f π(R_k (x_i − o_k))‖² / σ²) + ((log f − m) / s)²    ρ: Cauchy, c = 2;  σ = 0.3 pixels of a picture 640
///                                                                  pixels long
/// over rotations R and centres o of the key frames, points x and f is sought by Ceres (Schur complement, dense or
/// sparse). Key frames are anchors and frames in which the points have gone 12 small pixels or a quarter of a second
/// since the last one, 400 at most, evenly thinned. Start: essential matrices (five points, least median of errors; if
/// that gives none, most points within a small pixel) of pairs of key frames with most parallax, each tried with its
/// key frames in between, and at several focal lengths if it is not known; the one of least cost goes on. Key frames
/// with most points that are placed come next, one at a time; the latest twelve are adjusted every fifth key frame, all
/// of them when a quarter has been added. All other frames are placed by the points. Deviations are those of the
/// points' scatter, whose errors last from frame to frame (bundle_covariance.h).
///
/// The scene is the camera's frame at first, and its unit the median distance of the points from the camera: pictures
/// do not tell the length of the path.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "geometry/scene/background_tracks.h"
#include "geometry/scene/camera.h"
#include "tracking/problem/camera_knowledge.h"

namespace bodyloom {

struct BackgroundStructureOptions {
  FocalPrior focal;          ///< of the picture
  bool focal_known = false;  ///< held at exp(focal.log_mean)
  int num_threads = 1;
};

struct BackgroundStructure {
  bool solved = false;
  std::string why;                            ///< the reason if it is not solved
  std::vector<int> frames;                    ///< placed, rising
  std::vector<CameraPose> camera_from_first;  ///< of each; translations in units
  std::vector<double> sigma_rad;              ///< of each rotation, standard deviation about an axis
  std::vector<double> sigma_place;            ///< of each centre along an axis, units; the farthest camera's distance
                                              ///< from the first is held
  std::vector<int> names;                     ///< of the points (BackgroundTracks::Anchor::points)
  std::vector<Eigen::Vector3d> points;        ///< in the scene, units
  double log_focal = 0, log_focal_sigma = 0;
  int key_frames = 0;
  double median_px = 0;  ///< distance of pixels from projections, of points seen in three key frames or more
  double explained = 0;  ///< share of them within 1.5 pixels of a picture of 640
  double parallax = 0;   ///< median over the points of the largest angle between the first ray and another, rad
  double extent = 0;     ///< largest distance of a centre from the first, units
};

/// Anchors that begin after a break are left out with all that follows: `frames` then end before it.
BackgroundStructure ReconstructBackground(const BackgroundTracks& tracks, const BackgroundStructureOptions& options);

}  // namespace bodyloom
