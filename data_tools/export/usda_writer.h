// SPDX-License-Identifier: Apache-2.0
/// A scene as USD text (.usda): a SkelRoot a person with Skeleton, SkelAnimation and skinned Mesh, and the clip's camera.
/// Metres, y up, time codes are frames at the scene's rate from 0. Meshes are T-poses of the tracks' shapes with UV, four
/// joints a vertex, and blend shapes for pose correctives with weights in the animation (skinned_mesh.h). A person who is
/// lost keeps the last pose and is invisible meanwhile. The camera holds the principal point as aperture offsets; it has
/// no distortion. None for weak perspective and where the image size is not known.
/// Source: OpenUSD usdSkel/schema.usda and its pages on skinning.
#pragma once

#include <string>

#include "bodyloom/data_tools/export/export_scene.h"

namespace bodyloom {

/// `correctives`: shapes for pose correctives, 0 to 64.
std::string UsdaText(const ExportScene& scene, int correctives = 8);
void WriteUsda(const std::string& path, const ExportScene& scene, int correctives = 8);

}  // namespace bodyloom
