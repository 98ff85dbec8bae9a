// SPDX-License-Identifier: Apache-2.0
/// Writes a scene as one binary FBX file (7.4) for Unreal, Unity, MotionBuilder, Maya and Blender: centimetres
/// (UnitScaleFactor 1), y up, right-handed, seconds from the scene's start; the frame rate is the scene's.
///
///   models      "person_0" (null) → its skeleton, the pelvis first, and "person_0_body", the skinned mesh; "camera"
///   skeleton    names and rest pose of an AnimationRig, Mixamo's with "mixamorig:"; joints beyond the rig's names keep
///               the body's. All bones' axes are the world's in the rest pose, which is the bind pose and the pose
///               without animation
///   mesh        the body's vertices in the rest pose (rigged_mesh.h), normals, UV (v up), all joints of a vertex
///   shapes      "corrective_0" …, DeformPercent in [0, 100]
///   animation   one stack for all people, "motion": Euler angles XYZ without jumps, the pelvis' position, the shapes'
///               weights, and the moving camera, with a key for every frame of the track; linear keys. People who are
///               lost or absent are scaled to zero, within a quarter of a frame
///   camera      focal length on a film 36 mm wide; the principal point is the film offset. No distortion. None for
///               weak perspective or an unknown image size
///   texture     embedded PNG, on the material's diffuse colour
/// Source: the format as in fbx_document.h; names and meaning of properties by Autodesk's FBX SDK reference.
#pragma once

#include <string>
#include <vector>

#include "data_tools/export/export_scene.h"
#include "data_tools/export/skinned_mesh.h"
#include "data_tools/motion/animation_rig.h"

namespace bodyloom {

struct FbxOptions {
  AnimationRig rig = AnimationRig::kSmpl;
  int correctives = 8;                     ///< shapes for pose correctives, 0 to 64
  std::vector<std::string> textures = {};  ///< PNG file's bytes, by person; missing ones have one colour
};

/// Names of a body's joints in an FBX file.
std::vector<std::string> FbxJointNames(AnimationRig rig, const BodyModel& body);

/// Throws std::invalid_argument for options out of range, a rig that the body does not have, a texture that is no PNG,
/// and more than 4 GiB.
std::string FbxText(const ExportScene& scene, const FbxOptions& options, SkinSummary* summary);

/// Writes the same to a file atomically; throws std::runtime_error when it cannot be written.
SkinSummary WriteFbx(const std::string& path, const ExportScene& scene, const FbxOptions& options = {});

}  // namespace bodyloom
