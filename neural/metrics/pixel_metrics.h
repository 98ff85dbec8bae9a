// SPDX-License-Identifier: Apache-2.0
/// Intersection over union of two labellings of the same pixels, by class and of the foreground.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <vector>

#include "geometry/base/check.h"
#include "render/image/image.h"

namespace bodyloom {

/// Counts pixels; class 0 is the background. Ratios are NaN for classes that do not occur.
class ClassOverlap {
 public:
  explicit ClassOverlap(int num_classes) : both_(num_classes), predicted_(num_classes), true_(num_classes) {}

  /// Adds a pixel with its predicted and true class, both below the number of classes.
  void Add(size_t predicted, size_t truth) {
    both_[predicted] += predicted == truth ? 1 : 0;
    ++predicted_[predicted];
    ++true_[truth];
    foreground_both_ += predicted != 0 && truth != 0 ? 1 : 0;
    foreground_either_ += predicted != 0 || truth != 0 ? 1 : 0;
  }
  /// Adds pixels; throws std::invalid_argument unless there are as many predicted as true labels.
  void Add(const std::vector<uint8_t>& predicted, const std::vector<uint8_t>& truth) {
    BODYLOOM_CHECK(predicted.size() == truth.size(), "class overlap: ", predicted.size(), " pixels beside ",
                   truth.size());
    for (size_t i = 0; i < predicted.size(); ++i) Add(size_t{predicted[i]}, size_t{truth[i]});
  }

  [[nodiscard]] int num_classes() const { return static_cast<int>(both_.size()); }
  [[nodiscard]] double Iou(int k) const { return Ratio(both_[k], Either(k)); }
  [[nodiscard]] double ForegroundIou() const { return Ratio(foreground_both_, foreground_either_); }
  /// Mean over the classes other than the background that occur in the truth (`in_truth`), or in either labelling.
  [[nodiscard]] double MeanIou(bool in_truth) const {
    double sum = 0;
    int64_t classes = 0;
    for (int k = 1; k < num_classes(); ++k) {
      if ((in_truth ? true_[k] : Either(k)) == 0) continue;
      sum += Iou(k);
      ++classes;
    }
    return classes > 0 ? sum / static_cast<double>(classes) : std::numeric_limits<double>::quiet_NaN();
  }

 private:
  [[nodiscard]] int64_t Either(int k) const { return predicted_[k] + true_[k] - both_[k]; }
  static double Ratio(int64_t part, int64_t whole) {
    return whole > 0 ? static_cast<double>(part) / static_cast<double>(whole)
                     : std::numeric_limits<double>::quiet_NaN();
  }

  std::vector<int64_t> both_, predicted_, true_;
  int64_t foreground_both_ = 0, foreground_either_ = 0;
};

/// SSIM of two images of the same size, provided by the caller (neural/ does not depend on the evaluation library).
/// Empty: not measured.
using ImageSimilarity = std::function<double(const Image& truth, const Image& result)>;

}  // namespace bodyloom
