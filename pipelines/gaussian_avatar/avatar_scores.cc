// SPDX-License-Identifier: Apache-2.0
#include "pipelines/gaussian_avatar/avatar_scores.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "data_tools/evaluation/image_metrics.h"
#include "data_tools/evaluation/ssim.h"
#include "geometry/base/check.h"
#include "pipelines/report_text.h"
#include "render/gaussian_avatar/avatar_image.h"

namespace bodyloom {

Image TrueWindow(const TrainingView& view) {
  Image image(view.window.width(), view.window.height());
  for (size_t i = 0; i < view.window.area(); ++i) {
    if (view.pixels[4 * i + 3] != 0) std::copy_n(view.pixels.begin() + 4 * i, 3, image.bgr.begin() + 3 * i);
  }
  return image;
}

Image DrawnWindow(const SplatImage& drawn) {
  Image image(drawn.window().width(), drawn.window().height());
  for (int c = 0; c < 3; ++c) {
    const std::span<const float> plane = drawn.plane(static_cast<SplatImage::Plane>(2 - c));
    for (size_t i = 0; i < plane.size(); ++i) {
      image.bgr[3 * i + c] = static_cast<uint8_t>(std::lround(255 * std::clamp(plane[i], 0.0F, 1.0F)));
    }
  }
  return image;
}

void AvatarScorer::AddGarment(const TrainingView& view, std::span<const float> garment) {
  BODYLOOM_CHECK(garment.size() == view.window.area(), "avatar scores: a garment of ", garment.size(),
                 " pixels for a window of ", view.window.area());
  std::array<size_t, 256> shown{}, covered{};
  size_t of_garment = 0;
  for (size_t i = 0; i < garment.size(); ++i) {
    const uint8_t label = view.pixels[4 * i + 3];
    const bool is_garment = garment[i] >= kMinGarmentShare;
    ++shown[label];
    covered[label] += is_garment ? 1 : 0;
    of_garment += is_garment ? 1 : 0;
  }
  for (size_t label = 1; label < shown.size(); ++label) {
    const size_t either = shown[label] + of_garment - covered[label];
    if (either == 0) continue;
    by_label_[label].covered += covered[label];
    by_label_[label].iou += static_cast<double>(covered[label]) / static_cast<double>(either);
    ++by_label_[label].frames;
  }
}

void AvatarScorer::Add(const TrainingView& view, const SplatImage& image, std::span<const float> garment) {
  const Image truth = TrueWindow(view), drawn = DrawnWindow(image);
  BODYLOOM_CHECK(truth.width == drawn.width && truth.height == drawn.height, "avatar scores: an image of ", drawn.width,
                 "x", drawn.height, " for a window of ", truth.width, "x", truth.height);
  PixelMask person = {truth.width, truth.height, {}}, outline = person;
  const std::span<const float> alpha = image.plane(SplatImage::kAlpha);
  for (size_t i = 0; i < view.window.area(); ++i) {
    person.inside.push_back(view.pixels[4 * i + 3] != 0 ? 1 : 0);
    outline.inside.push_back(alpha[i] >= kMinAlpha ? 1 : 0);
  }
  double l1 = 0;
  for (size_t i = 0; i < truth.bgr.size(); ++i) l1 += std::abs(int{truth.bgr[i]} - int{drawn.bgr[i]});
  // Equal images have infinite PSNR, which has no mean.
  constexpr double kMaxDb = 100;
  ++sums_.frames;
  sums_.psnr_box_db += std::min(kMaxDb, Psnr(truth, drawn));
  sums_.psnr_person_db += std::min(kMaxDb, Psnr(truth, drawn, &person));
  sums_.ssim += Ssim(truth, drawn, SsimPreset::k3dgs);
  sums_.l1 += l1 / 255 / static_cast<double>(truth.bgr.size());
  sums_.outline_iou += MaskIoU(person, outline);
  if (!garment.empty()) AddGarment(view, garment);
}

AvatarScores AvatarScorer::Means() const {
  AvatarScores means = sums_;
  const double count = std::max(1, means.frames);
  for (double* value : {&means.psnr_box_db, &means.psnr_person_db, &means.ssim, &means.l1, &means.outline_iou}) {
    *value /= count;
  }
  // A mask says 1 wherever the person is: nothing by which a garment could be told.
  const bool has_labels =
      std::any_of(by_label_.begin() + 2, by_label_.end(), [](const Overlap& overlap) { return overlap.covered > 0; });
  const Overlap& maximum = *std::max_element(by_label_.begin(), by_label_.end(),
                                             [](const Overlap& a, const Overlap& b) { return a.covered < b.covered; });
  if (has_labels) means.garment_iou = maximum.iou / maximum.frames;
  return means;
}

nlohmann::ordered_json ToJson(const AvatarScores& scores) {
  nlohmann::ordered_json json = {{"frames", scores.frames},
                                 {"psnr_box_db", scores.psnr_box_db},
                                 {"psnr_person_db", scores.psnr_person_db},
                                 {"ssim", scores.ssim},
                                 {"ssim_preset", ToText(SsimPreset::k3dgs)},
                                 {"l1", scores.l1},
                                 {"outline_iou", scores.outline_iou}};
  if (scores.garment_iou) json["garment_iou"] = *scores.garment_iou;
  return json;
}

std::string ScoresText(const AvatarScores& scores) {
  return Concatenate(scores.frames, " frames: PSNR ", Fixed(scores.psnr_box_db, 2), " dB in the box, ",
                     Fixed(scores.psnr_person_db, 2), " dB in the person, SSIM ", Fixed(scores.ssim, 3), ", L1 ",
                     Fixed(scores.l1, 4), ", outline IoU ", Fixed(scores.outline_iou, 3),
                     scores.garment_iou ? ", garment IoU " + Fixed(*scores.garment_iou, 3) : "");
}

}  // namespace bodyloom
