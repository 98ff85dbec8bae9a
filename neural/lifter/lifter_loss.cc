// SPDX-License-Identifier: Apache-2.0
#include "neural/lifter/lifter_loss.h"

#include <vector>

#include "geometry/scene/lifter_weights.h"

namespace bodyloom {
namespace {

using torch::Tensor;
using Slice = torch::indexing::Slice;

constexpr double kLogSigmaLow = -5, kLogSigmaHigh = 1;
constexpr double kTiny = 1e-6;  ///< under square roots, for a finite derivative at zero

Tensor Indices(std::span<const int> values) {
  return torch::tensor(std::vector<int64_t>(values.begin(), values.end()), torch::kLong);
}

/// Errors of B×T×…×5 predictions against B×T×…×3 truths (broadcast): negative log likelihood without its constant, and
/// distance, B×T×….
struct PointErrors {
  Tensor nll, distance;
};
PointErrors Errors(const Tensor& predicted, const Tensor& truth) {
  const Tensor d = predicted.slice(-1, 0, 3) - truth;
  const Tensor log_sigma = predicted.slice(-1, 3, 5).clamp(kLogSigmaLow, kLogSigmaHigh);
  const Tensor xy2 = d.slice(-1, 0, 2).square().sum(-1), z2 = d.select(-1, 2).square();
  const Tensor log_xy = log_sigma.select(-1, 0), log_z = log_sigma.select(-1, 1);
  const Tensor r = (xy2 * torch::exp(-2 * log_xy) + z2 * torch::exp(-2 * log_z) + kTiny).sqrt();
  return {r + 2 * log_xy + log_z, (xy2 + z2 + kTiny).sqrt()};
}

struct Limb {
  Tensor log_weight;  ///< B×T×M
  Tensor points;      ///< B×T×M×n×5
  Tensor truth;       ///< B×T×1×n×3, or undefined
};
Limb TakeLimb(const Tensor& y, int limb, const Tensor& truth) {
  const int64_t n = static_cast<int64_t>(LifterOutput::LimbPoints(limb).size()), M = LifterOutput::kHypotheses;
  const int logits = LifterOutput::LogitOffset(limb);
  Limb result;
  result.log_weight = torch::log_softmax(y.slice(-1, logits, logits + M), -1);
  const int first = LifterOutput::PointOffset(limb, 0, 0);
  result.points = y.slice(-1, first, first + M * n * LifterOutput::kPerPoint)
                      .reshape({y.size(0), y.size(1), M, n, LifterOutput::kPerPoint});
  if (truth.defined()) {
    result.truth = truth.index_select(2, Indices(LifterOutput::LimbPoints(limb))).unsqueeze(2);
  }
  return result;
}

Tensor TakeTorso(const Tensor& y) {
  const int64_t n = static_cast<int64_t>(LifterOutput::kTorso.size());
  return y.slice(-1, 0, n * LifterOutput::kPerPoint).reshape({y.size(0), y.size(1), n, LifterOutput::kPerPoint});
}

/// B×T×21×3 with torso landmarks in place and limbs from `choose` (B×T×M weights of one limb's hypotheses).
template <typename Choose>
Tensor Assemble(const Tensor& y, const Tensor& truth, const Choose& choose) {
  Tensor points = torch::zeros({y.size(0), y.size(1), LifterOutput::kPoints, 3}, y.options());
  points = points.index_copy(2, Indices(LifterOutput::kTorso), TakeTorso(y).slice(-1, 0, 3));
  for (int l = 0; l < LifterOutput::kLimbs; ++l) {
    const Limb limb = TakeLimb(y, l, truth);
    const Tensor weights = choose(limb);
    points = points.index_copy(2, Indices(LifterOutput::LimbPoints(l)),
                               (weights.unsqueeze(-1).unsqueeze(-1) * limb.points.slice(-1, 0, 3)).sum(2));
  }
  return points;
}

Tensor OneHot(const Tensor& index) { return torch::one_hot(index, LifterOutput::kHypotheses).to(torch::kFloat); }

}  // namespace

LifterLoss ComputeLifterLoss(const Tensor& output, const LifterTargets& targets, const LifterLossOptions& options) {
  const Tensor y = output.transpose(1, 2);  // B×T×outputs
  LifterLoss loss;
  // Torso: face with half weight, shoulders and hips with full weight.
  const PointErrors torso = Errors(TakeTorso(y), targets.points.index_select(2, Indices(LifterOutput::kTorso)));
  const Tensor torso_weight = torch::tensor({0.5F, 0.5F, 0.5F, 0.5F, 0.5F, 1.F, 1.F, 1.F, 1.F});
  Tensor distance = (torso.distance * torso_weight).sum(-1), nll = (torso.nll * torso_weight).sum(-1);
  double total_weight = 6.5;
  std::vector<Tensor> posterior;
  for (int l = 0; l < LifterOutput::kLimbs; ++l) {
    const Limb limb = TakeLimb(y, l, targets.points);
    const PointErrors errors = Errors(limb.points, limb.truth);
    const Tensor joint = limb.log_weight - errors.nll.sum(-1);  // B×T×M
    posterior.push_back(torch::softmax(joint.detach(), -1));
    nll = nll - 1.5 * torch::logsumexp(joint, -1);
    distance = distance + 1.5 * (posterior.back() * errors.distance.sum(-1)).sum(-1);
    total_weight += 1.5 * static_cast<double>(LifterOutput::LimbPoints(l).size());
  }
  distance = distance.mean() / total_weight;
  nll = nll.mean() / total_weight;
  int next = 0;
  const Tensor points = Assemble(y, {}, [&](const Limb&) { return posterior[next++]; });
  const Tensor slip =
      (points.slice(1, 1) - points.slice(1, 0, -1)) - (targets.points.slice(1, 1) - targets.points.slice(1, 0, -1));
  const Tensor velocity =
      slip.numel() > 0 ? (slip.square().sum(-1) + kTiny).sqrt().mean() : torch::zeros({}, y.options());
  const Tensor up_log_sigma = y.select(-1, LifterOutput::kUp + 3).clamp(kLogSigmaLow, kLogSigmaHigh);
  const Tensor up_error =
      ((y.slice(-1, LifterOutput::kUp, LifterOutput::kUp + 3) - targets.up).square().sum(-1) + kTiny).sqrt();
  const Tensor up = (up_error * torch::exp(-up_log_sigma) + up_log_sigma).mean();
  const Tensor contact = torch::binary_cross_entropy_with_logits(
      y.slice(-1, LifterOutput::kContact, LifterOutput::kContact + 2), targets.contact);
  loss.total = distance + options.nll_weight * nll + options.velocity_weight * velocity + 0.1 * up + 0.05 * contact;
  loss.distance = distance.item<double>();
  loss.nll = nll.item<double>();
  loss.velocity = velocity.item<double>();
  loss.up = up_error.mean().item<double>();
  loss.contact = contact.item<double>();
  return loss;
}

Tensor LikeliestPoints(const Tensor& output) {
  return Assemble(output.transpose(1, 2), {}, [](const Limb& limb) { return OneHot(limb.log_weight.argmax(-1)); });
}

Tensor NearestPoints(const Tensor& output, const Tensor& truth) {
  return Assemble(output.transpose(1, 2), truth,
                  [](const Limb& limb) { return OneHot(Errors(limb.points, limb.truth).distance.sum(-1).argmin(-1)); });
}

}  // namespace bodyloom
