// SPDX-License-Identifier: Apache-2.0
#include "tracking/detection/people_detector.h"

#include <algorithm>
#include <optional>

#include "geometry/base/check.h"
#include "geometry/base/parallel.h"
#include "geometry/base/stopwatch.h"

namespace bodyloom {
namespace {

/// Landmarks of two regions this near, relative to the regions' sides, are one person's.
constexpr double kSamePose = 0.1;
/// A found person whose hips lie this near to a followed one's, relative to the region's side, is that person.
constexpr double kSameHips = 0.15;

bool IsSamePerson(const PoseRegion& a, const PoseRegion& b) {
  return (a.centre - b.centre).norm() < kSameHips * std::min(a.side, b.side);
}

}  // namespace

bool PeopleDetectorOptions::IsValid() const {
  return max_people >= 0 && search_interval >= 1 && tile_levels >= 1 && tile_levels <= 8 && min_presence > 0 &&
         min_presence < 1 && num_threads >= 1;
}

class PeopleDetector::Follower {
 public:
  Follower(const std::string& folder, const PeopleDetectorOptions& options) : options_(options) {
    BODYLOOM_CHECK(options.IsValid(), "people detector: an option is outside its range");
    const std::shared_ptr<const PoseModels> models = ReadPoseModels(folder, options.network);
    detectors_.reserve(size_t(options.num_threads));
    detectors_.emplace_back(models, options.masks);
    while (int(detectors_.size()) < options.num_threads) detectors_.emplace_back(detectors_.front());
  }

  std::vector<std::vector<DetectedPose>> Detect(std::span<const Image> frames, std::span<const char> with_mask) {
    BODYLOOM_CHECK(!frames.empty() && frames.size() <= kFramesAtOnce, "the people detector takes 1 to ", kFramesAtOnce,
                   " frames at once, got ", frames.size());
    BODYLOOM_CHECK(with_mask.empty() || with_mask.size() == frames.size(), "the people detector takes a word on masks ",
                   "for each of ", frames.size(), " frames, got ", with_mask.size());
    for (const Image& frame : frames) {
      if (width_ == 0) width_ = frame.width, height_ = frame.height;
      BODYLOOM_CHECK(frame.width == width_ && frame.height == height_, "all frames of a clip have one size, ", width_,
                     "x", height_, "; got ", frame.width, "x", frame.height);
    }
    if (IsTimeToSearch()) Search(frames[0]);
    std::vector<std::vector<DetectedPose>> people = LookAt(frames, with_mask);
    Follow(people);
    summary_.frames += int(frames.size());
    since_search_ += int(frames.size());
    return people;
  }

  [[nodiscard]] const PeopleDetectorSummary& summary() const { return summary_; }

 private:
  [[nodiscard]] bool IsTimeToSearch() const {
    if (regions_.empty()) return true;
    const bool may_be_more = options_.max_people == 0 || int(regions_.size()) < options_.max_people;
    return may_be_more && since_search_ >= options_.search_interval;
  }

  /// Adds the people of an image who are not followed yet. Smaller squares are searched after the whole image, and only
  /// while fewer than max_people are followed.
  void Search(const Image& image) {
    const Stopwatch watch;
    for (int level = 1; level <= options_.tile_levels && !IsFull(); ++level) {
      const std::vector<PoseRegion> squares = TileRegions(image.width, image.height, level);
      std::vector<std::vector<PoseRegion>> found(squares.size());
      InParallel(int(squares.size()),
                 [&](int i, PoseDetector& detector) { found[i] = detector.FindPeople(image, squares[i]); });
      for (const std::vector<PoseRegion>& regions : found) {
        for (const PoseRegion& region : regions) Add(region);
      }
    }
    since_search_ = 0;
    ++summary_.searches;
    summary_.search_seconds += watch.seconds();
  }

  [[nodiscard]] bool IsFull() const { return options_.max_people > 0 && int(regions_.size()) >= options_.max_people; }

  void Add(const PoseRegion& region) {
    const auto is_same = [&region](const PoseRegion& other) { return IsSamePerson(region, other); };
    if (!IsFull() && region.IsValid() && std::none_of(regions_.begin(), regions_.end(), is_same)) {
      regions_.push_back(region);
    }
  }

  /// Frame × region, side by side. poses[frame][person] for every region, present or not.
  std::vector<std::vector<DetectedPose>> LookAt(std::span<const Image> frames, std::span<const char> with_mask) {
    const Stopwatch watch;
    const int num_regions = int(regions_.size());
    std::vector<std::vector<DetectedPose>> poses(frames.size(), std::vector<DetectedPose>(regions_.size()));
    InParallel(int(frames.size()) * num_regions, [&](int i, PoseDetector& detector) {
      const int frame = i / num_regions, region = i % num_regions;
      poses[frame][region] =
          detector.PoseIn(frames[frame], regions_[region], with_mask.empty() || with_mask[frame] != 0);
    });
    summary_.regions += int(frames.size()) * num_regions;
    summary_.landmark_seconds += watch.seconds();
    return poses;
  }

  /// The regions of the next group from this one's poses; takes out of `poses` those that show nobody, or somebody
  /// twice.
  void Follow(std::vector<std::vector<DetectedPose>>& poses) {
    std::vector<PoseRegion> next;
    std::vector<DetectedPose> kept;
    std::vector<char> is_double(regions_.size(), 0);
    for (size_t person = 0; person < regions_.size(); ++person) {
      std::optional<DetectedPose> last;
      for (const std::vector<DetectedPose>& frame : poses) {
        if (IsPresent(frame[person])) last = frame[person];
      }
      if (!last) continue;
      const PoseRegion region = RegionAroundBody(last->hips, last->rim);
      if (!region.IsValid()) continue;
      const auto is_same = [&last](const DetectedPose& other) { return PoseDistance(*last, other) < kSamePose; };
      is_double[person] = std::any_of(kept.begin(), kept.end(), is_same);
      if (is_double[person]) continue;
      kept.push_back(*last);
      next.push_back(region);
    }
    for (std::vector<DetectedPose>& frame : poses) {
      std::vector<DetectedPose> present;
      for (size_t person = 0; person < frame.size(); ++person) {
        if (IsPresent(frame[person]) && !is_double[person]) present.push_back(std::move(frame[person]));
      }
      frame = std::move(present);
    }
    regions_ = std::move(next);
  }

  [[nodiscard]] bool IsPresent(const DetectedPose& pose) const {
    // NaN compares false.
    return pose.presence >= options_.min_presence && pose.hips.allFinite() && pose.rim.allFinite();
  }

  /// Calls body(i, detector) for i in 0..count−1, each detector used by one thread at a time. Networks run on one
  /// thread each: several in parallel use the processor better than one on several threads.
  template <typename Body>
  void InParallel(int count, const Body& body) {
    const int workers = std::min(count, int(detectors_.size()));
    ParallelFor(workers, workers, [&](int worker) {
      for (int i = worker; i < count; i += workers) body(i, detectors_[size_t(worker)]);
    });
  }

  PeopleDetectorOptions options_;
  std::vector<PoseDetector> detectors_;  ///< one a thread
  std::vector<PoseRegion> regions_;      ///< of the people followed, longest first
  int width_ = 0, height_ = 0, since_search_ = 0;
  PeopleDetectorSummary summary_;
};

PeopleDetector::PeopleDetector(const std::string& folder, const PeopleDetectorOptions& options)
    : follower_(std::make_unique<Follower>(folder, options)) {}
PeopleDetector::~PeopleDetector() = default;
PeopleDetector::PeopleDetector(PeopleDetector&&) noexcept = default;
PeopleDetector& PeopleDetector::operator=(PeopleDetector&&) noexcept = default;

std::vector<std::vector<DetectedPose>> PeopleDetector::Detect(std::span<const Image> frames,
                                                              std::span<const char> with_mask) {
  return follower_->Detect(frames, with_mask);
}

const PeopleDetectorSummary& PeopleDetector::summary() const { return follower_->summary(); }

}  // namespace bodyloom
