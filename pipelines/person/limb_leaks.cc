// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/pipelines/person/limb_leaks.h"

#include <algorithm>
#include <array>
#include <opencv2/imgproc.hpp>
#include <optional>

#include "bodyloom/data_tools/datasets/single_person_dataset.h"
#include "bodyloom/geometry/base/check.h"

namespace bodyloom {
namespace {

constexpr size_t kFewest = 50;  ///< pixels of a colour that is worth asking

bool IsTrunk(int part) { return part == 1 || part == 2; }
bool IsThigh(int part) { return part >= 7 && part <= 10; }
bool IsArmOrHand(int part) { return part == 3 || part == 4 || (part >= 15 && part <= 22); }

using Bgr = std::array<int, 3>;

/// The median colour of the pixels, channel by channel; none of fewer than kFewest.
class MedianColour {
 public:
  void Add(const uint8_t* bgr) {
    for (size_t c = 0; c < 3; ++c) ++counts_[c][bgr[c]];
    ++pixels_;
  }
  [[nodiscard]] std::optional<Bgr> Get() const {
    if (pixels_ < kFewest) return std::nullopt;
    Bgr median{};
    for (size_t c = 0; c < 3; ++c) {
      size_t below = 0;
      while ((below += counts_[c][median[c]]) * 2 < pixels_) ++median[c];
    }
    return median;
  }

 private:
  std::array<std::array<size_t, 256>, 3> counts_{};
  size_t pixels_ = 0;
};

int SquaredDistance(const uint8_t* bgr, const Bgr& other) {
  int sum = 0;
  for (size_t c = 0; c < 3; ++c) sum += (bgr[c] - other[c]) * (bgr[c] - other[c]);
  return sum;
}

}  // namespace

std::vector<uint8_t> WithoutLimbLeaks(const Image& picture, std::span<const uint8_t> mask,
                                      std::span<const uint8_t> labels, std::span<const uint8_t> parts, int reach_px) {
  const size_t area = picture.bgr.size() / 3;
  BODYLOOM_CHECK(mask.size() == area && labels.size() == area && parts.size() == area, "limb leaks: ", mask.size(),
                 " pixels of the mask, ", labels.size(), " labels and ", parts.size(), " parts of a picture of ",
                 picture.width, "x", picture.height);
  cv::Mat off_arms(picture.height, picture.width, CV_8UC1), distance;
  for (size_t i = 0; i < area; ++i) off_arms.data[i] = IsArmOrHand(parts[i]) ? 0 : 255;
  cv::distanceTransform(off_arms, distance, cv::DIST_L2, cv::DIST_MASK_PRECISE);
  const auto near_arm = [&](size_t i) { return distance.ptr<float>()[i] <= static_cast<float>(reach_px); };
  const auto label = [&](size_t i) { return static_cast<PersonLabel>(labels[i]); };
  MedianColour face_pixels, trunk_pixels, thigh_pixels;
  for (size_t i = 0; i < area; ++i) {
    if (mask[i] == 0) continue;
    const uint8_t* bgr = &picture.bgr[3 * i];
    if (label(i) == PersonLabel::kFace) face_pixels.Add(bgr);
    if (IsTrunk(parts[i]) && !near_arm(i)) trunk_pixels.Add(bgr);
    if (IsThigh(parts[i]) && !near_arm(i)) thigh_pixels.Add(bgr);
  }
  const std::optional<Bgr> face = face_pixels.Get(), trunk = trunk_pixels.Get(), thigh = thigh_pixels.Get();
  std::vector<uint8_t> kept(mask.begin(), mask.end());
  for (size_t i = 0; i < area; ++i) {
    if (!(IsTrunk(parts[i]) || IsThigh(parts[i])) || !near_arm(i)) continue;
    const std::optional<Bgr>& here = IsTrunk(parts[i]) ? trunk : thigh;
    const uint8_t* bgr = &picture.bgr[3 * i];
    const bool like_skin = face && here && SquaredDistance(bgr, *face) < SquaredDistance(bgr, *here);
    if (like_skin || label(i) == PersonLabel::kSkin || label(i) == PersonLabel::kFace) kept[i] = 0;
  }
  return kept;
}

}  // namespace bodyloom
