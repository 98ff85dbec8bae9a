// SPDX-License-Identifier: Apache-2.0
#include "render/gaussian_avatar/learning/image_loss.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "geometry/base/check.h"
#include "geometry/base/parallel.h"
#include "render/gaussian_avatar/learning/ssim_filter_simd.h"

namespace bodyloom {
namespace {

using namespace avatar_internal;  // NOLINT

constexpr int kLossRows = 16;    ///< rows per task
constexpr int kLossMargin = 16;  ///< zero padding on both sides of a filtered row
constexpr float kAbsoluteShare = 0.8F, kSsimShare = 0.2F;
constexpr double kPersonPixels = 1.3;
constexpr int kAlphaPlane = 3;

/// Rows of floats with zero padding.
class MarginRows {
 public:
  MarginRows(int rows, size_t pitch) : pitch_(pitch + 2 * kLossMargin), values_(rows * pitch_, 0.0F) {}
  float* operator[](int r) { return values_.data() + r * pitch_ + kLossMargin; }

 private:
  size_t pitch_;
  std::vector<float> values_;
};

void PutOver(const FloatColumns& planes, int channel, size_t first, int n, float background, float* out) {
  const float *colour = planes.column(channel) + first, *alpha = planes.column(kAlphaPlane) + first;
  for (int x = 0; x < n; ++x) out[x] = colour[x] + (1 - alpha[x]) * background;
}

/// Sums in sixteen lanes, so that the compiler can vectorise.
double SumOfRow(const float* values, int n) {
  constexpr int kLanes = FloatColumns::kLanes;
  float lanes[kLanes] = {};
  int x = 0;
  for (; x + kLanes <= n; x += kLanes) {
    for (int k = 0; k < kLanes; ++k) lanes[k] += values[x + k];
  }
  double sum = 0;
  for (const float lane : lanes) sum += lane;
  for (; x < n; ++x) sum += values[x];
  return sum;
}

/// The rows around y; zeros outside the image.
void LinesAround(const float* column, int y, int height, size_t pitch, const float* zeros, const float** lines) {
  for (int t = 0; t < kSsimTaps; ++t) {
    const int row = y + t - kSsimRadius;
    lines[t] = row >= 0 && row < height ? column + row * pitch : zeros;
  }
}

}  // namespace

double ImageLoss::ByPixel(const ImageTruth& truth) {
  return kAbsoluteShare / (3 * kPersonPixels * truth.person_pixels);
}

double ImageLoss::Compute(const FloatColumns& image, const ImageTruth& truth, const std::array<float, 3>& background,
                          int num_threads, FloatColumns* by_planes) {
  const size_t area = static_cast<size_t>(truth.width) * truth.height;
  BODYLOOM_CHECK(truth.width > 0 && truth.height > 0 && truth.planes.columns() == 4 &&
                     static_cast<size_t>(truth.planes.rows()) == area && image.columns() == 4 &&
                     image.rows() == truth.planes.rows() && truth.person_pixels > 0,
                 "picture loss: an image of ", image.rows(), " pixels and ", image.columns(), " planes, a truth of ",
                 truth.width, "x", truth.height);
  width_ = truth.width, height_ = truth.height;
  pitch_ = (static_cast<size_t>(width_) + kSsimLanes - 1) / kSsimLanes * kSsimLanes;
  half_ = SsimWindow();
  moments_.Resize(12, static_cast<int>(pitch_) * height_);
  by_moments_.Resize(9, static_cast<int>(pitch_) * height_);
  by_planes->Resize(4, image.rows());
  const std::vector<float> zeros(pitch_, 0.0F);
  std::vector<double> row_sum(static_cast<size_t>(height_) * 2, 0.0);
  const int chunks = (height_ + kLossRows - 1) / kLossRows;
  const auto rows_of = [&](int chunk, const auto& work) {
    for (int y = chunk * kLossRows; y < std::min(height_, (chunk + 1) * kLossRows); ++y) work(y);
  };

  const auto along = [&](int chunk) {
    MarginRows row(4, pitch_);
    rows_of(chunk, [&](int y) {
      for (int c = 0; c < 3; ++c) {
        PutOver(image, c, size_t(y) * width_, width_, background[c], row[0]);
        PutOver(truth.planes, c, size_t(y) * width_, width_, background[c], row[1]);
        SsimProducts(row[0], row[1], width_, row[2], row[3]);
        for (int m = 0; m < 4; ++m) {
          FilterSsimRow(row[m], half_.data(), width_, moments_.column(4 * c + m) + y * pitch_);
        }
      }
    });
  };
  const auto across = [&](int chunk) {
    MarginRows row(8, pitch_);
    const float* lines[kSsimTaps];
    rows_of(chunk, [&](int y) {
      for (int c = 0; c < 3; ++c) {
        for (int m = 0; m < 4; ++m) {
          LinesAround(moments_.column(4 * c + m), y, height_, pitch_, zeros.data(), lines);
          FilterSsimColumn(lines, half_.data(), width_, row[m]);
        }
        const float* const moments[4] = {row[0], row[1], row[2], row[3]};
        float* const by[3] = {row[5], row[6], row[7]};
        SsimOfMoments(moments, width_, row[4], by);
        for (int x = 0; x < width_; ++x) row[4][x] = 1 - row[4][x];
        row_sum[2 * y] += SumOfRow(row[4], width_);
        for (int k = 0; k < 3; ++k) {
          // Padding has no SSIM, so its derivatives are zero.
          for (size_t x = width_; x < pitch_; ++x) by[k][x] = 0;
          FilterSsimRow(by[k], half_.data(), width_, by_moments_.column(3 * c + k) + y * pitch_);
        }
      }
    });
  };
  const double scale = 1 / (3 * kPersonPixels * truth.person_pixels);
  const auto gather = [&](int chunk) {
    MarginRows row(5, pitch_);
    const float* lines[kSsimTaps];
    const auto absolute = static_cast<float>(scale * kAbsoluteShare), ssim = static_cast<float>(scale * kSsimShare);
    rows_of(chunk, [&](int y) {
      const size_t first = size_t(y) * width_;
      float* by_alpha = by_planes->column(kAlphaPlane) + first;
      std::fill_n(by_alpha, width_, 0.0F);
      double sum = 0;
      for (int c = 0; c < 3; ++c) {
        float *a = row[0], *b = row[1], *by_colour = by_planes->column(c) + first;
        PutOver(image, c, first, width_, background[c], a);
        PutOver(truth.planes, c, first, width_, background[c], b);
        for (int k = 0; k < 3; ++k) {
          LinesAround(by_moments_.column(3 * c + k), y, height_, pitch_, zeros.data(), lines);
          FilterSsimColumn(lines, half_.data(), width_, row[2 + k]);
        }
        const float *by_a = row[2], *by_squares = row[3], *by_product = row[4];
        for (int x = 0; x < width_; ++x) {
          const float sign = static_cast<float>(a[x] > b[x]) - static_cast<float>(a[x] < b[x]);
          const float by = absolute * sign - ssim * (by_a[x] + 2 * a[x] * by_squares[x] + b[x] * by_product[x]);
          by_colour[x] = by;
          by_alpha[x] -= by * background[c];
        }
        for (int x = 0; x < width_; ++x) a[x] = std::abs(a[x] - b[x]);
        sum += SumOfRow(a, width_);
      }
      row_sum[2 * y + 1] = sum;
    });
  };
  const auto count = [chunks] { return chunks; };
  RunPhases(num_threads, {{count, along}, {count, across}, {count, gather}});
  double loss = 0;
  for (int y = 0; y < height_; ++y) loss += kSsimShare * row_sum[2 * y] + kAbsoluteShare * row_sum[2 * y + 1];
  return scale * loss;
}

}  // namespace bodyloom
