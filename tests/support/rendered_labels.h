// SPDX-License-Identifier: Apache-2.0
/// Part labels of a known track, as predicted by a perfect detector.
#pragma once

#include "geometry/base/check.h"
#include "geometry/body/body_model.h"
#include "geometry/body/posed_body.h"
#include "geometry/scene/observations.h"
#include "geometry/scene/track.h"
#include "render/raster/visibility_buffer.h"

namespace bodyloom {

/// Each pixel gets the chart of the face at the centre of its block of block_px × block_px pixels (1: its own centre),
/// as low-resolution detectors give labels in blocks. Frames without a result are empty. Throws std::invalid_argument
/// when the body has no parts, the camera no image size, or block_px < 1.
inline PartLabelSequence RenderPartLabels(const BodyModel& body, const Track& track, int block_px = 1) {
  BODYLOOM_CHECK(body.has_parts(), "RenderPartLabels: the body '", body.name(), "' has no parts");
  BODYLOOM_CHECK(block_px >= 1, "RenderPartLabels: blocks of ", block_px, " px, expected at least 1");
  PartLabelSequence labels;
  labels.timestamps = track.motion.timestamps;
  labels.image_width = track.camera.width;
  labels.image_height = track.camera.height;
  VisibilityBuffer buffer;
  for (int t = 0; t < track.num_frames(); ++t) {
    LabelImage image;
    if (track.HasResult(t)) {
      const BodyPose pose =
          PoseFromAxisAngle(body, track.motion.poses.row(t).transpose(), track.motion.trans.row(t).transpose());
      buffer.Render(PoseVertices(body, track.motion.betas, pose), body.data().faces, track.CameraAt(t));
      // A block may extend beyond the box by up to its width.
      const PixelBox box = buffer.box().GrownBy(block_px).ClippedTo({0, 0, labels.image_width, labels.image_height});
      image = {box.x_begin, box.y_begin, box.width(), box.height(), {}};
      for (int y = box.y_begin; y < box.y_end; ++y) {
        for (int x = box.x_begin; x < box.x_end; ++x) {
          const int face =
              buffer.FaceAt(x / block_px * block_px + block_px / 2, y / block_px * block_px + block_px / 2);
          image.labels.push_back(face < 0 ? PartLabelSequence::kBackground : body.data().face_part[face]);
        }
      }
    }
    labels.frames.emplace_back(image);
  }
  return labels;
}

}  // namespace bodyloom
