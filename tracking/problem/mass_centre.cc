// SPDX-License-Identifier: Apache-2.0
#include "tracking/problem/mass_centre.h"

#include <Eigen/QR>
#include <map>
#include <vector>

#include "geometry/base/parallel.h"
#include "geometry/body/centre_of_mass.h"

namespace bodyloom {

using Eigen::Matrix3Xd;

CompiledPoint CompileCentreOfMass(const BodyModel& model, int num_betas) {
  const Eigen::VectorXd mass = MassByJoint(model);
  if (mass.size() == 0) return {};
  const SparseRows& regressor = model.data().J_regressor;
  std::map<int, double> share;
  for (int j = 0; j < model.num_joints(); ++j) {
    for (SparseRows::InnerIterator it(regressor, j); it; ++it) {
      share[static_cast<int>(it.col())] += mass[j] * it.value();
    }
  }
  std::vector<int> vertices;
  std::vector<double> weights;
  for (const auto& [vertex, weight] : share) {
    vertices.push_back(vertex);
    weights.push_back(weight);
  }
  return CompilePoint(model, vertices, weights, num_betas);
}

Matrix3Xd CentresOfMass(const SequenceProblem& problem, const CompiledPoint& centre_of_mass, int num_threads) {
  const int T = static_cast<int>(problem.states.size());
  Matrix3Xd centres(3, T);
  ParallelFor(T, num_threads, [&](int t) {
    thread_local Kinematics kinematics;
    thread_local PointEvaluator points;
    const FrameState& state = problem.states[t];
    kinematics.Set(*problem.layout.model, problem.betas, state.rotations, Eigen::Vector3d::Zero(), false);
    centres.col(t) = points.Evaluate(kinematics, centre_of_mass, false) + problem.layout.BodyPlace(state);
  });
  return centres;
}

CentreMotion MotionAround(const SequenceProblem& problem, const Matrix3Xd& centres, int t) {
  int first = t, last = t;
  const std::vector<double>& at = problem.timestamps;
  constexpr double kHalf = kCentreWindowS + 1e-9;  // rounding of timestamps
  const int T = static_cast<int>(at.size());
  while (first > 0 && problem.cut_before[first] == 0 && at[t] - at[first - 1] <= kHalf) --first;
  while (last + 1 < T && problem.cut_before[last + 1] == 0 && at[last + 1] - at[t] <= kHalf) ++last;
  return MotionOver(problem, centres, first, last, t);
}

CentreMotion MotionOver(const SequenceProblem& problem, const Matrix3Xd& centres, int first, int last, int t) {
  const std::vector<double>& at = problem.timestamps;
  const int n = last - first + 1;
  if (n < 3) return {};
  Eigen::MatrixX3d powers(n, 3);
  for (int k = 0; k < n; ++k) {
    const double s = at[first + k] - at[t];
    powers.row(k) << 1, s, s * s;
  }
  const Eigen::Matrix3d parabola = powers.colPivHouseholderQr().solve(centres.middleCols(first, n).transpose().eval());
  return {true, parabola.row(0).transpose(), 2 * parabola.row(2).transpose()};
}

}  // namespace bodyloom
