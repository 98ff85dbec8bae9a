// SPDX-License-Identifier: Apache-2.0
// Uses only the lowest library.
#include <Eigen/Core>
#include <iostream>

#include "bodyloom/geometry/math/rotation.h"
#include "bodyloom/geometry/scene/camera.h"

int main() {
  const Eigen::Matrix3d turn = bodyloom::RotationFromAxisAngle(Eigen::Vector3d(0, 1.5, 0));
  const Eigen::Vector3d back = bodyloom::AxisAngleFromRotation(turn);
  const bodyloom::Camera camera = bodyloom::MakePinhole(640, 480, 600);
  Eigen::Vector2d pixel;
  const bool seen = camera.Project(Eigen::Vector3d(0, 0, 2), &pixel);
  std::cout << back.transpose() << " rad, " << pixel.transpose() << " px\n";
  return seen && (back - Eigen::Vector3d(0, 1.5, 0)).norm() < 1e-12 ? 0 : 1;
}
