// SPDX-License-Identifier: Apache-2.0
/// A body in clothes, and how its loose garment moves along with it.
///
/// The clothes close to the skin are the skinned surface moved outwards along its normals (outfit.h); the loose garment
/// is cloth (cloth_simulation.h) pinned to that surface and colliding with it. Cloth depends on how the body has moved:
/// the same pose at another speed gives other folds.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "bodyloom/data_tools/synthesis/people/body_obstacles.h"
#include "bodyloom/data_tools/synthesis/people/cloth_simulation.h"
#include "bodyloom/data_tools/synthesis/people/loose_garment.h"
#include "bodyloom/data_tools/synthesis/people/outfit.h"
#include "bodyloom/geometry/body_model.h"
#include "bodyloom/geometry/posed_body.h"
#include "bodyloom/geometry/skinning.h"
#include "bodyloom/geometry/track.h"
#include "bodyloom/geometry/vertex_normals.h"

namespace bodyloom {

/// Immutable, may be shared by threads. The body must outlive it.
class DressedPerson {
 public:
  /// Throws std::invalid_argument when the body is not on SMPL's joints or has more betas given than components.
  DressedPerson(const BodyModel& body, const Eigen::VectorXd& betas, GarmentKind kind, uint64_t seed);
  DressedPerson(BodyModel&&, const Eigen::VectorXd&, GarmentKind, uint64_t) = delete;

  [[nodiscard]] const BodyModel& body() const { return body_; }
  [[nodiscard]] const Outfit& outfit() const { return outfit_; }
  [[nodiscard]] const LooseGarment& garment() const { return garment_; }
  [[nodiscard]] const BodyObstacles& obstacles() const { return *obstacles_; }
  [[nodiscard]] const MatrixX3d& rest_joints() const { return shape_.rest_joints; }

  /// V×3 vertices of the bare body.
  [[nodiscard]] MatrixX3d BareVertices(const BodyPose& pose) const;
  /// Moves the bare surface outwards by the clothes' thickness; `normals` are its own.
  [[nodiscard]] MatrixX3d Clothed(const MatrixX3d& bare, const MatrixX3f& normals) const;

 private:
  const BodyModel& body_;
  Skinner skinner_;
  ShapedBody shape_;
  Outfit outfit_;
  LooseGarment garment_;
  std::unique_ptr<const BodyObstacles> obstacles_;
};

struct ClothRunOptions {
  Eigen::Vector3d up = Eigen::Vector3d::UnitY();  ///< of the motion's frame, unit
  double tick_s = 1.0 / 60;  ///< the body is posed at least this often, in between along shortest arcs
  double move_in_s = 1.2;    ///< before frame 0 and after a cut: as sewn, from the T-pose to the pose
  double settle_s = 1.3;     ///< and then at rest in it
  double cut_speed = 8;      ///< m/s: frames between which joints move faster than this on average are a cut
  double cut_pause_s = 1;    ///< and frames this far apart or further
  bool has_floor = true;     ///< under the lowest point that the motion reaches
  ClothOptions cloth;        ///< gravity and floor are set from the above
};

/// Runs the cloth of a person through a motion, frame by frame, in the motion's frame. The same positions each time.
class ClothRun {
 public:
  /// `person` must outlive it. Throws std::invalid_argument when the motion is empty, not finite, or its timestamps do
  /// not rise.
  ClothRun(const DressedPerson& person, Motion motion, const ClothRunOptions& options);

  /// Places of the cloth's vertices in the next frame (the first call: frame 0, at rest); empty for a suit. Throws
  /// std::invalid_argument after the last frame.
  const std::vector<Eigen::Vector3d>& Next();

  [[nodiscard]] int num_cuts() const { return cuts_; }
  /// In the frame of the last Next(): LegsThroughCloth; 0 for a suit.
  [[nodiscard]] int legs_through() const;
  [[nodiscard]] const ClothSimulation* simulation() const { return simulation_ ? &*simulation_ : nullptr; }

 private:
  /// The body as cloth meets it.
  struct Place {
    ClothObstacles obstacles;
    std::vector<Eigen::Vector3d> pinned;
  };
  Place PlaceAt(const BodyPose& pose);
  BodyPose PoseAt(int t) const;
  void MoveTo(const BodyPose& from, const BodyPose& to, double seconds);
  void StartIn(const BodyPose& pose);
  bool IsCut(int t) const;

  const DressedPerson& person_;
  Motion motion_;
  ClothRunOptions options_;
  VertexNormalsOfMesh bare_normals_, clothed_normals_;
  std::optional<ClothSimulation> simulation_;
  std::vector<Eigen::Vector3d> none_;
  int next_ = 0, cuts_ = 0;
};

/// How many legs have come through the cloth's faces: whose line from hip over knee to ankle (joints J×3) passes
/// through them an odd number of times. A leg that stays inside, or leaves by the hem, does not.
int LegsThroughCloth(const MatrixX3i& faces, const std::vector<Eigen::Vector3d>& cloth, const MatrixX3d& joints);

/// How deep the cloth lies inside the clothed body: for each vertex of the cloth the signed distance to the tangent
/// plane of the nearest point of trunk and legs, for those within 6 cm of it. Largest depth, metres (0: none inside).
double LargestDepth(const std::vector<Eigen::Vector3d>& cloth, const ClothObstacles& obstacles);

}  // namespace bodyloom
