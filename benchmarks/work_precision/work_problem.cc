// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/work_precision/work_problem.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

#include "benchmarks/accuracy/dense_clips.h"
#include "data_tools/body/builtin_body.h"
#include "data_tools/formats/npz.h"
#include "data_tools/learned/pose_prior_io.h"
#include "data_tools/motion/load_motion.h"
#include "data_tools/synthesis/clips/demo_motion.h"
#include "geometry/base/check.h"
#include "geometry/body/posed_body.h"
#include "geometry/math/rotation.h"
#include "tracking/solvers/residuals/acceleration_cost.h"
#include "tracking/terms/dense/dense.h"
#include "tracking/terms/pose_prior/pose_prior.h"

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

namespace {

/// Doubles by a formula of their flat index.
NdArray Filled(std::vector<int64_t> shape, const std::function<double(int64_t)>& value) {
  int64_t size = 1;
  for (int64_t n : shape) size *= n;
  std::vector<double> values(size);
  for (int64_t i = 0; i < size; ++i) values[i] = value(i);
  return NdArray::FromDoubles(values.data(), std::move(shape));
}

/// Lists of different lengths as a rectangle: `width` entries a row, 0 where there is none.
struct Ragged {
  const std::vector<int>& begin;
  int width;
  explicit Ragged(const std::vector<int>& b) : begin(b), width(1) {
    for (size_t v = 0; v + 1 < b.size(); ++v) width = std::max(width, b[v + 1] - b[v]);
  }
  /// Index of entry k of row v, −1: none.
  [[nodiscard]] int At(int64_t v, int64_t k) const {
    return begin[v] + k < begin[v + 1] ? begin[v] + static_cast<int>(k) : -1;
  }
};

}  // namespace

void WriteProblemFile(const WorkProblem& work, const std::string& path) {
  const BodyModel& body = BuiltinBody();
  const BodyModelData& d = body.data();
  const SequenceProblem& problem = work.problem;
  const int64_t T = static_cast<int64_t>(problem.states.size()), V = body.num_vertices(), J = body.num_joints();
  const int64_t B = problem.layout.num_betas;
  int64_t K = 1;
  for (const FrameData& frame : problem.frames)
    K = std::max(K, static_cast<int64_t>(frame.Get<DenseTerm>().points->size()));
  const auto keypoint = [&](int64_t t, int64_t k) -> const DenseKeypoint* {
    const std::vector<DenseKeypoint>& points = *problem.frames[t].Get<DenseTerm>().points;
    return k < static_cast<int64_t>(points.size()) ? &points[k] : nullptr;
  };
  NpzArrays out;
  out["parents"] = Filled({J}, [&](int64_t j) { return body.parents()[j]; });
  out["corners"] = Filled({T, K, 3}, [&](int64_t i) {
    const DenseKeypoint* p = keypoint(i / (3 * K), i / 3 % K);
    return p != nullptr ? d.faces(p->face, i % 3) : 0;
  });
  out["barycentric"] = Filled({T, K, 3}, [&](int64_t i) {
    const DenseKeypoint* p = keypoint(i / (3 * K), i / 3 % K);
    return p != nullptr ? double{p->barycentric[i % 3]} / p->barycentric.cast<double>().sum() : 1.0 / 3;
  });
  out["pixel"] = Filled({T, K, 2}, [&](int64_t i) {
    const DenseKeypoint* p = keypoint(i / (2 * K), i / 2 % K);
    return p != nullptr ? double{p->pixel[i % 2]} : 0.0;
  });
  out["inverse_sigma"] = Filled({T, K}, [&](int64_t i) {
    const DenseKeypoint* p = keypoint(i / K, i % K);
    return p != nullptr ? 1.0 / p->sigma_px : 0.0;
  });
  out["v_template"] = Filled({V, 3}, [&](int64_t i) { return d.v_template(i / 3, i % 3); });
  out["shapedirs"] = Filled({V, 3, B}, [&](int64_t i) { return double{d.shapedirs(i / B, i % B)}; });
  out["joint_template"] = Filled({J, 3}, [&](int64_t i) { return body.joint_template()(i / 3, i % 3); });
  out["joint_shapedirs"] = Filled({J, 3, B}, [&](int64_t i) { return body.joint_shapedirs()(i / B, i % B); });
  const Ragged influences(body.influence_begin()), correctives(d.posedirs.begin);
  const int64_t I = influences.width, C = correctives.width;
  out["influence_joint"] = Filled({V, I}, [&](int64_t i) {
    const int k = influences.At(i / I, i % I);
    return k >= 0 ? body.influence_joint()[k] : 0;
  });
  out["influence_weight"] = Filled({V, I}, [&](int64_t i) {
    const int k = influences.At(i / I, i % I);
    return k >= 0 ? body.influence_weight()[k] : 0.0;
  });
  out["corrective_joint"] = Filled({V, C}, [&](int64_t i) {
    const int k = correctives.At(i / C, i % C);
    return k >= 0 ? d.posedirs.joint[k] : 0;
  });
  out["corrective"] = Filled({V, C, 3, 9}, [&](int64_t i) {
    const int k = correctives.At(i / (27 * C), i / 27 % C);
    return k >= 0 ? double{d.posedirs.block[27 * static_cast<int64_t>(k) + i % 27]} : 0.0;
  });
  const Camera& camera = problem.layout.camera;
  const double intrinsics[4] = {camera.fx, camera.fy, camera.cx, camera.cy};
  out["camera"] = NdArray::FromDoubles(intrinsics, {4});
  out["kernel"] = NdArray::FromDouble(problem.frames[0].Get<DenseTerm>().kernel);
  out["acceleration_factors"] = Filled({std::max<int64_t>(0, T - 2), 2}, [&](int64_t i) {
    const int64_t t = i / 2 + 2;
    const AccelerationFactors f = AccelerationFactors::Of(problem.timestamps[t - 1] - problem.timestamps[t - 2],
                                                          problem.timestamps[t] - problem.timestamps[t - 1]);
    return i % 2 == 0 ? f.earlier : f.later;
  });
  const std::vector<double> joint_sigma = JointAccelerationSigma(problem);
  out["joint_inverse_sigma"] = Filled({J}, [&](int64_t j) { return 1 / joint_sigma[j]; });
  const std::array<double, 3> root = RootAccelerationSigma(problem);
  out["root_inverse_sigma"] = Filled({3}, [&](int64_t c) { return 1 / root[c]; });
  const MixturePrior& prior = *work.prior;
  const int64_t M = prior.num_components(), D = 3 * static_cast<int64_t>(prior.joints().size());
  out["prior_weight"] = NdArray::FromDouble(problem.frames[0].Get<PosePriorTerm>().weight);
  out["prior_joints"] = Filled({D / 3}, [&](int64_t i) { return prior.joints()[i]; });
  out["prior_means"] = Filled({M, D}, [&](int64_t i) { return prior.mean(static_cast<int>(i / D))[i % D]; });
  out["prior_offset"] = Filled({M}, [&](int64_t i) { return prior.offset(static_cast<int>(i)); });
  out["prior_sqrt"] = Filled(
      {M, D, D}, [&](int64_t i) { return prior.sqrt_precision(static_cast<int>(i / (D * D)))(i / D % D, i % D); });
  RowMatrixXd rows;
  Eigen::VectorXd offset;
  ShapePriorRows(problem, &rows, &offset);
  out["shape_rows"] = NdArray::FromDoubles(rows.data(), {rows.rows(), rows.cols()});
  out["shape_offset"] = NdArray::FromDoubles(offset.data(), {offset.size()});
  out["poses"] = Filled({T, J, 3}, [&](int64_t i) {
    return AxisAngleFromRotation(problem.states[i / (3 * J)].rotations[i / 3 % J])[i % 3];
  });
  out["trans"] = Filled({T, 3}, [&](int64_t i) { return problem.states[i / 3].translation[i % 3]; });
  out["betas"] = NdArray::FromDoubles(problem.betas.data(), {B});
  WriteNpz(path, out);
}

std::vector<PeerMoment> ReadPeerFile(const WorkProblem& work, const std::string& path) {
  const NpzArrays in = ReadNpz(path);
  const auto values = [&](const char* name) { return RequireArray(in, name, path).ToDoubles(); };
  const std::vector<double> seconds = values("seconds"), cpu_seconds = values("cpu_seconds"),
                            iterations = values("iterations"), poses = values("poses"), trans = values("trans"),
                            betas = values("betas");
  const size_t T = work.problem.states.size(), J = work.problem.states[0].rotations.size();
  const auto B = static_cast<size_t>(work.problem.betas.size());
  BODYLOOM_CHECK(poses.size() == seconds.size() * T * J * 3 && trans.size() == seconds.size() * T * 3 &&
                     betas.size() == seconds.size() * B && iterations.size() == seconds.size() &&
                     cpu_seconds.size() == seconds.size(),
                 path, ": sizes that do not fit the problem");
  std::vector<PeerMoment> moments;
  for (size_t m = 0; m < seconds.size(); ++m) {
    PeerMoment moment{seconds[m], cpu_seconds[m], static_cast<int>(iterations[m]), work.problem};
    for (size_t t = 0; t < T; ++t) {
      FrameState& state = moment.answer.states[t];
      for (size_t j = 0; j < J; ++j) {
        state.rotations[j] =
            RotationFromAxisAngle(Eigen::Map<const Eigen::Vector3d>(&poses[((m * T + t) * J + j) * 3]));
      }
      state.translation = Eigen::Map<const Eigen::Vector3d>(&trans[(m * T + t) * 3]);
    }
    moment.answer.betas = Eigen::Map<const Eigen::VectorXd>(&betas[m * B], static_cast<Eigen::Index>(B));
    moments.push_back(std::move(moment));
  }
  return moments;
}

}  // namespace bodyloom
