// SPDX-License-Identifier: Apache-2.0
/// A person's Gaussians moved by the motion of the body's surface: the network (motion_network.h), looked up at every
/// Gaussian (motion_offsets.h), and the way back.
#pragma once

#include <cstdint>
#include <functional>
#include <span>

#include "bodyloom/geometry/body_model.h"
#include "bodyloom/render/avatar/motion/motion_network.h"
#include "bodyloom/render/avatar/motion/motion_offsets.h"
#include "bodyloom/render/avatar/pose_gradient.h"

namespace bodyloom {

/// Fills the network's maps for a frame of the clip.
using MotionMapsOf = std::function<void(int time, std::span<float> maps)>;

/// Keeps its memory between frames. Not for use by two threads at once.
class AvatarMotion {
 public:
  /// `outputs` of the options is kMotionChannels. Keeps a reference to the body. Throws as its parts.
  AvatarMotion(const BodyModel& body, const MotionNetworkOptions& options, const MotionLimits& limits = {});

  [[nodiscard]] const MotionNetworkOptions& options() const { return network_.options(); }
  [[nodiscard]] int num_parameters() const { return network_.num_parameters(); }
  [[nodiscard]] FloatColumns Initial(uint64_t seed) const { return network_.Initial(seed); }
  /// Floats of a frame's maps.
  [[nodiscard]] size_t num_values() const;

  /// Where the Gaussians stand; again whenever their anchors have changed.
  void Anchor(const GaussianBody& gaussians) { offsets_.Anchor(gaussians); }

  /// What this motion adds. Throws std::invalid_argument for sizes that do not fit.
  void Compute(const FloatColumns& parameters, std::span<const float> maps, int num_threads, GaussianOffsets* offsets);

  /// Of the last Compute: d loss / d the network's parameters (set), from those by the Gaussians' parameters
  /// (AvatarGradient::parameters), which are those by what is added to them.
  void Back(const FloatColumns& parameters, const FloatColumns& by_gaussians, int num_threads,
            FloatColumns* by_parameters);

 private:
  MotionOffsets offsets_;
  MotionNetwork network_;
  const TexelFeatures* map_ = nullptr;  ///< of the last Compute
  TexelFeatures by_map_;
  FloatColumns by_offsets_;
};

}  // namespace bodyloom
