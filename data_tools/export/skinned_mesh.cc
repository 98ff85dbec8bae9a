// SPDX-License-Identifier: Apache-2.0
#include "data_tools/export/skinned_mesh.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "geometry/base/check.h"
#include "geometry/body/normals.h"

namespace bodyloom {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr int kBasisFrames = 256, kJudgedFrames = 64;

/// Corners with equal position and UV become one vertex.
void SplitSeams(const BodyModelData& body, SkinnedMesh* mesh) {
  const bool has_uv = body.ft.rows() == body.faces.rows() && body.ft.rows() > 0;
  std::map<std::pair<int, int>, int> index;
  std::vector<int> uv_vertex;
  // The body's vertices first and in order, so that a mesh without seams is the body's.
  mesh->faces.resize(body.faces.rows(), 3);
  std::vector<int> first_uv(body.v_template.rows(), -1);
  for (Eigen::Index f = 0; has_uv && f < body.faces.rows(); ++f) {
    for (int k = 0; k < 3; ++k) {
      if (first_uv[body.faces(f, k)] < 0) first_uv[body.faces(f, k)] = body.ft(f, k);
    }
  }
  for (int v = 0; v < body.v_template.rows(); ++v) {
    index[{v, first_uv[v]}] = v;
    mesh->body_vertex.push_back(v);
    uv_vertex.push_back(first_uv[v]);
  }
  for (Eigen::Index f = 0; f < body.faces.rows(); ++f) {
    for (int k = 0; k < 3; ++k) {
      const std::pair<int, int> key(body.faces(f, k), has_uv ? body.ft(f, k) : -1);
      const auto [it, fresh] = index.try_emplace(key, static_cast<int>(mesh->body_vertex.size()));
      if (fresh) {
        mesh->body_vertex.push_back(key.first);
        uv_vertex.push_back(key.second);
      }
      mesh->faces(f, k) = it->second;
    }
  }
  if (!has_uv) return;
  mesh->uv = MatrixX2f::Zero(static_cast<Eigen::Index>(uv_vertex.size()), 2);
  for (size_t i = 0; i < uv_vertex.size(); ++i) {
    if (uv_vertex[i] >= 0) mesh->uv.row(static_cast<Eigen::Index>(i)) = body.vt.row(uv_vertex[i]);
  }
}

void ReduceInfluences(const BodyModel& body, SkinnedMesh* mesh) {
  std::vector<std::array<int, kSkinInfluences>> joints(body.num_vertices());
  std::vector<std::array<float, kSkinInfluences>> weights(body.num_vertices());
  for (int v = 0; v < body.num_vertices(); ++v) {
    std::vector<std::pair<double, int>> all;
    for (int i = body.influence_begin()[v]; i < body.influence_begin()[v + 1]; ++i) {
      if (body.influence_weight()[i] > 0) all.emplace_back(-body.influence_weight()[i], body.influence_joint()[i]);
    }
    std::sort(all.begin(), all.end());
    mesh->reduced_vertices += all.size() > kSkinInfluences;
    all.resize(std::min<size_t>(all.size(), kSkinInfluences));
    double sum = 0;
    for (const auto& [weight, joint] : all) sum -= weight;
    float rest = 1;  // the largest weight absorbs the rounding error
    for (size_t k = all.size(); k-- > 1;) {
      joints[v][k] = all[k].second;
      weights[v][k] = static_cast<float>(-all[k].first / sum);
      rest -= weights[v][k];
    }
    joints[v][0] = all.empty() ? 0 : all[0].second;
    weights[v][0] = rest;
  }
  for (const int v : mesh->body_vertex) {
    mesh->joints.push_back(joints[v]);
    mesh->weights.push_back(weights[v]);
  }
}

/// vec_rowmajor(R_j − I), j ≥ 1.
VectorXd PoseFeatures(const BodyPose& pose) {
  VectorXd features(9 * (static_cast<Eigen::Index>(pose.rotations.size()) - 1));
  for (size_t j = 1; j < pose.rotations.size(); ++j) {
    Eigen::Matrix<double, 3, 3, Eigen::RowMajor> d = pose.rotations[j] - Eigen::Matrix3d::Identity();
    features.segment<9>(9 * (static_cast<Eigen::Index>(j) - 1)) = Eigen::Map<Eigen::Matrix<double, 9, 1>>(d.data());
  }
  return features;
}

/// The body's posedirs as one matrix, 3V × 9(J−1).
Eigen::MatrixXf DenseCorrectives(const BodyModel& body) {
  const PoseCorrectives& blocks = body.data().posedirs;
  Eigen::MatrixXf dense = Eigen::MatrixXf::Zero(3 * body.num_vertices(), 9 * (body.num_joints() - 1));
  for (int v = 0; v < body.num_vertices(); ++v) {
    for (int k = blocks.begin[v]; k < blocks.begin[v + 1]; ++k) {
      dense.block<3, 9>(3 * v, 9 * (blocks.joint[k] - 1)) =
          Eigen::Map<const Eigen::Matrix<float, 3, 9, Eigen::RowMajor>>(blocks.block.data() + 27 * size_t(k));
    }
  }
  return dense;
}

/// Principal components of the correctives over the person's frames.
void AddShapes(const ExportPerson& person, int num_shapes, SkinnedMesh* mesh) {
  const BodyModel& body = *person.body;
  const auto T = static_cast<Eigen::Index>(person.poses.size());
  mesh->shape_weights.resize(T, 0);
  if (body.data().posedirs.empty()) return;
  const Eigen::MatrixXf P = DenseCorrectives(body);
  MatrixXd features(T, P.cols());
  for (Eigen::Index t = 0; t < T; ++t) features.row(t) = PoseFeatures(person.poses[size_t(t)]).transpose();
  const Eigen::RowVectorXd mean = features.colwise().mean();
  features.rowwise() -= mean;
  const VectorXd mean_shape = (P * mean.transpose().cast<float>()).cast<double>();
  for (size_t i = 0; i < mesh->body_vertex.size(); ++i) {
    mesh->positions.row(Eigen::Index(i)) += mean_shape.segment<3>(3 * mesh->body_vertex[i]).transpose();
  }
  // Of the sample's Gram matrix F G Fᵀ, G = PᵀP: component k is P Fᵀ u_k / σ_k.
  const std::vector<int> sample = SpreadFrames(static_cast<int>(T), kBasisFrames);
  MatrixXd F(static_cast<Eigen::Index>(sample.size()), features.cols());
  for (size_t i = 0; i < sample.size(); ++i) F.row(Eigen::Index(i)) = features.row(sample[i]);
  const MatrixXd G = (P.transpose() * P).cast<double>();
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(F * G * F.transpose());
  const Eigen::Index last = F.rows() - 1;
  for (int k = 0; k < num_shapes && k <= last; ++k) {
    const double square = solver.eigenvalues()[last - k];
    // Components below a micrometre (root mean square over vertices and frames) are dropped.
    if (!(square > 1e-12 * double(F.rows()) * body.num_vertices())) break;
    VectorXd direction = F.transpose() * solver.eigenvectors().col(last - k) / std::sqrt(square);
    VectorXd weights = features * (G * direction);
    const double low = weights.minCoeff(), range = weights.maxCoeff() - low;
    if (!(range > 0)) break;
    const VectorXd shape = (P * direction.cast<float>()).cast<double>();
    MatrixX3f& rows = mesh->shapes.emplace_back(static_cast<Eigen::Index>(mesh->body_vertex.size()), 3);
    for (size_t i = 0; i < mesh->body_vertex.size(); ++i) {
      const Vector3d d = shape.segment<3>(3 * mesh->body_vertex[i]);
      rows.row(Eigen::Index(i)) = (range * d).cast<float>().transpose();
      mesh->positions.row(Eigen::Index(i)) += low * d.transpose();
    }
    mesh->shape_weights.conservativeResize(T, mesh->shapes.size());
    mesh->shape_weights.col(mesh->shape_weights.cols() - 1) = ((weights.array() - low) / range).cwiseMax(0).cwiseMin(1);
  }
}

void Judge(const ExportPerson& person, SkinnedMesh* mesh) {
  const BodyModel& body = *person.body;
  double sum = 0;
  int64_t count = 0;
  for (const int t : SpreadFrames(static_cast<int>(person.poses.size()), kJudgedFrames)) {
    const BodyPose& pose = person.poses[t];
    const MatrixX3d truth = PoseVertices(body, person.betas, pose);
    const PosedSkeleton skeleton = PoseSkeleton(body, person.rest_joints, pose);
    for (int v = 0; v < body.num_vertices(); ++v) {  // body_vertex begins with the body's own
      Vector3d rest = mesh->positions.row(v).transpose();
      for (size_t k = 0; k < mesh->shapes.size(); ++k) {
        rest += mesh->shape_weights(t, Eigen::Index(k)) * mesh->shapes[k].row(v).transpose().cast<double>();
      }
      Vector3d posed = Vector3d::Zero();
      for (int k = 0; k < kSkinInfluences; ++k) {
        const int j = mesh->joints[v][k];
        posed += mesh->weights[v][k] * (skeleton.world_rotations[j] * (rest - person.rest_joints.row(j).transpose()) +
                                        skeleton.joints.row(j).transpose());
      }
      const double error = (posed - truth.row(v).transpose()).norm();
      mesh->max_error_m = std::max(mesh->max_error_m, error);
      sum += error * error;
      ++count;
    }
  }
  mesh->rms_error_m = std::sqrt(sum / double(count));
}

}  // namespace

std::vector<int> SpreadFrames(int n, int maximum) {
  std::vector<int> frames;
  const int count = std::min(n, maximum);
  frames.reserve(size_t(std::max(count, 0)));
  for (int i = 0; i < count; ++i)
    frames.push_back(count < 2 ? 0 : static_cast<int>(int64_t{i} * (n - 1) / (count - 1)));
  return frames;
}

void SkinSummary::AddPerson(double rms_of_person_m, double max_of_person_m, size_t shapes_of_person) {
  const double n = people++;
  rms_error_m = std::sqrt((n * std::pow(rms_error_m, 2) + std::pow(rms_of_person_m, 2)) / (n + 1));
  max_error_m = std::max(max_error_m, max_of_person_m);
  shapes += static_cast<int>(shapes_of_person);
}

SkinnedMesh MakeSkinnedMesh(const ExportPerson& person, int num_shapes) {
  BODYLOOM_CHECK(num_shapes >= 0 && num_shapes <= kMaxShapes, "skinned mesh: ", num_shapes, " shapes, expected 0 to ",
                 kMaxShapes);
  const BodyModel& body = *person.body;
  SkinnedMesh mesh;
  SplitSeams(body.data(), &mesh);
  ReduceInfluences(body, &mesh);
  const MatrixX3d shaped = ShapeVertices(body, person.betas);
  const MatrixX3f normals = VertexNormals(shaped, body.data().faces);
  const auto n = static_cast<Eigen::Index>(mesh.body_vertex.size());
  mesh.positions.resize(n, 3);
  mesh.normals.resize(n, 3);
  for (Eigen::Index i = 0; i < n; ++i) {
    mesh.positions.row(i) = shaped.row(mesh.body_vertex[size_t(i)]);
    mesh.normals.row(i) = normals.row(mesh.body_vertex[size_t(i)]);
    if (!(mesh.normals.row(i).norm() > 0.5F)) mesh.normals.row(i) = Eigen::RowVector3f::UnitY();
  }
  AddShapes(person, num_shapes, &mesh);
  Judge(person, &mesh);
  return mesh;
}

}  // namespace bodyloom
