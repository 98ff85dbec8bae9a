// SPDX-License-Identifier: Apache-2.0
#include "geometry/cloth/cloth_body.h"

#include "geometry/base/check.h"
#include "geometry/body/normals.h"

namespace bodyloom {
namespace {

/// Halfway from the middle to the elbows: in T-pose the arms are further out, the trunk is not.
double ArmX(const MatrixX3d& joints) { return 0.5 * (joints(16, 0) + joints(18, 0)); }

}  // namespace

BodyPose RestPose(const BodyModel& body) {
  return {std::vector<Eigen::Matrix3d>(body.num_joints(), Eigen::Matrix3d::Identity()), Eigen::Vector3d::Zero()};
}

ClothCollisionBody::Dressed::Dressed(const BodyModel& body, const Eigen::VectorXd& betas, std::vector<double> offsets)
    : skinner(body),
      shape(skinner.Shape(betas)),
      offsets_m(std::move(offsets)),
      normals(std::make_shared<const MeshNormals>(body.data().faces, body.num_vertices())),
      at_rest(AtRest(body)),
      obstacles(body, at_rest, shape.rest_joints) {}

MatrixX3d ClothCollisionBody::Dressed::AtRest(const BodyModel& body) const {
  const MatrixX3d bare = Bare(RestPose(body));
  return Clothed(bare, VertexNormalsOfMesh(normals).Compute(bare, body.data().faces));
}

MatrixX3d ClothCollisionBody::Dressed::Bare(const BodyPose& pose) const {
  MatrixX3d vertices(normals->num_vertices(), 3);
  skinner.Skin(shape, {&pose, 1}, {vertices.data(), size_t(vertices.size())});
  return vertices;
}

MatrixX3d ClothCollisionBody::Dressed::Clothed(const MatrixX3d& bare, const MatrixX3f& bare_normals) const {
  MatrixX3d clothed = bare;
  for (int v = 0; v < static_cast<int>(offsets_m.size()); ++v) {
    if (offsets_m[v] > 0) clothed.row(v) += offsets_m[v] * bare_normals.row(v).cast<double>();
  }
  return clothed;
}

ClothCollisionBody::ClothCollisionBody(const BodyModel& body, const Eigen::VectorXd& betas,
                                       std::vector<double> offsets_m)
    : body_(body) {
  BODYLOOM_CHECK(offsets_m.empty() || static_cast<int>(offsets_m.size()) == body.num_vertices(), offsets_m.size(),
                 " offsets, expected one for each of ", body.num_vertices(), " vertices");
  BODYLOOM_CHECK(body.num_joints() >= 24, "a garment needs a body on SMPL's 24 joints, this one has ",
                 body.num_joints());
  dressed_ = std::make_shared<const Dressed>(body, betas, std::move(offsets_m));
}

LooseGarment ClothCollisionBody::Cut(const LooseGarmentOptions& options, uint64_t seed) const {
  LooseGarment garment = CutLooseGarment(dressed_->at_rest, body_.data().faces, ArmX(rest_joints()), options);
  AddPositionNoise(&garment, seed);
  return garment;
}

}  // namespace bodyloom
