// SPDX-License-Identifier: Apache-2.0
#include "pipelines/detect/cut_masks.h"

#include <algorithm>
#include <cstdint>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <utility>
#include <vector>

#include "data_tools/observations/people.h"
#include "geometry/base/parallel.h"
#include "tracking/detection/background_cut.h"
#include "tracking/detection/still_background.h"

namespace bodyloom {
namespace {

constexpr int kFewestFrames = 12, kMaxSamples = 32;
constexpr int64_t kSampleBytes = 256 << 20;
constexpr double kMaxLeft = 0.2;
constexpr double kAround = 0.04;  ///< of the longer side of a mask's rectangle: what it may have left out

/// Adds what lies within a square of `margin` pixels around a pixel of the mask.
void Cover(std::vector<uint8_t>* mask, int width, int height, int margin, std::vector<uint8_t>* covered) {
  const cv::Mat around = cv::getStructuringElement(cv::MORPH_RECT, {2 * margin + 1, 2 * margin + 1});
  cv::Mat wide, all(height, width, CV_8UC1, covered->data());
  cv::dilate(cv::Mat(height, width, CV_8UC1, mask->data()), wide, around);
  all |= wide;
}

class MaskCutter {
 public:
  MaskCutter(const DetectPeopleRequest& request, int threads, DetectedClip* clip, const PipelineCallbacks& callbacks)
      : request_(request),
        threads_(ThreadsFor(threads)),
        width_(clip->people.image_width),
        height_(clip->people.image_height),
        num_frames_(static_cast<int>(clip->masks.size())),
        clip_(clip),
        callbacks_(callbacks) {}

  bool Run() {
    if (num_frames_ < kFewestFrames) return false;
    LearnBackground();
    if (!background_) return false;
    cut_ = clip_->masks;
    CutAll();
    // Now this way, now that: worse than coarse ones throughout.
    if (double(std::count(left_.begin(), left_.end(), 1)) > kMaxLeft * num_frames_) return false;
    clip_->masks = std::move(cut_);
    return true;
  }

 private:
  /// One pass that collects sample images and each linked person's colours, and estimates the background behind the
  /// people.
  void LearnBackground() {
    const int64_t bytes = int64_t{4} * width_ * height_;
    const int maximum =
        static_cast<int>(std::clamp<int64_t>(kSampleBytes / std::max<int64_t>(1, bytes), 9, kMaxSamples));
    const int samples = std::min(maximum, num_frames_);
    std::vector<CoveredImage> images;
    FrameSource source(request_.video, request_.span);
    Image frame;
    double time = 0;
    for (int t = 0; t < num_frames_ && source.Read(&frame, &time); ++t) {
      callbacks_.Update("background", t / double(num_frames_));
      const std::vector<PackedLabels>& masks = clip_->masks[t];
      const bool is_due = int64_t{t} * samples / num_frames_ >= int64_t(images.size());
      // Of a frame that was not detected nobody knows where people are.
      if (!is_due || std::any_of(masks.begin(), masks.end(), [](const auto& mask) { return mask.empty(); })) continue;
      CoveredImage& seen = images.emplace_back();
      seen.image = std::exchange(frame, {});
      seen.covered.assign(size_t(width_) * height_, 0);
      for (const PackedLabels& packed : masks) {
        const LabelImage mask = packed.Unpacked();
        std::vector<uint8_t> whole = mask.Over(width_, height_);
        AddClearInside(seen.image, whole, &person_);
        const int margin = 1 + static_cast<int>(kAround * std::max(mask.width, mask.height));
        Cover(&whole, width_, height_, margin, &seen.covered);
      }
    }
    background_ = FindStillBackground(images, {.num_threads = threads_});
  }

  void CutAll() {
    FrameSource source(request_.video, request_.span);
    std::vector<Image> batch;
    double time = 0;
    for (int first = 0; first < num_frames_; first += int(batch.size())) {
      callbacks_.Update("masks", first / double(num_frames_));
      batch.clear();
      Image frame;
      while (int(batch.size()) < threads_ && first + int(batch.size()) < num_frames_ && source.Read(&frame, &time)) {
        batch.push_back(std::exchange(frame, {}));
      }
      if (batch.empty()) return;
      ParallelFor(int(batch.size()), threads_,
                  [&](int i) { left_[first + i] = CutFrame(batch[i], &cut_[first + i]) ? 0 : 1; });
    }
  }

  /// False when somebody's mask is as it was.
  bool CutFrame(const Image& image, std::vector<PackedLabels>* masks) const {
    bool all = true;
    std::vector<std::vector<uint8_t>> coarse;
    std::vector<uint8_t> everybody(size_t(width_) * height_, 0);
    for (const PackedLabels& mask : *masks) {
      coarse.push_back(mask.Unpacked().Over(width_, height_));
      for (size_t p = 0; p < everybody.size(); ++p) everybody[p] |= coarse.back()[p];
    }
    for (size_t i = 0; i < masks->size(); ++i) {
      const auto cut = CutFromBackground(image, coarse[i], everybody, *background_, person_);
      all = all && cut.has_value();
      if (cut) (*masks)[i] = *cut;
    }
    return all;
  }

  const DetectPeopleRequest& request_;
  int threads_, width_, height_, num_frames_;
  DetectedClip* clip_;
  const PipelineCallbacks& callbacks_;
  std::optional<StillBackground> background_;
  std::vector<char> left_ = std::vector<char>(size_t(num_frames_), 0);  ///< frames that were not cut
  std::vector<std::vector<PackedLabels>> cut_;
  ColourDensity person_;  ///< of everybody: who is who the coarse masks say
};

}  // namespace

bool CutMasks(const DetectPeopleRequest& request, int threads, DetectedClip* clip, const PipelineCallbacks& callbacks) {
  return MaskCutter(request, threads, clip, callbacks).Run();
}

const char* MasksText(bool cut) { return cut ? "cut from what stands behind" : "as the network gives them"; }

}  // namespace bodyloom
