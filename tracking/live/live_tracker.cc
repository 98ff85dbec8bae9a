// SPDX-License-Identifier: Apache-2.0
#include "tracking/live/live_tracker.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <thread>
#include <utility>

#include "geometry/check.h"
#include "geometry/rotation.h"
#include "tracking/chain/fixed_lag.h"
#include "tracking/image_terms.h"
#include "tracking/initialise/bone_ratio_shape.h"
#include "tracking/initialise/initial_states.h"
#include "tracking/initialise/lifted_start.h"
#include "tracking/initialise/lifter_input.h"
#include "tracking/input_checks.h"
#include "tracking/live/live_history.h"
#include "tracking/observability.h"
#include "tracking/residuals/lifted_pose.h"
#include "tracking/track_result.h"

namespace bodyloom {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double kHistory_s = 4.2;  ///< what the lifter looks back on
constexpr int kHistoryFrames = 512;
constexpr int kLifterReach = 36;  ///< samples behind the oldest that is read; a little more than its own reach
constexpr int kFirstShapeFrames = 60;

constexpr size_t kEnoughDense = 100;  ///< keypoints of a frame beside which the lifter is not asked
constexpr double kOffLimb_m = 0.25;
constexpr int kFramesBetweenTries = 5;  ///< of the lifter's rate
constexpr int kTryIterations = 5;
constexpr double kTryGain = 0.5;  ///< of the cost of each frame: less does not pay for a jump
constexpr const char* kLimbJoints[4][2] = {
    {"l_shoulder", "l_elbow"}, {"r_shoulder", "r_elbow"}, {"l_hip", "l_knee"}, {"r_hip", "r_knee"}};

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

bool IsFinite(const FrameState& state) {
  return state.translation.allFinite() &&
         std::all_of(state.rotations.begin(), state.rotations.end(), [](const Matrix3d& R) { return R.allFinite(); });
}

}  // namespace

class LiveTracker::Impl {
 public:
  Impl(const LiveTrackerInput& input, const LiveTrackerOptions& options);
  std::optional<LiveFrame> Push(const LiveObservations& observations);
  std::vector<LiveFrame> Finish();

  FrameLayout layout_;
  std::unique_ptr<FixedLag> window_;
  std::unique_ptr<LiveHistory> history_;
  int64_t iterations_ = 0;
  int swaps_before_ = 0;

 private:
  /// A frame that has not been handed out yet or is in the window.
  struct Record {
    int64_t index = 0;
    double timestamp = 0;
    int shot = 0;
    bool cut_before = false, seen = false, in_window = false, handed_out = false;
    FrameStatus status = FrameStatus::kLost;
    std::vector<DenseKeypoint> dense;
    std::optional<BodyPose> initialiser;
    LiftedPose lifted;
  };

  [[nodiscard]] SequenceProblem EmptyProblem() const;
  void CheckObservations(const LiveObservations& observations) const;
  void EndShot();
  /// Records of the current shot that have not been handed out: the last `count`.
  [[nodiscard]] int NumOpen() const;
  /// Starting states of the last `count` frames; empty when they do not show enough.
  std::vector<FrameState> FindStates(int count);
  FrameData Observe(const FrameState& state, Record* record);
  void AddToWindow(Record* record, const FrameState& start, bool cut);
  void Start(int count, std::vector<FrameState> states);
  void Restart(int count);
  /// False when the window had to be given up.
  bool Solve(int iterations);
  void Track();
  void AskLifter();
  [[nodiscard]] Camera PinholeNow() const;
  /// Where limbs of the last frames are not where the lifter says, tries its poses instead, and keeps what costs less.
  /// `lifted` ends with the window's last frame, one frame every `stride`.
  void TryLifted(const std::vector<LiftedFrame>& lifted, int stride, double metres);
  /// Limbs (bit set) whose joints are farther than kOffLimb_m from the lifter's.
  unsigned LimbsOff(const FrameState& state, const LiftedFrame& lifted, double metres);
  void RefineShapePrior();
  LiveFrame HandOut(Record* record);
  void Forget();
  /// The window's frames in `records_`, oldest first.
  [[nodiscard]] int FirstInWindow() const { return static_cast<int>(records_.size()) - window_->num_frames(); }

  const LiveTrackerInput input_;
  const LiveTrackerOptions options_;
  int threads_ = 1;
  double stature_m_ = 0;
  ObservedLandmarks landmarks_;
  LiftedLandmarks lifted_landmarks_;
  std::optional<MixturePrior> prior_;
  JointLimits limits_;
  std::deque<Record> records_;
  int64_t next_index_ = 0, frames_of_clip_ = 0, next_shape_frames_ = kFirstShapeFrames;
  int64_t first_index_ = 0;  ///< of the clip
  bool tracking_ = false;
  int shot_ = 0, shot_frames_ = 0;  ///< which one; its tracked frames so far
  int since_lifter_ = 0;
  int until_next_try_ = 0;  ///< frames in which TryLifted() rests
  Kinematics kinematics_;
  PointEvaluator points_;
  double last_seen_ = 0;
};

LiveTracker::Impl::Impl(const LiveTrackerInput& input, const LiveTrackerOptions& options)
    : input_(input), options_(options) {
  std::string why;
  BODYLOOM_CHECK(options.IsValid(&why), "live: ", why);
  BODYLOOM_CHECK(input.body != nullptr, "live: no body");
  BODYLOOM_CHECK(!input.landmarks.empty() || input.dense, "live: neither 2D joints nor dense keypoints are announced");
  BODYLOOM_CHECK(input.camera.width > 0 && input.camera.height > 0, "live: the image size is not known");
  const BodyModel& model = *input.body;
  TrackSequenceInput numbers;
  numbers.body = input.body;
  numbers.camera = input.camera;
  CheckNumbers(numbers, options.solve);
  threads_ = options.solve.num_threads > 0 ? options.solve.num_threads
                                           : static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  const int num_betas = options.solve.estimate_shape ? std::min(model.num_betas(), 10) : 0;
  KeypointSequence names;
  names.names = input.landmarks;
  if (!input.landmarks.empty()) landmarks_ = FindObservedLandmarks(model, &names, num_betas);
  const std::vector<int> active = FindActiveJoints(model, landmarks_, input.dense, options.solve.skip_unneeded);
  Camera camera = input.camera;
  if (options.solve.camera_knowledge != CameraKnowledge::kKnown) {
    camera = MakePinhole(camera.width, camera.height, 0.9 * std::max(camera.width, camera.height));
  }
  layout_ = FrameLayout::Make(model, options.solve.camera_knowledge, camera, active, num_betas);
  if (input.prior != nullptr && input.prior->num_components() > 0) prior_.emplace(*input.prior, model, active);
  limits_ = JointLimits::ForBody(model);
  if (input.lifter != nullptr) lifted_landmarks_ = CompileLiftedLandmarks(model, num_betas);
  VectorXd gradient;
  stature_m_ = StatureOfMeanShape(model, num_betas, &gradient);
  window_ = std::make_unique<FixedLag>(EmptyProblem(), options.lag + options.context, threads_);
  window_->LimitDense(options.max_dense);
  history_ = std::make_unique<LiveHistory>(input.landmarks, camera.width, camera.height, kHistory_s, kHistoryFrames);
}

SequenceProblem LiveTracker::Impl::EmptyProblem() const {
  SequenceProblem problem;
  problem.layout = layout_;
  problem.betas = problem.shape_prior.mean = VectorXd::Zero(layout_.num_betas);
  problem.log_focal = problem.log_focal_prior = std::log(layout_.camera.fx);
  return problem;
}

void LiveTracker::Impl::CheckObservations(const LiveObservations& observations) const {
  BODYLOOM_CHECK(
      std::isfinite(observations.timestamp) && (records_.empty() || observations.timestamp > records_.back().timestamp),
      "live: a frame at ", observations.timestamp, " s", records_.empty() ? "" : " after one at ",
      records_.empty() ? 0.0 : records_.back().timestamp, " s; expected finite and increasing times");
  BODYLOOM_CHECK(observations.keypoints.empty() || observations.keypoints.size() == input_.landmarks.size(),
                 "live: ", observations.keypoints.size(), " 2D joints in a frame, expected ", input_.landmarks.size());
  BODYLOOM_CHECK(observations.dense.empty() || input_.dense, "live: dense keypoints came that were not announced");
  for (const DenseKeypoint& point : observations.dense) {
    BODYLOOM_CHECK(point.face >= 0 && point.face < input_.body->num_faces(), "live: a dense keypoint names face ",
                   point.face, ", the body '", input_.body->name(), "' has ", input_.body->num_faces());
  }
  BODYLOOM_CHECK(!observations.initialiser ||
                     static_cast<int>(observations.initialiser->rotations.size()) == input_.body->num_joints(),
                 "live: the initialiser has ",
                 observations.initialiser ? observations.initialiser->rotations.size() : 0, " rotations, the body ",
                 input_.body->num_joints(), " joints");
}

std::optional<LiveFrame> LiveTracker::Impl::Push(const LiveObservations& observations) {
  CheckObservations(observations);
  const bool cut = history_->Add(observations.timestamp, observations.keypoints);
  if (cut) EndShot();
  Record& record = records_.emplace_back();
  record.index = next_index_++;
  ++frames_of_clip_;
  record.timestamp = observations.timestamp;
  DenseSequence dense;
  dense.frames = {observations.dense};
  dense.image_width = layout_.camera.width;
  dense.image_height = layout_.camera.height;
  DropUnusable(&dense);
  record.dense = std::move(dense.frames[0]);
  if (observations.initialiser) {
    const FrameState given{observations.initialiser->rotations, observations.initialiser->trans};
    if (IsFinite(given)) record.initialiser = observations.initialiser;
  }
  record.seen = history_->NewestIsSeen() || !record.dense.empty();
  if (record.seen) last_seen_ = record.timestamp;
  if (tracking_ && record.timestamp - last_seen_ > options_.lost_after_s) {
    EndShot();
    history_->Forget();
  }
  record.shot = shot_;
  if (tracking_) {
    Track();
  } else if (record.seen) {
    int open = NumOpen();
    while (!(records_.end() - open)->seen) --open;  // what was not seen before the first sight stays lost
    std::vector<FrameState> states = FindStates(open);
    if (!states.empty()) Start(open, std::move(states));
  }
  std::optional<LiveFrame> out;
  const int waiting =
      static_cast<int>(std::count_if(records_.begin(), records_.end(), [](const Record& r) { return !r.handed_out; }));
  if (waiting > options_.lag) {
    out = HandOut(&*std::find_if(records_.begin(), records_.end(), [](const Record& r) { return !r.handed_out; }));
  }
  Forget();
  return out;
}

void LiveTracker::Impl::EndShot() {
  tracking_ = false;
  shot_frames_ = 0;
  ++shot_;
}

int LiveTracker::Impl::NumOpen() const {
  int open = 0;
  for (auto it = records_.rbegin(); it != records_.rend() && !it->handed_out && it->shot == shot_; ++it) ++open;
  return open;
}

std::vector<FrameState> LiveTracker::Impl::FindStates(int count) {
  const auto first = records_.end() - count;
  const bool given = std::all_of(first, records_.end(), [](const Record& r) { return r.initialiser.has_value(); });
  std::vector<FrameState> states;
  if (given) {
    for (auto it = first; it != records_.end(); ++it) {
      states.push_back({it->initialiser->rotations, it->initialiser->trans});
    }
    if (layout_.knowledge != CameraKnowledge::kWeak) return states;
  }
  TrackSequenceInput input;
  input.body = input_.body;
  input.prior = input_.prior;
  input.lifter = input_.lifter;
  input.camera = layout_.camera;
  const KeypointSequence keypoints = history_->Recent(count, 1);
  if (history_->NewestIsSeen()) input.keypoints = &keypoints;
  DenseSequence dense;
  for (auto it = first; it != records_.end(); ++it) {
    dense.frames.push_back(it->dense);
    dense.timestamps.push_back(it->timestamp);
  }
  if (input.keypoints == nullptr) input.dense = &dense;
  Motion motion;
  if (given) {
    motion.poses.resize(count, 3 * input_.body->num_joints());
    motion.trans.resize(count, 3);
    for (int i = 0; i < count; ++i) {
      const BodyPose pose{states[i].rotations, states[i].translation};
      motion.poses.row(i) = AxisAngleFromPose(*input_.body, pose).transpose();
      motion.trans.row(i) = pose.trans.transpose();
    }
    input.initialiser = &motion;
  }
  FrameLayout layout = layout_;
  const double focal = std::exp(window_->problem().log_focal);
  if (layout.focal_column >= 0) layout.camera.fx = layout.camera.fy = focal;
  LiftedStart lifted;
  TrackSequenceOptions options = options_.solve;
  options.num_threads = 1;
  KeypointSequence from_dense;
  states = FindInitialStates(input, JointsToStartFrom(input, &from_dense), layout, options, &lifted).states;
  for (size_t i = 0; i < lifted.frames.size(); ++i) {
    Record& record = *(first + static_cast<std::ptrdiff_t>(i));
    record.lifted =
        MakeLiftedPose(lifted.frames[i], lifted_landmarks_, lifted.metres, options_.solve.lifter_min_sigma_m);
  }
  return std::all_of(states.begin(), states.end(), IsFinite) ? states : std::vector<FrameState>();
}

FrameData LiveTracker::Impl::Observe(const FrameState& state, Record* record) {
  FrameData frame;
  const double height_px = PersonHeightPx(layout_, state, stature_m_);
  const auto back = static_cast<int>(records_.back().index - record->index);
  const KeypointSequence recent = history_->Recent(back + 1, 1);
  if (recent.num_frames() == back + 1) frame.landmarks = ObserveLandmarks(landmarks_, recent, 0, height_px);
  if (!record->dense.empty()) frame.dense = &record->dense;
  if (prior_) {
    frame.prior = &*prior_;
    frame.prior_weight = options_.solve.prior_weight;
  }
  frame.limits = &limits_;
  frame.upright_weight = options_.solve.upright_weight;
  frame.landmark_kernel = 4;
  if (!record->lifted.points.empty()) {
    frame.lifted = &record->lifted;
    frame.lifted_weight = options_.solve.lifter_weight;
  }
  if (record->initialiser) {
    frame.initial_rotations = record->initialiser->rotations;
    frame.initial_translation = record->initialiser->trans;
    frame.initialiser_weight = options_.solve.initialiser_weight;
    if (layout_.knowledge == CameraKnowledge::kWeak) frame.initial_translation = state.translation;
  }
  return frame;
}

void LiveTracker::Impl::AddToWindow(Record* record, const FrameState& start, bool cut) {
  FrameData frame = Observe(start, record);
  record->status = record->seen ? StatusOf(frame) : FrameStatus::kInterpolated;
  if (window_->Add(std::move(frame), start, record->timestamp, cut) > 0) {
    std::find_if(records_.begin(), records_.end(), [](const Record& r) { return r.in_window; })->in_window = false;
  }
  record->in_window = true;
  ++shot_frames_;
  SequenceProblem& problem = window_->problem();
  problem.shape_prior.weight = std::max(1.0, options_.solve.shape_prior_weight * static_cast<double>(frames_of_clip_));
}

void LiveTracker::Impl::Start(int count, std::vector<FrameState> states) {
  for (int i = 0; i < count; ++i) {
    Record& record = *(records_.end() - count + i);
    record.cut_before = i == 0 && record.index > first_index_;
    AddToWindow(&record, states[i], i == 0);
  }
  tracking_ = true;
  since_lifter_ = 0;
  Restart(0);
}

void LiveTracker::Impl::Restart(int count) {
  SequenceProblem& problem = window_->problem();
  const int T = window_->num_frames();
  if (count > 0) {
    const std::vector<FrameState> states = FindStates(count);
    for (size_t i = 0; i < states.size(); ++i) {
      const int slot = T - count + static_cast<int>(i);
      problem.states[slot] = states[i];
      problem.frames[slot] = Observe(states[i], &*(records_.end() - count + static_cast<std::ptrdiff_t>(i)));
      window_->Touch(slot);
    }
  }
  // First near the start, then free.
  const int open = std::min(T, shot_frames_);
  std::vector<FrameData> observed(problem.frames.end() - open, problem.frames.end());
  for (int slot = T - open; slot < T; ++slot) {
    FrameData& frame = problem.frames[slot];
    frame.initial_rotations = problem.states[slot].rotations;
    frame.initial_translation = problem.states[slot].translation;
    frame.initialiser_weight = options_.solve.start_pull;
    frame.landmark_kernel = 8;
    window_->Touch(slot);
  }
  if (!Solve(options_.start_iterations)) return;
  for (int slot = T - open; slot < T; ++slot) {
    problem.frames[slot] = std::move(observed[slot - T + open]);
    window_->Touch(slot);
  }
  Solve(options_.start_iterations);
}

bool LiveTracker::Impl::Solve(int iterations) {
  const SolveReport report = window_->Solve(iterations, options_.skip_settled);
  iterations_ += report.iterations - 1;
  if (report.status != SolveStatus::kFailure) return true;
  // Nothing in the window can be trusted: begin again with the next frame, from the shape and focal length so far.
  SequenceProblem problem = EmptyProblem();
  if (window_->problem().betas.allFinite()) problem.betas = window_->problem().betas;
  problem.shape_prior = window_->problem().shape_prior;
  if (std::isfinite(window_->problem().log_focal)) problem.log_focal = window_->problem().log_focal;
  window_ = std::make_unique<FixedLag>(std::move(problem), options_.lag + options_.context, threads_);
  window_->LimitDense(options_.max_dense);
  for (Record& record : records_) {
    if (!record.handed_out) record.status = FrameStatus::kLost;
    record.in_window = false;
  }
  EndShot();
  return false;
}

void LiveTracker::Impl::Track() {
  Record& record = records_.back();
  const SequenceProblem& problem = window_->problem();
  const int T = window_->num_frames();
  FrameState start = problem.states[T - 1];
  const bool young = shot_frames_ <= options_.lag;
  if (record.initialiser && layout_.knowledge != CameraKnowledge::kWeak) {
    start = {record.initialiser->rotations, record.initialiser->trans};
  } else if (shot_frames_ >= 2) {
    const double before = problem.timestamps[T - 1] - problem.timestamps[T - 2];
    start = Predict(problem.states[T - 2], problem.states[T - 1], before,
                    std::min(record.timestamp - problem.timestamps[T - 1], before));
  }
  AddToWindow(&record, start, false);
  if (young) {
    Restart(record.seen ? shot_frames_ : 0);
    return;
  }
  AskLifter();
  RefineShapePrior();
  Solve(options_.iterations);
}

void LiveTracker::Impl::AskLifter() {
  if (input_.lifter == nullptr || input_.landmarks.empty() || options_.solve.lifter_weight == 0 ||
      !lifted_landmarks_.IsUsable() || records_.back().initialiser || records_.back().dense.size() >= kEnoughDense) {
    return;
  }
  // At the network's own rate, in one phase that ends with the newest frame.
  const double step = history_->TimeStep();
  const int stride = step > 0 ? std::clamp(static_cast<int>(std::lround(1 / (kLifterRate * step))), 1, 20) : 1;
  if (++since_lifter_ < stride) return;
  since_lifter_ = 0;
  const int num_read = (options_.lag + stride - 1) / stride + 1;  // the newest, and those not handed out yet again
  const KeypointSequence seen = history_->Recent(kLifterReach + num_read, stride);
  const int samples = seen.num_frames();
  LiftOptions options;
  options.all_phases = false;
  options.last_samples = num_read;
  const std::vector<LiftedFrame> read =
      LiftKeypoints(seen, PinholeNow(), layout_.knowledge == CameraKnowledge::kKnown, {}, *input_.lifter, options);
  if (read.empty()) return;
  const int first = std::max(0, samples - num_read);
  const double metres = LifterMetres(*input_.body, window_->problem().betas);
  const int T = window_->num_frames(), shot = std::min(T, shot_frames_);
  for (int back = 0; back < shot && back <= (samples - 1 - first) * stride; ++back) {
    const int later = samples - 1 - back / stride;
    const LiftedFrame frame = back % stride == 0 ? read[later]
                                                 : InterpolateLifted(read[later], read[later - 1],
                                                                     static_cast<double>(back % stride) / stride);
    const int slot = T - 1 - back;
    Record& record = records_[FirstInWindow() + slot];
    record.lifted = MakeLiftedPose(frame, lifted_landmarks_, metres, options_.solve.lifter_min_sigma_m);
    FrameData& data = window_->problem().frames[slot];
    data.lifted = &record.lifted;
    data.lifted_weight = options_.solve.lifter_weight;
    window_->Touch(slot);
  }
  TryLifted({read.begin() + first, read.end()}, stride, metres);
}

unsigned LiveTracker::Impl::LimbsOff(const FrameState& state, const LiftedFrame& lifted, double metres) {
  kinematics_.Set(*input_.body, window_->problem().betas, state.rotations, Vector3d::Zero(), false);
  const auto at = [&](int k) { return points_.Evaluate(kinematics_, lifted_landmarks_.points[k], false); };
  const Vector3d hips = 0.5 * (at(kLifterLeftHip) + at(kLifterLeftHip + 1));
  unsigned off = 0;
  for (int limb = 0; limb < 4; ++limb) {
    for (int i = 1; i < 3; ++i) {  // elbow and wrist, knee and ankle
      const int k = kLimbs[limb][i];
      if (!lifted_landmarks_.known[k]) continue;
      const Vector3d away = at(k) - hips - metres * lifted.points.row(k).transpose();
      if (away.norm() > kOffLimb_m) off |= 1U << limb;
    }
  }
  return off;
}

void LiveTracker::Impl::TryLifted(const std::vector<LiftedFrame>& lifted, int stride, double metres) {
  if (until_next_try_ > 0) --until_next_try_;
  const int T = window_->num_frames(), samples = static_cast<int>(lifted.size());
  const int count = (samples - 1) * stride + 1;  // the last frames of the window, which the samples span
  // Dense keypoints tell limbs apart by themselves.
  if (until_next_try_ > 0 || samples < 2 || count > std::min(T, shot_frames_) || !records_.back().dense.empty() ||
      layout_.knowledge == CameraKnowledge::kWeak) {
    return;
  }
  SequenceProblem& problem = window_->problem();
  unsigned off = 0xF;
  for (int i = 0; i < samples; ++i) {
    off &= LimbsOff(problem.states[T - count + i * stride], lifted[i], metres);
    if (off == 0) return;
  }
  until_next_try_ = kFramesBetweenTries;
  const KeypointSequence seen = history_->Recent(samples, stride);
  const std::vector<FrameState> poses =
      PosesFromLifted(lifted, seen, PinholeNow(), *input_.body, problem.betas, metres);
  if (poses.empty()) return;
  std::vector<int> last;
  for (int t = T - count; t < T; ++t) last.push_back(t);
  const SequenceProblem now = SelectFrames(problem, last);
  SolveOptions options;
  options.solver = SequenceSolver::kChain;
  options.shape_constant = options.focal_constant = true;
  options.num_threads = threads_;
  options.max_iterations = 0;
  SequenceProblem best = now;
  double best_cost = SolveSequence(&best, options).final_cost;
  options.max_iterations = kTryIterations;
  best_cost = std::min(best_cost, SolveSequence(&best, options).final_cost) - kTryGain * count;
  bool found = false;
  for (const bool whole : {false, true}) {
    SequenceProblem other = now;
    for (int t = 0; t < count; ++t) {
      const int i = std::min(t / stride, samples - 2);
      const FrameState pose = InterpolateStates(poses[i], poses[i + 1], static_cast<double>(t - i * stride) / stride);
      if (whole) {
        other.states[t] = pose;
        continue;
      }
      for (int limb = 0; limb < 4; ++limb) {
        if ((off >> limb & 1U) == 0) continue;
        for (const char* name : kLimbJoints[limb]) {
          const int j = input_.body->FindJoint(name);
          other.states[t].rotations[j] = pose.rotations[j];
        }
      }
    }
    const SolveReport report = SolveSequence(&other, options);
    if (report.status == SolveStatus::kFailure || !(report.final_cost < best_cost)) continue;
    best_cost = report.final_cost;
    best = std::move(other);
    found = true;
  }
  if (!found) return;
  // What the frames before say about the pose was said of another one: the first of these begins a shot for the solver.
  for (int t = 0; t < count; ++t) {
    problem.states[T - count + t] = best.states[t];
    window_->Touch(T - count + t);
  }
  window_->Cut(T - count);
}

Camera LiveTracker::Impl::PinholeNow() const {
  Camera camera = layout_.camera;
  camera.model = CameraModel::kPinhole;
  if (layout_.focal_column >= 0) camera.fx = camera.fy = std::exp(window_->problem().log_focal);
  return camera;
}

void LiveTracker::Impl::RefineShapePrior() {
  if (layout_.num_betas == 0 || history_->Sample().num_frames() == 0 || frames_of_clip_ < next_shape_frames_) return;
  next_shape_frames_ *= 2;
  window_->problem().shape_prior.mean =
      EstimateShape(history_->Sample(), PinholeNow(), *input_.body, layout_.num_betas, options_.solve.hypotheses);
}

LiveFrame LiveTracker::Impl::HandOut(Record* record) {
  LiveFrame out;
  const SequenceProblem& problem = window_->problem();
  out.index = record->index;
  out.timestamp = record->timestamp;
  out.cut_before = record->cut_before;
  out.status = record->status;
  if (record->in_window) {
    const int slot = static_cast<int>(std::count_if(
        records_.begin(), records_.end(), [&](const Record& r) { return r.in_window && r.index < record->index; }));
    out.state = problem.states[slot];
  }
  if (!record->in_window || !IsFinite(out.state)) {
    out.status = FrameStatus::kLost;
    constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
    out.state.rotations.assign(input_.body->num_joints(), Matrix3d::Constant(kNaN));
    out.state.translation.setConstant(kNaN);
  }
  out.betas = problem.betas;
  out.camera = layout_.CameraAt(out.state, problem.log_focal);
  record->handed_out = true;
  return out;
}

void LiveTracker::Impl::Forget() {
  while (!records_.empty() && records_.front().handed_out && !records_.front().in_window && records_.size() > 1) {
    records_.pop_front();
  }
}

std::vector<LiveFrame> LiveTracker::Impl::Finish() {
  std::vector<LiveFrame> out;
  for (Record& record : records_) {
    if (!record.handed_out) out.push_back(HandOut(&record));
  }
  records_.clear();
  const SequenceProblem problem = EmptyProblem();
  window_ = std::make_unique<FixedLag>(problem, options_.lag + options_.context, threads_);
  window_->LimitDense(options_.max_dense);
  swaps_before_ += history_->num_swaps_repaired();
  history_ = std::make_unique<LiveHistory>(input_.landmarks, layout_.camera.width, layout_.camera.height, kHistory_s,
                                           kHistoryFrames);
  frames_of_clip_ = 0;
  next_shape_frames_ = kFirstShapeFrames;
  first_index_ = next_index_;
  EndShot();
  return out;
}

bool LiveTrackerOptions::IsValid(std::string* why) const {
  const auto in_range = [&](const char* name, double value, double low, double high) {
    if (value >= low && value <= high) return true;
    *why = Concatenate(name, " is ", value, ", expected ", low, " to ", high);
    return false;
  };
  return solve.IsValid(why) && in_range("lag", lag, 0, 60) && in_range("context", context, 3, 60) &&
         in_range("iterations", iterations, 1, 50) && in_range("start_iterations", start_iterations, 1, 50) &&
         in_range("max_dense", max_dense, 1, 1e7) && in_range("lost_after_s", lost_after_s, 0, 10) &&
         in_range("skip_settled", skip_settled, 0, 0.1);
}

LiveTracker::LiveTracker(const LiveTrackerInput& input, const LiveTrackerOptions& options)
    : impl_(std::make_unique<Impl>(input, options)) {}
LiveTracker::~LiveTracker() = default;
LiveTracker::LiveTracker(LiveTracker&&) noexcept = default;
LiveTracker& LiveTracker::operator=(LiveTracker&&) noexcept = default;
std::optional<LiveFrame> LiveTracker::Push(const LiveObservations& observations) { return impl_->Push(observations); }
std::vector<LiveFrame> LiveTracker::Finish() { return impl_->Finish(); }
const FrameLayout& LiveTracker::layout() const { return impl_->layout_; }
const VectorXd& LiveTracker::betas() const { return impl_->window_->problem().betas; }
double LiveTracker::log_focal() const { return impl_->window_->problem().log_focal; }
int64_t LiveTracker::num_iterations() const { return impl_->iterations_; }
int LiveTracker::num_swaps_repaired() const { return impl_->swaps_before_ + impl_->history_->num_swaps_repaired(); }

}  // namespace bodyloom
