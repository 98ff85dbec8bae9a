// SPDX-License-Identifier: Apache-2.0
/// Simulates a garment along a motion: the body is posed at short time steps and the cloth follows
/// (cloth_simulation.h).
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "geometry/body/normals.h"
#include "geometry/body/posed_body.h"
#include "geometry/cloth/cloth_body.h"
#include "geometry/cloth/cloth_simulation.h"
#include "geometry/scene/track.h"

namespace bodyloom {

struct ClothRunOptions {
  Eigen::Vector3d up = Eigen::Vector3d::UnitY();  ///< of the motion's frame, unit
  double tick_s = 1.0 / 60;  ///< longest interval between poses of the body, interpolated along geodesics
  double move_in_s = 1.2;    ///< before frame 0 and after a cut: from the garment as sewn on the T-pose to the pose
  double settle_s = 1.3;     ///< then at rest in that pose
  /// Damping during both, 1/s, so that the initial swinging dies down sooner; absent: that of `cloth`.
  std::optional<double> rest_damping;
  double cut_speed = 8;    ///< m/s: frames between which joints move faster than this on average are a cut
  double cut_pause_s = 1;  ///< frames at least this far apart are a cut too
  bool has_floor = true;   ///< a floor under the lowest point that the motion reaches
  ClothOptions cloth;      ///< gravity and floor are set from the above
};

/// Runs the garment of a body through a motion, frame by frame, in the motion's frame. Deterministic.
class ClothRun {
 public:
  /// `wearer` must outlive it. Throws std::invalid_argument when the motion is empty or not finite, or its timestamps
  /// do not increase.
  ClothRun(const ClothCollisionBody& wearer, Motion motion, const ClothRunOptions& options);

  /// Positions of the cloth's vertices in the next frame (first call: frame 0, at rest); empty without a garment.
  /// Throws std::invalid_argument after the last frame.
  const std::vector<Eigen::Vector3d>& Next();

  [[nodiscard]] int num_cuts() const { return cuts_; }
  /// LegsThroughCloth() in the frame of the last Next(); 0 without a garment.
  [[nodiscard]] int legs_through() const;
  [[nodiscard]] const ClothSimulation* simulation() const { return simulation_ ? &*simulation_ : nullptr; }

 private:
  /// The body as an obstacle of the cloth.
  struct Place {
    ClothObstacles obstacles;
    std::vector<Eigen::Vector3d> pinned;
  };
  Place PlaceAt(const BodyPose& pose);
  [[nodiscard]] int NumTicks(double seconds) const;
  void Rest(const BodyPose& pose, double seconds);
  BodyPose PoseAt(int t) const;
  void MoveTo(const BodyPose& from, const BodyPose& to, double seconds);
  void StartIn(const BodyPose& pose);
  bool IsCut(int t) const;

  const ClothCollisionBody& wearer_;
  Motion motion_;
  ClothRunOptions options_;
  VertexNormalsOfMesh bare_normals_, clothed_normals_;
  std::optional<ClothSimulation> simulation_;
  std::vector<Eigen::Vector3d> none_;
  int next_ = 0, cuts_ = 0;
};

// Repeated simulations of one garment in one motion.
//
// Folds are sensitive to parameters: a little more friction moves them. Several runs with varied parameters separate
// what the motion determines from what is particular to one run.

constexpr int kMaxClothRuns = 5;

/// Options of one of several runs: those given for run 0; in others friction, damping and air density are multiplied by
/// e^0.1 or e^-0.1, with different signs in each run. Throws std::invalid_argument for a run outside 0 to kMaxClothRuns
/// − 1.
ClothOptions PerturbedOptions(ClothOptions options, int run);

}  // namespace bodyloom
