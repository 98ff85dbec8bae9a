// SPDX-License-Identifier: Apache-2.0
#include "geometry/body/body_model.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "geometry/base/check.h"

namespace bodyloom {
namespace {

constexpr double kSumTolerance = 1e-3;

/// Checks that the stored rows sum to 1 and makes the sums exact.
void NormaliseRows(const char* what, SparseRows* rows) {
  rows->makeCompressed();
  for (int r = 0; r < rows->rows(); ++r) {
    double sum = 0;
    for (SparseRows::InnerIterator it(*rows, r); it; ++it) {
      BODYLOOM_CHECK(it.col() >= 0 && it.col() < rows->cols(), "body: row ", r, " of ", what, " names column ",
                     it.col(), ", expected 0..", rows->cols() - 1);
      sum += it.value();
    }
    BODYLOOM_CHECK(std::abs(sum - 1) <= kSumTolerance, "body: row ", r, " of ", what, " sums to ", sum, ", expected 1");
    for (SparseRows::InnerIterator it(*rows, r); it; ++it) it.valueRef() /= sum;
  }
}

void CheckSizes(const BodyModelData& d) {
  const auto V = d.v_template.rows();
  const auto J = static_cast<Eigen::Index>(d.parents.size());
  BODYLOOM_CHECK(V > 0, "body: v_template is empty");
  BODYLOOM_CHECK(J > 0, "body: no joints (parents is empty)");
  BODYLOOM_CHECK(d.v_template.allFinite(), "body: v_template holds NaN or infinite values");
  BODYLOOM_CHECK(d.shapedirs.rows() == 3 * V || d.shapedirs.cols() == 0, "body: shapedirs has ", d.shapedirs.rows(),
                 " rows, expected 3V = ", 3 * V);
  BODYLOOM_CHECK(d.shapedirs.allFinite(), "body: shapedirs holds NaN or infinite values");
  BODYLOOM_CHECK(d.J_regressor.rows() == J && d.J_regressor.cols() == V, "body: J_regressor is ", d.J_regressor.rows(),
                 "x", d.J_regressor.cols(), ", expected JxV = ", J, "x", V);
  BODYLOOM_CHECK(d.weights.rows() == V && d.weights.cols() == J, "body: weights is ", d.weights.rows(), "x",
                 d.weights.cols(), ", expected VxJ = ", V, "x", J);
  for (Eigen::Index j = 0; j < J; ++j) {
    const int parent = d.parents[j];
    BODYLOOM_CHECK(j == 0 ? parent == -1 : (parent >= 0 && parent < j), "body: parent of joint ", j, " is ", parent,
                   ", expected ", j == 0 ? "-1" : "an earlier joint");
  }
  BODYLOOM_CHECK(d.joint_names.empty() || static_cast<Eigen::Index>(d.joint_names.size()) == J,
                 "body: ", d.joint_names.size(), " joint names for ", J, " joints");
  BODYLOOM_CHECK(d.pose_mean.size() == 0 || d.pose_mean.size() == 3 * J, "body: pose_mean has ", d.pose_mean.size(),
                 " values, expected 3J = ", 3 * J);
  BODYLOOM_CHECK(d.pose_mean.allFinite(), "body: pose_mean holds NaN or infinite values");
}

void CheckIndices(const BodyModelData& d) {
  const int V = static_cast<int>(d.v_template.rows());
  const auto F = d.faces.rows();
  if (F > 0) {
    BODYLOOM_CHECK(d.faces.minCoeff() >= 0 && d.faces.maxCoeff() < V, "body: a face names vertex ",
                   d.faces.minCoeff() < 0 ? d.faces.minCoeff() : d.faces.maxCoeff(), ", expected 0..", V - 1);
  }
  if (d.ft.rows() > 0) {
    BODYLOOM_CHECK(d.ft.rows() == F, "body: ft has ", d.ft.rows(), " faces, expected ", F);
    BODYLOOM_CHECK(d.ft.minCoeff() >= 0 && d.ft.maxCoeff() < d.vt.rows(), "body: ft names UV vertex ",
                   d.ft.minCoeff() < 0 ? d.ft.minCoeff() : d.ft.maxCoeff(), ", expected 0..", d.vt.rows() - 1);
    BODYLOOM_CHECK(d.vt.allFinite(), "body: vt holds NaN or infinite values");
  }
  BODYLOOM_CHECK(d.face_part.empty() || static_cast<Eigen::Index>(d.face_part.size()) == F, "body: face_part has ",
                 d.face_part.size(), " entries, expected ", F);
  BODYLOOM_CHECK(d.face_iuv.rows() == 0 || (d.face_iuv.rows() == F && d.face_iuv.cols() == 6), "body: face_iuv is ",
                 d.face_iuv.rows(), "x", d.face_iuv.cols(), ", expected ", F, "x6");
  BODYLOOM_CHECK(d.face_iuv.allFinite(), "body: face_iuv holds NaN or infinite values");
  for (const Landmark& landmark : d.landmarks) {
    BODYLOOM_CHECK(!landmark.vertices.empty() && landmark.vertices.size() == landmark.weights.size(),
                   "body: landmark '", landmark.name, "' has ", landmark.vertices.size(), " vertices and ",
                   landmark.weights.size(), " weights");
    for (int v : landmark.vertices) {
      BODYLOOM_CHECK(v >= 0 && v < V, "body: landmark '", landmark.name, "' names vertex ", v, ", expected 0..", V - 1);
    }
    const double sum = std::accumulate(landmark.weights.begin(), landmark.weights.end(), 0.0);
    BODYLOOM_CHECK(std::abs(sum - 1) <= kSumTolerance, "body: the weights of landmark '", landmark.name, "' sum to ",
                   sum, ", expected 1");
  }
  const PoseCorrectives& p = d.posedirs;
  if (p.begin.empty()) {
    BODYLOOM_CHECK(p.joint.empty() && p.block.empty(), "body: pose correctives without vertex offsets");
    return;
  }
  const int J = static_cast<int>(d.parents.size());
  BODYLOOM_CHECK(static_cast<int>(p.begin.size()) == V + 1 && p.begin.front() == 0 &&
                     p.begin.back() == static_cast<int>(p.joint.size()) &&
                     std::is_sorted(p.begin.begin(), p.begin.end()),
                 "body: pose correctives' offsets do not match ", V, " vertices and ", p.joint.size(), " blocks");
  BODYLOOM_CHECK(p.block.size() == 27 * p.joint.size(), "body: pose correctives hold ", p.block.size(),
                 " values, expected ", 27 * p.joint.size());
  for (int j : p.joint)
    BODYLOOM_CHECK(j >= 1 && j < J, "body: a pose corrective names joint ", j, ", expected 1..", J - 1);
  BODYLOOM_CHECK(std::all_of(p.block.begin(), p.block.end(), [](float x) { return std::isfinite(x); }),
                 "body: posedirs holds NaN or infinite values");
}

}  // namespace

BodyModel::BodyModel(BodyModelData data) : data_(std::move(data)) {
  CheckSizes(data_);
  CheckIndices(data_);
  NormaliseRows("J_regressor", &data_.J_regressor);
  NormaliseRows("weights", &data_.weights);
  if (data_.joint_names.empty()) {
    for (int j = 0; j < num_joints(); ++j) {
      data_.joint_names.push_back(j < static_cast<int>(SmplJointNames().size()) ? SmplJointNames()[j]
                                                                                : "joint_" + std::to_string(j));
    }
  }
  joint_template_ = data_.J_regressor * data_.v_template;
  joint_shapedirs_.setZero(3 * num_joints(), num_betas());
  for (int j = 0; num_betas() > 0 && j < num_joints(); ++j) {
    for (SparseRows::InnerIterator it(data_.J_regressor, j); it; ++it) {
      joint_shapedirs_.middleRows<3>(3 * j) += it.value() * data_.shapedirs.middleRows<3>(3 * it.col()).cast<double>();
    }
  }
  influence_begin_.push_back(0);
  for (int v = 0; v < num_vertices(); ++v) {
    for (SparseRows::InnerIterator it(data_.weights, v); it; ++it) {
      if (it.value() == 0) continue;
      influence_joint_.push_back(static_cast<int>(it.col()));
      influence_weight_.push_back(it.value());
    }
    influence_begin_.push_back(static_cast<int>(influence_joint_.size()));
  }
  ancestors_.resize(num_joints());
  for (int j = 0; j < num_joints(); ++j) {
    if (j > 0) ancestors_[j] = ancestors_[data_.parents[j]];
    ancestors_[j].push_back(j);
  }
}

MatrixX3d BodyModel::RestJoints(const Eigen::VectorXd& betas) const {
  BODYLOOM_CHECK(betas.size() <= num_betas(), "betas has ", betas.size(), " values, the body '", name(), "' takes ",
                 num_betas());
  MatrixX3d joints = joint_template_;
  if (betas.size() > 0) {
    const Eigen::VectorXd offset = joint_shapedirs_.leftCols(betas.size()) * betas;
    for (int j = 0; j < num_joints(); ++j) joints.row(j) += offset.segment<3>(3 * j).transpose();
  }
  return joints;
}

int BodyModel::FindJoint(const std::string& name) const {
  const auto it = std::find(data_.joint_names.begin(), data_.joint_names.end(), name);
  return it == data_.joint_names.end() ? -1 : static_cast<int>(it - data_.joint_names.begin());
}

int BodyModel::FindLandmark(const std::string& name) const {
  for (size_t i = 0; i < data_.landmarks.size(); ++i) {
    if (data_.landmarks[i].name == name) return static_cast<int>(i);
  }
  return -1;
}

const std::vector<std::string>& SmplJointNames() {
  static const std::vector<std::string> names = {
      "pelvis",     "l_hip",      "r_hip",   "spine1",  "l_knee",  "r_knee",   "spine2",   "l_ankle",
      "r_ankle",    "spine3",     "l_foot",  "r_foot",  "neck",    "l_collar", "r_collar", "head",
      "l_shoulder", "r_shoulder", "l_elbow", "r_elbow", "l_wrist", "r_wrist",  "l_hand",   "r_hand"};
  return names;
}

const std::vector<int>& SmplParents() {
  static const std::vector<int> parents = {-1, 0, 0, 0,  1,  2,  3,  4,  5,  6,  7,  8,
                                           9,  9, 9, 12, 13, 14, 16, 17, 18, 19, 20, 21};
  return parents;
}

PoseCorrectives PoseCorrectivesFromDense(const float* posedirs, int num_vertices, int num_joints, float threshold) {
  PoseCorrectives result;
  const size_t columns = 9 * static_cast<size_t>(num_joints - 1);
  result.begin.push_back(0);
  for (int v = 0; v < num_vertices; ++v) {
    for (int j = 1; j < num_joints; ++j) {
      float block[27];
      bool keep = false;
      for (int c = 0; c < 3; ++c) {
        for (int k = 0; k < 9; ++k) {
          const float x = posedirs[(3 * static_cast<size_t>(v) + c) * columns + 9 * (j - 1) + k];
          block[9 * c + k] = x;
          keep = keep || !(std::abs(x) <= threshold);
        }
      }
      if (!keep) continue;
      result.joint.push_back(j);
      result.block.insert(result.block.end(), block, block + 27);
    }
    result.begin.push_back(static_cast<int>(result.joint.size()));
  }
  if (result.joint.empty()) result.begin.clear();
  return result;
}

}  // namespace bodyloom
