// SPDX-License-Identifier: Apache-2.0
#include "tracking/detection/background_tracker.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>
#include <utility>
#include <vector>

#include "geometry/base/check.h"
#include "geometry/base/percentile.h"
#include "tracking/detection/small_picture.h"

namespace bodyloom {
namespace {

constexpr int kTrackedSide = 640, kCornerCell = 32, kPictureBorder = 8, kMinDistance = 10;
constexpr size_t kEnoughCorners = 80;
constexpr double kMinEigenvalue = 1e-4;  ///< of cv::cornerMinEigenVal: corners of some eight grey levels
constexpr int kFlowWindow = 15, kFlowLevels = 3;
constexpr double kThereAndBackPx = 0.4;
constexpr int kFewestTracked = 12;
constexpr double kKeptShare = 0.6, kLeastShare = 0.3;
constexpr double kLostS = 0.7, kSteadyS = 0.11, kSeekS = 0.1;
constexpr double kFoundAgainShare = 0.5;
constexpr double kRestPx = 0.3, kRestS = 1, kPassOverS = 0.2;
constexpr size_t kMostKept = 24;  ///< anchors' pictures for loops
constexpr int kMostPassedOver = 12;

}  // namespace

class BackgroundTracker::Impl {
 public:
  struct SmallFrame {
    int frame = 0;
    double time_s = 0;
    std::vector<uint8_t> grey;
    std::vector<CoveredRegion> regions;
    CoveredPixels covered;  ///< of the regions, once it is looked at
  };

  using Pyramid = std::vector<cv::Mat>;

  /// Places of an anchor's points in a frame.
  struct Seen {
    std::vector<cv::Point2f> at;  ///< small pixels; also of those not seen now: where they are expected
    std::vector<char> is_seen;
    int count = 0;
  };

  void Push(const Image& frame, double time_s, std::span<const CoveredRegion> covered) {
    if (tracks_.timestamps.empty()) {
      BODYLOOM_CHECK(!frame.empty(), "background points: a frame without pixels");
      tracks_.width = frame.width;
      tracks_.height = frame.height;
      size_ = SmallPicture::ByWholeScale(frame.width, frame.height, kTrackedSide);
    }
    BODYLOOM_CHECK(frame.width == tracks_.width && frame.height == tracks_.height, "background points: a frame of ",
                   frame.width, "x", frame.height, ", expected ", tracks_.width, "x", tracks_.height);
    BODYLOOM_CHECK(tracks_.timestamps.empty() || time_s > tracks_.timestamps.back(), "background points: a frame at ",
                   time_s, " s after one at ", tracks_.timestamps.empty() ? 0 : tracks_.timestamps.back(), " s");
    SmallFrame small;
    small.frame = static_cast<int>(tracks_.timestamps.size());
    small.time_s = time_s;
    tracks_.timestamps.push_back(time_s);
    small.grey = ShrunkGrey(frame, size_);
    small.regions.assign(covered.begin(), covered.end());
    if (tracks_.anchors.empty()) {
      Cover(&small);
      BeginAnchor(small, PyramidOf(small), true, {});
      return;
    }
    waiting_.push_back(std::move(small));
    const bool passes_over =
        rests_ && waiting_.back().time_s - looked_s_ < kPassOverS - 1e-6 && waiting_.size() < size_t(kMostPassedOver);
    if (!passes_over) LookAtWaiting();
  }

  BackgroundTracks Finish() {
    if (!waiting_.empty()) LookAtWaiting();
    return std::move(tracks_);
  }

 private:
  [[nodiscard]] cv::Mat Picture(const SmallFrame& frame) const {
    return {size_.height, size_.width, CV_8UC1, const_cast<uint8_t*>(frame.grey.data())};
  }
  [[nodiscard]] Pyramid PyramidOf(const SmallFrame& frame) const {
    Pyramid pyramid;
    cv::buildOpticalFlowPyramid(Picture(frame), pyramid, {kFlowWindow, kFlowWindow}, kFlowLevels);
    return pyramid;
  }
  [[nodiscard]] bool IsCovered(const SmallFrame& frame, const cv::Point2f& at) const {
    const int x = static_cast<int>(std::lround(at.x)), y = static_cast<int>(std::lround(at.y));
    if (x < 0 || y < 0 || x >= size_.width || y >= size_.height) return true;
    return !frame.covered.empty() && frame.covered[size_t(y) * size_.width + x] != 0;
  }
  [[nodiscard]] Eigen::Vector2f InFrame(const cv::Point2f& small) const {
    return size_.ToFrame(Eigen::Vector2d(small.x, small.y)).cast<float>();
  }

  /// Places of points with their names.
  struct NamedPoints {
    std::vector<cv::Point2f> at;
    std::vector<int> names;
  };

  /// The points that live on, and corners elsewhere, which are named from `next_name_` on.
  [[nodiscard]] NamedPoints CornersOf(const SmallFrame& frame, const NamedPoints& living) {
    cv::Mat strength;
    cv::cornerMinEigenVal(Picture(frame), strength, 3);
    NamedPoints corners{BestOfCells(frame, strength, kCornerCell, living.at), living.names};
    if (corners.at.size() < kEnoughCorners) corners.at = BestOfCells(frame, strength, kCornerCell / 2, living.at);
    while (corners.names.size() < corners.at.size()) corners.names.push_back(next_name_++);
    return corners;
  }

  /// `living`, and the best corner of every cell without any of them.
  [[nodiscard]] std::vector<cv::Point2f> BestOfCells(const SmallFrame& frame, const cv::Mat& strength, int cell,
                                                     const std::vector<cv::Point2f>& living) const {
    std::vector<cv::Point2f> corners = living;
    const int columns = (size_.width + cell - 1) / cell;
    std::vector<char> is_taken(size_t(columns) * ((size_.height + cell - 1) / cell), 0);
    for (const cv::Point2f& at : living) is_taken[size_t(int(at.y) / cell) * columns + int(at.x) / cell] = 1;
    for (int top = 0; top < size_.height; top += cell) {
      for (int left = 0; left < size_.width; left += cell) {
        if (is_taken[size_t(top / cell) * columns + left / cell] != 0) continue;
        float best = kMinEigenvalue;
        cv::Point2f at(-1, -1);
        for (int y = std::max(top, kPictureBorder); y < std::min(top + cell, size_.height - kPictureBorder); ++y) {
          const float* row = strength.ptr<float>(y);
          for (int x = std::max(left, kPictureBorder); x < std::min(left + cell, size_.width - kPictureBorder); ++x) {
            if (row[x] <= best || IsCovered(frame, cv::Point2f(float(x), float(y)))) continue;
            best = row[x];
            at = cv::Point2f(float(x), float(y));
          }
        }
        const auto is_near = [&at](const cv::Point2f& other) { return cv::norm(other - at) < kMinDistance; };
        if (at.x >= 0 && std::none_of(corners.begin(), corners.end(), is_near)) corners.push_back(at);
      }
    }
    return corners;
  }

  /// `target`: the frame's pyramid.
  void BeginAnchor(const SmallFrame& frame, const Pyramid& target, bool after_break, const NamedPoints& living) {
    BackgroundTracks::Anchor& anchor = tracks_.anchors.emplace_back();
    anchor.frame = frame.frame;
    anchor.after_break = after_break;
    NamedPoints corners = CornersOf(frame, living);
    corners_ = std::move(corners.at);
    anchor.points = std::move(corners.names);
    for (const cv::Point2f& corner : corners_) anchor.pixels.push_back(InFrame(corner));
    pyramid_ = target;
    seen_ = {corners_, std::vector<char>(corners_.size(), 1), static_cast<int>(corners_.size())};
    at_first_ = seen_.count;
    seen_s_ = looked_s_ = frame.time_s;
    rest_ = seen_;
  }

  /// Seeks points of one picture in another, and back. `from` has the places expected.
  [[nodiscard]] Seen Seek(const Pyramid& source, const std::vector<cv::Point2f>& points, const Pyramid& target,
                          const SmallFrame& frame, const Seen& from) const {
    Seen found{from.at, std::vector<char>(points.size(), 0), 0};
    if (points.empty()) return found;
    const cv::TermCriteria stop(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 20, 0.01);
    std::vector<uchar> there, back;
    std::vector<float> error;
    std::vector<cv::Point2f> returned = points;
    cv::calcOpticalFlowPyrLK(source, target, points, found.at, there, error, {kFlowWindow, kFlowWindow}, kFlowLevels,
                             stop, cv::OPTFLOW_USE_INITIAL_FLOW);
    cv::calcOpticalFlowPyrLK(target, source, found.at, returned, back, error, {kFlowWindow, kFlowWindow}, kFlowLevels,
                             stop, cv::OPTFLOW_USE_INITIAL_FLOW);
    for (size_t i = 0; i < points.size(); ++i) {
      const bool good = there[i] != 0 && back[i] != 0 && cv::norm(returned[i] - points[i]) < kThereAndBackPx &&
                        !IsCovered(frame, found.at[i]);
      found.is_seen[i] = good ? 1 : 0;
      found.count += good ? 1 : 0;
    }
    Seen expected = from;
    expected.is_seen.assign(points.size(), 1);
    const cv::Point2f moved = MedianWay(expected, found);
    for (size_t i = 0; i < points.size(); ++i) {
      if (found.is_seen[i] == 0) found.at[i] = from.at[i] + moved;
    }
    return found;
  }

  /// Median distance that points went between two sights, small pixels.
  static double MedianStep(const Seen& before, const Seen& after) {
    std::vector<double> steps;
    for (size_t i = 0; i < before.at.size(); ++i) {
      if (before.is_seen[i] != 0 && after.is_seen[i] != 0) steps.push_back(cv::norm(after.at[i] - before.at[i]));
    }
    return steps.empty() ? 0 : Percentile(steps, 50);
  }

  void Cover(SmallFrame* frame) const {
    for (const CoveredRegion& region : frame->regions) {
      if (!region.mask.labels.empty()) {
        CoverMask(region.mask, size_, &frame->covered);
      } else if (region.x1 >= region.x0 && region.y1 >= region.y0) {
        CoverBox(region.x0, region.y0, region.x1, region.y1, size_, &frame->covered);
      }
    }
    frame->regions.clear();
  }

  /// Median of the ways along either axis.
  static cv::Point2f MedianWay(const Seen& before, const Seen& after) {
    std::vector<double> by_x, by_y;
    for (size_t i = 0; i < before.at.size(); ++i) {
      if (before.is_seen[i] == 0 || after.is_seen[i] == 0) continue;
      by_x.push_back(after.at[i].x - before.at[i].x);
      by_y.push_back(after.at[i].y - before.at[i].y);
    }
    if (by_x.empty()) return {0, 0};
    return {static_cast<float>(Percentile(by_x, 50)), static_cast<float>(Percentile(by_y, 50))};
  }

  void LookAtWaiting() {
    std::deque<SmallFrame> waiting = std::exchange(waiting_, {});
    Cover(&waiting.back());
    const SmallFrame& last = waiting.back();
    if (rests_ && waiting.size() > 1) {
      const Seen seen = Seek(pyramid_, corners_, PyramidOf(last), last, seen_);
      if (seen.count >= NumExpected() && MedianStep(seen_, seen) <= kRestPx) {
        Accept(last, seen);
        return;
      }
    }
    for (SmallFrame& frame : waiting) {
      Cover(&frame);
      LookAt(frame);
    }
  }

  [[nodiscard]] int NumExpected() const { return std::max(kFewestTracked, static_cast<int>(kKeptShare * at_first_)); }

  void LookAt(const SmallFrame& frame) {
    const Pyramid target = PyramidOf(frame);
    Seen expected = seen_;
    if (frame.time_s - seen_s_ < kSteadyS) {
      const auto seconds = static_cast<float>(frame.time_s - seen_s_);
      for (cv::Point2f& at : expected.at) at += seconds * velocity_;
    }
    const Seen seen = Seek(pyramid_, corners_, target, frame, expected);
    // Another picture has chance matches.
    if (seen.count >= std::max(kFewestTracked, static_cast<int>(kLeastShare * seen_.count))) {
      Accept(frame, seen);
      if (seen.count < NumExpected()) NextAnchor(frame, target);
      return;
    }
    // A blurred frame is passed over.
    const bool is_blank = at_first_ < kFewestTracked;
    const double lost_s = frame.time_s - seen_s_;
    if (!is_blank && lost_s > kSeekS && frame.time_s - sought_s_ > kSeekS) {
      sought_s_ = frame.time_s;
      if (IsFoundAgain(frame, target)) {
        AnchorOfLoops(frame, target);
        return;
      }
    }
    if (is_blank || lost_s > kLostS) AnchorOfLoops(frame, target);
    looked_s_ = frame.time_s;
  }

  void Accept(const SmallFrame& frame, const Seen& seen) {
    // Against the place where the rest began: slow motion adds up.
    if (MedianStep(rest_, seen) > kRestPx) {
      moved_s_ = frame.time_s;
      rest_ = seen;
      has_moved_ = true;
    }
    rests_ = !has_moved_ || frame.time_s - moved_s_ > kRestS;
    AddSight(frame, seen, &tracks_.anchors.back());
    const double seconds = frame.time_s - seen_s_;
    velocity_ = seconds < kSteadyS ? MedianWay(seen_, seen) / static_cast<float>(seconds) : cv::Point2f(0, 0);
    if (tracks_.anchors.back().sights.size() == 1) at_first_ = seen.count;
    seen_ = seen;
    seen_s_ = looked_s_ = frame.time_s;
  }

  void AddSight(const SmallFrame& frame, const Seen& seen, BackgroundTracks::Anchor* anchor) const {
    constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
    BackgroundTracks::Sight& sight = anchor->sights.emplace_back();
    sight.frame = frame.frame;
    for (size_t i = 0; i < seen.at.size(); ++i) {
      sight.pixels.push_back(seen.is_seen[i] != 0 ? InFrame(seen.at[i]) : Eigen::Vector2f(kNaN, kNaN));
    }
  }

  /// The frame, of which the latest anchor has a sight, becomes the next.
  void NextAnchor(const SmallFrame& frame, const Pyramid& target) {
    NamedPoints living;
    Revive(frame, tracks_.anchors.back().points, seen_, &living);
    CloseLoops(frame, target, &living);
    KeepForLoops();
    ThinKept();
    BeginAnchor(frame, target, false, living);
  }

  /// The frame becomes the next anchor; a break, unless earlier anchors' points are in it.
  void AnchorOfLoops(const SmallFrame& frame, const Pyramid& target) {
    NamedPoints living;
    KeepForLoops();
    const int found = CloseLoops(frame, target, &living);
    ThinKept();
    BeginAnchor(frame, target, found == 0, living);
  }

  /// Adds those of an anchor's points that are seen, inside the picture's border and apart from the others.
  void Revive(const SmallFrame& frame, const std::vector<int>& names, const Seen& seen, NamedPoints* living) const {
    for (size_t i = 0; i < seen.at.size(); ++i) {
      const cv::Point2f& at = seen.at[i];
      const bool inside = at.x >= kPictureBorder && at.y >= kPictureBorder &&
                          at.x < float(size_.width - kPictureBorder) && at.y < float(size_.height - kPictureBorder);
      if (seen.is_seen[i] == 0 || !inside || IsCovered(frame, at)) continue;
      bool is_apart = true;
      for (size_t k = 0; is_apart && k < living->at.size(); ++k) {
        is_apart = living->names[k] != names[i] && cv::norm(living->at[k] - at) >= kMinDistance;
      }
      if (!is_apart) continue;
      living->at.push_back(at);
      living->names.push_back(names[i]);
    }
  }

  struct Kept {
    size_t anchor;
    Pyramid pyramid;
    std::vector<cv::Point2f> corners;
  };

  /// The anchor that ends is kept.
  void KeepForLoops() {
    if (tracks_.anchors.empty() || corners_.size() < size_t(kFewestTracked)) return;
    kept_.push_back({tracks_.anchors.size() - 1, std::move(pyramid_), corners_});
  }

  /// Drops every other one but the latest when there are too many.
  void ThinKept() {
    if (kept_.size() <= kMostKept) return;
    Kept latest = std::move(kept_.back());
    kept_.pop_back();
    for (size_t i = 1; 2 * i < kept_.size(); ++i) kept_[i] = std::move(kept_[2 * i]);
    kept_.resize(kMostKept / 2);
    kept_.push_back(std::move(latest));
  }

  /// Returns true if half of the points of an anchor, the latest or one that is kept, are in the frame.
  [[nodiscard]] bool IsFoundAgain(const SmallFrame& frame, const Pyramid& target) const {
    const auto is_in = [&](const Pyramid& pyramid, const std::vector<cv::Point2f>& corners) {
      if (corners.size() < size_t(kFewestTracked)) return false;
      const Seen start{corners, std::vector<char>(corners.size(), 1), 0};
      return Seek(pyramid, corners, target, frame, start).count >= kFoundAgainShare * double(corners.size());
    };
    return is_in(pyramid_, corners_) ||
           std::any_of(kept_.begin(), kept_.end(), [&](const Kept& kept) { return is_in(kept.pyramid, kept.corners); });
  }

  /// Seeks kept anchors in the frame; returns the number found, whose points live on where no others are.
  int CloseLoops(const SmallFrame& frame, const Pyramid& target, NamedPoints* living) {
    int found = 0;
    for (auto kept = kept_.rbegin(); kept != kept_.rend(); ++kept) {
      Seen start{kept->corners, std::vector<char>(kept->corners.size(), 1), 0};
      const Seen seen = Seek(kept->pyramid, kept->corners, target, frame, start);
      if (seen.count < kFoundAgainShare * double(kept->corners.size())) continue;
      AddSight(frame, seen, &tracks_.anchors[kept->anchor]);
      Revive(frame, tracks_.anchors[kept->anchor].points, seen, living);
      ++found;
    }
    return found;
  }

  BackgroundTracks tracks_;
  SmallPicture size_;
  Pyramid pyramid_;                   ///< of the latest anchor
  std::vector<cv::Point2f> corners_;  ///< in it
  Seen seen_, rest_;                  ///< latest sight; sight since which the points rest
  int at_first_ = 0;                  ///< points seen in the first frame after the anchor
  cv::Point2f velocity_{0, 0};        ///< small pixels a second, at the latest sight
  double seen_s_ = 0, looked_s_ = 0, sought_s_ = 0, moved_s_ = 0;
  int next_name_ = 0;
  bool rests_ = true, has_moved_ = false;
  std::deque<SmallFrame> waiting_;  ///< passed over
  std::vector<Kept> kept_;
};

BackgroundTracker::BackgroundTracker() : impl_(std::make_unique<Impl>()) {}
BackgroundTracker::~BackgroundTracker() = default;
BackgroundTracker::BackgroundTracker(BackgroundTracker&&) noexcept = default;
BackgroundTracker& BackgroundTracker::operator=(BackgroundTracker&&) noexcept = default;

void BackgroundTracker::Push(const Image& frame, double time_s, std::span<const CoveredRegion> covered) {
  impl_->Push(frame, time_s, covered);
}

BackgroundTracks BackgroundTracker::Finish() { return impl_->Finish(); }

}  // namespace bodyloom
