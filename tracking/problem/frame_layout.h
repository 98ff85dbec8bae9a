// SPDX-License-Identifier: Apache-2.0
/// The unknowns of a frame, its pose and position, those that all frames share, and their columns in its normal
/// equations.
#pragma once

#include <Eigen/Core>
#include <memory>
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

/// The unknowns of another view: of a second camera, and more, that shows the same person (view_terms.h).
struct ViewState {
  CameraPose camera_from_scene;  ///< from the frame of the states; its rotation is differentiated by right increments
  double log_focal = 0;
  /// The view's clock shows offset_s + (1 + rate) τ where the problem's shows τ, the time since the clip's middle.
  double offset_s = 0, rate = 0;
};

/// Unknowns that all frames share.
struct SharedValues {
  Eigen::VectorXd betas;
  double log_focal = 0;          ///< of the first view
  std::vector<ViewState> views;  ///< the others
};

struct FrameLayout;

/// Another view and the columns of its unknowns; −1: known.
struct ViewLayout {
  int pose_column = -1;   ///< 6: rotation, translation
  int focal_column = -1;  ///< 1
  int clock_column = -1;  ///< 2: offset, rate
  /// Prior of each unknown: mean and σ.
  double log_focal_prior = 0, log_focal_sigma = FocalPrior().log_sigma;
  /// Instead of that: mean and σ of the logarithm of the focal length less that of the first view's; σ = 0: none.
  double log_ratio_prior = 0, log_ratio_sigma = 0;
  double offset_prior_s = 0, offset_sigma_s = 1;
  double rate_prior = 0, rate_sigma = 1e-3;
  std::shared_ptr<const FrameLayout> local;  ///< of the view's terms by themselves, in its camera's frame
  /// The blocks of the unknowns above (FrameLayout::num_blocks()), rotation and translation of the pose being two; −1.
  int rotation_block = -1, translation_block = -1, focal_block = -1, clock_block = -1;
};

/// Unknowns of another view.
struct ViewUnknowns {
  CameraKnowledge knowledge = CameraKnowledge::kUnknownFocal;  ///< not kWeak
  Camera camera;                                               ///< intrinsics, as of FrameLayout
  bool pose = true, clock = true;
};

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
  int clock_column = -1;  ///< 2: the clock of the view, in ViewLayout::local only
  int num_columns = 0;
  std::vector<ViewLayout> views;  ///< the others than the first

  static FrameLayout Make(const BodyModel& model, CameraKnowledge knowledge, const Camera& camera,
                          std::vector<int> active_joints, int num_betas);
  /// Adds a view (view_terms.h), with the columns of its unknowns after all others. Throws std::invalid_argument for
  /// weak perspective and when the root's rotation is not estimated.
  void AddView(const ViewUnknowns& view);
  [[nodiscard]] int num_frame_columns() const { return translation_column + 3; }

  /// The unknowns as blocks, in column order: one of three columns a joint and for the translation, then one for the
  /// shape and one for the logarithm of the focal length, where they are estimated, then those of each view.
  [[nodiscard]] int num_blocks() const { return TranslationBlock() + 1 + static_cast<int>(shared_blocks.size()); }
  [[nodiscard]] int TranslationBlock() const { return translation_column / 3; }
  [[nodiscard]] int BetaBlock() const { return num_betas > 0 ? TranslationBlock() + 1 : -1; }  ///< −1: not estimated
  /// −1: not estimated.
  [[nodiscard]] int FocalBlock() const { return focal_column >= 0 ? TranslationBlock() + 1 + (num_betas > 0) : -1; }
  [[nodiscard]] int ClockBlock() const { return clock_column >= 0 ? num_blocks() - 1 : -1; }  ///< −1: known
  /// Block of a column of a joint or of the translation.
  [[nodiscard]] static int BlockOfColumn(int column) { return column / 3; }
  [[nodiscard]] int FirstColumn(int block) const {
    return block <= TranslationBlock() ? 3 * block : shared_blocks[block - TranslationBlock() - 1].first_column;
  }
  [[nodiscard]] int NumColumns(int block) const {
    return block <= TranslationBlock() ? 3 : shared_blocks[block - TranslationBlock() - 1].num_columns;
  }
  struct Block {
    int first_column = 0, num_columns = 0;
  };
  std::vector<Block> shared_blocks;  ///< those after the translation's
  /// Appends a block of columns and returns its number.
  int AddSharedBlock(int columns);
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

/// One Newton step from a product of rotations towards the nearest rotation, so that products of many do not drift.
Eigen::Matrix3d NearbyRotation(const Eigen::Matrix3d& product);

/// Step from a to b of the unknowns that all frames share, in the layout's columns from beta_column on. Rotations by
/// right increments.
Eigen::VectorXd SharedStep(const FrameLayout& layout, const SharedValues& a, const SharedValues& b);
/// The values after a step.
SharedValues StepShared(const FrameLayout& layout, const SharedValues& values, const Eigen::VectorXd& step);

/// Interpolates from a (s = 0) to b (s = 1): rotations along geodesics, translation linearly.
FrameState InterpolateStates(const FrameState& a, const FrameState& b, double s);

/// Image height of an upright body of this stature at a frame's depth, pixels: the scale of detection noise.
double UprightHeightPx(const FrameLayout& layout, const FrameState& state, double stature_m);

}  // namespace bodyloom
