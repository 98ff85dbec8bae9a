// SPDX-License-Identifier: Apache-2.0
/// Close-fitting outfit of a synthetic person: top, trousers, shoes and hair are the body's own surface moved outwards,
/// labelled by position.
///
/// Points of the surface are given by their position on the template (T-pose, metres, body frame), so cuts (sleeve,
/// neckline, hairline, …) are smooth curves on any mesh and move with the skin. Any body with SMPL's first 22 joints
/// and a T-pose template is supported; its joints and height determine the measures.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "data_tools/datasets/single_person_dataset.h"
#include "geometry/body/body_model.h"

namespace bodyloom {

/// Suit: top and trousers. Skirt: top, bare legs and a loose skirt. Coat: trousers and a loose coat, with tight
/// sleeves.
enum class GarmentKind { kSuit, kSkirt, kCoat };

std::string ToString(GarmentKind kind);
/// "suit", "skirt" or "coat"; throws std::invalid_argument otherwise.
GarmentKind GarmentKindFromString(const std::string& name);

/// Patterned: close-fitting clothes in patterns that show the motion of the surface. Everyday: common clothes,
/// including wide trousers and loose shirts, mostly plain (wardrobe.h).
enum class ClothesStyle { kPatterned, kEveryday };

std::string ToString(ClothesStyle style);
/// "patterned" or "everyday"; throws std::invalid_argument otherwise.
ClothesStyle ClothesStyleFromString(const std::string& name);

/// Boundaries of the clothes, metres on the template. The seed chooses within common cuts.
struct OutfitCut {
  double unit = 1;  ///< height of the body / 1.71 m: scales every length below
  double waist_y = 0, neck_x = 0, neck_z = 0, neck_y = 0, neck_radius_x = 0, neck_radius_z = 0;
  double sleeve_x = 0;                       ///< the top ends where |x| is larger, and
  double armpit_y = -1e9;                    ///< y is above this (a top without sleeves; no bound for others)
  double hem_y = 0;                          ///< lower end of trousers (shorts under a skirt)
  double shoe_y = 0;                         ///< shoes begin below
  double head_y = 0;                         ///< neck and head begin above
  double jaw_y = 0, jaw_z = 0;               ///< the jaw's line: y = jaw_y + ½(jaw_z − z)
  double ear_y = 0, ear_z = 0;               ///< the hair's plane passes through this
  double nape_y = 0;                         ///< hair ends below, or, where it is long,
  double long_hair_y = 1e9;                  ///< it hangs down the back to here, and
  double long_hair_x = 0;                    ///< as far to either side, with a round end
  double head_joint_y = 0, head_height = 0;  ///< of the head's joint, and of the crown above it
};

class Outfit {
 public:
  /// Throws std::invalid_argument when the body does not begin with SMPL's 22 joints without hands.
  Outfit(const BodyModel& body, GarmentKind kind, uint64_t seed, ClothesStyle style = ClothesStyle::kPatterned);

  [[nodiscard]] GarmentKind kind() const { return kind_; }
  [[nodiscard]] ClothesStyle style() const { return style_; }
  [[nodiscard]] const OutfitCut& cut() const { return cut_; }
  /// Label of the point `on_template`; never background.
  [[nodiscard]] PersonLabel LabelAt(const Eigen::Vector3d& on_template) const;
  /// Distance of the clothes (or hair) from the skin there, metres: at least 0, continuous.
  [[nodiscard]] double OffsetAt(const Eigen::Vector3d& on_template) const;
  /// The same for every vertex.
  [[nodiscard]] const std::vector<double>& offsets_m() const { return offsets_m_; }
  /// Distance (about) from the neckline, positive where the top is cut away.
  [[nodiscard]] double NeckHole(const Eigen::Vector3d& on_template) const;
  /// Distance (about) from a sleeve's end, positive where the top is.
  [[nodiscard]] double InsideSleeve(const Eigen::Vector3d& on_template) const;
  /// True if there is a top, or shoes; everyday people sometimes have none.
  [[nodiscard]] bool has_top() const { return has_top_; }
  [[nodiscard]] bool has_shoes() const { return has_shoes_; }
  [[nodiscard]] double hip_z() const { return hip_z_; }    ///< metres on the template, of the hip's joint
  [[nodiscard]] double sole_y() const { return sole_y_; }  ///< of the lowest vertex

 private:
  [[nodiscard]] double HairDepth(const Eigen::Vector3d& p) const;
  [[nodiscard]] double LongHairDepth(const Eigen::Vector3d& p) const;

  void CutEveryday(uint64_t seed, const MatrixX3d& joints);

  GarmentKind kind_;
  ClothesStyle style_;
  OutfitCut cut_;
  double top_m_ = 0, trousers_m_ = 0, flare_m_ = 0, shoes_m_ = 0, hair_m_ = 0;
  bool even_flare_ = false;  ///< trousers widen linearly down to the hem, else quadratically
  bool tucked_in_ = true;    ///< the shirt, else it hangs over the trousers
  bool has_top_ = true, has_shoes_ = true;
  double hip_z_ = 0, sole_y_ = 0;
  std::vector<double> offsets_m_;
};

}  // namespace bodyloom
