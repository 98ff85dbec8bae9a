// SPDX-License-Identifier: Apache-2.0
/// The unknowns of a frame, its pose and position, and their columns in its normal equations.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "geometry/body/body_model.h"
#include "geometry/scene/camera.h"
#include "tracking/problem/camera_knowledge.h"

namespace bodyloom {

struct FrameState {
  std::vector<Eigen::Matrix3d> rotations;  ///< J
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();
};

bool IsFinite(const FrameState& state);

/// The unknowns of a frame and their columns in its Jacobian; shared by all frames of a clip.
struct FrameLayout {
  const BodyModel* model = nullptr;
  CameraKnowledge knowledge = CameraKnowledge::kKnown;
  Camera camera;                     ///< intrinsics; the focal length is replaced by exp(log_focal) when estimated
  std::vector<int> active_joints;    ///< joints whose rotation is estimated, in column order (3 columns each)
  std::vector<int> column_of_joint;  ///< J; −1: held
  int translation_column = 0;        ///< 3 columns: translation, or (log scale, tx, ty) for weak perspective
  int beta_column = 0, num_betas = 0;
  int focal_column = -1;  ///< −1: known
  int num_columns = 0;

  static FrameLayout Make(const BodyModel& model, CameraKnowledge knowledge, const Camera& camera,
                          std::vector<int> active_joints, int num_betas);
  [[nodiscard]] int num_frame_columns() const { return translation_column + 3; }

  /// The unknowns as blocks, in column order: one of three columns a joint and for the translation, then one for the
  /// shape and one for the logarithm of the focal length, where they are estimated.
  [[nodiscard]] int num_blocks() const { return translation_column / 3 + 1 + (num_betas > 0) + (focal_column >= 0); }
  [[nodiscard]] int TranslationBlock() const { return translation_column / 3; }
  [[nodiscard]] int BetaBlock() const { return num_betas > 0 ? TranslationBlock() + 1 : -1; }  ///< −1: not estimated
  [[nodiscard]] int FocalBlock() const { return focal_column >= 0 ? num_blocks() - 1 : -1; }   ///< −1: not estimated
  /// Block of a column of a joint or of the translation.
  [[nodiscard]] static int BlockOfColumn(int column) { return column / 3; }
  [[nodiscard]] int FirstColumn(int block) const {
    return block <= TranslationBlock() ? 3 * block : block == BetaBlock() ? beta_column : focal_column;
  }
  [[nodiscard]] int NumColumns(int block) const {
    return block <= TranslationBlock() ? 3 : block == BetaBlock() ? num_betas : 1;
  }
  /// Intrinsics at a frame's state; for weak perspective with its scale and offset.
  [[nodiscard]] Camera CameraAt(const FrameState& state, double log_focal) const;
  /// Translation of the body: zero for weak perspective, where it is in the camera.
  [[nodiscard]] Eigen::Vector3d BodyTranslation(const FrameState& state) const;
  /// Position of the body's origin in the camera frame, metres. For weak perspective: (tx, ty, fx/s), at the distance
  /// for a pinhole of the layout's focal length.
  [[nodiscard]] Eigen::Vector3d BodyPlace(const FrameState& state) const;
  /// ∂BodyPlace/∂(the translation's three columns): the identity except for weak perspective.
  [[nodiscard]] Eigen::Matrix3d BodyPlaceByTranslation(const FrameState& state) const;
};

/// Interpolates from a (s = 0) to b (s = 1): rotations along geodesics, translation linearly.
FrameState InterpolateStates(const FrameState& a, const FrameState& b, double s);

/// Image height of an upright body of this stature at a frame's depth, pixels: the scale of detection noise.
double UprightHeightPx(const FrameLayout& layout, const FrameState& state, double stature_m);

}  // namespace bodyloom
