// SPDX-License-Identifier: Apache-2.0
#include "neural/networks/uv_sampler.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/support/gradient_check.h"

namespace bodyloom::pull_push_test {
namespace {

using torch::Tensor;

/// One plane and its mask.
struct Plane {
  int height = 0, width = 0;
  std::vector<double> x, mask;
};

double Enlarged(const Plane& small, int y, int x) {
  const double v = std::max(0.0, (y + 0.5) / 2 - 0.5), u = std::max(0.0, (x + 0.5) / 2 - 0.5);
  const int i = static_cast<int>(v), j = static_cast<int>(u);
  const int i1 = std::min(i + 1, small.height - 1), j1 = std::min(j + 1, small.width - 1);
  const double s = v - i, t = u - j;
  const auto at = [&](int row, int column) { return small.x[row * small.width + column]; };
  return (1 - s) * ((1 - t) * at(i, j) + t * at(i, j1)) + s * ((1 - t) * at(i1, j) + t * at(i1, j1));
}

/// The definition, pixel by pixel.
std::vector<double> SlowPullPush(const Plane& plane, int levels) {
  const auto pixels = static_cast<size_t>(plane.height) * plane.width;
  std::vector<double> result(pixels, 0);
  for (size_t i = 0; i < pixels; ++i) result[i] = plane.mask[i] > 0 ? plane.x[i] : 0;
  if (levels == 0 || plane.height % 2 != 0 || plane.width % 2 != 0) return result;
  Plane coarse{plane.height / 2, plane.width / 2, {}, {}};
  for (int i = 0; i < coarse.height; ++i) {
    for (int j = 0; j < coarse.width; ++j) {
      double sum = 0;
      int count = 0;
      for (const int at : {2 * i * plane.width + 2 * j, 2 * i * plane.width + 2 * j + 1,
                           (2 * i + 1) * plane.width + 2 * j, (2 * i + 1) * plane.width + 2 * j + 1}) {
        if (plane.mask[at] == 0) continue;
        sum += plane.x[at];
        ++count;
      }
      coarse.x.push_back(count > 0 ? sum / count : 0);
      coarse.mask.push_back(count > 0 ? 1 : 0);
    }
  }
  coarse.x = SlowPullPush(coarse, levels - 1);
  for (size_t i = 0; i < pixels; ++i) {
    if (plane.mask[i] == 0) {
      result[i] = Enlarged(coarse, static_cast<int>(i) / plane.width, static_cast<int>(i) % plane.width);
    }
  }
  return result;
}

TEST(PullPush, AgreesWithItsDefinition) {
  torch::manual_seed(4);
  for (const double share : {0.02, 0.3, 0.9}) {
    const Tensor x = torch::randn({2, 3, 24, 16}, torch::kDouble);
    const Tensor mask = (torch::rand({2, 1, 24, 16}) < share).to(torch::kDouble);
    for (const int levels : {0, 1, 3, 9}) {  // 24 halves three times
      const Tensor filled = PullPush(x, mask, levels).contiguous();
      for (int64_t b = 0; b < 2; ++b) {
        for (int64_t c = 0; c < 3; ++c) {
          const auto values = [](const Tensor& plane) {
            const Tensor whole = plane.contiguous();
            return std::vector<double>(whole.data_ptr<double>(), whole.data_ptr<double>() + whole.numel());
          };
          const std::vector<double> expected = SlowPullPush({24, 16, values(x[b][c]), values(mask[b][0])}, levels);
          const std::vector<double> found = values(filled[b][c]);
          for (size_t i = 0; i < expected.size(); ++i) ASSERT_NEAR(found[i], expected[i], 1e-12) << share << " " << i;
        }
      }
    }
  }
}

TEST(PullPush, OneColourFillsWhatItReachesAndNothingStaysNothing) {
  Tensor mask = torch::zeros({1, 1, 32, 32});
  mask.slice(2, 10, 12).slice(3, 4, 30).fill_(1);
  const Tensor filled = PullPush(torch::full({1, 1, 32, 32}, 0.7), mask, 5);
  EXPECT_LT((filled - 0.7).abs().max().item<float>(), 1e-6);
  EXPECT_EQ(PullPush(torch::ones({1, 2, 32, 32}), torch::zeros({1, 1, 32, 32}), 5).abs().max().item<float>(), 0);
  // Masked pixels have no influence.
  Tensor odd = torch::full({1, 1, 32, 32}, 1e6);
  odd.slice(2, 10, 12).slice(3, 4, 30).fill_(0.7);
  EXPECT_TRUE(torch::equal(PullPush(odd, mask, 5), filled));
  EXPECT_THROW(PullPush(odd, torch::ones({1, 1, 32, 16}), 5), std::invalid_argument);
  EXPECT_THROW(PullPush(odd, torch::ones({1, 2, 32, 32}), 5), std::invalid_argument);
}

TEST(PullPush, DerivativesAgreeWithDifferences) {
  torch::manual_seed(5);
  const Tensor mask = (torch::rand({1, 1, 8, 8}) < 0.3).to(torch::kDouble);
  const Tensor weights = torch::randn({1, 2, 8, 8}, torch::kDouble);
  const GradientCheck check =
      CheckGradients([&](const std::vector<Tensor>& x) { return (PullPush(x[0], mask, 3) * weights).sum(); },
                     {torch::randn({1, 2, 8, 8}, torch::kDouble)});
  EXPECT_LT(check.max_error, 1e-7);
  EXPECT_GT(check.num_nonzero, 10);
}

}  // namespace
}  // namespace bodyloom::pull_push_test
