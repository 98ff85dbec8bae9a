// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/neural/refiner/refiner_module.h"

#include <gtest/gtest.h>
#include <torch/torch.h>

#include <stdexcept>
#include <vector>

#include "bodyloom/neural/device.h"
#include "bodyloom/pipelines/person/picture_refiner.h"
#include "bodyloom/render/person/person_layers.h"
#include "tests/support/random_refiner.h"

namespace bodyloom {
namespace {

PersonLayers RandomLayers(int width, int height) {
  torch::manual_seed(3);
  PersonLayers layers;
  layers.width = width, layers.height = height;
  layers.planes = HostValues<float>(torch::rand({PersonPlane::kCount, height, width}));
  return layers;
}

torch::Tensor PlanesOf(PersonLayers* layers) {
  return torch::from_blob(layers->planes.data(), {1, PersonPlane::kCount, layers->height, layers->width});
}

TEST(RefinerModule, ChangesNothingBeforeItHasLearned) {
  RefinerModule module;
  const torch::NoGradGuard no_grad;
  PersonLayers layers = RandomLayers(64, 128);
  const torch::Tensor change = module(PlanesOf(&layers));
  EXPECT_EQ(change.sizes(), (std::vector<int64_t>{1, 4, 128, 64}));
  EXPECT_EQ(change.abs().max().item<float>(), 0);
}

TEST(RefinerModule, RunsWithoutLibTorchTheSame) {
  RefinerModule module;
  const RefinerWeights weights = RandomRefiner(0.5F);
  ImportRefiner(weights, &module);
  PictureRefiner native(weights);
  const torch::NoGradGuard no_grad;
  for (const auto& [width, height] : {std::pair(64, 128), std::pair(192, 64)}) {
    PersonLayers layers = RandomLayers(width, height);
    const std::vector<float> here = HostValues<float>(module(PlanesOf(&layers))), there = native.Change(layers);
    ASSERT_EQ(here.size(), there.size());
    float largest = 0;
    for (size_t i = 0; i < here.size(); ++i) {
      ASSERT_NEAR(here[i], there[i], 2e-4F) << i;
      largest = std::max(largest, std::abs(here[i]));
    }
    EXPECT_GT(largest, 0.1F);
    const std::vector<float> person = HostValues<float>(ChangedPerson(PlanesOf(&layers), module(PlanesOf(&layers))));
    const std::vector<float> twin = ChangedPerson(layers, there);
    for (size_t i = 0; i < person.size(); ++i) ASSERT_NEAR(person[i], twin[i], 2e-4F) << i;
  }
}

TEST(RefinerModule, NumbersGoOutAndIn) {
  RefinerModule module;
  const RefinerWeights weights = RandomRefiner(1);
  ImportRefiner(weights, &module);
  const RefinerWeights back = ExportRefiner(module);
  for (size_t i = 0; i < kRefinerShapes.size(); ++i) {
    EXPECT_TRUE(back.convolutions[i].kernel == weights.convolutions[i].kernel) << i;
    EXPECT_TRUE(back.convolutions[i].bias == weights.convolutions[i].bias) << i;
  }
  EXPECT_THROW(ImportRefiner({}, &module), std::invalid_argument);
}

TEST(RefinerModule, RefusesOtherSizes) {
  RefinerModule module;
  EXPECT_THROW(module(torch::zeros({1, 12, 60, 64})), std::invalid_argument);
  EXPECT_THROW(module(torch::zeros({1, 11, 64, 64})), std::invalid_argument);
  PictureRefiner native(RandomRefiner(0));
  EXPECT_THROW(native.Change({}), std::invalid_argument);
  EXPECT_THROW(native.Change(RandomLayers(64, 40)), std::invalid_argument);
  EXPECT_THROW(PictureRefiner{RefinerWeights()}, std::invalid_argument);
}

}  // namespace
}  // namespace bodyloom
