// SPDX-License-Identifier: Apache-2.0
/// Renders surface attributes as colours for viewing. (For their values see render/raster/resolve_pixels.h.)
///
///   parts    the chart's colour (render/image/palette.h)
///   iuv      red = u, green = v of the chart, blue increases with the part's number
///   normal   camera frame: red = right, green = up, blue = towards the viewer, each (1 + component) / 2
///   depth    near is warm, far is cold (OpenCV's "turbo"), linear between two depths
///   texture  a UV map of colours over the body's atlas
///   error    a value per vertex, in the colours of render/view/error_colours.h
#pragma once

#include <span>
#include <string>
#include <vector>

#include "geometry/body/body_model.h"
#include "geometry/body/normals.h"
#include "geometry/scene/camera.h"
#include "render/image/image.h"
#include "render/raster/resolve_pixels.h"
#include "render/raster/visibility_buffer.h"

namespace bodyloom {

enum class SurfaceAttribute { kParts, kIuv, kNormal, kDepth, kTexture, kError };

struct AttributeImageOptions {
  SurfaceAttribute attribute = SurfaceAttribute::kParts;
  double near_m = 1, far_m = 5;               ///< depth: range of the colours
  TexelAttribute texture = {};                ///< texture: three channels blue, green, red, 0…255
  std::span<const float> vertex_errors = {};  ///< error: one per vertex; NaN: not known
  double error_maximum = 1;                   ///< error: value of the last colour
  int samples = 2;                            ///< per pixel along x and y, 1..8: colours are averaged, not coordinates
  bool both_sides = false;                    ///< back faces are visible too, for surfaces that are not closed
  int num_threads = 1;                        ///< the image is the same for any number
};

/// UV map of an image's colours, for AttributeImageOptions::texture (which borrows it).
std::vector<float> TexelsOf(const Image& image);

/// Keeps its memory between images. Not for use by two threads at once.
class AttributePainter {
 public:
  /// Draws the attribute over an image of the camera's size. `coverage`, one per pixel, receives the share of samples
  /// that show the body, 0 to 255; background pixels are left unchanged. Throws std::invalid_argument when sizes differ
  /// or the body lacks what is to be drawn.
  void Draw(const BodyModel& body, const MatrixX3d& vertices_in_camera, const Camera& camera,
            const AttributeImageOptions& options, Image* image, std::vector<uint8_t>* coverage = nullptr);

 private:
  VisibilityBuffer buffer_;
  ResolvedPixels pixels_;
  VertexNormalsOfMesh normals_;
};

}  // namespace bodyloom
