// SPDX-License-Identifier: Apache-2.0
/// Errors of an estimated motion against the true one: positions, motion over time, joint angles. Inputs in metres and
/// seconds. Errors in pixels: data_tools/evaluation/metrics_image.h.
///
/// Shapes: a clip is T frames of P points (P×3), the same for prediction and truth; otherwise std::invalid_argument.
/// Missing values: a point with a non-finite coordinate on either side is left out of every mean and counted in
/// `missing`. Protocols that must not reward missing frames fill them first (NearestFramesWithResult). Definitions as
/// in the evaluation code of WHAM, TRAM and GVHMR where they agree; deviations are stated.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "geometry/math/arrays.h"
#include "geometry/scene/track.h"

namespace bodyloom {

inline constexpr double kNotMeasured = std::numeric_limits<double>::quiet_NaN();

/// Distribution of a set of errors; NaN if there was nothing to measure.
struct ErrorStatistics {
  double mean = kNotMeasured;
  double std_dev = kNotMeasured;  ///< of the population: √(mean of squares − square of mean)
  double median = kNotMeasured, p95 = kNotMeasured, max = kNotMeasured;
  int64_t count = 0;    ///< finite values
  int64_t missing = 0;  ///< non-finite values, left out
};
ErrorStatistics Summarize(std::span<const double> values);

/// Percentage of the finite values that are above `limit`; NaN if none is finite.
double PercentAbove(std::span<const double> values, double limit);

/// Error of a frame's landmarks after a similarity transform above which it shows another pose, such as a limb turned
/// the other way or front and back exchanged.
inline constexpr double kAnotherPose_m = 0.12;

/// True for each of the first `frames` frames of the track that has a result; the track has at least as many.
std::vector<bool> HasResults(const Track& track, int frames);

/// For every frame the nearest frame that has a result, the earlier one in a tie; empty if none has.
/// Scoring frame t with frame result[t] makes a missing frame cost as much as standing still.
std::vector<int> NearestFramesWithResult(const std::vector<bool>& has_result);

// ---- positions ------------------------------------------------------------------------------------------------------

using Clip = std::span<const MatrixX3d>;

/// T×3: mean of the points `root` of each frame (NaN if one of them is not finite). {0} is SMPL's pelvis, {1, 2} the
/// middle of SMPL's hips, {11, 12} the middle of COCO's.
MatrixX3d RootPositions(Clip points, const std::vector<int>& root);

/// points_t − roots_t, row by row. roots is T×3.
std::vector<MatrixX3d> RelativeTo(Clip points, const MatrixX3d& roots);

/// The global scale of a clip: argmin_s Σ_{t,p} ‖s·prediction − truth‖² = Σ ⟨prediction, truth⟩ / Σ ‖prediction‖², both
/// relative to their roots. It is not observable with a single camera. NaN if the prediction is all zero or missing.
double ClipScale(Clip prediction_from_root, Clip truth_from_root);

/// Distances between corresponding points, metres.
struct PositionError {
  double mean = kNotMeasured;    ///< over all frames and points
  ErrorStatistics frames;        ///< distribution of the frames' means
  std::vector<double> of_frame;  ///< T: those means; NaN where all points are missing
  Eigen::VectorXd per_point;     ///< P: mean over frames of each point
  int64_t count = 0, missing = 0;
};

/// Gathers a PositionError frame by frame, for clips too large for memory (all vertices of long clips).
class PositionErrorAccumulator {
 public:
  /// Distances of one frame's P points, metres; a non-finite one is missing.
  void AddFrame(const Eigen::VectorXd& distances);
  [[nodiscard]] PositionError Result() const;

 private:
  std::vector<double> frame_means_;
  Eigen::VectorXd point_sum_;
  std::vector<int64_t> point_count_;
  int64_t missing_ = 0;
};

/// mean_{t,p} ‖prediction − truth‖ with no alignment. MPJPE and PVE are this after RelativeTo the root:
///   MPJPE        = MeanPositionError(RelativeTo(joints, root), …)
///   scaled MPJPE = MeanPositionError(RelativeTo(joints, root), …, ClipScale(…))
///   PVE          = MeanPositionError(RelativeTo(vertices, pelvis joint), …)
/// `scale` multiplies the prediction.
PositionError MeanPositionError(Clip prediction, Clip truth, double scale = 1);

/// PA-MPJPE: each frame's prediction is first moved onto the truth by its own similarity (geometry/math/procrustes.h).
/// A frame whose alignment has no points is missing.
PositionError ProcrustesPositionError(Clip prediction, Clip truth);

/// Error of root positions, T×3 metres in the camera frame. Depth, the least certain coordinate with a single camera,
/// is reported separately.
struct RootError {
  ErrorStatistics distance;       ///< ‖prediction − truth‖
  double lateral = kNotMeasured;  ///< mean distance in the image plane's directions (x, y)
  double depth = kNotMeasured;    ///< mean |z difference|
};
RootError RootPositionError(const MatrixX3d& prediction, const MatrixX3d& truth);

// ---- motion over time -----------------------------------------------------------------------------------------------

/// Time derivatives of a clip by divided differences of real timestamps (T seconds, strictly increasing):
///   order 1: x′, 2: x″, 3: x‴ = order! · [x_t … x_{t+order}],
/// exact for polynomials of that degree and equal to the usual n-th difference × fpsⁿ at a constant frame rate.
/// Returns max(0, T − order) frames. A stencil with a step above max_step_s crosses a gap and gives NaN;
/// max_step_s = 0 means 1.5 times the median step.
std::vector<MatrixX3d> TimeDerivative(Clip points, const std::vector<double>& timestamps, int order,
                                      double max_step_s = 0);

struct MotionError {
  double mean = kNotMeasured;             ///< ‖difference of the derivatives‖ over frames and points
  double mean_prediction = kNotMeasured;  ///< ‖derivative‖ of the prediction
  double mean_truth = kNotMeasured;       ///< and of the truth
  int64_t count = 0, missing = 0;
};
/// Acceleration error, m/s²: ‖x″ of prediction − x″ of truth‖. No alignment: positions in one and the same frame.
MotionError AccelerationError(Clip prediction, Clip truth, const std::vector<double>& timestamps,
                              double max_step_s = 0);

/// Jitter, m/s³: mean ‖x‴‖ of one clip. (WHAM and GVHMR print this divided by 10.)
double Jitter(Clip points, const std::vector<double>& timestamps, double max_step_s = 0);

// ---- joint angles ---------------------------------------------------------------------------------------------------

/// Geodesic angle between corresponding rotations, degrees in [0, 180].
struct JointAngleError {
  double mean_deg = kNotMeasured;  ///< joints 1…J−1 relative to their parents, over all frames
  double root_deg = kNotMeasured;  ///< joint 0: the body's orientation in the frame of the poses
  Eigen::VectorXd per_joint_deg;   ///< J: mean over frames
  ErrorStatistics frames;          ///< distribution of the frames' means over joints 1…J−1
  int64_t count = 0, missing = 0;  ///< joint rotations, the root's included
};
/// Poses are T×3J axis-angle, radians, both in the same camera or world frame.
JointAngleError MeanJointAngleError(const RowMatrixXd& prediction, const RowMatrixXd& truth);

}  // namespace bodyloom
