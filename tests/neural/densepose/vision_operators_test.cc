// SPDX-License-Identifier: Apache-2.0
#include "neural/densepose/vision_operators.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <torch/csrc/jit/ir/irparser.h>
#include <torch/script.h>

#include <memory>
#include <numeric>
#include <sstream>
#include <vector>

namespace bodyloom::vision_operators_test {
namespace {

using ::testing::ElementsAre;

std::vector<int64_t> Values(const torch::Tensor& indices) {
  EXPECT_EQ(indices.scalar_type(), torch::kLong);
  return {indices.data_ptr<int64_t>(), indices.data_ptr<int64_t>() + indices.numel()};
}

TEST(NonMaximumSuppression, KeepsTheBestOfBoxesThatOverlapTooMuch) {
  // The first two share 80 of 120: IoU 2/3. The third touches the first. The fourth is the second again, as good.
  const torch::Tensor boxes =
      torch::tensor({{0.F, 0.F, 10.F, 10.F}, {2.F, 0.F, 12.F, 10.F}, {10.F, 0.F, 20.F, 10.F}, {2.F, 0.F, 12.F, 10.F}});
  const torch::Tensor scores = torch::tensor({0.5F, 0.9F, 0.7F, 0.9F});
  EXPECT_THAT(Values(NonMaximumSuppression(boxes, scores, 0.66)), ElementsAre(1, 2));
  EXPECT_THAT(Values(NonMaximumSuppression(boxes, scores, 0.67)), ElementsAre(1, 2, 0));
  EXPECT_THAT(Values(NonMaximumSuppression(boxes, scores, 1)), ElementsAre(1, 3, 2, 0));
  EXPECT_EQ(NonMaximumSuppression(torch::zeros({0, 4}), torch::zeros({0}), 0.5).numel(), 0);
  EXPECT_THROW(NonMaximumSuppression(boxes, torch::zeros({3}), 0.5), c10::Error);
}

/// Features of two pictures that are linear in column and row, other in each channel.
torch::Tensor LinearFeatures(int height, int width) {
  const torch::Tensor y = torch::arange(height, torch::kFloat).view({height, 1});
  const torch::Tensor x = torch::arange(width, torch::kFloat).view({1, width});
  const torch::Tensor first = torch::stack({1 + 2 * x + 0 * y, 3 * y - x, 0 * x + 0 * y + 7});
  return torch::stack({first, 10 * first});
}

TEST(RegionAlign, TheMeanOfALinearFunctionIsItsValueAtTheMiddleOfTheBin) {
  const torch::Tensor features = LinearFeatures(20, 30);
  const torch::Tensor regions = torch::tensor({{0.F, 10.F, 8.F, 42.F, 30.F}, {1.F, 6.F, 9.F, 31.F, 33.F}});
  for (const bool aligned : {true, false}) {
    for (const int sampling_ratio : {2, 3, 0}) {
      const torch::Tensor pooled = RegionAlign(features, regions, 0.5, 3, 4, sampling_ratio, aligned);
      ASSERT_EQ(pooled.sizes(), (std::vector<int64_t>{2, 3, 3, 4}));
      for (int k = 0; k < 2; ++k) {
        const auto edge = [&](int i) { return 0.5 * regions[k][i].item<double>() - (aligned ? 0.5 : 0); };
        for (int row = 0; row < 3; ++row) {
          for (int column = 0; column < 4; ++column) {
            const double y = edge(2) + (edge(4) - edge(2)) * (row + 0.5) / 3;
            const double x = edge(1) + (edge(3) - edge(1)) * (column + 0.5) / 4;
            const double scale = k == 0 ? 1 : 10;
            EXPECT_NEAR(pooled[k][0][row][column].item<double>(), scale * (1 + 2 * x), 1e-3);
            EXPECT_NEAR(pooled[k][1][row][column].item<double>(), scale * (3 * y - x), 1e-3);
            EXPECT_NEAR(pooled[k][2][row][column].item<double>(), scale * 7, 1e-3);
          }
        }
      }
    }
  }
}

TEST(RegionAlign, TheBorderIsHeldForOneCellAndThenThereIsNothing) {
  const torch::Tensor features = torch::full({1, 1, 4, 4}, 5.F);
  const auto at = [&](float x) {  // one sample in the middle of a cell-sized region
    return RegionAlign(features, torch::tensor({{0.F, x - 0.5F, 1.F, x + 0.5F, 2.F}}), 1, 1, 1, 1, false).item<float>();
  };
  EXPECT_EQ(at(-0.75F), 5);
  EXPECT_EQ(at(-1.25F), 0);
  EXPECT_EQ(at(3.75F), 5);
  EXPECT_EQ(at(4.25F), 0);
}

TEST(RegionAlign, ASmallRegionIsOneCellUnlessAligned) {
  const torch::Tensor features = LinearFeatures(9, 9).slice(0, 0, 1);
  const torch::Tensor point = torch::tensor({{0.F, 4.F, 4.F, 4.F, 4.F}});
  EXPECT_NEAR(RegionAlign(features, point, 1, 1, 1, 2, false)[0][0].item<float>(), 1 + 2 * 4.5, 1e-5);
  EXPECT_NEAR(RegionAlign(features, point, 1, 1, 1, 2, true)[0][0].item<float>(), 1 + 2 * 3.5, 1e-5);
}

TEST(RegionAlign, RefusesWhatDoesNotFit) {
  EXPECT_THROW(RegionAlign(torch::zeros({1, 3, 4}), torch::zeros({1, 5}), 1, 1, 1, 1, true), c10::Error);
  EXPECT_THROW(RegionAlign(torch::zeros({1, 1, 4, 4}), torch::zeros({1, 4}), 1, 1, 1, 1, true), c10::Error);
  EXPECT_THROW(RegionAlign(torch::zeros({1, 1, 4, 4}), torch::ones({1, 5}), 1, 1, 1, 1, true), c10::Error);
  EXPECT_EQ(RegionAlign(torch::zeros({1, 2, 4, 4}), torch::zeros({0, 5}), 1, 3, 3, 2, true).size(0), 0);
}

/// A saved module whose forward is this graph over inputs after %self.
std::string Saved(const std::string& ir) {
  torch::jit::Module module("Calls");
  const auto graph = std::make_shared<torch::jit::Graph>();
  torch::jit::parseIR(ir, graph.get());
  graph->inputs()[0]->setType(module.type());
  module.type()->addMethod(module._ivalue()->compilation_unit()->create_function(
      c10::QualifiedName(*module.type()->name(), "forward"), graph));
  std::ostringstream bytes;
  module.save(bytes);
  return bytes.str();
}

TEST(VisionOperators, SavedProgramsThatCallTorchvisionRun) {
  RegisterVisionOperators();
  RegisterVisionOperators();
  std::istringstream nms(Saved(R"IR(graph(%self, %boxes : Tensor, %scores : Tensor):
  %threshold : float = prim::Constant[value=0.5]()
  %kept : Tensor = torchvision::nms(%boxes, %scores, %threshold)
  return (%kept))IR"));
  const torch::Tensor boxes = torch::tensor({{0.F, 0.F, 10.F, 10.F}, {2.F, 0.F, 12.F, 10.F}});
  EXPECT_THAT(Values(torch::jit::load(nms).forward({boxes, torch::tensor({0.2F, 0.4F})}).toTensor()), ElementsAre(1));

  std::istringstream align(Saved(R"IR(graph(%self, %features : Tensor, %regions : Tensor):
  %scale : float = prim::Constant[value=0.5]()
  %side : int = prim::Constant[value=2]()
  %ratio : int = prim::Constant[value=0]()
  %aligned : bool = prim::Constant[value=1]()
  %pooled : Tensor = torchvision::roi_align(%features, %regions, %scale, %side, %side, %ratio, %aligned)
  return (%pooled))IR"));
  const torch::Tensor features = LinearFeatures(20, 30), regions = torch::tensor({{0.F, 10.F, 8.F, 42.F, 30.F}});
  EXPECT_TRUE(torch::jit::load(align)
                  .forward({features, regions})
                  .toTensor()
                  .equal(RegionAlign(features, regions, 0.5, 2, 2, 0, true)));
}

}  // namespace
}  // namespace bodyloom::vision_operators_test
