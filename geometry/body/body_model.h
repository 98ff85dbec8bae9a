// SPDX-License-Identifier: Apache-2.0
/// The parametric body: immutable data of the SMPL family (SMPL, SMPL-H, SMPL-X, the built-in body) with run-time
/// sizes.
///
/// A body of V vertices, J joints, B shape components and, optionally, pose correctives:
///   v_shaped(β)  = v_template + shapedirs β
///   joints(β)    = J_regressor v_shaped(β)
///   v_rest(β,θ)  = v_shaped(β) + posedirs · vec_rowmajor(R_j − I, j = 1..J−1)
///   v(β,θ,t)     = Σ_j w_j [ G_j(θ) (v_rest − joints_j) + p_j ] + t
/// with G_j, p_j the world rotation and position of joint j along the kinematic tree.
/// Source: Loper et al., "SMPL: A Skinned Multi-Person Linear Model", eq. 2–10.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "geometry/math/arrays.h"

namespace bodyloom {

/// A named linear functional of the vertices: point = Σ_i weight_i · vertex_i (weights sum to 1).
struct Landmark {
  std::string name;
  std::vector<int> vertices;
  std::vector<double> weights;
};

/// Pose correctives by blocks: vertex v depends on joint `joint[k]` (k in [begin[v], begin[v+1])) through the 3×9 block
/// at `block[27 k]`, row-major, which multiplies vec_rowmajor(R_joint − I). Only non-zero blocks are stored, so a body
/// with local correctives costs what it uses and a dense SMPL is the special case of J−1 blocks a vertex.
struct PoseCorrectives {
  std::vector<int> begin;  ///< V+1 entries, or empty when the body has no correctives
  std::vector<int> joint;
  std::vector<float> block;
  [[nodiscard]] bool empty() const { return joint.empty(); }
};

/// Plain arrays as read from a file. BodyModel's constructor checks them.
struct BodyModelData {
  std::string name;                      ///< "bodyloom", "smpl", "smplh", "smplx", …
  std::vector<std::string> joint_names;  ///< J; empty means SMPL's names as far as they reach
  std::vector<int> parents;              ///< J; parents[0] = −1, parents[j] < j
  MatrixX3d v_template;                  ///< V×3 metres, T-pose
  RowMatrixXf shapedirs;                 ///< 3V×B, row 3v+c: metres per unit of β
  PoseCorrectives posedirs;
  SparseRows J_regressor;     ///< J×V, rows sum to 1
  SparseRows weights;         ///< V×J skinning weights, rows sum to 1
  MatrixX3i faces;            ///< F×3 vertex indices, counter-clockwise seen from outside
  Eigen::VectorXd pose_mean;  ///< 3J axis-angle added to poses (hands of SMPL-H/X); empty means zero

  // Optional surface coordinates. Empty when neither the body nor the user provides them.
  MatrixX2f vt;                     ///< UV vertices in [0,1]², v up
  MatrixX3i ft;                     ///< F×3 indices into vt
  std::vector<uint8_t> face_part;   ///< F DensePose-style chart ids 1..24 (0: none)
  RowMatrixXf face_iuv;             ///< F×6: (u,v) of the three corners inside the face's chart
  std::vector<Landmark> landmarks;  ///< for example COCO-17, toes and heels
};

class BodyModel {
 public:
  /// Takes and checks the data. Throws std::invalid_argument naming the array, what it holds and what was expected:
  /// sizes, index ranges, finite values, weights and regressor rows summing to 1 within 1e-3 (then normalised),
  /// landmark weights summing to 1 within 1e-3.
  explicit BodyModel(BodyModelData data);

  [[nodiscard]] const BodyModelData& data() const { return data_; }
  [[nodiscard]] const std::string& name() const { return data_.name; }
  [[nodiscard]] int num_vertices() const { return static_cast<int>(data_.v_template.rows()); }
  [[nodiscard]] int num_faces() const { return static_cast<int>(data_.faces.rows()); }
  [[nodiscard]] int num_joints() const { return static_cast<int>(data_.parents.size()); }
  [[nodiscard]] int num_betas() const { return static_cast<int>(data_.shapedirs.cols()); }
  [[nodiscard]] const std::vector<int>& parents() const { return data_.parents; }

  /// Joints of the mean shape (J×3) and their derivative by shape (3J×B): joints(β) = joint_template + joint_shapedirs
  /// β.
  [[nodiscard]] const MatrixX3d& joint_template() const { return joint_template_; }
  [[nodiscard]] const Eigen::MatrixXd& joint_shapedirs() const { return joint_shapedirs_; }
  /// J×3 rest joints of a shape. betas may be shorter than B (the rest is zero); longer throws.
  [[nodiscard]] MatrixX3d RestJoints(const Eigen::VectorXd& betas) const;

  /// Skinning influences of vertex v: joints and weights in [influence_begin[v], influence_begin[v+1]).
  [[nodiscard]] const std::vector<int>& influence_begin() const { return influence_begin_; }
  [[nodiscard]] const std::vector<int>& influence_joint() const { return influence_joint_; }
  [[nodiscard]] const std::vector<double>& influence_weight() const { return influence_weight_; }

  /// Joints from the root to j, j included.
  [[nodiscard]] const std::vector<int>& ancestors(int j) const { return ancestors_[j]; }
  /// Returns the index of a name, −1 when absent.
  [[nodiscard]] int FindJoint(const std::string& name) const;
  [[nodiscard]] int FindLandmark(const std::string& name) const;
  [[nodiscard]] bool has_uv() const { return data_.ft.rows() > 0; }
  [[nodiscard]] bool has_parts() const { return !data_.face_part.empty(); }

 private:
  BodyModelData data_;
  MatrixX3d joint_template_;
  Eigen::MatrixXd joint_shapedirs_;
  std::vector<int> influence_begin_, influence_joint_;
  std::vector<double> influence_weight_;
  std::vector<std::vector<int>> ancestors_;
};

/// SMPL's 24 joint names in order (pelvis … r_hand) and its parents.
const std::vector<std::string>& SmplJointNames();
const std::vector<int>& SmplParents();

/// Blocks of a dense posedirs array (3V rows, 9(J−1) columns, row 3v+c); blocks whose entries are all within
/// ±threshold are dropped (0: exact).
PoseCorrectives PoseCorrectivesFromDense(const float* posedirs, int num_vertices, int num_joints, float threshold = 0);

// The hip joints; errors and uncertainties of poses are stated relative to their midpoint, the mid-hip.

/// Indices of l_hip and r_hip; twice the root where the body lacks one of them.
inline std::array<int, 2> HipJoints(const BodyModel& body) {
  const std::array<int, 2> hips = {body.FindJoint("l_hip"), body.FindJoint("r_hip")};
  return hips[0] < 0 || hips[1] < 0 ? std::array<int, 2>{0, 0} : hips;
}

/// A point of the surface: Σ_c barycentric_c · (corner c of the face).
struct SurfacePoint {
  int face = -1;                                           ///< −1: no point (a part that the body lacks)
  Eigen::Vector3d barycentric = Eigen::Vector3d::UnitX();  ///< sums to 1 for a point in the face's plane
};

}  // namespace bodyloom
