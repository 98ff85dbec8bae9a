// SPDX-License-Identifier: Apache-2.0
#include "data_tools/evaluation/ssim.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>

#include "geometry/check.h"

namespace bodyloom {
namespace {

constexpr int kGaussianRadius = 5;
constexpr int kGaussianTaps = 2 * kGaussianRadius + 1;
constexpr double kGaussianSigma = 1.5;

struct PresetRow {
  SsimPreset preset;
  const char* name;
  int taps;          ///< side of the window
  bool is_gaussian;  ///< and population covariance; else uniform and sample covariance
  double range;      ///< L in units of white
};
constexpr PresetRow kPresets[] = {{SsimPreset::kWang2004, "wang2004", kGaussianTaps, true, 1},
                                  {SsimPreset::kSkimage7, "skimage7", 7, false, 1},
                                  {SsimPreset::kPatn, "patn", kGaussianTaps, true, 1},
                                  {SsimPreset::kGfla51, "gfla51", 51, false, 1},
                                  {SsimPreset::kNeuralBody, "neuralbody", 7, false, 2},
                                  {SsimPreset::k3dgs, "3dgs", kGaussianTaps, true, 1},
                                  {SsimPreset::kPiq, "piq", kGaussianTaps, true, 1}};

const PresetRow& RowOf(SsimPreset preset) {
  return *std::find_if(std::begin(kPresets), std::end(kPresets), [&](const auto& row) { return row.preset == preset; });
}

/// One channel of both pictures.
struct PlanePair {
  int width = 0, height = 0;
  std::vector<double> a, b;
};

/// What a window is filtered for: a, b, a² + b², ab. SSIM needs no more, as it holds the variances as a sum alone.
constexpr int kMoments = 4;

struct Constants {
  double c1 = 0, c2 = 0;
  double covariance_norm = 1;
};

double SsimAt(double mean_a, double mean_b, double mean_squares, double mean_product, const Constants& k) {
  const double product = mean_a * mean_b, squares = mean_a * mean_a + mean_b * mean_b;
  const double covariance = k.covariance_norm * (mean_product - product);
  const double variances = k.covariance_norm * (mean_squares - squares);
  return ((2 * product + k.c1) * (2 * covariance + k.c2)) / ((squares + k.c1) * (variances + k.c2));
}

std::array<double, kGaussianRadius + 1> GaussianHalf() {
  std::array<double, kGaussianRadius + 1> half{};  // from the edge to the centre
  double sum = 0;
  for (int i = 0; i <= kGaussianRadius; ++i) {
    const double x = (i - kGaussianRadius) / kGaussianSigma;
    half[i] = std::exp(-0.5 * x * x);
    sum += (i < kGaussianRadius ? 2 : 1) * half[i];
  }
  for (double& weight : half) weight /= sum;
  return half;
}

/// Mean over all windows inside the planes, separable, in strips of columns whose working rows stay in the cache.
double GaussianMean(const PlanePair& planes, const Constants& constants) {
  constexpr int kStrip = 256, kWide = kStrip + 2 * kGaussianRadius;
  const std::array<double, kGaussianRadius + 1> half = GaussianHalf();
  const int out_width = planes.width - 2 * kGaussianRadius, out_height = planes.height - 2 * kGaussianRadius;
  std::vector<double> wide(kMoments * kWide), rows(size_t{kGaussianTaps} * kMoments * kStrip);
  std::vector<double> columns(kMoments * kStrip);
  double total = 0;
  for (int begin = 0; begin < out_width; begin += kStrip) {
    const int n = std::min(kStrip, out_width - begin);
    for (int y = 0; y < planes.height; ++y) {
      const double* a = &planes.a[static_cast<size_t>(y) * planes.width + begin];
      const double* b = &planes.b[static_cast<size_t>(y) * planes.width + begin];
      for (int x = 0; x < n + 2 * kGaussianRadius; ++x) {
        wide[x] = a[x];
        wide[kWide + x] = b[x];
        wide[2 * kWide + x] = a[x] * a[x] + b[x] * b[x];
        wide[3 * kWide + x] = a[x] * b[x];
      }
      double* row = &rows[size_t(y % kGaussianTaps) * kMoments * kStrip];
      for (int m = 0; m < kMoments; ++m) {
        const double* in = &wide[m * kWide];
        double* out = row + m * kStrip;
        for (int x = 0; x < n; ++x) {
          double sum = half[kGaussianRadius] * in[x + kGaussianRadius];
          for (int t = 0; t < kGaussianRadius; ++t) sum += half[t] * (in[x + t] + in[x + 2 * kGaussianRadius - t]);
          out[x] = sum;
        }
      }
      if (y < 2 * kGaussianRadius) continue;
      const double* line[kGaussianTaps];  // from the window's first row to its last
      for (int t = 0; t < kGaussianTaps; ++t) line[t] = &rows[size_t((y + 1 + t) % kGaussianTaps) * kMoments * kStrip];
      for (int m = 0; m < kMoments; ++m) {
        for (int x = m * kStrip; x < m * kStrip + n; ++x) {
          double sum = half[kGaussianRadius] * line[kGaussianRadius][x];
          for (int t = 0; t < kGaussianRadius; ++t) sum += half[t] * (line[t][x] + line[2 * kGaussianRadius - t][x]);
          columns[x] = sum;
        }
      }
      for (int x = 0; x < n; ++x) {  // apart from the sum, which would keep the divisions from being vectorised
        wide[x] = SsimAt(columns[x], columns[kStrip + x], columns[2 * kStrip + x], columns[3 * kStrip + x], constants);
      }
      total += std::accumulate(wide.begin(), wide.begin() + n, 0.0);
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
  const auto add_row = [&](int y, double sign) {
    const size_t row = static_cast<size_t>(y) * width;
    for (int x = 0; x < width; ++x) {
      const double a = planes.a[row + x], b = planes.b[row + x];
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
  PlanePair padded{planes.width + 2 * border, planes.height + 2 * border, {}, {}};
  const size_t n = static_cast<size_t>(padded.width) * padded.height;
  for (const auto& [from, to] : {std::pair(&planes.a, &padded.a), std::pair(&planes.b, &padded.b)}) {
    to->assign(n, 0);
    for (int y = 0; y < planes.height; ++y) {
      std::copy_n(from->data() + static_cast<size_t>(y) * planes.width, planes.width,
                  to->data() + static_cast<size_t>(y + border) * padded.width + border);
    }
  }
  return padded;
}

/// Means of factor×factor pixels.
PlanePair Pooled(const PlanePair& planes, int factor) {
  PlanePair pooled{planes.width / factor, planes.height / factor, {}, {}};
  const double per_pixel = 1.0 / (static_cast<double>(factor) * factor);
  for (const auto& [from, to] : {std::pair(&planes.a, &pooled.a), std::pair(&planes.b, &pooled.b)}) {
    to->assign(static_cast<size_t>(pooled.width) * pooled.height, 0);
    for (int y = 0; y < pooled.height * factor; ++y) {
      for (int x = 0; x < pooled.width * factor; ++x) {
        (*to)[static_cast<size_t>(y / factor) * pooled.width + x / factor] +=
            per_pixel * (*from)[static_cast<size_t>(y) * planes.width + x];
      }
    }
  }
  return pooled;
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
  if (row.preset == SsimPreset::k3dgs) return GaussianMean(Padded(planes, kGaussianRadius), constants);
  if (row.preset == SsimPreset::kPiq) {
    // nearbyint rounds halves to even, as Python's round does.
    const int factor = static_cast<int>(std::nearbyint(std::min(planes.width, planes.height) / 256.0));
    if (factor > 1) return GaussianMean(Pooled(planes, factor), constants);
  }
  return GaussianMean(planes, constants);
}

/// `plane(channel, box)` gives both pictures' channel cut to a box.
template <typename Planes>
double SsimOf(int width, int height, int channels, const PresetRow& row, double range, const PixelMask* mask,
              const Planes& plane) {
  const int least = SsimMinimumSize(row.preset);
  BODYLOOM_CHECK(channels > 0 && width >= least && height >= least, "SSIM preset ", row.name, ": pictures of ", width,
                 "x", height, " and ", channels, " channels, expected at least ", least, "x", least, " and 1");
  Box box{0, 0, width, height};
  if (row.preset == SsimPreset::kNeuralBody && mask != nullptr) {
    BODYLOOM_CHECK(
        mask->width == width && mask->height == height && mask->inside.size() == static_cast<size_t>(width) * height,
        "a mask of ", mask->width, "x", mask->height, " for a picture of ", width, "x", height);
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
    const auto [least, most] = std::minmax_element(result.values.begin(), result.values.end());
    range = *most - *least;
  }
  return SsimOf(truth.width, truth.height, truth.channels, row, range, mask, [&](int channel, const Box& box) {
    PlanePair planes{box.width(), box.height(), {}, {}};
    for (int y = box.y_begin; y < box.y_end; ++y) {
      const size_t begin = static_cast<size_t>(y) * truth.width + box.x_begin;
      const auto a = truth.plane(channel).subspan(begin, box.width());
      const auto b = result.plane(channel).subspan(begin, box.width());
      planes.a.insert(planes.a.end(), a.begin(), a.end());
      planes.b.insert(planes.b.end(), b.begin(), b.end());
    }
    return planes;
  });
}

double Ssim(const Image& truth, const Image& result, SsimPreset preset, const PixelMask* mask) {
  BODYLOOM_CHECK(truth.width == result.width && truth.height == result.height, "the truth has ", truth.width, "x",
                 truth.height, " pixels, the result ", result.width, "x", result.height);
  const PresetRow& row = RowOf(preset);
  double range = row.range * 255;
  if (preset == SsimPreset::kPatn && !result.bgr.empty()) {
    const auto [least, most] = std::minmax_element(result.bgr.begin(), result.bgr.end());
    range = *most - *least;
  }
  return SsimOf(truth.width, truth.height, 3, row, range, mask, [&](int channel, const Box& box) {
    PlanePair planes{box.width(), box.height(), {}, {}};
    const size_t n = static_cast<size_t>(box.width()) * box.height();
    planes.a.reserve(n);
    planes.b.reserve(n);
    for (int y = box.y_begin; y < box.y_end; ++y) {
      for (int x = box.x_begin; x < box.x_end; ++x) {
        planes.a.push_back(truth.pixel(x, y)[channel]);
        planes.b.push_back(result.pixel(x, y)[channel]);
      }
    }
    return planes;
  });
}

}  // namespace bodyloom
