// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/work_precision/autodiff_peer.h"

#include <ceres/ceres.h>
#include <ceres/dynamic_autodiff_cost_function.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <set>
#include <utility>

#include "geometry/base/check.h"
#include "geometry/math/rotation.h"
#include "tests/tracking/jet_twin.h"
#include "tracking/solvers/residuals/acceleration_cost.h"
#include "tracking/solvers/residuals/ceres_functions.h"
#include "tracking/solvers/solve_sequence.h"
#include "tracking/terms/dense/dense.h"
#include "tracking/terms/initialiser.h"
#include "tracking/terms/joint_limits.h"
#include "tracking/terms/landmarks.h"
#include "tracking/terms/lifted/lifted_pose.h"
#include "tracking/terms/part_labels/part_label_term.h"
#include "tracking/terms/pose_prior/pose_prior.h"
#include "tracking/terms/rendered_uv/rendered_uv_term.h"
#include "tracking/terms/upright.h"

namespace bodyloom {
namespace {

constexpr int kStride = 16;  ///< derivatives a pass

template <typename T>
using Map3 = Eigen::Map<const twin::Vector3<T>>;

/// ρ(s) = c² s / (c² + s) with its first two derivatives.
class GemanMcClureLoss : public ceres::LossFunction {
 public:
  explicit GemanMcClureLoss(double c) : c2_(c * c) {}
  void Evaluate(double s, double rho[3]) const override {
    const double ratio = c2_ / (c2_ + s);
    rho[0] = s * ratio;
    rho[1] = ratio * ratio;
    rho[2] = -2 * ratio * ratio / (c2_ + s);
  }

 private:
  double c2_;
};

/// (π(x) − y) / σ of one keypoint. Blocks: the rotations of `joints`, translation, betas.
struct KeypointResidual {
  const BodyModel* model;
  const Camera* camera;
  const DenseKeypoint* keypoint;
  std::vector<int> joints;   ///< ascending, with all their ancestors
  std::vector<int> slot_of;  ///< J: place in `joints`
  int num_betas;

  template <typename T>
  bool operator()(T const* const* blocks, T* residual) const {
    const size_t n = joints.size();
    const T* betas = blocks[n + 1];
    std::vector<twin::Matrix3<T>> local(n), G(n);
    std::vector<twin::Vector3<T>> rest(n), p(n);
    for (size_t i = 0; i < n; ++i) {
      const int j = joints[i];
      local[i] = twin::Exp<T>(Map3<T>(blocks[i]));
      for (int c = 0; c < 3; ++c) {
        rest[i][c] = T(model->joint_template()(j, c));
        for (int b = 0; b < num_betas; ++b) rest[i][c] += model->joint_shapedirs()(3 * j + c, b) * betas[b];
      }
      if (j == 0) {
        G[i] = local[i];
        p[i] = rest[i] + Map3<T>(blocks[n]);
      } else {
        const int parent = slot_of[model->parents()[j]];
        G[i] = G[parent] * local[i];
        p[i] = p[parent] + G[parent] * (rest[i] - rest[parent]);
      }
    }
    const BodyModelData& d = model->data();
    const Eigen::Vector3d weights = keypoint->barycentric.cast<double>() / keypoint->barycentric.cast<double>().sum();
    twin::Vector3<T> x = twin::Vector3<T>::Zero();
    for (int corner = 0; corner < 3; ++corner) {
      const int v = d.faces(keypoint->face, corner);
      twin::Vector3<T> shaped;
      for (int c = 0; c < 3; ++c) {
        shaped[c] = T(d.v_template(v, c));
        for (int b = 0; b < num_betas; ++b) shaped[c] += double{d.shapedirs(3 * v + c, b)} * betas[b];
      }
      for (int k = d.posedirs.empty() ? 0 : d.posedirs.begin[v]; k < (d.posedirs.empty() ? 0 : d.posedirs.begin[v + 1]);
           ++k) {
        const twin::Matrix3<T>& R = local[slot_of[d.posedirs.joint[k]]];
        const float* block = &d.posedirs.block[27 * static_cast<size_t>(k)];
        for (int c = 0; c < 3; ++c) {
          for (int m = 0; m < 9; ++m) {
            shaped[c] += double{block[9 * c + m]} * (R(m / 3, m % 3) - T(m % 4 == 0 ? 1.0 : 0.0));
          }
        }
      }
      for (int e = model->influence_begin()[v]; e < model->influence_begin()[v + 1]; ++e) {
        const int i = slot_of[model->influence_joint()[e]];
        x += (G[i] * (shaped - rest[i]) + p[i]) * T(weights[corner] * model->influence_weight()[e]);
      }
    }
    if (x[2] < T(Camera::kMinDepth)) {  // saturates
      residual[0] = residual[1] = T(1e9);
      return true;
    }
    const Eigen::Matrix<T, 2, 1> pixel =
        twin::Project<T>(*camera, x, T(camera->fx), T(camera->fy), T(1.0), T(0.0), T(0.0));
    for (int c = 0; c < 2; ++c) residual[c] = (pixel[c] - double{keypoint->pixel[c]}) / double{keypoint->sigma_px};
    return true;
  }
};

/// Angular acceleration of one joint, of residuals/acceleration_cost.h.
struct RotationResidual {
  AccelerationFactors factors;
  double inverse_sigma;
  template <typename T>
  bool operator()(const T* a, const T* b, const T* c, T* residual) const {
    const twin::Matrix3<T> R0 = twin::Exp<T>(Map3<T>(a)), R1 = twin::Exp<T>(Map3<T>(b)), R2 = twin::Exp<T>(Map3<T>(c));
    Eigen::Map<twin::Vector3<T>> r(residual);
    r = (twin::Log<T>(R1.transpose() * R2) * T(factors.later) -
         twin::Log<T>(R0.transpose() * R1) * T(factors.earlier)) *
        T(inverse_sigma);
    return true;
  }
};

struct VectorResidual {
  AccelerationFactors factors;
  std::array<double, 3> sigma;
  template <typename T>
  bool operator()(const T* a, const T* b, const T* c, T* residual) const {
    for (int i = 0; i < 3; ++i) {
      residual[i] = (factors.later * (c[i] - b[i]) - factors.earlier * (b[i] - a[i])) / sigma[i];
    }
    return true;
  }
};

double ValueOf(double x) { return x; }
template <typename T, int N>
T ValueOf(const ceres::Jet<T, N>& x) {
  return x.a;
}

/// The nearest component of the pose prior. Blocks: the prior's joints.
struct PriorResidual {
  const MixturePrior* prior;
  double root_weight;
  template <typename T>
  bool operator()(T const* const* blocks, T* residual) const {
    const auto D = static_cast<Eigen::Index>(3 * prior->joints().size());
    Eigen::Matrix<T, Eigen::Dynamic, 1> x(D);
    Eigen::VectorXd value(D);
    for (Eigen::Index i = 0; i < D; ++i) value[i] = ValueOf(x[i] = blocks[i / 3][i % 3]);
    double energy = 0;
    const int k = prior->Nearest(value, &energy);
    for (Eigen::Index i = 0; i < D; ++i) x[i] -= prior->mean(k)[i];
    const Eigen::MatrixXd& L = prior->sqrt_precision(k);
    for (Eigen::Index i = 0; i < D; ++i) {
      residual[i] = T(0.0);
      for (Eigen::Index j = i; j < D; ++j) residual[i] += root_weight * L(i, j) * x[j];
    }
    residual[D] = T(root_weight * std::sqrt(prior->offset(k)));
    return true;
  }
};

/// Joints that move a keypoint, with all their ancestors, ascending.
std::vector<int> JointsOf(const BodyModel& model, const DenseKeypoint& keypoint) {
  std::set<int> joints;
  const BodyModelData& d = model.data();
  const auto add = [&](int j) { joints.insert(model.ancestors(j).begin(), model.ancestors(j).end()); };
  for (int corner = 0; corner < 3; ++corner) {
    const int v = d.faces(keypoint.face, corner);
    for (int e = model.influence_begin()[v]; e < model.influence_begin()[v + 1]; ++e) add(model.influence_joint()[e]);
    if (d.posedirs.empty()) continue;
    for (int k = d.posedirs.begin[v]; k < d.posedirs.begin[v + 1]; ++k) add(d.posedirs.joint[k]);
  }
  return {joints.begin(), joints.end()};
}

/// The unknowns as Ceres sees them.
struct Blocks {
  std::vector<double> rotations, translations;
  int joints;
  double* Rotation(size_t t, int j) { return &rotations[3 * (t * joints + j)]; }
  double* Translation(size_t t) { return &translations[3 * t]; }
};

void AddKeypoints(const SequenceProblem& problem, size_t t, double* betas, Blocks* x, ceres::Problem* target) {
  const BodyModel& model = *problem.layout.model;
  for (const DenseKeypoint& keypoint : *problem.frames[t].Get<DenseTerm>().points) {
    auto residual = std::make_unique<KeypointResidual>();
    residual->model = &model;
    residual->camera = &problem.layout.camera;
    residual->keypoint = &keypoint;
    residual->num_betas = problem.layout.num_betas;
    residual->joints = JointsOf(model, keypoint);
    residual->slot_of.assign(model.num_joints(), -1);
    std::vector<double*> blocks;
    for (int j : residual->joints) {
      residual->slot_of[j] = static_cast<int>(blocks.size());
      blocks.push_back(x->Rotation(t, j));
    }
    blocks.push_back(x->Translation(t));
    blocks.push_back(betas);
    auto* cost = new ceres::DynamicAutoDiffCostFunction<KeypointResidual, kStride>(residual.release());
    for (size_t i = 0; i + 1 < blocks.size(); ++i) cost->AddParameterBlock(3);
    cost->AddParameterBlock(problem.layout.num_betas);
    cost->SetNumResiduals(2);
    target->AddResidualBlock(cost, new GemanMcClureLoss(problem.frames[t].Get<DenseTerm>().kernel), blocks);
  }
}

void AddPrior(const SequenceProblem& problem, size_t t, Blocks* x, ceres::Problem* target) {
  const FrameData& frame = problem.frames[t];
  const PosePriorTerm& prior = frame.Get<PosePriorTerm>();
  if (prior.mixture == nullptr || prior.mixture->empty()) return;
  auto* cost = new ceres::DynamicAutoDiffCostFunction<PriorResidual, kStride>(
      new PriorResidual{prior.mixture.get(), std::sqrt(prior.weight)});
  std::vector<double*> blocks;
  for (int j : prior.mixture->joints()) {
    blocks.push_back(x->Rotation(t, j));
    cost->AddParameterBlock(3);
  }
  cost->SetNumResiduals(static_cast<int>(3 * blocks.size()) + 1);
  target->AddResidualBlock(cost, nullptr, blocks);
}

void AddSmoothness(const SequenceProblem& problem, size_t t, Blocks* x, ceres::Problem* target) {
  const AccelerationFactors factors = AccelerationFactors::Of(problem.timestamps[t - 1] - problem.timestamps[t - 2],
                                                              problem.timestamps[t] - problem.timestamps[t - 1]);
  const std::vector<double> joint_sigma = JointAccelerationSigma(problem);
  for (int j = 0; j < x->joints; ++j) {
    target->AddResidualBlock(new ceres::AutoDiffCostFunction<RotationResidual, 3, 3, 3, 3>(
                                 new RotationResidual{factors, 1 / joint_sigma[j]}),
                             nullptr, x->Rotation(t - 2, j), x->Rotation(t - 1, j), x->Rotation(t, j));
  }
  target->AddResidualBlock(new ceres::AutoDiffCostFunction<VectorResidual, 3, 3, 3, 3>(
                               new VectorResidual{factors, RootAccelerationSigma(problem)}),
                           nullptr, x->Translation(t - 2), x->Translation(t - 1), x->Translation(t));
}

void Check(const SequenceProblem& problem) {
  const FrameLayout& layout = problem.layout;
  bool plain = layout.knowledge == CameraKnowledge::kKnown && layout.num_betas > 0 &&
               static_cast<int>(layout.active_joints.size()) == layout.model->num_joints() &&
               std::find(problem.cut_before.begin(), problem.cut_before.end(), 1) == problem.cut_before.end();
  for (const FrameData& frame : problem.frames) {
    plain = plain && frame.Get<DenseTerm>().points != nullptr && frame.Get<DenseTerm>().whitening.empty() &&
            frame.Get<LandmarkTerm>().seen.empty() && frame.Get<RenderedUvTerm>().term == nullptr &&
            frame.Get<PartLabelTerm>().matches == nullptr && frame.Get<LiftedPoseTerm>().pose == nullptr &&
            frame.Get<JointLimitTerm>().limits == nullptr && frame.Get<UprightTerm>().weight == 0 &&
            frame.Get<InitialiserTerm>().weight == 0;
  }
  BODYLOOM_CHECK(plain, "the AutoDiff peer states dense keypoints, pose prior, shape prior and accelerations only");
}

}  // namespace

SolveReport SolveWithAutoDiff(SequenceProblem* problem, const SolveOptions& options) {
  Check(*problem);
  const size_t T = problem->states.size();
  Blocks x;
  x.joints = problem->layout.model->num_joints();
  for (const FrameState& state : problem->states) {
    for (const Eigen::Matrix3d& R : state.rotations) {
      const Eigen::Vector3d w = AxisAngleFromRotation(R);
      x.rotations.insert(x.rotations.end(), w.data(), w.data() + 3);
    }
    x.translations.insert(x.translations.end(), state.translation.data(), state.translation.data() + 3);
  }
  Eigen::VectorXd betas = problem->betas;
  ceres::Problem target;
  for (size_t t = 0; t < T; ++t) {
    AddKeypoints(*problem, t, betas.data(), &x, &target);
    AddPrior(*problem, t, &x, &target);
    if (t >= 2) AddSmoothness(*problem, t, &x, &target);
  }
  RowMatrixXd A;
  Eigen::VectorXd b;
  ShapePriorRows(*problem, &A, &b);
  target.AddResidualBlock(new LinearCost(A, b), nullptr, betas.data());

  ceres::Solver::Options solver;
  solver.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  solver.sparse_linear_algebra_library_type = ceres::SUITE_SPARSE;
  solver.max_num_iterations = options.max_iterations;
  solver.num_threads = options.num_threads;
  solver.function_tolerance = options.function_tolerance;
  solver.gradient_tolerance = options.gradient_tolerance;
  solver.parameter_tolerance = options.parameter_tolerance;
  solver.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  const SerialOpenMp no_threads_in_the_factorisation;
  ceres::Solve(solver, &target, &summary);

  SolveReport report;
  report.status = !summary.IsSolutionUsable()                      ? SolveStatus::kFailure
                  : summary.termination_type == ceres::CONVERGENCE ? SolveStatus::kConverged
                                                                   : SolveStatus::kMaxIterations;
  report.iterations = static_cast<int>(summary.iterations.size());
  report.initial_cost = summary.initial_cost;
  report.final_cost = summary.final_cost;
  report.seconds = summary.total_time_in_seconds;
  report.message = summary.message;
  for (size_t t = 0; t < T; ++t) {
    for (int j = 0; j < x.joints; ++j) {
      problem->states[t].rotations[j] = RotationFromAxisAngle(Eigen::Map<const Eigen::Vector3d>(x.Rotation(t, j)));
    }
    problem->states[t].translation = Eigen::Map<const Eigen::Vector3d>(x.Translation(t));
  }
  problem->betas = betas;
  return report;
}

}  // namespace bodyloom
