// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/pipelines/detect/cut_masks.h"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "bodyloom/data_tools/masks/background_cut.h"
#include "bodyloom/data_tools/masks/still_background.h"
#include "bodyloom/data_tools/observations/people.h"
#include "bodyloom/geometry/base/parallel.h"

namespace bodyloom {
namespace {

constexpr int kFewestFrames = 12, kMostSamples = 32;
constexpr int64_t kSampleBytes = 256 << 20;
constexpr double kMostLeft = 0.2;
constexpr double kAround = 0.04;  ///< of a person's longer side: what a coarse mask may have left out

/// A mask over the whole picture.
std::vector<uint8_t> Spread(const PackedLabels& packed, int width, int height) {
  const LabelImage mask = packed.Unpacked();
  std::vector<uint8_t> whole(size_t(width) * height, 0);
  for (int y = std::max(0, -mask.y_begin); y < std::min(mask.height, height - mask.y_begin); ++y) {
    for (int x = std::max(0, -mask.x_begin); x < std::min(mask.width, width - mask.x_begin); ++x) {
      whole[size_t(y + mask.y_begin) * width + x + mask.x_begin] = mask.labels[size_t(y) * mask.width + x];
    }
  }
  return whole;
}

/// Adds what lies within a square of `margin` pixels around the mask, by columns and then by rows.
void Cover(const PackedLabels& packed, int width, int height, std::vector<uint8_t>* covered) {
  const LabelImage mask = packed.Unpacked();
  const int margin = 1 + static_cast<int>(kAround * std::max(mask.width, mask.height));
  const std::vector<uint8_t> whole = Spread(packed, width, height);
  std::vector<uint8_t> wide(whole.size(), 0);
  const auto widen = [margin](const uint8_t* from, int count, int stride, uint8_t* to) {
    int reach = -1;  // covered up to here
    for (int i = 0; i < count; ++i) {
      if (from[size_t(i) * stride] == 0) continue;
      for (int k = std::max(reach + 1, i - margin); k <= std::min(count - 1, i + margin); ++k)
        to[size_t(k) * stride] = 1;
      reach = std::max(reach, std::min(count - 1, i + margin));
    }
  };
  for (int x = 0; x < width; ++x) widen(whole.data() + x, height, width, wide.data() + x);
  for (int y = 0; y < height; ++y) {
    widen(wide.data() + size_t(y) * width, width, 1, covered->data() + size_t(y) * width);
  }
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
    const std::vector<std::vector<PackedLabels>> coarse = clip_->masks;
    CutAll();
    const auto left = std::count(left_.begin(), left_.end(), 1);
    // Now this way, now that: worse than coarse ones throughout.
    if (double(left) > kMostLeft * num_frames_) clip_->masks = coarse;
    return double(left) <= kMostLeft * num_frames_;
  }

 private:
  /// One pass: some pictures, the background behind all people in them, and every linked person's colours.
  void LearnBackground() {
    const int64_t bytes = int64_t{4} * width_ * height_;
    const int most = static_cast<int>(std::clamp<int64_t>(kSampleBytes / std::max<int64_t>(1, bytes), 9, kMostSamples));
    const int samples = std::min(most, num_frames_);
    std::vector<CoveredPicture> pictures;
    FrameSource source(request_.video, request_.span);
    Image frame;
    double time = 0;
    for (int t = 0; t < num_frames_ && source.Read(&frame, &time); ++t) {
      callbacks_.Update("background", t / double(num_frames_));
      const std::vector<PackedLabels>& masks = clip_->masks[t];
      const bool is_due = int64_t{t} * samples / num_frames_ >= int64_t(pictures.size());
      // Of a frame that was not detected nobody knows where people are.
      if (!is_due || std::any_of(masks.begin(), masks.end(), [](const auto& mask) { return mask.empty(); })) continue;
      CoveredPicture& seen = pictures.emplace_back();
      seen.picture = std::exchange(frame, {});
      seen.covered.assign(size_t(width_) * height_, 0);
      for (const PackedLabels& mask : masks) {
        Cover(mask, width_, height_, &seen.covered);
        AddClearInside(seen.picture, Spread(mask, width_, height_), &person_);
      }
    }
    background_ = FindStillBackground(pictures, {.num_threads = threads_});
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
                  [&](int i) { left_[first + i] = CutFrame(batch[i], &clip_->masks[first + i]) ? 0 : 1; });
    }
  }

  /// False when somebody's mask is as it was.
  bool CutFrame(const Image& picture, std::vector<PackedLabels>* masks) const {
    bool all = true;
    std::vector<std::vector<uint8_t>> coarse;
    for (const PackedLabels& mask : *masks) coarse.push_back(Spread(mask, width_, height_));
    for (size_t i = 0; i < masks->size(); ++i) {
      std::vector<uint8_t> others;
      for (size_t k = 0; k < coarse.size(); ++k) {
        if (k == i) continue;
        others.resize(coarse[k].size(), 0);
        for (size_t p = 0; p < others.size(); ++p) others[p] |= coarse[k][p];
      }
      const auto cut = CutFromBackground(picture, coarse[i], others, *background_, person_);
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
  ColourDensity person_;  ///< of everybody: who is who the coarse masks say
};

}  // namespace

bool CutMasks(const DetectPeopleRequest& request, int threads, DetectedClip* clip, const PipelineCallbacks& callbacks) {
  return MaskCutter(request, threads, clip, callbacks).Run();
}

const char* MasksText(bool cut) { return cut ? "cut from what stands behind" : "as the network gives them"; }

}  // namespace bodyloom
