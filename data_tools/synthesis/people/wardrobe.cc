// SPDX-License-Identifier: Apache-2.0
#include "data_tools/synthesis/people/wardrobe.h"

#include <algorithm>
#include <cmath>

#include "geometry/base/hash_random.h"

namespace bodyloom {
namespace {

using Eigen::Vector3f;

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
