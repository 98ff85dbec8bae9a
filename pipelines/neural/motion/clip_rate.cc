// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/pipelines/neural/motion/clip_rate.h"

#include <cmath>
#include <stdexcept>

#include "bodyloom/data_tools/motion/motion_tools.h"
#include "bodyloom/geometry/base/check.h"

namespace bodyloom {
namespace {

constexpr double kTolerance = 0.01;

}  // namespace

bool IsAtRate(const Track& track, double fps) {
  const double own = FrameRateWithoutGaps(track.motion);
  return own <= 0 || std::abs(own / fps - 1) <= kTolerance;
}

std::string RateText(const Track& track) {
  return Concatenate(std::round(100 * FrameRateWithoutGaps(track.motion)) / 100, " frames a second");
}

void RequireRate(const Track& track, double fps, const std::string& data, const std::string& what_helps) {
  if (IsAtRate(track, fps)) return;
  throw std::runtime_error(
      Concatenate(data, ": pictures at ", RateText(track), ", expected ", fps, " as in training; ", what_helps));
}

}  // namespace bodyloom
