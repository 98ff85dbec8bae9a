// SPDX-License-Identifier: Apache-2.0
/// Image errors of an estimated motion: distances from detections and true projections in pixels. Metric errors:
/// data_tools/evaluation/metrics.h.
///
/// Shapes: T frames of K×2 pixels. A point without a projection is a row of NaN; it is left out of distances and
/// counted in `missing`, and it counts as wrong in PCK.
#pragma once

#include <span>
#include <vector>

#include "data_tools/evaluation/metrics.h"
#include "geometry/math/arrays.h"
#include "geometry/scene/camera.h"
#include "geometry/scene/observations.h"

namespace bodyloom {

using PixelClip = std::span<const MatrixX2d>;

/// N×2 pixels of N×3 points in the camera frame; NaN where the camera does not project (Camera::Project).
MatrixX2d ProjectPoints(const Camera& camera, const MatrixX3d& points_in_camera);

/// Factor that brings pixels of a width×height image to the scale of a side×side one into which the whole image was
/// fitted: side / max(width, height). Papers that report pixels "for images of size 512×512" rarely state how the image
/// was resized; this project always scales by the longer side.
double SquareImageScale(int width, int height, int side = 512);

/// Per-vertex projection error of paper A, Table 4: distance between the projected vertices of the estimated and of the
/// true body, each through its own camera, in pixels of a side×side image:
///   e_tv = ‖π(v̂_tv) − π(v_tv)‖ · side / max(width, height).
/// Source: "Learning Motion-Dependent Appearance for High-Fidelity Rendering of Dynamic Humans from a Single Camera",
/// appendix A. The table's "mean ± std" does not name the population; the spread over frames' means matches its
/// magnitude (±10–30 % of the mean); the spread over vertices is given too.
struct ProjectionError {
  double mean_px = kNotMeasured;          ///< over all frames and vertices
  double std_frames_px = kNotMeasured;    ///< spread of the frames' means
  double std_vertices_px = kNotMeasured;  ///< spread over all frames and vertices
  double rms_px = kNotMeasured;           ///< √ mean e²
  ErrorStatistics frames_px;              ///< distribution of the frames' means
  int64_t count = 0, missing = 0;         ///< vertices
};

/// Gathers a ProjectionError frame by frame. `scale` multiplies the distances (SquareImageScale).
class ProjectionErrorAccumulator {
 public:
  explicit ProjectionErrorAccumulator(double scale) : scale_(scale) {}
  void AddFrame(const MatrixX2d& prediction_px, const MatrixX2d& truth_px);
  [[nodiscard]] ProjectionError Result() const;

 private:
  double scale_ = 1, sum_ = 0, squares_ = 0;
  int64_t count_ = 0, missing_ = 0;
  std::vector<double> frame_means_;
};

ProjectionError PerVertexProjectionError(PixelClip prediction_px, PixelClip truth_px, int width, int height,
                                         int side = 512);

/// Distances of projected points to detections, pooled over frames (and over cameras, by calling it again).
struct ReprojectionErrors {
  std::vector<double> px;
  std::vector<double> percent_of_height;  ///< of the person's height in that frame, where there is one
  int64_t missing = 0;                    ///< detections whose point has no projection
};
/// Appends e_tk = ‖prediction − detection‖ of every detection with confidence above min_confidence. The prediction may
/// have fewer frames than the detections, not more.
void AddReprojectionErrors(PixelClip prediction_px, const KeypointSequence& detections, double min_confidence,
                           ReprojectionErrors* errors);

/// Longer side of the box around the detections of a frame with confidence above min_confidence: the height in pixels
/// of a standing person, and a comparable measure of size in other poses. NaN with fewer than five detections.
double DetectionBoxSidePx(const KeypointSequence& detections, int frame, double min_confidence);

/// Reference length of a PCK threshold.
enum class PckReference {
  kBox,    ///< longer side of the box around the frame's detections (DetectionBoxSidePx); PCK@0.05, PCK@0.1
  kTorso,  ///< distance from left shoulder to right hip (or right shoulder to left hip when one is missing); PCK@0.2
};
/// Percentage of correct keypoints, counted over frames (and over cameras, by calling Add again).
struct CorrectKeypoints {
  int64_t correct = 0, total = 0;
  /// Share in 0…1, NaN when nothing was counted.
  [[nodiscard]] double Share() const;
};
/// Counts the detections with confidence above min_confidence, and those whose predicted point lies within
/// fraction × reference. Frames without a reference are left out.
/// Source of @0.2 torso: Sapp and Taskar, "MODEC", CVPR 2013.
void AddCorrectKeypoints(PixelClip prediction_px, const KeypointSequence& detections, double fraction,
                         PckReference reference, double min_confidence, CorrectKeypoints* counts);

}  // namespace bodyloom
