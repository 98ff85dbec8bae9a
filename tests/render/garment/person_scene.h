// SPDX-License-Identifier: Apache-2.0
/// The built-in body before a camera, and the mask of the drawn person.
#pragma once

#include "data_tools/body/builtin_body.h"
#include "geometry/body/posed_body.h"
#include "geometry/math/rotation.h"
#include "geometry/scene/camera.h"
#include "geometry/scene/observations.h"
#include "render/raster/visibility_buffer.h"

namespace bodyloom {

inline Camera PersonCamera() { return MakePinhole(600, 800, 900); }

/// V×3 in the camera's frame, facing it, turned by `turn_rad` about the vertical, arms at 45 degrees.
inline MatrixX3d StandingBefore(const BodyModel& body, double turn_rad) {
  BodyPose pose = PoseFromAxisAngle(body, Eigen::VectorXd::Zero(3 * body.num_joints()), {0, 0, 3});
  pose.rotations[0] = RotationFromAxisAngle({0, turn_rad, 0}) * RotationFromAxisAngle({EIGEN_PI, 0, 0});
  pose.rotations[body.FindJoint("l_shoulder")] = RotationFromAxisAngle({0, 0, -0.8});
  pose.rotations[body.FindJoint("r_shoulder")] = RotationFromAxisAngle({0, 0, 0.8});
  return PoseVertices(body, Eigen::VectorXd(), pose);
}

inline LabelImage MaskOf(const MatrixX3d& vertices, const MatrixX3i& faces, const Camera& camera) {
  VisibilityBuffer buffer;
  buffer.Render(vertices, faces, camera);
  LabelImage mask{0, 0, camera.width, camera.height, std::vector<uint8_t>(size_t(camera.width) * camera.height)};
  for (int y = 0; y < camera.height; ++y) {
    for (int x = 0; x < camera.width; ++x) mask.labels[size_t(y) * camera.width + x] = buffer.FaceAt(x, y) >= 0 ? 1 : 0;
  }
  return mask;
}

}  // namespace bodyloom
