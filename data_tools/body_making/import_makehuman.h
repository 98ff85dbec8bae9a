// SPDX-License-Identifier: Apache-2.0
/// Makes a body of the SMPL kind from MakeHuman's CC0 assets: its own 13,380-vertex skin with texture coordinates,
/// SMPL's 24 joints, principal shape components of random adults, skinning weights and landmarks.
///
/// num_people random adults (makehuman_population.h) are put into T-pose (makehuman_tpose.h) and aligned at the pelvis.
///   v_template, shapedirs  mean and area-weighted principal components, in metres per standard deviation, signed so
///                          that the body grows taller
///   J_regressor            non-negative least squares from nearby skin to the joints of all those people
///   weights                the game-engine rig's, fingers to the hand, thumb to the wrist, ball to the foot, clavicle
///                          to the collar; the torso's by height between the spine joints; smoothed; at most 4 a vertex
///   posedirs               none: plain linear blend skinning
///   vt, ft                 of base.obj; no charts
///   landmarks              COCO-17, toes, heels
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "bodyloom/geometry/body_model.h"

namespace bodyloom {

struct ImportMakeHumanOptions {
  int num_people = 300;          ///< sample size of the principal components, 20 .. 5000
  int num_betas = 10;            ///< shape components kept, 1 .. min(num_people − 1, 100)
  double metres_per_unit = 0.1;  ///< base.obj is in decimetres
  uint32_t seed = 1;             ///< of the random people
  [[nodiscard]] bool IsValid(std::string* why) const;
};

struct ImportMakeHumanSummary {
  int targets = 0;                          ///< macro targets found
  std::vector<double> cumulative_variance;  ///< share of the population's variance by component
  std::vector<double> joint_errors_mm;      ///< by joint: mean distance of the regressed from the rig's joint
  double mean_height_m = 0;                 ///< of the people
};

/// The body, named "makehuman". Same folder and options, same body. Throws std::invalid_argument for invalid options,
/// std::runtime_error naming the file for a folder that cannot be used.
BodyModelData ImportMakeHuman(const std::string& folder, const ImportMakeHumanOptions& options = {},
                              ImportMakeHumanSummary* summary = nullptr);

}  // namespace bodyloom
