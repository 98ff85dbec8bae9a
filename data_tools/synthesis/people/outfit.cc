// SPDX-License-Identifier: Apache-2.0
#include "data_tools/synthesis/people/outfit.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "data_tools/synthesis/clips/smooth_curve.h"
#include "data_tools/synthesis/pose_joints.h"
#include "geometry/base/check.h"
#include "geometry/base/hash_random.h"

namespace bodyloom {
namespace {

using Eigen::Vector3d;

constexpr double kUsualHeight_m = 1.71;

/// The hair's plane rises from the ears to the forehead at this slope.
const Vector3d kHairNormal = Vector3d(0, 0.81, -0.584).normalized();

}  // namespace

std::string ToString(GarmentKind kind) {
  switch (kind) {
    case GarmentKind::kSuit:
      return "suit";
    case GarmentKind::kSkirt:
      return "skirt";
    case GarmentKind::kCoat:
      return "coat";
  }
  return "";
}

GarmentKind GarmentKindFromString(const std::string& name) {
  for (const GarmentKind kind : {GarmentKind::kSuit, GarmentKind::kSkirt, GarmentKind::kCoat}) {
    if (ToString(kind) == name) return kind;
  }
  throw std::invalid_argument("garment \"" + name + "\", expected skirt, coat or suit");
}

std::string ToString(ClothesStyle style) { return style == ClothesStyle::kEveryday ? "everyday" : "patterned"; }

ClothesStyle ClothesStyleFromString(const std::string& name) {
  for (const ClothesStyle style : {ClothesStyle::kPatterned, ClothesStyle::kEveryday}) {
    if (ToString(style) == name) return style;
  }
  throw std::invalid_argument("clothes \"" + name + "\", expected patterned or everyday");
}

Outfit::Outfit(const BodyModel& body, GarmentKind kind, uint64_t seed, ClothesStyle style)
    : kind_(kind), style_(style) {
  constexpr int kWithoutHands = 22;
  const std::vector<int>& smpl = SmplParents();
  BODYLOOM_CHECK(body.num_joints() >= kWithoutHands &&
                     std::equal(smpl.begin(), smpl.begin() + kWithoutHands, body.parents().begin()),
                 "outfit: ", body.name(), " with ", body.num_joints(), " joints, expected a body on SMPL's first 22");
  const MatrixX3d& joints = body.joint_template();
  const MatrixX3d& vertices = body.data().v_template;
  const double top_y = vertices.col(1).maxCoeff(), bottom_y = vertices.col(1).minCoeff();
  OutfitCut& c = cut_;
  c.unit = (top_y - bottom_y) / kUsualHeight_m;
  HashRandom random(seed, {0x6f757466});
  const auto between = [&](double low, double high) { return random.Uniform(low, high); };

  c.waist_y = joints(kPelvis, 1) + (kind == GarmentKind::kSkirt ? between(0.55, 0.8) : between(0.1, 0.5)) *
                                       (joints(kSpine1, 1) - joints(kPelvis, 1));
  c.neck_x = joints(kNeck, 0), c.neck_z = joints(kNeck, 2);
  c.neck_y = joints(kNeck, 1) - 0.045 * c.unit;
  c.neck_radius_x = between(0.07, 0.095) * c.unit, c.neck_radius_z = between(0.07, 0.12) * c.unit;
  const double shoulder = joints(kLeftShoulder, 0), elbow = joints(kLeftElbow, 0), wrist = joints(kLeftWrist, 0);
  switch (kind == GarmentKind::kCoat ? 2 : random.Below(3)) {
    case 0:
      c.sleeve_x = shoulder + between(0.35, 0.7) * (elbow - shoulder);
      break;
    case 1:
      c.sleeve_x = elbow + between(0.0, 0.4) * (wrist - elbow);
      break;
    default:
      c.sleeve_x = wrist - 0.015 * c.unit;
  }
  const double knee = joints(kLeftKnee, 1), ankle = joints(kLeftAnkle, 1);
  const bool long_trousers = kind == GarmentKind::kCoat || random.Uniform() < 0.7;
  c.hem_y = kind == GarmentKind::kSkirt ? 0.7 * joints(1, 1) + 0.3 * knee
            : long_trousers             ? ankle + 0.01 * c.unit
                                        : knee + between(-0.02, 0.1) * c.unit;
  c.shoe_y = ankle + between(-0.01, 0.05) * c.unit;
  const double head_height = top_y - joints(kHead, 1), front_z = [&] {
    double z = -1e9;
    for (int v = 0; v < vertices.rows(); ++v) {
      if (vertices(v, 1) > joints(kHead, 1)) z = std::max(z, vertices(v, 2));
    }
    return z;
  }();
  c.head_joint_y = joints(kHead, 1), c.head_height = head_height;
  c.head_y = joints(kNeck, 1);
  c.jaw_y = joints(kHead, 1) - 0.35 * head_height, c.jaw_z = front_z - 0.02 * c.unit;
  c.ear_y = joints(kHead, 1) + 0.1 * head_height, c.ear_z = joints(kHead, 2) - 0.29 * head_height;
  c.nape_y = joints(kHead, 1) - between(0.25, 0.5) * head_height;
  top_m_ = between(0.005, 0.009) * c.unit, trousers_m_ = between(0.006, 0.012) * c.unit;
  flare_m_ = between(0, 0.015) * c.unit, shoes_m_ = between(0.006, 0.01) * c.unit;
  hair_m_ = between(0.012, 0.028) * c.unit;
  hip_z_ = joints(kLeftHip, 2), sole_y_ = bottom_y;
  if (style == ClothesStyle::kEveryday) CutEveryday(seed, joints);
  offsets_m_.reserve(vertices.rows());
  for (int v = 0; v < vertices.rows(); ++v) offsets_m_.push_back(OffsetAt(vertices.row(v).transpose()));
}

/// Widths of trousers and shirts, drawn apart from the rest.
void Outfit::CutEveryday(uint64_t seed, const MatrixX3d& joints) {
  OutfitCut& c = cut_;
  HashRandom random(seed, {0x65766572});
  const auto between = [&](double low, double high) { return random.Uniform(low, high) * c.unit; };
  const double width = random.Uniform();
  if (width < 0.35) {  // slim
    trousers_m_ = between(0.004, 0.01), flare_m_ = between(0, 0.01);
  } else if (width < 0.7) {  // straight
    trousers_m_ = between(0.01, 0.018), flare_m_ = between(0.01, 0.03), even_flare_ = true;
  } else {  // wide
    trousers_m_ = between(0.015, 0.028), flare_m_ = between(0.03, 0.065), even_flare_ = true;
  }
  const bool loose = random.Uniform() < 0.65;
  top_m_ = loose ? between(0.01, 0.028) : between(0.004, 0.008);
  const double hang = between(-0.14, 0.07);  // down to the crotch
  if (kind_ == GarmentKind::kSuit && random.Uniform() < 0.75) {
    tucked_in_ = false;
    c.waist_y = joints(kPelvis, 1) + hang;
    top_m_ = std::max(top_m_, trousers_m_ + 0.15 * flare_m_ + 0.003 * c.unit);  // over the flare's beginning
  }
  hair_m_ = between(0.012, 0.042);
  has_top_ = kind_ != GarmentKind::kSuit || random.Uniform() >= 0.12;
  has_shoes_ = random.Uniform() >= 0.2;
  if (!has_top_) top_m_ = 0;
  if (!has_shoes_) shoes_m_ = 0;
  if (has_top_ && kind_ == GarmentKind::kSuit && random.Uniform() < 0.08) {  // no sleeves
    c.sleeve_x = joints(kLeftShoulder, 0) - between(0.0, 0.02);
    c.armpit_y = joints(kLeftShoulder, 1) - 0.13 * c.unit;  // hips may be as wide as shoulders
  }
  if (random.Uniform() < 0.3) {
    c.long_hair_y = joints(kNeck, 1) - between(0.02, 0.3);
    c.long_hair_x = between(0.06, 0.11);
  }
}

/// Distance (about) from the edge of the hair that hangs down the back, positive inside; empty if it is not long.
double Outfit::LongHairDepth(const Vector3d& p) const {
  const double above_round_end = std::min(0.0, p.y() - cut_.long_hair_y - cut_.long_hair_x);
  return std::min(cut_.neck_z - p.z(), cut_.long_hair_x - std::hypot(p.x(), above_round_end));
}

/// Distance from the hair's edge, positive where hair grows or hangs.
double Outfit::HairDepth(const Vector3d& p) const {
  const double grown = std::min(kHairNormal.dot(p - Vector3d(0, cut_.ear_y, cut_.ear_z)), p.y() - cut_.nape_y);
  return std::max(grown, LongHairDepth(p));
}

double Outfit::NeckHole(const Vector3d& p) const {
  const double x = (p.x() - cut_.neck_x) / cut_.neck_radius_x, z = (p.z() - cut_.neck_z) / cut_.neck_radius_z;
  return std::min((1 - std::sqrt(x * x + z * z)) * cut_.neck_radius_x, p.y() - cut_.neck_y);
}

double Outfit::InsideSleeve(const Vector3d& p) const {
  return std::max(cut_.sleeve_x - std::abs(p.x()), cut_.armpit_y - p.y());
}

PersonLabel Outfit::LabelAt(const Vector3d& p) const {
  const OutfitCut& c = cut_;
  if (p.y() > c.head_y) {
    if (HairDepth(p) > 0) return PersonLabel::kHair;
    return p.y() > c.jaw_y + 0.5 * (c.jaw_z - p.z()) ? PersonLabel::kFace : PersonLabel::kSkin;
  }
  if (LongHairDepth(p) > 0) return PersonLabel::kHair;
  if (has_shoes_ && p.y() < c.shoe_y) return PersonLabel::kShoes;
  if (p.y() < c.waist_y) return p.y() < c.hem_y ? PersonLabel::kSkin : PersonLabel::kBottom;
  return !has_top_ || InsideSleeve(p) < 0 || NeckHole(p) > 0 ? PersonLabel::kSkin : PersonLabel::kTop;
}

double Outfit::OffsetAt(const Vector3d& p) const {
  const OutfitCut& c = cut_;
  const double edge = 0.012 * c.unit;  // from the skin to a garment's full thickness
  if (p.y() > c.head_y) return hair_m_ * SmoothStep(HairDepth(p) / (3 * edge));
  // A shirt that is tucked in is thin at the waist, so that trousers or a skirt go over it.
  const double tucked = c.waist_y + 2 * edge;
  const double at_waist = tucked_in_ ? 0.5 + 0.5 * SmoothStep((p.y() - tucked) / (4 * edge)) : 1;
  const double top = top_m_ * SmoothStep(InsideSleeve(p) / edge) * SmoothStep(-NeckHole(p) / edge) * at_waist *
                     SmoothStep((p.y() - (c.waist_y - 2 * edge)) / edge);
  const double share = std::clamp((c.waist_y - p.y()) / (c.waist_y - c.hem_y), 0.0, 1.0);
  const double bottom = kind_ == GarmentKind::kSkirt ? 0.3 * trousers_m_ * SmoothStep((p.y() - c.hem_y) / edge)
                                                     : (trousers_m_ + flare_m_ * share * (even_flare_ ? 1 : share)) *
                                                           SmoothStep((p.y() - c.hem_y) / edge);
  const double shoes = shoes_m_ * SmoothStep((c.shoe_y - p.y()) / edge);
  const double below_waist = bottom * SmoothStep((c.waist_y + edge - p.y()) / edge);
  const double hair = hair_m_ * SmoothStep(LongHairDepth(p) / (3 * edge));
  return std::max({top, below_waist, shoes, hair});
}

}  // namespace bodyloom
