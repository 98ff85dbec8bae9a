// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/pipelines/person/label_colours.h"

#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <vector>

#include "bodyloom/geometry/person_label.h"
#include "bodyloom/geometry/base/check.h"
#include "bodyloom/render/median_colour.h"

namespace bodyloom {
namespace {

constexpr float kLightnessWeight = 0.5F;
constexpr float kRatio = 0.5F;
constexpr size_t kFewestPixels = 50;

/// (L/2, a, b) of some pixels of the picture.
std::vector<ChannelTriple> LabOf(const Image& picture, const std::vector<size_t>& pixels) {
  cv::Mat colours(1, static_cast<int>(pixels.size()), CV_32FC3);
  for (size_t k = 0; k < pixels.size(); ++k) {
    const uint8_t* bgr = &picture.bgr[3 * pixels[k]];
    colours.at<cv::Vec3f>(static_cast<int>(k)) = cv::Vec3f(bgr[0], bgr[1], bgr[2]) / 255;
  }
  cv::cvtColor(colours, colours, cv::COLOR_BGR2Lab);
  std::vector<ChannelTriple> lab;
  lab.reserve(pixels.size());
  for (const cv::Vec3f& colour : cv::Mat_<cv::Vec3f>(colours)) {
    lab.push_back({colour[0] * kLightnessWeight, colour[1], colour[2]});
  }
  return lab;
}

float Distance(const ChannelTriple& a, const ChannelTriple& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

}  // namespace

void RelabelByColour(const Image& picture, std::span<uint8_t> labels) {
  BODYLOOM_CHECK(3 * labels.size() == picture.bgr.size(), "labels by colour: ", labels.size(), " labels for ",
                 picture.width, "x", picture.height, " pixels");
  std::vector<size_t> pixels;
  for (size_t i = 0; i < labels.size(); ++i) {
    if (labels[i] == 0 || labels[i] >= kNumPersonLabels) continue;
    pixels.push_back(i);
  }
  if (pixels.empty()) return;
  const std::vector<ChannelTriple> colours = LabOf(picture, pixels);
  std::array<std::vector<ChannelTriple>, kNumPersonLabels> of_label;
  for (size_t k = 0; k < pixels.size(); ++k) of_label[labels[pixels[k]]].push_back(colours[k]);
  const auto median_of = [&](PersonLabel label) {
    return MedianColourOfMany(of_label[static_cast<size_t>(label)], kFewestPixels);
  };
  const std::optional<ChannelTriple> face = median_of(PersonLabel::kFace);
  if (!face) return;
  const std::array<PersonLabel, 2> kinds = {PersonLabel::kTop, PersonLabel::kBottom};
  const std::array<std::optional<ChannelTriple>, 2> worn = {median_of(kinds[0]), median_of(kinds[1])};
  for (size_t k = 0; k < pixels.size(); ++k) {
    uint8_t& label = labels[pixels[k]];
    const float to_face = Distance(colours[k], *face);
    float nearest = kRatio * to_face;
    const bool skin = label == static_cast<uint8_t>(PersonLabel::kSkin);
    for (size_t j = 0; j < 2; ++j) {
      if (!worn[j]) continue;
      const float to_worn = Distance(colours[k], *worn[j]);
      if (skin && to_worn < nearest) {
        nearest = to_worn;
        label = static_cast<uint8_t>(kinds[j]);
      } else if (!skin && label == static_cast<uint8_t>(kinds[j]) && to_face < kRatio * to_worn) {
        label = static_cast<uint8_t>(PersonLabel::kSkin);
        break;
      }
    }
  }
}

}  // namespace bodyloom
