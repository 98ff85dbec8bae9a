// SPDX-License-Identifier: Apache-2.0
/// Reference implementation of render/gaussian_avatar/pose_gaussians.h in its simplest form, for double or for
/// automatic derivatives, and a small Gaussian avatar to test it on.
#pragma once

#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "render/gaussian_avatar/avatar_frame.h"
#include "render/gaussian_avatar/gaussian_body.h"
#include "tests/support/splat_twin.h"

namespace bodyloom {

/// All trainable parameters of one Gaussian, its light and its bones.
template <class T>
struct TwinPerson {
  std::vector<std::array<T, GaussianBody::kNumParameters>> rows;
  std::array<T, GaussianBody::kLightValues> light;
  std::vector<std::array<T, 12>> bones;  ///< rows of [R_k | p_k]
};

/// Y_h(n), lowest first (geometry's own numbers: square roots).
template <class T>
std::array<T, 9> TwinBasis(const std::array<T, 3>& n) {
  const double c0 = 0.5 * std::sqrt(1 / M_PI), c1 = 0.5 * std::sqrt(3 / M_PI), c2 = 0.5 * std::sqrt(15 / M_PI),
               c3 = 0.25 * std::sqrt(5 / M_PI);
  const auto& [x, y, z] = n;
  return {T(c0),
          T(c1) * y,
          T(c1) * z,
          T(c1) * x,
          T(c2) * x * y,
          T(c2) * y * z,
          T(c3) * (T(3) * z * z - T(1)),
          T(c2) * x * z,
          T(0.5 * c2) * (x * x - y * y)};
}

template <class T>
TwinGaussian<T> TwinPose(const GaussianBody& body, const MatrixX3i& faces, const AvatarFrame& frame,
                         const std::array<float, 9>& light_from_frame, const TwinPerson<T>& person, int i) {
  using std::exp;
  using std::sqrt;
  using Body = GaussianBody;
  const auto& row = person.rows[i];
  // Weights.
  std::array<T, Body::kInfluences> weight;
  T sum(0);
  for (int k = 0; k < Body::kInfluences; ++k) sum += weight[k] = exp(row[Body::kWeightLogit + k]);
  for (T& w : weight) w /= sum;
  // Place and blended bone, with joints at rest as plain numbers.
  TwinGaussian<T> g;
  g.position = {T(0), T(0), T(0)};
  T a[3][3] = {};
  for (auto& r : a) {
    for (T& entry : r) entry = T(0);
  }
  for (int k = 0; k < Body::kInfluences; ++k) {
    const int joint = body.joints[i * Body::kInfluences + k];
    const auto& bone = person.bones[joint];
    for (int r = 0; r < 3; ++r) {
      T moved = bone[4 * r + 3];
      for (int c = 0; c < 3; ++c) {
        a[r][c] += weight[k] * bone[4 * r + c];
        moved += bone[4 * r + c] * (row[c] - T(double(frame.rest_joints(joint, c))));
      }
      g.position[r] += weight[k] * moved;
    }
  }
  const SkinAnchor& anchor = body.anchors[i];
  for (int k = 0; k < 3 && !frame.correctives.empty(); ++k) {
    for (int r = 0; r < 3; ++r) {
      g.position[r] += T(double(anchor.corrective_factor) * anchor.barycentric[k] *
                         frame.correctives[4 * faces(anchor.face, k) + r]);
    }
  }
  // Shape: A R(q) diag(e^s), R(q) v = v + 2 u × (u × v + w v) / |q|².
  const T w = row[3], u[3] = {row[4], row[5], row[6]};
  const T square = w * w + u[0] * u[0] + u[1] * u[1] + u[2] * u[2];
  for (int c = 0; c < 3; ++c) {
    const T v[3] = {T(c == 0 ? 1 : 0), T(c == 1 ? 1 : 0), T(c == 2 ? 1 : 0)};
    T inner[3], turned[3];
    for (int k = 0; k < 3; ++k) {
      inner[k] = u[(k + 1) % 3] * v[(k + 2) % 3] - u[(k + 2) % 3] * v[(k + 1) % 3] + w * v[k];
    }
    for (int k = 0; k < 3; ++k) {
      turned[k] = v[k] + T(2) * (u[(k + 1) % 3] * inner[(k + 2) % 3] - u[(k + 2) % 3] * inner[(k + 1) % 3]) / square;
    }
    const T scale = exp(row[Body::kLogScale + c]);
    for (int r = 0; r < 3; ++r) {
      g.factor[3 * r + c] = scale * (a[r][0] * turned[0] + a[r][1] * turned[1] + a[r][2] * turned[2]);
    }
  }
  g.opacity = T(1) / (T(1) + exp(-row[Body::kOpacityLogit]));
  // Colour.
  std::array<T, 3> m, n;
  for (int r = 0; r < 3; ++r) {
    m[r] = a[r][0] * row[Body::kNormal] + a[r][1] * row[Body::kNormal + 1] + a[r][2] * row[Body::kNormal + 2];
  }
  const T length = sqrt(m[0] * m[0] + m[1] * m[1] + m[2] * m[2]);
  for (int r = 0; r < 3; ++r) {
    n[r] = T(0);
    for (int c = 0; c < 3; ++c) n[r] += T(double(light_from_frame[3 * r + c])) * m[c] / length;
  }
  const std::array<T, 9> basis = TwinBasis(n);
  for (int c = 0; c < 3; ++c) {
    T shading(0);
    for (int h = 0; h < 9; ++h) shading += person.light[9 * c + h] * basis[h];
    g.colour[c] = row[Body::kAlbedo + c] * shading;
  }
  return g;
}

/// The numbers of a body and a frame.
template <class T>
TwinPerson<T> TwinOf(const GaussianBody& body, const AvatarFrame& frame) {
  TwinPerson<T> person;
  for (int i = 0; i < body.size(); ++i) {
    person.rows.push_back(RowOf<T, GaussianBody::kNumParameters>(body.parameters, i));
  }
  for (int k = 0; k < GaussianBody::kLightValues; ++k) person.light[k] = T(double(body.light[k]));
  person.bones.resize(frame.num_joints());
  for (int j = 0; j < frame.num_joints(); ++j) {
    for (int r = 0; r < 3; ++r) {
      double place = frame.bones[12 * j + 4 * r + 3];
      for (int c = 0; c < 3; ++c) {
        place += double(frame.bones[12 * j + 4 * r + c]) * frame.rest_joints(j, c);
        person.bones[j][4 * r + c] = T(double(frame.bones[12 * j + 4 * r + c]));
      }
      person.bones[j][4 * r + 3] = T(place);
    }
  }
  return person;
}

/// Gaussians around the joints of a frame with random parameters: joints in any order and repeated, quaternions and
/// normals of any length, a light with all lobes.
inline GaussianBody RandomPerson(int count, const AvatarFrame& frame, int num_faces, uint32_t seed) {
  std::mt19937 generator(seed);
  const auto uniform = [&] { return static_cast<float>(generator() / 2147483648.0 - 1); };
  using Body = GaussianBody;
  Body body;
  body.Resize(count);
  for (int i = 0; i < count; ++i) {
    FloatColumns& p = body.parameters;
    for (int k = 0; k < Body::kInfluences; ++k) {
      body.joints[i * Body::kInfluences + k] = static_cast<int32_t>(generator() % frame.num_joints());
      p(i, Body::kWeightLogit + k) = 2 * uniform();
    }
    const auto home = frame.rest_joints.row(body.joints[i * Body::kInfluences]);
    for (int k = 0; k < 3; ++k) {
      p(i, Body::kPosition + k) = home[k] + 0.1F * uniform();
      p(i, Body::kLogScale + k) = -3.7F + 0.7F * uniform();
      p(i, Body::kAlbedo + k) = 0.5F + 0.4F * uniform();
      p(i, Body::kNormal + k) = 1.5F * uniform();
    }
    for (int k = 0; k < 4; ++k) p(i, Body::kQuaternion + k) = 2 * uniform();
    p(i, Body::kOpacityLogit) = 2 * uniform();
    const float first = 0.5F + 0.5F * uniform();
    body.anchors[i] = {static_cast<int32_t>(generator() % num_faces),
                       {first, 0.7F * (1 - first), 0.3F * (1 - first)},
                       i % 3 == 0 ? 0.0F : 0.5F + 0.5F * uniform()};
    body.kinds[i] = i % 2 == 0 ? GaussianKind::kSkin : GaussianKind::kLoose;
  }
  for (float& value : body.light) value = 0.3F * uniform();
  for (int c = 0; c < 3; ++c) body.light[9 * c] = 2.5F;
  return body;
}

}  // namespace bodyloom
