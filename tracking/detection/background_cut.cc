// SPDX-License-Identifier: Apache-2.0
#include "tracking/detection/background_cut.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <opencv2/imgproc.hpp>

// after imgproc, which it needs
#include <opencv2/imgproc/detail/gcgraph.hpp>

#include "geometry/base/check.h"
#include "geometry/base/percentile.h"
#include "render/image/image_mat.h"

namespace bodyloom {
namespace {

constexpr double kPrior = 4, kSmooth = 8, kByColours = 0.5;
constexpr double kInsideReach = 0.02, kOutsideReach = 0.03, kFarthestOutside = 0.06, kRing = 0.12, kClearInside = 0.03;
constexpr double kOutliers = 0.01, kColours = 256.0 * 256 * 256;
constexpr double kDarkestShadow = 0.55, kShadowCost = 2.5;
constexpr double kMinGain = 0.7, kMaxGain = 1.4;
constexpr double kSmallPiece = 0.1;
constexpr double kUnlikeSigmas = 4, kMaxMaskError = 0.1;
constexpr int kGainStep = 7;  ///< pixels between those that a gain is asked of
constexpr size_t kFewestForGain = 100;

cv::Mat MaskMat(std::span<const uint8_t> mask, int width, int height) {
  return cv::Mat(height, width, CV_8UC1, const_cast<uint8_t*>(mask.data())) != 0;
}

/// Pixels to the nearest pixel of the other kind: positive inside the mask, negative outside.
cv::Mat SignedDistance(const cv::Mat& mask) {
  cv::Mat inside, outside;
  cv::distanceTransform(mask, inside, cv::DIST_L2, 3);
  cv::distanceTransform(~mask, outside, cv::DIST_L2, 3);
  return inside - outside;
}

double Square(double x) { return x * x; }

class MaskCut {
 public:
  MaskCut(const Image& image, const cv::Mat& coarse, const cv::Mat& others, const StillBackground& background,
          const ColourDensity& person)
      : image_(image), background_(background), person_(person) {
    const cv::Rect box = cv::boundingRect(coarse);
    extent_ = std::max(box.width, box.height);
    const int margin = static_cast<int>(std::ceil(kRing * extent_)) + 1;
    window_ = cv::Rect(box.x - margin, box.y - margin, box.width + 2 * margin, box.height + 2 * margin) &
              cv::Rect(0, 0, image.width, image.height);
    distance_ = SignedDistance(coarse(window_));
    if (!others.empty()) distance_.setTo(-2 * kRing * extent_, others(window_) & ~coarse(window_));
    FindGain(coarse);
    for (int y = 0; y < window_.height; ++y) {
      for (int x = 0; x < window_.width; ++x) {
        if (IsAround(x, y)) around_.Add(ColourAt(x, y));
      }
    }
  }

  /// True if the pixels around the person agree with the background; otherwise the camera or the light has changed.
  [[nodiscard]] bool SeesTheBackground() const {
    int known = 0, unlike = 0;
    for (int y = 0; y < window_.height; ++y) {
      for (int x = 0; x < window_.width; ++x) {
        if (!IsAround(x, y) || SigmaAt(x, y) <= 0) continue;
        ++known;
        unlike += Differences(x, y).shaded > Square(kUnlikeSigmas * SigmaAt(x, y)) ? 1 : 0;
      }
    }
    return unlike <= kMaxMaskError * known;
  }

  LabelImage Find() {
    // Pixels too far outside get no node.
    nodes_ = cv::Mat(window_.size(), CV_32SC1, cv::Scalar(-1));
    const int count = window_.area();
    cv::detail::GCGraph<double> graph(count, 4 * count);
    for (int y = 0; y < window_.height; ++y) {
      for (int x = 0; x < window_.width; ++x) {
        if (IsFar(x, y)) continue;
        const int node = nodes_.at<int>(y, x) = graph.addVtx();
        const auto [in, out] = Costs(x, y);
        // The source side is the person: the cost of being outside is the capacity of the edge from the source.
        graph.addTermWeights(node, out, in);
      }
    }
    AddEdges(&graph);
    graph.maxFlow();
    LabelImage mask{window_.x, window_.y, window_.width, window_.height, std::vector<uint8_t>(size_t(count), 0)};
    for (int y = 0; y < window_.height; ++y) {
      for (int x = 0; x < window_.width; ++x) {
        const int node = nodes_.at<int>(y, x);
        if (node >= 0 && graph.inSourceSegment(node)) mask.labels[size_t(y) * window_.width + x] = 1;
      }
    }
    LeaveOutStrays(&mask);
    return mask;
  }

 private:
  [[nodiscard]] bool IsFar(int x, int y) const { return distance_.at<float>(y, x) < -kFarthestOutside * extent_; }
  /// True for pixels in the ring around the person, which show neither the person nor somebody else.
  [[nodiscard]] bool IsAround(int x, int y) const {
    return IsFar(x, y) && distance_.at<float>(y, x) > -kRing * extent_;
  }
  [[nodiscard]] const uint8_t* ColourAt(int x, int y) const { return image_.pixel(window_.x + x, window_.y + y); }
  [[nodiscard]] float SigmaAt(int x, int y) const {
    return background_.sigma[size_t(window_.y + y) * image_.width + window_.x + x];
  }
  [[nodiscard]] std::array<double, 3> BehindAt(int x, int y) const {
    const uint8_t* b = background_.colours.pixel(window_.x + x, window_.y + y);
    return {gain_[0] * b[0], gain_[1] * b[1], gain_[2] * b[2]};
  }

  /// Estimates the gains over the whole image outside the coarse mask. Other people cover at most a minor part of it.
  void FindGain(const cv::Mat& coarse) {
    std::array<std::vector<double>, 3> ratios;
    for (int y = 0; y < image_.height; y += kGainStep) {
      for (int x = 0; x < image_.width; x += kGainStep) {
        if (coarse.at<uchar>(y, x) != 0 || background_.sigma[size_t(y) * image_.width + x] <= 0) continue;
        const uint8_t *seen = image_.pixel(x, y), *behind = background_.colours.pixel(x, y);
        for (int c = 0; c < 3; ++c) {
          if (behind[c] >= 32 && seen[c] < 250) ratios[c].push_back(double(seen[c]) / behind[c]);
        }
      }
    }
    for (int c = 0; c < 3; ++c) {
      if (ratios[c].size() < kFewestForGain) continue;
      gain_[c] = std::clamp(Percentile(ratios[c], 50), kMinGain, kMaxGain);
    }
  }

  /// Squared distances of a pixel's colour from the background's, unshaded and in the nearest shadow.
  struct FromBackground {
    double square = 0, shaded = 0;
  };
  [[nodiscard]] FromBackground Differences(int x, int y) const {
    const uint8_t* seen = ColourAt(x, y);
    const std::array<double, 3> behind = BehindAt(x, y);
    FromBackground from;
    double along = 0, length = 1e-9;
    for (int c = 0; c < 3; ++c) {
      from.square += Square(seen[c] - behind[c]);
      along += seen[c] * behind[c], length += behind[c] * behind[c];
    }
    const double shade = std::clamp(along / length, kDarkestShadow, 1.0);
    for (int c = 0; c < 3; ++c) from.shaded += Square(seen[c] - shade * behind[c]);
    return from;
  }

  /// −log of the likelihood of this colour under the background.
  [[nodiscard]] double BackgroundCost(int x, int y) const {
    const double sigma = SigmaAt(x, y);
    const auto [square, shaded] = Differences(x, y);
    static const double kPeak = 1 / std::pow(2 * std::numbers::pi, 1.5);
    const double peak = kPeak / (sigma * sigma * sigma);
    const auto cost = [&](double of) {
      return -std::log((1 - kOutliers) * peak * std::exp(-of / (2 * sigma * sigma)) + kOutliers / kColours);
    };
    return std::min(cost(square), cost(shaded) + kShadowCost);
  }

  /// Costs of being inside and of being outside.
  [[nodiscard]] std::array<double, 2> Costs(int x, int y) const {
    const double distance = distance_.at<float>(y, x) / extent_;
    const double prior = distance > 0 ? kPrior * std::min(1.0, distance / kInsideReach)
                                      : -kPrior * std::min(1.0, -distance / kOutsideReach);
    const uint8_t* colour = ColourAt(x, y);
    const double as_person = -std::log(person_.At(colour));
    if (SigmaAt(x, y) > 0) return {std::max(0.0, -prior) + as_person, std::max(0.0, prior) + BackgroundCost(x, y)};
    return {std::max(0.0, -prior) + kByColours * as_person,
            std::max(0.0, prior) - kByColours * std::log(around_.At(colour))};
  }

  [[nodiscard]] double StepBetween(int x, int y, int to_x, int to_y) const {
    const uint8_t *a = ColourAt(x, y), *b = ColourAt(to_x, to_y);
    double step = 0, of_difference = 0;
    const bool known = SigmaAt(x, y) > 0 && SigmaAt(to_x, to_y) > 0;
    const std::array<double, 3> behind_a = BehindAt(x, y), behind_b = BehindAt(to_x, to_y);
    for (int c = 0; c < 3; ++c) {
      step += Square(double(a[c]) - b[c]);
      of_difference += Square((a[c] - behind_a[c]) - (b[c] - behind_b[c]));
    }
    return known ? std::min(step, of_difference) : step;
  }

  void AddEdges(cv::detail::GCGraph<double>* graph) {
    struct Edge {
      int a, b;
      double square;
    };
    std::vector<Edge> edges;
    double sum = 0;
    for (int y = 0; y < window_.height; ++y) {
      for (int x = 0; x < window_.width; ++x) {
        for (const auto& [dx, dy] : {std::array<int, 2>{1, 0}, std::array<int, 2>{0, 1}}) {
          if (x + dx >= window_.width || y + dy >= window_.height) continue;
          const int a = nodes_.at<int>(y, x), b = nodes_.at<int>(y + dy, x + dx);
          if (a < 0 || b < 0) continue;
          edges.push_back({a, b, StepBetween(x, y, x + dx, y + dy)});
          sum += edges.back().square;
        }
      }
    }
    const double beta = std::max(1.0, sum / std::max<double>(1, double(edges.size())));
    for (const Edge& edge : edges) {
      const double weight = kSmooth * std::exp(-edge.square / (2 * beta));
      graph->addEdges(edge.a, edge.b, weight, weight);
    }
  }

  /// Drops pieces smaller than a tenth of the largest: too small for a limb whose joint is occluded.
  void LeaveOutStrays(LabelImage* mask) const {
    const cv::Mat found(window_.size(), CV_8UC1, mask->labels.data());
    cv::Mat pieces, stats, middles;
    const int count = cv::connectedComponentsWithStats(found, pieces, stats, middles, 4);
    int largest = 0;
    for (int k = 1; k < count; ++k) largest = std::max(largest, stats.at<int>(k, cv::CC_STAT_AREA));
    for (int y = 0; y < window_.height; ++y) {
      for (int x = 0; x < window_.width; ++x) {
        const int piece = pieces.at<int>(y, x);
        if (piece > 0 && stats.at<int>(piece, cv::CC_STAT_AREA) < kSmallPiece * largest) {
          mask->labels[size_t(y) * window_.width + x] = 0;
        }
      }
    }
  }

  const Image& image_;
  const StillBackground& background_;
  const ColourDensity& person_;
  double extent_ = 1;
  cv::Rect window_;
  cv::Mat distance_, nodes_;
  ColourDensity around_;
  std::array<double, 3> gain_ = {1, 1, 1};
};

}  // namespace

std::optional<LabelImage> CutFromBackground(const Image& image, std::span<const uint8_t> coarse,
                                            std::span<const uint8_t> others, const StillBackground& background,
                                            const ColourDensity& person) {
  const size_t area = size_t(image.width) * image.height;
  BODYLOOM_CHECK(!image.empty() && coarse.size() == area && (others.empty() || others.size() == area) &&
                     background.sigma.size() == area && background.colours.bgr.size() == image.bgr.size(),
                 "cut from the background: an image of ", image.width, "x", image.height, ", masks of ", coarse.size(),
                 " and ", others.size(), " pixels, a background of ", background.sigma.size());
  const cv::Mat mask = MaskMat(coarse, image.width, image.height);
  if (cv::countNonZero(mask) == 0) return LabelImage();
  const cv::Mat other = others.empty() ? cv::Mat() : MaskMat(others, image.width, image.height);
  MaskCut cut(image, mask, other, background, person);
  return cut.SeesTheBackground() ? std::optional(cut.Find()) : std::nullopt;
}

void AddClearInside(const Image& image, std::span<const uint8_t> coarse, ColourDensity* person) {
  BODYLOOM_CHECK(!image.empty() && coarse.size() == size_t(image.width) * image.height,
                 "colours of a mask: an image of ", image.width, "x", image.height, ", a mask of ", coarse.size(),
                 " pixels");
  const cv::Mat mask = MaskMat(coarse, image.width, image.height);
  const cv::Rect box = cv::boundingRect(mask);
  if (box.area() == 0) return;
  const double deep = kClearInside * std::max(box.width, box.height);
  const cv::Mat distance = SignedDistance(mask(box));
  for (int y = 0; y < box.height; ++y) {
    for (int x = 0; x < box.width; ++x) {
      if (distance.at<float>(y, x) > deep) person->Add(image.pixel(box.x + x, box.y + y));
    }
  }
}

}  // namespace bodyloom
