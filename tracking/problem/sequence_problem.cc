// SPDX-License-Identifier: Apache-2.0
#include "tracking/problem/sequence_problem.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "geometry/base/rate_gate.h"

namespace bodyloom {

using Eigen::VectorXd;

std::vector<double> JointLevers(const BodyModel& model) {
  std::vector<double> levers(model.num_joints(), 0.1);
  for (int j = 0; j < model.num_joints(); ++j) {
    for (int a : model.ancestors(j)) {
      levers[a] = std::max(levers[a], (model.joint_template().row(j) - model.joint_template().row(a)).norm());
    }
  }
  return levers;
}

double StatureOfMeanShape(const BodyModel& model, int num_betas, VectorXd* gradient) {
  Eigen::Index top, bottom;
  const double height =
      model.data().v_template.col(1).maxCoeff(&top) - model.data().v_template.col(1).minCoeff(&bottom);
  const RowMatrixXf& s = model.data().shapedirs;
  *gradient = (s.row(3 * top + 1).head(num_betas) - s.row(3 * bottom + 1).head(num_betas)).cast<double>().transpose();
  return height;
}

void ShapePriorRows(const SequenceProblem& problem, RowMatrixXd* A, VectorXd* b) {
  const int B = problem.layout.num_betas;
  VectorXd gradient;
  const double mean_height = StatureOfMeanShape(*problem.layout.model, B, &gradient);
  const double height = problem.shape_prior.height_m > 0 ? problem.shape_prior.height_m : mean_height;
  *A = RowMatrixXd::Identity(B + 1, B) * (std::sqrt(problem.shape_prior.weight) / problem.shape_prior.sigma);
  *b = VectorXd::Zero(B + 1);
  if (problem.shape_prior.mean.size() == B) *b = -*A * problem.shape_prior.mean;
  A->row(B) = gradient.transpose() / problem.shape_prior.height_sigma_m;
  (*b)[B] = (mean_height - height) / problem.shape_prior.height_sigma_m;
}

std::vector<SharedPrior> SharedPriors(const SequenceProblem& problem, const SharedValues& values) {
  std::vector<SharedPrior> priors;
  const FrameLayout& layout = problem.layout;
  if (layout.focal_column >= 0) {
    priors.push_back({"focal length prior", layout.focal_column, values.log_focal, problem.log_focal_prior,
                      problem.log_focal_sigma});
  }
  for (size_t v = 0; v < layout.views.size(); ++v) {
    const ViewLayout& view = layout.views[v];
    const ViewState& state = values.views[v];
    const std::string which = ", view " + std::to_string(v + 2);
    if (view.focal_column >= 0 && view.log_ratio_sigma > 0) {
      priors.push_back({"focal length as of view 1" + which, view.focal_column, state.log_focal - values.log_focal,
                        view.log_ratio_prior, view.log_ratio_sigma, layout.focal_column});
    } else if (view.focal_column >= 0) {
      priors.push_back({"focal length prior" + which, view.focal_column, state.log_focal, view.log_focal_prior,
                        view.log_focal_sigma});
    }
    if (view.clock_column >= 0) {
      const int column = view.clock_column;
      priors.push_back({"clock prior" + which, column, state.offset_s, view.offset_prior_s, view.offset_sigma_s});
      priors.push_back({"clock prior" + which, column + 1, state.rate, view.rate_prior, view.rate_sigma});
    }
  }
  return priors;
}

const Smoothness& SmoothnessOf(const SequenceProblem& problem, int shot) {
  return problem.smoothness[problem.smoothness.size() == 1 ? 0 : shot];
}

std::vector<double> JointAccelerationSigma(const SequenceProblem& problem, int shot) {
  const Smoothness& smooth = SmoothnessOf(problem, shot);
  std::vector<double> sigma = JointLevers(*problem.layout.model);
  for (size_t j = 0; j < sigma.size(); ++j) {
    sigma[j] = (smooth.of_joint.empty() ? smooth.tip_acceleration : smooth.of_joint[j]) / sigma[j];
  }
  return sigma;
}

std::array<double, 3> RootAccelerationSigma(const SequenceProblem& problem, int shot) {
  const Smoothness& smooth = SmoothnessOf(problem, shot);
  const double sigma = smooth.root_acceleration;
  const bool weak = problem.layout.knowledge == CameraKnowledge::kWeak;
  return {weak ? smooth.weak_scale_acceleration : sigma, sigma, sigma};
}

std::vector<double> JointVelocitySigma(const SequenceProblem& problem) {
  std::vector<double> sigma = JointLevers(*problem.layout.model);
  for (double& s : sigma) s = 1 / (s * std::sqrt(problem.velocity_weight));
  return sigma;
}

std::array<double, 3> RootVelocitySigma(const SequenceProblem& problem) {
  // A change of log scale is to one of place as their accelerations are.
  const Smoothness usual;
  const double sigma = 1 / std::sqrt(problem.velocity_weight);
  const bool weak = problem.layout.knowledge == CameraKnowledge::kWeak;
  return {weak ? sigma * usual.weak_scale_acceleration / usual.root_acceleration : sigma, sigma, sigma};
}

SequenceProblem SelectFrames(const SequenceProblem& problem, const std::vector<int>& frames) {
  SequenceProblem coarse;
  coarse.layout = problem.layout;
  static_cast<SharedValues&>(coarse) = problem;
  coarse.log_focal_prior = problem.log_focal_prior;
  coarse.log_focal_sigma = problem.log_focal_sigma;
  coarse.smoothness = problem.smoothness;
  coarse.velocity_weight = problem.velocity_weight;
  coarse.shape_prior = problem.shape_prior;
  int previous = -1;
  for (int t : frames) {
    coarse.frames.push_back(problem.frames[t]);
    coarse.states.push_back(problem.states[t]);
    coarse.timestamps.push_back(problem.timestamps[t]);
    bool cut = false;
    for (int u = previous + 1; u <= t; ++u) cut = cut || problem.cut_before[u];
    coarse.cut_before.push_back(cut);
    previous = t;
  }
  for (const FrameCoupling& coupling : problem.couplings) {
    FrameCoupling selected = coupling;
    bool all = true;
    for (int& t : selected.frames) {
      const auto at = std::lower_bound(frames.begin(), frames.end(), t);
      all = all && at != frames.end() && *at == t;
      t = static_cast<int>(at - frames.begin());
    }
    if (all) coarse.couplings.push_back(std::move(selected));
  }
  return coarse;
}

void SpreadFrames(const SequenceProblem& coarse, const std::vector<int>& frames, SequenceProblem* problem) {
  static_cast<SharedValues&>(*problem) = coarse;
  for (size_t i = 0; i < frames.size(); ++i) problem->states[frames[i]] = coarse.states[i];
  for (size_t i = 0; i + 1 < frames.size(); ++i) {
    if (coarse.cut_before[i + 1]) continue;
    const double t0 = problem->timestamps[frames[i]], t1 = problem->timestamps[frames[i + 1]];
    for (int t = frames[i] + 1; t < frames[i + 1]; ++t) {
      problem->states[t] =
          InterpolateStates(coarse.states[i], coarse.states[i + 1], (problem->timestamps[t] - t0) / (t1 - t0));
    }
  }
}

std::vector<int> FramesAtRate(const SequenceProblem& problem, double rate, const std::vector<char>& anchors) {
  std::vector<int> frames;
  const int T = static_cast<int>(problem.states.size());
  RateGate gate(rate);
  bool seeks_anchor = false;
  for (int t = 0; t < T; ++t) {
    const double time = problem.timestamps[t];
    if (t == 0 || problem.cut_before[t]) {
      gate = RateGate(rate);
      seeks_anchor = !anchors.empty();
    }
    const bool is_anchor = seeks_anchor && anchors[t] != 0, ends_shot = t + 1 == T || problem.cut_before[t + 1];
    seeks_anchor = seeks_anchor && !is_anchor;
    if (is_anchor) gate.Reset(time);
    if (is_anchor || gate.Passes(time) || ends_shot) frames.push_back(t);
  }
  return frames;
}

std::vector<int> ShotOfFrames(const std::vector<char>& cut_before) {
  std::vector<int> shot(cut_before.size(), 0);
  for (size_t t = 1; t < shot.size(); ++t) shot[t] = shot[t - 1] + (cut_before[t] != 0 ? 1 : 0);
  return shot;
}

}  // namespace bodyloom
