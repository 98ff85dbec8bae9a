// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/data_tools/descriptors/surface_maps.h"

#include "bodyloom/geometry/normals_simd.h"

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

}  // namespace bodyloom::describe_internal
