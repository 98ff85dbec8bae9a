// SPDX-License-Identifier: Apache-2.0
#include "render/photo_avatar/draw_person.h"

#include <algorithm>
#include <cmath>

#include "geometry/base/check.h"
#include "geometry/base/parallel.h"

namespace bodyloom {
namespace {

constexpr int kSamples = 3;  ///< a pixel along x and y

}  // namespace

void LayOver(const DrawnPerson& person, Image* image) {
  BODYLOOM_CHECK(image->width == person.image.width && image->height == person.image.height,
                 "drawn person: ", person.image.width, "x", person.image.height, " over ", image->width, "x",
                 image->height);
  for (size_t p = 0; p < person.coverage.size(); ++p) {
    const int under = 255 - person.coverage[p];
    if (under == 255) continue;
    for (size_t i = 3 * p; i < 3 * p + 3; ++i) {
      image->bgr[i] = static_cast<uint8_t>(std::min(255, person.image.bgr[i] + (image->bgr[i] * under + 127) / 255));
    }
  }
}

PersonPainter::PersonPainter(const PhotoPerson& person, int num_threads)
    : person_(&person),
      texels_(TexelsOf(person.texture)),
      surface_(*person.body, !person.garment.empty(), num_threads) {
  options_.attribute = SurfaceAttribute::kTexture;
  options_.texture = {texels_, person.texture.width, person.texture.height, 3};
  options_.samples = kSamples;
  options_.both_sides = !person.garment.empty();
  options_.num_threads = num_threads;
}

void PersonPainter::Draw(const MatrixX3d& vertices_in_camera, const Camera& camera, Image* image,
                         std::vector<uint8_t>* coverage) {
  const size_t pixels = static_cast<size_t>(camera.width) * camera.height;
  BODYLOOM_CHECK(coverage == nullptr || coverage->size() == pixels,
                 "drawing a person: the coverage is of another size than the image");
  drawn_.image = Image(camera.width, camera.height);
  drawn_.coverage.assign(pixels, 0);
  painter_.Draw(*person_->body, vertices_in_camera, camera, options_, &drawn_.image, &drawn_.coverage);
  surface_.Look(vertices_in_camera, camera);
  surface_.Light(person_->light.coefficients, person_->light.limits, drawn_.coverage, &drawn_.image);
  LayOver(drawn_, image);
  if (coverage != nullptr) *coverage = drawn_.coverage;
}

std::vector<uint8_t> BgraOf(const DrawnPerson& person) {
  std::vector<uint8_t> bgra(4 * person.coverage.size(), 0);
  for (size_t p = 0; p < person.coverage.size(); ++p) {
    if (person.coverage[p] == 0) continue;
    for (size_t c = 0; c < 3; ++c) {
      bgra[4 * p + c] =
          static_cast<uint8_t>(std::min(255.0, std::round(255.0 * person.image.bgr[3 * p + c] / person.coverage[p])));
    }
    bgra[4 * p + 3] = person.coverage[p];
  }
  return bgra;
}

PersonFramePainter::PersonFramePainter(const PhotoPerson& person, int threads) {
  for (int i = 0; i < std::max(1, threads); ++i) painters_.push_back(std::make_unique<PersonPainter>(person, 1));
}

std::vector<DrawnPerson> PersonFramePainter::Draw(std::span<const PersonPose> poses) {
  BODYLOOM_CHECK(poses.size() <= painters_.size(), "drawing people: ", poses.size(), " frames at once, expected up to ",
                 painters_.size());
  std::vector<DrawnPerson> drawn(poses.size());
  ParallelFor(static_cast<int>(poses.size()), at_once(), [&](int i) {
    const Camera& camera = poses[i].camera;
    drawn[i] = {Image(camera.width, camera.height),
                std::vector<uint8_t>(static_cast<size_t>(camera.width) * camera.height, 0)};
    if (poses[i].vertices_in_camera.rows() == 0) return;
    painters_[i]->Draw(poses[i].vertices_in_camera, camera, &drawn[i].image, &drawn[i].coverage);
  });
  return drawn;
}

}  // namespace bodyloom
