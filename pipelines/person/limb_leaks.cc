// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/pipelines/person/limb_leaks.h"

#include <algorithm>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <vector>

#include "bodyloom/geometry/person_label.h"
#include "bodyloom/geometry/base/check.h"
#include "bodyloom/render/median_colour.h"

namespace bodyloom {
namespace {

constexpr size_t kFewest = 50;  ///< pixels of a colour that is worth asking

bool IsTrunk(int part) { return part == 1 || part == 2; }
bool IsThigh(int part) { return part >= 7 && part <= 10; }
bool IsArmOrHand(int part) { return part == 3 || part == 4 || (part >= 15 && part <= 22); }

ChannelTriple ColourOf(const uint8_t* bgr) {
  return {static_cast<float>(bgr[0]), static_cast<float>(bgr[1]), static_cast<float>(bgr[2])};
}

float SquaredDistance(const ChannelTriple& a, const ChannelTriple& b) {
  float sum = 0;
  for (size_t c = 0; c < 3; ++c) sum += (a[c] - b[c]) * (a[c] - b[c]);
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
  std::vector<ChannelTriple> face_pixels, trunk_pixels, thigh_pixels;
  for (size_t i = 0; i < area; ++i) {
    if (mask[i] == 0) continue;
    const ChannelTriple bgr = ColourOf(&picture.bgr[3 * i]);
    if (label(i) == PersonLabel::kFace) face_pixels.push_back(bgr);
    if (IsTrunk(parts[i]) && !near_arm(i)) trunk_pixels.push_back(bgr);
    if (IsThigh(parts[i]) && !near_arm(i)) thigh_pixels.push_back(bgr);
  }
  const std::optional<ChannelTriple> face = MedianColourOfMany(face_pixels, kFewest),
                                     trunk = MedianColourOfMany(trunk_pixels, kFewest),
                                     thigh = MedianColourOfMany(thigh_pixels, kFewest);
  std::vector<uint8_t> kept(mask.begin(), mask.end());
  for (size_t i = 0; i < area; ++i) {
    if (!(IsTrunk(parts[i]) || IsThigh(parts[i])) || !near_arm(i)) continue;
    const std::optional<ChannelTriple>& here = IsTrunk(parts[i]) ? trunk : thigh;
    const ChannelTriple bgr = ColourOf(&picture.bgr[3 * i]);
    const bool like_skin = face && here && SquaredDistance(bgr, *face) < SquaredDistance(bgr, *here);
    if (like_skin || label(i) == PersonLabel::kSkin || label(i) == PersonLabel::kFace) kept[i] = 0;
  }
  return kept;
}

}  // namespace bodyloom
