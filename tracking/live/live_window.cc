// SPDX-License-Identifier: Apache-2.0
#include "tracking/live/live_window.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "tracking/clip/track_result.h"
#include "tracking/clip/uncertainty.h"
#include "tracking/problem/input_checks.h"
#include "tracking/problem/user_cost.h"
#include "tracking/terms/dense/dense.h"
#include "tracking/terms/initialiser.h"
#include "tracking/terms/pose_prior/pose_prior.h"
#include "tracking/terms/straight_knees.h"
#include "tracking/terms/upright.h"

namespace bodyloom {
namespace {

constexpr double kHistory_s = 4.2;  ///< past frames that the lifter uses
constexpr int kHistoryFrames = 512;

std::unique_ptr<FixedLag> MakeLag(const LiveSetup& setup, SequenceProblem problem) {
  auto lag = std::make_unique<FixedLag>(std::move(problem), setup.options.lag + setup.options.context, setup.threads);
  lag->LimitPoints(setup.options.max_dense);
  return lag;
}

}  // namespace

LiveWindow::LiveWindow(const LiveSetup& setup, int64_t first_index)
    : setup_(setup),
      lag_(MakeLag(setup, setup.EmptyProblem())),
      history_(setup.input.landmarks, setup.layout.camera.width, setup.layout.camera.height, kHistory_s,
               kHistoryFrames),
      first_index_(first_index),
      next_index_(first_index) {}

LiveRecord& LiveWindow::Append(const LiveObservations& observations) {
  const Continuity continuity =
      history_.Add(observations.timestamp, observations.keypoints, tracking ? setup_.options.max_jump_s : 0);
  if (continuity == Continuity::kCut) {
    EndShot();
    Release(history_.num_frames() - 1);
  }
  LiveRecord& record = records_.emplace_back();
  record.index = next_index_++;
  ++frames_of_clip_;
  record.timestamp = observations.timestamp;
  DenseSequence dense;
  dense.frames = {observations.dense};
  dense.image_width = setup_.layout.camera.width;
  dense.image_height = setup_.layout.camera.height;
  DropUnusable(&dense);
  record.dense = std::move(dense.frames[0]);
  if (observations.initialiser) {
    const FrameState given{observations.initialiser->rotations, observations.initialiser->trans};
    if (IsFinite(given)) record.initialiser = observations.initialiser;
  }
  record.seen = history_.NewestIsSeen() || !record.dense.empty();
  if (continuity == Continuity::kHeld) {
    record.held = {std::exchange(record.dense, {}), std::exchange(record.initialiser, std::nullopt),
                   !observations.keypoints.empty()};
    record.seen = false;
    ++num_held_;
  }
  if (record.seen) last_seen_s_ = record.timestamp;
  if (tracking && record.timestamp - last_seen_s_ > setup_.options.lost_after_s) {
    EndShot();
    history_.Forget();
  }
  record.shot = shot_;
  return record;
}

void LiveWindow::Release(int count) {
  for (auto it = records_.rbegin(); it != records_.rend() && count > 0; ++it, --count) {
    if (!it->held || it->handed_out) return;  // returned frames do not change
    --num_held_;
    it->dense = std::move(it->held->dense);
    it->initialiser = std::move(it->held->initialiser);
    it->seen = it->held->seen || !it->dense.empty();
    it->held.reset();
    it->shot = shot_;
    it->lifted = LiftedPose();  // predicted for the previous person
    it->standing.reset();
    if (!it->in_window) continue;
    const int slot = SlotOf(*it);
    lag_->problem().frames[slot].Get<LiftedPoseTerm>().pose = nullptr;
    lag_->Touch(slot);
  }
}

void LiveWindow::EndShot() {
  tracking = false;
  shot_frames_ = 0;
  ++shot_;
}

int LiveWindow::NumOpen() const {
  int open = 0;
  for (auto it = records_.rbegin(); it != records_.rend() && !it->handed_out && it->shot == shot_; ++it) ++open;
  return open;
}

int LiveWindow::SlotOf(const LiveRecord& record) const {
  return static_cast<int>(std::count_if(records_.begin(), records_.end(),
                                        [&](const LiveRecord& r) { return r.in_window && r.index < record.index; }));
}

int LiveWindow::NumOfShotInWindow() const { return std::min(lag_->num_frames(), shot_frames_); }

FrameData LiveWindow::Observe(const FrameState& state, LiveRecord* record) const {
  const TrackSequenceOptions& solve = setup_.options.solve;
  FrameData frame;
  const double height_px = UprightHeightPx(setup_.layout, state, setup_.stature_m);
  const auto back = static_cast<int>(records_.back().index - record->index);
  const KeypointSequence recent = history_.Recent(back + 1, 1);
  auto& landmarks = frame.Get<LandmarkTerm>();
  if (recent.num_frames() == back + 1) landmarks.seen = ObserveLandmarks(setup_.landmarks, recent, 0, height_px);
  landmarks.kernel = StageSettings().landmark_kernel;
  if (!record->dense.empty()) frame.Get<DenseTerm>().points = &record->dense;
  auto& lifted = frame.Get<LiftedPoseTerm>();  // of which something is known later
  if (!record->lifted.points.empty()) {
    lifted.pose = &record->lifted;
    lifted.weight = solve.lifter_weight;
  }
  if (setup_.prior != nullptr) {
    frame.Get<PosePriorTerm>().mixture = setup_.prior;
    frame.Get<PosePriorTerm>().weight = solve.prior_weight;
  }
  frame.Get<JointLimitTerm>().limits = setup_.limits;
  frame.Get<UprightTerm>().weight = solve.upright_weight;
  if (solve.straight_knees_weight > 0) {
    frame.Get<StraightKneesTerm>() = StraightKneesTerm(setup_.knees, solve.straight_knees_weight);
  }
  auto& initialiser = frame.Get<InitialiserTerm>();
  if (record->initialiser) {
    initialiser.rotations = record->initialiser->rotations;
    initialiser.translation = record->initialiser->trans;
    initialiser.weight = solve.initialiser_weight;
    if (setup_.layout.knowledge == CameraKnowledge::kWeak) initialiser.translation = state.translation;
  }
  for (size_t i = 0; i < solve.user_terms.size(); ++i) {
    auto cost = MakeUserCostTerm(solve.user_terms[i], setup_.user_inputs[i], static_cast<int>(record->index));
    if (cost != nullptr) frame.terms.Add(std::move(cost));
  }
  return frame;
}

void LiveWindow::Add(LiveRecord* record, const FrameState& start, bool cut) {
  FrameData frame = Observe(start, record);
  record->status = record->seen ? StatusOf(frame) : FrameStatus::kInterpolated;
  if (lag_->Add(std::move(frame), start, record->timestamp, cut) > 0) {
    std::find_if(records_.begin(), records_.end(), [](const LiveRecord& r) { return r.in_window; })->in_window = false;
  }
  record->in_window = true;
  ++shot_frames_;
  lag_->problem().shape_prior.weight =
      std::max(1.0, setup_.options.solve.shape_prior_weight * static_cast<double>(frames_of_clip_));
}

void LiveWindow::Replace(LiveRecord* record, const FrameState& start, bool cut) {
  const int slot = SlotOf(*record);
  FrameData& frame = lag_->problem().frames[slot];
  frame = Observe(start, record);
  record->status = record->seen ? StatusOf(frame) : FrameStatus::kInterpolated;
  lag_->problem().states[slot] = start;
  lag_->Touch(slot);
  if (cut) lag_->Cut(slot);
  ++shot_frames_;
}

bool LiveWindow::Solve(int iterations) {
  const SolveReport report = lag_->Solve(iterations, setup_.options.reuse_linearisation);
  iterations_ += report.iterations - 1;
  if (report.status != SolveStatus::kFailure) return true;
  // The states of the window are not usable: restart with the next frame, from the shape and focal length so far.
  const SequenceProblem& failed = lag_->problem();
  SequenceProblem problem = setup_.EmptyProblem();
  if (failed.betas.allFinite()) problem.betas = failed.betas;
  problem.shape_prior = failed.shape_prior;
  if (std::isfinite(failed.log_focal)) problem.log_focal = failed.log_focal;
  lag_ = MakeLag(setup_, std::move(problem));
  for (LiveRecord& record : records_) {
    if (!record.handed_out) record.status = FrameStatus::kLost;
    record.in_window = false;
  }
  EndShot();
  return false;
}

PositionSigma LiveWindow::Uncertainty(int begin, int end) {
  const int J = setup_.input.body->num_joints();
  PositionSigma sigma = PositionSigma::Unknown(std::max(0, end - begin), J);
  if (begin >= end) return sigma;
  lag_->VisitCovariance(begin, end, [&](int slot, const Eigen::MatrixXd& P) {
    const FrameData& frame = problem().frames[slot];
    const JointSpread spread = JointSpreadOf(setup_.layout, problem().states[slot], problem().betas, P);
    // P includes the lifter's predictions through the prior from frames that have left the window. With 2D joints alone
    // the lifter's own covariance is nearly that of both joined; dense keypoints are more accurate than the lifter.
    const LiftedPose* lifted = frame.Get<LiftedPoseTerm>().pose;
    const bool lifter_decides = lifted != nullptr && frame.Get<DenseTerm>().size() == 0;
    sigma.joints.row(slot - begin) = (lifter_decides ? JointSigmaOf(*lifted, J) : JointSigmaOf(spread)).transpose();
    sigma.hips[slot - begin] = spread.HipsSigma();
  });
  return sigma;
}

Camera LiveWindow::PinholeNow() const {
  Camera camera = setup_.layout.camera;
  camera.model = CameraModel::kPinhole;
  if (setup_.layout.focal_column >= 0) camera.fx = camera.fy = std::exp(problem().log_focal);
  return camera;
}

void LiveWindow::DropDone() {
  while (records_.size() > 1 && records_.front().handed_out && !records_.front().in_window) records_.pop_front();
}

}  // namespace bodyloom
