// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/pipelines/person/person_layer_painter.h"

#include <algorithm>

#include "bodyloom/geometry/base/check.h"
#include "bodyloom/geometry/body_model.h"

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

std::vector<float> RestPlaces(const BodyModel& body) {
  const MatrixX3d& rest = body.data().v_template;
  std::vector<float> places;
  for (Eigen::Index v = 0; v < rest.rows(); ++v) {
    for (int c = 0; c < 3; ++c) places.push_back(static_cast<float>(rest(v, c)));
  }
  return places;
}

int RoundUp(int size) { return (size + kLayersMultiple - 1) / kLayersMultiple * kLayersMultiple; }

/// A box of the layers' sizes around the covered pixels, the same distance on both sides.
PersonLayers BoxAround(const std::vector<uint8_t>& coverage, const Image& picture, int reach) {
  int x0 = picture.width, x1 = -1, y0 = picture.height, y1 = -1;
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < picture.width; ++x) {
      if (coverage[static_cast<size_t>(y) * picture.width + x] == 0) continue;
      x0 = std::min(x0, x), x1 = std::max(x1, x), y0 = std::min(y0, y), y1 = std::max(y1, y);
    }
  }
  PersonLayers layers;
  if (x1 < 0) return layers;
  const int across = x1 - x0 + 1, down = y1 - y0 + 1;
  layers.width = RoundUp(across + 2 * reach);
  layers.height = RoundUp(down + 2 * reach);
  layers.x = x0 - (layers.width - across) / 2, layers.y = y0 - (layers.height - down) / 2;
  return layers;
}

}  // namespace

PersonLayerPainter::PersonLayerPainter(const PhotoPerson& person, int num_threads)
    : person_(&person),
      threads_(num_threads),
      painter_(person, num_threads),
      sources_(SeenAndMirrored(person.sources)),
      places_(RestPlaces(*person.body)) {}

PersonLayers PersonLayerPainter::DrawColours(const MatrixX3d& vertices, const Camera& camera, int reach) {
  Image picture(camera.width, camera.height);
  std::vector<uint8_t> coverage(static_cast<size_t>(camera.width) * camera.height, 0);
  painter_.Draw(vertices, camera, &picture, &coverage);
  PersonLayers layers = BoxAround(coverage, picture, reach);
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
  const BodyModel& body = *person_->body;
  VisibilityOptions visibility;
  visibility.cull_back_faces = person_->garment.empty();
  visibility.num_threads = threads_;
  buffer_.Render(vertices, body.data().faces, camera, visibility);
  ResolveRequest request;
  request.num_threads = threads_;
  request.normal = true;
  request.vertex_normals = &normals_.Compute(vertices, body.data().faces);
  request.vertex_attributes = {{places_, 3}};
  const bool known = !person_->sources.empty();
  request.texel_attributes = {{sources_, known ? person_->sources.width : 1, known ? person_->sources.height : 1, 2}};
  ResolvePixels(buffer_, body, vertices, camera, request, &pixels_);

  const size_t pixels = layers.pixels();
  layers.planes.resize(PersonPlane::kCount * pixels, 0);
  const auto plane = [&](int p) { return layers.planes.begin() + static_cast<std::ptrdiff_t>(p * pixels); };
  ForEachPixel(layers, camera.width, camera.height, [&](int x, int y, size_t i) {
    if (plane(PersonPlane::kAlpha)[i] == 0 || buffer_.FaceAt(x, y) < 0) return;
    const size_t at = buffer_.box().IndexOf(x, y);
    for (int c = 0; c < 3; ++c) {
      plane(PersonPlane::kNormal + c)[i] = pixels_.normal[3 * at + c];
      plane(PersonPlane::kPlace + c)[i] = pixels_.vertex_attributes[0][3 * at + c];
    }
    plane(PersonPlane::kSeen)[i] = pixels_.texel_attributes[0][2 * at];
    plane(PersonPlane::kMirrored)[i] = pixels_.texel_attributes[0][2 * at + 1];
  });
  return layers;
}

}  // namespace bodyloom
