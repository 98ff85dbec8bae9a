// SPDX-License-Identifier: Apache-2.0
#include "data_tools/export/glb_buffer.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <utility>

#include "geometry/base/check.h"

namespace bodyloom {
namespace {

static_assert(std::endian::native == std::endian::little, "glTF is little-endian");

constexpr int kGltfU8 = 5121, kGltfU16 = 5123, kGltfU32 = 5125, kGltfF32 = 5126;

size_t ComponentsOf(const std::string& type) {
  static const std::map<std::string, size_t> count = {
      {"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}, {"MAT4", 16}};
  return count.at(type);
}

template <typename T>
std::span<const char> BytesOf(std::span<const T> values) {
  return {reinterpret_cast<const char*>(values.data()), values.size_bytes()};
}

void AppendU32(uint32_t value, std::string* bytes) { bytes->append(reinterpret_cast<const char*>(&value), 4); }

}  // namespace

int GlbBuffer::AddView(std::span<const char> bytes, Target target) {
  bytes_.append((4 - bytes_.size() % 4) % 4, '\0');
  views_.push_back({bytes_.size(), bytes.size(), target});
  bytes_.append(bytes.data(), bytes.size());
  return static_cast<int>(views_.size()) - 1;
}

int GlbBuffer::AddAccessor(int view, int component_type, size_t count, const std::string& type) {
  accessors_.push_back({view, component_type, count, type, {}, {}});
  return static_cast<int>(accessors_.size()) - 1;
}

int GlbBuffer::AddFloats(std::span<const float> values, const std::string& type, Target target, bool with_range) {
  const size_t n = ComponentsOf(type);
  const int accessor = AddAccessor(AddView(BytesOf(values), target), kGltfF32, values.size() / n, type);
  if (with_range) {
    std::vector<float> low(n, std::numeric_limits<float>::max()), high(n, std::numeric_limits<float>::lowest());
    for (size_t i = 0; i < values.size(); ++i) {
      low[i % n] = std::min(low[i % n], values[i]);
      high[i % n] = std::max(high[i % n], values[i]);
    }
    accessors_.back().low = std::move(low);
    accessors_.back().high = std::move(high);
  }
  return accessor;
}

int GlbBuffer::AddBytes4(std::span<const uint8_t> values) {
  return AddAccessor(AddView(BytesOf(values), kVertices), kGltfU8, values.size() / 4, "VEC4");
}

int GlbBuffer::AddShorts4(std::span<const uint16_t> values) {
  return AddAccessor(AddView(BytesOf(values), kVertices), kGltfU16, values.size() / 4, "VEC4");
}

int GlbBuffer::AddIndices(std::span<const uint32_t> values, int num_vertices) {
  // The largest number of a type is not an index.
  if (num_vertices > std::numeric_limits<uint16_t>::max()) {
    return AddAccessor(AddView(BytesOf(values), kIndices), kGltfU32, values.size(), "SCALAR");
  }
  const std::vector<uint16_t> shorts(values.begin(), values.end());
  return AddAccessor(AddView(BytesOf(std::span<const uint16_t>(shorts)), kIndices), kGltfU16, values.size(), "SCALAR");
}

nlohmann::ordered_json GlbBuffer::Views() const {
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const View& view : views_) {
    json.push_back({{"buffer", 0}, {"byteOffset", view.offset}, {"byteLength", view.length}});
    if (view.target != kNone) json.back()["target"] = int{view.target};
  }
  return json;
}

nlohmann::ordered_json GlbBuffer::Accessors() const {
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const Accessor& accessor : accessors_) {
    json.push_back({{"bufferView", accessor.view},
                    {"componentType", accessor.component_type},
                    {"count", accessor.count},
                    {"type", accessor.type}});
    if (accessor.low.empty()) continue;
    json.back()["min"] = accessor.low;
    json.back()["max"] = accessor.high;
  }
  return json;
}

std::string GlbBytes(const nlohmann::ordered_json& json, const std::string& binary) {
  std::string text = json.dump();
  text.append((4 - text.size() % 4) % 4, ' ');
  const size_t padded = (binary.size() + 3) / 4 * 4, total = 12 + 8 + text.size() + 8 + padded;
  BODYLOOM_CHECK(total <= std::numeric_limits<uint32_t>::max(), "glTF: ", total,
                 " bytes, a .glb file holds at most 4 GiB");
  std::string bytes = "glTF";
  bytes.reserve(total);
  AppendU32(2, &bytes);
  AppendU32(static_cast<uint32_t>(total), &bytes);
  AppendU32(static_cast<uint32_t>(text.size()), &bytes);
  bytes += "JSON" + text;
  AppendU32(static_cast<uint32_t>(padded), &bytes);
  bytes += std::string("BIN\0", 4) + binary;
  bytes.append(padded - binary.size(), '\0');
  return bytes;
}

}  // namespace bodyloom
