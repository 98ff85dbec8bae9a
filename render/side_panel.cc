// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/render/side_panel.h"

namespace bodyloom {

SidePanel::SidePanel(const std::vector<MatrixX3d>& joints, const std::vector<double>& timestamps,
                     const FollowViewOptions& options, const std::vector<MatrixX3d>& others)
    : follow_(joints, timestamps, options, others), backdrop_(StudioBackdrop(options.width, options.height)) {}

SidePanel::Picture SidePanel::At(int t, const Floor& floor) const {
  const View view = follow_.At(t);
  const Eigen::Matrix3d& R = view.from_camera.camera_from_world_rotation;
  const Eigen::Vector3d& translation = view.from_camera.camera_from_world_translation;
  Picture picture{view, {R * floor.point + translation, R * floor.up}, backdrop_};
  DrawFloorGrid(picture.floor, R * follow_.CentreAt(t) + translation, {}, view.camera, &picture.image);
  return picture;
}

Image Beside(const Image& left, const Image& right) {
  Image both(left.width + right.width, left.height);
  Paste(left, 0, 0, &both);
  Paste(right, left.width, 0, &both);
  return both;
}

}  // namespace bodyloom
