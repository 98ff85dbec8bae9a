// SPDX-License-Identifier: Apache-2.0
#include "tracking/clip/turn_to_vertical.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <span>

#include "tracking/initialise/ground_plane.h"
#include "tracking/initialise/swap_repair.h"
#include "tracking/lifter/lifter_reading.h"
#include "tracking/problem/track_options.h"
#include "tracking/room/picture_vertical.h"

namespace bodyloom {

using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

/// Calls turn(begin, end, R) for each shot whose up is clear, with the turn from it to up_for(it), in the scene of
/// `path` (null: in the camera); returns the largest.
template <typename UpFor, typename Turn>
double TurnShots(const std::vector<LiftedFrame>& frames, const std::vector<CameraPose>* path,
                 const std::vector<char>& cut_before, const UpFor& up_for, const Turn& turn_shot) {
  double largest = 0;
  const size_t T = frames.size();
  for (size_t begin = 0, end = 0; begin < T; begin = end) {
    for (end = begin + 1; end < T && cut_before[end] == 0;) ++end;
    const auto shot = std::span(frames).subspan(begin, end - begin);
    const UpEstimate own =
        path == nullptr ? EstimateUp(shot) : EstimateUp(shot, std::span(*path).subspan(begin, end - begin));
    if (!own.found) continue;
    const Vector3d up = up_for(own.up);
    largest = std::max(largest, std::acos(std::clamp(own.up.dot(up), -1.0, 1.0)));
    turn_shot(begin, end, Eigen::Quaterniond::FromTwoVectors(own.up, up).toRotationMatrix());
  }
  return largest;
}

Matrix3d TurnInCamera(const CameraPose& camera_from_scene, const Matrix3d& turn) {
  const Matrix3d& R = camera_from_scene.camera_from_world_rotation;
  return R * turn * R.transpose();
}

Vector3d UpByLines(const Vector3d& up, const PictureVertical& lines, const StartFocal& focal) {
  return JoinVerticals(up, GroundPlaneOptions().up_rad, lines, focal.px, focal.log_sigma).up;
}

}  // namespace

double TurnToVertical(const TrackSequenceInput& input, const StartFocal& focal, const std::vector<char>& cut_before,
                      LiftedStart* lifted, std::vector<FrameState>* states) {
  const std::vector<CameraPose>* path = input.camera_from_scene;
  const bool knows = input.ground != nullptr || (input.picture_vertical != nullptr && input.picture_vertical->found);
  if (!knows || lifted->frames.empty()) return 0;
  return TurnShots(
      lifted->frames, path, cut_before,
      [&](const Vector3d& own) {
        return input.ground != nullptr ? input.ground->up : UpByLines(own, *input.picture_vertical, focal);
      },
      [&](size_t begin, size_t end, const Matrix3d& turn) {
        for (size_t t = begin; t < end; ++t) {
          const Matrix3d in_camera = path == nullptr ? turn : TurnInCamera((*path)[t], turn);
          TurnLandmarks(in_camera, &lifted->frames[t]);
          (*states)[t].rotations[0] = in_camera * (*states)[t].rotations[0];
        }
      });
}

void TurnViewsToVertical(const TrackSequenceInput& input, const FrameLayout& layout,
                         std::vector<ViewObservations>* views) {
  for (size_t v = 0; v < views->size(); ++v) {
    const PictureVertical* lines = (*input.views)[v].picture_vertical;
    std::vector<LiftedFrame>& lifted = (*views)[v].lifted;
    if (lines == nullptr || !lines->found || lifted.empty() || (*input.views)[v].camera_from_own != nullptr) continue;
    const ViewLayout& view = layout.views[v];
    const StartFocal focal = {view.local->camera.fx, view.focal_column >= 0 ? view.log_focal_sigma : 0};
    TurnShots(
        lifted, nullptr, FindCuts((*views)[v].keypoints),
        [&](const Vector3d& own) { return UpByLines(own, *lines, focal); },
        [&](size_t begin, size_t end, const Matrix3d& turn) {
          for (size_t t = begin; t < end; ++t) TurnLandmarks(turn, &lifted[t]);
        });
  }
}

}  // namespace bodyloom
