// SPDX-License-Identifier: Apache-2.0
/// The numbers behind synthetic detections, for every maker of them (detection_noise.h for whole clips,
/// data_tools/synthesis/lifter for training windows). Lengths in person heights. Source: medians over nine cameras of
/// two dance clips.
#pragma once

#include <cmath>
#include <string_view>

namespace bodyloom {

/// σ = (0.006 + 0.024 (1 − confidence)^1.5) person heights.
template <typename T>
T DetectionSigma(T confidence) {
  const T u = 1 - confidence;
  return T(0.006) + T(0.024) * u * std::sqrt(u);
}

inline constexpr double kSlowNoiseShare = 0.85, kWhiteNoiseShare = 0.45;
inline constexpr double kSlowNoiseSeconds = 0.25;     ///< time constant of the slow part
inline constexpr double kConstantNoise = 0.005;       ///< offset of a landmark for a clip
inline constexpr double kHeavyTailConfidence = 0.35;  ///< below it noise is multiplied by 1 + e, e exponential, mean 1
inline constexpr double kHeavyTailSeconds = 0.2;      ///< redrawn so often
inline constexpr double kHiddenFactor = 0.16;         ///< of the confidence, when the body hides the landmark
inline constexpr double kConfidenceDrift = 0.09, kHiddenConfidenceDrift = 0.05;  ///< slow changes of the confidence
inline constexpr double kConfidenceDriftSeconds = 0.3;
inline constexpr double kMinConfidence = 0.02;

/// The landmark's kind: its name without the side.
inline std::string_view LandmarkKind(std::string_view name) {
  for (const std::string_view side : {std::string_view("left_"), std::string_view("right_")}) {
    if (name.starts_with(side)) return name.substr(side.size());
  }
  return name;
}

/// Typical confidence of a landmark in plain view; nose, eyes and ears by FaceConfidence.
inline double OpenConfidence(std::string_view kind) {
  struct Row {
    std::string_view kind;
    double confidence;
  };
  static constexpr Row kTypical[] = {{"shoulder", 0.71}, {"elbow", 0.66},    {"wrist", 0.65},
                                     {"hip", 0.58},      {"knee", 0.74},     {"ankle", 0.72},
                                     {"big_toe", 0.65},  {"small_toe", 0.6}, {"heel", 0.62}};
  for (const Row& row : kTypical) {
    if (row.kind == kind) return row.confidence;
  }
  return 0.65;
}

/// peak · logistic((c + shift)/width) with c the cosine between the way the landmark faces and the way to the camera.
struct FaceConfidence {
  double peak, shift, width;
  template <typename T>
  [[nodiscard]] T At(T cosine) const {
    return T(peak) / (1 + std::exp(-(cosine + T(shift)) / T(width)));
  }
};
inline constexpr FaceConfidence kNoseConfidence{0.97, 0.62, 0.12}, kEyeConfidence{0.97, 0.13, 0.15},
    kEarConfidence{0.92, 0.42, 0.10};

}  // namespace bodyloom
