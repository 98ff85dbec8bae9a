// SPDX-License-Identifier: Apache-2.0
/// The binary part of a glTF file: one buffer, a view for every array, accessors by number.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <vector>

namespace bodyloom {

class GlbBuffer {
 public:
  enum Target { kNone = 0, kVertices = 34962, kIndices = 34963 };

  /// `type`: "SCALAR", "VEC2", "VEC3", "VEC4" or "MAT4" (column-major). Vertex positions and animation times need
  /// `with_range`, their minimum and maximum.
  int AddFloats(std::span<const float> values, const std::string& type, Target target = kNone, bool with_range = false);
  int AddBytes4(std::span<const uint8_t> values);  ///< VEC4 of vertices
  int AddShorts4(std::span<const uint16_t> values);
  int AddIndices(std::span<const uint32_t> values, int num_vertices);  ///< 16 bits if they suffice
  /// Adds a view without an accessor, for images.
  int AddView(std::span<const char> bytes, Target target = kNone);

  /// glTF's "bufferViews" and "accessors".
  [[nodiscard]] nlohmann::ordered_json Views() const;
  [[nodiscard]] nlohmann::ordered_json Accessors() const;
  [[nodiscard]] const std::string& bytes() const { return bytes_; }

 private:
  struct View {
    size_t offset = 0, length = 0;
    Target target = kNone;
  };
  struct Accessor {
    int view = 0, component_type = 0;
    size_t count = 0;
    std::string type;
    std::vector<float> low, high;
  };
  int AddAccessor(int view, int component_type, size_t count, const std::string& type);

  std::string bytes_;
  std::vector<View> views_;
  std::vector<Accessor> accessors_;
};

/// The file: header, JSON and binary chunk, each padded to four bytes. Throws std::invalid_argument above 4 GiB.
std::string GlbBytes(const nlohmann::ordered_json& json, const std::string& binary);

}  // namespace bodyloom
