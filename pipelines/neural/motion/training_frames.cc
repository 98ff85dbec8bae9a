// SPDX-License-Identifier: Apache-2.0
#include "pipelines/neural/motion/training_frames.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "neural/motion/motion_frame.h"
#include "pipelines/clip_span.h"
#include "render/view/contact_sheet.h"

namespace bodyloom {
namespace {

constexpr int kShareStretch = 32;  ///< frames: with less of the data, whole stretches of so many are kept
constexpr int kReachFrames = 64;   ///< that ReachOf looks at, at most

void RequireAllInClip(const std::vector<FrameRange>& ranges, const char* option, int num_frames) {
  for (const FrameRange& range : ranges) RequireInClip({range.begin, range.end - 1}, option, num_frames);
}

std::vector<FrameRange> CutAtGaps(const std::vector<FrameRange>& ranges, const PersonFrames& frames) {
  std::vector<FrameRange> cut;
  for (const FrameRange& range : ranges) {
    int begin = range.begin;
    for (int t = range.begin; t < range.end; ++t) {
      if (t + 1 < range.end && frames.Segment(t + 1) == frames.Segment(t)) continue;
      if (frames.Segment(t) >= 0) cut.push_back({begin, t + 1});
      begin = t + 1;
    }
  }
  return cut;
}

/// Of every so many stretches the first.
std::vector<FrameRange> TakeShare(const std::vector<FrameRange>& ranges, double share) {
  if (share >= 1) return ranges;
  std::vector<FrameRange> stretches;
  for (const FrameRange& range : ranges) {
    for (int begin = range.begin; begin < range.end; begin += kShareStretch) {
      stretches.push_back({begin, std::min(range.end, begin + kShareStretch)});
    }
  }
  const double count = std::max(1.0, share * static_cast<double>(stretches.size()));
  const auto num_kept = static_cast<int>(std::lround(count));
  std::vector<FrameRange> kept;
  kept.reserve(static_cast<size_t>(num_kept));
  for (int i = 0; i < num_kept; ++i) {
    kept.push_back(stretches[static_cast<size_t>(i * static_cast<double>(stretches.size()) / count)]);
  }
  return kept;
}

}  // namespace

TrainingFrames ChooseFrames(const TrainingFramesRequest& request, const PersonFrames& frames,
                            const PersonFrames* validation) {
  const int T = frames.num_frames(), validation_frames = validation != nullptr ? validation->num_frames() : 0;
  RequireAllInClip(request.train, "--train", T);
  RequireAllInClip(request.validate, "--validate", validation_frames > 0 ? validation_frames : T);
  TrainingFrames chosen = {request.train, request.validate};
  if (validation_frames > 0 && chosen.validation.empty()) chosen.validation = {{0, validation_frames}};
  if (chosen.train.empty()) {
    // The end of the clip is kept for validation.
    const int last = chosen.validation.empty() ? T - std::max(1, T / 5) : T;
    chosen.train = {{0, last}};
    if (chosen.validation.empty() && last < T) chosen.validation = {{last, T}};
  }
  chosen.train = TakeShare(CutAtGaps(chosen.train, frames), request.share);
  chosen.validation = CutAtGaps(chosen.validation, validation != nullptr ? *validation : frames);
  return chosen;
}

int ReachOf(MotionData* data, const std::vector<FrameRange>& ranges) {
  if (!data->has_labels()) return 0;
  std::vector<int> all;
  for (const FrameRange& range : ranges) {
    for (int t = range.begin; t < range.end; ++t) all.push_back(t);
  }
  std::vector<MotionFrame> frames;
  for (const int i : EvenlySpreadFrames(static_cast<int>(all.size()), kReachFrames)) {
    MotionFrame frame;
    data->Fill(all[i], true, &frame);
    frame.motion = frame.dense = frame.uv = frame.image = frame.normals = {};
    frames.push_back(std::move(frame));
  }
  return ClothesReach(frames);
}

}  // namespace bodyloom
