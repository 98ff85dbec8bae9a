// SPDX-License-Identifier: Apache-2.0
#include "tracking/terms/dense/dense_points_simd.h"

// Instruction sets that add nothing to these loops, and those whose vectors have no size at compile time.
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_AVX3_DL | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tracking/terms/dense/dense_points_simd.cc"
#include <hwy/foreach_target.h>
// Must come after foreach_target.h.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace bodyloom::dense_internal::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using Tag = hn::CappedTag<double, 8>;
using Lanes = hn::Vec<Tag>;

HWY_INLINE Lanes LoadFloats(const float* p) { return hn::PromoteTo(Tag(), hn::LoadU(hn::Rebind<float, Tag>(), p)); }

/// Four values: one vector, or two, or four.
using QuadTag = hn::CappedTag<double, 4>;
constexpr int kQuadLanes = static_cast<int>(hn::MaxLanes(QuadTag()));
struct Quad {
  hn::Vec<QuadTag> part[4 / kQuadLanes];
};
HWY_INLINE Quad LoadQuad(const double* p) {
  Quad q;
  for (int i = 0; i < 4 / kQuadLanes; ++i) q.part[i] = hn::LoadU(QuadTag(), p + i * kQuadLanes);
  return q;
}
HWY_INLINE void StoreQuad(const Quad& q, double* p) {
  for (int i = 0; i < 4 / kQuadLanes; ++i) hn::StoreU(q.part[i], QuadTag(), p + i * kQuadLanes);
}
HWY_INLINE Quad ZeroQuad() {
  Quad q;
  for (auto& part : q.part) part = hn::Zero(QuadTag());
  return q;
}
/// s p + q.
HWY_INLINE Quad MulAdd(double s, const Quad& p, const Quad& q) {
  Quad sum;
  for (int i = 0; i < 4 / kQuadLanes; ++i) {
    sum.part[i] = hn::MulAdd(hn::Set(QuadTag(), s), p.part[i], q.part[i]);
  }
  return sum;
}

/// (G x + t, 1).
HWY_INLINE Quad Transform(const double* HWY_RESTRICT transform, const double* HWY_RESTRICT x) {
  return MulAdd(x[0], LoadQuad(transform),
                MulAdd(x[1], LoadQuad(transform + 4), MulAdd(x[2], LoadQuad(transform + 8), LoadQuad(transform + 12))));
}

/// 2×3 times a corrective's 3×9 block, added to 2×9: target_r[i] += Σ_c A_rc block_c[i].
HWY_INLINE void AddBlock(const double (&A)[2][4], const float* HWY_RESTRICT block, double (&target)[2][16]) {
  const Tag d;
  const int N = static_cast<int>(hn::Lanes(d));
  for (int i = 0; i < 8; i += N) {
    const Lanes x = LoadFloats(block + i), y = LoadFloats(block + 9 + i), z = LoadFloats(block + 18 + i);
    for (int r = 0; r < 2; ++r) {
      Lanes sum = hn::MulAdd(hn::Set(d, A[r][0]), x, hn::LoadU(d, target[r] + i));
      sum = hn::MulAdd(hn::Set(d, A[r][1]), y, sum);
      hn::StoreU(hn::MulAdd(hn::Set(d, A[r][2]), z, sum), d, target[r] + i);
    }
  }
  for (int r = 0; r < 2; ++r) {
    target[r][8] += A[r][0] * double{block[8]} + A[r][1] * double{block[17]} + A[r][2] * double{block[26]};
  }
}

/// Posed position of a vertex, computed at its first use in a frame.
const double* PosedVertex(const Body& body, const Frame& frame, const Vertices& vertices, int v) {
  double* HWY_RESTRICT posed = vertices.posed + 3 * static_cast<int64_t>(v);
  if (vertices.posed_stamp[v] == vertices.frame) return posed;
  vertices.posed_stamp[v] = vertices.frame;
  double* HWY_RESTRICT shaped = vertices.shaped + 3 * static_cast<int64_t>(v);
  if (vertices.shaped_stamp[v] != vertices.shape) {
    vertices.shaped_stamp[v] = vertices.shape;
    for (int c = 0; c < 3; ++c) {
      const float* HWY_RESTRICT row = body.shapedirs + (3 * static_cast<int64_t>(v) + c) * body.shape_stride;
      double sum = body.v_template[3 * static_cast<int64_t>(v) + c];
      for (int b = 0; b < frame.num_betas; ++b) sum += double{row[b]} * frame.betas[b];
      shaped[c] = sum;
    }
  }
  double* HWY_RESTRICT rest = vertices.rest + 3 * static_cast<int64_t>(v);
  double x = shaped[0], y = shaped[1], z = shaped[2];
  if (body.corrective_begin != nullptr && body.corrective_begin[v] < body.corrective_begin[v + 1]) {
    const Tag d;
    const int N = static_cast<int>(hn::Lanes(d));
    Lanes sum_x = hn::Zero(d), sum_y = hn::Zero(d), sum_z = hn::Zero(d);
    for (int k = body.corrective_begin[v]; k < body.corrective_begin[v + 1]; ++k) {
      const float* HWY_RESTRICT block = body.corrective_block + 27 * static_cast<int64_t>(k);
      const double* HWY_RESTRICT feature = frame.feature + 9 * body.corrective_joint[k];
      for (int m = 0; m < 8; m += N) {
        const Lanes f = hn::LoadU(d, feature + m);
        sum_x = hn::MulAdd(LoadFloats(block + m), f, sum_x);
        sum_y = hn::MulAdd(LoadFloats(block + 9 + m), f, sum_y);
        sum_z = hn::MulAdd(LoadFloats(block + 18 + m), f, sum_z);
      }
      x += double{block[8]} * feature[8];
      y += double{block[17]} * feature[8];
      z += double{block[26]} * feature[8];
    }
    x += hn::GetLane(hn::SumOfLanes(d, sum_x));
    y += hn::GetLane(hn::SumOfLanes(d, sum_y));
    z += hn::GetLane(hn::SumOfLanes(d, sum_z));
  }
  rest[0] = x;
  rest[1] = y;
  rest[2] = z;
  Quad sum = ZeroQuad();
  for (int e = body.influence_begin[v]; e < body.influence_begin[v + 1]; ++e) {
    sum = MulAdd(body.influence_weight[e], Transform(frame.transform + 16 * body.influence_joint[e], rest), sum);
  }
  double at[4];
  StoreQuad(sum, at);
  for (int c = 0; c < 3; ++c) posed[c] = at[c];
  return posed;
}

void PosePointsHere(const Body& body, const Frame& frame, const Vertices& vertices, const Point* points, int n,
                    double* x) {
  for (int i = 0; i < n; ++i) {
    double sum[3] = {0, 0, 0};
    for (int k = 0; k < 3; ++k) {
      const double b = points[i].weight[k];
      if (b == 0) continue;
      const double* posed = PosedVertex(body, frame, vertices, points[i].vertex[k]);
      for (int c = 0; c < 3; ++c) sum[c] += b * posed[c];
    }
    for (int c = 0; c < 3; ++c) x[3 * i + c] = sum[c];
  }
}

/// Part of one vertex of a point: its weight in the point times …
struct Corner {
  double A[2][4];      ///< … A M, M = Σ w G: by the rest vertex
  const float* shape;  ///< its rows of shapedirs
};

/// Rows by the shape: of the corners' rest vertices, and of the bones that move them, whose weights times A are given.
HWY_INLINE void FillShape(const Frame& frame, int shape_stride, const Corner* corners, int num_corners,
                          const double (*bone_A)[2][3], const int* bones, int num_bones,
                          double* HWY_RESTRICT const (&target)[2]) {
  const Tag d;
  const hn::Rebind<float, Tag> d_float;
  const int N = static_cast<int>(hn::Lanes(d));
  for (int first = 0; first < frame.num_betas; first += N) {
    const size_t left = static_cast<size_t>(frame.num_betas - first);
    const bool whole = left >= static_cast<size_t>(N);
    Lanes sum[2] = {hn::Zero(d), hn::Zero(d)};
    for (int k = 0; k < num_corners; ++k) {
      const float* HWY_RESTRICT shape = corners[k].shape + first;
      for (int c = 0; c < 3; ++c) {
        const float* HWY_RESTRICT row = shape + c * shape_stride;
        const Lanes x =
            hn::PromoteTo(d, whole ? hn::LoadU(d_float, row) : hn::MaskedLoad(hn::FirstN(d_float, left), d_float, row));
        for (int r = 0; r < 2; ++r) sum[r] = hn::MulAdd(hn::Set(d, corners[k].A[r][c]), x, sum[r]);
      }
    }
    for (int k = 0; k < num_bones; ++k) {
      const double* HWY_RESTRICT dt = frame.dt + static_cast<int64_t>(3) * bones[k] * frame.dt_stride + first;
      for (int c = 0; c < 3; ++c) {
        const Lanes x = hn::LoadU(d, dt + c * frame.dt_stride);
        for (int r = 0; r < 2; ++r) sum[r] = hn::MulAdd(hn::Set(d, bone_A[k][r][c]), x, sum[r]);
      }
    }
    for (int r = 0; r < 2; ++r) {
      if (whole) {
        hn::StoreU(sum[r], d, target[r] + first);
      } else {
        hn::BlendedStore(sum[r], hn::FirstN(d, left), d, target[r] + first);
      }
    }
  }
}

void FillRowsHere(const Body& body, const Frame& frame, const Vertices& vertices, const Group& group,
                  const Point* points, const int* chosen, int n, const double* A, double* rows, int64_t stride) {
  // By the group's joints: what moves with the joint and its weight, and A times the correctives' matrices.
  HWY_ALIGN double moved[kMaxGroupJoints][4];
  HWY_ALIGN double corrective[kMaxGroupJoints][2][16];
  bool has_corrective[kMaxGroupJoints], is_bone[kMaxGroupJoints];
  int bones[kMaxGroupJoints], bone_joints[kMaxGroupJoints];
  double bone_A[kMaxGroupJoints][2][3];
  const int N = group.num_joints;
  for (int i = 0; i < n; ++i) {
    const Point& point = points[chosen[i]];
    const double* HWY_RESTRICT a = A + 6 * static_cast<int64_t>(chosen[i]);
    double* HWY_RESTRICT out[2] = {rows + 2 * i * stride, rows + (2 * i + 1) * stride};
    for (int q = 0; q < N; ++q) {
      StoreQuad(ZeroQuad(), moved[q]);
      has_corrective[q] = is_bone[q] = false;
    }
    Corner corners[3];
    int num_corners = 0, num_bones = 0;
    for (int k = 0; k < 3; ++k) {
      const double weight = point.weight[k];
      if (weight == 0) continue;
      const int v = point.vertex[k];
      const double* HWY_RESTRICT rest = vertices.rest + 3 * static_cast<int64_t>(v);
      Quad M[3] = {ZeroQuad(), ZeroQuad(), ZeroQuad()};  // by rows
      for (int e = body.influence_begin[v]; e < body.influence_begin[v + 1]; ++e) {
        const int joint = body.influence_joint[e], q = group.of_joint[joint];
        const double w = weight * body.influence_weight[e];
        StoreQuad(MulAdd(w, Transform(frame.transform + 16 * joint, rest), LoadQuad(moved[q])), moved[q]);
        for (int c = 0; c < 3; ++c) M[c] = MulAdd(w, LoadQuad(frame.rotation + 12 * joint + 4 * c), M[c]);
        if (is_bone[q]) continue;
        is_bone[q] = true;
        bones[num_bones++] = q;
      }
      Corner& corner = corners[num_corners++];
      corner.shape = body.shapedirs + 3 * static_cast<int64_t>(v) * body.shape_stride;
      for (int r = 0; r < 2; ++r) {
        const double* HWY_RESTRICT row = a + 3 * r;
        StoreQuad(MulAdd(row[0], M[0], MulAdd(row[1], M[1], MulAdd(row[2], M[2], ZeroQuad()))), corner.A[r]);
      }
      if (body.corrective_begin == nullptr) continue;
      for (int e = body.corrective_begin[v]; e < body.corrective_begin[v + 1]; ++e) {
        const int q = group.of_joint[body.corrective_joint[e]];
        if (!has_corrective[q]) {
          has_corrective[q] = true;
          for (int m = 0; m < 9; ++m) corrective[q][0][m] = corrective[q][1][m] = 0;
        }
        AddBlock(corner.A, body.corrective_block + 27 * static_cast<int64_t>(e), corrective[q]);
      }
    }
    for (int k = 0; k < num_bones; ++k) {
      const double w = moved[bones[k]][3];
      bone_joints[k] = group.joints[bones[k]];
      for (int c = 0; c < 6; ++c) bone_A[k][c / 3][c % 3] = w * a[c];
    }
    // From the leaves up, since a parent also moves everything that its child moves.
    for (int q = N - 1; q >= 0; --q) {
      if (group.parent[q] < 0) continue;
      double* HWY_RESTRICT sum = moved[group.parent[q]];
      StoreQuad(MulAdd(1, LoadQuad(moved[q]), LoadQuad(sum)), sum);
    }
    for (int q = 0; q < N; ++q) {
      const int column = group.column[q];
      if (column < 0) continue;
      const double* HWY_RESTRICT rotation = frame.rotation + 12 * group.joints[q];
      const double* HWY_RESTRICT F = frame.feature_jacobian + 36 * group.joints[q];
      double lever[4];
      StoreQuad(MulAdd(-moved[q][3], LoadQuad(frame.joint + 4 * group.joints[q]), LoadQuad(moved[q])), lever);
      const Quad G[3] = {LoadQuad(rotation), LoadQuad(rotation + 4), LoadQuad(rotation + 8)};
      for (int r = 0; r < 2; ++r) {
        // a · (G_m × lever) = G_m · (lever × a), m = 0, 1, 2 in the lanes of a quad
        const double* HWY_RESTRICT row = a + 3 * r;
        Quad sum = MulAdd(lever[0] * row[1] - lever[1] * row[0], G[2], ZeroQuad());
        sum = MulAdd(lever[1] * row[2] - lever[2] * row[1], G[0], sum);
        sum = MulAdd(lever[2] * row[0] - lever[0] * row[2], G[1], sum);
        for (int k = 0; k < 9 && has_corrective[q]; ++k) sum = MulAdd(corrective[q][r][k], LoadQuad(F + 4 * k), sum);
        // The fourth value lands in the next column, which is filled later.
        StoreQuad(sum, out[r] + column);
      }
    }
    double* HWY_RESTRICT beta[2] = {out[0] + group.beta_column, out[1] + group.beta_column};
    FillShape(frame, body.shape_stride, corners, num_corners, bone_A, bone_joints, num_bones, beta);
  }
}

}  // namespace bodyloom::dense_internal::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bodyloom::dense_internal {

HWY_EXPORT(PosePointsHere);
HWY_EXPORT(FillRowsHere);

void PosePoints(const Body& body, const Frame& frame, const Vertices& vertices, const Point* points, int n, double* x) {
  HWY_DYNAMIC_DISPATCH(PosePointsHere)(body, frame, vertices, points, n, x);
}

void FillRows(const Body& body, const Frame& frame, const Vertices& vertices, const Group& group, const Point* points,
              const int* chosen, int n, const double* A, double* rows, int64_t stride) {
  HWY_DYNAMIC_DISPATCH(FillRowsHere)(body, frame, vertices, group, points, chosen, n, A, rows, stride);
}

}  // namespace bodyloom::dense_internal
#endif  // HWY_ONCE
