// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/pipelines/person/clothes_parser.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "bodyloom/geometry/person_label.h"
#include "bodyloom/geometry/base/check.h"
#include "bodyloom/geometry/posed_body.h"
#include "bodyloom/pipelines/person/label_colours.h"
#include "bodyloom/pipelines/person/surface_planes.h"
#include "bodyloom/render/overlay.h"
#include "bodyloom/render/view_camera.h"

namespace bodyloom {
namespace {

constexpr int kReach = 16;  ///< pixels around the mask

constexpr int kFirstClass = static_cast<int>(PersonLabel::kTop);
static_assert(static_cast<int>(PersonLabel::kShoes) - kFirstClass + 1 == kParserClasses);

ParserWeights CheckedParser(ParserWeights weights) {
  std::string why;
  BODYLOOM_CHECK(weights.IsValid(&why), "clothes parser: ", why);
  return weights;
}

/// The mask of the picture as a smaller picture has it: where at least half of a pixel is inside.
std::vector<uint8_t> ResizedMask(std::span<const uint8_t> mask, const Image& picture, int width, int height) {
  Image grey(picture.width, picture.height);
  for (size_t i = 0; i < mask.size(); ++i) std::fill_n(&grey.bgr[3 * i], 3, mask[i] != 0 ? uint8_t{255} : uint8_t{0});
  const Image small = Resized(grey, width, height);
  std::vector<uint8_t> result(static_cast<size_t>(width) * height);
  for (size_t i = 0; i < result.size(); ++i) result[i] = small.bgr[3 * i] > 127 ? 1 : 0;
  return result;
}

/// The answers of the network between the pixels of its picture.
class Answers {
 public:
  Answers(const PersonLayers& layers, std::vector<float> numbers) : layers_(layers), numbers_(std::move(numbers)) {}

  /// The class at a place of the layers' picture, pixels.
  [[nodiscard]] int ClassAt(double x, double y) const {
    const double u = std::clamp(x - layers_.x, 0.0, layers_.width - 1.0);
    const double v = std::clamp(y - layers_.y, 0.0, layers_.height - 1.0);
    const int u0 = static_cast<int>(u), v0 = static_cast<int>(v);
    const int u1 = std::min(u0 + 1, layers_.width - 1), v1 = std::min(v0 + 1, layers_.height - 1);
    const auto across = static_cast<float>(u - u0), down = static_cast<float>(v - v0);
    std::array<float, kParserClasses> answers{};
    for (int c = 0; c < kParserClasses; ++c) {
      const float* plane = numbers_.data() + c * layers_.pixels();
      const auto at = [&](int column, int row) { return plane[static_cast<size_t>(row) * layers_.width + column]; };
      answers[c] =
          std::lerp(std::lerp(at(u0, v0), at(u1, v0), across), std::lerp(at(u0, v1), at(u1, v1), across), down);
    }
    return static_cast<int>(std::max_element(answers.begin(), answers.end()) - answers.begin());
  }

 private:
  const PersonLayers& layers_;
  std::vector<float> numbers_;
};

}  // namespace

PersonLayers ParserLayers(const PersonPhoto& photo, int num_threads) {
  const Image& picture = *photo.picture;
  BODYLOOM_CHECK(photo.mask.size() == static_cast<size_t>(picture.width) * picture.height &&
                     picture.width == photo.camera.width && picture.height == photo.camera.height,
                 "clothes parser: a picture of ", picture.width, "x", picture.height, " with a mask of ",
                 photo.mask.size(), " pixels and a camera of ", photo.camera.width, "x", photo.camera.height);
  PersonLayers layers = BoxAround(picture.width, picture.height, photo.mask, kReach);
  const size_t pixels = layers.pixels();
  layers.planes.assign(PersonPlane::kNormal * pixels, 0);
  if (pixels == 0) return layers;
  ForEachPixel(layers, picture.width, picture.height, [&](int x, int y, size_t i) {
    if (photo.mask[static_cast<size_t>(y) * picture.width + x] == 0) return;
    layers.planes[PersonPlane::kAlpha * pixels + i] = 1;
    for (size_t c = 0; c < 3; ++c) {
      layers.planes[(PersonPlane::kColour + c) * pixels + i] = static_cast<float>(picture.pixel(x, y)[2 - c]) / 255;
    }
  });
  SurfacePlanes(*photo.body, *photo.rest_vertices, num_threads).Draw(*photo.vertices_in_camera, photo.camera, &layers);
  return layers;
}

ClothesParser::ClothesParser(ParserWeights weights)
    : pixels_per_metre_(weights.pixels_per_metre), network_(CheckedParser(std::move(weights)).network, kParserPlanes) {}

std::vector<uint8_t> ClothesParser::Labels(const PersonPhoto& photo, int num_threads) {
  const double factor =
      PictureUnetScale(PixelsPerMetre(photo.camera, photo.vertices_in_camera->col(2).mean()), pixels_per_metre_);
  Image smaller;
  std::vector<uint8_t> smaller_mask;
  PersonPhoto at_known_size = photo;
  if (factor < 1) {
    at_known_size.camera = ScaledCamera(photo.camera, factor);
    smaller = Resized(*photo.picture, at_known_size.camera.width, at_known_size.camera.height);
    smaller_mask = ResizedMask(photo.mask, *photo.picture, smaller.width, smaller.height);
    at_known_size.picture = &smaller, at_known_size.mask = smaller_mask;
  }
  const PersonLayers layers = ParserLayers(at_known_size, num_threads);
  std::vector<uint8_t> labels(photo.mask.size(), 0);
  if (layers.pixels() == 0) return labels;
  const Answers answers(layers, network_.Run(layers.width, layers.height, layers.planes));
  for (int y = 0; y < photo.picture->height; ++y) {
    for (int x = 0; x < photo.picture->width; ++x) {
      const size_t i = static_cast<size_t>(y) * photo.picture->width + x;
      if (photo.mask[i] == 0) continue;
      const int of_class = answers.ClassAt(factor * (x + 0.5) - 0.5, factor * (y + 0.5) - 0.5);
      labels[i] = static_cast<uint8_t>(kFirstClass + of_class);
    }
  }
  RelabelByColour(*photo.picture, labels);
  return labels;
}

std::vector<uint8_t> ClothesParser::Labels(const Image& picture, std::span<const uint8_t> mask, const BodyModel& body,
                                           const Track& track, const Camera& camera, int num_threads) {
  const MatrixX3d rest = ShapeVertices(body, track.motion.betas), vertices = TrackVertices(body, track, 0);
  return Labels({&picture, mask, &body, &rest, &vertices, camera}, num_threads);
}

}  // namespace bodyloom
