// SPDX-License-Identifier: Apache-2.0
/// Compares the surfaces of two tracks of one person, vertex by vertex.
#pragma once

#include <vector>

#include "data_tools/evaluation/evaluation.h"
#include "data_tools/evaluation/metrics.h"
#include "data_tools/evaluation/metrics_image.h"
#include "geometry/body/body_model.h"
#include "geometry/scene/track.h"

namespace bodyloom {

struct VertexErrorOptions {
  int vertex_step = 1;      ///< every n-th vertex is compared (1: all); the mean moves by well under a percent up to 10
  int num_threads = 1;      ///< of skinning; the result is the same
  int image_side_px = 512;  ///< projection errors are for an image scaled to this by its longer side
  /// Body of the truth, with the vertices and joints of the track's: another sex of one family. Null: the track's.
  const BodyModel* true_body = nullptr;
};

struct VertexErrors {
  ProjectionError projection;  ///< each body through its own track's camera, pixels
  PositionError position;      ///< after moving pelvis onto pelvis, metres
};

/// Compares frame source[t] of `track` with frame t of `truth`, t < source.size(), both posed on `body` in the camera
/// frame. The image is the truth's (camera.width × height). Throws std::invalid_argument when a pose or shape does not
/// fit the body, a frame is out of range, the bodies have different vertices or joints, or vertex_step is below 1.
VertexErrors CompareVertices(const Track& track, const std::vector<int>& source, const Track& truth,
                             const BodyModel& body, const VertexErrorOptions& options = {});

enum class VertexErrorUnit {
  kMillimetres,  ///< distance after moving pelvis onto pelvis: the mean over all is pve_mm
  kPixels,       ///< distance of the projections, in pixels of options.image_side_px: the mean is projection_mean_px
};

/// Error of every vertex of frame t of `track` against frame t of `truth`; empty if either has no result there. Throws
/// as CompareVertices.
Eigen::VectorXd VertexErrorsOfFrame(const Track& track, const Track& truth, int t, const BodyModel& body,
                                    VertexErrorUnit unit, const VertexErrorOptions& options = {});

/// Adds projection_mean_px and its spreads, root mean square and 95th percentile.
void AddProjectionError(const ProjectionError& error, int image_side_px, Evaluation* evaluation);

}  // namespace bodyloom
