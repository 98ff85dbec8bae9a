// SPDX-License-Identifier: Apache-2.0
/// The sections of bodyloom_bench_descriptors. Each prints its own table; `folder` takes files.
#pragma once

#include <string>

#include "bodyloom/geometry/body_model.h"

namespace bodyloom {

void BenchNormals(const BodyModel& body);
void BenchVelocities(const BodyModel& body);
/// Jitter of a track and, with a truth at a finer rate that has frames at the track's times (`truth` empty: none), the
/// error of every velocity scheme against it, in camera and body axes.
void BenchTracked(const BodyModel& body, const std::string& track, const std::string& truth);
void BenchBake(const BodyModel& body);
/// Error of bilinear lookups in a baked map of normals, next to seams and away from them.
void BenchSeams(const BodyModel& body);
void BenchStream(const BodyModel& body, const std::string& folder);
void BenchTexture(const BodyModel& body, const std::string& folder);

}  // namespace bodyloom
