// SPDX-License-Identifier: Apache-2.0
#include "render/splat/project_simd.h"

#include <algorithm>

#include "render/splat/camera_gaussians.h"

#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_AVX3_DL | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/splat/project_simd.cc"
#include <hwy/foreach_target.h>
// Must come after foreach_target.h.
#include <hwy/highway.h>

#include "render/splat/float_math-inl.h"
#include "render/splat/vec3-inl.h"

HWY_BEFORE_NAMESPACE();
namespace bodyloom::splat_internal::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using bodyloom::HWY_NAMESPACE::Log2;

using DF = hn::CappedTag<float, FloatColumns::kLanes>;
using VF = hn::Vec<DF>;
using MF = hn::Mask<DF>;
using Camera = CameraGaussians;
using Screen = ScreenGaussians;

using Vec3 = bodyloom::HWY_NAMESPACE::Vec3<VF>;

/// The rows of the factor F and of B = J F. With w = 1/z, u = x w, v = y w (weak perspective: 1, 0, 0) the projection's
/// Jacobian is J = [f_x w, 0, −f_x w u; 0, f_y w, −f_y w v].
struct Footprint {
  VF w, u, v, scale_x, scale_y;
  Vec3 across, down, along;  ///< F_0 − u F_2, F_1 − v F_2, F_2
  Vec3 b1, b2;               ///< scale_x · across, scale_y · down
};

HWY_INLINE Footprint FootprintOf(const ScreenProjection& projection, VF x, VF y, VF z, const VF* f) {
  const DF d;
  Footprint p;
  const Vec3 first = {f[0], f[1], f[2]}, second = {f[3], f[4], f[5]};
  p.along = {f[6], f[7], f[8]};
  if (projection.divide_by_depth) {
    p.w = hn::Div(hn::Set(d, 1.0F), z);
    p.u = hn::Mul(x, p.w), p.v = hn::Mul(y, p.w);
    p.across = first - p.u * p.along, p.down = second - p.v * p.along;
  } else {
    p.w = hn::Set(d, 1.0F), p.u = p.v = hn::Zero(d);
    p.across = first, p.down = second;
  }
  p.scale_x = hn::Mul(hn::Set(d, projection.focal_x), p.w);
  p.scale_y = hn::Mul(hn::Set(d, projection.focal_y), p.w);
  p.b1 = p.scale_x * p.across, p.b2 = p.scale_y * p.down;
  return p;
}

void ProjectRows(const ScreenProjection& projection, ConstTable camera, int first, int last, Table screen) {
  const DF d;
  const int N = static_cast<int>(hn::Lanes(d));
  const VF zero = hn::Zero(d), one = hn::Set(d, 1.0F), low_pass = hn::Set(d, projection.low_pass_px2);
  for (int i = first; i < last; i += N) {
    VF in[Camera::kNumColumns];
    VF nothing = zero;  // NaN unless all are finite
    for (int c = 0; c < Camera::kNumColumns; ++c) {
      in[c] = hn::Load(d, camera.data + camera.stride * c + i);
      nothing = hn::Add(nothing, hn::Sub(in[c], in[c]));
    }
    MF ok = hn::Eq(nothing, zero);
    const VF opacity = in[Camera::kOpacity];
    ok = hn::And(ok, hn::And(hn::Ge(opacity, hn::Set(d, Screen::kMinAlpha)), hn::Le(opacity, one)));
    const VF z = in[Camera::kZ];
    if (projection.divide_by_depth) ok = hn::And(ok, hn::Ge(z, hn::Set(d, projection.near_m)));
    const VF maximum =
        hn::Max(hn::Max(hn::Abs(in[Camera::kRed]), hn::Abs(in[Camera::kGreen])), hn::Abs(in[Camera::kBlue]));
    ok = hn::And(ok, hn::Le(maximum, hn::Set(d, Screen::kLargestColour)));

    const VF x = in[Camera::kX], y = in[Camera::kY];
    const Footprint p = FootprintOf(projection, x, y, hn::IfThenElse(ok, z, one), in + Camera::kFactor);
    const bool divides = projection.divide_by_depth;
    const VF mean_x =
        hn::Add(hn::Mul(hn::Set(d, projection.focal_x), divides ? p.u : x), hn::Set(d, projection.centre_x));
    const VF mean_y =
        hn::Add(hn::Mul(hn::Set(d, projection.focal_y), divides ? p.v : y), hn::Set(d, projection.centre_y));
    const VF xx = Dot(p.b1, p.b1), xy = Dot(p.b1, p.b2), yy = Dot(p.b2, p.b2);
    const VF sxx = hn::Add(xx, low_pass), syy = hn::Add(yy, low_pass);
    // |B Bᵀ + l I| = |b1 × b2|² + l (|b1|² + |b2|²) + l²: no cancellation for thin Gaussians.
    const Vec3 normal = Cross(p.b1, p.b2);
    const VF det = hn::Add(Dot(normal, normal), hn::Mul(low_pass, hn::Add(hn::Add(xx, yy), low_pass)));
    ok = hn::And(ok,
                 hn::And(hn::Ge(det, hn::Set(d, 1e-12F)), hn::Ge(det, hn::Mul(hn::Set(d, 1e-7F), hn::Mul(sxx, syy)))));
    const VF scale = hn::Div(one, hn::IfThenElse(ok, det, one));
    const VF log2_opacity = Log2(d, hn::IfThenElse(ok, opacity, one));
    // q ≤ 2 ln(255 o), with a margin so that rounding excludes no pixel that reaches 1/255.
    const VF reach = hn::Mul(hn::Set(d, 1.38629436F), hn::Max(zero, hn::Add(log2_opacity, hn::Set(d, 7.99435344F))));
    const auto half = [&](VF s) HWY_ATTR {
      return hn::Add(hn::Mul(hn::Sqrt(hn::Mul(reach, s)), hn::Set(d, 1.0001F)), hn::Set(d, 0.01F));
    };
    const VF half_width = half(sxx), half_height = half(syy);
    ok = hn::And(ok, hn::Le(hn::Max(half_width, half_height), hn::Set(d, Screen::kLargestReachPx)));
    ok = hn::And(ok, hn::Le(hn::Max(hn::Abs(mean_x), hn::Abs(mean_y)), hn::Set(d, Screen::kFarthestMeanPx)));

    const auto store = [&](int column, VF value) HWY_ATTR {
      hn::Store(hn::IfThenElseZero(ok, value), d, screen.data + screen.stride * column + i);
    };
    store(Screen::kMeanX, mean_x);
    store(Screen::kMeanY, mean_y);
    store(Screen::kConicXx, hn::Mul(syy, scale));
    store(Screen::kConicXy, hn::Neg(hn::Mul(xy, scale)));
    store(Screen::kConicYy, hn::Mul(sxx, scale));
    store(Screen::kOpacity, opacity);
    store(Screen::kRed, in[Camera::kRed]);
    store(Screen::kGreen, in[Camera::kGreen]);
    store(Screen::kBlue, in[Camera::kBlue]);
    store(Screen::kDepth, z);
    store(Screen::kLog2Opacity, log2_opacity);
    const VF no = hn::Set(d, -1.0F);
    hn::Store(hn::IfThenElse(ok, half_width, no), d, screen.data + screen.stride * Screen::kHalfWidth + i);
    hn::Store(hn::IfThenElse(ok, half_height, no), d, screen.data + screen.stride * Screen::kHalfHeight + i);
  }
}

void ProjectRowsBackward(const ScreenProjection& projection, ConstTable camera, ConstTable screen, ConstTable by_screen,
                         int first, int last, Table by_camera) {
  const DF d;
  const int N = static_cast<int>(hn::Lanes(d));
  const VF zero = hn::Zero(d), one = hn::Set(d, 1.0F), two = hn::Set(d, 2.0F), half = hn::Set(d, 0.5F);
  const VF focal_x = hn::Set(d, projection.focal_x), focal_y = hn::Set(d, projection.focal_y);
  for (int i = first; i < last; i += N) {
    const MF drawn = hn::Gt(hn::Load(d, screen.data + screen.stride * Screen::kHalfWidth + i), zero);
    const auto of_camera = [&](int column) HWY_ATTR {
      return hn::IfThenElseZero(drawn, hn::Load(d, camera.data + camera.stride * column + i));
    };
    const auto of_screen = [&](int column) HWY_ATTR { return hn::Load(d, screen.data + screen.stride * column + i); };
    const auto given = [&](int column) HWY_ATTR { return hn::Load(d, by_screen.data + by_screen.stride * column + i); };
    VF f[9];
    for (int c = 0; c < 9; ++c) f[c] = of_camera(Camera::kFactor + c);
    const VF x = of_camera(Camera::kX), y = of_camera(Camera::kY);
    const VF z = hn::IfThenElse(drawn, of_camera(Camera::kZ), one);
    const Footprint p = FootprintOf(projection, x, y, z, f);

    // Derivative by the covariance: S = −K G K, with G that by K as a symmetric matrix.
    const VF kxx = of_screen(Screen::kConicXx), kxy = of_screen(Screen::kConicXy), kyy = of_screen(Screen::kConicYy);
    const VF gxx = given(Screen::kConicXx), gxy = hn::Mul(half, given(Screen::kConicXy)), gyy = given(Screen::kConicYy);
    const auto pair = [](VF a, VF b, VF e, VF g) HWY_ATTR { return hn::Add(hn::Mul(a, b), hn::Mul(e, g)); };
    const VF m00 = pair(kxx, gxx, kxy, gxy), m01 = pair(kxx, gxy, kxy, gyy);
    const VF m10 = pair(kxy, gxx, kyy, gxy), m11 = pair(kxy, gxy, kyy, gyy);
    const VF minus_two = hn::Neg(two);
    const VF s00 = hn::Mul(minus_two, pair(m00, kxx, m01, kxy)), s01 = hn::Mul(minus_two, pair(m00, kxy, m01, kyy)),
             s11 = hn::Mul(minus_two, pair(m10, kxy, m11, kyy));
    const Vec3 by_b1 = s00 * p.b1 + s01 * p.b2, by_b2 = s01 * p.b1 + s11 * p.b2;  // 2 S B
    const Vec3 by_f0 = p.scale_x * by_b1, by_f1 = p.scale_y * by_b2;
    Vec3 by_f2 = {zero, zero, zero};
    const VF mean_x = hn::Mul(focal_x, given(Screen::kMeanX)), mean_y = hn::Mul(focal_y, given(Screen::kMeanY));
    VF by_x = mean_x, by_y = mean_y, by_z = zero;
    if (projection.divide_by_depth) {
      by_f2 = hn::Neg(p.u) * by_f0 - p.v * by_f1;
      // The position enters through the mean and through J.
      const VF by_u = hn::Sub(mean_x, Dot(by_f0, p.along)), by_v = hn::Sub(mean_y, Dot(by_f1, p.along));
      const VF by_w = hn::Add(hn::Mul(focal_x, Dot(by_b1, p.across)), hn::Mul(focal_y, Dot(by_b2, p.down)));
      by_x = hn::Mul(by_u, p.w), by_y = hn::Mul(by_v, p.w);
      by_z = hn::Neg(hn::Mul(hn::Add(hn::Mul(by_w, p.w), hn::Add(hn::Mul(by_u, p.u), hn::Mul(by_v, p.v))), p.w));
    }
    const auto store = [&](int column, VF value) HWY_ATTR {
      hn::Store(hn::IfThenElseZero(drawn, value), d, by_camera.data + by_camera.stride * column + i);
    };
    store(Camera::kX, by_x);
    store(Camera::kY, by_y);
    store(Camera::kZ, by_z);
    const Vec3 rows[3] = {by_f0, by_f1, by_f2};
    for (int r = 0; r < 3; ++r) {
      store(Camera::kFactor + 3 * r, rows[r].x);
      store(Camera::kFactor + 3 * r + 1, rows[r].y);
      store(Camera::kFactor + 3 * r + 2, rows[r].z);
    }
    store(Camera::kOpacity, given(Screen::kOpacity));
    store(Camera::kRed, given(Screen::kRed));
    store(Camera::kGreen, given(Screen::kGreen));
    store(Camera::kBlue, given(Screen::kBlue));
  }
}

}  // namespace bodyloom::splat_internal::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bodyloom::splat_internal {

HWY_EXPORT(ProjectRows);
HWY_EXPORT(ProjectRowsBackward);

void ProjectRows(const ScreenProjection& projection, ConstTable camera, int first, int last, Table screen) {
  HWY_DYNAMIC_DISPATCH(ProjectRows)(projection, camera, first, last, screen);
}

void ProjectRowsBackward(const ScreenProjection& projection, ConstTable camera, ConstTable screen, ConstTable by_screen,
                         int first, int last, Table by_camera) {
  HWY_DYNAMIC_DISPATCH(ProjectRowsBackward)(projection, camera, screen, by_screen, first, last, by_camera);
}

}  // namespace bodyloom::splat_internal
#endif  // HWY_ONCE
