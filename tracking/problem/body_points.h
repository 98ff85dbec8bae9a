// SPDX-License-Identifier: Apache-2.0
/// Points of the body as sums over bones, and their derivatives.
///
/// Every linear functional of the vertices, a landmark or a surface point (face + barycentric), is
///   x = Σ_i [ G_i q_i + W_i t_i ]       q_i = q⁰_i + Q_i β + Σ_j P_ij vec(R_j − I)
/// with i over the few bones that move it. Landmarks are compiled into this form once (CompiledPoint), so that a
/// landmark averaged over 200 vertices costs as much as one vertex; surface points are gathered from three vertices.
/// Derivatives: d x/d δ_j = −[S_j − W_j p_j]× G_j + E_j d vec(R_j)/d δ_j with S_j, W_j the sums of G_i q_i + W_i t_i
/// and W_i over the bones i below j, E_j = Σ_i G_i P_ij; d x/d β = Σ_i G_i Q_i + W_i d t_i/d β; d x/d trans = I.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "geometry/body/body_model.h"

namespace bodyloom {

// The kinematic tree of one frame with everything its derivatives need; scratch memory that is reused between frames.
//
// Bone j maps a rest point x to G_j x + t_j with t_j = p_j − G_j rest_j, p_j the joint's position. Rotations are
// differentiated by right increments R_j ← R_j exp(δ_j).

struct Kinematics {
  using Matrix93d = Eigen::Matrix<double, 9, 3>;
  using Matrix3Bd = Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::ColMajor, 3, 32>;
  static constexpr int kMaxBetas = 32;

  const BodyModel* model = nullptr;
  Eigen::VectorXd betas;                             ///< the first n shape components in use
  std::vector<Eigen::Matrix3d> R, G;                 ///< J local and world rotations
  std::vector<Eigen::Vector3d> p, rest, t;           ///< J joint positions, rest joints, bone offsets
  std::vector<Matrix3Bd> dp, dt;                     ///< J derivatives of p and t by betas, 3×n
  std::vector<Matrix93d> feature_jacobian;           ///< J: d vec_rowmajor(R_j) / d δ_j
  std::vector<Eigen::Matrix<double, 9, 1>> feature;  ///< J: vec_rowmajor(R_j − I)

  /// Sets shape and pose. `rotations` holds J matrices. Derivatives are filled only when requested.
  void Set(const BodyModel& body, const Eigen::VectorXd& shape, const std::vector<Eigen::Matrix3d>& rotations,
           const Eigen::Vector3d& trans, bool derivatives);
};

/// A landmark compiled for a body and a number of shape components.
struct CompiledPoint {
  struct Bone {
    int joint = 0;
    double weight = 0;
    Eigen::Vector3d q0;
    Eigen::Matrix<double, 3, Eigen::Dynamic> Q;  ///< 3×B
  };
  struct Corrective {
    int bone = 0;   ///< index into `bones`
    int joint = 0;  ///< whose rotation drives it
    Eigen::Matrix<double, 3, 9> P;
  };
  std::vector<Bone> bones;
  std::vector<Corrective> correctives;
};

CompiledPoint CompilePoint(const BodyModel& model, std::span<const int> vertices, std::span<const double> weights,
                           int num_betas);

/// Position of one point and, when requested, its derivative by the listed joints; reused between points.
class PointEvaluator {
 public:
  /// Posed position; `kinematics` must hold derivatives when Jacobian() is called afterwards.
  Eigen::Vector3d Evaluate(const Kinematics& kinematics, const CompiledPoint& point, bool jacobian);
  /// The surface point Σ_k barycentric_k · vertex_k. Rest vertices come from `cache`.
  class VertexCache;
  Eigen::Vector3d Evaluate(const Kinematics& kinematics, const int vertices[3], const double barycentric[3],
                           VertexCache* cache, bool jacobian);

  /// Posed position of one vertex. Does not affect the results of the last Evaluate().
  static Eigen::Vector3d VertexPosition(const Kinematics& kinematics, int v, VertexCache* cache);

  /// Joints that move the point, after Evaluate(…, true).
  [[nodiscard]] const std::vector<int>& joints() const { return touched_; }
  /// d x / d δ_j for j in joints(); 3×3.
  [[nodiscard]] Eigen::Matrix3d JointJacobian(const Kinematics& kinematics, int j) const;
  /// d x / d β, 3×B.
  [[nodiscard]] const Kinematics::Matrix3Bd& ShapeJacobian() const { return shape_; }

  /// Rest positions (shape and correctives applied) of the vertices that were requested in the current frame.
  class VertexCache {
   public:
    void NewFrame(const Kinematics& kinematics);
    const Eigen::Vector3d& Rest(const Kinematics& kinematics, int v);

   private:
    std::vector<int> stamp_;
    std::vector<Eigen::Vector3d> rest_;
    int frame_ = 0;
  };

 private:
  void Begin(const Kinematics& kinematics);
  void AddBone(const Kinematics& kinematics, int joint, double weight, const Eigen::Vector3d& y, bool jacobian);

  std::vector<Eigen::Vector3d> sum_;                     ///< S_j
  std::vector<double> weight_;                           ///< W_j
  std::vector<Eigen::Matrix<double, 3, 9>> corrective_;  ///< E_j
  std::vector<char> has_corrective_, is_touched_;
  std::vector<int> touched_, corrective_joints_;
  Kinematics::Matrix3Bd shape_;
};

}  // namespace bodyloom
