// SPDX-License-Identifier: Apache-2.0
#include "neural/networks/image_unet_module.h"

#include <gtest/gtest.h>
#include <torch/torch.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "neural/base/device.h"
#include "tests/support/random_image_unet.h"
#include "tracking/detection/inference/image_unet_runner.h"

namespace bodyloom::image_unet_module_test {
namespace {

constexpr ImageUnetPlanes kFiveToThree = {5, 3};

TEST(ImageUnetModule, AnswersNothingBeforeItHasLearned) {
  torch::manual_seed(3);
  ImageUnetModule module(kFiveToThree);
  const torch::NoGradGuard no_grad;
  const torch::Tensor answer = module(torch::rand({2, 5, 48, 32}));
  EXPECT_EQ(answer.sizes(), (std::vector<int64_t>{2, 3, 48, 32}));
  EXPECT_EQ(answer.abs().max().item<float>(), 0);
}

TEST(ImageUnetModule, RunsWithoutLibTorchTheSame) {
  torch::manual_seed(3);
  ImageUnetModule module(kFiveToThree);
  const ImageUnetWeights weights = RandomImageUnet(kFiveToThree, 0.5F);
  ImportImageUnet(weights, &module);
  ImageUnetRunner native(weights, kFiveToThree);
  const torch::NoGradGuard no_grad;
  for (const auto& [width, height] : {std::pair(16, 48), std::pair(64, 32), std::pair(16, 48)}) {
    const torch::Tensor planes = torch::rand({1, 5, height, width});
    const std::vector<float> here = HostValues<float>(module(planes));
    const std::vector<float> there = native.Run(width, height, HostValues<float>(planes));
    ASSERT_EQ(here.size(), there.size());
    float largest = 0;
    for (size_t i = 0; i < here.size(); ++i) {
      ASSERT_NEAR(here[i], there[i], 2e-4F) << i;
      largest = std::max(largest, std::abs(here[i]));
    }
    EXPECT_GT(largest, 0.1F);
  }
}

TEST(ImageUnetModule, NumbersGoOutAndIn) {
  ImageUnetModule module(kFiveToThree);
  const ImageUnetWeights weights = RandomImageUnet(kFiveToThree, 1);
  ImportImageUnet(weights, &module);
  const ImageUnetWeights back = ExportImageUnet(module);
  EXPECT_EQ(back.num_parameters(), weights.num_parameters());
  for (size_t i = 0; i < weights.convolutions.size(); ++i) {
    EXPECT_TRUE(back.convolutions[i].kernel == weights.convolutions[i].kernel) << i;
    EXPECT_TRUE(back.convolutions[i].bias == weights.convolutions[i].bias) << i;
  }
  EXPECT_THROW(ImportImageUnet({}, &module), std::invalid_argument);
}

TEST(ImageUnetModule, RefusesOtherSizes) {
  ImageUnetModule module(kFiveToThree);
  EXPECT_THROW(module(torch::zeros({1, 5, 60, 64})), std::invalid_argument);
  EXPECT_THROW(module(torch::zeros({1, 4, 64, 64})), std::invalid_argument);
  ImageUnetRunner native(RandomImageUnet(kFiveToThree, 0), kFiveToThree);
  EXPECT_THROW(native.Run(0, 0, {}), std::invalid_argument);
  EXPECT_THROW(native.Run(16, 24, std::vector<float>(size_t{5} * 16 * 24)), std::invalid_argument);
  EXPECT_THROW(native.Run(16, 16, std::vector<float>(size_t{4} * 16 * 16)), std::invalid_argument);
  EXPECT_THROW(ImageUnetRunner(RandomImageUnet(kFiveToThree, 0), {5, 4}), std::invalid_argument);
}

}  // namespace
}  // namespace bodyloom::image_unet_module_test
