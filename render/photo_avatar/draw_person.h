// SPDX-License-Identifier: Apache-2.0
/// Renders a person made from photos in the person's light (PhotoPerson::light).
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "geometry/math/arrays.h"
#include "geometry/scene/camera.h"
#include "render/lighting/lit_surface.h"
#include "render/photo_avatar/photo_person.h"
#include "render/view/attribute_image.h"

namespace bodyloom {

/// A rendered person without background.
struct DrawnPerson {
  Image image;                    ///< over black: colours multiplied by the coverage
  std::vector<uint8_t> coverage;  ///< one per pixel: share that the person covers, 0 to 255
};

/// Composites the person over an image of the same size: person + image·(255 − coverage)/255.
void LayOver(const DrawnPerson& person, Image* image);

/// Posed body of a person and the camera that sees it.
struct PersonPose {
  MatrixX3d vertices_in_camera;  ///< of person.body
  Camera camera;
};

/// Keeps its memory between images. Not for use by two threads at once.
class PersonPainter {
 public:
  /// `person` must outlive this. Images are the same for any number of threads.
  PersonPainter(const PhotoPerson& person, int num_threads);

  /// Draws the person over an image of the camera's size, nine samples per pixel. `vertices_in_camera`: of person.body.
  /// `coverage`, one per pixel, receives the share of samples that show the person, 0 to 255. Throws
  /// std::invalid_argument when sizes differ.
  void Draw(const MatrixX3d& vertices_in_camera, const Camera& camera, Image* image,
            std::vector<uint8_t>* coverage = nullptr);

 private:
  const PhotoPerson* person_;
  std::vector<float> texels_;
  AttributeImageOptions options_;
  AttributePainter painter_;
  LitSurface surface_;
  DrawnPerson drawn_;
};

// Renders several frames of a person made from photos in parallel.

/// Blue, green, red (not premultiplied) and alpha; zeros off the person.
std::vector<uint8_t> BgraOf(const DrawnPerson& person);

/// Not for use by two threads at once.
class PersonFramePainter {
 public:
  /// `person` must outlive this. `threads` frames are drawn at once. Images are the same for any number.
  PersonFramePainter(const PhotoPerson& person, int threads);

  [[nodiscard]] int at_once() const { return static_cast<int>(painters_.size()); }

  /// Draws at most at_once() poses, more throw std::invalid_argument. A pose without vertices gives an empty image.
  std::vector<DrawnPerson> Draw(std::span<const PersonPose> poses);

 private:
  std::vector<std::unique_ptr<PersonPainter>> painters_;
};

}  // namespace bodyloom
