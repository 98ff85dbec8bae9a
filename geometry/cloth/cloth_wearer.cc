// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/geometry/cloth/cloth_wearer.h"

#include "bodyloom/geometry/base/check.h"
#include "bodyloom/geometry/vertex_normals.h"

namespace bodyloom {
namespace {

/// Half the way from the middle to the elbows: arms of a T-pose are further out, the trunk is not.
double ArmX(const MatrixX3d& joints) { return 0.5 * (joints(16, 0) + joints(18, 0)); }

}  // namespace

BodyPose RestPose(const BodyModel& body) {
  return {std::vector<Eigen::Matrix3d>(body.num_joints(), Eigen::Matrix3d::Identity()), Eigen::Vector3d::Zero()};
}

ClothWearer::ClothWearer(const BodyModel& body, const Eigen::VectorXd& betas, std::vector<double> offsets_m)
    : body_(body), skinner_(body), shape_(skinner_.Shape(betas)), offsets_m_(std::move(offsets_m)) {
  BODYLOOM_CHECK(offsets_m_.empty() || static_cast<int>(offsets_m_.size()) == body.num_vertices(), offsets_m_.size(),
                 " offsets, expected one for each of ", body.num_vertices(), " vertices");
  BODYLOOM_CHECK(body.num_joints() >= 24, "a garment needs a body on SMPL's 24 joints, this one has ",
                 body.num_joints());
  const MatrixX3d bare = BareVertices(RestPose(body));
  clothed_at_rest_ = Clothed(bare, VertexNormals(bare, body.data().faces));
  obstacles_ = std::make_unique<BodyObstacles>(body, clothed_at_rest_, shape_.rest_joints);
}

LooseGarment ClothWearer::Cut(const LooseGarmentOptions& options, uint64_t seed) const {
  LooseGarment garment = CutLooseGarment(clothed_at_rest_, body_.data().faces, ArmX(shape_.rest_joints), options);
  Crumple(&garment, seed);
  return garment;
}

MatrixX3d ClothWearer::BareVertices(const BodyPose& pose) const {
  MatrixX3d vertices(body_.num_vertices(), 3);
  skinner_.Skin(shape_, {&pose, 1}, {vertices.data(), size_t(vertices.size())});
  return vertices;
}

MatrixX3d ClothWearer::Clothed(const MatrixX3d& bare, const MatrixX3f& normals) const {
  MatrixX3d clothed = bare;
  if (offsets_m_.empty()) return clothed;
  for (int v = 0; v < clothed.rows(); ++v) {
    if (offsets_m_[v] > 0) clothed.row(v) += offsets_m_[v] * normals.row(v).cast<double>();
  }
  return clothed;
}

}  // namespace bodyloom
