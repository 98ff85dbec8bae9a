// SPDX-License-Identifier: Apache-2.0
#include "pipelines/neural/guided/virtual_views.h"

#include <Eigen/Geometry>

#include "data_tools/descriptors/photo_maps.h"
#include "neural/guided/complete_maps.h"
#include "pipelines/neural/photo/photo_input.h"
#include "render/uv_maps/posed_track.h"

namespace bodyloom {

Track VirtualViewTrack(const BodyModel& body, const Eigen::VectorXd& betas) {
  constexpr int kSide = 1024;
  constexpr double kDistance = 6, kSpan = 2.8;  // metres: seen, at the root's depth
  Track track;
  track.camera = MakePinhole(kSide, kSide, kSide * kDistance / kSpan);
  Motion& motion = track.motion;
  motion.up = Motion::Up::kCamera;
  motion.body = body.num_joints() == 24 ? "smpl" : body.num_joints() == 52 ? "smplh" : "smplx";
  motion.betas = betas;
  motion.poses = RowMatrixXd::Zero(kNumVirtualViews, 3 * body.num_joints());
  motion.trans = MatrixX3d::Zero(kNumVirtualViews, 3);
  // Body: y up, x its left, z its front. Half a turn about x faces the camera (y down, z forward).
  const auto about = [](double angle, const Eigen::Vector3d& axis) { return Eigen::AngleAxisd(angle, axis); };
  const Eigen::Vector3d x = Eigen::Vector3d::UnitX(), y = Eigen::Vector3d::UnitY();
  const Eigen::AngleAxisd turns[kNumVirtualViews] = {about(0, y),        about(M_PI, y),     about(-M_PI / 2, y),
                                                     about(M_PI / 2, y), about(M_PI / 2, x), about(-M_PI / 2, x)};
  for (int v = 0; v < kNumVirtualViews; ++v) {
    const Eigen::AngleAxisd root(Eigen::Quaterniond(about(M_PI, x)) * turns[v]);
    motion.poses.row(v).head<3>() = (root.angle() * root.axis()).transpose();
    motion.timestamps.push_back(v);
    track.frame_status.push_back(FrameStatus::kTracked);
  }
  const Eigen::Vector3d root = PosedTrack(body, track).Root(0);
  motion.trans.rowwise() = (Eigen::Vector3d(0, 0, kDistance) - root).transpose();
  return track;
}

std::vector<PhotoFrame> VirtualViews(const BodyModel& body, const Eigen::VectorXd& betas, int size, int texture_size) {
  const Track track = VirtualViewTrack(body, betas);
  PhotoMapsOptions options;
  options.size = size;
  options.texture_size = texture_size;
  const PhotoMaps maps(body, track, options);
  std::vector<PhotoFrame> views(kNumVirtualViews);
  for (int v = 0; v < kNumVirtualViews; ++v) FillMaps(maps.At(v), size, texture_size, &views[v]);
  return views;
}

}  // namespace bodyloom
