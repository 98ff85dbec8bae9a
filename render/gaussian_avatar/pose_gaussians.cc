// SPDX-License-Identifier: Apache-2.0
#include "render/gaussian_avatar/pose_gaussians.h"

#include <algorithm>

#include "geometry/base/check.h"
#include "geometry/base/parallel.h"

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

bool PoseGaussiansOptions::IsValid(std::string* why) const {
  const InRange in_range(why);
  for (const float entry : light_from_frame) {
    if (!in_range("light_from_frame", entry, -1.001, 1.001)) return false;
  }
  return in_range("num_threads", num_threads, 1, 1024);
}

}  // namespace bodyloom

namespace bodyloom::avatar_internal {

PoseTables TablesOf(const GaussianBody& body, const MatrixX3i& faces, const AvatarFrame& frame,
                    const PoseGaussiansOptions& options) {
  std::string why;
  BODYLOOM_CHECK(options.IsValid(&why), "posing Gaussians: ", why);
  BODYLOOM_CHECK(body.IsValid(frame.num_joints(), static_cast<int>(faces.rows()), &why), "posing Gaussians: ", why);
  BODYLOOM_CHECK(frame.bones.size() == 12 * static_cast<size_t>(frame.num_joints()),
                 "posing Gaussians: ", frame.bones.size(), " numbers of bones, expected ", 12 * frame.num_joints());
  PoseTables tables;
  tables.parameters = body.parameters.data(), tables.parameter_stride = body.parameters.stride();
  if (!frame.correctives.empty()) {
    const auto num_vertices = static_cast<int>(frame.correctives.size() / 4);
    BODYLOOM_CHECK(faces.size() == 0 || (faces.minCoeff() >= 0 && faces.maxCoeff() < num_vertices),
                   "posing Gaussians: faces name vertices ", faces.minCoeff(), "..", faces.maxCoeff(), ", expected 0..",
                   num_vertices - 1);
    tables.correctives = frame.correctives.data();
  }
  tables.joints = body.joints.data();
  tables.bones = frame.bones.data();
  tables.faces = faces.data();
  tables.anchors = body.anchors.data();
  tables.light = body.light.data();
  tables.light_from_frame = options.light_from_frame.data();
  return tables;
}

}  // namespace bodyloom::avatar_internal
