// SPDX-License-Identifier: Apache-2.0
/// The garment of a person made from photos, along a track.
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
  double swing_rad = 0;  ///< how far the cloth is swung (render/garment/fit_clothes.h)
  int run = 0;           ///< which of several runs of the simulation (geometry/cloth/cloth_run.h)
};

/// Borrows the clothed body.
class PersonCloth {
 public:
  /// A garment as a photo shows it, on the clothed body of that photo, which has the faces of the one it was cut for.
  /// `moved`: a track of that body (MovedByPerson). Frames without a result go on as the frame before them. Throws
  /// std::invalid_argument as ClothRun does.
  PersonCloth(const BodyModel& clothed, const LooseGarment& garment, const Track& moved,
              const PersonClothOptions& options = {});
  PersonCloth(const PersonCloth&) = delete;
  PersonCloth& operator=(const PersonCloth&) = delete;

  /// Places of the cloth's vertices in frame t, metres, the track's camera frame; none without a garment. A frame may
  /// be requested again, not one before it (std::invalid_argument).
  const std::vector<Eigen::Vector3d>& At(int t);

 private:
  std::optional<ClothWearer> wearer_;
  std::optional<ClothRun> run_;
  std::vector<Eigen::Vector3d> cloth_;
  int last_ = -1;
};

/// The garment of a clothed body whose zero betas are the person; the same each time. `cut` gets the number of columns.
LooseGarment CutGarment(const BodyModel& clothed, LooseGarmentOptions* cut);

}  // namespace bodyloom
