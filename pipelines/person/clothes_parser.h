// SPDX-License-Identifier: Apache-2.0
/// What each pixel of a person in a photo shows (PersonLabel), by the clothes parser (render/person/parser_weights.h),
/// without LibTorch.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "bodyloom/geometry/arrays.h"
#include "bodyloom/geometry/body_model.h"
#include "bodyloom/geometry/camera.h"
#include "bodyloom/geometry/track.h"
#include "bodyloom/pipelines/person/picture_unet_runner.h"
#include "bodyloom/render/image.h"
#include "bodyloom/render/person/parser_weights.h"
#include "bodyloom/render/person/person_layers.h"

namespace bodyloom {

/// A photo of a person whose bare body was fitted. All but the image must outlive its use.
struct PersonPhoto {
  const Image* picture = nullptr;
  std::span<const uint8_t> mask;  ///< one a pixel of the picture; 0 where the person is not
  const BodyModel* body = nullptr;
  const MatrixX3d* rest_vertices = nullptr;       ///< of the person's shape, V×3, metres
  const MatrixX3d* vertices_in_camera = nullptr;  ///< V×3, metres
  Camera camera;                                  ///< of the picture's size
};

/// What the parser reads of the part of the photo around the mask. Throws std::invalid_argument
/// when sizes do not fit.
PersonLayers ParserLayers(const PersonPhoto& photo, int num_threads);

/// Not for use by two threads at once; the network runs on the thread that calls.
class ClothesParser {
 public:
  /// Throws std::invalid_argument for weights that are not valid.
  explicit ClothesParser(ParserWeights weights);

  /// One a pixel of the picture: 0 off the mask, elsewhere kTop to kShoes, skin and clothes told apart by their colours too
  /// (pipelines/person/label_colours.h). A person more than a quarter larger than those
  /// that the parser learned from is parsed in a smaller picture, whose answers are enlarged bilinearly. Throws as
  /// ParserLayers().
  std::vector<uint8_t> Labels(const PersonPhoto& photo, int num_threads);
  /// The same of a track's first frame, seen by `camera`.
  std::vector<uint8_t> Labels(const Image& picture, std::span<const uint8_t> mask, const BodyModel& body,
                              const Track& track, const Camera& camera, int num_threads);

 private:
  double pixels_per_metre_;
  PictureUnetRunner network_;
};

}  // namespace bodyloom
