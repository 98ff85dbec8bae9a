// SPDX-License-Identifier: Apache-2.0
/// Details of everyday clothes (ClothesStyle::kEveryday): collars, bands and stitches at their ends, a jacket that is
/// open over a shirt, buttons, knit, waistbands, side seams, worn denim, soles. The seed determines which of them a
/// person has.
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "data_tools/synthesis/people/outfit.h"

namespace bodyloom {

class ClothesDetails {
 public:
  ClothesDetails(const Outfit& outfit, uint64_t seed);

  /// `colour` (red, green, blue, 0…255) of the cloth, modified by the details at this point of the template; unchanged
  /// for labels other than top, bottom and shoes.
  [[nodiscard]] Eigen::Vector3f On(PersonLabel label, const Eigen::Vector3f& on_template,
                                   const Eigen::Vector3f& colour) const;

 private:
  [[nodiscard]] Eigen::Vector3f OnTop(const Eigen::Vector3d& p, const Eigen::Vector3f& colour) const;
  [[nodiscard]] Eigen::Vector3f OnBottom(const Eigen::Vector3d& p, const Eigen::Vector3f& colour) const;

  Outfit outfit_;
  // Lengths in metres; 0: this person has none.
  double collar_m_ = 0, cuff_m_ = 0, hem_band_m_ = 0;  ///< widths of bands in other colours
  double stitches_m_ = 0;                              ///< distance of a line of stitches from the cloth's end
  double open_m_ = 0;                                  ///< half the opening of a jacket at the neck
  bool buttons_ = false;                               ///< down the front
  double knit_m_ = 0;                                  ///< distance of the rows of knit
  double waistband_m_ = 0, sole_m_ = 0;
  bool side_seams_ = false;
  float worn_ = 0;  ///< lightening of the thighs' front
  Eigen::Vector3f trim_, inner_, belt_, sole_;
};

}  // namespace bodyloom
