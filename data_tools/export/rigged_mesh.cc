// SPDX-License-Identifier: Apache-2.0
#include "data_tools/export/rigged_mesh.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <functional>
#include <span>

#include "data_tools/export/skinned_mesh.h"
#include "geometry/base/check.h"
#include "geometry/body/normals.h"
#include "geometry/body/skinning.h"

namespace bodyloom {
namespace {

using Eigen::Matrix3d;
using Eigen::MatrixXf;
using Eigen::RowVectorXf;
using Eigen::Vector3d;
using Eigen::VectorXf;

constexpr int kShapeFrames = 256, kErrorFrames = 64;
constexpr size_t kFramesAtOnce = 32;
/// A blend of rotations with a smaller determinant has no useful inverse: its joints are turned against each other.
constexpr double kMinDeterminant = 0.2;
/// Components below a micrometre (root mean square over vertices and frames) are dropped.
constexpr double kMinComponent_m = 1e-6;

/// Affine motions of the joints, and blends of them by the vertices' weights.
class JointBlend {
 public:
  /// From `joints_before`, with rotations `before` in the world, to `joints_after` with `after`.
  JointBlend(const BodyModel& body, const std::vector<Matrix3d>& before, const MatrixX3d& joints_before,
             const std::vector<Matrix3d>& after, const MatrixX3d& joints_after)
      : body_(body) {
    for (int j = 0; j < body.num_joints(); ++j) {
      linear_.emplace_back(after[size_t(j)] * before[size_t(j)].transpose());
      offset_.emplace_back(joints_after.row(j).transpose() - linear_.back() * joints_before.row(j).transpose());
    }
  }
  void At(int vertex, Matrix3d* linear, Vector3d* offset) const {
    linear->setZero();
    offset->setZero();
    for (int i = body_.influence_begin()[vertex]; i < body_.influence_begin()[vertex + 1]; ++i) {
      const auto j = size_t(body_.influence_joint()[i]);
      *linear += body_.influence_weight()[i] * linear_[j];
      *offset += body_.influence_weight()[i] * offset_[j];
    }
  }

 private:
  const BodyModel& body_;
  std::vector<Matrix3d> linear_;
  std::vector<Vector3d> offset_;
};

Vector3d VertexOf(std::span<const double> vertices, int v) {
  return Eigen::Map<const Vector3d>(vertices.data() + size_t(3) * size_t(v));
}

/// A person's vertices, posed by the body and taken back to the rig's rest pose.
class MeshAtRest {
 public:
  MeshAtRest(const ExportPerson& person, const RigSkeleton& rig)
      : person_(person),
        rig_(rig),
        joints_(rig.RestPositions(*person.body, person.rest_joints)),
        skinner_(*person.body),
        shaped_(skinner_.Shape(person.betas)),
        rest_from_t_pose_(*person.body, std::vector<Matrix3d>(rig.rest_rotations.size(), Matrix3d::Identity()),
                          person.rest_joints, rig.rest_rotations, joints_) {}

  [[nodiscard]] const MatrixX3d& joints() const { return joints_; }

  /// Calls visit(i, the body's vertices (3V) in frame frames[i]) for each i in order.
  void VisitPosed(const std::vector<int>& frames,
                  const std::function<void(Eigen::Index, std::span<const double>)>& visit) const {
    const size_t size = size_t(3) * size_t(person_.body->num_vertices());
    std::vector<double> posed(size * kFramesAtOnce);
    std::vector<BodyPose> poses;
    for (size_t begin = 0; begin < frames.size(); begin += kFramesAtOnce) {
      const size_t count = std::min(kFramesAtOnce, frames.size() - begin);
      poses.clear();
      for (size_t i = 0; i < count; ++i) poses.push_back(person_.poses[size_t(frames[begin + i])]);
      skinner_.Skin(shaped_, poses, std::span(posed).first(size * count));
      for (size_t i = 0; i < count; ++i) {
        visit(static_cast<Eigen::Index>(begin + i), std::span<const double>(posed).subspan(size * i, size));
      }
    }
  }

  /// Motion from the rest pose to a frame.
  [[nodiscard]] JointBlend BlendAt(int t) const {
    const PosedSkeleton skeleton = PoseSkeleton(*person_.body, person_.rest_joints, person_.poses[size_t(t)]);
    return {*person_.body, rig_.rest_rotations, joints_, skeleton.world_rotations, skeleton.joints};
  }

  /// Posed vertices taken back to rest, 3V.
  [[nodiscard]] RowVectorXf AtRest(int t, std::span<const double> posed) const {
    const JointBlend blend = BlendAt(t);
    RowVectorXf result(static_cast<Eigen::Index>(posed.size()));
    Matrix3d linear, inverse;
    Vector3d offset, x;
    for (int v = 0; v < person_.body->num_vertices(); ++v) {
      blend.At(v, &linear, &offset);
      bool invertible = false;
      linear.computeInverseWithCheck(inverse, invertible, kMinDeterminant);
      if (invertible) {
        x = inverse * (VertexOf(posed, v) - offset);
      } else {  // the frame's T-pose, blended into the rest pose
        rest_from_t_pose_.At(v, &linear, &offset);
        x = linear * (ShapedVertex(*person_.body, person_.betas, v) +
                      PoseCorrective(*person_.body, person_.poses[size_t(t)], v)) +
            offset;
      }
      result.segment<3>(Eigen::Index{3} * v) = x.cast<float>().transpose();
    }
    return result;
  }

 private:
  const ExportPerson& person_;
  const RigSkeleton& rig_;
  MatrixX3d joints_;
  Skinner skinner_;
  ShapedBody shaped_;
  JointBlend rest_from_t_pose_;
};

/// Principal components with weights in [0, 1] over all frames: position + Σ weight · shape.
void AddPrincipalShapes(const std::vector<VectorXf>& directions, const RowVectorXf& mean, const MeshAtRest& at_rest,
                        RiggedMesh* mesh) {
  const Eigen::Index T = mesh->shape_weights.rows();
  Eigen::MatrixXd weights(T, directions.size());
  at_rest.VisitPosed(SpreadFrames(static_cast<int>(T), static_cast<int>(T)),
                     [&](Eigen::Index t, std::span<const double> posed) {
                       const RowVectorXf offset = at_rest.AtRest(static_cast<int>(t), posed) - mean;
                       for (size_t k = 0; k < directions.size(); ++k) {
                         weights(t, Eigen::Index(k)) = double(offset.dot(directions[k]));
                       }
                     });
  std::vector<Eigen::Index> kept;
  for (Eigen::Index k = 0; k < weights.cols(); ++k) {
    const double low = weights.col(k).minCoeff(), range = weights.col(k).maxCoeff() - low;
    if (!(range > 0)) continue;
    const Eigen::Map<const MatrixX3f> direction(directions[size_t(k)].data(), mesh->positions.rows(), 3);
    mesh->positions += low * direction.cast<double>();
    mesh->shapes.emplace_back(float(range) * direction);
    weights.col(k) = ((weights.col(k).array() - low) / range).cwiseMax(0).cwiseMin(1);
    kept.push_back(k);
  }
  mesh->shape_weights = weights(Eigen::all, kept);
}

void MeasureRiggedMesh(const ExportPerson& person, const MeshAtRest& at_rest, RiggedMesh* mesh) {
  double sum = 0;
  int64_t count = 0;
  Matrix3d linear;
  Vector3d offset;
  const std::vector<int> frames = SpreadFrames(static_cast<int>(person.poses.size()), kErrorFrames);
  at_rest.VisitPosed(frames, [&](Eigen::Index i, std::span<const double> posed) {
    const int t = frames[size_t(i)];
    const JointBlend blend = at_rest.BlendAt(t);
    MatrixX3d rest = mesh->positions;
    for (size_t k = 0; k < mesh->shapes.size(); ++k) {
      rest += mesh->shape_weights(t, Eigen::Index(k)) * mesh->shapes[k].cast<double>();
    }
    for (int v = 0; v < rest.rows(); ++v) {
      blend.At(v, &linear, &offset);
      const double error = (linear * rest.row(v).transpose() + offset - VertexOf(posed, v)).norm();
      mesh->max_error_m = std::max(mesh->max_error_m, error);
      sum += error * error;
      ++count;
    }
  });
  mesh->rms_error_m = std::sqrt(sum / double(count));
}

}  // namespace

RiggedMesh MakeRiggedMesh(const ExportPerson& person, const RigSkeleton& rig, int num_shapes) {
  BODYLOOM_CHECK(num_shapes >= 0 && num_shapes <= kMaxShapes, "rigged mesh: ", num_shapes, " shapes, expected 0 to ",
                 kMaxShapes);
  const MeshAtRest at_rest(person, rig);
  RiggedMesh mesh;
  mesh.joints = at_rest.joints();
  const std::vector<int> sample = SpreadFrames(static_cast<int>(person.poses.size()), kShapeFrames);
  const Eigen::Index n = static_cast<Eigen::Index>(sample.size()), V = person.body->num_vertices();
  RowMatrixXf rows(n, 3 * V);
  at_rest.VisitPosed(sample, [&](Eigen::Index i, std::span<const double> posed) {
    rows.row(i) = at_rest.AtRest(sample[size_t(i)], posed);
  });
  const RowVectorXf mean = rows.colwise().mean();
  rows.rowwise() -= mean;
  mesh.positions = Eigen::Map<const MatrixX3f>(mean.data(), V, 3).cast<double>();
  mesh.shape_weights.resize(static_cast<Eigen::Index>(person.poses.size()), 0);
  if (num_shapes > 0) {
    const MatrixXf gram = rows * rows.transpose();
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(gram.cast<double>());
    std::vector<VectorXf> directions;
    for (Eigen::Index k = n - 1; k >= 0 && k >= n - num_shapes; --k) {
      const double square = solver.eigenvalues()[k];
      if (!(square > kMinComponent_m * kMinComponent_m * double(n) * double(V))) break;
      directions.emplace_back(rows.transpose() * (solver.eigenvectors().col(k) / std::sqrt(square)).cast<float>());
    }
    AddPrincipalShapes(directions, mean, at_rest, &mesh);
  }
  mesh.normals = VertexNormals(mesh.positions, person.body->data().faces);
  for (Eigen::Index v = 0; v < V; ++v) {
    if (!(mesh.normals.row(v).norm() > 0.5F)) mesh.normals.row(v) = Eigen::RowVector3f::UnitY();
  }
  MeasureRiggedMesh(person, at_rest, &mesh);
  return mesh;
}

}  // namespace bodyloom
