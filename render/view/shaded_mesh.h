// SPDX-License-Identifier: Apache-2.0
/// Draws a mesh over an image: smooth shading by vertex normals, dark antialiased contour, transparency.
#pragma once

#include <vector>

#include "geometry/body/normals.h"
#include "geometry/math/arrays.h"
#include "geometry/scene/camera.h"
#include "render/image/image.h"
#include "render/image/palette.h"
#include "render/raster/visibility_buffer.h"

namespace bodyloom {

struct MeshStyle {
  Colour colour = kBodyColour;
  std::vector<Colour> face_colours = {};  ///< F colours instead of `colour`, or empty
  double alpha = 1;                       ///< opacity of the surface
  double contour_px = 1.4;                ///< width of the line along silhouettes and occlusions between limbs; 0: none
  double contour_alpha = 0.9;             ///< opacity of that line
  int samples = 3;                        ///< per pixel along x and y
  int num_threads = 1;                    ///< the image is the same for any number
};

/// Draws meshes (vertices in the camera frame, metres) seen by `camera` onto an image of the camera's size. Lit from
/// the upper left of the viewer. Only the mesh's box is processed. Where all samples of a pixel show one smooth surface
/// in one colour, shading is computed once, at its centre.
///
/// Keeps its memory between images: allocating 20 MB per image takes as long as drawing. Not for use by two threads at
/// once.
class MeshDrawer {
 public:
  MeshDrawer() = default;
  /// A copy has its own memory, for another thread.
  MeshDrawer(const MeshDrawer&) : MeshDrawer() {}
  MeshDrawer& operator=(const MeshDrawer&) { return *this; }
  ~MeshDrawer() = default;

  /// Throws std::invalid_argument when sizes differ.
  void Draw(const MatrixX3d& vertices_in_camera, const MatrixX3i& faces, const Camera& camera, const MeshStyle& style,
            Image* image);

 private:
  VisibilityBuffer buffer_;
  VertexNormalsOfMesh normals_;
};

/// As MeshDrawer::Draw, for a single image.
void DrawMesh(const MatrixX3d& vertices_in_camera, const MatrixX3i& faces, const Camera& camera, const MeshStyle& style,
              Image* image);

}  // namespace bodyloom
