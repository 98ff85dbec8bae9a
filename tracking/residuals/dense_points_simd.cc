// SPDX-License-Identifier: Apache-2.0
#include "tracking/residuals/dense_points_simd.h"

// Instruction sets that add nothing to these loops, and those whose vectors have no size at compile time.
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_AVX3_DL | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tracking/residuals/dense_points_simd.cc"
#include <hwy/foreach_target.h>
// Must come after foreach_target.h.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace bodyloom::dense_internal::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using Tag = hn::CappedTag<double, 8>;
using Lanes = hn::Vec<Tag>;

HWY_INLINE Lanes LoadFloats(const float* p) { return hn::PromoteTo(Tag(), hn::LoadU(hn::Rebind<float, Tag>(), p)); }

/// 2×3 times 3×n, added to 2×n: target_r[i] += Σ_c A_rc row_c[i], rows of float or of double.
template <class T>
HWY_INLINE void AddRows(const double (&A)[2][3], const T* HWY_RESTRICT row0, const T* HWY_RESTRICT row1,
                        const T* HWY_RESTRICT row2, int n, double* HWY_RESTRICT target0, double* HWY_RESTRICT target1) {
  const Tag d;
  const int N = static_cast<int>(hn::Lanes(d));
  int i = 0;
  for (; i + N <= n; i += N) {
    Lanes x, y, z;
    if constexpr (sizeof(T) == sizeof(float)) {
      x = LoadFloats(row0 + i), y = LoadFloats(row1 + i), z = LoadFloats(row2 + i);
    } else {
      x = hn::LoadU(d, row0 + i), y = hn::LoadU(d, row1 + i), z = hn::LoadU(d, row2 + i);
    }
    Lanes sum = hn::MulAdd(hn::Set(d, A[0][0]), x, hn::LoadU(d, target0 + i));
    sum = hn::MulAdd(hn::Set(d, A[0][1]), y, sum);
    hn::StoreU(hn::MulAdd(hn::Set(d, A[0][2]), z, sum), d, target0 + i);
    sum = hn::MulAdd(hn::Set(d, A[1][0]), x, hn::LoadU(d, target1 + i));
    sum = hn::MulAdd(hn::Set(d, A[1][1]), y, sum);
    hn::StoreU(hn::MulAdd(hn::Set(d, A[1][2]), z, sum), d, target1 + i);
  }
  for (; i < n; ++i) {
    const double x = row0[i], y = row1[i], z = row2[i];
    target0[i] += A[0][0] * x + A[0][1] * y + A[0][2] * z;
    target1[i] += A[1][0] * x + A[1][1] * y + A[1][2] * z;
  }
}

const double* RestVertex(const Body& body, const Frame& frame, const Vertices& vertices, int v) {
  double* HWY_RESTRICT rest = vertices.rest + 3 * static_cast<int64_t>(v);
  if (vertices.rest_stamp[v] == vertices.frame) return rest;
  vertices.rest_stamp[v] = vertices.frame;
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
  return rest;
}

/// G x + t, column by column.
HWY_INLINE void Transform(const double* HWY_RESTRICT G, const double* HWY_RESTRICT t, const double* HWY_RESTRICT x,
                          double* HWY_RESTRICT y) {
  for (int r = 0; r < 3; ++r) y[r] = t[r] + G[r] * x[0] + G[3 + r] * x[1] + G[6 + r] * x[2];
}

void PosePointsHere(const Body& body, const Frame& frame, const Vertices& vertices, const Point* points, int n,
                    double* x) {
  for (int i = 0; i < n; ++i) {
    double sum[3] = {0, 0, 0};
    for (int k = 0; k < 3; ++k) {
      const double b = points[i].weight[k];
      if (b == 0) continue;
      const int v = points[i].vertex[k];
      const double* rest = RestVertex(body, frame, vertices, v);
      for (int e = body.influence_begin[v]; e < body.influence_begin[v + 1]; ++e) {
        const int joint = body.influence_joint[e];
        const double w = b * body.influence_weight[e];
        double y[3];
        Transform(frame.G + 9 * joint, frame.t + 3 * joint, rest, y);
        for (int c = 0; c < 3; ++c) sum[c] += w * y[c];
      }
    }
    for (int c = 0; c < 3; ++c) x[3 * i + c] = sum[c];
  }
}

void FillRowsHere(const Body& body, const Frame& frame, const Vertices& vertices, const Group& group,
                  const Point* points, const int* chosen, int n, const double* A, double* rows, int64_t stride) {
  // By the group's joints: what moves with the joint, its weight, and A times the correctives' matrices.
  double moved[kMaxGroupJoints][4];
  double corrective[kMaxGroupJoints][2][9];
  bool has_corrective[kMaxGroupJoints];
  const int B = frame.num_betas, N = group.num_joints;
  for (int i = 0; i < n; ++i) {
    const Point& point = points[chosen[i]];
    const double* HWY_RESTRICT a = A + 6 * static_cast<int64_t>(chosen[i]);
    double* HWY_RESTRICT out[2] = {rows + 2 * i * stride, rows + (2 * i + 1) * stride};
    double* HWY_RESTRICT beta[2] = {out[0] + group.beta_column, out[1] + group.beta_column};
    for (int b = 0; b < B; ++b) beta[0][b] = beta[1][b] = 0;
    for (int q = 0; q < N; ++q) {
      for (double& value : moved[q]) value = 0;
      has_corrective[q] = false;
    }
    for (int k = 0; k < 3; ++k) {
      const double weight = point.weight[k];
      if (weight == 0) continue;
      const int v = point.vertex[k];
      const double* HWY_RESTRICT rest = vertices.rest + 3 * static_cast<int64_t>(v);
      double M[9] = {0, 0, 0, 0, 0, 0, 0, 0, 0};  // Σ w G
      for (int e = body.influence_begin[v]; e < body.influence_begin[v + 1]; ++e) {
        const int joint = body.influence_joint[e];
        const double w = weight * body.influence_weight[e];
        const double* HWY_RESTRICT G = frame.G + 9 * joint;
        double y[3];
        Transform(G, frame.t + 3 * joint, rest, y);
        double* HWY_RESTRICT sum = moved[group.of_joint[joint]];
        for (int c = 0; c < 3; ++c) sum[c] += w * y[c];
        sum[3] += w;
        for (int c = 0; c < 9; ++c) M[c] += w * G[c];
      }
      double AM[2][3];
      for (int r = 0; r < 2; ++r) {
        for (int c = 0; c < 3; ++c) {
          AM[r][c] = a[3 * r] * M[3 * c] + a[3 * r + 1] * M[3 * c + 1] + a[3 * r + 2] * M[3 * c + 2];
        }
      }
      const float* HWY_RESTRICT s = body.shapedirs + 3 * static_cast<int64_t>(v) * body.shape_stride;
      AddRows(AM, s, s + body.shape_stride, s + 2 * body.shape_stride, B, beta[0], beta[1]);
      if (body.corrective_begin == nullptr) continue;
      for (int e = body.corrective_begin[v]; e < body.corrective_begin[v + 1]; ++e) {
        const int q = group.of_joint[body.corrective_joint[e]];
        if (!has_corrective[q]) {
          has_corrective[q] = true;
          for (int m = 0; m < 9; ++m) corrective[q][0][m] = corrective[q][1][m] = 0;
        }
        const float* HWY_RESTRICT block = body.corrective_block + 27 * static_cast<int64_t>(e);
        AddRows(AM, block, block + 9, block + 18, 9, corrective[q][0], corrective[q][1]);
      }
    }
    for (int q = 0; q < N; ++q) {
      const double w = moved[q][3];
      if (w == 0) continue;
      const double* HWY_RESTRICT dt = frame.dt + 3 * static_cast<int64_t>(group.joints[q]) * B;
      const double wA[2][3] = {{w * a[0], w * a[1], w * a[2]}, {w * a[3], w * a[4], w * a[5]}};
      AddRows(wA, dt, dt + B, dt + 2 * B, B, beta[0], beta[1]);
    }
    // From the leaves up: what a joint moves, its parent moves too.
    for (int q = N - 1; q >= 0; --q) {
      if (group.parent[q] < 0) continue;
      double* HWY_RESTRICT sum = moved[group.parent[q]];
      for (int c = 0; c < 4; ++c) sum[c] += moved[q][c];
    }
    for (int q = 0; q < N; ++q) {
      const int column = group.column[q];
      if (column < 0) continue;
      const int joint = group.joints[q];
      const double* HWY_RESTRICT p = frame.p + 3 * joint;
      const double* HWY_RESTRICT G = frame.G + 9 * joint;
      const double lever[3] = {moved[q][0] - moved[q][3] * p[0], moved[q][1] - moved[q][3] * p[1],
                               moved[q][2] - moved[q][3] * p[2]};
      for (int r = 0; r < 2; ++r) {
        // a · (G_m × lever) = G_m · (lever × a)
        const double* HWY_RESTRICT row = a + 3 * r;
        const double x = lever[1] * row[2] - lever[2] * row[1], y = lever[2] * row[0] - lever[0] * row[2],
                     z = lever[0] * row[1] - lever[1] * row[0];
        double* HWY_RESTRICT target = out[r] + column;
        for (int m = 0; m < 3; ++m) target[m] = G[3 * m] * x + G[3 * m + 1] * y + G[3 * m + 2] * z;
        if (!has_corrective[q]) continue;
        const double* HWY_RESTRICT F = frame.feature_jacobian + 27 * joint;
        for (int m = 0; m < 3; ++m) {
          double sum = 0;
          for (int k = 0; k < 9; ++k) sum += corrective[q][r][k] * F[9 * m + k];
          target[m] += sum;
        }
      }
    }
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
