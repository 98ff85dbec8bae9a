// SPDX-License-Identifier: Apache-2.0
/// A clip's errors by how much each frame's motion is like what was trained on.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "bodyloom/neural/motion/motion_scores.h"

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

}  // namespace bodyloom
