// SPDX-License-Identifier: Apache-2.0
/// What is wrong with a body's mesh, at rest and in the poses of a track, and a copy with what can be mended mended.
#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "data_tools/body/repair_body.h"
#include "geometry/base/callbacks.h"
#include "geometry/mesh/mesh_check.h"

namespace bodyloom {

/// Pairs of faces that cross each other, faces that share a corner too where they cross elsewhere. No face names a
/// vertex twice, no two have the same vertices.
using FindCrossingFaces =
    std::function<std::vector<std::array<int, 2>>(const MatrixX3d& vertices, const MatrixX3i& faces)>;

/// What the libraries do not know of surfaces, and a program that is linked with CGAL does. Empty: not done.
struct SurfaceTools {
  FindCrossingFaces crossing;
  FindHoleFaces hole_faces;
};

struct CheckBodyRequest {
  std::string body;           ///< empty: the built-in body
  std::string track, frames;  ///< poses to look for crossing faces in (FrameRange); empty: none, all frames
  std::string repair;         ///< the mended body, compact .npz; empty: not written
  double same_place_mm = 0;   ///< vertices no further apart are one place
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
  bool crossing_checked = false;  ///< whether crossing faces were looked for
  bool could_fill_holes = false;  ///< whether there was what fills holes
  int poses_checked = 0;
  bool repaired = false;
  RepairBodySummary repair;
  std::vector<BodyFinding> left;  ///< of the mended body
  std::string out;

  /// Findings of the body that a user goes on with: the mended one where there is one.
  [[nodiscard]] const std::vector<BodyFinding>& remaining() const { return repaired ? left : findings; }
};

/// Crossing faces are looked for in the mended body where there is one. Throws RequestError for a track without
/// what finds them, or a file both read and written; std::runtime_error naming a file that cannot be used; Cancelled.
CheckBodyReport CheckBody(const CheckBodyRequest& request, const PipelineCallbacks& callbacks = {});

/// A line a finding, or "nothing found"; then what was mended and what is left.
std::string ToText(const CheckBodyReport& report);

}  // namespace bodyloom
