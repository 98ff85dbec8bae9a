// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/render/avatar/vertex_anchors.h"

namespace bodyloom {

VertexAnchors::VertexAnchors(const BodyModel& model) : model_(model), face_of_(model.num_vertices(), 0) {
  for (int f = model.num_faces() - 1; f >= 0; --f) {
    for (int c = 0; c < 3; ++c) face_of_[model.data().faces(f, c)] = f;
  }
}

SkinAnchor VertexAnchors::At(int vertex, float corrective_factor) const {
  SkinAnchor anchor;
  anchor.face = face_of_[vertex];
  anchor.barycentric = {0, 0, 0};
  for (int c = 0; c < 3; ++c) {
    if (model_.data().faces(anchor.face, c) == vertex) anchor.barycentric[c] = 1;
  }
  anchor.corrective_factor = corrective_factor;
  return anchor;
}

}  // namespace bodyloom
