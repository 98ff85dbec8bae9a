// SPDX-License-Identifier: Apache-2.0
/// The points of a body that correspond to a texel's by symmetry, for guesses at what a picture does not show. Of a point
/// that one side of the body at rest (rest_views.h) shows at (x, y):
///   mirror       what the same side shows at (−x, y)          the other arm
///   behind       what the other side shows at (x, y)          the back of the same arm
///   across       what the other side shows at (−x, y)
/// A point that neither side shows (in a fold) corresponds to nothing.
#pragma once

#include <array>
#include <vector>

#include "bodyloom/geometry/arrays.h"
#include "bodyloom/geometry/surface_point.h"
#include "bodyloom/geometry/uv_texels.h"
#include "bodyloom/render/person/rest_views.h"

namespace bodyloom {

enum TexelCounterpart { kMirror, kBehind, kAcross, kNumCounterparts };

/// One a texel of the table; face −1: none.
using TexelCounterparts = std::array<std::vector<SurfacePoint>, kNumCounterparts>;

/// The texels' points, n×3, from a body at rest (V×3, metres).
MatrixX3d TexelPoints(const MatrixX3d& rest_vertices, const MatrixX3i& faces, const UvTexelTable& table);

/// `points`: TexelPoints() of the body that `views` see.
TexelCounterparts FindTexelCounterparts(const RestViews& views, const MatrixX3d& points);

}  // namespace bodyloom
