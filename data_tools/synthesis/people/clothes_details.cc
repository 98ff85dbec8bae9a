// SPDX-License-Identifier: Apache-2.0
#include "data_tools/synthesis/people/clothes_details.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "data_tools/synthesis/clips/smooth_curve.h"
#include "geometry/base/hash_random.h"

namespace bodyloom {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

constexpr double kLine_m = 0.003;       ///< half the visible width of a seam
constexpr double kButtonGap_m = 0.085;  ///< from one to the next
constexpr double kButtonRadius_m = 0.006;
constexpr double kPlacket_m = 0.018;  ///< half the width of the button placket

bool IsFront(const OutfitCut& cut, const Vector3d& p) { return p.z() > cut.neck_z; }

}  // namespace

ClothesDetails::ClothesDetails(const Outfit& outfit, uint64_t seed) : outfit_(outfit) {
  HashRandom random(seed, {0x64657461});
  const double unit = outfit.cut().unit;
  // Every random number is drawn even if unused, so that one detail does not change another.
  const auto some = [&](double share, double low, double high) {
    const bool has = random.Uniform() < share;
    const double length = random.Uniform(low, high) * unit;
    return has ? length : 0;
  };
  const auto any_colour = [&] {
    const auto third = float(random.Uniform(15, 240)), second = float(random.Uniform(15, 240)),
               first = float(random.Uniform(15, 240));
    return Vector3f(first, second, third);
  };
  const auto any_grey = [&](double low, double high) { return Vector3f::Constant(float(random.Uniform(low, high))); };
  collar_m_ = some(0.45, 0.008, 0.03);
  cuff_m_ = some(0.3, 0.01, 0.05);
  hem_band_m_ = some(0.25, 0.01, 0.05);
  stitches_m_ = some(0.6, 0.012, 0.03);
  open_m_ = some(0.15, 0.03, 0.09);
  buttons_ = random.Uniform() < 0.2;
  knit_m_ = some(0.2, 0.006, 0.02);
  waistband_m_ = some(0.6, 0.02, 0.045);
  sole_m_ = some(0.6, 0.012, 0.035);
  side_seams_ = random.Uniform() < 0.5;
  const bool is_worn = random.Uniform() < 0.35;
  const auto worn = static_cast<float>(random.Uniform(0.1, 0.5));
  if (is_worn) worn_ = worn;
  const bool grey_trim = random.Uniform() < 0.6;
  const Vector3f grey = any_grey(10, 245), coloured = any_colour();
  trim_ = grey_trim ? grey : coloured;
  const bool grey_inner = random.Uniform() < 0.7;
  const Vector3f inner_grey = any_grey(10, 245), inner_coloured = any_colour();
  inner_ = grey_inner ? inner_grey : inner_coloured;
  belt_ = any_grey(10, 70);
  const bool white_sole = random.Uniform() < 0.7;
  const Vector3f light = any_grey(200, 245), dark = any_grey(15, 60);
  sole_ = white_sole ? light : dark;
}

Vector3f ClothesDetails::OnTop(const Vector3d& p, const Vector3f& colour) const {
  const OutfitCut& c = outfit_.cut();
  const double from_neck = -outfit_.NeckHole(p), from_sleeve = outfit_.InsideSleeve(p), from_hem = p.y() - c.waist_y;
  if (open_m_ > 0 && IsFront(c, p)) {  // wider at the neck than below
    const double below = std::clamp((c.neck_y - p.y()) / std::max(0.1, c.neck_y - c.waist_y), 0.0, 1.0);
    const double half = open_m_ * (1 - 0.6 * below), x = std::abs(p.x() - c.neck_x);
    if (x < half) return inner_;
    if (x < half + 2 * kLine_m) return 0.6F * colour;
  }
  if (from_neck < collar_m_ || from_sleeve < cuff_m_ || from_hem < hem_band_m_) return trim_;
  const double from_end = std::min({from_neck, from_sleeve, from_hem});
  if (stitches_m_ > 0 && std::abs(from_end - stitches_m_) < 0.5 * kLine_m) return 0.7F * colour;
  if (buttons_ && open_m_ == 0 && IsFront(c, p)) {
    const double x = std::abs(p.x() - c.neck_x), row = std::remainder(c.neck_y - p.y(), kButtonGap_m * c.unit);
    if (x * x + row * row < std::pow(kButtonRadius_m * c.unit, 2)) return trim_;
    if (std::abs(x - kPlacket_m * c.unit) < 0.5 * kLine_m) return 0.7F * colour;
  }
  if (knit_m_ > 0) {
    const double along = std::abs(p.x()) > 0.2 * c.unit ? p.x() : p.y();  // around the sleeves, too
    return (1 + 0.12F * static_cast<float>(std::sin(2 * std::numbers::pi * along / knit_m_))) * colour;
  }
  return colour;
}

Vector3f ClothesDetails::OnBottom(const Vector3d& p, const Vector3f& colour) const {
  const OutfitCut& c = outfit_.cut();
  if (c.waist_y - p.y() < waistband_m_) return belt_;
  if (stitches_m_ > 0 && std::abs(p.y() - c.hem_y - stitches_m_) < 0.5 * kLine_m) return 0.7F * colour;
  const bool at_side = std::abs(p.x()) > 0.1 * c.unit && std::abs(p.z() - outfit_.hip_z()) < kLine_m;
  if (side_seams_ && at_side) return 0.6F * colour;
  if (worn_ > 0 && p.z() > outfit_.hip_z()) {
    const double thigh = SmoothStep((c.waist_y - 0.1 * c.unit - p.y()) / (0.1 * c.unit)) *
                         SmoothStep((p.y() - c.waist_y + 0.6 * c.unit) / (0.15 * c.unit)) *
                         SmoothStep((p.z() - outfit_.hip_z()) / (0.08 * c.unit));
    return colour + worn_ * static_cast<float>(thigh) * (Vector3f::Constant(235) - colour);
  }
  return colour;
}

Vector3f ClothesDetails::On(PersonLabel label, const Vector3f& on_template, const Vector3f& colour) const {
  const Vector3d p = on_template.cast<double>();
  switch (label) {
    case PersonLabel::kTop:
      return OnTop(p, colour).cwiseMin(255.0F);
    case PersonLabel::kBottom:
      return OnBottom(p, colour);
    case PersonLabel::kShoes:
      return p.y() < outfit_.sole_y() + sole_m_ ? sole_ : colour;
    default:
      return colour;
  }
}

}  // namespace bodyloom
