// SPDX-License-Identifier: Apache-2.0
/// Simulates detection noise on exact 2D landmarks: confidence, noise that depends on it, drift, drop-outs, swaps.
///
/// All lengths are in person heights h (the height of the body in the image, pixels), as measured on nine-camera
/// detections of dancers:
/// - confidence: a typical value for each landmark, lowered to 16 % (with drift) when the body hides it; the nose, eyes
///   and ears follow the direction c of the head relative to the camera through logistic curves; it drifts slowly;
/// - noise: σ = (0.006 + 0.024 (1 − confidence)^1.5) h, of which 0.85 σ drifts with a time constant of 0.25 s and 0.45
///   σ is white, plus a constant offset of 0.005 h for each landmark of the clip; below a confidence of 0.35 all of it
///   is multiplied by 1 + e, e exponential with mean 1, redrawn every 0.2 s;
/// - drop-outs: a landmark is missing in a given frame with `dropout_probability`;
/// - swaps: left and right of elbows, wrists, knees and ankles are exchanged for a few frames, `swap_probability` of
///   the frames of each pair.
#pragma once

#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "geometry/scene/observations.h"

namespace bodyloom {

struct DetectionNoiseOptions {
  double noise = 1;              ///< multiplies σ and the offset; 0: exact positions
  bool model_confidence = true;  ///< false: 1 where visible, 0.3 where hidden
  double dropout_probability = 0.01;
  double swap_probability = 0.004;
  double swap_frames = 3;  ///< mean length of a swap
  [[nodiscard]] bool IsValid(std::string* why) const;
};

/// Inputs of the model for a frame besides the true landmarks.
struct DetectionFrame {
  double person_height_px = 0;
  std::vector<bool> hidden;         ///< K: the body is in front of the landmark
  std::vector<double> head_cosine;  ///< K: for face landmarks the cosine between the landmark's outward direction and
                                    ///< the direction to the camera; others unused
};

/// Changes `exact` (confidence > 0 where the landmark is in the image) into detections. `frames` has one entry a frame.
/// Same seed, same result.
KeypointSequence DetectKeypoints(const KeypointSequence& exact, const std::vector<DetectionFrame>& frames,
                                 const DetectionNoiseOptions& options, uint64_t seed);

// Constants of the detection model, shared by whole clips (above) and training windows (data_tools/synthesis/lifter).
// Lengths in person heights. Source: medians over nine cameras of two dance clips.

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
inline constexpr double kHeavyTailSeconds = 0.2;      ///< interval at which e is redrawn
inline constexpr double kHiddenFactor = 0.16;         ///< factor of the confidence if the body hides the landmark
inline constexpr double kConfidenceDrift = 0.09, kHiddenConfidenceDrift = 0.05;  ///< slow drift of the confidence
inline constexpr double kConfidenceDriftSeconds = 0.3;
inline constexpr double kMinDetectedConfidence = 0.02;

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

/// peak · logistic((c + shift)/width) with c the cosine between the landmark's outward direction and the direction to
/// the camera.
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
