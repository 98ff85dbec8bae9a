// SPDX-License-Identifier: Apache-2.0
#include "tracking/detection/line_segments.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <opencv2/imgproc.hpp>

#include "geometry/base/check.h"
#include "geometry/base/parallel.h"

namespace bodyloom {
namespace {

constexpr int kLargestSide = 1280;  ///< pixels of a sample
constexpr double kMinSeenShare = 0.2, kMaxMaskedShare = 0.1;
constexpr double kNearBorder = 0.008;  ///< of the longer side
constexpr double kWholeSide = 0.95;    ///< of a side
constexpr double kStraightPx = 1.5;    ///< that an edge of a bar is off its row or column
constexpr uint8_t kRestlessLevels = 8;
constexpr int kRestlessStride = 4;  ///< every 16th pixel says how much moves

using History = std::array<uint8_t, 2 * FrameSamples::kFewestSamples>;

uint8_t MedianOf(History* values, int count) {
  const auto middle = values->begin() + count / 2;
  std::nth_element(values->begin(), middle, values->begin() + count);
  return *middle;
}

uint8_t DeviationOf(History* values, int count, uint8_t median) {
  for (int i = 0; i < count; ++i) (*values)[i] = static_cast<uint8_t>(std::abs((*values)[i] - median));
  return MedianOf(values, count);
}

/// The values of a pixel: where nobody is, or of all frames if somebody nearly always is.
class PixelInSamples {
 public:
  PixelInSamples(const std::vector<GreySample>& samples, std::span<const CoveredPixels> covered)
      : samples_(samples), covered_(covered) {}
  /// Returns true if the pixel is seen often enough.
  bool Gather(size_t pixel) {
    count_ = 0;
    for (size_t i = 0; i < samples_.size(); ++i) {
      const bool hidden = !covered_.empty() && !covered_[i].empty() && covered_[i][pixel] != 0;
      if (!hidden) values_[count_++] = samples_[i].grey[pixel];
    }
    const bool seen = count_ > 0 && count_ >= kMinSeenShare * static_cast<double>(samples_.size());
    if (seen) return true;
    count_ = 0;
    for (const GreySample& sample : samples_) values_[count_++] = sample.grey[pixel];
    return false;
  }
  [[nodiscard]] History* values() { return &values_; }
  [[nodiscard]] int count() const { return count_; }

 private:
  const std::vector<GreySample>& samples_;
  std::span<const CoveredPixels> covered_;
  History values_{};
  int count_ = 0;
};

void CheckCovered(const FrameSamples& samples, std::span<const CoveredPixels> covered) {
  const size_t pixels = samples.small().num_pixels();
  BODYLOOM_CHECK(covered.empty() || covered.size() == samples.samples().size(), "line segments: people of ",
                 covered.size(), " frames, expected ", samples.samples().size());
  for (const CoveredPixels& people : covered) {
    BODYLOOM_CHECK(people.empty() || people.size() == pixels, "line segments: people in ", people.size(),
                   " pixels, expected ", pixels);
  }
}

StillPicture MedianOfSamples(const std::vector<GreySample>& samples, std::span<const CoveredPixels> covered,
                             const SmallPicture& size, int num_threads) {
  StillPicture picture;
  picture.width = size.width;
  picture.height = size.height;
  picture.scale = size.scale;
  if (size.num_pixels() == 0) return picture;
  picture.grey.resize(size.num_pixels());
  picture.people.assign(size.num_pixels(), 0);
  std::vector<int> restless(picture.height, 0), looked_at(picture.height, 0);
  ParallelFor(picture.height, num_threads, [&](int y) {
    PixelInSamples pixel(samples, covered);
    for (int x = 0; x < picture.width; ++x) {
      const size_t i = size_t(y) * picture.width + x;
      picture.people[i] = pixel.Gather(i) ? 0 : 1;
      picture.grey[i] = MedianOf(pixel.values(), pixel.count());
      if (picture.people[i] != 0 || x % kRestlessStride != 0 || y % kRestlessStride != 0) continue;
      ++looked_at[y];
      restless[y] += DeviationOf(pixel.values(), pixel.count(), picture.grey[i]) > kRestlessLevels ? 1 : 0;
    }
  });
  double moving = 0, all = 0;
  for (int y = 0; y < picture.height; ++y) moving += restless[y], all += looked_at[y];
  picture.restless_share = all > 0 ? moving / all : 0;
  return picture;
}

bool MostlyMasked(const StillPicture& picture, const LineSegment& segment) {
  const int steps = 1 + static_cast<int>(segment.length());
  int masked = 0;
  for (int i = 0; i <= steps; ++i) {
    const Eigen::Vector2d at = segment.a + (segment.b - segment.a) * i / steps;
    const int x = std::clamp(static_cast<int>(std::lround(at.x())), 0, picture.width - 1);
    const int y = std::clamp(static_cast<int>(std::lround(at.y())), 0, picture.height - 1);
    masked += picture.people[size_t(y) * picture.width + x] != 0 ? 1 : 0;
  }
  return masked > kMaxMaskedShare * (steps + 1);
}

/// Edges of the picture, and of black bars beside it: both ends near one border, or straight from border to border.
bool IsFrameOfPicture(const StillPicture& picture, const LineSegment& segment) {
  const Eigen::Array2d size(picture.width - 1, picture.height - 1);
  const Eigen::Array2d a = segment.a.array(), b = segment.b.array(),
                       near = Eigen::Array2d::Constant(kNearBorder * size.maxCoeff());
  const bool along = ((a < near && b < near) || (a > size - near && b > size - near)).any();
  const Eigen::Array2d run = (b - a).abs();
  const bool across = (run.x() < kStraightPx && run.y() > kWholeSide * size.y()) ||
                      (run.y() < kStraightPx && run.x() > kWholeSide * size.x());
  return along || across;
}

}  // namespace

bool FrameSamples::Add(const Image& frame) {
  if (samples_.empty()) {
    BODYLOOM_CHECK(!frame.empty(), "line segments: a frame without pixels");
    image_width_ = frame.width;
    image_height_ = frame.height;
    small_ = SmallPicture::Of(frame.width, frame.height, kLargestSide);
  }
  BODYLOOM_CHECK(frame.width == image_width_ && frame.height == image_height_, "line segments: a frame of ",
                 frame.width, "x", frame.height, ", expected ", image_width_, "x", image_height_);
  const int index = next_++;
  if (index % step_ != 0) return false;
  if (samples_.size() == 2 * kFewestSamples) {
    for (size_t i = 1; i < kFewestSamples; ++i) samples_[i] = std::move(samples_[2 * i]);
    samples_.resize(kFewestSamples);
    step_ *= 2;
  }
  samples_.push_back({index, ShrunkGrey(frame, small_)});
  return true;
}

StillPicture MedianPicture(const FrameSamples& samples, std::span<const CoveredPixels> covered, int num_threads) {
  CheckCovered(samples, covered);
  return MedianOfSamples(samples.samples(), covered, samples.small(), num_threads);
}

StillPicture MedianPicture(const FrameSamples& samples, std::span<const CoveredPixels> covered,
                           std::span<const Eigen::Matrix3d> moved_from_sample, int num_threads) {
  CheckCovered(samples, covered);
  const size_t count = samples.samples().size();
  BODYLOOM_CHECK(moved_from_sample.size() == count, "line segments: ", moved_from_sample.size(),
                 " homographies, expected ", count);
  const SmallPicture& size = samples.small();
  Eigen::Matrix3d frame_from_small = size.scale * Eigen::Matrix3d::Identity();
  frame_from_small.col(2) << 0.5 * size.scale - 0.5, 0.5 * size.scale - 0.5, 1;
  std::vector<GreySample> moved(count);
  std::vector<CoveredPixels> hidden(count, CoveredPixels(size.num_pixels()));
  ParallelFor(static_cast<int>(count), num_threads, [&](int i) {
    const Eigen::Matrix3d H = frame_from_small.inverse() * moved_from_sample[i] * frame_from_small;
    cv::Mat homography(3, 3, CV_64F);
    for (int k = 0; k < 9; ++k) homography.at<double>(k / 3, k % 3) = H(k / 3, k % 3);
    const GreySample& sample = samples.samples()[i];
    moved[i].frame = sample.frame;
    moved[i].grey.resize(size.num_pixels());
    const auto warp = [&](const std::vector<uint8_t>& from, int interpolation, int beyond, std::vector<uint8_t>* to) {
      const cv::Mat source(size.height, size.width, CV_8UC1, const_cast<uint8_t*>(from.data()));
      cv::Mat target(size.height, size.width, CV_8UC1, to->data());
      cv::warpPerspective(source, target, homography, target.size(), interpolation, cv::BORDER_CONSTANT,
                          cv::Scalar(beyond));
    };
    warp(sample.grey, cv::INTER_LINEAR, 0, &moved[i].grey);
    const bool nobody = covered.empty() || covered[i].empty();
    warp(nobody ? CoveredPixels(size.num_pixels(), 0) : covered[i], cv::INTER_NEAREST, 1, &hidden[i]);
  });
  return MedianOfSamples(moved, hidden, size, num_threads);
}

std::vector<LineSegment> FindLineSegments(const StillPicture& picture, double min_share) {
  std::vector<LineSegment> segments;
  if (picture.grey.empty()) return segments;
  const cv::Mat grey(picture.height, picture.width, CV_8UC1, const_cast<uint8_t*>(picture.grey.data()));
  std::vector<cv::Vec4f> found;
  cv::createLineSegmentDetector(cv::LSD_REFINE_STD)->detect(grey, found);
  const double shortest = min_share * std::max(picture.width, picture.height);
  for (const cv::Vec4f& ends : found) {
    LineSegment segment{{ends[0], ends[1]}, {ends[2], ends[3]}};
    if (!(segment.length() >= shortest) || MostlyMasked(picture, segment) || IsFrameOfPicture(picture, segment)) {
      continue;
    }
    for (Eigen::Vector2d* end : {&segment.a, &segment.b}) {
      *end = picture.scale * (*end + Eigen::Vector2d(0.5, 0.5)) - Eigen::Vector2d(0.5, 0.5);
    }
    segments.push_back(segment);
  }
  return segments;
}

}  // namespace bodyloom
