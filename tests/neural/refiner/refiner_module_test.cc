// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/neural/refiner/refiner_module.h"

#include <gtest/gtest.h>
#include <torch/torch.h>

#include <stdexcept>
#include <vector>

#include "bodyloom/neural/device.h"
#include "bodyloom/pipelines/person/picture_refiner.h"
#include "bodyloom/render/person/person_layers.h"
#include "tests/support/random_picture_unet.h"

namespace bodyloom {
namespace {

/// Anything, but nobody in one corner and somebody all through another.
PersonLayers RandomLayers(int width, int height) {
  torch::manual_seed(3);
  PersonLayers layers;
  layers.width = width, layers.height = height;
  torch::Tensor planes = torch::rand({PersonPlane::kCount, height, width});
  planes[PersonPlane::kAlpha].slice(0, 0, 30).slice(1, 0, 30).zero_();
  planes[PersonPlane::kAlpha].slice(0, height - 30, height).slice(1, width - 30, width).fill_(1);
  layers.planes = HostValues<float>(planes);
  return layers;
}

torch::Tensor PlanesOf(PersonLayers* layers) {
  return torch::from_blob(layers->planes.data(), {1, PersonPlane::kCount, layers->height, layers->width});
}

TEST(RefinerModule, ChangesNothingBeforeItHasLearned) {
  RefinerModule module(true);
  const torch::NoGradGuard no_grad;
  PersonLayers layers = RandomLayers(64, 128);
  const torch::Tensor change = module(PlanesOf(&layers));
  EXPECT_EQ(change.sizes(), (std::vector<int64_t>{1, 4, 128, 64}));
  EXPECT_EQ(change.abs().max().item<float>(), 0);
}

TEST(RefinerModule, RunsWithoutLibTorchTheSame) {
  RefinerModule module(true);
  const RefinerWeights weights = RandomRefiner(0.5F);
  ImportPictureUnet(weights.network, &module->network);
  PictureRefiner native(weights);
  const torch::NoGradGuard no_grad;
  for (const auto& [width, height] : {std::pair(64, 128), std::pair(192, 64)}) {
    PersonLayers layers = RandomLayers(width, height);
    const std::vector<float> here = HostValues<float>(module(PlanesOf(&layers))), there = native.Change(layers);
    ASSERT_EQ(here.size(), there.size());
    float largest = 0;
    const size_t alpha = PersonPlane::kAlpha * layers.pixels();
    EXPECT_EQ(there[alpha], 0) << "nobody near";
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

TEST(RefinerModule, LeavesTheOutlineAlone) {
  RefinerModule module(false);
  RefinerWeights weights = RandomRefiner(0.5F);
  ImportPictureUnet(weights.network, &module->network);
  weights.moves_outline = false;
  PictureRefiner native(weights);
  const torch::NoGradGuard no_grad;
  PersonLayers layers = RandomLayers(64, 128);
  const std::vector<float> here = HostValues<float>(module(PlanesOf(&layers))), there = native.Change(layers);
  ASSERT_EQ(here.size(), there.size());
  const size_t alpha = PersonPlane::kAlpha * layers.pixels();
  float largest = 0;
  for (size_t i = 0; i < alpha; ++i) {
    ASSERT_NEAR(here[i], there[i], 2e-4F) << i;
    largest = std::max(largest, std::abs(there[i]));
  }
  EXPECT_GT(largest, 0.1F);
  for (size_t i = alpha; i < here.size(); ++i) {
    ASSERT_EQ(here[i], 0) << i;
    ASSERT_EQ(there[i], 0) << i;
  }
}

TEST(RefinerModule, RefusesWhatItCannotUse) {
  PictureRefiner native(RandomRefiner(0));
  EXPECT_THROW(native.Change({}), std::invalid_argument);
  EXPECT_THROW(native.Change(RandomLayers(64, 40)), std::invalid_argument);
  EXPECT_THROW(PictureRefiner{RefinerWeights()}, std::invalid_argument);
}

}  // namespace
}  // namespace bodyloom
