// SPDX-License-Identifier: Apache-2.0
#include "render/lighting/fit_lighting.h"

#include <ceres/loss_function.h>
#include <ceres/normal_prior.h>
#include <ceres/problem.h>
#include <ceres/solver.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <memory>

#include "geometry/base/check.h"

namespace bodyloom {
namespace {

constexpr size_t kFewest = 50;
constexpr double kTukey = 4.685;  // 95 % efficient on Gaussian residuals
constexpr double kHuber = 1.345;  // the same
constexpr double kAlbedoGauge = 1e3;

struct Sample {
  ShVector basis;
  double light;
  int label;
};

double Median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

std::vector<Sample> UsableSamples(const MatrixX3d& normals, std::span<const double> light,
                                  std::span<const uint8_t> labels, const FitLightingOptions& options, int* left_out) {
  std::vector<size_t> usable;
  for (size_t i = 0; i < light.size(); ++i) {
    const double length = normals.row(Eigen::Index(i)).norm();
    if (std::isfinite(light[i]) && std::isfinite(length) && length > 0) usable.push_back(i);
  }
  *left_out = static_cast<int>(light.size() - usable.size());
  const size_t count = std::min(usable.size(), size_t(options.max_samples));
  std::vector<Sample> samples;
  samples.reserve(count);
  for (size_t k = 0; k < count; ++k) {
    const size_t i = usable[k * usable.size() / count];
    const Eigen::Vector3d n = normals.row(Eigen::Index(i)).normalized();
    samples.push_back({ShBasis(n), light[i], labels.empty() ? 0 : labels[i]});
  }
  return samples;
}

class Fit {
 public:
  Fit(std::vector<Sample> samples, const FitLightingOptions& options, FitLightingResult* result)
      : samples_(std::move(samples)), options_(options), result_(*result) {}

  void Run() {
    FitLightingSummary& summary = result_.summary;
    summary.samples = static_cast<int>(samples_.size());
    if (samples_.size() < kFewest) return;
    Eigen::Matrix<double, 9, 9> information = Eigen::Matrix<double, 9, 9>::Zero();
    for (const Sample& s : samples_) information += s.basis * s.basis.transpose();
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(information, Eigen::EigenvaluesOnly);
    summary.spread = std::max(0.0, eigen.eigenvalues()[0]) / eigen.eigenvalues()[8];
    summary.status = FitLightingStatus::kNormalsTooAlike;
    if (!(summary.spread >= options_.min_spread)) return;
    summary.status = FitLightingStatus::kDark;
    if (!Start(information)) return;
    // The scale of the first kernel is that of the initial residuals; the second's is re-estimated.
    Solve(std::make_unique<ceres::HuberLoss>(kHuber));
    const bool converged = Solve(std::make_unique<ceres::TukeyLoss>(kTukey));
    Normalise();
    summary.status = converged ? FitLightingStatus::kConverged : FitLightingStatus::kNotConverged;
    Describe();
  }

 private:
  /// Initialises albedos from the medians of the labels, then the light by least squares. False when there is no light.
  bool Start(const Eigen::Matrix<double, 9, 9>& information) {
    std::vector<std::vector<double>> by_label;
    for (const Sample& s : samples_) {
      if (size_t(s.label) >= by_label.size()) by_label.resize(s.label + 1);
      by_label[s.label].push_back(s.light);
    }
    std::vector<double> all;
    for (const Sample& s : samples_) all.push_back(s.light);
    median_ = Median(all);
    if (!(median_ > 0)) return false;
    for (const auto& lights : by_label) {
      // A nearly black label would have no weight in the light; it starts a little brighter.
      result_.albedo.push_back(lights.empty() ? 0 : std::max(0.05, Median(lights) / median_));
      share_.push_back(double(lights.size()) / double(samples_.size()));
    }
    ShVector right = ShVector::Zero();
    for (const Sample& s : samples_) right += s.basis * (s.light / result_.albedo[s.label]);
    Eigen::Matrix<double, 9, 9> held = information;
    held.diagonal().tail<8>().array() += options_.ridge * options_.ridge * double(samples_.size());
    result_.coefficients = held.ldlt().solve(right);
    Normalise();
    return true;
  }

  /// Scales the albedos to mean 1 and the light by the inverse factor.
  void Normalise() {
    double mean = 0;
    for (size_t l = 0; l < share_.size(); ++l) mean += share_[l] * result_.albedo[l];
    if (!(mean > 0)) return;
    for (double& a : result_.albedo) a /= mean;
    result_.coefficients *= mean;
  }

  [[nodiscard]] double Residual(const Sample& s) const {
    return result_.albedo[s.label] * result_.coefficients.dot(s.basis) - s.light;
  }

  void MeasureSigma() {
    std::vector<double> sizes;
    double brightest = 0;
    for (const Sample& s : samples_) {
      sizes.push_back(std::abs(Residual(s)));
      brightest = std::max(brightest, std::abs(s.light));
    }
    // A lower bound of the scale for a fit without error: below it the kernels would reject residuals due to the ridge.
    const double minimum = std::max(1e-6 * brightest, options_.ridge * median_);
    result_.summary.sigma = std::max(1.4826 * Median(sizes), minimum);
  }

  bool Solve(std::unique_ptr<ceres::LossFunction> loss) {
    MeasureSigma();
    ceres::Problem::Options problem_options;
    problem_options.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    ceres::Problem problem(problem_options);
    double* coefficients = result_.coefficients.data();
    for (const Sample& s : samples_) {
      problem.AddResidualBlock(new ShadedAlbedoCost(s.basis, s.light, result_.summary.sigma), loss.get(), coefficients,
                               &result_.albedo[s.label]);
    }
    AddGauge(&problem);
    AddRidge(&problem);
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::DENSE_NORMAL_CHOLESKY;
    options.max_num_iterations = options_.max_iterations;
    options.num_threads = 1;
    options.logging_type = ceres::SILENT;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem, &summary);
    result_.summary.iterations += static_cast<int>(summary.iterations.size()) - 1;
    return summary.termination_type == ceres::CONVERGENCE;
  }

  /// Adds the gauge on the mean albedo; with a single label the albedo is held constant instead.
  void AddGauge(ceres::Problem* problem) {
    if (std::count_if(share_.begin(), share_.end(), [](double s) { return s > 0; }) == 1) {
      for (size_t l = 0; l < share_.size(); ++l) {
        if (share_[l] > 0) problem->SetParameterBlockConstant(&result_.albedo[l]);
      }
      return;
    }
    std::vector<double*> blocks;
    std::vector<double> weights;
    for (size_t l = 0; l < share_.size(); ++l) {
      if (share_[l] == 0) continue;
      blocks.push_back(&result_.albedo[l]);
      weights.push_back(kAlbedoGauge * share_[l]);
    }
    problem->AddResidualBlock(new MeanAlbedoCost(weights), nullptr, blocks);
  }

  void AddRidge(ceres::Problem* problem) {
    const double weight = options_.ridge * std::sqrt(double(samples_.size())) / result_.summary.sigma;
    RowMatrixXd A = RowMatrixXd::Identity(9, 9) * weight;
    A(0, 0) = 0;
    problem->AddResidualBlock(new ceres::NormalPrior(A, Eigen::VectorXd::Zero(9)), nullptr,
                              result_.coefficients.data());
  }

  /// Σ_l w_l (a_l − 1).
  class MeanAlbedoCost : public ceres::CostFunction {
   public:
    explicit MeanAlbedoCost(std::vector<double> weights) : weights_(std::move(weights)) {
      set_num_residuals(1);
      mutable_parameter_block_sizes()->assign(weights_.size(), 1);
    }
    bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override {
      residuals[0] = 0;
      for (size_t l = 0; l < weights_.size(); ++l) {
        residuals[0] += weights_[l] * (parameters[l][0] - 1);
        if (jacobians != nullptr && jacobians[l] != nullptr) jacobians[l][0] = weights_[l];
      }
      return true;
    }

   private:
    std::vector<double> weights_;
  };

  void Describe() {
    FitLightingSummary& summary = result_.summary;
    MeasureSigma();
    int negative = 0, outliers = 0;
    summary.min_shading = INFINITY;
    for (const Sample& s : samples_) {
      const double shading = result_.coefficients.dot(s.basis);
      negative += shading < 0;
      outliers += std::abs(Residual(s)) > kTukey * summary.sigma;
      summary.min_shading = std::min(summary.min_shading, shading);
      summary.mean_shading += shading / double(samples_.size());
    }
    summary.negative_share = negative / double(samples_.size());
    summary.outlier_share = outliers / double(samples_.size());
  }

  std::vector<Sample> samples_;
  const FitLightingOptions& options_;
  FitLightingResult& result_;
  double median_ = 0;          ///< of the light
  std::vector<double> share_;  ///< of the samples, by label
};

}  // namespace

std::string ToString(FitLightingStatus status) {
  switch (status) {
    case FitLightingStatus::kConverged:
      return "converged";
    case FitLightingStatus::kNotConverged:
      return "not converged";
    case FitLightingStatus::kTooFewSamples:
      return "too few samples";
    case FitLightingStatus::kNormalsTooAlike:
      return "normals too alike";
    case FitLightingStatus::kDark:
      return "dark";
  }
  return "unknown";
}

bool ShadedAlbedoCost::Evaluate(double const* const* parameters, double* residuals, double** jacobians) const {
  const Eigen::Map<const ShVector> coefficients(parameters[0]);
  const double albedo = parameters[1][0], shading = coefficients.dot(basis_);
  residuals[0] = (albedo * shading - light_) / sigma_;
  if (jacobians == nullptr) return true;
  if (jacobians[0] != nullptr) {
    Eigen::Map<ShVector> by_coefficients(jacobians[0]);
    by_coefficients = albedo / sigma_ * basis_;
  }
  if (jacobians[1] != nullptr) jacobians[1][0] = shading / sigma_;
  return true;
}

FitLightingResult FitLighting(const MatrixX3d& normals, std::span<const double> light, std::span<const uint8_t> labels,
                              const FitLightingOptions& options) {
  BODYLOOM_CHECK(size_t(normals.rows()) == light.size(), "lighting: ", normals.rows(), " normals and ", light.size(),
                 " values of light");
  BODYLOOM_CHECK(labels.empty() || labels.size() == light.size(), "lighting: ", labels.size(), " labels and ",
                 light.size(), " values of light");
  BODYLOOM_CHECK(options.max_samples > 0 && options.max_iterations > 0, "lighting: options must be positive");
  FitLightingResult result;
  std::vector<Sample> samples = UsableSamples(normals, light, labels, options, &result.summary.left_out);
  Fit(std::move(samples), options, &result).Run();
  return result;
}

}  // namespace bodyloom
