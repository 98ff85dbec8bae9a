// SPDX-License-Identifier: Apache-2.0
#include "render/gaussian_avatar/learning/avatar_trainer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <stdexcept>

namespace bodyloom::gaussian_cost_test {
namespace {

GaussianBody RandomBody() {
  std::mt19937 numbers(3);
  const auto uniform = [&] { return static_cast<float>(numbers() / 2147483648.0 - 1); };
  GaussianBody body;
  body.Resize(7);
  for (int i = 0; i < body.size(); ++i) {
    for (int c = 0; c < GaussianBody::kNumParameters; ++c) body.parameters(i, c) = 2 * uniform();
    body.anchors[i].corrective_factor = std::abs(uniform());
    body.kinds[i] = static_cast<GaussianKind>(i % 3);
  }
  return body;
}

double Cost(const GaussianBody& body, const GaussianCost& cost) {
  double sum = 0;
  for (int i = 0; i < body.size(); ++i) {
    const double opacity = 1 / (1 + std::exp(-double(body.parameters(i, GaussianBody::kOpacityLogit))));
    if (body.kinds[i] != GaussianKind::kCloth) {
      sum += (cost.by_opacity + cost.by_distance * (1 - body.anchors[i].corrective_factor)) * opacity;
    }
    for (int c = 0; c < 3; ++c) sum += cost.by_scale * std::exp(body.parameters(i, GaussianBody::kLogScale + c));
  }
  return sum / body.size();
}

TEST(GaussianCost, IsTheFormulaAndItsDerivative) {
  const GaussianBody body = RandomBody();
  const GaussianCost cost{.by_opacity = 0.5, .by_scale = 0.25, .by_distance = 2};
  FloatColumns gradient(GaussianBody::kNumParameters, body.size());
  gradient.Fill(0);
  EXPECT_NEAR(AddGaussianCost(body, cost, &gradient), Cost(body, cost), 1e-6);
  for (int i = 0; i < body.size(); ++i) {
    for (int c = 0; c < GaussianBody::kNumParameters; ++c) {
      GaussianBody above = body, below = body;
      constexpr float kStep = 1e-2F;
      above.parameters(i, c) += kStep, below.parameters(i, c) -= kStep;
      const double step = double(above.parameters(i, c)) - below.parameters(i, c);
      EXPECT_NEAR(gradient(i, c), (Cost(above, cost) - Cost(below, cost)) / step, 2e-5) << i << " " << c;
    }
  }
}

TEST(GaussianCost, OffTheSkinCostsMore) {
  GaussianBody body = RandomBody();
  for (SkinAnchor& anchor : body.anchors) anchor.corrective_factor = 1;
  FloatColumns gradient(GaussianBody::kNumParameters, body.size());
  const double on_the_skin = AddGaussianCost(body, {}, &gradient);
  body.anchors[2].corrective_factor = 0;
  EXPECT_EQ(AddGaussianCost(body, {}, &gradient), on_the_skin) << "of cloth";
  body.anchors[1].corrective_factor = 0;
  EXPECT_GT(AddGaussianCost(body, {}, &gradient), on_the_skin);
  EXPECT_EQ(AddGaussianCost(body, {.by_distance = 0}, &gradient), on_the_skin);
}

TEST(GaussianCost, RefusesATableOfAnotherSize) {
  FloatColumns gradient(GaussianBody::kNumParameters, 3);
  EXPECT_THROW(AddGaussianCost(RandomBody(), {}, &gradient), std::invalid_argument);
}

}  // namespace
}  // namespace bodyloom::gaussian_cost_test
