// SPDX-License-Identifier: Apache-2.0
/// A posed toy body with Gaussians on it.
#pragma once

#include "render/gaussian_avatar/pose_gaussians.h"
#include "tests/support/avatar_twin.h"
#include "tests/support/toy_body.h"
#include "tests/support/toy_poses.h"

namespace bodyloom {

struct PersonScene {
  BodyModel model = ToyBody();
  AvatarFrame frame;
  GaussianBody body;
  PoseGaussiansOptions options;
  const MatrixX3i& faces = model.data().faces;

  explicit PersonScene(int count, uint32_t seed = 1) {
    AvatarFrames(model, Eigen::VectorXd::Constant(2, 0.5)).Make(RandomPose(model, seed, 1.2, 2.5), {}, 1, &frame);
    body = RandomPerson(count, frame, model.num_faces(), seed);
    const Eigen::Matrix3d turn = RotationFromAxisAngle(Eigen::Vector3d(0.3, -0.8, 0.4));
    for (int k = 0; k < 9; ++k) options.light_from_frame[k] = static_cast<float>(turn(k / 3, k % 3));
  }
  void Pose(CameraGaussians* posed, int threads = 1) const {
    PoseGaussiansOptions own = options;
    own.num_threads = threads;
    PoseGaussians(body, faces, frame, own, posed);
  }
  template <class T>
  [[nodiscard]] TwinPerson<T> Twin() const {
    return TwinOf<T>(body, frame);
  }
  template <class T>
  [[nodiscard]] TwinGaussian<T> TwinRow(const TwinPerson<T>& person, int i) const {
    return TwinPose(body, faces, frame, options.light_from_frame, person, i);
  }
};

template <class T>
std::array<T, CameraGaussians::kNumColumns> ColumnsOf(const TwinGaussian<T>& g) {
  std::array<T, CameraGaussians::kNumColumns> row;
  std::copy(g.position.begin(), g.position.end(), row.begin());
  std::copy(g.factor.begin(), g.factor.end(), row.begin() + CameraGaussians::kFactor);
  row[CameraGaussians::kOpacity] = g.opacity;
  std::copy(g.colour.begin(), g.colour.end(), row.begin() + CameraGaussians::kRed);
  return row;
}

}  // namespace bodyloom
