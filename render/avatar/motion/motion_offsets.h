// SPDX-License-Identifier: Apache-2.0
/// From the motion network's map (motion_network.h) to what is added to each Gaussian, and back.
///
/// A Gaussian looks the map up at its anchor's place in the atlas, bilinear between texels of its own chart. Channels
/// 0 to 9 are for those on the skin, 10 to 19 for loose ones and cloth, in the order of GaussianOffsets. With y what was
/// looked up,
///   offset = limit · y / (1 + |y|)
/// so that a motion that was never learned cannot tear the person apart. Cloth, whose motion is simulated, is moved little
/// and stays opaque.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "bodyloom/geometry/body_model.h"
#include "bodyloom/geometry/uv_charts.h"
#include "bodyloom/geometry/uv_texels.h"
#include "bodyloom/render/avatar/gaussian_body.h"
#include "bodyloom/render/avatar/gaussian_offsets.h"
#include "bodyloom/render/avatar/motion/texel_features.h"

namespace bodyloom {

inline constexpr int kMotionChannels = 2 * GaussianOffsets::kNumColumns;

/// What motion may change at most.
struct MotionLimits {
  float skin_position = 0.03F, loose_position = 0.15F, cloth_position = 0.02F;  ///< metres
  float log_scale = 0.3F, opacity_logit = 1, albedo = 0.3F;                     ///< opacity: not of cloth
  [[nodiscard]] bool IsValid(std::string* why) const;
};

class MotionOffsets {
 public:
  /// Of maps of side² texels. Keeps a reference to the body. Throws std::invalid_argument for a body without UV
  /// coordinates and limits that are not valid.
  MotionOffsets(const BodyModel& body, int side, const MotionLimits& limits = {});

  /// side², 1 where the atlas shows the body, gutters included.
  [[nodiscard]] std::vector<uint8_t> ShowsBody() const;

  /// Where the Gaussians stand; again whenever their anchors have changed.
  void Anchor(const GaussianBody& gaussians);

  /// Fills `offsets` for the Gaussians that were anchored. The map is side² with at least kMotionChannels channels.
  void Compute(const TexelFeatures& map, int num_threads, GaussianOffsets* offsets) const;

  /// From d loss / d offsets of that map: d loss / d map (set). Same bytes for any number of threads.
  void Back(const TexelFeatures& map, const FloatColumns& by_offsets, int num_threads, TexelFeatures* by_map) const;

 private:
  /// Four texels of a row, with weights; those without a chart weigh nothing.
  struct Taps {
    std::array<int32_t, 4> texel{};
    std::array<float, 4> weight{};
    GaussianKind kind = GaussianKind::kSkin;
    /// Of the map, for column 0.
    [[nodiscard]] int first_channel() const { return kind == GaussianKind::kSkin ? 0 : GaussianOffsets::kNumColumns; }
  };
  [[nodiscard]] float LookUp(const TexelFeatures& map, const Taps& taps, int channel) const;

  const BodyModel& body_;
  int side_;
  using Limits = std::array<float, GaussianOffsets::kNumColumns>;
  [[nodiscard]] const Limits& LimitsOf(const Taps& taps) const { return limits_[static_cast<size_t>(taps.kind)]; }

  std::array<Limits, 3> limits_{};  ///< by kind
  UvCharts charts_;
  UvTexelTable table_;
  std::vector<Taps> taps_;
};

}  // namespace bodyloom
