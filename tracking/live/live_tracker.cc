// SPDX-License-Identifier: Apache-2.0
#include "tracking/live/live_tracker.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "geometry/math/rotation.h"
#include "tracking/live/live_limbs.h"
#include "tracking/live/live_setup.h"
#include "tracking/live/live_start.h"
#include "tracking/live/live_window.h"

namespace bodyloom {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Steady motion continued by dt seconds.
FrameState Predict(const FrameState& before, const FrameState& last, double dt_before, double dt) {
  const double s = dt / dt_before;
  FrameState next = last;
  for (size_t j = 0; j < last.rotations.size(); ++j) {
    const Vector3d w = s * AxisAngleFromRotation(before.rotations[j].transpose() * last.rotations[j]);
    next.rotations[j] = last.rotations[j] * RotationFromAxisAngle(w);
  }
  next.translation += s * (last.translation - before.translation);
  return next;
}

}  // namespace

class LiveTracker::Impl {
 public:
  Impl(const LiveTrackerInput& input, const LiveTrackerOptions& options) : setup_(input, options) {}
  std::optional<LiveFrame> Push(const LiveObservations& observations);
  std::vector<LiveFrame> Finish();
  [[nodiscard]] const LiveSetup& setup() const { return setup_; }
  [[nodiscard]] const SequenceProblem& problem() const { return clip_->window.problem(); }
  [[nodiscard]] int64_t num_iterations() const { return iterations_before_ + clip_->window.iterations(); }
  [[nodiscard]] int64_t num_frames_left_out() const { return left_out_before_ + clip_->window.num_frames_left_out(); }
  [[nodiscard]] int num_swaps_repaired() const { return swaps_before_ + clip_->window.history().num_swaps_repaired(); }

 private:
  /// State that is reset for each clip.
  struct Clip {
    Clip(const LiveSetup& setup, int64_t first_index) : window(setup, first_index) {}
    LiveWindow window;
    LiveLifter lifter;
    LiveLimbs limbs;
    LiveShape shape;
  };

  /// The newest frame continues the shot.
  void Track(LiveRecord* newest);
  /// Frames of the records that have not been returned yet, in order.
  std::vector<LiveFrame> ReleaseFrames(const std::deque<LiveRecord>::iterator& begin,
                                       const std::deque<LiveRecord>::iterator& end);

  const LiveSetup setup_;
  int64_t pushed_ = 0;
  int64_t iterations_before_ = 0, left_out_before_ = 0;  ///< of clips that have ended
  int swaps_before_ = 0;
  std::unique_ptr<Clip> clip_ = std::make_unique<Clip>(setup_, 0);
};

std::optional<LiveFrame> LiveTracker::Impl::Push(const LiveObservations& observations) {
  LiveWindow& window = clip_->window;
  std::deque<LiveRecord>& records = window.records();
  setup_.CheckObservations(observations, records.empty() ? nullptr : &records.back().timestamp);
  LiveRecord& newest = window.Append(observations);
  ++pushed_;
  if (window.tracking) {
    Track(&newest);
  } else if (newest.seen && StartShot(setup_, &window)) {
    clip_->lifter.Restart();
  }
  std::optional<LiveFrame> out;
  const auto waits = [](const LiveRecord& record) { return !record.handed_out; };
  if (std::count_if(records.begin(), records.end(), waits) > setup_.options.lag) {
    const auto first = std::find_if(records.begin(), records.end(), waits);
    out = std::move(ReleaseFrames(first, first + 1).front());
  }
  window.DropDone();
  return out;
}

void LiveTracker::Impl::Track(LiveRecord* newest) {
  LiveWindow& window = clip_->window;
  const SequenceProblem& problem = window.problem();
  const int T = window.lag().num_frames();
  FrameState start = problem.states[T - 1];
  const bool young = window.shot_frames() <= setup_.options.lag;
  if (newest->initialiser && setup_.layout.knowledge != CameraKnowledge::kWeak) {
    start = {newest->initialiser->rotations, newest->initialiser->trans};
  } else if (window.shot_frames() >= 2) {
    const double before = problem.timestamps[T - 1] - problem.timestamps[T - 2];
    start = Predict(problem.states[T - 2], problem.states[T - 1], before,
                    std::min(newest->timestamp - problem.timestamps[T - 1], before));
  }
  window.Add(newest, start, false);
  if (young) {
    // No frame of the shot has been returned yet.
    RestartShot(setup_, newest->seen ? window.shot_frames() : 0, &window);
    return;
  }
  clip_->limbs.Try(setup_, clip_->lifter.Ask(setup_, &window), &window);
  clip_->shape.Refine(setup_, &window);
  window.Solve(setup_.options.iterations);
}

std::vector<LiveFrame> LiveTracker::Impl::ReleaseFrames(const std::deque<LiveRecord>::iterator& begin,
                                                        const std::deque<LiveRecord>::iterator& end) {
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  const int num_joints = setup_.input.body->num_joints();
  LiveWindow& window = clip_->window;
  const SequenceProblem& problem = window.problem();
  PositionSigma sigma;
  int first_slot = 0;
  if (setup_.options.solve.estimate_uncertainty) {
    const auto in_window = [](const LiveRecord& record) { return record.in_window; };
    const auto first = std::find_if(begin, end, in_window);
    if (first != end) first_slot = window.SlotOf(*first);
    sigma = window.Uncertainty(first_slot, first_slot + static_cast<int>(std::count_if(begin, end, in_window)));
  }
  std::vector<LiveFrame> frames;
  for (auto record = begin; record != end; ++record) {
    LiveFrame& out = frames.emplace_back();
    out.index = record->index;
    out.timestamp = record->timestamp;
    out.cut_before = record->cut_before;
    out.status = record->status;
    out.standing = record->standing;
    out.joint_sigma.setConstant(num_joints, kNaN);
    const int slot = record->in_window ? window.SlotOf(*record) : -1;
    if (slot >= 0) out.state = problem.states[slot];
    if (slot < 0 || !IsFinite(out.state)) {
      out.status = FrameStatus::kLost;
      out.state.rotations.assign(num_joints, Matrix3d::Constant(kNaN));
      out.state.translation.setConstant(kNaN);
    } else if (sigma.joints.rows() > 0) {
      out.joint_sigma = sigma.joints.row(slot - first_slot).transpose();
      out.root_sigma = sigma.hips[slot - first_slot];
    }
    out.betas = problem.betas;
    out.camera = setup_.layout.CameraAt(out.state, problem.log_focal);
    record->handed_out = true;
  }
  return frames;
}

std::vector<LiveFrame> LiveTracker::Impl::Finish() {
  std::deque<LiveRecord>& records = clip_->window.records();
  const auto first =
      std::find_if(records.begin(), records.end(), [](const LiveRecord& record) { return !record.handed_out; });
  std::vector<LiveFrame> out = ReleaseFrames(first, records.end());
  iterations_before_ = num_iterations();
  swaps_before_ = num_swaps_repaired();
  left_out_before_ = num_frames_left_out();
  clip_ = std::make_unique<Clip>(setup_, pushed_);
  return out;
}

LiveTracker::LiveTracker(const LiveTrackerInput& input, const LiveTrackerOptions& options)
    : impl_(std::make_unique<Impl>(input, options)) {}
LiveTracker::~LiveTracker() = default;
LiveTracker::LiveTracker(LiveTracker&&) noexcept = default;
LiveTracker& LiveTracker::operator=(LiveTracker&&) noexcept = default;
std::optional<LiveFrame> LiveTracker::Push(const LiveObservations& observations) { return impl_->Push(observations); }
std::vector<LiveFrame> LiveTracker::Finish() { return impl_->Finish(); }
const FrameLayout& LiveTracker::layout() const { return impl_->setup().layout; }
const Eigen::VectorXd& LiveTracker::betas() const { return impl_->problem().betas; }
double LiveTracker::log_focal() const { return impl_->problem().log_focal; }
int64_t LiveTracker::num_iterations() const { return impl_->num_iterations(); }
int LiveTracker::num_swaps_repaired() const { return impl_->num_swaps_repaired(); }
int64_t LiveTracker::num_frames_left_out() const { return impl_->num_frames_left_out(); }

}  // namespace bodyloom
