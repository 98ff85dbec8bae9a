// SPDX-License-Identifier: Apache-2.0
#include "render/photo_avatar/parts_in_image.h"

#include "render/raster/resolve_pixels.h"
#include "render/raster/visibility_buffer.h"

namespace bodyloom {

std::vector<uint8_t> PartsInImage(const BodyModel& body, const MatrixX3d& vertices, const Camera& camera,
                                  int num_threads) {
  VisibilityBuffer buffer;
  VisibilityOptions visibility;
  visibility.num_threads = num_threads;
  buffer.Render(vertices, body.data().faces, camera, visibility);
  ResolveRequest request;
  request.part = true;
  request.num_threads = num_threads;
  ResolvedPixels pixels;
  ResolvePixels(buffer, body, vertices, camera, request, &pixels);
  std::vector<uint8_t> parts(static_cast<size_t>(camera.width) * camera.height, 0);
  for (int y = 0; y < camera.height; ++y) {
    for (int x = 0; x < camera.width; ++x) {
      if (buffer.FaceAt(x, y) < 0) continue;
      parts[static_cast<size_t>(y) * camera.width + x] = pixels.part[buffer.box().IndexOf(x, y)];
    }
  }
  return parts;
}

}  // namespace bodyloom
