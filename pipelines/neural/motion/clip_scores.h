// SPDX-License-Identifier: Apache-2.0
/// A rendered clip against the pictures of the single-person dataset it was rendered for.
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

/// What was measured; absent where it was not.
struct ClipScores {
  MotionScores windows;                              ///< the person alone, in its window
  std::vector<MotionErrors::Quarter> by_similarity;  ///< empty without a clip to be like
  struct Composed {
    double psnr_db = 0;      ///< of the whole picture
    double rim_psnr_db = 0;  ///< within CompositeScore::kRimPixels of the person's contour
  };
  std::optional<Composed> composed;  ///< over the dataset's own backgrounds
};

/// Collects them frame by frame.
class ClipScorer {
 public:
  /// `similarity` by frame, or empty (MotionErrors). `set`: the single-person dataset whose whole pictures are
  /// compared, empty: they are not. `picture`: the size of those written.
  ClipScorer(std::vector<float> similarity, const std::string& set, PictureSize picture);

  /// Frame t's window, as the renderer compared it.
  void AddWindow(int t, const MotionFrameScores& scores) { errors_.Add(t, scores); }
  /// Frame t's whole picture.
  void AddComposed(int t, const Image& composed);

  [[nodiscard]] const MotionErrors& errors() const { return errors_; }
  /// `windows`: those of the renderer, of the same frames.
  [[nodiscard]] ClipScores Scores(const MotionScores& windows) const;

 private:
  MotionErrors errors_;
  std::optional<CompositeScore> composed_;
};

nlohmann::ordered_json ToJson(const ClipScores& scores);

}  // namespace bodyloom
