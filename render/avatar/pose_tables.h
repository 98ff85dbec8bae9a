// SPDX-License-Identifier: Apache-2.0
/// Checked arguments of posing, as plain arrays.
#pragma once

#include "bodyloom/geometry/arrays.h"
#include "bodyloom/render/avatar/avatar_frame.h"
#include "bodyloom/render/avatar/gaussian_body.h"
#include "bodyloom/render/avatar/pose_options.h"
#include "bodyloom/render/avatar/pose_simd.h"

namespace bodyloom::avatar_internal {

inline constexpr int kRowsAChunk = 1024;  ///< a multiple of kLanes; sums are taken chunk by chunk
inline int NumChunks(int num_rows) { return (num_rows + kRowsAChunk - 1) / kRowsAChunk; }

/// Throws as PoseGaussians does. The arguments must outlive the answer.
PoseTables TablesOf(const GaussianBody& body, const MatrixX3i& faces, const AvatarFrame& frame,
                    const PoseGaussiansOptions& options);

}  // namespace bodyloom::avatar_internal
