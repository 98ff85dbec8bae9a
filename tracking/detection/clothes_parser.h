// SPDX-License-Identifier: Apache-2.0
/// What each pixel of a person in a photo shows (PersonLabel), by the clothes parser (render/image/parser_weights.h),
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
#include "tracking/detection/inference/picture_unet_runner.h"

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

  /// One a pixel of the picture: 0 off the mask, elsewhere kTop to kShoes, skin and clothes told apart by their colours
  /// too (tracking/detection/clothes_parser.h). A person more than a quarter larger than those
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

// Clothes that have the face's colour are skin, and skin that has the clothes' colour is clothes: a network that has
// seen few people knows a garment's usual edges better than where this one ends.
//
// Colours are (L/2, a, b) of CIE L*a*b*: shade counts half. With m_k the median colour of the pixels with label k and
// d_k = |colour − m_k|,
// top or bottom becomes skin   where d_face < r d_own
// skin becomes top or bottom   where d_that < r d_face, the nearer of both
// r = ½. A bare chest that is called a top stays one: its own colour is as near.

/// `labels`: PersonLabel, one a pixel. Nothing changes without 50 pixels of a face; of clothes with fewer than 50
/// pixels nothing is known. Throws std::invalid_argument when sizes differ.
void RelabelByColour(const Image& picture, std::span<uint8_t> labels);

// Draws what a body's surface is like into person layers (render/image/person_layers.h): its normal, and where its
// points lie at rest.

/// Keeps its memory between pictures. Not for use by two threads at once.
class SurfacePlanes {
 public:
  /// `body` must outlive this; `rest_vertices`: V×3, metres.
  SurfacePlanes(const BodyModel& body, const MatrixX3d& rest_vertices, int num_threads);

  /// kNormal and kPlace where alpha is above 0 and the surface is seen from outside, 0 elsewhere; other planes stay.
  /// The same for any number of threads.
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
