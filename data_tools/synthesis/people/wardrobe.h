// SPDX-License-Identifier: Apache-2.0
/// Colours and patterns of a synthetic person, fixed to the surface: stripes, checks, dots and noise as functions of
/// the position on the template (or on the cloth as sewn), distinct for every label and chosen by a seed.
///
/// Patterned clothes (ClothesStyle): top and bottom are each plain with probability 1/5, else of two different
/// patterns. Everyday clothes: three tops in five and three bottoms in four are plain apart from fading; a tenth of the
/// tops has a print on the chest; half of all are black, grey or white, a third of the bottoms blue as denim. Seams,
/// collars, knit and the like: ClothesDetails.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <optional>

#include "data_tools/synthesis/people/outfit.h"

namespace bodyloom {

/// Details of everyday clothes (ClothesStyle::kEveryday): collars, bands and stitches at their ends, a jacket that is
/// open over a shirt, buttons, knit, waistbands, side seams, worn denim, soles. The seed determines which of them a
/// person has.
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

enum class PatternKind : uint8_t { kPlain, kStripes, kChecks, kDots, kNoise, kPrint };

struct SurfacePattern {
  PatternKind kind = PatternKind::kPlain;
  Eigen::Vector3f colour = Eigen::Vector3f::Constant(128), other = colour;  ///< red, green, blue, 0…255
  float cell_m = 0.05F;                                                     ///< period / 2
  int axis = 1;                                                             ///< stripes: axis across them
  uint64_t seed = 0;                                                        ///< noise, print
  Eigen::AlignedBox3f print;  ///< print: noise of both colours in here, plain elsewhere
  [[nodiscard]] Eigen::Vector3f At(const Eigen::Vector3f& place_m) const;
};

/// Smooth noise in [0, 1] of period-free lattice values, second derivatives continuous inside cells.
float ValueNoise(const Eigen::Vector3f& p, uint64_t seed);

class Wardrobe {
 public:
  /// `around_m`: circumference after which the loose garment's pattern repeats (a multiple of its period); 0: none.
  Wardrobe(const Outfit& outfit, double around_m, uint64_t seed);

  /// Colour (red, green, blue, 0…255) of a point of the body's surface with that label.
  [[nodiscard]] Eigen::Vector3f OfBody(PersonLabel label, const Eigen::Vector3f& on_template) const;
  /// Colour of a point of the loose garment (circumference, distance down, 0).
  [[nodiscard]] Eigen::Vector3f OfGarment(const Eigen::Vector3f& pattern_m) const;
  [[nodiscard]] const SurfacePattern& of_label(PersonLabel label) const { return patterns_[size_t(label)]; }

 private:
  void DressEveryday(GarmentKind garment, uint64_t seed);
  [[nodiscard]] Eigen::Vector3f OfFace(const Eigen::Vector3f& p) const;

  OutfitCut cut_;
  std::array<SurfacePattern, kNumPersonLabels> patterns_;
  SurfacePattern garment_;
  std::optional<ClothesDetails> details_;  ///< of everyday clothes
};

}  // namespace bodyloom
