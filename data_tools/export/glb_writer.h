// SPDX-License-Identifier: Apache-2.0
/// Writes a scene as one glTF 2.0 binary file (.glb) for viewers, game engines and Blender: metres, y up, seconds from
/// the scene's start.
///
///   nodes        "person_0" → its skeleton, the body's joint names, pelvis first; "person_0_body" skinned, beside it;
///                "camera" at its place, with the clip's focal length; "ground", 6 m of the plane y = 0
///   mesh         T-pose of the track's shape, normals, UV (v down, as glTF has it), four joints a vertex
///   shapes       pose correctives as "corrective_0" …, weights in [0, 1] (residual: skinned_mesh.h)
///   animation    one for all people, "motion": rotations (quaternions without jumps of sign), pelvis' position, the
///                shapes' weights, and the node of a moving camera, a key for every frame of the track; LINEAR.
///                People who are lost or absent are scaled to zero for that time (STEP)
///   camera       perspective, vertical angle 2·atan(H / (2 fy)). glTF has no principal point and no distortion:
///                "extras" hold K, distortion and image size. None for weak perspective or an unknown image size
///   extras       of the asset: source and uncertainty of the world frame
/// Source: Khronos, glTF 2.0 specification.
#pragma once

#include <string>
#include <vector>

#include "data_tools/export/export_scene.h"
#include "data_tools/export/skinned_mesh.h"

namespace bodyloom {

struct GlbOptions {
  int correctives = 8;  ///< shapes for pose correctives, 0 to 64; programs are asked to support 8
  bool ground = true;
  std::vector<std::string> textures = {};  ///< PNG file's bytes, by person; missing ones have one colour
};

/// Throws std::invalid_argument for options out of range, a texture that is no PNG, and more than 4 GiB.
std::string GlbText(const ExportScene& scene, const GlbOptions& options, SkinSummary* summary);

/// Writes the same to a file atomically; throws std::runtime_error when it cannot be written.
SkinSummary WriteGlb(const std::string& path, const ExportScene& scene, const GlbOptions& options = {});

}  // namespace bodyloom
