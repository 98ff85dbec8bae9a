// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/pipelines/person/surface_planes.h"

namespace bodyloom {

SurfacePlanes::SurfacePlanes(const BodyModel& body, const MatrixX3d& rest_vertices, int num_threads)
    : body_(&body), threads_(num_threads) {
  places_.reserve(static_cast<size_t>(rest_vertices.size()));
  for (Eigen::Index v = 0; v < rest_vertices.rows(); ++v) {
    for (int c = 0; c < 3; ++c) places_.push_back(static_cast<float>(rest_vertices(v, c)));
  }
}

void SurfacePlanes::Draw(const MatrixX3d& vertices, const Camera& camera, PersonLayers* layers) {
  const size_t pixels = layers->pixels();
  layers->planes.resize(PersonPlane::kNormal * pixels);
  layers->planes.resize(PersonPlane::kCount * pixels, 0);
  VisibilityOptions visibility;
  visibility.cull_back_faces = true;
  visibility.num_threads = threads_;
  buffer_.Render(vertices, body_->data().faces, camera, visibility);
  ResolveRequest request;
  request.num_threads = threads_;
  request.normal = true;
  request.vertex_normals = &normals_.Compute(vertices, body_->data().faces);
  request.vertex_attributes = {{places_, 3}};
  ResolvePixels(buffer_, *body_, vertices, camera, request, &pixels_);
  const auto plane = [&](int p) { return layers->planes.begin() + static_cast<std::ptrdiff_t>(p * pixels); };
  ForEachPixel(*layers, camera.width, camera.height, [&](int x, int y, size_t i) {
    if (plane(PersonPlane::kAlpha)[i] == 0 || buffer_.FaceAt(x, y) < 0) return;
    const size_t at = buffer_.box().IndexOf(x, y);
    for (int c = 0; c < 3; ++c) {
      plane(PersonPlane::kNormal + c)[i] = pixels_.normal[3 * at + c];
      plane(PersonPlane::kPlace + c)[i] = pixels_.vertex_attributes[0][3 * at + c];
    }
  });
}

}  // namespace bodyloom
