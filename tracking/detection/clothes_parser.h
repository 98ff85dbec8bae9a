// SPDX-License-Identifier: Apache-2.0
/// Labels each pixel of a person in a photo (PersonLabel) with the clothes parser (render/image/parser_weights.h),
/// without LibTorch.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geometry/body/body_model.h"
#include "geometry/body/normals.h"
#include "geometry/math/arrays.h"
#include "geometry/scene/camera.h"
#include "geometry/scene/track.h"
#include "render/image/image.h"
#include "render/image/parser_weights.h"
#include "render/image/person_layers.h"
#include "render/raster/resolve_pixels.h"
#include "render/raster/visibility_buffer.h"
#include "tracking/detection/inference/image_unet_runner.h"

namespace bodyloom {

/// A photo of a person whose bare body was fitted. All but the image must outlive its use.
struct PersonPhoto {
  const Image* image = nullptr;
  std::span<const uint8_t> mask;  ///< one a pixel of the image; 0 where the person is not
  const BodyModel* body = nullptr;
  const MatrixX3d* rest_vertices = nullptr;       ///< of the person's shape, V×3, metres
  const MatrixX3d* vertices_in_camera = nullptr;  ///< V×3, metres
  Camera camera;                                  ///< of the image's size
};

/// The parser's input planes for the part of the photo around the mask. Throws std::invalid_argument when sizes do not
/// fit.
PersonLayers ParserLayers(const PersonPhoto& photo, int num_threads);

/// Not for use by two threads at once; the network runs on the thread that calls.
class ClothesParser {
 public:
  /// Throws std::invalid_argument for weights that are not valid.
  explicit ClothesParser(ParserWeights weights);

  /// Returns one label a pixel of the image: 0 off the mask, elsewhere kTop to kShoes, corrected by colour
  /// (RelabelByColour()). A person more than a quarter larger than those of the training data is parsed in a smaller
  /// image, and the scores are enlarged bilinearly. Throws as ParserLayers().
  std::vector<uint8_t> Labels(const PersonPhoto& photo, int num_threads);
  /// The same for a track's first frame, seen by `camera`.
  std::vector<uint8_t> Labels(const Image& image, std::span<const uint8_t> mask, const BodyModel& body,
                              const Track& track, const Camera& camera, int num_threads);

 private:
  double pixels_per_metre_;
  ImageUnetRunner network_;
};

// Correction of labels by colour: clothes of the face's colour become skin, and skin of the clothes' colour becomes
// clothes. A network trained on few people knows a garment's usual edges better than the edges of this garment.
//
// Colours are (L/2, a, b) of CIE L*a*b*: lightness counts half. With m_k the median colour of the pixels with label k
// and d_k = |colour − m_k|,
//   top or bottom becomes skin   where d_face < r d_own
//   skin becomes top or bottom   where d_that < r d_face, the nearer of both
// r = ½. A bare chest labelled as top keeps its label: its colour is as near to the median of that label.

/// Corrects `labels` (PersonLabel, one a pixel) in place. Nothing changes with fewer than 50 pixels of a face; clothes
/// with fewer than 50 pixels are not used. Throws std::invalid_argument when sizes differ.
void RelabelByColour(const Image& image, std::span<uint8_t> labels);

/// Draws the body's surface into person layers (render/image/person_layers.h): normals and rest positions. Keeps its
/// memory between images. Not for use by two threads at once.
class SurfacePlanes {
 public:
  /// `body` must outlive this; `rest_vertices`: V×3, metres.
  SurfacePlanes(const BodyModel& body, const MatrixX3d& rest_vertices, int num_threads);

  /// Writes kNormal and kPlace where alpha is above 0 and the surface is seen from outside, 0 elsewhere; keeps the
  /// other planes. Same bytes for any number of threads.
  void Draw(const MatrixX3d& vertices_in_camera, const Camera& camera, PersonLayers* layers);

 private:
  const BodyModel* body_;
  int threads_;
  std::vector<float> places_;  ///< 3 a vertex
  VisibilityBuffer buffer_;
  ResolvedPixels pixels_;
  VertexNormalsOfMesh normals_;
};

}  // namespace bodyloom
