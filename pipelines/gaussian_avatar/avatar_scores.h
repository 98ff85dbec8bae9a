// SPDX-License-Identifier: Apache-2.0
/// Scores of rendered images of a Gaussian avatar against the true images.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>

#include "render/gaussian_avatar/learning/training_view.h"
#include "render/splat/splat_image.h"

namespace bodyloom {

/// Means over frames. Images are compared in 8 bits, both over black, in the true person's bounding box enlarged by
/// kScoreMargin pixels, which the views have.
struct AvatarScores {
  static constexpr int kScoreMargin = 32;
  int frames = 0;
  double psnr_box_db = 0;
  double psnr_person_db = 0;  ///< of the pixels of the true person
  double ssim = 0;            ///< of the box, preset 3dgs (data_tools/evaluation/ssim.h)
  double l1 = 0;              ///< of the box, in [0, 1]
  double outline_iou = 0;     ///< true person against alpha of at least ½
  /// IoU of the pixels whose garment share is at least ½ with the label that they mostly cover; absent without a
  /// garment or without true labels.
  std::optional<double> garment_iou;
};

/// Accumulates the scores.
class AvatarScorer {
 public:
  /// Adds a view. `image`: drawn in the view's window. `garment`: share of the garment in each pixel; empty: none.
  void Add(const TrainingView& view, const SplatImage& image, std::span<const float> garment = {});
  [[nodiscard]] AvatarScores Means() const;

 private:
  /// Overlap of one true label with the garment.
  struct Overlap {
    size_t covered = 0;  ///< its pixels that the garment covers
    double iou = 0;      ///< sum over the frames that show either
    int frames = 0;
  };
  void AddGarment(const TrainingView& view, std::span<const float> garment);

  AvatarScores sums_;
  std::array<Overlap, 256> by_label_{};
};

/// The person over black: of the truth, and of an image drawn in the view's window.
Image TrueWindow(const TrainingView& view);
Image DrawnWindow(const SplatImage& image);

/// "34 frames: PSNR 24.1 dB in the box, 20.4 dB in the person, …"
std::string ScoresText(const AvatarScores& scores);

/// {"frames", "psnr_box_db", …}, as the fields are named, and "ssim_preset".
nlohmann::ordered_json ToJson(const AvatarScores& scores);

}  // namespace bodyloom
