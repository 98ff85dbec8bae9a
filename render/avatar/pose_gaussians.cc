// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/render/avatar/pose_gaussians.h"

#include <algorithm>

#include "bodyloom/geometry/base/parallel.h"
#include "bodyloom/render/avatar/pose_tables.h"

namespace bodyloom {

void PoseGaussians(const GaussianBody& body, const MatrixX3i& faces, const AvatarFrame& frame,
                   const PoseGaussiansOptions& options, CameraGaussians* posed) {
  const avatar_internal::PoseTables tables = avatar_internal::TablesOf(body, faces, frame, options);
  const int count = body.size();
  posed->Resize(count);
  FloatColumns& out = posed->columns;
  ParallelFor(avatar_internal::NumChunks(count), options.num_threads, [&](int i) {
    const int first = i * avatar_internal::kRowsAChunk;
    avatar_internal::PoseRows(tables, first, std::min(count, first + avatar_internal::kRowsAChunk), out.data(),
                              out.stride());
  });
}

}  // namespace bodyloom
