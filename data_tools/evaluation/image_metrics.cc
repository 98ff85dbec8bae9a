// SPDX-License-Identifier: Apache-2.0
#include "data_tools/evaluation/image_metrics.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "geometry/base/check.h"

namespace bodyloom {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

void RequireMask(int width, int height, const PixelMask* mask) {
  if (mask == nullptr) return;
  BODYLOOM_CHECK(
      mask->width == width && mask->height == height && mask->inside.size() == static_cast<size_t>(width) * height,
      "a mask of ", mask->width, "x", mask->height, " for an image of ", width, "x", height);
}

template <typename Pixels>
void RequireSameSize(const Pixels& truth, const Pixels& result) {
  BODYLOOM_CHECK(truth.width == result.width && truth.height == result.height, "the truth has ", truth.width, "x",
                 truth.height, " pixels, the result ", result.width, "x", result.height);
}

double PsnrOf(double squares, double count, double data_range) {
  if (count == 0) return kNaN;
  return 10 * std::log10(data_range * data_range * count / squares);
}

struct Vector {
  double x, y, z;
};

std::optional<Vector> NormalAt(const uint8_t* bgr) {
  const Vector n{2.0 * bgr[2] / 255 - 1, 2.0 * bgr[1] / 255 - 1, 2.0 * bgr[0] / 255 - 1};
  const double square = n.x * n.x + n.y * n.y + n.z * n.z;
  if (square < 0.25 || square > 2.25) return std::nullopt;
  return n;
}

double AngleDeg(const Vector& a, const Vector& b) {
  const double x = a.y * b.z - a.z * b.y, y = a.z * b.x - a.x * b.z, z = a.x * b.y - a.y * b.x;
  const double cross = std::sqrt(x * x + y * y + z * z), dot = a.x * b.x + a.y * b.y + a.z * b.z;
  return std::atan2(cross, dot) * 180 / std::numbers::pi;
}

double Median(std::vector<double>* values) {
  const size_t half = values->size() / 2;
  const auto middle = values->begin() + static_cast<std::ptrdiff_t>(half);
  std::nth_element(values->begin(), middle, values->end());
  if (values->size() % 2 == 1) return *middle;
  return (*middle + *std::max_element(values->begin(), middle)) / 2;
}

}  // namespace

PixelMask MaskFrom(const Image& image) {
  PixelMask mask{image.width, image.height, std::vector<uint8_t>(image.bgr.size() / 3)};
  for (size_t i = 0; i < mask.inside.size(); ++i) {
    const uint8_t* bgr = &image.bgr[3 * i];
    mask.inside[i] = std::max({bgr[0], bgr[1], bgr[2]}) >= 128 ? 1 : 0;
  }
  return mask;
}

PixelMask RimOf(const PixelMask& mask, int pixels) {
  RequireMask(mask.width, mask.height, &mask);
  PixelMask rim = mask;
  for (int y = 0; y < mask.height; ++y) {
    for (int x = 0; x < mask.width; ++x) {
      bool any = false, all = true;
      for (int v = std::max(0, y - pixels); v <= std::min(mask.height - 1, y + pixels); ++v) {
        for (int u = std::max(0, x - pixels); u <= std::min(mask.width - 1, x + pixels); ++u) {
          const bool inside = mask.inside[static_cast<size_t>(v) * mask.width + u] != 0;
          any = any || inside;
          all = all && inside;
        }
      }
      rim.inside[static_cast<size_t>(y) * mask.width + x] = any && !all ? 1 : 0;
    }
  }
  return rim;
}

PlanarImage PlanarFrom(const Image& image) {
  PlanarImage planar{image.width, image.height, 3, {}};
  const size_t n = image.bgr.size() / 3;
  planar.values.resize(3 * n);
  for (size_t i = 0; i < n; ++i) {
    for (size_t c = 0; c < 3; ++c) planar.values[c * n + i] = image.bgr[3 * i + 2 - c];
  }
  return planar;
}

double Psnr(const PlanarImage& truth, const PlanarImage& result, double data_range, const PixelMask* mask) {
  RequireSameSize(truth, result);
  BODYLOOM_CHECK(truth.channels == result.channels, "the truth has ", truth.channels, " channels, the result ",
                 result.channels);
  BODYLOOM_CHECK(data_range > 0, "a data range of ", data_range, ", expected more than 0");
  RequireMask(truth.width, truth.height, mask);
  double squares = 0, count = 0;
  for (int c = 0; c < truth.channels; ++c) {
    const auto a = truth.plane(c), b = result.plane(c);
    for (size_t i = 0; i < a.size(); ++i) {
      if (mask != nullptr && mask->inside[i] == 0) continue;
      squares += (a[i] - b[i]) * (a[i] - b[i]);
      ++count;
    }
  }
  return PsnrOf(squares, count, data_range);
}

double Psnr(const Image& truth, const Image& result, const PixelMask* mask) {
  RequireSameSize(truth, result);
  RequireMask(truth.width, truth.height, mask);
  int64_t squares = 0, count = 0;
  for (size_t i = 0; i < truth.bgr.size() / 3; ++i) {
    if (mask != nullptr && mask->inside[i] == 0) continue;
    for (size_t c = 3 * i; c < 3 * i + 3; ++c) {
      const int difference = truth.bgr[c] - result.bgr[c];
      squares += difference * difference;
    }
    count += 3;
  }
  return PsnrOf(static_cast<double>(squares), static_cast<double>(count), 255);
}

double MaskIoU(const PixelMask& truth, const PixelMask& result) {
  RequireSameSize(truth, result);
  int64_t both = 0, either = 0;
  for (size_t i = 0; i < truth.inside.size(); ++i) {
    both += truth.inside[i] != 0 && result.inside[i] != 0;
    either += truth.inside[i] != 0 || result.inside[i] != 0;
  }
  return either == 0 ? kNaN : static_cast<double>(both) / static_cast<double>(either);
}

LabelOverlap CompareLabels(std::span<const uint8_t> truth, std::span<const uint8_t> result, int num_labels) {
  BODYLOOM_CHECK(truth.size() == result.size(), "the truth has ", truth.size(), " labels, the result ", result.size());
  std::vector<int64_t> of_truth(num_labels), of_result(num_labels), of_both(num_labels);
  int64_t right = 0;
  for (size_t i = 0; i < truth.size(); ++i) {
    BODYLOOM_CHECK(truth[i] < num_labels && result[i] < num_labels, "label ", int{std::max(truth[i], result[i])},
                   " at pixel ", i, ", expected 0 to ", num_labels - 1);
    ++of_truth[truth[i]];
    ++of_result[result[i]];
    if (truth[i] == result[i]) {
      ++of_both[truth[i]];
      ++right;
    }
  }
  LabelOverlap overlap;
  double sum = 0, present = 0;
  for (int label = 0; label < num_labels; ++label) {
    const int64_t either = of_truth[label] + of_result[label] - of_both[label];
    overlap.iou.push_back(either == 0 ? kNaN : static_cast<double>(of_both[label]) / static_cast<double>(either));
    if (either == 0) continue;
    sum += overlap.iou.back();
    ++present;
  }
  if (present > 0) {
    overlap.mean_iou = sum / present;
    overlap.accuracy = static_cast<double>(right) / static_cast<double>(truth.size());
  }
  return overlap;
}

NormalError CompareNormals(const Image& truth, const Image& result, const PixelMask* mask) {
  RequireSameSize(truth, result);
  RequireMask(truth.width, truth.height, mask);
  std::vector<double> angles_deg;
  double wanted = 0, sum = 0;
  for (size_t i = 0; i < truth.bgr.size() / 3; ++i) {
    if (mask != nullptr && mask->inside[i] == 0) continue;
    const auto a = NormalAt(&truth.bgr[3 * i]);
    if (!a) continue;
    ++wanted;
    const auto b = NormalAt(&result.bgr[3 * i]);
    if (!b) continue;
    angles_deg.push_back(AngleDeg(*a, *b));
    sum += angles_deg.back();
  }
  NormalError error;
  if (wanted > 0) error.coverage = static_cast<double>(angles_deg.size()) / wanted;
  if (!angles_deg.empty()) {
    error.mean_deg = sum / static_cast<double>(angles_deg.size());
    error.median_deg = Median(&angles_deg);
  }
  return error;
}

}  // namespace bodyloom
