// SPDX-License-Identifier: Apache-2.0
/// The skinned mesh of a person in an FBX document: geometry, clusters of the joints, shapes, material.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "data_tools/export/fbx_document.h"
#include "data_tools/export/rigged_mesh.h"
#include "geometry/body/body_model.h"

namespace bodyloom {

struct FbxSkin {
  int64_t model = 0;                    ///< of the mesh; to be attached to its parent
  std::vector<int64_t> shape_channels;  ///< whose "DeformPercent" is animated
};

/// 16 numbers, by columns, of a translation to centimetres: a transform of the rest pose, whose axes are the world's.
std::vector<double> FbxTranslation(const Eigen::Vector3d& place_m);

/// Adds the mesh, skinned to the models of the joints (J), with the positions of the mesh's rest pose. `png`: an image
/// file's bytes, or empty: `colour`. Throws std::invalid_argument for a texture that is no PNG.
FbxSkin AddFbxSkin(const std::string& person, const BodyModel& body, const RiggedMesh& mesh,
                   std::span<const int64_t> joint_models, const std::string& png, const Eigen::Vector3d& colour,
                   FbxDocument* document);

}  // namespace bodyloom
