// SPDX-License-Identifier: Apache-2.0
/// A garment along a motion: the body is posed at short ticks, and the cloth follows (cloth_simulation.h).
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
  double tick_s = 1.0 / 60;  ///< the body is posed at least this often, in between along shortest arcs
  double move_in_s = 1.2;    ///< before frame 0 and after a cut: as sewn, from the T-pose to the pose
  double settle_s = 1.3;     ///< and then at rest in it
  /// 1/s, in both: what swings from being put on comes to rest sooner; absent: that of `cloth`.
  std::optional<double> rest_damping;
  double cut_speed = 8;    ///< m/s: frames between which joints move faster than this on average are a cut
  double cut_pause_s = 1;  ///< and frames this far apart or further
  bool has_floor = true;   ///< under the lowest point that the motion reaches
  ClothOptions cloth;      ///< gravity and floor are set from the above
};

/// Runs the garment of a body through a motion, frame by frame, in the motion's frame. The same positions each time.
class ClothRun {
 public:
  /// `wearer` must outlive it. Throws std::invalid_argument when the motion is empty, not finite, or its timestamps do
  /// not rise.
  ClothRun(const ClothWearer& wearer, Motion motion, const ClothRunOptions& options);

  /// Places of the cloth's vertices in the next frame (the first call: frame 0, at rest); empty without a garment.
  /// Throws std::invalid_argument after the last frame.
  const std::vector<Eigen::Vector3d>& Next();

  [[nodiscard]] int num_cuts() const { return cuts_; }
  /// In the frame of the last Next(): LegsThroughCloth; 0 without a garment.
  [[nodiscard]] int legs_through() const;
  [[nodiscard]] const ClothSimulation* simulation() const { return simulation_ ? &*simulation_ : nullptr; }

 private:
  /// The body as cloth meets it.
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

  const ClothWearer& wearer_;
  Motion motion_;
  ClothRunOptions options_;
  VertexNormalsOfMesh bare_normals_, clothed_normals_;
  std::optional<ClothSimulation> simulation_;
  std::vector<Eigen::Vector3d> none_;
  int next_ = 0, cuts_ = 0;
};

// One garment in one motion, simulated several times.
//
// Where a fold falls is chance: with a little more friction it falls beside. Who learns from one run takes its folds
// for the cloth's own; what several runs have in common is what cloth does in that motion.

constexpr int kMostClothRuns = 5;

/// The options of one of several runs: those given for run 0; in others friction, damping and air density times e^0.1
/// or e^-0.1, each run by signs of its own. Throws std::invalid_argument for a run outside 0 to kMostClothRuns − 1.
ClothOptions OfRun(ClothOptions options, int run);

}  // namespace bodyloom
