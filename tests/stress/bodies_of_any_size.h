// SPDX-License-Identifier: Apache-2.0
/// The toy body (tests/support/toy_body.h) with as many vertices as requested: the same person, finer or coarser.
#pragma once

#include "geometry/body/body_model.h"

namespace bodyloom::stress {

/// Exactly 100 vertices: three about each joint and one for each landmark of the surface.
BodyModel BodyOf100Vertices();

/// The toy body's vertices repeated, at most `num_vertices` of them (at least 804); every complete copy has faces.
BodyModel BodyOfManyVertices(int num_vertices);

/// The body scaled by `scale`: in millimetres for 1000.
BodyModel ScaledBody(const BodyModel& body, double scale);

}  // namespace bodyloom::stress
