// SPDX-License-Identifier: Apache-2.0
#include "geometry/uv_maps/uv_bake.h"

#include <algorithm>
#include <cmath>

#include "geometry/base/check.h"
#include "geometry/uv_maps/uv_bake_simd.h"

namespace bodyloom {

using uv_bake_internal::Block;

std::vector<float> InterleaveChannels(std::span<const float> values, int num_vertices, int num_channels) {
  BODYLOOM_CHECK(num_channels > 0 && values.size() == size_t(num_vertices) * num_channels, "channels: ", values.size(),
                 " values, expected ", num_vertices, " vertices x ", num_channels);
  const int groups = (num_channels + 3) / 4;
  std::vector<float> grouped(size_t{4} * groups * num_vertices, 0.0F);
  for (int v = 0; v < num_vertices; ++v) {
    for (int c = 0; c < num_channels; ++c) {
      grouped[4 * (size_t(c / 4) * num_vertices + v) + c % 4] = values[size_t(v) * num_channels + c];
    }
  }
  return grouped;
}

UvBaker::UvBaker(const UvTexelTable& table, const MatrixX3i& faces) : num_pixels_(table.width * table.height) {
  for (size_t i = 0; i < table.size(); ++i) {
    BODYLOOM_CHECK(table.face[i] >= 0 && table.face[i] < faces.rows(), "UV table: face ", table.face[i],
                   ", expected 0..", faces.rows() - 1);
    const int base = table.pixel[i] & ~3, lane = table.pixel[i] & 3;
    if (blocks_.empty() || blocks_.back().pixel != base) blocks_.push_back({base, {}, {}});
    for (int k = 0; k < 3; ++k) {
      const int vertex = faces(table.face[i], k);
      blocks_.back().vertex[lane][k] = vertex;
      blocks_.back().weight[lane][k] = table.barycentric[i][k];
      num_vertices_ = std::max(num_vertices_, vertex + 1);
    }
  }
  for (const Block& block : blocks_) num_blank_ += std::min(4, num_pixels_ - block.pixel);
  num_blank_ -= static_cast<int>(table.size());
}

UvBaker::~UvBaker() = default;
UvBaker::UvBaker(const UvBaker&) = default;
UvBaker::UvBaker(UvBaker&&) noexcept = default;
UvBaker& UvBaker::operator=(const UvBaker&) = default;
UvBaker& UvBaker::operator=(UvBaker&&) noexcept = default;

void UvBaker::Check(size_t attributes, int num_vertices, size_t maps, int num_channels) const {
  const size_t groups = (size_t(num_channels) + 3) / 4;
  BODYLOOM_CHECK(num_vertices >= num_vertices_ && attributes == 4 * groups * num_vertices, "UV bake: ", attributes,
                 " values of ", num_vertices, " vertices, expected groups of four for ", num_channels,
                 " channels of at least ", num_vertices_, " vertices");
  BODYLOOM_CHECK(maps == size_t(num_channels) * num_pixels_, "UV bake: room for ", maps, " values, expected ",
                 num_channels, " x ", num_pixels_);
}

void UvBaker::Bake(std::span<const float> grouped, int num_vertices, int num_channels, std::span<float> maps) const {
  Check(grouped.size(), num_vertices, maps.size(), num_channels);
  const int num_blocks = static_cast<int>(blocks_.size());
  for (int first = 0; first < num_channels;) {
    float* planes[8] = {};
    const int count = num_channels - first >= 8 ? 8 : std::min(4, num_channels - first);
    for (int p = 0; p < count; ++p) planes[p] = maps.data() + size_t(first + p) * num_pixels_;
    const float* attributes = grouped.data() + size_t(first) * num_vertices;
    if (count == 8) {
      uv_bake_internal::BakeTwoGroups(blocks_.data(), num_blocks, num_pixels_, attributes, 4 * int64_t{num_vertices},
                                      planes);
    } else {
      uv_bake_internal::BakeGroup(blocks_.data(), num_blocks, num_pixels_, attributes, count, planes);
    }
    first += count;
  }
}

int UvBaker::BakeUnit(std::span<const float> vectors, std::span<float> maps) const {
  Check(vectors.size(), static_cast<int>(vectors.size() / 4), maps.size(), 3);
  float* planes[3] = {maps.data(), maps.data() + num_pixels_, maps.data() + size_t{2} * num_pixels_};
  const int num_zero = uv_bake_internal::BakeUnitVectors(blocks_.data(), static_cast<int>(blocks_.size()), num_pixels_,
                                                         vectors.data(), planes);
  if (num_zero == num_blank_) return 0;
  for (const Block& block : blocks_) {  // rare
    for (int i = 0; i < 4; ++i) {
      const int p = block.pixel + i;
      const float* weight = block.weight[i];
      if (weight[0] + weight[1] + weight[2] == 0 || planes[0][p] != 0 || planes[1][p] != 0 || planes[2][p] != 0) {
        continue;
      }
      float best = 0;
      for (int k = 0; k < 3; ++k) {
        const float* n = vectors.data() + 4 * size_t(block.vertex[i][k]);
        const float length = std::hypot(n[0], n[1], n[2]);
        if (weight[k] <= best || !(length > 0)) continue;
        best = weight[k];
        for (int c = 0; c < 3; ++c) planes[c][p] = n[c] / length;
      }
    }
  }
  return num_zero - num_blank_;
}

}  // namespace bodyloom
