// SPDX-License-Identifier: Apache-2.0
/// Builds the built-in body from its two source files (assets/body, recipe beside them):
///   cage_left_half.txt  left half of the 494-vertex quad cage, with names and UV charts (cage.h)
///   builtin_body.npz    data not derived from the cage: the ten shape components on the cage, skinning weights,
///                       joint regressor, pose correctives, landmarks and chart coordinates, all of the left half
/// v_template = S2 S1 cage and shapedirs = S2 S1 cage_shape with S1, S2 the operators of two Catmull–Clark levels
/// (subdivision.h); the right half is the mirror image. Arrays of the .npz: assets/body/RECIPE.md.
#pragma once

#include <string>

#include "geometry/body/body_model.h"

namespace bodyloom {

/// Contents of the two files and their names in messages.
struct BuiltinBodySources {
  std::string cage_text, cage_name = "cage_left_half.txt";
  std::string parts_bytes, parts_name = "builtin_body.npz";
};

/// The sources compiled into the library.
BuiltinBodySources EmbeddedBuiltinBodySources();

/// Reads the two files. Throws std::runtime_error naming the path.
BuiltinBodySources ReadBuiltinBodySources(const std::string& cage_path, const std::string& parts_path);

struct MakeBuiltinBodySummary {
  int cage_vertices = 0, cage_quads = 0, vertices = 0, quads = 0;
};

/// Builds the body and fills `summary`. Deterministic: same files, same arrays.
/// Throws std::runtime_error naming file and array (or line) when a source is damaged or the two do not fit together.
BodyModelData MakeBuiltinBody(const BuiltinBodySources& sources, MakeBuiltinBodySummary* summary = nullptr);

/// The same body on SMPL-H's 52 joints (finger_joints.h), named "bodyloom_hands". Throws as MakeBuiltinBody().
BodyModelData MakeBuiltinBodyWithHands(const BuiltinBodySources& sources);

}  // namespace bodyloom
