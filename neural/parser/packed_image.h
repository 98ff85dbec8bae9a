// SPDX-License-Identifier: Apache-2.0
/// Training image of a person for U-Nets (render/image/parser_weights.h), quantised to bytes.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "neural/training/training_run.h"
#include "render/image/person_layers.h"

namespace bodyloom {

struct PackedImage {
  int width = 0, height = 0;    ///< as PersonLayers
  double pixels_per_metre = 0;  ///< size of the person
  std::vector<uint8_t> planes;  ///< PersonPlane::kCount × height × width, PackPlane()
  std::vector<uint8_t> truth;   ///< targets, planes × height × width

  [[nodiscard]] size_t pixels() const { return static_cast<size_t>(width) * height; }
};

/// Quantisation of a plane: normals in steps of 1/127, positions in steps of 1/64 m (up to ±2 m), all else in steps of
/// 1/255.
struct PlanePacking {
  float offset = 0, scale = 255;
};

constexpr PlanePacking PackingOf(int plane) {
  if (plane >= PersonPlane::kNormal && plane < PersonPlane::kPlace) return {128, 127};
  if (plane >= PersonPlane::kPlace && plane < PersonPlane::kCount) return {128, 64};
  return {};
}

inline uint8_t PackPlane(int plane, float value) {
  const PlanePacking packing = PackingOf(plane);
  return static_cast<uint8_t>(std::clamp(std::round(packing.offset + packing.scale * value), 0.0F, 255.0F));
}

inline std::vector<uint8_t> PackPlanes(const PersonLayers& layers) {
  std::vector<uint8_t> packed;
  packed.reserve(PersonPlane::kCount * layers.pixels());
  for (int p = 0; p < PersonPlane::kCount; ++p) {
    for (const float value : layers.Plane(p)) packed.push_back(PackPlane(p, value));
  }
  return packed;
}

// Common options of training U-Nets on images (render/image/parser_weights.h).

struct ImageTraining : TrainingRun {
  ImageTraining() { steps = 8000; }
  int crop = 192;  ///< pixels a side, a multiple of kImageUnetMultiple
  int batch = 8;
  double learning_rate = 1e-3;
  int warmup_steps = 100;
  double weight_decay = 1e-4;
  double average_share = 0.1;  ///< mean age of the averaged weights as a share of the steps
  double light_strength = 1;   ///< strength of the random change of colours per crop; 0: none
};

/// Checks the common options. `why` may be nullptr.
bool IsValidImageTraining(const ImageTraining& training, std::string* why);

}  // namespace bodyloom
