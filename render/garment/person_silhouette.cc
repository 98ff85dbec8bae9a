// SPDX-License-Identifier: Apache-2.0
#include "render/garment/person_silhouette.h"

#include <algorithm>
#include <cmath>

#include "render/view/view_camera.h"

namespace bodyloom {

PersonSilhouette::PersonSilhouette(const Camera& camera, const LabelImage& mask, int height_px) {
  int first = camera.height, last = -1;
  for (int y = 0; y < camera.height; ++y) {
    for (int x = 0; x < camera.width && last < y; ++x) {
      if (mask.At(x, y) != 0) first = std::min(first, y), last = y;
    }
  }
  const double scale = last >= first ? std::min(1.0, static_cast<double>(height_px) / (last - first + 1)) : 1;
  camera_ = scale < 1 ? ScaledCamera(camera, scale) : camera;
  person_.resize(size_t(camera_.width) * camera_.height);
  const auto in_mask = [scale](int pixel) { return static_cast<int>(std::lround((pixel + 0.5) / scale - 0.5)); };
  for (int y = 0; y < camera_.height; ++y) {
    for (int x = 0; x < camera_.width; ++x) {
      const bool person = mask.At(in_mask(x), in_mask(y)) != 0;
      person_[size_t(y) * camera_.width + x] = person ? 1 : 0;
      area_ += person ? 1 : 0;
    }
  }
}

VisibilityBuffer SeeGarment(const LooseGarment& garment, std::span<const Eigen::Vector3d> cloth, const Camera& camera) {
  MatrixX3d places(static_cast<Eigen::Index>(cloth.size()), 3);
  for (Eigen::Index v = 0; v < places.rows(); ++v) places.row(v) = cloth[v].transpose();
  VisibilityOptions both_sides;
  both_sides.cull_back_faces = false;
  VisibilityBuffer seen;
  seen.Render(places, garment.cloth.faces, camera, both_sides);
  return seen;
}

int UnlikePixels(const PersonSilhouette& silhouette, const VisibilityBuffer& body, const VisibilityBuffer& cloth) {
  int unlike = 0;
  for (int y = 0; y < silhouette.camera().height; ++y) {
    for (int x = 0; x < silhouette.camera().width; ++x) {
      const bool drawn = body.FaceAt(x, y) >= 0 || cloth.FaceAt(x, y) >= 0;
      unlike += drawn != silhouette.IsPerson(x, y) ? 1 : 0;
    }
  }
  return unlike;
}

std::vector<int> CoveredBeside(const PersonSilhouette& silhouette, const VisibilityBuffer& bare,
                               const VisibilityBuffer& garment_seen, const LooseGarment& garment) {
  std::vector<int> covered(garment.rings - 1, 0);
  const PixelBox& box = garment_seen.box();
  for (int y = box.y_begin; y < box.y_end; ++y) {
    for (int x = box.x_begin; x < box.x_end; ++x) {
      const int face = garment_seen.FaceAt(x, y);
      if (face < 0 || bare.FaceAt(x, y) >= 0) continue;
      covered[face / (2 * garment.columns)] += silhouette.IsPerson(x, y) ? 1 : -1;
    }
  }
  return covered;
}

}  // namespace bodyloom
