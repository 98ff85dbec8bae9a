// SPDX-License-Identifier: Apache-2.0
#include "data_tools/synthesis/people/wardrobe.h"

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

/// Hue in turns, saturation and value in [0, 1].
Vector3f FromHsv(double hue, double saturation, double value) {
  const auto channel = [&](double shift) {
    const double k = std::fmod(shift + 6 * (hue - std::floor(hue)), 6.0);
    return float(255 * value * (1 - saturation * std::clamp(std::min(k, 4 - k), 0.0, 1.0)));
  };
  return {channel(5), channel(3), channel(1)};
}

/// Uniform in it; a single value uses no random number.
struct Shades {
  double low, high = low;
  double Draw(HashRandom* random) const { return low < high ? random->Uniform(low, high) : low; }
};

Vector3f DrawHsv(const Shades& hue, const Shades& saturation, const Shades& value, HashRandom* random) {
  const double v = value.Draw(random), s = saturation.Draw(random), h = hue.Draw(random);
  return FromHsv(h, s, v);
}

/// From the darkest (0) to the lightest (1) skin, in sRGB.
Vector3f SkinColour(double lightness) {
  const Vector3f dark(96, 62, 44), middle(202, 146, 110), light(250, 220, 198);
  const auto t = static_cast<float>(2 * lightness);
  return t < 1 ? Vector3f(dark + t * (middle - dark)) : Vector3f(middle + (t - 1) * (light - middle));
}

float LatticeValue(int x, int y, int z, uint64_t seed) {
  uint64_t h = seed;
  for (const int i : {x, y, z}) h = (h ^ static_cast<uint32_t>(i)) * 0x9e3779b97f4a7c15ULL, h ^= h >> 29;
  return static_cast<float>((h * 0xbf58476d1ce4e5b9ULL) >> 40) * 0x1.0p-24F;
}

constexpr double kPlainShare = 0.2;  ///< of tops and of bottoms: each of the five patterns is as likely

bool IsOdd(float x) { return (static_cast<int>(std::floor(x)) & 1) != 0; }

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

float ValueNoise(const Vector3f& p, uint64_t seed) {
  const Vector3f cell = p.array().floor();
  Vector3f f = p - cell;
  for (float& x : f) x = x * x * x * (x * (6 * x - 15) + 10);
  const Eigen::Vector3i i = cell.cast<int>();
  float corners[8];
  for (int k = 0; k < 8; ++k) corners[k] = LatticeValue(i.x() + (k & 1), i.y() + (k >> 1 & 1), i.z() + (k >> 2), seed);
  for (int k = 0; k < 4; ++k) corners[k] = corners[2 * k] + f.x() * (corners[2 * k + 1] - corners[2 * k]);
  for (int k = 0; k < 2; ++k) corners[k] = corners[2 * k] + f.y() * (corners[2 * k + 1] - corners[2 * k]);
  return corners[0] + f.z() * (corners[1] - corners[0]);
}

Vector3f SurfacePattern::At(const Vector3f& place_m) const {
  const Vector3f p = place_m / cell_m;
  switch (kind) {
    case PatternKind::kPlain:
      return colour;
    case PatternKind::kStripes:
      return IsOdd(p[axis]) ? other : colour;
    case PatternKind::kChecks:
      return IsOdd(p.x()) != (IsOdd(p.y()) != IsOdd(p.z())) ? other : colour;
    case PatternKind::kDots: {
      // Balls of the lattice: cut by a surface, discs.
      const Vector3f d = 0.5F * p - Vector3f((0.5F * p).array().floor()) - Vector3f::Constant(0.5F);
      return d.squaredNorm() < 0.36F * 0.36F ? other : colour;
    }
    case PatternKind::kNoise: {
      const float n = 0.65F * ValueNoise(p, seed) + 0.35F * ValueNoise(2.3F * p, seed + 1);
      return colour + std::clamp(1.6F * n - 0.3F, 0.0F, 1.0F) * (other - colour);
    }
    case PatternKind::kPrint:
      return print.contains(place_m) && ValueNoise(p, seed) > 0.5F ? other : colour;
  }
  return colour;
}

Wardrobe::Wardrobe(const Outfit& outfit, double around_m, uint64_t seed) : cut_(outfit.cut()) {
  HashRandom random(seed, {0x77617264});
  const auto unit = static_cast<float>(cut_.unit);
  const double hue = random.Uniform();
  const auto dress = [&](PersonLabel label, double label_hue, PatternKind kind, double cell_m) {
    SurfacePattern& p = patterns_[size_t(label)];
    const double value = random.Uniform(0.55, 0.95);
    p.kind = kind;
    p.colour = FromHsv(label_hue, random.Uniform(0.45, 0.85), value);
    const double other_saturation = random.Uniform(0.15, 0.6), other_hue = label_hue + random.Uniform(-0.12, 0.12);
    p.other = FromHsv(other_hue, other_saturation, value > 0.75 ? value - 0.45 : value + 0.35);
    p.cell_m = float(cell_m) * unit;
    p.axis = random.Uniform() < 0.7 ? 1 : 0;
    p.seed = random.Next();
  };
  // Two different patterns of the four on top and bottom, either of them plain instead for one person in five. That is
  // drawn apart, so that it changes nothing else of a seed's person.
  const int first = static_cast<int>(random.Below(4)), second = (first + 1 + static_cast<int>(random.Below(3))) % 4;
  HashRandom plain(seed, {0x706c6169});
  const auto unless_plain = [&](int pattern) {
    return plain.Uniform() < kPlainShare ? PatternKind::kPlain : PatternKind(1 + pattern);
  };
  const PatternKind of_top = unless_plain(first), of_bottom = unless_plain(second);
  dress(PersonLabel::kTop, hue, of_top, random.Uniform(0.032, 0.055));
  const double bottom_cell_m = random.Uniform(0.032, 0.055), bottom_hue = hue + random.Uniform(0.3, 0.7);
  dress(PersonLabel::kBottom, bottom_hue, of_bottom, bottom_cell_m);
  dress(PersonLabel::kShoes, random.Uniform(), PatternKind::kPlain, 0.03);
  dress(PersonLabel::kHair, 0.07, PatternKind::kNoise, 0.012);
  dress(PersonLabel::kSkin, 0.06, PatternKind::kNoise, 0.08);
  SurfacePattern& skin = patterns_[size_t(PersonLabel::kSkin)];
  skin.colour = SkinColour(random.Uniform()), skin.other = 0.94F * skin.colour;
  patterns_[size_t(PersonLabel::kFace)] = skin;
  SurfacePattern& hair = patterns_[size_t(PersonLabel::kHair)];
  hair.colour = DrawHsv({0.04, 0.12}, {0.3, 0.8}, {0.1, 0.6}, &random);
  hair.other = 0.7F * hair.colour;

  if (outfit.style() == ClothesStyle::kEveryday) {
    DressEveryday(outfit.kind(), seed);
    details_.emplace(outfit, seed);
  }

  garment_ = of_label(outfit.kind() == GarmentKind::kCoat ? PersonLabel::kTop : PersonLabel::kBottom);
  if (around_m > 0) {
    const double periods = std::max(1.0, std::round(around_m / (2 * garment_.cell_m)));
    garment_.cell_m = float(around_m / (2 * periods));
  }
}

void Wardrobe::DressEveryday(GarmentKind garment, uint64_t seed) {
  HashRandom random(seed, {0x65766477});
  const auto unit = static_cast<float>(cut_.unit);
  const auto grey = [&] {
    const double which = random.Uniform();
    const double value = which < 0.4   ? random.Uniform(0.04, 0.16)
                         : which < 0.7 ? random.Uniform(0.25, 0.6)
                                       : random.Uniform(0.78, 0.95);
    return DrawHsv({0, 1}, {0, 0.08}, {value}, &random);
  };
  const auto any = [&] { return DrawHsv({0, 1}, {0.25, 0.85}, {0.25, 0.95}, &random); };
  const auto colour = [&](bool denim) {
    const double which = random.Uniform();
    if (which < 0.5) return grey();
    return denim && which < 0.83 ? DrawHsv({0.58, 0.64}, {0.3, 0.7}, {0.15, 0.6}, &random) : any();
  };
  // Shares up to which a cloth is faded, printed, striped, checked, dotted; the rest is noise.
  const auto dress = [&](PersonLabel label, const std::array<double, 5>& up_to) {
    SurfacePattern& p = patterns_[size_t(label)];
    p = SurfacePattern();
    p.seed = random.Next();
    p.colour = colour(label == PersonLabel::kBottom);
    const double which = random.Uniform();
    p.axis = random.Uniform() < 0.6 ? 1 : 0;
    if (which < up_to[0]) {
      p.kind = PatternKind::kNoise, p.other = float(random.Uniform(0.75, 0.95)) * p.colour;
      p.cell_m = float(random.Uniform(0.02, 0.08)) * unit;
      return;
    }
    p.other = random.Uniform() < 0.5 ? grey() : any();
    p.kind = which < up_to[1]   ? PatternKind::kPrint
             : which < up_to[2] ? PatternKind::kStripes
             : which < up_to[3] ? PatternKind::kChecks
             : which < up_to[4] ? PatternKind::kDots
                                : PatternKind::kNoise;
    p.cell_m = float(random.Uniform(0.006, 0.04)) * unit;
    const auto half_width = static_cast<float>(random.Uniform(0.06, 0.13)),
               height = static_cast<float>(random.Uniform(0.06, 0.25)),
               from_neck = static_cast<float>(random.Uniform(0.02, 0.1));
    const Vector3f neck(float(cut_.neck_x), float(cut_.neck_y), float(cut_.neck_z));
    p.print = {neck - unit * Vector3f(half_width, from_neck + height, 0),
               neck + unit * Vector3f(half_width, -from_neck, 1)};
  };
  // A loose garment has other coordinates than the body, in which the print's position would be arbitrary.
  const double prints = garment == GarmentKind::kCoat ? 0.6 : 0.7;
  dress(PersonLabel::kTop, {0.6, prints, 0.82, 0.9, 0.94});
  dress(PersonLabel::kBottom, {0.75, 0.75, 0.82, 0.9, 0.93});
  SurfacePattern& shoes = patterns_[size_t(PersonLabel::kShoes)];
  shoes.colour = shoes.other = random.Uniform() < 0.7 ? grey() : any();
  SurfacePattern& hair = patterns_[size_t(PersonLabel::kHair)];
  const double which = random.Uniform();
  hair.colour = which < 0.6    ? DrawHsv({0.05, 0.1}, {0.2, 0.6}, {0.05, 0.3}, &random)
                : which < 0.8  ? DrawHsv({0.09, 0.13}, {0.3, 0.55}, {0.5, 0.8}, &random)
                : which < 0.93 ? DrawHsv({0.1}, {0, 0.1}, {0.35, 0.8}, &random)
                               : DrawHsv({0.02, 0.05}, {0.65}, {0.3, 0.55}, &random);
  hair.other = 0.7F * hair.colour;
}

Vector3f Wardrobe::OfFace(const Vector3f& p) const {
  Vector3f skin = of_label(PersonLabel::kFace).At(p);
  const auto H = static_cast<float>(cut_.head_height);
  if (p.z() < 0.5 * (cut_.jaw_z + cut_.ear_z)) return skin;
  const float x = std::abs(p.x()) / H, y = (p.y() - float(cut_.head_joint_y)) / H;
  const auto inside = [&](float cx, float cy, float rx, float ry) {
    const float dx = (x - cx) / rx, dy = (y - cy) / ry;
    return dx * dx + dy * dy < 1;
  };
  if (inside(0.2F, 0.28F, 0.035F, 0.035F)) return {30, 24, 22};
  if (inside(0.2F, 0.28F, 0.085F, 0.05F)) return {240, 238, 235};
  if (inside(0.21F, 0.4F, 0.11F, 0.025F)) return of_label(PersonLabel::kHair).colour;
  if (inside(0, -0.13F, 0.14F, 0.035F)) return skin.cwiseProduct(Vector3f(0.85F, 0.5F, 0.5F));
  return skin;
}

Vector3f Wardrobe::OfGarment(const Vector3f& p) const {
  if (garment_.kind != PatternKind::kDots) return garment_.At(p);
  return garment_.At({p.x(), p.y(), garment_.cell_m});  // through the middle of the balls, not between them
}

Vector3f Wardrobe::OfBody(PersonLabel label, const Vector3f& p) const {
  if (label == PersonLabel::kFace) return OfFace(p);
  const Vector3f colour = of_label(label).At(p);
  return details_ ? details_->On(label, p, colour) : colour;
}

}  // namespace bodyloom
