// SPDX-License-Identifier: Apache-2.0
/// Reference implementation of the body model, not optimised: Loper et al., eq. 2–10, with homogeneous matrices, dense
/// loops and any scalar (double, ceres::Jet). Shares no code with geometry/.
#pragma once

#include <array>
#include <vector>

#include "geometry/body/body_model.h"

namespace bodyloom {

template <typename T>
using Slow3 = std::array<T, 3>;
template <typename T>
using Slow33 = std::array<std::array<T, 3>, 3>;
template <typename T>
using Slow34 = std::array<std::array<T, 4>, 3>;

template <typename T>
struct SlowBody {
  std::vector<Slow3<T>> vertices;  ///< the selected vertices
  std::vector<Slow3<T>> joints;    ///< J
};

template <typename T>
SlowBody<T> PoseSlowly(const BodyModelData& d, const std::vector<T>& betas, const std::vector<Slow33<T>>& rotations,
                       const Slow3<T>& trans, const std::vector<int>& vertices) {
  const int J = static_cast<int>(d.parents.size());
  const auto shaped = [&](int v, int c) {
    T x = T(d.v_template(v, c));
    for (size_t b = 0; b < betas.size(); ++b) x += T(double{d.shapedirs(3 * v + c, static_cast<int>(b))}) * betas[b];
    return x;
  };
  // eq. 10: joints of the shaped body.
  std::vector<Slow3<T>> rest(J);
  for (int j = 0; j < J; ++j) {
    for (int c = 0; c < 3; ++c) {
      rest[j][c] = T(0);
      for (SparseRows::InnerIterator it(d.J_regressor, j); it; ++it) rest[j][c] += T(it.value()) * shaped(it.col(), c);
    }
  }
  // eq. 4: world transforms along the tree; eq. 3: minus the rest pose.
  std::vector<Slow34<T>> world(J), skin(J);
  SlowBody<T> body;
  body.joints.resize(J);
  for (int j = 0; j < J; ++j) {
    const int p = d.parents[j];
    Slow34<T> local;
    for (int r = 0; r < 3; ++r) {
      for (int c = 0; c < 3; ++c) local[r][c] = rotations[j][r][c];
      local[r][3] = p < 0 ? rest[j][r] + trans[r] : rest[j][r] - rest[p][r];
    }
    for (int r = 0; r < 3; ++r) {
      for (int c = 0; c < 4; ++c) {
        if (p < 0) {
          world[j][r][c] = local[r][c];
          continue;
        }
        world[j][r][c] = c == 3 ? world[p][r][3] : T(0);
        for (int k = 0; k < 3; ++k) world[j][r][c] += world[p][r][k] * local[k][c];
      }
    }
    skin[j] = world[j];
    for (int r = 0; r < 3; ++r) {
      for (int k = 0; k < 3; ++k) skin[j][r][3] -= world[j][r][k] * rest[j][k];
      body.joints[j][r] = world[j][r][3];
    }
  }
  for (int v : vertices) {
    // eq. 8–9: shape and pose blend shapes, the latter through the dense row of 9(J−1) features.
    std::array<T, 4> x;
    x[3] = T(1);
    for (int c = 0; c < 3; ++c) {
      x[c] = shaped(v, c);
      std::vector<double> dense(9 * (J - 1), 0.0);
      if (!d.posedirs.begin.empty()) {
        for (int k = d.posedirs.begin[v]; k < d.posedirs.begin[v + 1]; ++k) {
          for (int e = 0; e < 9; ++e) dense[9 * (d.posedirs.joint[k] - 1) + e] += d.posedirs.block[27 * k + 9 * c + e];
        }
      }
      for (int j = 1; j < J; ++j) {
        for (int e = 0; e < 9; ++e) {
          if (dense[9 * (j - 1) + e] == 0) continue;
          x[c] += T(dense[9 * (j - 1) + e]) * (rotations[j][e / 3][e % 3] - T(e % 4 == 0 ? 1 : 0));
        }
      }
    }
    // eq. 2: blend the matrices, then transform.
    Slow34<T> blend;
    for (auto& row : blend) row.fill(T(0));
    for (int j = 0; j < J; ++j) {
      const double w = d.weights.coeff(v, j);
      if (w == 0) continue;
      for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 4; ++c) blend[r][c] += T(w) * skin[j][r][c];
      }
    }
    Slow3<T> y;
    for (int r = 0; r < 3; ++r) {
      y[r] = T(0);
      for (int c = 0; c < 4; ++c) y[r] += blend[r][c] * x[c];
    }
    body.vertices.push_back(y);
  }
  return body;
}

}  // namespace bodyloom
