// SPDX-License-Identifier: Apache-2.0
#include "geometry/uv_maps/surface_maps.h"

#include <algorithm>
#include <cstring>
#include <utility>

#include "geometry/body/normals_simd.h"

namespace bodyloom::describe_internal {

SurfaceMaps::SurfaceMaps(const BodyModel& body, const UvTexelOptions& texels, NormalWeighting weighting, bool normals)
    : body_(body),
      table_(BuildUvTexelTable(body, texels)),
      baker_(table_, body.data().faces),
      normals_(body.data().faces, body.num_vertices(), weighting),
      template_normals_(normals ? TemplateNormals(body, weighting) : MatrixX3f()) {}

int SurfaceMaps::Normals(std::span<const float> vertices, const PosedSkeleton& skeleton, Scratch* scratch,
                         NormalSummary* summary, std::span<float> planes) const {
  *summary = normals_.Compute(vertices, scratch->vertices, &scratch->normals, {&body_, &template_normals_, &skeleton});
  normals_internal::PadVertices(scratch->vertices.data(), body_.num_vertices(), 1, scratch->padded.data());
  return baker_.BakeUnit(scratch->padded, planes);
}

void SurfaceMaps::Velocities(std::span<const float> velocities, Scratch* scratch, std::span<float> planes) const {
  normals_internal::PadVertices(velocities.data(), body_.num_vertices(), 1, scratch->padded.data());
  baker_.Bake(scratch->padded, body_.num_vertices(), 3, planes);
}

PosedFrames::PosedFrames(const Skinner& skinner, const ShapedBody& shape,
                         const std::vector<std::optional<BodyPose>>& poses, int num_vertices, int room)
    : skinner_(skinner),
      shape_(shape),
      poses_(poses),
      stride_(3 * size_t(num_vertices)),
      roots_(poses.size()),
      place_of_frame_(poses.size(), -1) {
  vertices_.reserve(stride_ * room);
}

int PosedFrames::Need(std::span<const int> needed) {
  std::vector<std::pair<int, int>> kept;  // place, frame
  std::vector<int> missing;
  for (const int t : needed) {
    if (place_of_frame_[t] >= 0) {
      kept.emplace_back(place_of_frame_[t], t);
    } else {
      missing.push_back(t);
    }
  }
  std::sort(kept.begin(), kept.end());
  for (const int t : placed_frames_) place_of_frame_[t] = -1;
  placed_frames_.clear();
  for (const auto& [place, t] : kept) {
    const int to = static_cast<int>(placed_frames_.size());
    if (to != place) {
      std::memmove(vertices_.data() + stride_ * to, vertices_.data() + stride_ * place, stride_ * sizeof(float));
    }
    place_of_frame_[t] = to;
    placed_frames_.push_back(t);
  }
  vertices_.resize(stride_ * (kept.size() + missing.size()));
  std::vector<BodyPose> poses;
  for (const int t : missing) {
    poses.push_back(*poses_[t]);
    place_of_frame_[t] = static_cast<int>(placed_frames_.size());
    placed_frames_.push_back(t);
  }
  MatrixX3d roots;
  skinner_.SkinFromRoot(shape_, poses, std::span(vertices_).subspan(stride_ * kept.size()), &roots);
  for (size_t i = 0; i < missing.size(); ++i) roots_[missing[i]] = roots.row(static_cast<Eigen::Index>(i)).transpose();
  return static_cast<int>(missing.size());
}

}  // namespace bodyloom::describe_internal
