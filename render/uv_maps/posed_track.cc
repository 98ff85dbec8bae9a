// SPDX-License-Identifier: Apache-2.0
#include "render/uv_maps/posed_track.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "geometry/base/check.h"
#include "geometry/base/parallel.h"
#include "geometry/body/posed_body.h"
#include "render/view/view_camera.h"

namespace bodyloom {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

PosedTrack::PosedTrack(const BodyModel& body, const Track& track, std::vector<double> yaw_deg)
    : body_(body),
      track_(track),
      skinner_(body),
      shape_(skinner_.Shape(track.motion.betas)),
      yaw_deg_(std::move(yaw_deg)) {
  BODYLOOM_CHECK(yaw_deg_.empty() || static_cast<int>(yaw_deg_.size()) == track.num_frames(),
                 "posed track: ", yaw_deg_.size(), " angles for ", track.num_frames(), " frames");
}

Matrix3d PosedTrack::Turn(int t) const {
  if (yaw_deg_.empty()) return Matrix3d::Identity();
  return Eigen::AngleAxisd(yaw_deg_[t] * M_PI / 180, Vector3d::UnitY()).toRotationMatrix();
}

Vector3d PosedTrack::Root(int t) const {
  return shape_.rest_joints.row(0).transpose() + track_.motion.trans.row(t).transpose();
}

MatrixX3d PosedTrack::Vertices(int t) const {
  MatrixX3d vertices(body_.num_vertices(), 3);
  const BodyPose pose =
      PoseFromAxisAngle(body_, track_.motion.poses.row(t).transpose(), track_.motion.trans.row(t).transpose());
  skinner_.Skin(shape_, std::span(&pose, 1), {vertices.data(), static_cast<size_t>(vertices.size())});
  return Turned(t, std::move(vertices));
}

MatrixX3d PosedTrack::Landmarks(int t, const std::vector<std::string>& names) const {
  const BodyPose pose =
      PoseFromAxisAngle(body_, track_.motion.poses.row(t).transpose(), track_.motion.trans.row(t).transpose());
  return Turned(t, PoseLandmarks(body_, track_.motion.betas, pose, names));
}

MatrixX3d PosedTrack::Turned(int t, MatrixX3d points) const {
  if (!turned()) return points;
  const Eigen::RowVector3d root = Root(t).transpose();
  return ((points.rowwise() - root) * Turn(t).transpose()).rowwise() + root;
}

std::vector<PersonExtent> PosedTrack::Extents(int num_threads) const {
  std::vector<PersonExtent> extents(track_.num_frames());
  ParallelFor(track_.num_frames(), num_threads, [&](int t) {
    if (!track_.HasResult(t)) return;
    const MatrixX3d vertices = Vertices(t);
    const Camera camera = track_.CameraAt(t);
    PersonExtent extent{Vector2d::Constant(1e9), Vector2d::Constant(-1e9)};
    for (Eigen::Index v = 0; v < vertices.rows(); ++v) {
      Vector2d pixel;
      if (!camera.Project(vertices.row(v).transpose(), &pixel)) continue;
      extent.min = extent.min.cwiseMin(pixel);
      extent.max = extent.max.cwiseMax(pixel);
    }
    const bool in_image = extent.max.minCoeff() >= 0 && extent.min.x() < camera.width && extent.min.y() < camera.height;
    if (in_image) extents[t] = extent;
  });
  return extents;
}

double PixelsPerMetre(const BodyModel& body, const Track& track) {
  const PosedTrack posed(body, track, {});
  std::vector<double> sizes;
  for (int t = 0; t < track.num_frames(); ++t) {
    if (!track.HasResult(t)) continue;
    const double size = PixelsPerMetre(track.CameraAt(t), posed.Root(t).z());
    if (size > 0) sizes.push_back(size);
  }
  if (sizes.empty()) return 0;
  std::nth_element(sizes.begin(), sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2), sizes.end());
  return sizes[sizes.size() / 2];
}

double ScaleToSize(double wanted, double own) {
  const double ratio = wanted / own;
  return std::abs(ratio - 1) <= 0.02 ? 1 : ratio;
}

}  // namespace bodyloom
