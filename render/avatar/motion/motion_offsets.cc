// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/render/avatar/motion/motion_offsets.h"

#include <algorithm>
#include <cmath>

#include "bodyloom/geometry/base/check.h"
#include "bodyloom/geometry/base/in_range.h"
#include "bodyloom/geometry/base/parallel.h"
#include "bodyloom/render/uv_sample.h"

namespace bodyloom {
namespace {

constexpr int kOffsetRows = 1024;  ///< of a thread at a time

}  // namespace

bool MotionLimits::IsValid(std::string* why) const {
  const InRange in_range(why);
  return in_range("skin_position", skin_position, 0, 1) && in_range("loose_position", loose_position, 0, 1) &&
         in_range("cloth_position", cloth_position, 0, 1) && in_range("log_scale", log_scale, 0, 10) &&
         in_range("opacity_logit", opacity_logit, 0, 100) && in_range("albedo", albedo, 0, 10);
}

MotionOffsets::MotionOffsets(const BodyModel& body, int side, const MotionLimits& limits)
    : body_(body),
      side_(side),
      charts_(FindUvCharts(body)),
      table_(BuildUvTexelTable(body, charts_, {.width = side, .height = side, .gutter = 1})) {
  std::string why;
  BODYLOOM_CHECK(limits.IsValid(&why), "motion offsets: ", why);
  const auto set = [&](GaussianKind kind, float position, float opacity_logit) {
    Limits& limit = limits_[static_cast<size_t>(kind)];
    std::fill_n(limit.begin() + GaussianOffsets::kPosition, 3, position);
    std::fill_n(limit.begin() + GaussianOffsets::kLogScale, 3, limits.log_scale);
    limit[GaussianOffsets::kOpacityLogit] = opacity_logit;
    std::fill_n(limit.begin() + GaussianOffsets::kAlbedo, 3, limits.albedo);
  };
  set(GaussianKind::kSkin, limits.skin_position, limits.opacity_logit);
  set(GaussianKind::kLoose, limits.loose_position, limits.opacity_logit);
  set(GaussianKind::kCloth, limits.cloth_position, 0);
}

std::vector<uint8_t> MotionOffsets::ShowsBody() const {
  std::vector<uint8_t> shows(static_cast<size_t>(side_) * side_, 0);
  for (const int pixel : table_.pixel) shows[pixel] = 1;
  return shows;
}

void MotionOffsets::Anchor(const GaussianBody& gaussians) {
  taps_.assign(gaussians.size(), {});
  for (int i = 0; i < gaussians.size(); ++i) {
    const SkinAnchor& anchor = gaussians.anchors[i];
    const Eigen::Vector3d barycentric(anchor.barycentric[0], anchor.barycentric[1], anchor.barycentric[2]);
    const UvTaps taps = TapsAt(table_, UvPointAt(body_, charts_, anchor.face, barycentric));
    for (int k = 0; k < taps.count; ++k) {
      taps_[i].texel[k] = taps.pixel[k];
      taps_[i].weight[k] = static_cast<float>(taps.weight[k]);
    }
    taps_[i].kind = gaussians.kinds[i];
  }
}

float MotionOffsets::LookUp(const TexelFeatures& map, const Taps& taps, int channel) const {
  float sum = 0;
  for (int k = 0; k < 4; ++k) {
    sum += taps.weight[k] * map.at(taps.texel[k] / side_, taps.texel[k] % side_)[channel];
  }
  return sum;
}

void MotionOffsets::Compute(const TexelFeatures& map, int num_threads, GaussianOffsets* offsets) const {
  BODYLOOM_CHECK(map.side() == side_ && map.channels() >= kMotionChannels, "motion offsets: a map of ", map.side(),
                 " texels and ", map.channels(), " channels, expected ", side_, " and ", kMotionChannels);
  const int count = static_cast<int>(taps_.size());
  offsets->columns.Resize(GaussianOffsets::kNumColumns, count);
  ParallelFor((count + kOffsetRows - 1) / kOffsetRows, num_threads, [&](int chunk) {
    for (int i = chunk * kOffsetRows; i < std::min(count, (chunk + 1) * kOffsetRows); ++i) {
      const Limits& limits = LimitsOf(taps_[i]);
      for (int c = 0; c < GaussianOffsets::kNumColumns; ++c) {
        const float y = LookUp(map, taps_[i], taps_[i].first_channel() + c);
        offsets->columns(i, c) = limits[c] * (y / (1 + std::abs(y)));
      }
    }
  });
}

void MotionOffsets::Back(const TexelFeatures& map, const FloatColumns& by_offsets, int num_threads,
                         TexelFeatures* by_map) const {
  const int count = static_cast<int>(taps_.size());
  BODYLOOM_CHECK(by_offsets.rows() == count && by_offsets.columns() == GaussianOffsets::kNumColumns,
                 "motion offsets: derivatives of ", by_offsets.rows(), " rows and ", by_offsets.columns(),
                 " columns, expected ", count, " and ", int{GaussianOffsets::kNumColumns});
  by_map->Resize(side_, map.channels());
  for (int y = 0; y < side_; ++y) {
    std::fill_n(by_map->at(y, 0), static_cast<ptrdiff_t>(side_) * map.channels(), 0.0F);
  }
  // A thread has a column of its own, so that every texel's sum goes by the Gaussians' order.
  ParallelFor(GaussianOffsets::kNumColumns, num_threads, [&](int c) {
    for (int i = 0; i < count; ++i) {
      const float by = by_offsets(i, c);
      if (by == 0) continue;
      const Taps& taps = taps_[i];
      const int channel = taps.first_channel() + c;
      const float below = 1 + std::abs(LookUp(map, taps, channel));
      const float by_y = by * LimitsOf(taps)[c] / (below * below);
      for (int k = 0; k < 4; ++k) {
        by_map->at(taps.texel[k] / side_, taps.texel[k] % side_)[channel] += taps.weight[k] * by_y;
      }
    }
  });
}

}  // namespace bodyloom
