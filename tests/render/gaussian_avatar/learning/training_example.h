// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "geometry/uv_maps/uv_texels.h"
#include "render/gaussian_avatar/learning/avatar_trainer.h"
#include "render/gaussian_avatar/skin_gaussians.h"
#include "tests/support/toy_body.h"
#include "tests/support/toy_poses.h"

namespace bodyloom {

/// A toy person whose Gaussians have distinct colours, rendered in a few poses as training data.
struct TrainingExample {
  BodyModel model = ToyBody();
  Eigen::VectorXd betas = Eigen::VectorXd::Constant(2, 0.5);
  UvTexelTable texels = BuildUvTexelTable(model, {.width = 40, .height = 40});
  GaussianBody truth = SkinGaussians(model, betas, texels);
  std::vector<BodyPose> poses;
  std::vector<TrainingView> views;

  TrainingExample() {
    for (int i = 0; i < truth.size(); ++i) {
      truth.parameters(i, GaussianBody::kOpacityLogit) = 5;
      for (int c = 0; c < 3; ++c) {
        const float place = truth.parameters(i, GaussianBody::kPosition + c);
        truth.parameters(i, GaussianBody::kAlbedo + c) = 0.5F + 0.4F * std::sin(9 * place + static_cast<float>(c));
      }
    }
    AvatarPainter painter;
    const AvatarFrames frames(model, betas);
    for (uint32_t seed = 1; seed <= 4; ++seed) {
      AvatarFrame frame;
      BodyPose pose = RandomPose(model, seed, 0.3, 2.5);
      pose.trans = Eigen::Vector3d(0, 0, 3.2);
      poses.push_back(pose);
      frames.Make(pose, {}, 1, &frame);
      AvatarView view;
      view.camera = MakePinhole(120, 150, 170);
      view.window = {0, 0, 120, 150};
      painter.Draw(truth, model.data().faces, frame, view);
      Image image(120, 150);
      const SplatImage& drawn = painter.image();
      for (int i = 0; i < 120 * 150; ++i) {
        for (int c = 0; c < 3; ++c) {
          const float value = drawn.plane(static_cast<SplatImage::Plane>(2 - c))[i];
          image.bgr[3 * i + c] = static_cast<uint8_t>(std::lround(255 * std::min(1.0F, std::max(0.0F, value))));
        }
      }
      const auto is_person = [&](int x, int y) { return drawn.plane(SplatImage::kAlpha)[y * 120 + x] > 0.5F; };
      views.push_back(CutTrainingView(image, is_person, view.window, {}, 8));
      views.back().camera = view.camera;
      views.back().frame = frame;
      views.back().time = static_cast<int>(views.size()) - 1;
    }
  }
  [[nodiscard]] AvatarTrainingState Start() const {
    return AvatarTrainingState::Of(SkinGaussians(model, betas, texels));
  }
};

inline const TrainingExample& Example() {
  static const TrainingExample example;
  return example;
}

}  // namespace bodyloom
