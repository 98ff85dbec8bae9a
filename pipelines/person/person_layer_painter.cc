// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/pipelines/person/person_layer_painter.h"

#include <algorithm>

namespace bodyloom {
namespace {

/// Texels that were seen are white in the picture of sources, mirrored ones blue (photo_person.h). Without a picture
/// nobody knows: one texel that is neither.
std::vector<float> SeenAndMirrored(const Image& sources) {
  if (sources.empty()) return {0, 0};
  std::vector<float> result;
  result.reserve(sources.bgr.size() / 3 * 2);
  for (size_t i = 0; i + 2 < sources.bgr.size(); i += 3) {
    const bool blue = sources.bgr[i] > 127, red = sources.bgr[i + 2] > 127, green = sources.bgr[i + 1] > 127;
    result.push_back(blue && green && red ? 1.0F : 0.0F);
    result.push_back(blue && !red ? 1.0F : 0.0F);
  }
  return result;
}

}  // namespace

PersonLayerPainter::PersonLayerPainter(const PhotoPerson& person, int num_threads)
    : person_(&person),
      painter_(person, num_threads),
      sources_(SeenAndMirrored(person.sources)),
      surface_(*person.body, person.body->data().v_template, num_threads) {}

PersonLayers PersonLayerPainter::DrawColours(const MatrixX3d& vertices, const Camera& camera, int reach) {
  Image picture(camera.width, camera.height);
  std::vector<uint8_t> coverage(static_cast<size_t>(camera.width) * camera.height, 0);
  painter_.Draw(vertices, camera, &picture, &coverage);
  PersonLayers layers = BoxAround(picture.width, picture.height, coverage, reach);
  const size_t pixels = layers.pixels();
  layers.planes.assign(4 * pixels, 0);
  ForEachPixel(layers, picture.width, picture.height, [&](int x, int y, size_t i) {
    const uint8_t covered = coverage[static_cast<size_t>(y) * picture.width + x];
    if (covered == 0) return;
    layers.planes[PersonPlane::kAlpha * pixels + i] = covered / 255.0F;
    for (size_t c = 0; c < 3; ++c) {  // the picture is black beneath: colours are multiplied by alpha
      layers.planes[(PersonPlane::kColour + c) * pixels + i] =
          std::min(1.0F, static_cast<float>(picture.pixel(x, y)[2 - c]) / covered);
    }
  });
  FillAround(layers.width, layers.height, layers.Plane(PersonPlane::kAlpha),
             std::span(layers.planes).first(3 * pixels));
  return layers;
}

PersonLayers PersonLayerPainter::Draw(const MatrixX3d& vertices, const Camera& camera) {
  PersonLayers layers = DrawColours(vertices, camera, kReach);
  if (layers.width == 0) return layers;
  const bool known = !person_->sources.empty();
  const TexelAttribute texels = {sources_, known ? person_->sources.width : 1, known ? person_->sources.height : 1, 2};
  surface_.Draw(vertices, camera, person_->garment.empty(), &texels, &layers);
  return layers;
}

}  // namespace bodyloom
