// SPDX-License-Identifier: Apache-2.0
/// Scores of a rendered clip against the images of the single-person dataset it was rendered for.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "neural/motion/motion_frame.h"
#include "pipelines/animate/background.h"
#include "pipelines/animate/motion_errors.h"
#include "pipelines/animate/person_segmentation.h"
#include "render/image/image.h"

namespace bodyloom {

/// Scores; absent where not measured.
struct ClipScores {
  MotionScores windows;                              ///< of the person alone, in its window
  std::vector<MotionErrors::Quarter> by_similarity;  ///< empty without a clip to compare the motion with
  struct Composed {
    double psnr_db = 0;      ///< of the whole image
    double rim_psnr_db = 0;  ///< within CompositeScore::kRimPixels of the person's contour
  };
  std::optional<Composed> composed;  ///< over the dataset's own backgrounds
};

/// Accumulates the scores frame by frame.
class ClipScorer {
 public:
  /// `similarity` by frame, or empty (MotionErrors). `set`: the single-person dataset whose whole images are compared;
  /// empty: none. `image`: size of the images written.
  ClipScorer(std::vector<float> similarity, const std::string& set, ImageSize image);

  /// Adds the scores of frame t's window.
  void AddWindow(int t, const MotionFrameScores& scores) { errors_.Add(t, scores); }
  /// Adds frame t's whole image.
  void AddComposed(int t, const Image& composed);

  [[nodiscard]] const MotionErrors& errors() const { return errors_; }
  /// Final scores; `windows`: the renderer's scores of the same frames.
  [[nodiscard]] ClipScores Scores(const MotionScores& windows) const;

 private:
  MotionErrors errors_;
  std::optional<CompositeScore> composed_;
};

nlohmann::ordered_json ToJson(const ClipScores& scores);

}  // namespace bodyloom
