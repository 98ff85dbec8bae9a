// SPDX-License-Identifier: Apache-2.0
/// Reference implementation of body and camera, directly from the formulas for any scalar: dense loops over all joints,
/// no kinematic sparsity, no code shared with tracking/. Used with Jets as the truth for analytic derivatives.
#pragma once

#include <ceres/jet.h>

#include <Eigen/Core>
#include <vector>

#include "geometry/body/body_model.h"
#include "geometry/math/rotation.h"
#include "geometry/scene/camera.h"
#include "tracking/problem/frame_cost.h"

namespace bodyloom::twin {

using Jet = ceres::Jet<double, 1>;  ///< one parameter at a time

template <typename T>
using Matrix3 = Eigen::Matrix<T, 3, 3>;
template <typename T>
using Vector3 = Eigen::Matrix<T, 3, 1>;

/// exp([w]×) for any scalar; by Taylor series of both coefficients near zero, so that Jets at zero are exact.
template <typename T>
Matrix3<T> Exp(const Vector3<T>& w) {
  using std::cos;
  using std::sin;
  using std::sqrt;
  const T angle2 = w.squaredNorm();
  T a, b;
  if (angle2 < T(1e-6)) {
    a = T(1) - angle2 / T(6) + angle2 * angle2 / T(120);
    b = T(0.5) - angle2 / T(24) + angle2 * angle2 / T(720);
  } else {
    const T angle = sqrt(angle2);
    a = sin(angle) / angle;
    b = (T(1) - cos(angle)) / angle2;
  }
  Matrix3<T> S;
  S << T(0), -w[2], w[1], w[2], T(0), -w[0], -w[1], w[0], T(0);
  return Matrix3<T>::Identity() + S * a + S * S * b;
}

/// log of a rotation with angle below π − 0.05 and not the identity's immediate neighbourhood derivative-wise.
template <typename T>
Vector3<T> Log(const Matrix3<T>& R) {
  using std::atan2;
  using std::sqrt;
  Vector3<T> v(R(2, 1) - R(1, 2), R(0, 2) - R(2, 0), R(1, 0) - R(0, 1));
  const T sine2 = v.squaredNorm() / T(4);
  const T cosine = (R.trace() - T(1)) / T(2);
  T factor;  // θ / (2 sin θ)
  if (sine2 < T(1e-8)) {
    factor = T(0.5) + sine2 / T(12);
  } else {
    const T sine = sqrt(sine2);
    factor = atan2(sine, cosine) / (T(2) * sine);
  }
  return v * factor;
}

/// One body: local rotations R_j exp(δ_j), betas, translation.
template <typename T>
struct Body {
  const BodyModel* model;
  std::vector<Matrix3<T>> local;
  Eigen::Matrix<T, Eigen::Dynamic, 1> betas;
  Vector3<T> trans;

  [[nodiscard]] Vector3<T> ShapedVertex(int v) const {
    const BodyModelData& d = model->data();
    Vector3<T> x;
    for (int c = 0; c < 3; ++c) {
      x[c] = T(d.v_template(v, c));
      for (int b = 0; b < betas.size(); ++b) x[c] += T(static_cast<double>(d.shapedirs(3 * v + c, b))) * betas[b];
    }
    return x;
  }
  [[nodiscard]] Vector3<T> RestJoint(int j) const {
    Vector3<T> x = Vector3<T>::Zero();
    for (SparseRows::InnerIterator it(model->data().J_regressor, j); it; ++it) {
      x += ShapedVertex(static_cast<int>(it.col())) * T(it.value());
    }
    return x;
  }
  /// World rotation and position of every joint.
  void Pose(std::vector<Matrix3<T>>* G, std::vector<Vector3<T>>* p, std::vector<Vector3<T>>* rest) const {
    const int J = model->num_joints();
    G->resize(J);
    p->resize(J);
    rest->resize(J);
    for (int j = 0; j < J; ++j) {
      (*rest)[j] = RestJoint(j);
      const int parent = model->parents()[j];
      (*G)[j] = j == 0 ? local[0] : Matrix3<T>((*G)[parent] * local[j]);
      (*p)[j] = j == 0 ? Vector3<T>((*rest)[0] + trans)
                       : Vector3<T>((*p)[parent] + (*G)[parent] * ((*rest)[j] - (*rest)[parent]));
    }
  }
  [[nodiscard]] std::vector<Vector3<T>> Vertices(const std::vector<int>& ids) const {
    std::vector<Matrix3<T>> G;
    std::vector<Vector3<T>> p, rest, result;
    Pose(&G, &p, &rest);
    const BodyModelData& d = model->data();
    for (int v : ids) {
      Vector3<T> x = ShapedVertex(v);
      if (!d.posedirs.begin.empty()) {
        for (int k = d.posedirs.begin[v]; k < d.posedirs.begin[v + 1]; ++k) {
          const Matrix3<T>& R = local[d.posedirs.joint[k]];
          for (int c = 0; c < 3; ++c) {
            for (int m = 0; m < 9; ++m) {
              const T feature = R(m / 3, m % 3) - T(m % 4 == 0 ? 1.0 : 0.0);
              x[c] += T(static_cast<double>(d.posedirs.block[27 * k + 9 * c + m])) * feature;
            }
          }
        }
      }
      Vector3<T> posed = Vector3<T>::Zero();
      for (SparseRows::InnerIterator it(d.weights, v); it; ++it) {
        const int j = static_cast<int>(it.col());
        posed += (G[j] * (x - rest[j]) + p[j]) * T(it.value());
      }
      result.push_back(posed);
    }
    return result;
  }
};

/// Pixel of a point for OpenCV's rational distortion or weak perspective, from the formulas of the OpenCV manual.
template <typename T>
Eigen::Matrix<T, 2, 1> Project(const Camera& camera, const Vector3<T>& x, const T& fx, const T& fy, const T& scale,
                               const T& tx, const T& ty) {
  if (camera.model == CameraModel::kWeakPerspective) {
    return {scale * (x[0] + tx) + T(camera.cx), scale * (x[1] + ty) + T(camera.cy)};
  }
  const T a = x[0] / x[2], b = x[1] / x[2], r2 = a * a + b * b;
  const auto& k = camera.distortion;
  const T radial =
      (T(1) + r2 * (T(k[0]) + r2 * (T(k[1]) + r2 * T(k[4])))) / (T(1) + r2 * (T(k[5]) + r2 * (T(k[6]) + r2 * T(k[7]))));
  const T u = a * radial + T(2 * k[2]) * a * b + T(k[3]) * (r2 + T(2) * a * a);
  const T v = b * radial + T(k[2]) * (r2 + T(2) * b * b) + T(2 * k[3]) * a * b;
  return {fx * u + T(camera.cx), fy * v + T(camera.cy)};
}

/// One frame's body and camera as functions of one of the layout's parameters.
struct SeededFrame {
  Body<Jet> body;
  Camera camera;
  Jet fx, fy, scale, tx, ty;
  [[nodiscard]] Eigen::Matrix<Jet, 2, 1> Project(const Vector3<Jet>& x) const {
    return twin::Project<Jet>(camera, x, fx, fy, scale, tx, ty);
  }
};

/// Derivatives are by parameter `column` (−1: none): right increments for rotations.
inline SeededFrame SeedFrame(const BodyModel& model, const FrameLayout& layout, const FrameState& state,
                             const Eigen::VectorXd& betas, double log_focal, int column) {
  const auto seed = [&](int c, double value) { return c == column ? Jet(value, 0) : Jet(value); };
  SeededFrame frame;
  frame.camera = layout.camera;
  frame.body.model = &model;
  for (int j = 0; j < model.num_joints(); ++j) {
    Vector3<Jet> delta(Jet(0.0), Jet(0.0), Jet(0.0));
    const int first = layout.column_of_joint[j];
    for (int c = 0; c < 3 && first >= 0; ++c) delta[c] = seed(first + c, 0.0);
    frame.body.local.push_back(state.rotations[j].cast<Jet>() * Exp(delta));
  }
  frame.body.betas.resize(layout.num_betas);
  for (int b = 0; b < layout.num_betas; ++b) frame.body.betas[b] = seed(layout.beta_column + b, betas[b]);
  Vector3<Jet> translation;
  for (int c = 0; c < 3; ++c) translation[c] = seed(layout.translation_column + c, state.translation[c]);
  frame.fx = Jet(layout.camera.fx), frame.fy = Jet(layout.camera.fy);
  frame.scale = Jet(1.0), frame.tx = Jet(0.0), frame.ty = Jet(0.0);
  if (layout.knowledge == CameraKnowledge::kWeak) {
    frame.body.trans = Vector3<Jet>(Jet(0.0), Jet(0.0), Jet(0.0));
    frame.scale = exp(translation[0]);
    frame.tx = translation[1];
    frame.ty = translation[2];
  } else {
    frame.body.trans = translation;
  }
  if (layout.focal_column >= 0) frame.fx = frame.fy = exp(seed(layout.focal_column, log_focal));
  return frame;
}

}  // namespace bodyloom::twin
