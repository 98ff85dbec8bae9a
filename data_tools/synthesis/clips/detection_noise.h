// SPDX-License-Identifier: Apache-2.0
/// Detection noise on exact 2D landmarks: confidence, noise that depends on it, drift, drop-outs, swaps.
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

#include <cstdint>
#include <string>
#include <vector>

#include "bodyloom/geometry/observations.h"

namespace bodyloom {

struct DetectionNoiseOptions {
  double noise = 1;              ///< multiplies σ and the offset; 0: exact positions
  bool model_confidence = true;  ///< false: 1 where visible, 0.3 where hidden
  double dropout_probability = 0.01;
  double swap_probability = 0.004;
  double swap_frames = 3;  ///< mean length
  [[nodiscard]] bool IsValid(std::string* why) const;
};

/// What the model needs to know of a frame besides where the landmarks truly are.
struct DetectionFrame {
  double person_height_px = 0;
  std::vector<bool> hidden;         ///< K: the body is in front of the landmark
  std::vector<double> head_cosine;  ///< K: for face landmarks the cosine between the landmark's outward direction and
                                    ///< the way to the camera; others unused
};

/// Changes `exact` (confidence > 0 where the landmark is in the image) into detections. `frames` has one entry a frame.
/// Same seed, same result.
KeypointSequence DetectKeypoints(const KeypointSequence& exact, const std::vector<DetectionFrame>& frames,
                                 const DetectionNoiseOptions& options, uint64_t seed);

}  // namespace bodyloom
