// SPDX-License-Identifier: Apache-2.0
#include "render/gaussian_avatar/learning/adam_simd.h"

#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_AVX3_DL | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/gaussian_avatar/learning/adam_simd.cc"
#include <hwy/foreach_target.h>
// Must come after foreach_target.h.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace bodyloom::avatar_internal::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using DA = hn::CappedTag<float, kAdamLanes>;
using VA = hn::Vec<DA>;

void StepAdamColumn(const AdamColumn& c, int first, int last) {
  const DA d;
  const VA fresh1 = hn::Set(d, 1 - kAdamBeta1), fresh2 = hn::Set(d, 1 - kAdamBeta2);
  const VA rate = hn::Set(d, c.rate), epsilon = hn::Set(d, kAdamEpsilon);
  for (int i = first; i < last; i += static_cast<int>(hn::MaxLanes(d))) {
    const VA g = hn::LoadU(d, c.gradient + i), moves = hn::LoadU(d, c.moves + i);
    VA m = hn::LoadU(d, c.first + i), v = hn::LoadU(d, c.second + i);
    m = hn::Add(m, hn::Mul(hn::Mul(moves, fresh1), hn::Sub(g, m)));
    v = hn::Add(v, hn::Mul(hn::Mul(moves, fresh2), hn::Sub(hn::Mul(g, g), v)));
    hn::StoreU(m, d, c.first + i);
    hn::StoreU(v, d, c.second + i);
    const VA below = hn::Add(hn::Mul(hn::Sqrt(v), hn::LoadU(d, c.unbias2 + i)), epsilon);
    const VA step = hn::Div(hn::Mul(hn::Mul(m, hn::LoadU(d, c.unbias1 + i)), hn::Mul(moves, rate)), below);
    hn::StoreU(hn::Sub(hn::LoadU(d, c.value + i), step), d, c.value + i);
  }
}

}  // namespace bodyloom::avatar_internal::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bodyloom::avatar_internal {

HWY_EXPORT(StepAdamColumn);

void StepAdamColumn(const AdamColumn& column, int first, int last) {
  HWY_DYNAMIC_DISPATCH(StepAdamColumn)(column, first, last);
}

}  // namespace bodyloom::avatar_internal
#endif  // HWY_ONCE
