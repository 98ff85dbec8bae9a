// SPDX-License-Identifier: Apache-2.0
/// MakeHuman's CC0 base mesh (hm08), game-engine rig and macro targets, as they lie on disk.
///
/// Layout of the folder (that of the mpfb / MakeHuman asset repositories):
///   base.obj                              19,158 vertices in decimetres, x left, y up, z front; quads by group:
///                                         "body", helper geometry, and a small cube "joint-…" at every joint
///   rigs/standard/rig.game_engine.json    53 bones: parent, head and tail as a joint cube or a mean of vertices
///   rigs/standard/weights.game_engine.json  bone → [[vertex, weight], …]
///   targets/macrodetails/**/*.target.gz   lines "vertex dx dy dz" in decimetres
/// Read through limits (file sizes, inflated size, JSON depth), every index checked. Errors are std::runtime_error
/// "path: place: what was found, expected what".
#pragma once

#include <map>
#include <string>
#include <vector>

#include "bodyloom/data_tools/body_making/quads.h"
#include "bodyloom/geometry/arrays.h"

namespace bodyloom {

struct MakeHumanBone {
  std::string name;
  int parent = -1;                                ///< index of an earlier bone, −1 for the root
  std::vector<int> head_vertices, tail_vertices;  ///< whose means are the bone's ends
};

/// A blend shape: offsets of some vertices.
struct MakeHumanTarget {
  std::vector<int> vertices;
  MatrixX3f offsets_dm;
};

struct MakeHumanFiles {
  MatrixX3d vertices_dm;  ///< n×3: the body's vertices first, helpers behind
  int num_body_vertices = 0;
  std::vector<Quad> quads, quads_uv;                    ///< of the body; indices into vertices_dm and uv
  MatrixX2d uv;                                         ///< v up
  std::map<std::string, std::vector<int>> joint_cubes;  ///< "joint-l-knee" → its vertices
  std::vector<MakeHumanBone> bones;                     ///< parents before children
  SparseRows bone_weights;                              ///< body vertices × bones, rows sum to 1
  std::map<std::string, MakeHumanTarget> targets;       ///< by file name without ".target.gz"

  [[nodiscard]] int FindBone(const std::string& name) const;  ///< −1 when absent
};

/// Reads the folder. Empty target files are kept as targets without offsets.
MakeHumanFiles ReadMakeHuman(const std::string& folder);

/// Contents of a .gz file, at most max_bytes of them.
std::string ReadGzip(const std::string& path, size_t max_bytes);

}  // namespace bodyloom
