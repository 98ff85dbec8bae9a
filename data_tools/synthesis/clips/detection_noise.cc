// SPDX-License-Identifier: Apache-2.0
#include "data_tools/synthesis/clips/detection_noise.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "data_tools/synthesis/clips/smooth_curve.h"
#include "geometry/base/check.h"
#include "geometry/base/hash_random.h"

namespace bodyloom {
namespace {

enum Stream : uint64_t { kDrift = 1, kWhite, kOffset, kTail, kConfidence, kDropout, kSwap };

/// Typical confidence of a landmark in plain view.
double ConfidenceInView(std::string_view kind, double head_cosine) {
  if (kind == "nose") return kNoseConfidence.At(head_cosine);
  if (kind == "eye") return kEyeConfidence.At(head_cosine);
  if (kind == "ear") return kEarConfidence.At(head_cosine);
  return OpenConfidence(kind);
}

/// Exchanges left and right of one pair in runs of frames.
void SwapPair(int left, int right, const DetectionNoiseOptions& options, HashRandom random,
              KeypointSequence* sequence) {
  const double enter = options.swap_probability / options.swap_frames / (1 - options.swap_probability);
  bool swapped = false;
  for (int t = 0; t < sequence->num_frames(); ++t) {
    swapped = random.Uniform() < (swapped ? 1 - 1 / options.swap_frames : enter);
    if (swapped) std::swap(sequence->at(t, left), sequence->at(t, right));
  }
}

}  // namespace

bool DetectionNoiseOptions::IsValid(std::string* why) const {
  const auto no = [&](const std::string& text) {
    if (why != nullptr) *why = text;
    return false;
  };
  if (!(noise >= 0 && noise <= 100)) return no("detection noise: noise must be in [0, 100]");
  if (!(dropout_probability >= 0 && dropout_probability <= 1))
    return no("detection noise: dropout_probability must be in [0, 1]");
  if (!(swap_probability >= 0 && swap_probability <= 0.5))
    return no("detection noise: swap_probability must be in [0, 0.5]");
  if (!(swap_frames >= 1)) return no("detection noise: swap_frames must be at least 1");
  return true;
}

KeypointSequence DetectKeypoints(const KeypointSequence& exact, const std::vector<DetectionFrame>& frames,
                                 const DetectionNoiseOptions& options, uint64_t seed) {
  std::string why;
  BODYLOOM_CHECK(options.IsValid(&why), why);
  const int T = exact.num_frames(), K = exact.num_points();
  BODYLOOM_CHECK(static_cast<int>(frames.size()) == T, "detection noise: ", frames.size(), " frames described, ", T,
                 " given");
  KeypointSequence detected = exact;
  for (int k = 0; k < K; ++k) {
    const auto key = static_cast<uint64_t>(k);
    const std::string_view kind = LandmarkKind(exact.names[k]);
    const std::vector<double> drift_x =
        RoughDrift(exact.timestamps, kSlowNoiseSeconds, HashRandom(seed, {kDrift, key, 0}));
    const std::vector<double> drift_y =
        RoughDrift(exact.timestamps, kSlowNoiseSeconds, HashRandom(seed, {kDrift, key, 1}));
    const std::vector<double> mood =
        RoughDrift(exact.timestamps, kConfidenceDriftSeconds, HashRandom(seed, {kConfidence, key}));
    HashRandom offset(seed, {kOffset, key});
    const double offset_x = kConstantNoise * offset.Normal(), offset_y = kConstantNoise * offset.Normal();
    const double joint_factor = offset.Uniform(0.6, 1.4);
    for (int t = 0; t < T; ++t) {
      Keypoint& p = detected.at(t, k);
      if (!(p.confidence > 0)) {
        p = {};
        continue;
      }
      HashRandom random(seed, {kWhite, key, static_cast<uint64_t>(t)});
      const bool hidden = frames[t].hidden[k];
      double confidence = hidden ? 0.3 : 1.0;
      if (options.model_confidence) {
        confidence = ConfidenceInView(kind, frames[t].head_cosine[k]) * (hidden ? kHiddenFactor : 1.0);
        confidence = std::clamp(confidence + (hidden ? kHiddenConfidenceDrift : kConfidenceDrift) * mood[t],
                                kMinDetectedConfidence, 1.0);
      }
      const double h = frames[t].person_height_px;
      const double sigma = joint_factor * DetectionSigma(confidence);
      double tail = 1;
      if (confidence < kHeavyTailConfidence) {
        const auto window = static_cast<uint64_t>(std::max(0.0, std::floor(exact.timestamps[t] / kHeavyTailSeconds)));
        tail += HashRandom(seed, {kTail, key, window}).Exponential();
      }
      const double x = tail * (sigma * (kSlowNoiseShare * drift_x[t] + kWhiteNoiseShare * random.Normal()) + offset_x);
      const double y = tail * (sigma * (kSlowNoiseShare * drift_y[t] + kWhiteNoiseShare * random.Normal()) + offset_y);
      p.x = static_cast<float>(p.x + options.noise * h * x);
      p.y = static_cast<float>(p.y + options.noise * h * y);
      p.confidence = static_cast<float>(confidence);
      if (HashRandom(seed, {kDropout, key, static_cast<uint64_t>(t)}).Uniform() < options.dropout_probability) p = {};
    }
  }
  if (options.swap_probability > 0) {
    for (int k = 0; k < K; ++k) {
      const std::string_view kind = LandmarkKind(exact.names[k]);
      const bool swappable = kind == "elbow" || kind == "wrist" || kind == "knee" || kind == "ankle";
      if (!swappable || !exact.names[k].starts_with("left_")) continue;
      const auto twin = std::find(exact.names.begin(), exact.names.end(), "right_" + std::string(kind));
      if (twin == exact.names.end()) continue;
      SwapPair(k, static_cast<int>(twin - exact.names.begin()), options,
               HashRandom(seed, {kSwap, static_cast<uint64_t>(k)}), &detected);
    }
  }
  return detected;
}

}  // namespace bodyloom
