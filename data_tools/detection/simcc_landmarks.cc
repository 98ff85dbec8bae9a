// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/data_tools/detection/simcc_landmarks.h"

#include <algorithm>
#include <cmath>

#include "bodyloom/geometry/base/check.h"

namespace bodyloom {
namespace {

/// The first of the largest scores; one that is not a number is none.
size_t LargestAt(std::span<const float> scores) {
  size_t best = 0;
  for (size_t i = 1; i < scores.size(); ++i) {
    if (scores[i] > scores[best] || std::isnan(scores[best])) best = i;
  }
  return best;
}

}  // namespace

std::vector<Keypoint> DecodeSimcc(std::span<const float> columns, std::span<const float> rows, int landmarks,
                                  int per_pixel, const PictureCrop& crop) {
  BODYLOOM_CHECK(landmarks >= 1 && per_pixel >= 1 && crop.width >= 1 && crop.height >= 1, landmarks, " landmarks, ",
                 per_pixel, " scores a pixel");
  const size_t width = size_t(per_pixel) * size_t(crop.width), height = size_t(per_pixel) * size_t(crop.height);
  BODYLOOM_CHECK(columns.size() == width * size_t(landmarks) && rows.size() == height * size_t(landmarks),
                 columns.size(), " and ", rows.size(), " scores for ", landmarks, " landmarks in ", crop.width, "x",
                 crop.height, " pixels");
  std::vector<Keypoint> points;
  for (size_t k = 0; k < size_t(landmarks); ++k) {
    const std::span<const float> across = columns.subspan(k * width, width), down = rows.subspan(k * height, height);
    const size_t column = LargestAt(across), row = LargestAt(down);
    const float score = std::min(across[column], down[row]);
    const Eigen::Array2d pixel = crop.ImageFromCrop(Eigen::Array2d(double(column), double(row)) / per_pixel);
    const bool seen = across[column] > 0 && down[row] > 0;
    points.push_back(seen ? Keypoint{float(pixel.x()), float(pixel.y()), std::min(score, 1.0F)} : Keypoint{0, 0, 0});
  }
  return points;
}

}  // namespace bodyloom
