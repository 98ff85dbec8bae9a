// SPDX-License-Identifier: Apache-2.0
#include "data_tools/learned/pose_prior_io.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "data_tools/formats/npz.h"

namespace bodyloom {
namespace {

constexpr double kDensityStep = 1.0 / 16;

NdArray PackDensity(const RowMatrixXf& density) {
  std::vector<uint8_t> packed(density.size());
  for (Eigen::Index i = 0; i < density.size(); ++i) {
    packed[i] = static_cast<uint8_t>(std::clamp(std::lround(density.data()[i] / kDensityStep) + 128L, 0L, 255L));
  }
  return NdArray::FromUInt8(packed.data(), {density.rows(), density.cols()});
}

RowMatrixXf UnpackDensity(const NpzArrays& arrays, const std::string& name, const std::string& where) {
  const NdArray& array = RequireArray(arrays, name, where);
  if (array.dtype != DType::kU8 || array.shape.size() != 2 || array.shape[0] != array.shape[1] || array.shape[0] < 2 ||
      array.shape[0] > 4096) {
    throw std::runtime_error(where + ": " + name + " is " + array.ShapeText() +
                             ", expected a square array of unsigned bytes");
  }
  const std::vector<float> values = array.ToFloats();
  RowMatrixXf density(array.shape[0], array.shape[1]);
  for (Eigen::Index i = 0; i < density.size(); ++i) {
    density.data()[i] = (values[i] - 128) * static_cast<float>(kDensityStep);
  }
  return density;
}

}  // namespace

void WritePosePrior(const std::string& path, const PosePrior& prior) {
  const int K = prior.num_components(), D = prior.dim();
  std::vector<float> covariance;
  for (const Eigen::MatrixXd& C : prior.covariances) {
    for (int r = 0; r < D; ++r) {
      for (int c = r; c < D; ++c) covariance.push_back(static_cast<float>(C(r, c)));
    }
  }
  const RowMatrixXf means = prior.means.cast<float>();
  const Eigen::VectorXf log_weights = prior.log_weights.cast<float>();
  NpzArrays arrays;
  arrays["joints"] = NdArray::FromStrings(prior.joints);
  arrays["log_weights"] = NdArray::FromFloats(log_weights.data(), {K});
  arrays["means"] = NdArray::FromFloats(means.data(), {K, D});
  arrays["covariance_upper"] = NdArray::FromFloats(covariance.data(), {K, D * (D + 1) / 2});
  arrays["arm_log_density"] = PackDensity(prior.arm_log_density);
  arrays["leg_log_density"] = PackDensity(prior.leg_log_density);
  WriteNpz(path, arrays);
}

namespace {

PosePrior FromArrays(const NpzArrays& arrays, const std::string& where) {
  PosePrior prior;
  prior.joints = RequireArray(arrays, "joints", where).ToStrings();
  const NdArray& means = RequireArray(arrays, "means", where);
  const NdArray& covariances = RequireArray(arrays, "covariance_upper", where);
  const NdArray& log_weights = RequireArray(arrays, "log_weights", where);
  const int64_t D = prior.dim(), K = log_weights.num_elements();
  if (D == 0 || K == 0 || means.shape != std::vector<int64_t>{K, D} ||
      covariances.shape != std::vector<int64_t>{K, D * (D + 1) / 2}) {
    throw std::runtime_error(where + ": means is " + means.ShapeText() + " and covariance_upper " +
                             covariances.ShapeText() + ", expected KxD and KxD(D+1)/2 with K = " + std::to_string(K) +
                             " and D = 3 joints = " + std::to_string(D));
  }
  const std::vector<double> weights = log_weights.ToDoubles(), packed = covariances.ToDoubles();
  prior.log_weights = Eigen::Map<const Eigen::VectorXd>(weights.data(), K);
  prior.means = means.ToMatrix();
  size_t next = 0;
  for (int64_t k = 0; k < K; ++k) {
    Eigen::MatrixXd C(D, D);
    for (int64_t r = 0; r < D; ++r) {
      for (int64_t c = r; c < D; ++c) C(r, c) = C(c, r) = packed[next++];
    }
    if (!C.allFinite() || Eigen::LLT<Eigen::MatrixXd>(C).info() != Eigen::Success) {
      throw std::runtime_error(where + ": covariance of component " + std::to_string(k) + " is not positive definite");
    }
    prior.covariances.push_back(std::move(C));
  }
  if (!prior.means.allFinite() || !prior.log_weights.allFinite()) {
    throw std::runtime_error(where + ": means or log_weights hold NaN or infinite values");
  }
  prior.arm_log_density = UnpackDensity(arrays, "arm_log_density", where);
  prior.leg_log_density = UnpackDensity(arrays, "leg_log_density", where);
  if (prior.arm_log_density.rows() != prior.leg_log_density.rows()) {
    throw std::runtime_error(where + ": arm and leg densities have different numbers of directions");
  }
  prior.num_directions = static_cast<int>(prior.arm_log_density.rows());
  return prior;
}

}  // namespace

PosePrior ReadPosePriorBytes(const std::string& bytes, const std::string& where) {
  return FromArrays(ReadNpzBytes(bytes, where), where);
}

PosePrior ReadPosePrior(const std::string& path) { return FromArrays(ReadNpz(path), path); }

}  // namespace bodyloom

// Made by bodyloom_embed() in data_tools/CMakeLists.txt.
extern "C" {
extern const char bodyloom_pose_prior_begin[], bodyloom_pose_prior_end[];
}

namespace bodyloom {

const PosePrior& BuiltinPosePrior() {
  static const PosePrior prior = ReadPosePriorBytes(std::string(bodyloom_pose_prior_begin, bodyloom_pose_prior_end),
                                                    "assets/prior/pose_prior.npz (built in)");
  return prior;
}

}  // namespace bodyloom
