// SPDX-License-Identifier: Apache-2.0
/// Pictures of a person made from photos, in the person's light (PhotoPerson::light).
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "geometry/math/arrays.h"
#include "geometry/scene/camera.h"
#include "render/lighting/lit_surface.h"
#include "render/photo_avatar/photo_person.h"
#include "render/view/attribute_picture.h"

namespace bodyloom {

/// A person alone in a picture.
struct DrawnPerson {
  Image picture;                  ///< over black: colours multiplied by the coverage
  std::vector<uint8_t> coverage;  ///< one a pixel: share that shows the person, 0 to 255
};

/// The person over an image of the same size: picture + image·(255 − coverage)/255.
void LayOver(const DrawnPerson& person, Image* image);

/// A body that a person is drawn in.
struct PersonPose {
  MatrixX3d vertices_in_camera;  ///< of person.body
  Camera camera;
};

/// Keeps its memory between pictures. Not for use by two threads at once.
class PersonPainter {
 public:
  /// `person` must outlive this. Pictures are the same for any number of threads.
  PersonPainter(const PhotoPerson& person, int num_threads);

  /// Draws the person over an image of the camera's size, nine samples a pixel. `vertices_in_camera`: of person.body.
  /// `coverage`, one a pixel, becomes the share of samples that show the person, 0 to 255. Throws std::invalid_argument
  /// when sizes differ.
  void Draw(const MatrixX3d& vertices_in_camera, const Camera& camera, Image* image,
            std::vector<uint8_t>* coverage = nullptr);

 private:
  const PhotoPerson* person_;
  std::vector<float> texels_;
  AttributePictureOptions options_;
  AttributePainter painter_;
  LitSurface surface_;
  DrawnPerson drawn_;
};

// Frames of a person made from photos, several drawn at once.

/// Blue, green, red, not multiplied, and alpha; zeros where nobody is.
std::vector<uint8_t> BgraOf(const DrawnPerson& person);

/// Not for use by two threads at once.
class PersonFramePainter {
 public:
  /// `person` must outlive this. `threads` frames are drawn at once. Pictures are the same for any number.
  PersonFramePainter(const PhotoPerson& person, int threads);

  [[nodiscard]] int at_once() const { return static_cast<int>(painters_.size()); }

  /// At most at_once() poses; nobody is in the picture of one without vertices. Throws std::invalid_argument for more.
  std::vector<DrawnPerson> Draw(std::span<const PersonPose> poses);

 private:
  std::vector<std::unique_ptr<PersonPainter>> painters_;
};

}  // namespace bodyloom
