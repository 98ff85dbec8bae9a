// SPDX-License-Identifier: Apache-2.0
#include "render/gaussian_avatar/pose_simd.h"

#include <algorithm>

#include "render/splat/camera_gaussians.h"

#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_AVX3_DL | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/gaussian_avatar/pose_simd.cc"
#include <hwy/foreach_target.h>
// Must come after foreach_target.h.
#include <hwy/highway.h>

#include "geometry/math/quad-inl.h"
#include "render/splat/float_math-inl.h"
#include "render/splat/vec3-inl.h"

HWY_BEFORE_NAMESPACE();
namespace bodyloom::avatar_internal::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using bodyloom::HWY_NAMESPACE::Exp;
using bodyloom::HWY_NAMESPACE::Fill;
using bodyloom::HWY_NAMESPACE::LoadQuadU;
using bodyloom::HWY_NAMESPACE::Quad;
using bodyloom::HWY_NAMESPACE::StoreQuad;
using bodyloom::HWY_NAMESPACE::StoreQuadU;

using DF = hn::CappedTag<float, kLanes>;
using VF = hn::Vec<DF>;
using MF = hn::Mask<DF>;
using Vec3 = bodyloom::HWY_NAMESPACE::Vec3<VF>;
using Mat3 = bodyloom::HWY_NAMESPACE::Mat3<VF>;
using Body = GaussianBody;
using Posed = CameraGaussians;

constexpr int kN = static_cast<int>(hn::MaxLanes(DF()));
constexpr int kInfluences = Body::kInfluences;
constexpr float kSh1 = 0.48860251F, kSh2 = 1.09254843F, kSh3 = 0.31539157F, kSh4 = 0.54627421F, kSh0 = 0.28209479F;

/// Sixteen Gaussians: their weights and blended bones.
struct Block {
  alignas(64) float weight[kInfluences][kLanes];
  alignas(64) float bone[3][kLanes][4];  ///< rows of [A | t]
  alignas(64) float corrective[kLanes][4];
  alignas(64) float is_live[kLanes];  ///< backward pass: 1 for rows with nonzero derivatives, else 0
};

/// Reads columns from a given row on.
struct Reader {
  const float* data;
  size_t stride;
  HWY_INLINE VF operator()(int column) const { return hn::Load(DF(), data + stride * column); }
  HWY_INLINE Vec3 Three(int column) const { return {(*this)(column), (*this)(column + 1), (*this)(column + 2)}; }
};

HWY_INLINE void FindWeights(const Reader& parameters, int lane, Block* block) {
  const DF d;
  VF logit[kInfluences], maximum = parameters(Body::kWeightLogit), sum = hn::Zero(d);
  for (int k = 0; k < kInfluences; ++k) {
    logit[k] = parameters(Body::kWeightLogit + k);
    maximum = hn::Max(maximum, logit[k]);
  }
  for (int k = 0; k < kInfluences; ++k) {
    logit[k] = Exp(d, hn::Sub(logit[k], maximum));
    sum = hn::Add(sum, logit[k]);
  }
  for (int k = 0; k < kInfluences; ++k) hn::Store(hn::Div(logit[k], sum), d, block->weight[k] + lane);
}

HWY_INLINE void BlendBones(const PoseTables& tables, int first, int last, Block* block) {
  for (int part = 0; part < kLanes; part += kN) {
    FindWeights({tables.parameters + first + part, tables.parameter_stride}, part, block);
  }
  for (int lane = 0; lane < kLanes; ++lane) {
    const int64_t row = std::min(first + lane, last - 1);
    const int32_t* joints = tables.joints + row * kInfluences;
    Quad a = Fill(0), b = a, c = a;
    for (int k = 0; k < kInfluences; ++k) {
      const float* bone = tables.bones + 12 * static_cast<int64_t>(joints[k]);
      const Quad weight = Fill(block->weight[k][lane]);
      a = a + weight * LoadQuadU(bone), b = b + weight * LoadQuadU(bone + 4), c = c + weight * LoadQuadU(bone + 8);
    }
    StoreQuad(a, block->bone[0][lane]);
    StoreQuad(b, block->bone[1][lane]);
    StoreQuad(c, block->bone[2][lane]);
    const SkinAnchor& anchor = tables.anchors[row];
    Quad moved = Fill(0);
    if (tables.correctives != nullptr && anchor.corrective_factor != 0) {
      const int32_t* corners = tables.faces + 3 * static_cast<int64_t>(anchor.face);
      for (int k = 0; k < 3; ++k) {
        moved = moved + Fill(anchor.corrective_factor * anchor.barycentric[k]) *
                            LoadQuadU(tables.correctives + 4 * static_cast<int64_t>(corners[k]));
      }
    }
    StoreQuad(moved, block->corrective[lane]);
  }
}

/// [A | t] of the lanes from `lane` on.
HWY_INLINE void LoadBone(const Block& block, int lane, Mat3* a, Vec3* t) {
  const DF d;
  hn::LoadInterleaved4(d, block.bone[0][lane], a->r0.x, a->r0.y, a->r0.z, t->x);
  hn::LoadInterleaved4(d, block.bone[1][lane], a->r1.x, a->r1.y, a->r1.z, t->y);
  hn::LoadInterleaved4(d, block.bone[2][lane], a->r2.x, a->r2.y, a->r2.z, t->z);
}

/// Normalises a vector and returns 1 over its length; both zero if it is shorter than 1e-6.
HWY_INLINE VF Normalise(Vec3* v) {
  const DF d;
  const VF square = Dot(*v, *v);
  const MF none = hn::Lt(square, hn::Set(d, 1e-12F));
  const VF inverse = hn::IfThenZeroElse(none, hn::Div(hn::Set(d, 1.0F), hn::Sqrt(square)));
  *v = inverse * *v;
  return inverse;
}

struct Turn {
  VF w, x, y, z;  ///< unit length; zeros, which give the identity, if the input is no rotation
  VF inverse;     ///< 1 over the length of the input; 0 if it is no rotation
  Mat3 r;
};

HWY_INLINE Turn TurnOf(const Reader& parameters) {
  const DF d;
  const VF one = hn::Set(d, 1.0F), two = hn::Set(d, 2.0F);
  VF q[4], square = hn::Zero(d);
  for (int k = 0; k < 4; ++k) {
    q[k] = parameters(Body::kQuaternion + k);
    square = hn::Add(square, hn::Mul(q[k], q[k]));
  }
  const MF none = hn::Lt(square, hn::Set(d, 1e-12F));
  Turn t;
  t.inverse = hn::IfThenZeroElse(none, hn::Div(one, hn::Sqrt(square)));
  t.w = hn::Mul(q[0], t.inverse), t.x = hn::Mul(q[1], t.inverse), t.y = hn::Mul(q[2], t.inverse),
  t.z = hn::Mul(q[3], t.inverse);
  const VF xx = hn::Mul(t.x, t.x), yy = hn::Mul(t.y, t.y), zz = hn::Mul(t.z, t.z);
  const VF xy = hn::Mul(t.x, t.y), xz = hn::Mul(t.x, t.z), yz = hn::Mul(t.y, t.z);
  const VF wx = hn::Mul(t.w, t.x), wy = hn::Mul(t.w, t.y), wz = hn::Mul(t.w, t.z);
  const auto diagonal = [&](VF a, VF b) HWY_ATTR { return hn::Sub(one, hn::Mul(two, hn::Add(a, b))); };
  const auto plus = [&](VF a, VF b) HWY_ATTR { return hn::Mul(two, hn::Add(a, b)); };
  const auto minus = [&](VF a, VF b) HWY_ATTR { return hn::Mul(two, hn::Sub(a, b)); };
  t.r = {{diagonal(yy, zz), minus(xy, wz), plus(xz, wy)},
         {plus(xy, wz), diagonal(xx, zz), minus(yz, wx)},
         {minus(xz, wy), plus(yz, wx), diagonal(xx, yy)}};
  return t;
}

/// Computes Y_h of a unit vector (render/lighting/sh_lighting.h).
HWY_INLINE void FindBasis(Vec3 n, VF* basis) {
  const DF d;
  const VF c1 = hn::Set(d, kSh1), c2 = hn::Set(d, kSh2);
  basis[0] = hn::Set(d, kSh0);
  basis[1] = hn::Mul(c1, n.y), basis[2] = hn::Mul(c1, n.z), basis[3] = hn::Mul(c1, n.x);
  basis[4] = hn::Mul(c2, hn::Mul(n.x, n.y)), basis[5] = hn::Mul(c2, hn::Mul(n.y, n.z));
  basis[6] = hn::Mul(hn::Set(d, kSh3), hn::Sub(hn::Mul(hn::Set(d, 3.0F), hn::Mul(n.z, n.z)), hn::Set(d, 1.0F)));
  basis[7] = hn::Mul(c2, hn::Mul(n.x, n.z));
  basis[8] = hn::Mul(hn::Set(d, kSh4), hn::Sub(hn::Mul(n.x, n.x), hn::Mul(n.y, n.y)));
}

/// Values of one register of Gaussians shared by both passes.
struct Pose {
  Mat3 a;
  Vec3 t, rest;
  Turn turn;
  Vec3 scale;
  Mat3 shape;  ///< R diag(scale)
  Vec3 rest_normal, normal;
  VF normal_inverse;
  VF basis[9];
  VF opacity;
  Vec3 albedo, shading;
};

HWY_INLINE Mat3 LightFromFrame(const float* m) {
  const DF d;
  const auto row = [&](int r) HWY_ATTR {
    return Vec3{hn::Set(d, m[3 * r]), hn::Set(d, m[3 * r + 1]), hn::Set(d, m[3 * r + 2])};
  };
  return {row(0), row(1), row(2)};
}

HWY_INLINE void FindPose(const PoseTables& tables, int row, const Block& block, int lane, Pose* pose) {
  const DF d;
  const VF one = hn::Set(d, 1.0F);
  const Reader parameters = {tables.parameters + row, tables.parameter_stride};
  LoadBone(block, lane, &pose->a, &pose->t);
  pose->rest = parameters.Three(Body::kPosition);
  pose->albedo = parameters.Three(Body::kAlbedo);
  const Vec3 log_scale = parameters.Three(Body::kLogScale);
  const VF logit = parameters(Body::kOpacityLogit);
  pose->turn = TurnOf(parameters);
  pose->scale = {Exp(d, log_scale.x), Exp(d, log_scale.y), Exp(d, log_scale.z)};
  const auto scaled = [&](Vec3 r) HWY_ATTR {
    return Vec3{hn::Mul(r.x, pose->scale.x), hn::Mul(r.y, pose->scale.y), hn::Mul(r.z, pose->scale.z)};
  };
  pose->shape = {scaled(pose->turn.r.r0), scaled(pose->turn.r.r1), scaled(pose->turn.r.r2)};
  pose->opacity = hn::Div(one, hn::Add(one, Exp(d, hn::Neg(logit))));
  pose->rest_normal = parameters.Three(Body::kNormal);
  pose->normal = pose->a * pose->rest_normal;
  pose->normal_inverse = Normalise(&pose->normal);
  pose->normal = LightFromFrame(tables.light_from_frame) * pose->normal;
  FindBasis(pose->normal, pose->basis);
  const auto shade = [&](int channel) HWY_ATTR {
    VF sum = hn::Zero(d);
    for (int h = 0; h < 9; ++h) {
      sum = hn::Add(sum, hn::Mul(hn::Set(d, tables.light[9 * channel + h]), pose->basis[h]));
    }
    return sum;
  };
  pose->shading = {shade(0), shade(1), shade(2)};
}

void PoseRows(const PoseTables& tables, int first, int last, float* posed, size_t posed_stride) {
  const DF d;
  Block block;
  for (int i = first; i < last; i += kLanes) {
    BlendBones(tables, i, last, &block);
    for (int lane = 0; lane < kLanes; lane += kN) {
      Pose pose;
      FindPose(tables, i + lane, block, lane, &pose);
      Vec3 corrective;
      VF unused;
      hn::LoadInterleaved4(d, block.corrective[lane], corrective.x, corrective.y, corrective.z, unused);
      const Vec3 place = (pose.a * pose.rest + pose.t) + corrective;
      const Mat3 factor = TimesTransposed(pose.a, Transposed(pose.shape));
      const auto store = [&](int column, VF value)
                             HWY_ATTR { hn::Store(value, d, posed + posed_stride * column + i + lane); };
      const auto store3 = [&](int column, Vec3 value) HWY_ATTR {
        store(column, value.x);
        store(column + 1, value.y);
        store(column + 2, value.z);
      };
      store3(Posed::kX, place);
      store3(Posed::kFactor, factor.r0);
      store3(Posed::kFactor + 3, factor.r1);
      store3(Posed::kFactor + 6, factor.r2);
      store(Posed::kOpacity, pose.opacity);
      store(Posed::kRed, hn::Mul(pose.albedo.x, pose.shading.x));
      store(Posed::kGreen, hn::Mul(pose.albedo.y, pose.shading.y));
      store(Posed::kBlue, hn::Mul(pose.albedo.z, pose.shading.z));
    }
  }
}

/// Derivative by a quaternion of any length, from that by the rotation matrix.
HWY_INLINE void FindByQuaternion(const Turn& t, const Mat3& g, VF* by) {
  const DF d;
  const VF two = hn::Set(d, 2.0F);
  const VF xy = hn::Add(g.r0.y, g.r1.x), xz = hn::Add(g.r0.z, g.r2.x), yz = hn::Add(g.r1.z, g.r2.y);
  const VF wx = hn::Sub(g.r2.y, g.r1.z), wy = hn::Sub(g.r0.z, g.r2.x), wz = hn::Sub(g.r1.x, g.r0.y);
  const auto sum = [&](VF a, VF b, VF c, VF e) HWY_ATTR { return hn::Mul(two, hn::Add(hn::Add(a, b), hn::Add(c, e))); };
  const auto own = [&](VF q, VF a, VF b) HWY_ATTR { return hn::Neg(hn::Mul(two, hn::Mul(q, hn::Add(a, b)))); };
  const VF gw = sum(hn::Mul(t.x, wx), hn::Mul(t.y, wy), hn::Mul(t.z, wz), hn::Zero(d));
  const VF gx = sum(own(t.x, g.r1.y, g.r2.z), hn::Mul(t.y, xy), hn::Mul(t.z, xz), hn::Mul(t.w, wx));
  const VF gy = sum(hn::Mul(t.x, xy), own(t.y, g.r0.x, g.r2.z), hn::Mul(t.z, yz), hn::Mul(t.w, wy));
  const VF gz = sum(hn::Mul(t.x, xz), hn::Mul(t.y, yz), own(t.z, g.r0.x, g.r1.y), hn::Mul(t.w, wz));
  const VF along = hn::Add(hn::Add(hn::Mul(gw, t.w), hn::Mul(gx, t.x)), hn::Add(hn::Mul(gy, t.y), hn::Mul(gz, t.z)));
  const auto across = [&](VF gk, VF q) HWY_ATTR { return hn::Mul(t.inverse, hn::Sub(gk, hn::Mul(along, q))); };
  by[0] = across(gw, t.w), by[1] = across(gx, t.x), by[2] = across(gy, t.y), by[3] = across(gz, t.z);
}

/// Derivative by the unit normal in the light's frame; adds to the sums for the light.
HWY_INLINE Vec3 FindByNormal(const PoseTables& tables, const Pose& pose, MF is_live, Vec3 by_colour,
                             float* light_sums) {
  const DF d;
  const VF by_shading[3] = {hn::Mul(by_colour.x, pose.albedo.x), hn::Mul(by_colour.y, pose.albedo.y),
                            hn::Mul(by_colour.z, pose.albedo.z)};
  VF g[9];
  for (int h = 0; h < 9; ++h) {
    g[h] = hn::Zero(d);
    for (int c = 0; c < 3; ++c) {
      g[h] = hn::Add(g[h], hn::Mul(by_shading[c], hn::Set(d, tables.light[9 * c + h])));
      float* sum = light_sums + (9 * c + h) * kLanes;
      const VF more = hn::IfThenElseZero(is_live, hn::Mul(by_shading[c], pose.basis[h]));
      hn::Store(hn::Add(hn::Load(d, sum), more), d, sum);
    }
  }
  const VF c1 = hn::Set(d, kSh1), c2 = hn::Set(d, kSh2), c4 = hn::Set(d, 2 * kSh4);
  const Vec3 n = pose.normal;
  const auto line = [&](VF one, VF a, VF ga, VF b, VF gb) HWY_ATTR {
    return hn::Add(hn::Mul(c1, one), hn::Mul(c2, hn::Add(hn::Mul(a, ga), hn::Mul(b, gb))));
  };
  const VF across = hn::Mul(c4, g[8]);
  return {hn::Add(line(g[3], n.y, g[4], n.z, g[7]), hn::Mul(across, n.x)),
          hn::Sub(line(g[1], n.x, g[4], n.z, g[5]), hn::Mul(across, n.y)),
          hn::Add(line(g[2], n.y, g[5], n.x, g[7]), hn::Mul(hn::Set(d, 6 * kSh3), hn::Mul(n.z, g[6])))};
}

/// Derivatives by the weights' logits, from that by [A | t] in block->bone; adds to the sums for the bones.
HWY_INLINE void GoBackThroughBlend(const PoseTables& tables, int first, int last, const Block& block,
                                   float* by_parameters, size_t stride, float* bone_sums) {
  const DF d;
  alignas(64) float products[kInfluences][kLanes][4];
  for (int lane = 0; lane < kLanes; ++lane) {
    const int64_t row = std::min(first + lane, last - 1);
    const int32_t* joints = tables.joints + row * kInfluences;
    if (block.is_live[lane] == 0) {
      for (int k = 0; k < kInfluences; ++k) StoreQuad(Fill(0), products[k][lane]);
      continue;
    }
    const Quad a = LoadQuadU(block.bone[0][lane]), b = LoadQuadU(block.bone[1][lane]),
               c = LoadQuadU(block.bone[2][lane]);
    for (int k = 0; k < kInfluences; ++k) {
      const int64_t at = 12 * static_cast<int64_t>(joints[k]);
      const float* bone = tables.bones + at;
      float* sum = bone_sums + at;
      StoreQuad((a * LoadQuadU(bone) + b * LoadQuadU(bone + 4)) + c * LoadQuadU(bone + 8), products[k][lane]);
      const Quad weight = Fill(block.weight[k][lane]);
      StoreQuadU(LoadQuadU(sum) + weight * a, sum);
      StoreQuadU(LoadQuadU(sum + 4) + weight * b, sum + 4);
      StoreQuadU(LoadQuadU(sum + 8) + weight * c, sum + 8);
    }
  }
  for (int lane = 0; lane < kLanes; lane += kN) {
    const MF is_live = hn::Gt(hn::Load(d, block.is_live + lane), hn::Zero(d));
    VF by_weight[kInfluences], mean = hn::Zero(d);
    for (int k = 0; k < kInfluences; ++k) {
      VF p[4];
      hn::LoadInterleaved4(d, products[k][lane], p[0], p[1], p[2], p[3]);
      by_weight[k] = hn::Add(hn::Add(p[0], p[1]), hn::Add(p[2], p[3]));
      mean = hn::Add(mean, hn::Mul(by_weight[k], hn::Load(d, block.weight[k] + lane)));
    }
    for (int k = 0; k < kInfluences; ++k) {
      const VF by_logit = hn::Mul(hn::Load(d, block.weight[k] + lane), hn::Sub(by_weight[k], mean));
      hn::Store(hn::IfThenElseZero(is_live, by_logit), d,
                by_parameters + stride * (Body::kWeightLogit + k) + first + lane);
    }
  }
}

void PoseRowsBackward(const PoseTables& tables, const float* by_posed, size_t by_posed_stride, int first, int last,
                      float* by_parameters, size_t by_parameter_stride, const PoseSums& sums) {
  const DF d;
  const VF one = hn::Set(d, 1.0F);
  const Mat3 frame_from_light = Transposed(LightFromFrame(tables.light_from_frame));
  Block block;
  for (int i = first; i < last; i += kLanes) {
    BlendBones(tables, i, last, &block);
    for (int lane = 0; lane < kLanes; lane += kN) {
      const int at = i + lane;
      Pose pose;
      FindPose(tables, at, block, lane, &pose);
      const auto count = static_cast<size_t>(std::clamp(last - at, 0, kN));  // excludes spare rows from the sums
      const MF exists = hn::FirstN(d, count);
      MF is_live = hn::MaskFromVec(hn::Zero(d));
      for (int c = 0; c < Posed::kNumColumns; ++c) {
        is_live = hn::Or(is_live, hn::Ne(hn::Load(d, by_posed + by_posed_stride * c + at), hn::Zero(d)));
      }
      // Rows that are not drawn may hold NaN, which multiplication by zero does not remove.
      is_live = hn::And(is_live, exists);
      hn::Store(hn::IfThenElseZero(is_live, one), d, block.is_live + lane);
      const auto given = [&](int column) HWY_ATTR {
        return hn::IfThenElseZero(is_live, hn::Load(d, by_posed + by_posed_stride * column + at));
      };
      const auto given3 = [&](int column) HWY_ATTR {
        return Vec3{given(column), given(column + 1), given(column + 2)};
      };
      const auto store = [&](int column, VF value) HWY_ATTR {
        hn::Store(hn::IfThenElseZero(is_live, value), d, by_parameters + by_parameter_stride * column + at);
      };
      const auto store3 = [&](int column, Vec3 value) HWY_ATTR {
        store(column, value.x);
        store(column + 1, value.y);
        store(column + 2, value.z);
      };
      const Mat3 to_rest = Transposed(pose.a);
      // Colour: albedo, light, normal.
      const Vec3 by_colour = given3(Posed::kRed);
      store3(Body::kAlbedo, Vec3{hn::Mul(by_colour.x, pose.shading.x), hn::Mul(by_colour.y, pose.shading.y),
                                 hn::Mul(by_colour.z, pose.shading.z)});
      Vec3 by_normal = FindByNormal(tables, pose, is_live, by_colour, sums.light + lane);
      by_normal = by_normal - Dot(by_normal, pose.normal) * pose.normal;
      by_normal = pose.normal_inverse * (frame_from_light * by_normal);
      store3(Body::kNormal, to_rest * by_normal);
      // Position and shape.
      const Vec3 by_place = given3(Posed::kX);
      store3(Body::kPosition, to_rest * by_place);
      const Mat3 by_factor = {given3(Posed::kFactor), given3(Posed::kFactor + 3), given3(Posed::kFactor + 6)};
      const Mat3 by_shape = TimesTransposed(to_rest, Transposed(by_factor));
      const auto by_axis = [&](VF a, VF b, VF c, VF e, VF f, VF g)
                               HWY_ATTR { return hn::Add(hn::Add(hn::Mul(a, b), hn::Mul(c, e)), hn::Mul(f, g)); };
      const Mat3 &g = by_shape, &s = pose.shape;
      store3(Body::kLogScale, Vec3{by_axis(g.r0.x, s.r0.x, g.r1.x, s.r1.x, g.r2.x, s.r2.x),
                                   by_axis(g.r0.y, s.r0.y, g.r1.y, s.r1.y, g.r2.y, s.r2.y),
                                   by_axis(g.r0.z, s.r0.z, g.r1.z, s.r1.z, g.r2.z, s.r2.z)});
      const auto scaled = [&](Vec3 r) HWY_ATTR {
        return Vec3{hn::Mul(r.x, pose.scale.x), hn::Mul(r.y, pose.scale.y), hn::Mul(r.z, pose.scale.z)};
      };
      VF by_quaternion[4];
      FindByQuaternion(pose.turn, {scaled(g.r0), scaled(g.r1), scaled(g.r2)}, by_quaternion);
      for (int k = 0; k < 4; ++k) store(Body::kQuaternion + k, by_quaternion[k]);
      store(Body::kOpacityLogit, hn::Mul(given(Posed::kOpacity), hn::Mul(pose.opacity, hn::Sub(one, pose.opacity))));
      // All three depend on the blended bone.
      const Mat3 by_a =
          (TimesTransposed(by_factor, pose.shape) + Outer(by_place, pose.rest)) + Outer(by_normal, pose.rest_normal);
      hn::StoreInterleaved4(by_a.r0.x, by_a.r0.y, by_a.r0.z, by_place.x, d, block.bone[0][lane]);
      hn::StoreInterleaved4(by_a.r1.x, by_a.r1.y, by_a.r1.z, by_place.y, d, block.bone[1][lane]);
      hn::StoreInterleaved4(by_a.r2.x, by_a.r2.y, by_a.r2.z, by_place.z, d, block.bone[2][lane]);
    }
    GoBackThroughBlend(tables, i, last, block, by_parameters, by_parameter_stride, sums.bones);
  }
}

}  // namespace bodyloom::avatar_internal::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bodyloom::avatar_internal {

HWY_EXPORT(PoseRows);
HWY_EXPORT(PoseRowsBackward);

void PoseRows(const PoseTables& tables, int first, int last, float* posed, size_t posed_stride) {
  HWY_DYNAMIC_DISPATCH(PoseRows)(tables, first, last, posed, posed_stride);
}

void PoseRowsBackward(const PoseTables& tables, const float* by_posed, size_t by_posed_stride, int first, int last,
                      float* by_parameters, size_t by_parameter_stride, const PoseSums& sums) {
  HWY_DYNAMIC_DISPATCH(PoseRowsBackward)
  (tables, by_posed, by_posed_stride, first, last, by_parameters, by_parameter_stride, sums);
}

}  // namespace bodyloom::avatar_internal
#endif  // HWY_ONCE
