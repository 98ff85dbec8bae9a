// SPDX-License-Identifier: Apache-2.0
/// Finds faults of a body's mesh, at rest and in the poses of a track, and writes a repaired copy.
#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "data_tools/body/repair_body.h"
#include "geometry/base/callbacks.h"
#include "geometry/mesh/mesh_check.h"

namespace bodyloom {

/// Finds pairs of intersecting faces, including faces that share a corner and also intersect elsewhere. No face names a
/// vertex twice, and no two faces have the same vertices.
using FindCrossingFaces =
    std::function<std::vector<std::array<int, 2>>(const MatrixX3d& vertices, const MatrixX3i& faces)>;

/// Surface algorithms supplied by programs that are linked with CGAL. Empty functions: the checks are skipped.
struct SurfaceTools {
  FindCrossingFaces crossing;
  FindHoleFaces hole_faces;
};

struct CheckBodyRequest {
  std::string body;           ///< empty: the built-in body
  std::string track, frames;  ///< poses to check for crossing faces (FrameRange); empty: none, all frames
  std::string repair;         ///< the repaired body, compact .npz; empty: not written
  double same_place_mm = 0;   ///< vertices within this distance coincide
  int max_hole_edges = 100;   ///< of holes that `repair` fills
  SurfaceTools surface_tools;
};

/// One kind of fault.
struct BodyFinding {
  std::string what;
  int count = 0;
  std::string details;  ///< where, for a reader
};

struct CheckBodyReport {
  std::string description;  ///< the mesh in a line
  std::vector<BodyFinding> findings;
  bool crossing_checked = false;  ///< true if checked for crossing faces
  bool could_fill_holes = false;  ///< true if SurfaceTools::hole_faces was given
  int poses_checked = 0;
  bool repaired = false;
  RepairBodySummary repair;
  std::vector<BodyFinding> left;  ///< faults of the repaired body
  std::string out;

  /// Faults of the resulting body: the repaired one if there is one.
  [[nodiscard]] const std::vector<BodyFinding>& remaining() const { return repaired ? left : findings; }
};

/// Checks the body; crossing faces are checked in the repaired body if there is one. Throws RequestError for a track
/// without SurfaceTools::crossing, or a file both read and written; std::runtime_error naming a file that cannot be
/// used; Cancelled.
CheckBodyReport CheckBody(const CheckBodyRequest& request, const PipelineCallbacks& callbacks = {});

/// One line per fault, or "nothing found"; then the repairs and the remaining faults.
std::string ToText(const CheckBodyReport& report);

}  // namespace bodyloom
