// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/pipelines/detect/frame_source.h"

#include <algorithm>
#include <cmath>

#include "bodyloom/geometry/base/check.h"
#include "bodyloom/pipelines/callbacks.h"

namespace bodyloom {
namespace {

constexpr double kUsualFps = 30;
constexpr double kSameTime = 1e-6;  ///< seconds

void CheckSpan(const FrameSpan& span) {
  if (!(span.from_s >= 0) || (span.to_s >= 0 && span.to_s < span.from_s)) {
    throw RequestError(Concatenate("the clip from second ", span.from_s, " to ", span.to_s,
                                   " holds no frame; expected 0 <= from <= to"));
  }
}

}  // namespace

FrameSource::FrameSource(const std::string& video, const FrameSpan& span)
    : reader_(video),
      has_clock_(!std::isnan(reader_.frame_time())),
      to_s_(span.to_s),
      fps_(info().fps > 0 ? info().fps
           : span.fps > 0 ? span.fps
                          : kUsualFps) {
  CheckSpan(span);
  if (span.from_s > 0) {
    has_clock_ ? reader_.SkipTo(span.from_s) : reader_.Skip(int(std::ceil(span.from_s * fps_ - kSameTime)));
  }
  first_ = reader_.next_frame();
}

int FrameSource::num_frames() const {
  if (info().num_frames <= 0) return 0;
  const double end = to_s_ < 0 ? info().num_frames : std::min<double>(info().num_frames, to_s_ * fps_ + 1);
  return std::max(1, int(end) - first_);
}

bool FrameSource::Read(Image* frame, double* time_s) {
  at_end_ = at_end_ || !reader_.Read(frame);
  if (at_end_) return false;
  *time_s = has_clock_ ? reader_.frame_time() : (reader_.next_frame() - 1) / fps_;
  at_end_ = to_s_ >= 0 && *time_s > to_s_ + kSameTime;
  return !at_end_;
}

}  // namespace bodyloom
