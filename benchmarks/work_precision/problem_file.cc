// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/work_precision/problem_file.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "bodyloom/data_tools/body/builtin_body.h"
#include "bodyloom/data_tools/formats/npz.h"
#include "bodyloom/geometry/base/check.h"
#include "bodyloom/geometry/rotation.h"
#include "bodyloom/tracking/residuals/acceleration_cost.h"
#include "bodyloom/tracking/terms/dense/dense.h"
#include "bodyloom/tracking/terms/pose_prior/pose_prior.h"

namespace bodyloom {
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
