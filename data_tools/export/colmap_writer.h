// SPDX-License-Identifier: Apache-2.0
/// The clip's camera as a COLMAP model in text: a folder with cameras.txt, images.txt and points3D.txt, for
/// reconstruction and splat training.
///
/// One camera: PINHOLE, or FULL_OPENCV where the lens distorts; principal point + 0.5, because COLMAP's picture begins at
/// the corner of its first pixel. One image a frame of the first person's track, "frame_000000.png" by the track's
/// frames that are known, all from the same place where the camera stands still: pose world → camera, quaternion w x y
/// z. Points: the vertices of everybody's first known frame, as a start. World: metres, y up (unlike COLMAP's own
/// reconstructions, whose up is anywhere).
/// Source: colmap doc/format.rst.
#pragma once

#include <string>

#include "bodyloom/data_tools/export/export_scene.h"

namespace bodyloom {

std::string ColmapCamerasText(const Camera& camera);
std::string ColmapImagesText(const ExportScene& scene);
std::string ColmapPointsText(const ExportScene& scene);

/// Throws std::invalid_argument for a camera without image size or of weak perspective, std::runtime_error when a file
/// cannot be written.
void WriteColmap(const std::string& folder, const ExportScene& scene);

}  // namespace bodyloom
