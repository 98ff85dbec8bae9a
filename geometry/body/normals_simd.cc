// SPDX-License-Identifier: Apache-2.0
#include "geometry/body/normals_simd.h"

#include <cmath>
#include <limits>

#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_AVX3_DL | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "geometry/body/normals_simd.cc"
#include <hwy/foreach_target.h>
// Must come after foreach_target.h.
#include <hwy/highway.h>

#include "geometry/math/quad-inl.h"

HWY_BEFORE_NAMESPACE();
namespace bodyloom::normals_internal::HWY_NAMESPACE {

using namespace bodyloom::HWY_NAMESPACE;  // Quad

constexpr float kDegenerate = 4 * std::numeric_limits<float>::epsilon();
constexpr float kSmallest = 1e-35F;  ///< has a reciprocal

/// Of four vectors.
struct Columns {
  Quad x, y, z;
};

HWY_INLINE Columns Scaled(const Columns& a, Quad factor) { return {a.x * factor, a.y * factor, a.z * factor}; }

HWY_INLINE Quad Dot(const Columns& a, const Columns& b) { return MulAdd(a.x, b.x, MulAdd(a.y, b.y, a.z * b.z)); }

HWY_INLINE Columns Cross(const Columns& a, const Columns& b) {
  return {NegMulAdd(a.z, b.y, a.y * b.z), NegMulAdd(a.x, b.z, a.z * b.x), NegMulAdd(a.y, b.x, a.x * b.y)};
}

HWY_INLINE Quad LargestComponent(const Columns& a) { return Max(Abs(a.x), Max(Abs(a.y), Abs(a.z))); }

/// to − from of four faces' corners.
HWY_INLINE Columns Edges(const float* HWY_RESTRICT positions, const int* HWY_RESTRICT faces, int from, int to) {
  Quad rows[4];
  for (int i = 0; i < 4; ++i) {
    rows[i] =
        LoadQuad(positions + 4 * int64_t{faces[3 * i + to]}) - LoadQuad(positions + 4 * int64_t{faces[3 * i + from]});
  }
  Transpose(rows[0], rows[1], rows[2], rows[3]);
  return {rows[0], rows[1], rows[2]};
}

/// e1 × e2 of four faces and the largest of its |components|; zero where degenerate.
struct FaceCross {
  Columns e1, e2, e3, n;
  Quad largest;

  HWY_INLINE FaceCross(const float* positions, const int* faces)
      : e1(Edges(positions, faces, 0, 1)),
        e2(Edges(positions, faces, 0, 2)),
        e3{e2.x - e1.x, e2.y - e1.y, e2.z - e1.z},
        n(Cross(e1, e2)),
        largest(LargestComponent(n)) {
    const Quad zero = Fill(0), longest = Max(Dot(e1, e1), Max(Dot(e2, e2), Dot(e3, e3)));
    const Quad limit = Max(Fill(kDegenerate) * longest, Fill(kSmallest));
    n = {IfGreater(largest, limit, n.x, zero), IfGreater(largest, limit, n.y, zero),
         IfGreater(largest, limit, n.z, zero)};
    largest = IfGreater(largest, limit, largest, zero);
  }

  [[nodiscard]] HWY_INLINE int NumDegenerate(int count) const {
    if (AllGreater(largest, Fill(0))) return 0;
    HWY_ALIGN float lanes[4];
    StoreQuad(largest, lanes);
    int zeros = 0;
    for (int i = 0; i < count; ++i) zeros += lanes[i] == 0;
    return zeros;
  }
};

/// Angle in [0, π] whose sine and cosine are proportional to s ≥ 0 and c, to 3e-7. Polynomial of atan on
/// [−tan(π/8), tan(π/8)] as in Cephes' atanf.
HWY_INLINE Quad AngleOf(Quad s, Quad c) {
  const Quad one = Fill(1), zero = Fill(0), a = Abs(c), bend = Fill(0.41421356F);
  const Quad t = Min(s, a) / Max(Max(s, a), Fill(1e-37F));
  const Quad u = IfGreater(t, bend, (t - one) / (t + one), t);
  const Quad z = u * u;
  Quad p = MulAdd(Fill(8.05374449538e-2F), z, Fill(-1.38776856032e-1F));
  p = MulAdd(p, z, Fill(1.99777106478e-1F));
  p = MulAdd(p, z, Fill(-3.33329491539e-1F));
  Quad angle = MulAdd(p * z, u, u) + IfGreater(t, bend, Fill(0.785398163F), zero);
  angle = IfGreater(s, a, Fill(1.570796327F) - angle, angle);
  return IfGreater(zero, c, Fill(3.141592654F) - angle, angle);
}

HWY_INLINE void StoreRows(Columns v, Quad w, float* HWY_RESTRICT out, int64_t stride) {
  Transpose(v.x, v.y, v.z, w);
  StoreQuad(v.x, out);
  StoreQuad(v.y, out + stride);
  StoreQuad(v.z, out + 2 * stride);
  StoreQuad(w, out + 3 * stride);
}

/// Corners of faces f … f+3; beyond the last face, of a face of one point.
struct FourFaces {
  int count;
  const int* corners;
  int last[12] = {};
  FourFaces(const int* faces, int num_faces, int f)
      : count(num_faces - f < 4 ? num_faces - f : 4), corners(faces + 3 * int64_t{f}) {
    if (count == 4) return;
    for (int i = 0; i < 3 * count; ++i) last[i] = corners[i];
    corners = last;
  }
};

float LargestMagnitude(const float* values, int64_t count) {
  namespace hn = hwy::HWY_NAMESPACE;
  const hn::CappedTag<float, 16> d;
  const int64_t N = static_cast<int64_t>(hn::Lanes(d));
  auto largest = hn::Zero(d), poison = hn::Zero(d);  // x·0 is NaN exactly when x is not finite
  int64_t i = 0;
  for (; i + N <= count; i += N) {
    const auto x = hn::LoadU(d, values + i);
    largest = hn::Max(largest, hn::Abs(x));
    poison = hn::MulAdd(x, hn::Zero(d), poison);
  }
  float result = hn::GetLane(hn::MaxOfLanes(d, largest)), bad = hn::GetLane(hn::SumOfLanes(d, poison));
  for (; i < count; ++i) {
    const float x = std::fabs(values[i]);
    result = x > result ? x : result;
    bad += x * 0.0F;
  }
  return bad == 0 ? result : std::numeric_limits<float>::infinity();
}

void PadVertices(const float* HWY_RESTRICT vertices, int num_vertices, float factor, float* HWY_RESTRICT positions) {
  const Quad scale = Fill(factor);
  for (int v = 0; v + 1 < num_vertices; ++v) {  // reads one value beyond the vertex
    StoreQuad(FirstThree(LoadQuadU(vertices + 3 * int64_t{v})) * scale, positions + 4 * int64_t{v});
  }
  if (num_vertices > 0) {
    const int64_t v = num_vertices - 1;
    for (int c = 0; c < 3; ++c) positions[4 * v + c] = factor * vertices[3 * v + c];
    positions[4 * v + 3] = 0;
  }
}

int64_t FaceVectors(const float* positions, const int* faces, int num_faces, float* face_vectors) {
  int64_t degenerate = 0;
  for (int f = 0; f < num_faces; f += 4) {
    const FourFaces four(faces, num_faces, f);
    const FaceCross cross(positions, four.corners);
    degenerate += cross.NumDegenerate(four.count);
    StoreRows(cross.n, cross.largest, face_vectors + 4 * int64_t{f}, 4);
  }
  return degenerate;
}

int64_t CornerVectors(const float* positions, const int* faces, int num_faces, float* corner_vectors) {
  const Quad zero = Fill(0), one = Fill(1);
  int64_t degenerate = 0;
  for (int f = 0; f < num_faces; f += 4) {
    const FourFaces four(faces, num_faces, f);
    const FaceCross cross(positions, four.corners);
    degenerate += cross.NumDegenerate(four.count);
    // Divided by the largest component first: the square of a small face's area has no float.
    const Columns n = Scaled(cross.n, one / IfGreater(cross.largest, zero, cross.largest, one));
    const Quad length = Sqrt(Dot(n, n));
    const Quad twice_area = length * cross.largest;
    const Columns unit = Scaled(n, one / IfGreater(length, zero, length, one));
    const Columns back = Scaled(cross.e1, Fill(-1));
    const Quad angles[3] = {AngleOf(twice_area, Dot(cross.e1, cross.e2)), AngleOf(twice_area, Dot(back, cross.e3)),
                            AngleOf(twice_area, Dot(cross.e2, cross.e3))};
    for (int k = 0; k < 3; ++k) {
      const Quad w = IfGreater(cross.largest, zero, angles[k], zero);
      StoreRows(Scaled(unit, w), w, corner_vectors + 12 * int64_t{f} + 4 * k, 12);
    }
  }
  return degenerate;
}

int VertexSums(const float* HWY_RESTRICT vectors, const int* HWY_RESTRICT begin, const int* HWY_RESTRICT items,
               int num_vertices, float* HWY_RESTRICT normals, uint8_t* HWY_RESTRICT missing) {
  const Quad zero = Fill(0), one = Fill(1);
  int num_missing = 0;
  for (int first = 0; first < num_vertices; first += 4) {
    const int count = num_vertices - first < 4 ? num_vertices - first : 4;
    Quad rows[4] = {zero, zero, zero, zero};
    for (int i = 0; i < count; ++i) {
      Quad sum = zero;
      for (int k = begin[first + i]; k < begin[first + i + 1]; ++k) {
        sum = sum + LoadQuad(vectors + 4 * int64_t{items[k]});
      }
      rows[i] = sum;
    }
    Transpose(rows[0], rows[1], rows[2], rows[3]);
    // w is the sum of the vectors' lengths: what remains must be more than the rounding of that.
    const Columns sum = {rows[0], rows[1], rows[2]};
    const Quad largest = LargestComponent(sum), limit = Max(Fill(kDegenerate) * rows[3], Fill(kSmallest));
    const Columns n = Scaled(sum, one / IfGreater(largest, limit, largest, one));
    const Quad w = IfGreater(largest, limit, one / Sqrt(Max(Dot(n, n), Fill(0.5F))), zero);
    HWY_ALIGN float out[16];
    StoreRows(Scaled(n, w), w, out, 4);
    for (int i = 0; i < count; ++i) {
      for (int c = 0; c < 3; ++c) normals[3 * int64_t{first + i} + c] = out[4 * i + c];
      missing[first + i] = out[4 * i + 3] == 0;
      num_missing += missing[first + i];
    }
  }
  return num_missing;
}

}  // namespace bodyloom::normals_internal::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bodyloom::normals_internal {

HWY_EXPORT(LargestMagnitude);
HWY_EXPORT(PadVertices);
HWY_EXPORT(FaceVectors);
HWY_EXPORT(CornerVectors);
HWY_EXPORT(VertexSums);

float LargestMagnitude(const float* values, int64_t count) {
  return HWY_DYNAMIC_DISPATCH(LargestMagnitude)(values, count);
}

void PadVertices(const float* vertices, int num_vertices, float factor, float* positions) {
  HWY_DYNAMIC_DISPATCH(PadVertices)(vertices, num_vertices, factor, positions);
}

int64_t FaceVectors(const float* positions, const int* faces, int num_faces, float* face_vectors) {
  return HWY_DYNAMIC_DISPATCH(FaceVectors)(positions, faces, num_faces, face_vectors);
}

int64_t CornerVectors(const float* positions, const int* faces, int num_faces, float* corner_vectors) {
  return HWY_DYNAMIC_DISPATCH(CornerVectors)(positions, faces, num_faces, corner_vectors);
}

int VertexSums(const float* vectors, const int* begin, const int* items, int num_vertices, float* normals,
               uint8_t* missing) {
  return HWY_DYNAMIC_DISPATCH(VertexSums)(vectors, begin, items, num_vertices, normals, missing);
}

}  // namespace bodyloom::normals_internal
#endif  // HWY_ONCE
