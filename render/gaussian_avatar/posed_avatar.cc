// SPDX-License-Identifier: Apache-2.0
#include "render/gaussian_avatar/posed_avatar.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "geometry/base/check.h"
#include "render/gaussian_avatar/cloth_bones.h"
#include "render/view/view_camera.h"

namespace bodyloom {
namespace {

constexpr double kRoomForClothes = 0.25;  ///< share of the body's longer side, on every side

}  // namespace

PosedAvatar::PosedAvatar(const BodyModel& body, const Track& track, std::vector<double> yaw_deg, double scale,
                         int num_threads, const std::string& where)
    : body_(body),
      track_(track),
      posed_(body, track, std::move(yaw_deg)),
      frames_(body, track.motion.betas),
      scale_(scale),
      num_threads_(num_threads) {
  BODYLOOM_CHECK(!track.camera.HasDistortion(), where, ": its camera's lens is distorted, expected an ideal one");
  const Camera camera = scale == 1 ? track.camera : ScaledCamera(track.camera, scale);
  width_ = camera.width, height_ = camera.height;
  extents_ = posed_.Extents(num_threads);
}

void PosedAvatar::Wear(GarmentBones bones, std::vector<int> shown) {
  garment_ = std::move(bones);
  shown_ = std::move(shown);
}

CameraPose PosedAvatar::CameraPoseAt(int t) const {
  const Eigen::Matrix3d turn = posed_.Turn(t);
  const Eigen::Vector3d root = posed_.Root(t);
  return {turn, root - turn * root};
}

std::vector<float> PosedAvatar::SeenCloth(int t, const GarmentBones& run) const {
  return SeenBones(run.of_frame.at(t), CameraPoseAt(t));
}

void PosedAvatar::MakeFrame(int t, AvatarFrame* frame) const {
  const Motion& motion = track_.motion;
  const BodyPose pose = PoseFromAxisAngle(body_, motion.poses.row(t).transpose(), motion.trans.row(t).transpose());
  const CameraPose camera = CameraPoseAt(t);
  frames_.Make(pose, camera, num_threads_, frame);
  if (garment_.of_frame.empty()) return;
  AppendBones(garment_.of_frame.at(shown_.empty() ? t : shown_[t]), garment_.as_sewn, camera, frame);
}

Camera PosedAvatar::CameraAt(int t) const {
  return scale_ == 1 ? track_.CameraAt(t) : ScaledCamera(track_.CameraAt(t), scale_);
}

PixelBox PosedAvatar::BoxAt(int t, double share) const {
  const PersonExtent& extent = extents_[t];
  const double room = share * (extent.max - extent.min).maxCoeff();
  // Extents may be huge if a limb is near the camera plane.
  const auto low = [&](int c) { return static_cast<int>(std::floor(std::max(-1e6, scale_ * (extent.min[c] - room)))); };
  const auto high = [&](int c) {
    return static_cast<int>(std::ceil(std::min(1e6, scale_ * (extent.max[c] + room)))) + 1;
  };
  return PixelBox{low(0), low(1), high(0), high(1)}.ClippedTo({0, 0, width_, height_});
}

AvatarView PosedAvatar::ViewAt(int t) const {
  AvatarView view;
  view.camera = CameraAt(t);
  view.window = BoxAt(t, kRoomForClothes);
  view.options.num_threads = num_threads_;
  const Eigen::Matrix3d turn = posed_.Turn(t);
  for (int k = 0; k < 9; ++k) view.options.light_from_frame[k] = static_cast<float>(turn(k % 3, k / 3));
  return view;
}

}  // namespace bodyloom
