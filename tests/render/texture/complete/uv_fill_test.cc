// SPDX-License-Identifier: Apache-2.0
#include "render/texture/complete/uv_fill.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <stdexcept>

#include "tests/support/meshes.h"

namespace bodyloom::uv_fill_test {
namespace {

using Eigen::Vector3d;

/// A sphere's atlas, a smooth function on the sphere, and a mask with holes: one octant as a whole, discs elsewhere.
class UvFill : public testing::Test {
 protected:
  UvFill()
      : body_(SphereOfOctants(4)),
        table_(BuildUvTexelTable(body_, {.width = 96, .height = 48})),
        truth_(96 * 48, 0.0F),
        known_(96 * 48, 0) {
    for (size_t i = 0; i < table_.size(); ++i) {
      Vector3d p = Vector3d::Zero();
      for (int k = 0; k < 3; ++k) {
        p += double{table_.barycentric[i][k]} *
             body_.data().v_template.row(body_.data().faces(table_.face[i], k)).transpose();
      }
      truth_[table_.pixel[i]] = static_cast<float>(0.5 + 0.4 * p.normalized().z());
      if (table_.in_gutter[i]) continue;
      const bool whole_octant = table_.chart_at[table_.pixel[i]] == 2;
      const bool disc = (p.normalized() - Vector3d(0.6, -0.6, 0.5).normalized()).norm() < 0.3;
      known_[table_.pixel[i]] = !whole_octant && !disc;
      num_holes_ += whole_octant || disc;
    }
  }

  [[nodiscard]] std::vector<float> WithHoles(float hole) const {
    std::vector<float> map = truth_;
    for (size_t p = 0; p < map.size(); ++p) {
      if (!known_[p]) map[p] = hole;
    }
    return map;
  }

  using Filler = std::function<void(std::span<const uint8_t>, int, std::span<float>)>;
  [[nodiscard]] std::vector<std::pair<const char*, Filler>> Fillers() const {
    return {{"pyramid", [this](std::span<const uint8_t> known, int channels,
                               std::span<float> maps) { PyramidFill(body_, table_).Fill(known, channels, maps); }},
            {"laplace", [this](std::span<const uint8_t> known, int channels, std::span<float> maps) {
               LaplaceFill(body_, table_, known).Fill(channels, maps);
             }}};
  }

  BodyModel body_;
  UvTexelTable table_;
  std::vector<float> truth_;
  std::vector<uint8_t> known_;
  int num_holes_ = 0;
};

TEST_F(UvFill, GraphCrossesSeams) {
  const UvGraph graph = BuildUvGraph(body_, table_);
  EXPECT_EQ(graph.num_nodes(), table_.num_inside);
  EXPECT_GT(graph.num_seam_links, 150);
  // Connected as a whole, though the charts are eight; links lead to near points of the sphere.
  std::vector<char> reached(graph.num_nodes(), 0);
  std::vector<int> front = {0};
  reached[0] = 1;
  int count = 1;
  while (!front.empty()) {
    const int a = front.back();
    front.pop_back();
    for (int k = graph.begin[a]; k < graph.begin[a + 1]; ++k) {
      const int b = graph.neighbour[k];
      ASSERT_NE(a, b);
      ASSERT_LT(std::abs(truth_[graph.pixel[a]] - truth_[graph.pixel[b]]), 0.15F);
      if (reached[b]) continue;
      reached[b] = 1;
      ++count;
      front.push_back(b);
    }
  }
  EXPECT_EQ(count, graph.num_nodes());
}

TEST_F(UvFill, KeepsWhatIsKnownAndStaysInItsRange) {
  ASSERT_GT(num_holes_, 100);
  for (const auto& [name, fill] : Fillers()) {
    std::vector<float> map = WithHoles(-7);
    fill(known_, 1, map);
    double squares = 0;
    for (size_t i = 0; i < table_.size(); ++i) {
      const int p = table_.pixel[i];
      if (known_[p]) {
        ASSERT_EQ(map[p], truth_[p]);
      }
      ASSERT_GE(map[p], 0.1F - 1e-6F) << name;
      ASSERT_LE(map[p], 0.9F + 1e-6F) << name;
      if (!known_[p] && !table_.in_gutter[i]) squares += std::pow(map[p] - truth_[p], 2);
    }
    // z is not harmonic on the sphere, and an octant is a large hole: half of what the mean would give.
    EXPECT_LT(std::sqrt(squares / num_holes_), 0.12) << name;
    // Constants stay constants.
    std::fill(map.begin(), map.end(), 0.25F);
    for (size_t p = 0; p < map.size(); ++p) map[p] = known_[p] ? 0.25F : 9.0F;
    fill(known_, 1, map);
    for (size_t i = 0; i < table_.size(); ++i) ASSERT_NEAR(map[table_.pixel[i]], 0.25F, 1e-6F) << name;
  }
}

TEST_F(UvFill, LaplaceIsTheMeanOfItsNeighboursEverywhere) {
  std::vector<float> map = WithHoles(0);
  LaplaceFill(body_, table_, known_).Fill(1, map);
  const UvGraph graph = BuildUvGraph(body_, table_);
  int checked = 0;
  for (int a = 0; a < graph.num_nodes(); ++a) {
    if (known_[graph.pixel[a]]) continue;
    double mean = 0;
    for (int k = graph.begin[a]; k < graph.begin[a + 1]; ++k) mean += map[graph.pixel[graph.neighbour[k]]];
    mean /= graph.begin[a + 1] - graph.begin[a];
    ASSERT_NEAR(map[graph.pixel[a]], mean, 2e-6);
    ++checked;
  }
  EXPECT_EQ(checked, num_holes_);
}

TEST_F(UvFill, PyramidIsNearTheLaplacian) {
  std::vector<float> exact = WithHoles(0), fast = exact;
  LaplaceFill(body_, table_, known_).Fill(1, exact);
  PyramidFill(body_, table_).Fill(known_, 1, fast);
  double squares = 0;
  for (size_t p = 0; p < exact.size(); ++p) {
    if (!known_[p]) squares += std::pow(exact[p] - fast[p], 2);
  }
  EXPECT_LT(std::sqrt(squares / num_holes_), 0.06);
}

TEST_F(UvFill, SeamsDoNotShow) {
  // At a seam inside a hole the two sides agree: neighbours across the seam differ no more than those beside it.
  for (const auto& [name, fill] : Fillers()) {
    std::vector<float> map = WithHoles(0);
    fill(known_, 1, map);
    const UvGraph graph = BuildUvGraph(body_, table_);
    double across = 0, within = 0;
    for (int a = 0; a < graph.num_nodes(); ++a) {
      for (int k = graph.begin[a]; k < graph.begin[a + 1]; ++k) {
        const int b = graph.neighbour[k], pa = graph.pixel[a], pb = graph.pixel[b];
        if (known_[pa]) continue;
        double& worst = table_.chart_at[pa] != table_.chart_at[pb] ? across : within;
        worst = std::max<double>(worst, std::abs(map[pa] - map[pb]));
      }
    }
    EXPECT_GT(across, 0);
    EXPECT_LT(across, 2 * within + 0.02) << name;
  }
}

TEST_F(UvFill, ManyChannelsAreFilledEachByItself) {
  for (const auto& [name, fill] : Fillers()) {
    std::vector<float> one = WithHoles(0), three;
    for (int c = 0; c < 3; ++c) {
      for (const float x : one) three.push_back(static_cast<float>(c) * x + 1);
    }
    fill(known_, 3, three);
    fill(known_, 1, one);
    for (size_t p = 0; p < one.size(); ++p) {
      if (table_.chart_at[p] < 0) continue;
      ASSERT_NEAR(three[p], 1, 1e-6) << name;
      ASSERT_NEAR(three[2 * one.size() + p], 2 * one[p] + 1, 1e-5) << name;
    }
  }
}

TEST_F(UvFill, WithNothingKnownLeavesTheMapAlone) {
  const std::vector<uint8_t> none(known_.size(), 0);
  for (const auto& [name, fill] : Fillers()) {
    std::vector<float> map(known_.size(), 0.5F);
    fill(none, 1, map);
    for (const float x : map) ASSERT_EQ(x, 0.5F) << name;
    std::vector<uint8_t> all(known_.size(), 1);
    map = truth_;
    fill(all, 1, map);
    for (size_t i = 0; i < table_.size(); ++i) ASSERT_NEAR(map[table_.pixel[i]], truth_[table_.pixel[i]], 0.06F);
    EXPECT_THROW(fill(std::span(known_).first(5), 1, map), std::invalid_argument);
    EXPECT_THROW(fill(known_, 2, map), std::invalid_argument);
  }
}

TEST_F(UvFill, GutterTakesKnownTexelsOnly) {
  std::vector<float> map = WithHoles(-7);
  for (size_t i = 0; i < table_.size(); ++i) {
    if (table_.in_gutter[i]) map[table_.pixel[i]] = -9;
  }
  FillGutter(body_, table_, known_, 1, map);
  int filled = 0, left = 0;
  for (size_t i = 0; i < table_.size(); ++i) {
    const int p = table_.pixel[i];
    if (!table_.in_gutter[i]) {
      ASSERT_EQ(map[p], known_[p] ? truth_[p] : -7);
      continue;
    }
    ++(map[p] == -9 ? left : filled);
    if (map[p] != -9) {
      ASSERT_NEAR(map[p], truth_[p], 0.1);
    }
  }
  EXPECT_GT(filled, 200);
  EXPECT_GT(left, 20);  // those that show the octant nobody has seen
}

TEST_F(UvFill, PartsThatNothingKnownTouchesTakeTheMean) {
  // Two spheres in one atlas, all of one unknown.
  BodyModelData two = SphereOfOctants(2);
  const UvTexelTable table = BuildUvTexelTable(BodyModel(two), {.width = 64, .height = 32, .gutter = 0});
  // Without a gutter no seam is crossed: each chart is by itself.
  std::vector<uint8_t> known(64 * 32, 0);
  for (size_t i = 0; i < table.size(); ++i) known[table.pixel[i]] = table.chart_at[table.pixel[i]] == 0;
  for (const int kind : {0, 1}) {
    std::vector<float> map(64 * 32, -1.0F);
    double sum = 0;
    int count = 0;
    for (int p = 0; p < 64 * 32; ++p) {
      if (!known[p]) continue;
      map[p] = static_cast<float>(p % 7);
      sum += map[p];
      ++count;
    }
    if (kind == 0) {
      PyramidFill(BodyModel(two), table).Fill(known, 1, map);
    } else {
      LaplaceFill(BodyModel(two), table, known).Fill(1, map);
    }
    for (size_t i = 0; i < table.size(); ++i) {
      if (!known[table.pixel[i]]) {
        ASSERT_NEAR(map[table.pixel[i]], sum / count, 1e-4);
      }
    }
  }
}

}  // namespace
}  // namespace bodyloom::uv_fill_test
