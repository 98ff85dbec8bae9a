// SPDX-License-Identifier: Apache-2.0
/// How like the truth pictures of a person of Gaussians are.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>

#include "render/gaussian_avatar/learning/training_view.h"
#include "render/splat/splat_picture.h"

namespace bodyloom {

/// Means over frames. Pictures are compared in bytes, both over black, in the box around the true person that the
/// views have (kScoreMargin pixels wide).
struct AvatarScores {
  static constexpr int kScoreMargin = 32;
  int frames = 0;
  double psnr_box_db = 0;
  double psnr_person_db = 0;  ///< of the pixels of the true person
  double ssim = 0;            ///< of the box, preset 3dgs (data_tools/evaluation/ssim.h)
  double l1 = 0;              ///< of the box, in [0, 1]
  double outline_iou = 0;     ///< of the true person and where alpha is at least ½
  /// Of where the garment is at least half of the picture, and the label that it mostly covers; absent without a
  /// garment, and where the truth has no labels.
  std::optional<double> garment_iou;
};

/// Collects them.
class AvatarScorer {
 public:
  /// `picture`: drawn in the view's window. `garment`: share of the garment in its pixels; empty: there is none.
  void Add(const TrainingView& view, const SplatPicture& picture, std::span<const float> garment = {});
  [[nodiscard]] AvatarScores Means() const;

 private:
  /// A label of the truth beside the garment.
  struct Overlap {
    size_t covered = 0;  ///< its pixels that the garment covers
    double iou = 0;      ///< sum over the frames that show either
    int frames = 0;
  };
  void AddGarment(const TrainingView& view, std::span<const float> garment);

  AvatarScores sums_;
  std::array<Overlap, 256> by_label_{};
};

/// The person over black; of the truth, and of a picture drawn in the view's window.
Image TrueWindow(const TrainingView& view);
Image DrawnWindow(const SplatPicture& picture);

/// "34 frames: PSNR 24.1 dB in the box, 20.4 dB in the person, …"
std::string ScoresText(const AvatarScores& scores);

/// {"frames", "psnr_box_db", …}, as the fields are named, and "ssim_preset".
nlohmann::ordered_json ToJson(const AvatarScores& scores);

}  // namespace bodyloom
