// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/work_precision/work_problem.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "benchmarks/accuracy/dense_clips.h"
#include "bodyloom/data_tools/body/builtin_body.h"
#include "bodyloom/data_tools/learned/pose_prior_io.h"
#include "bodyloom/data_tools/motion/load_motion.h"
#include "bodyloom/data_tools/synthesis/clips/demo_motion.h"
#include "bodyloom/geometry/posed_body.h"
#include "bodyloom/tracking/terms/dense/dense.h"
#include "bodyloom/tracking/terms/pose_prior/pose_prior.h"

namespace bodyloom {
namespace {

/// `frames` frames from `first` on, forwards and backwards as often as it takes.
Motion Unfold(const Motion& motion, int first, int frames) {
  const int T = motion.num_frames(), period = std::max(1, 2 * T - 2);
  const double step = T > 1 ? (motion.timestamps[T - 1] - motion.timestamps[0]) / (T - 1) : 1.0 / 30;
  Motion result = motion;
  result.poses.resize(frames, motion.poses.cols());
  result.trans.resize(frames, 3);
  result.timestamps.resize(frames);
  for (int i = 0; i < frames; ++i) {
    const int k = (first + i) % period, t = k < T ? k : period - k;
    result.poses.row(i) = motion.poses.row(t);
    result.trans.row(i) = motion.trans.row(t);
    result.timestamps[i] = i * step;
  }
  return result;
}

}  // namespace

std::unique_ptr<WorkProblem> MakeWorkProblem(const WorkProblemOptions& options) {
  const BodyModel& body = BuiltinBody();
  auto work = std::make_unique<WorkProblem>();
  SynthClipOptions synth;
  synth.seed = options.seed;
  synth.dense_per_frame = options.dense;
  synth.dense = DenseFaults(options.noise);
  synth.keypoints = false;
  synth.initialiser_error_px = options.start_error_px;
  synth.num_threads = 2;
  const Motion motion =
      options.motion.empty() ? DemoMotion(body, options.first_frame + options.frames, 30) : LoadMotion(options.motion);
  work->clip = MakeSynthClip(body, Unfold(motion, options.first_frame, options.frames), synth);
  const SynthClip& clip = work->clip;
  std::vector<int> joints(body.num_joints());
  std::iota(joints.begin(), joints.end(), 0);
  work->prior = std::make_unique<MixturePrior>(BuiltinPosePrior(), body, joints);
  SequenceProblem& problem = work->problem;
  const int B = std::min(body.num_betas(), 10), T = options.frames;
  problem.layout = FrameLayout::Make(body, CameraKnowledge::kKnown, clip.truth.camera, joints, B);
  problem.timestamps = clip.truth.motion.timestamps;
  problem.cut_before.assign(T, 0);
  problem.betas = Eigen::VectorXd::Zero(B);
  problem.shape_prior.weight = std::max(1.0, 0.3 * T);
  for (int t = 0; t < T; ++t) {
    const BodyPose start =
        PoseFromAxisAngle(body, clip.initialiser.poses.row(t).transpose(), clip.initialiser.trans.row(t).transpose());
    problem.states.push_back({start.rotations, start.trans});
    FrameData frame;
    frame.Get<DenseTerm>().points = &clip.dense.frames[t];
    frame.Get<PosePriorTerm>().mixture = work->prior;
    frame.Get<PosePriorTerm>().weight = 0.2;
    problem.frames.push_back(frame);
  }
  return work;
}

double ProjectionErrorPx(const WorkProblem& work, const std::vector<FrameState>& states, const Eigen::VectorXd& betas) {
  const BodyModel& body = BuiltinBody();
  const Motion& truth = work.clip.truth.motion;
  const Camera& camera = work.clip.truth.camera;
  double sum = 0;
  int count = 0;
  Eigen::Vector2d p, q;
  const int stride = std::max(1, static_cast<int>(states.size()) / 300);  // of long clips a sample
  for (size_t t = 0; t < states.size(); t += stride) {
    const auto row = static_cast<Eigen::Index>(t);
    const MatrixX3d a = PoseVertices(body, betas, {states[t].rotations, states[t].translation});
    const MatrixX3d b = PoseVertices(
        body, truth.betas, PoseFromAxisAngle(body, truth.poses.row(row).transpose(), truth.trans.row(row).transpose()));
    for (Eigen::Index v = 0; v < a.rows(); v += 10, ++count) {
      const bool seen = camera.Project(a.row(v), &p) && camera.Project(b.row(v), &q);
      sum += seen ? std::min((p - q).norm(), double(camera.width)) : camera.width;
    }
  }
  return sum / count * 512 / std::max(camera.width, camera.height);
}

}  // namespace bodyloom
