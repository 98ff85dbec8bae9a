// SPDX-License-Identifier: Apache-2.0
/// A clip's errors by how much each frame's motion is like what was trained on.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <utility>
#include <vector>

#include "neural/motion/motion_frame.h"

namespace bodyloom {

/// The error of every frame of a clip beside how much its motion is like what was trained on.
class MotionErrors {
 public:
  /// `similarity` by frame of the clip (data_tools/evaluation/motion_similarity.h), or empty.
  explicit MotionErrors(std::vector<float> similarity) : similarity_(std::move(similarity)) {}
  void Add(int frame, const MotionFrameScores& scores);

  /// A line a frame: frame, image_l1, ssim, lpips, tlpips, similarity; what was not measured is empty. The file appears
  /// whole or not at all.
  void WriteCsv(const std::string& path) const;

  struct Quarter {
    double least_similarity = 0;
    MotionFrameScores scores;  ///< means over the frames where each was measured
    int frames = 0;
  };
  /// The frames in four parts of equal size, the least similar first; empty without similarities or with fewer than
  /// four frames.
  [[nodiscard]] std::vector<Quarter> Quarters() const;

 private:
  struct Error {
    int frame;
    MotionFrameScores scores;
    float similarity;
  };
  std::vector<float> similarity_;
  std::vector<Error> errors_;
};

/// [{"least_similarity": …, "image_l1": …, "ssim": …, "lpips": …, "tlpips": …, "frames": …}, …]; null: not measured
nlohmann::ordered_json ToJson(const std::vector<MotionErrors::Quarter>& quarters);

// Scores of a motion-dependent renderer as one line.

/// "L1 0.0516, PSNR 20.41 dB, SSIM 0.9312, LPIPS 0.0387, labels IoU 0.847, …": what was not measured (NaN) is left out,
/// LPIPS of random features is called so. Units as in MotionScores.
std::string ScoresText(const MotionScores& scores);
/// The same of single frames' scores or their means.
std::string ScoresText(const MotionFrameScores& scores, bool lpips_random_features);

}  // namespace bodyloom
