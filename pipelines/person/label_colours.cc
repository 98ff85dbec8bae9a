// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/pipelines/person/label_colours.h"

#include <array>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <vector>

#include "bodyloom/data_tools/datasets/single_person_dataset.h"
#include "bodyloom/geometry/base/check.h"
#include "bodyloom/geometry/base/percentile.h"

namespace bodyloom {
namespace {

constexpr float kLightnessWeight = 0.5F;
constexpr float kRatio = 0.5F;
constexpr size_t kFewestPixels = 50;

/// (L/2, a, b) of some pixels of the picture.
std::vector<cv::Vec3f> LabOf(const Image& picture, const std::vector<size_t>& pixels) {
  cv::Mat colours(1, static_cast<int>(pixels.size()), CV_32FC3);
  for (size_t k = 0; k < pixels.size(); ++k) {
    const uint8_t* bgr = &picture.bgr[3 * pixels[k]];
    colours.at<cv::Vec3f>(static_cast<int>(k)) = cv::Vec3f(bgr[0], bgr[1], bgr[2]) / 255;
  }
  cv::cvtColor(colours, colours, cv::COLOR_BGR2Lab);
  std::vector<cv::Vec3f> lab(colours.begin<cv::Vec3f>(), colours.end<cv::Vec3f>());
  for (cv::Vec3f& colour : lab) colour[0] *= kLightnessWeight;
  return lab;
}

std::optional<cv::Vec3f> MedianLab(const std::vector<cv::Vec3f>& colours, const std::vector<size_t>& which) {
  if (which.size() < kFewestPixels) return std::nullopt;
  cv::Vec3f median;
  for (int c = 0; c < 3; ++c) {
    std::vector<double> values;
    values.reserve(which.size());
    for (const size_t k : which) values.push_back(colours[k][c]);
    median[c] = static_cast<float>(Percentile(values, 50));
  }
  return median;
}

}  // namespace

void RelabelByColour(const Image& picture, std::span<uint8_t> labels) {
  BODYLOOM_CHECK(3 * labels.size() == picture.bgr.size(), "labels by colour: ", labels.size(), " labels for ",
                 picture.width, "x", picture.height, " pixels");
  std::vector<size_t> pixels;
  std::array<std::vector<size_t>, kNumPersonLabels> of_label;
  for (size_t i = 0; i < labels.size(); ++i) {
    if (labels[i] == 0 || labels[i] >= kNumPersonLabels) continue;
    of_label[labels[i]].push_back(pixels.size());
    pixels.push_back(i);
  }
  if (pixels.empty()) return;
  const std::vector<cv::Vec3f> colours = LabOf(picture, pixels);
  const auto median_of = [&](PersonLabel label) { return MedianLab(colours, of_label[static_cast<size_t>(label)]); };
  const std::optional<cv::Vec3f> face = median_of(PersonLabel::kFace);
  if (!face) return;
  const std::array<PersonLabel, 2> kinds = {PersonLabel::kTop, PersonLabel::kBottom};
  const std::array<std::optional<cv::Vec3f>, 2> worn = {median_of(kinds[0]), median_of(kinds[1])};
  for (size_t k = 0; k < pixels.size(); ++k) {
    uint8_t& label = labels[pixels[k]];
    const double to_face = cv::norm(colours[k] - *face);
    double nearest = kRatio * to_face;
    const bool skin = label == static_cast<uint8_t>(PersonLabel::kSkin);
    for (size_t j = 0; j < 2; ++j) {
      if (!worn[j]) continue;
      const double to_worn = cv::norm(colours[k] - *worn[j]);
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
