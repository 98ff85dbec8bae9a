// SPDX-License-Identifier: Apache-2.0
#include "geometry/uv_maps/uv_bake.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <stdexcept>
#include <vector>

#include "geometry/body/skinning_simd.h"
#include "geometry/uv_maps/uv_bake_simd.h"
#include "tests/support/meshes.h"

namespace bodyloom::uv_bake_test {
namespace {

std::vector<float> RandomValues(size_t n, uint32_t seed) {
  std::mt19937 random(seed);
  std::vector<float> values(n);
  for (float& x : values) x = static_cast<float>(random() / 2147483648.0 - 1);
  return values;
}

class BakeTarget : public ::testing::TestWithParam<int64_t> {
 protected:
  void SetUp() override { skinning_internal::ForceSimdTarget(GetParam()); }
  void TearDown() override { skinning_internal::ForceSimdTarget(0); }
};

TEST_P(BakeTarget, IsTheWeightedSumOfThreeVertices) {
  const BodyModel body(SphereOfOctants(3));
  const int V = body.num_vertices();
  // 37×29 texels: rows and the whole are no multiples of four.
  for (const auto& [width, height] : {std::pair{64, 64}, {37, 29}, {5, 3}}) {
    const UvTexelTable table = BuildUvTexelTable(body, {.width = width, .height = height});
    const UvBaker baker(table, body.data().faces);
    for (const int C : {1, 3, 4, 6, 33}) {
      const std::vector<float> values = RandomValues(size_t(V) * C, C);
      std::vector<float> maps(size_t(C) * width * height, 7.0F);  // 7: not written
      baker.Bake(InterleaveChannels(values, V, C), V, C, maps);
      std::vector<char> shows(width * height, 0);
      for (size_t i = 0; i < table.size(); ++i) {
        shows[table.pixel[i]] = 1;
        for (int c = 0; c < C; ++c) {
          double sum = 0;
          for (int k = 0; k < 3; ++k) {
            sum += double{table.barycentric[i][k]} * values[size_t(body.data().faces(table.face[i], k)) * C + c];
          }
          ASSERT_NEAR(maps[size_t(c) * width * height + table.pixel[i]], sum, 1e-6);
        }
      }
      // Beside the chart, and in blocks that have no texel at all, nothing changes but zeros within a block of four.
      for (int p = 0; p < width * height; ++p) {
        const float x = maps[p];
        if (!shows[p]) {
          ASSERT_TRUE(x == 7 || x == 0);
        }
      }
    }
  }
}

TEST_P(BakeTarget, UnitVectorsHaveLengthOne) {
  const BodyModel body(SphereOfOctants(4));
  const UvTexelTable table = BuildUvTexelTable(body);
  const UvBaker baker(table, body.data().faces);
  std::vector<float> vectors(4 * size_t(body.num_vertices()), 0.0F);
  for (int v = 0; v < body.num_vertices(); ++v) {
    for (int c = 0; c < 3; ++c) vectors[4 * v + c] = 3 * static_cast<float>(body.data().v_template(v, c));
  }
  std::vector<float> maps(3 * 128 * 128, 0.0F);
  EXPECT_EQ(baker.BakeUnit(vectors, maps), 0);
  std::vector<char> shows(128 * 128, 0);
  for (size_t i = 0; i < table.size(); ++i) {
    shows[table.pixel[i]] = 1;
    Eigen::Vector3d n, expected = Eigen::Vector3d::Zero();
    for (int c = 0; c < 3; ++c) n[c] = maps[c * 128 * 128 + table.pixel[i]];
    for (int k = 0; k < 3; ++k) {
      expected +=
          double{table.barycentric[i][k]} * body.data().v_template.row(body.data().faces(table.face[i], k)).transpose();
    }
    ASSERT_NEAR(n.norm(), 1, 5e-7);
    ASSERT_LT((n - expected.normalized()).norm(), 1e-6);
  }
  for (int p = 0; p < 128 * 128; ++p) {
    ASSERT_TRUE(shows[p] || maps[p] == 0);
  }
}

TEST_P(BakeTarget, UnitVectorsThatCancelOutTakeACorner) {
  TestMesh mesh{MatrixX3d(4, 3), MatrixX3i(2, 3)};
  mesh.vertices << 0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0;
  mesh.faces << 0, 1, 2, 0, 2, 3;
  MatrixX2f vt = mesh.vertices.leftCols<2>().cast<float>();
  const BodyModel body(BodyOfMesh(mesh, vt, mesh.faces));
  const UvTexelTable table = BuildUvTexelTable(body, {.width = 1, .height = 1});
  ASSERT_EQ(table.size(), 1U);
  const UvBaker baker(table, body.data().faces);
  // The one texel lies in the middle of the diagonal from vertex 0 to vertex 2.
  std::vector<float> vectors = {0, 0, 2, 0, 1, 0, 0, 0, 0, 0, -2, 0, 0, 1, 0, 0};
  std::vector<float> map(3, 9.0F);
  EXPECT_EQ(baker.BakeUnit(vectors, map), 1);
  EXPECT_EQ(std::abs(map[2]), 1.0F);
  // Nothing to take: zero, and counted.
  std::fill(vectors.begin(), vectors.end(), 0.0F);
  EXPECT_EQ(baker.BakeUnit(vectors, map), 1);
  EXPECT_EQ(map, (std::vector<float>{0, 0, 0}));
}

double HalfToDouble(uint16_t h) {
  const int exponent = h >> 10 & 31, mantissa = h & 1023;
  const double value = exponent == 31  ? (mantissa ? std::nan("") : std::numeric_limits<double>::infinity())
                       : exponent == 0 ? std::ldexp(mantissa, -24)
                                       : std::ldexp(1024 + mantissa, exponent - 25);
  return h & 0x8000 ? -value : value;
}

TEST_P(BakeTarget, HalvesAreRoundedToTheNearest) {
  std::vector<float> values = RandomValues(3001, 5);
  for (size_t i = 0; i < values.size(); ++i) values[i] *= std::ldexp(1.0F, static_cast<int>(i % 30) - 14);
  for (int h = 0; h < 0x7c00; h += 7) values.push_back(static_cast<float>(HalfToDouble(static_cast<uint16_t>(h))));
  values.insert(values.end(), {0.0F, -0.0F, 1.0F, 65504.0F, 6e-8F, 1e-9F});
  std::vector<uint16_t> halves(values.size());
  uv_bake_internal::HalfFromFloat(values.data(), static_cast<int64_t>(values.size()), halves.data());
  for (size_t i = 0; i < values.size(); ++i) {
    const double error = std::abs(HalfToDouble(halves[i]) - values[i]);
    // Half a unit in the last place: 2⁻¹¹ of the value, 2⁻²⁵ where halves are denormal.
    ASSERT_LE(error, std::max(std::ldexp(std::abs(double{values[i]}), -11), std::ldexp(1.0, -25))) << values[i];
  }
}

std::string TargetLabel(const ::testing::TestParamInfo<int64_t>& info) {
  return skinning_internal::SimdTargetName(info.param);
}
INSTANTIATE_TEST_SUITE_P(Simd, BakeTarget, ::testing::ValuesIn(skinning_internal::SimdTargets()), TargetLabel);

TEST(UvBake, RefusesWrongSizes) {
  const BodyModel body(SphereOfOctants(1));
  const UvTexelTable table = BuildUvTexelTable(body, {.width = 32, .height = 32});
  EXPECT_THROW(UvBaker(table, body.data().faces.topRows(3)), std::invalid_argument);
  const UvBaker baker(table, body.data().faces);
  std::vector<float> maps(1024 * 3), grouped(4 * size_t(body.num_vertices()));
  EXPECT_THROW(baker.Bake(grouped, body.num_vertices(), 2, maps), std::invalid_argument);
  EXPECT_THROW(baker.Bake(grouped, body.num_vertices(), 5, std::span(maps)), std::invalid_argument);
  EXPECT_THROW(baker.BakeUnit(std::span(grouped).first(8), maps), std::invalid_argument);
  EXPECT_THROW((void)InterleaveChannels(grouped, 3, 2), std::invalid_argument);
}

}  // namespace
}  // namespace bodyloom::uv_bake_test
