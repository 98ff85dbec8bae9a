// SPDX-License-Identifier: Apache-2.0
/// Errors of a rendered clip, grouped by the similarity of each frame's motion to the training motion.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <utility>
#include <vector>

#include "neural/motion/motion_frame.h"

namespace bodyloom {

/// Errors of a clip's frames together with the similarity of their motion to the training motion.
class MotionErrors {
 public:
  /// `similarity` by frame of the clip (data_tools/evaluation/motion_similarity.h), or empty.
  explicit MotionErrors(std::vector<float> similarity) : similarity_(std::move(similarity)) {}
  void Add(int frame, const MotionFrameScores& scores);

  /// Writes one line per frame: frame, image_l1, ssim, lpips, tlpips, similarity; values not measured are empty. The
  /// file is written whole or not at all.
  void WriteCsv(const std::string& path) const;

  struct Quarter {
    double min_similarity = 0;
    MotionFrameScores scores;  ///< means over the frames where each was measured
    int frames = 0;
  };
  /// Quartiles of the frames by similarity, least similar first; empty without similarities or with fewer than four
  /// frames.
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

/// [{"min_similarity": …, "image_l1": …, "ssim": …, "lpips": …, "tlpips": …, "frames": …}, …]; null: not measured
nlohmann::ordered_json ToJson(const std::vector<MotionErrors::Quarter>& quarters);

// Scores of the motion-dependent renderer in one line of text.

/// "L1 0.0516, PSNR 20.41 dB, SSIM 0.9312, LPIPS 0.0387, labels IoU 0.847, …": values not measured (NaN) are left out,
/// LPIPS of random features is marked as such. Units as in MotionScores.
std::string ScoresText(const MotionScores& scores);
/// The same of single frames' scores or their means.
std::string ScoresText(const MotionFrameScores& scores, bool lpips_random_features);

}  // namespace bodyloom
