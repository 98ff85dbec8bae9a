// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/tracking/live/live_lifter.h"

#include <algorithm>
#include <cmath>

#include "bodyloom/tracking/initialise/lifted_start.h"
#include "bodyloom/tracking/initialise/lifter_input.h"

namespace bodyloom {
namespace {

constexpr int kLifterReach = 36;      ///< samples behind the oldest that is read; a little more than the network's own
constexpr size_t kEnoughDense = 100;  ///< keypoints of a frame beside which it is not run

}  // namespace

LiveReading LiveLifter::Ask(const LiveSetup& setup, LiveWindow* window) {
  const LiveRecord& newest = window->records().back();
  if (setup.input.lifter == nullptr || setup.input.landmarks.empty() || setup.options.solve.lifter_weight == 0 ||
      !setup.lifted_landmarks.IsUsable() || newest.initialiser || newest.dense.size() >= kEnoughDense) {
    return {};
  }
  // At the network's own rate, in one phase that ends with the newest frame.
  const double step = window->history().TimeStep();
  LiveReading reading;
  reading.stride = step > 0 ? std::clamp(static_cast<int>(std::lround(1 / (kLifterRate * step))), 1, 20) : 1;
  const int stride = reading.stride;
  if (++since_last_ < stride) return {};
  since_last_ = 0;
  // The newest, and those not handed out yet again.
  const int num_read = (setup.options.lag + stride - 1) / stride + 1;
  const KeypointSequence seen = window->history().Recent(kLifterReach + num_read, stride);
  const int samples = seen.num_frames();
  LiftOptions options;
  options.all_phases = false;
  options.last_samples = num_read;
  const std::vector<LiftedFrame> read = LiftKeypoints(
      seen, window->PinholeNow(), setup.layout.knowledge == CameraKnowledge::kKnown, {}, *setup.input.lifter, options);
  if (read.empty()) return {};
  const int first = std::max(0, samples - num_read);
  reading.metres = LifterMetres(*setup.input.body, window->problem().betas);
  FixedLag& lag = window->lag();
  const int T = lag.num_frames(), shot = window->NumOfShotInWindow();
  for (int back = 0; back < shot && back <= (samples - 1 - first) * stride; ++back) {
    const int later = samples - 1 - back / stride;
    const LiftedFrame frame = back % stride == 0 ? read[later]
                                                 : InterpolateLifted(read[later], read[later - 1],
                                                                     static_cast<double>(back % stride) / stride);
    const int slot = T - 1 - back;
    LiveRecord& record = window->RecordAt(slot);
    record.lifted =
        MakeLiftedPose(frame, setup.lifted_landmarks, reading.metres, setup.options.solve.lifter_min_sigma_m);
    LiftedPoseTerm& term = lag.problem().frames[slot].Get<LiftedPoseTerm>();
    term.pose = &record.lifted;
    term.weight = setup.options.solve.lifter_weight;
    lag.Touch(slot);
  }
  reading.frames.assign(read.begin() + first, read.end());
  return reading;
}

}  // namespace bodyloom
