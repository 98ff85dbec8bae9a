// SPDX-License-Identifier: Apache-2.0
#include "neural/densepose/paste_charts.h"

#include <gtest/gtest.h>
#include <torch/torch.h>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

namespace bodyloom::paste_charts_test {
namespace {

constexpr int kRows = 8, kColumns = 10, kCells = kRows * kColumns;

/// Planes that are linear in row and column, whose interpolation is linear too: person below row `waist`, chart 3 left
/// of column `middle` and chart 7 right of it, u rising to the right and v downwards by different slopes a chart.
struct LinearPlanes {
  static constexpr float kWaist = 2.25F, kMiddle = 4.4F;
  static float U(int part, double column) { return float(0.01 * part + 0.05 * column); }
  static float V(int part, double row) { return float(0.02 * part + 0.06 * row); }

  LinearPlanes() : coarse(2 * kCells), fine(25 * kCells, -100), u(25 * kCells), v(25 * kCells) {
    for (int r = 0; r < kRows; ++r) {
      for (int c = 0; c < kColumns; ++c) {
        const size_t cell = size_t(r) * kColumns + size_t(c);
        coarse[kCells + cell] = float(r) - kWaist;
        fine[3 * kCells + cell] = kMiddle - float(c);
        fine[7 * kCells + cell] = float(c) - kMiddle;
        for (int part = 0; part < 25; ++part) {
          u[size_t(part) * kCells + cell] = U(part, c);
          v[size_t(part) * kCells + cell] = V(part, r);
        }
      }
    }
  }
  [[nodiscard]] ChartPlanes view() const {
    return {2, kRows, kColumns, coarse.data(), fine.data(), u.data(), v.data()};
  }

  std::vector<float> coarse, fine, u, v;
};

TEST(PasteCharts, LinearPlanesAreWhatTheyAreAtEachPixelOfTheBox) {
  const LinearPlanes planes;
  const ChartDetection box = {30.3, 11.8, 97.6, 81.1, 1, {}};
  const ChartImage image = PasteCharts(planes.view(), box, 200, 100);
  // Pixels whose centres are inside: 30.5 to 97.5 (97 + ½ < 97.6), 12.5 to 80.5.
  EXPECT_EQ(image.x_begin, 30);
  EXPECT_EQ(image.width, 68);
  EXPECT_EQ(image.y_begin, 12);
  EXPECT_EQ(image.height, 69);
  int parts[25] = {};
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      double column = (image.x_begin + x + 0.5 - box.x0) * kColumns / (box.x1 - box.x0) - 0.5;
      double row = (image.y_begin + y + 0.5 - box.y0) * kRows / (box.y1 - box.y0) - 0.5;
      column = std::clamp(column, 0.0, kColumns - 1.0);
      row = std::clamp(row, 0.0, kRows - 1.0);
      const int part = row <= LinearPlanes::kWaist ? 0 : column < LinearPlanes::kMiddle ? 3 : 7;
      const size_t i = size_t(y) * size_t(image.width) + size_t(x);
      ASSERT_EQ(image.part[i], part) << x << " " << y;
      ++parts[part];
      if (part == 0) continue;
      ASSERT_NEAR(image.u[i], LinearPlanes::U(part, column), 1e-5);
      ASSERT_NEAR(image.v[i], LinearPlanes::V(part, row), 1e-5);
    }
  }
  EXPECT_GT(parts[0], 1000);
  EXPECT_GT(parts[3], 1000);
  EXPECT_GT(parts[7], 1000);
}

TEST(PasteCharts, AgreesWithLibTorchsResizeOfAWholeBox) {
  torch::manual_seed(3);
  const int height = 37, width = 53, channels = 15;
  const auto random = [](int64_t count) { return torch::randn({1, count, kRows, kColumns}); };
  const torch::Tensor coarse = random(channels), fine = random(25), u = torch::rand({1, 25, kRows, kColumns}),
                      v = 1 - u;
  const auto resized = [&](const torch::Tensor& planes) {
    namespace F = torch::nn::functional;
    return F::interpolate(planes, F::InterpolateFuncOptions()
                                      .size(std::vector<int64_t>{height, width})
                                      .mode(torch::kBilinear)
                                      .align_corners(false))[0];
  };
  const torch::Tensor label = resized(fine).argmax(0) * (resized(coarse).argmax(0) > 0);
  const torch::Tensor expected_u = resized(u).gather(0, label.unsqueeze(0))[0];
  const ChartPlanes planes = {
      channels,           kRows, kColumns, coarse.data_ptr<float>(), fine.data_ptr<float>(), u.data_ptr<float>(),
      v.data_ptr<float>()};
  const ChartImage image = PasteCharts(planes, {4, 9, 4.0 + width, 9.0 + height, 1, {}}, 100, 100);
  ASSERT_EQ(image.part.size(), size_t(height) * width);
  int seen = 0;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const size_t i = size_t(y) * width + size_t(x);
      ASSERT_EQ(image.part[i], label[y][x].item<int>()) << x << " " << y;
      if (image.part[i] == 0) continue;
      ++seen;
      ASSERT_NEAR(image.u[i], expected_u[y][x].item<float>(), 1e-5);
      ASSERT_NEAR(image.v[i], 1 - expected_u[y][x].item<float>(), 1e-5);
    }
  }
  EXPECT_GT(seen, 1000);
}

TEST(PasteCharts, ABoxThatLeavesTheImageIsCutNotMoved) {
  const LinearPlanes planes;
  const ChartDetection box = {-20, -15, 60, 65, 1, {}};
  const ChartImage whole = PasteCharts(planes.view(), {0, 0, 80, 80, 1, {}}, 200, 200);
  const ChartImage cut = PasteCharts(planes.view(), box, 40, 50);
  EXPECT_EQ(cut.x_begin, 0);
  EXPECT_EQ(cut.y_begin, 0);
  ASSERT_EQ(cut.width, 40);
  ASSERT_EQ(cut.height, 50);
  for (int y = 0; y < cut.height; ++y) {
    for (int x = 0; x < cut.width; ++x) {
      const size_t i = size_t(y) * 40 + size_t(x), j = size_t(y + 15) * 80 + size_t(x + 20);
      ASSERT_EQ(cut.part[i], whole.part[j]);
      ASSERT_NEAR(cut.u[i], whole.u[j], 1e-6);
    }
  }
}

TEST(PasteCharts, UAndVAreClampedAndNumbersThatAreNoneAreBackground) {
  LinearPlanes planes;
  for (float& u : planes.u) u = 1.5F;
  for (float& v : planes.v) v = -0.5F;
  ChartImage image = PasteCharts(planes.view(), {0, 0, 20, 20, 1, {}}, 20, 20);
  const size_t last = image.part.size() - 1;
  EXPECT_EQ(image.part[last], 7);
  EXPECT_EQ(image.u[last], 1);
  EXPECT_EQ(image.v[last], 0);
  for (float& u : planes.u) u = std::numeric_limits<float>::quiet_NaN();
  image = PasteCharts(planes.view(), {0, 0, 20, 20, 1, {}}, 20, 20);
  EXPECT_EQ(image.part, std::vector<uint8_t>(400, 0));
}

TEST(PasteCharts, EmptyAndEndlessBoxesHoldNothing) {
  const LinearPlanes planes;
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN(), kInf = std::numeric_limits<double>::infinity();
  for (const ChartDetection& box :
       {ChartDetection{5, 5, 5, 9, 1, {}}, ChartDetection{9, 5, 5, 9, 1, {}}, ChartDetection{kNan, 5, 8, 9, 1, {}},
        ChartDetection{0, 0, kInf, 9, 1, {}}, ChartDetection{500, 500, 600, 600, 1, {}}}) {
    EXPECT_TRUE(PasteCharts(planes.view(), box, 20, 20).part.empty()) << box.x0;
  }
  ChartPlanes no_cells = planes.view();
  no_cells.height = 0;
  EXPECT_THROW(PasteCharts(no_cells, {0, 0, 9, 9, 1, {}}, 20, 20), std::invalid_argument);
}

}  // namespace
}  // namespace bodyloom::paste_charts_test
