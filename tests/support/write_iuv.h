// SPDX-License-Identifier: Apache-2.0
/// IUV images of a track's body, as DensePose writes them.
#pragma once

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <string>

#include "data_tools/body/builtin_body.h"
#include "data_tools/video/image_file.h"
#include "geometry/body/posed_body.h"
#include "geometry/scene/track.h"
#include "render/raster/resolve_pixels.h"
#include "render/raster/visibility_buffer.h"

namespace bodyloom {

/// Writes whole IUV images of the built-in body, one per frame, from 000000.png on. Returns the folder.
inline std::string WriteIuv(const Track& track, const std::string& folder) {
  std::filesystem::create_directories(folder);
  for (int t = 0; t < track.num_frames(); ++t) {
    const BodyPose pose =
        PoseFromAxisAngle(BuiltinBody(), track.motion.poses.row(t).transpose(), track.motion.trans.row(t).transpose());
    const MatrixX3d vertices = PoseVertices(BuiltinBody(), track.motion.betas, pose);
    VisibilityBuffer buffer;
    buffer.Render(vertices, BuiltinBody().data().faces, track.camera);
    ResolveRequest request;
    request.part = request.chart_uv = true;
    ResolvedPixels pixels;
    ResolvePixels(buffer, BuiltinBody(), vertices, track.camera, request, &pixels);
    Image image(track.camera.width, track.camera.height);
    for (int y = pixels.box.y_begin; y < pixels.box.y_end; ++y) {
      for (int x = pixels.box.x_begin; x < pixels.box.x_end; ++x) {
        const size_t i = pixels.box.IndexOf(x, y);
        uint8_t* pixel = image.pixel(x, y);
        pixel[0] = pixels.part[i];
        for (int c = 0; c < 2; ++c) pixel[1 + c] = static_cast<uint8_t>(255 * pixels.chart_uv[2 * i + c]);
      }
    }
    char name[32];
    std::snprintf(name, sizeof name, "/%06d.png", t);
    WriteImage(folder + name, image);
  }
  return folder;
}

}  // namespace bodyloom
