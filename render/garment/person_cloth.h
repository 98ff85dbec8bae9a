// SPDX-License-Identifier: Apache-2.0
/// Simulates the garment of a person made from photos along a track.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "geometry/body/body_model.h"
#include "geometry/cloth/cloth_body.h"
#include "geometry/cloth/cloth_run.h"
#include "geometry/cloth/loose_garment.h"
#include "geometry/math/arrays.h"
#include "geometry/scene/track.h"

namespace bodyloom {

struct PersonClothOptions {
  double swing_rad = 0;  ///< rotation of gravity (render/garment/fit_clothes.h)
  int run = 0;           ///< number of the simulation run (geometry/cloth/cloth_run.h)
};

/// Borrows the clothed body.
class PersonCloth {
 public:
  /// `garment`: fitted to a photo, worn by the clothed body of that photo, which has the faces of the body it was cut
  /// for. `moved`: a track of that body (MovedByPerson). Frames without a result repeat the frame before. Throws
  /// std::invalid_argument as ClothRun does.
  PersonCloth(const BodyModel& clothed, const LooseGarment& garment, const Track& moved,
              const PersonClothOptions& options = {});
  PersonCloth(const PersonCloth&) = delete;
  PersonCloth& operator=(const PersonCloth&) = delete;

  /// Positions of the cloth's vertices in frame t, metres, the track's camera frame; none without a garment. Frames
  /// must not decrease from call to call (std::invalid_argument).
  const std::vector<Eigen::Vector3d>& At(int t);

 private:
  std::optional<ClothCollisionBody> wearer_;
  std::optional<ClothRun> run_;
  std::vector<Eigen::Vector3d> cloth_;
  int last_ = -1;
};

/// Cuts the garment for a clothed body whose zero betas are the person; deterministic. `cut` receives the number of
/// columns.
LooseGarment CutGarment(const BodyModel& clothed, LooseGarmentOptions* cut);

}  // namespace bodyloom
