// SPDX-License-Identifier: Apache-2.0
#include "data_tools/evaluation/ssim.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iterator>
#include <limits>
#include <numeric>

#include "data_tools/evaluation/ssim_rows_simd.h"
#include "geometry/base/check.h"

namespace bodyloom {
namespace {

using ssim_internal::Constants;
using ssim_internal::kMoments;
using ssim_internal::kRadius;
using ssim_internal::kTaps;

constexpr double kGaussianSigma = 1.5;

struct PresetRow {
  SsimPreset preset;
  const char* name;
  int taps;          ///< side of the window
  bool is_gaussian;  ///< and population covariance; else uniform and sample covariance
  double range;      ///< L in units of white
};
constexpr PresetRow kPresets[] = {{SsimPreset::kWang2004, "wang2004", kTaps, true, 1},
                                  {SsimPreset::kSkimage7, "skimage7", 7, false, 1},
                                  {SsimPreset::kPatn, "patn", kTaps, true, 1},
                                  {SsimPreset::kGfla51, "gfla51", 51, false, 1},
                                  {SsimPreset::kNeuralBody, "neuralbody", 7, false, 2},
                                  {SsimPreset::k3dgs, "3dgs", kTaps, true, 1},
                                  {SsimPreset::kPiq, "piq", kTaps, true, 1}};

const PresetRow& RowOf(SsimPreset preset) {
  return *std::find_if(std::begin(kPresets), std::end(kPresets), [&](const auto& row) { return row.preset == preset; });
}

/// One channel of both images, read a piece of a row at a time.
struct PlanePair {
  int width = 0, height = 0;
  /// Puts the n values from (x, y) on into a and b.
  std::function<void(int x, int y, int n, double* a, double* b)> read;
};

double SsimAt(double mean_a, double mean_b, double mean_squares, double mean_product, const Constants& k) {
  const double product = mean_a * mean_b, squares = mean_a * mean_a + mean_b * mean_b;
  const double covariance = k.covariance_norm * (mean_product - product);
  const double variances = k.covariance_norm * (mean_squares - squares);
  return ((2 * product + k.c1) * (2 * covariance + k.c2)) / ((squares + k.c1) * (variances + k.c2));
}

/// Weights from the window's edge to its centre.
std::array<double, kRadius + 1> GaussianHalf() {
  std::array<double, kRadius + 1> half{};
  double sum = 0;
  for (int i = 0; i <= kRadius; ++i) {
    const double x = (i - kRadius) / kGaussianSigma;
    half[i] = std::exp(-0.5 * x * x);
    sum += (i < kRadius ? 2 : 1) * half[i];
  }
  for (double& weight : half) weight /= sum;
  return half;
}

/// Mean over all windows inside the planes, separable, in strips of columns whose working rows stay in the cache.
double GaussianMean(const PlanePair& planes, const Constants& constants) {
  using ssim_internal::kStrip;
  const std::array<double, kRadius + 1> half = GaussianHalf();
  const int out_width = planes.width - 2 * kRadius, out_height = planes.height - 2 * kRadius;
  constexpr size_t kLine = size_t{kMoments} * ssim_internal::kPitch;
  std::vector<double> a(ssim_internal::kWide), b(ssim_internal::kWide), lines(kTaps * kLine), ssim(kStrip);
  double total = 0;
  for (int begin = 0; begin < out_width; begin += kStrip) {
    const int n = std::min(kStrip, out_width - begin);
    for (int y = 0; y < planes.height; ++y) {
      planes.read(begin, y, n + 2 * kRadius, a.data(), b.data());
      ssim_internal::FilterAlong(a.data(), b.data(), half.data(), n, &lines[(y % kTaps) * kLine]);
      if (y < 2 * kRadius) continue;
      const double* window[kTaps];  // from its first row to its last
      for (int t = 0; t < kTaps; ++t) window[t] = &lines[((y + 1 + t) % kTaps) * kLine];
      ssim_internal::SsimAcross(window, half.data(), constants, n, ssim.data());
      total += std::accumulate(ssim.begin(), ssim.begin() + n, 0.0);
    }
  }
  return total / (static_cast<double>(out_width) * out_height);
}

/// Mean over all taps×taps windows inside the planes by running sums: of columns from row to row, then along the row.
/// Bytes stay exact.
double UniformMean(const PlanePair& planes, int taps, const Constants& constants) {
  const int width = planes.width, out_width = width - taps + 1, out_height = planes.height - taps + 1;
  const double per_pixel = 1.0 / (static_cast<double>(taps) * taps);
  std::vector<std::array<double, kMoments>> columns(width);
  std::vector<double> row_a(width), row_b(width);
  const auto add_row = [&](int y, double sign) {
    planes.read(0, y, width, row_a.data(), row_b.data());
    for (int x = 0; x < width; ++x) {
      const double a = row_a[x], b = row_b[x];
      columns[x][0] += sign * a;
      columns[x][1] += sign * b;
      columns[x][2] += sign * (a * a + b * b);
      columns[x][3] += sign * (a * b);
    }
  };
  double total = 0;
  for (int y = 0; y < planes.height; ++y) {
    add_row(y, 1);
    if (y >= taps) add_row(y - taps, -1);
    if (y + 1 < taps) continue;
    std::array<double, kMoments> window{};
    double sum = 0;
    for (int x = 0; x < width; ++x) {
      for (int m = 0; m < kMoments; ++m) window[m] += columns[x][m];
      if (x + 1 < taps) continue;
      sum +=
          SsimAt(window[0] * per_pixel, window[1] * per_pixel, window[2] * per_pixel, window[3] * per_pixel, constants);
      for (int m = 0; m < kMoments; ++m) window[m] -= columns[x + 1 - taps][m];
    }
    total += sum;
  }
  return total / (static_cast<double>(out_width) * out_height);
}

/// The planes with `border` zeros on every side.
PlanePair Padded(const PlanePair& planes, int border) {
  const auto read = [planes, border](int x, int y, int n, double* a, double* b) {
    std::fill_n(a, n, 0.0);
    std::fill_n(b, n, 0.0);
    const int begin = std::max(x - border, 0), end = std::min(x - border + n, planes.width);
    if (y < border || y >= planes.height + border || begin >= end) return;
    const int skipped = begin - (x - border);
    planes.read(begin, y - border, end - begin, a + skipped, b + skipped);
  };
  return {planes.width + 2 * border, planes.height + 2 * border, read};
}

/// Means of factor×factor pixels.
PlanePair Pooled(const PlanePair& planes, int factor) {
  const auto read = [planes, factor](int x, int y, int n, double* a, double* b) {
    const double per_pixel = 1.0 / (static_cast<double>(factor) * factor);
    std::vector<double> row_a(static_cast<size_t>(n) * factor), row_b(row_a.size());
    std::fill_n(a, n, 0.0);
    std::fill_n(b, n, 0.0);
    for (int j = 0; j < factor; ++j) {
      planes.read(x * factor, y * factor + j, n * factor, row_a.data(), row_b.data());
      for (int i = 0; i < n * factor; ++i) {
        a[i / factor] += per_pixel * row_a[i];
        b[i / factor] += per_pixel * row_b[i];
      }
    }
  };
  return {planes.width / factor, planes.height / factor, read};
}

struct Box {
  int x_begin = 0, y_begin = 0, x_end = 0, y_end = 0;
  [[nodiscard]] int width() const { return x_end - x_begin; }
  [[nodiscard]] int height() const { return y_end - y_begin; }
};

Box BoxOf(const PixelMask& mask) {
  Box box{mask.width, mask.height, 0, 0};
  for (int y = 0; y < mask.height; ++y) {
    for (int x = 0; x < mask.width; ++x) {
      if (mask.inside[static_cast<size_t>(y) * mask.width + x] == 0) continue;
      box = {std::min(box.x_begin, x), std::min(box.y_begin, y), std::max(box.x_end, x + 1),
             std::max(box.y_end, y + 1)};
    }
  }
  return box;
}

/// SSIM of one channel under a preset whose range L is known.
double PlaneSsim(const PlanePair& planes, const PresetRow& row, double range) {
  Constants constants;
  constants.c1 = 0.01 * range * 0.01 * range;
  constants.c2 = 0.03 * range * 0.03 * range;
  if (!row.is_gaussian) {
    const double count = static_cast<double>(row.taps) * row.taps;
    constants.covariance_norm = count / (count - 1);
    return UniformMean(planes, row.taps, constants);
  }
  if (row.preset == SsimPreset::k3dgs) return GaussianMean(Padded(planes, kRadius), constants);
  if (row.preset == SsimPreset::kPiq) {
    // nearbyint rounds halves to even, as Python's round does.
    const int factor = static_cast<int>(std::nearbyint(std::min(planes.width, planes.height) / 256.0));
    if (factor > 1) return GaussianMean(Pooled(planes, factor), constants);
  }
  return GaussianMean(planes, constants);
}

/// `plane(channel, box)` gives both images' channel cut to a box.
template <typename Planes>
double SsimOf(int width, int height, int channels, const PresetRow& row, double range, const PixelMask* mask,
              const Planes& plane) {
  const int minimum = SsimMinimumSize(row.preset);
  BODYLOOM_CHECK(channels > 0 && width >= minimum && height >= minimum, "SSIM preset ", row.name, ": images of ", width,
                 "x", height, " and ", channels, " channels, expected at least ", minimum, "x", minimum, " and 1");
  Box box{0, 0, width, height};
  if (row.preset == SsimPreset::kNeuralBody && mask != nullptr) {
    BODYLOOM_CHECK(
        mask->width == width && mask->height == height && mask->inside.size() == static_cast<size_t>(width) * height,
        "a mask of ", mask->width, "x", mask->height, " for an image of ", width, "x", height);
    box = BoxOf(*mask);
    if (box.width() < row.taps || box.height() < row.taps) return std::numeric_limits<double>::quiet_NaN();
  }
  if (!(range > 0)) return std::numeric_limits<double>::quiet_NaN();
  double sum = 0;
  for (int c = 0; c < channels; ++c) sum += PlaneSsim(plane(c, box), row, range);
  return sum / channels;
}

}  // namespace

std::vector<std::string> SsimPresetNames() {
  std::vector<std::string> names;
  for (const PresetRow& row : kPresets) names.emplace_back(row.name);
  return names;
}

std::string ToText(SsimPreset preset) { return RowOf(preset).name; }

std::optional<SsimPreset> SsimPresetFrom(std::string_view name) {
  for (const PresetRow& row : kPresets) {
    if (row.name == name) return row.preset;
  }
  return std::nullopt;
}

int SsimMinimumSize(SsimPreset preset) { return preset == SsimPreset::k3dgs ? 1 : RowOf(preset).taps; }

double Ssim(const PlanarImage& truth, const PlanarImage& result, SsimPreset preset, double white,
            const PixelMask* mask) {
  BODYLOOM_CHECK(truth.width == result.width && truth.height == result.height && truth.channels == result.channels,
                 "the truth has ", truth.width, "x", truth.height, " pixels of ", truth.channels,
                 " channels, the result ", result.width, "x", result.height, " of ", result.channels);
  const PresetRow& row = RowOf(preset);
  double range = row.range * white;
  if (preset == SsimPreset::kPatn && !result.values.empty()) {
    const auto [minimum, maximum] = std::minmax_element(result.values.begin(), result.values.end());
    range = *maximum - *minimum;
  }
  return SsimOf(truth.width, truth.height, truth.channels, row, range, mask, [&](int channel, const Box& box) {
    const auto read = [&truth, &result, box, channel](int x, int y, int n, double* a, double* b) {
      const size_t begin = static_cast<size_t>(y + box.y_begin) * truth.width + box.x_begin + x;
      std::copy_n(truth.plane(channel).data() + begin, n, a);
      std::copy_n(result.plane(channel).data() + begin, n, b);
    };
    return PlanePair{box.width(), box.height(), read};
  });
}

double Ssim(const Image& truth, const Image& result, SsimPreset preset, const PixelMask* mask) {
  BODYLOOM_CHECK(truth.width == result.width && truth.height == result.height, "the truth has ", truth.width, "x",
                 truth.height, " pixels, the result ", result.width, "x", result.height);
  const PresetRow& row = RowOf(preset);
  double range = row.range * 255;
  if (preset == SsimPreset::kPatn && !result.bgr.empty()) {
    const auto [minimum, maximum] = std::minmax_element(result.bgr.begin(), result.bgr.end());
    range = *maximum - *minimum;
  }
  return SsimOf(truth.width, truth.height, 3, row, range, mask, [&](int channel, const Box& box) {
    const auto read = [&truth, &result, box, channel](int x, int y, int n, double* a, double* b) {
      const uint8_t* bytes_a = truth.pixel(box.x_begin + x, box.y_begin + y) + channel;
      const uint8_t* bytes_b = result.pixel(box.x_begin + x, box.y_begin + y) + channel;
      for (int i = 0; i < n; ++i) {
        a[i] = bytes_a[3 * i];
        b[i] = bytes_b[3 * i];
      }
    };
    return PlanePair{box.width(), box.height(), read};
  });
}

}  // namespace bodyloom
