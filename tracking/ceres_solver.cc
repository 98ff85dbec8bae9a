// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/tracking/ceres_solver.h"

#include <ceres/ceres.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "bodyloom/geometry/rotation.h"
#include "bodyloom/tracking/residuals/acceleration_cost.h"
#include "bodyloom/tracking/residuals/compressed_frame_cost.h"
#include "bodyloom/tracking/residuals/linear_cost.h"
#include "bodyloom/tracking/residuals/rotation_manifold.h"
#include "bodyloom/tracking/residuals/velocity_cost.h"
#include "bodyloom/tracking/serial_openmp.h"
#include "bodyloom/tracking/terms/own/neighbours_cost.h"

namespace bodyloom {

using Eigen::VectorXd;

namespace {

class IterationCallback : public ceres::IterationCallback {
 public:
  explicit IterationCallback(const std::function<bool(int, double)>& f) : f_(f) {}
  ceres::CallbackReturnType operator()(const ceres::IterationSummary& s) override {
    return f_(s.iteration, s.cost) ? ceres::SOLVER_CONTINUE : ceres::SOLVER_TERMINATE_SUCCESSFULLY;
  }

 private:
  const std::function<bool(int, double)>& f_;
};

/// The flat parameter memory Ceres works on.
struct Parameters {
  std::vector<double> rotations;     ///< T × A × 3
  std::vector<double> translations;  ///< T × 3
  VectorXd betas;
  double log_focal;
  int num_active;
  double* Rotation(size_t t, size_t a) { return &rotations[3 * (t * num_active + a)]; }
  double* Translation(size_t t) { return &translations[3 * t]; }
};

Parameters Pack(const SequenceProblem& problem) {
  Parameters x;
  x.num_active = static_cast<int>(problem.layout.active_joints.size());
  for (const FrameState& state : problem.states) {
    for (int j : problem.layout.active_joints) {
      const Eigen::Vector3d w = AxisAngleFromRotation(state.rotations[j]);
      x.rotations.insert(x.rotations.end(), w.data(), w.data() + 3);
    }
    x.translations.insert(x.translations.end(), state.translation.data(), state.translation.data() + 3);
  }
  x.betas = problem.betas;
  x.log_focal = problem.log_focal;
  return x;
}

void Unpack(Parameters& x, SequenceProblem* problem) {
  for (size_t t = 0; t < problem->states.size(); ++t) {
    FrameState& state = problem->states[t];
    for (int a = 0; a < x.num_active; ++a) {
      state.rotations[problem->layout.active_joints[a]] =
          RotationFromAxisAngle(Eigen::Map<const Eigen::Vector3d>(x.Rotation(t, a)));
    }
    state.translation = Eigen::Map<const Eigen::Vector3d>(x.Translation(t));
  }
  problem->betas = x.betas;
  problem->log_focal = x.log_focal;
}

void AddSmoothness(const SequenceProblem& problem, Parameters* x, ceres::Problem* ceres_problem) {
  const std::vector<int> shot = ShotOfFrames(problem.cut_before);
  std::vector<double> joint_sigma;
  std::array<double, 3> root_sigma{};
  for (size_t t = 2; t < problem.states.size(); ++t) {
    if (joint_sigma.empty() || shot[t] != shot[t - 1]) {
      joint_sigma = JointAccelerationSigma(problem, shot[t]);
      root_sigma = RootAccelerationSigma(problem, shot[t]);
    }
    if (problem.cut_before[t] || problem.cut_before[t - 1]) continue;
    const double dt0 = problem.timestamps[t - 1] - problem.timestamps[t - 2];
    const double dt1 = problem.timestamps[t] - problem.timestamps[t - 1];
    for (int a = 0; a < x->num_active; ++a) {
      const double sigma = joint_sigma[problem.layout.active_joints[a]];
      ceres_problem->AddResidualBlock(new RotationAccelerationCost(dt0, dt1, sigma), nullptr, x->Rotation(t - 2, a),
                                      x->Rotation(t - 1, a), x->Rotation(t, a));
    }
    ceres_problem->AddResidualBlock(new VectorAccelerationCost(dt0, dt1, root_sigma.data()), nullptr,
                                    x->Translation(t - 2), x->Translation(t - 1), x->Translation(t));
  }
}

void AddVelocities(const SequenceProblem& problem, Parameters* x, ceres::Problem* ceres_problem) {
  if (problem.velocity_weight <= 0) return;
  const std::vector<double> joint_sigma = JointVelocitySigma(problem);
  const std::array<double, 3> root_sigma = RootVelocitySigma(problem);
  for (size_t t = 1; t < problem.states.size(); ++t) {
    if (problem.cut_before[t]) continue;
    const double dt = problem.timestamps[t] - problem.timestamps[t - 1];
    for (int a = 0; a < x->num_active; ++a) {
      ceres_problem->AddResidualBlock(new RotationVelocityCost(dt, joint_sigma[problem.layout.active_joints[a]]),
                                      nullptr, x->Rotation(t - 1, a), x->Rotation(t, a));
    }
    ceres_problem->AddResidualBlock(new VectorVelocityCost(dt, root_sigma.data()), nullptr, x->Translation(t - 1),
                                    x->Translation(t));
  }
}

void AddSharedPriors(const SequenceProblem& problem, Parameters* x, ceres::Problem* ceres_problem) {
  if (problem.layout.num_betas > 0) {
    RowMatrixXd A;
    VectorXd b;
    ShapePriorRows(problem, &A, &b);
    ceres_problem->AddResidualBlock(new LinearCost(A, b), nullptr, x->betas.data());
  }
  if (problem.layout.focal_column >= 0) {
    RowMatrixXd A(1, 1);
    A(0, 0) = 1 / problem.log_focal_sigma;
    ceres_problem->AddResidualBlock(
        new LinearCost(A, VectorXd::Constant(1, -problem.log_focal_prior / problem.log_focal_sigma)), nullptr,
        &x->log_focal);
  }
}

/// Users' own cost functions on neighbouring frames. Their states hold the rotations of joints that are not active.
void AddNeighbours(const SequenceProblem& problem, Parameters* x, ceres::Problem* ceres_problem) {
  for (size_t t = 0; t < problem.frames.size(); ++t) {
    if (!HasCostsWithNext(problem, t)) continue;
    std::vector<double*> blocks;
    for (size_t u = t; u <= t + 1; ++u) {
      for (int a = 0; a < x->num_active; ++a) blocks.push_back(x->Rotation(u, a));
      blocks.push_back(x->Translation(u));
    }
    if (problem.layout.num_betas > 0) blocks.push_back(x->betas.data());
    for (const OwnCost& cost : problem.frames[t].own.with_next) {
      ceres_problem->AddResidualBlock(
          new NeighboursCost(cost, problem.layout, problem.states[t], problem.states[t + 1]), cost.loss.get(), blocks);
    }
  }
}

SolveStatus StatusOf(const ceres::Solver::Summary& summary) {
  switch (summary.termination_type) {
    case ceres::CONVERGENCE:
      return SolveStatus::kConverged;
    case ceres::NO_CONVERGENCE:
      return SolveStatus::kMaxIterations;
    case ceres::USER_SUCCESS:
      return SolveStatus::kStopped;
    default:
      return SolveStatus::kFailure;
  }
}

}  // namespace

SolveReport SolveWithCeres(SequenceProblem* problem, const SolveOptions& options) {
  const size_t T = problem->states.size();
  Parameters x = Pack(*problem);
  ceres::Problem::Options problem_options;
  problem_options.manifold_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  problem_options.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  FrameBatch batch(options.num_threads);
  problem_options.evaluation_callback = &batch;
  problem_options.disable_all_safety_checks = true;
  ceres::Problem ceres_problem(problem_options);
  RotationManifold manifold;
  for (size_t t = 0; t < T; ++t) {
    std::vector<double*> blocks;
    for (int a = 0; a < x.num_active; ++a) {
      ceres_problem.AddParameterBlock(x.Rotation(t, a), 3, &manifold);
      blocks.push_back(x.Rotation(t, a));
    }
    ceres_problem.AddParameterBlock(x.Translation(t), 3);
    blocks.push_back(x.Translation(t));
    if (problem->layout.num_betas > 0) blocks.push_back(x.betas.data());
    if (problem->layout.focal_column >= 0) blocks.push_back(&x.log_focal);
    auto cost = std::make_unique<CompressedFrameCost>(problem->layout, problem->frames[t], problem->states[t]);
    ceres_problem.AddResidualBlock(batch.Add(std::move(cost), blocks), nullptr, blocks);
  }
  AddSmoothness(*problem, &x, &ceres_problem);
  AddVelocities(*problem, &x, &ceres_problem);
  AddSharedPriors(*problem, &x, &ceres_problem);
  AddNeighbours(*problem, &x, &ceres_problem);
  if (options.shape_constant && problem->layout.num_betas > 0) ceres_problem.SetParameterBlockConstant(x.betas.data());
  if (options.focal_constant && problem->layout.focal_column >= 0) {
    ceres_problem.SetParameterBlockConstant(&x.log_focal);
  }

  ceres::Solver::Options solver;
  solver.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  solver.sparse_linear_algebra_library_type = ceres::SUITE_SPARSE;
  solver.max_num_iterations = options.max_iterations;
  solver.num_threads = 1;  // FrameBatch has the threads
  solver.function_tolerance = options.function_tolerance;
  solver.gradient_tolerance = options.gradient_tolerance;
  solver.parameter_tolerance = options.parameter_tolerance;
  solver.logging_type = ceres::SILENT;
  std::unique_ptr<IterationCallback> callback;
  if (options.on_iteration) {
    callback = std::make_unique<IterationCallback>(options.on_iteration);
    solver.callbacks.push_back(callback.get());
  }
  ceres::Solver::Summary summary;
  const SerialOpenMp no_threads_in_the_factorisation;
  ceres::Solve(solver, &ceres_problem, &summary);
  SolveReport report;
  report.status = StatusOf(summary);
  report.iterations = static_cast<int>(summary.iterations.size());
  report.initial_cost = summary.initial_cost;
  report.final_cost = summary.final_cost;
  report.seconds = summary.total_time_in_seconds;
  report.message = summary.message;
  report.seconds_evaluation = summary.residual_evaluation_time_in_seconds + summary.jacobian_evaluation_time_in_seconds;
  report.seconds_linear_solver = summary.linear_solver_time_in_seconds;
  if (summary.IsSolutionUsable()) Unpack(x, problem);
  return report;
}

}  // namespace bodyloom
