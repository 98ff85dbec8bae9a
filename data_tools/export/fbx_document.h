// SPDX-License-Identifier: Apache-2.0
/// An FBX document: objects with numbers, connections among them, and the settings of the scene. Centimetres, FBX's own
/// unit (UnitScaleFactor 1), y up, right-handed, front +z.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "data_tools/export/fbx_node.h"

namespace bodyloom {

constexpr double kFbxPerMetre = 100;

/// FBX's clock counts 1/46186158000 s.
int64_t FbxTime(double seconds);

class FbxDocument {
 public:
  /// Adds an object of a kind ("Model", "Geometry", …) with the nested records of `content`; `class_name` and
  /// `subclass` are, for example, "Model" and "LimbNode". Returns its number.
  int64_t Add(const std::string& kind, const std::string& name, const std::string& class_name,
              const std::string& subclass, const std::vector<FbxNode>& content);
  /// Attaches an object to another, 0: the scene; with a property's name to this property of it.
  void Connect(int64_t child, int64_t parent, const std::string& property = "");

  /// The file, with the frame rate and the length of the scene and the name of its only animation. It bears no date, so
  /// that the same scene gives the same bytes. Throws std::invalid_argument above 4 GiB.
  [[nodiscard]] std::string Bytes(double fps, double duration_s, const std::string& animation) const;

 private:
  int64_t last_number_ = 1'000'000;
  FbxNode objects_ = FbxNode("Objects"), connections_ = FbxNode("Connections");
  std::map<std::string, int> count_;  ///< of objects, by kind
};

}  // namespace bodyloom
