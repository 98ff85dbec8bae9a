// SPDX-License-Identifier: Apache-2.0
/// The body that wears a garment: shaped, offset by clothes close to the skin, with the garment pinned to it.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "geometry/body/body_model.h"
#include "geometry/body/normals.h"
#include "geometry/body/posed_body.h"
#include "geometry/body/skinning.h"
#include "geometry/cloth/body_obstacles.h"
#include "geometry/cloth/loose_garment.h"

namespace bodyloom {

/// The body must outlive it. May be shared by threads after Wear(). A copy shares all but the garment.
class ClothCollisionBody {
 public:
  /// `offsets_m`: distance of the close-fitting clothes from the skin, one per vertex; negative ones count as 0; empty:
  /// bare. Throws std::invalid_argument when the body does not begin with SMPL's 24 joints, has more betas given than
  /// components or another number of vertices than offsets.
  ClothCollisionBody(const BodyModel& body, const Eigen::VectorXd& betas, std::vector<double> offsets_m);
  ClothCollisionBody(BodyModel&&, const Eigen::VectorXd&, std::vector<double>) = delete;

  /// Cuts a garment for this body (CutLooseGarment), crumpled by the seed.
  [[nodiscard]] LooseGarment Cut(const LooseGarmentOptions& options, uint64_t seed) const;
  /// Sets the garment, which must be cut for a body with these faces.
  void Wear(LooseGarment garment) { garment_ = std::move(garment); }

  [[nodiscard]] const BodyModel& body() const { return body_; }
  [[nodiscard]] const LooseGarment& garment() const { return garment_; }  ///< empty: none
  [[nodiscard]] const BodyObstacles& obstacles() const { return dressed_->obstacles; }
  [[nodiscard]] const MatrixX3d& rest_joints() const { return dressed_->shape.rest_joints; }
  [[nodiscard]] const std::shared_ptr<const MeshNormals>& mesh_normals() const { return dressed_->normals; }
  /// True if any clothes offset is non-zero; otherwise Clothed() is the identity.
  [[nodiscard]] bool has_offsets() const { return !dressed_->offsets_m.empty(); }

  /// V×3 vertices of the bare body.
  [[nodiscard]] MatrixX3d BareVertices(const BodyPose& pose) const { return dressed_->Bare(pose); }
  /// Moves the bare surface outwards by the clothes' thickness; `normals` are those of the bare surface.
  [[nodiscard]] MatrixX3d Clothed(const MatrixX3d& bare, const MatrixX3f& normals) const {
    return dressed_->Clothed(bare, normals);
  }

 private:
  /// The body with its close-fitting clothes.
  struct Dressed {
    Dressed(const BodyModel& body, const Eigen::VectorXd& betas, std::vector<double> offsets);
    [[nodiscard]] MatrixX3d AtRest(const BodyModel& body) const;
    [[nodiscard]] MatrixX3d Bare(const BodyPose& pose) const;
    [[nodiscard]] MatrixX3d Clothed(const MatrixX3d& bare, const MatrixX3f& bare_normals) const;

    Skinner skinner;
    ShapedBody shape;
    std::vector<double> offsets_m;
    std::shared_ptr<const MeshNormals> normals;
    MatrixX3d at_rest;  ///< clothed, in T-pose
    BodyObstacles obstacles;
  };
  const BodyModel& body_;
  std::shared_ptr<const Dressed> dressed_;
  LooseGarment garment_;
};

/// The T-pose at the origin.
BodyPose RestPose(const BodyModel& body);

}  // namespace bodyloom
