// SPDX-License-Identifier: Apache-2.0
#include "data_tools/export/fbx_node.h"

#include <zlib.h>

#include <bit>
#include <limits>
#include <utility>

#include "geometry/base/check.h"

namespace bodyloom {
namespace {

static_assert(std::endian::native == std::endian::little, "FBX is little-endian");

constexpr uint32_t kFbxVersion = 7400;
constexpr size_t kFbxNullRecord = 13;
/// Level 1 of zlib: curves and weights hardly get smaller at higher ones.
constexpr int kFbxDeflateLevel = 1;
constexpr char kFbxFooterId[] = "\xfa\xbc\xab\x09\xd0\xc8\xd4\x66\xb1\x76\xfb\x83\x1c\xf7\x26\x7e";
constexpr char kFbxFooterEnd[] = "\xf8\x5a\x8c\x6a\xde\xf5\xd9\x7e\xec\xe9\x0c\xe3\x75\x8f\x29\x0b";

uint32_t U32(size_t value) {
  BODYLOOM_CHECK(value <= std::numeric_limits<uint32_t>::max(), "FBX: ", value,
                 " bytes, a file of version 7.4 holds at most 4 GiB");
  return static_cast<uint32_t>(value);
}

void AppendFbxU32(size_t value, std::string* bytes) {
  const uint32_t word = U32(value);
  bytes->append(reinterpret_cast<const char*>(&word), sizeof word);
}

}  // namespace

FbxNode& FbxNode::AddProperty(char type, const void* value, size_t size) {
  properties_.push_back(type);
  if (type == 'S' || type == 'R') AppendFbxU32(size, &properties_);
  properties_.append(static_cast<const char*>(value), size);
  ++num_properties_;
  return *this;
}

FbxNode& FbxNode::AddArray(char type, size_t count, const void* values, size_t size) {
  uLongf packed_size = compressBound(size);
  std::string packed(packed_size, '\0');
  const int status = compress2(reinterpret_cast<Bytef*>(packed.data()), &packed_size, static_cast<const Bytef*>(values),
                               size, kFbxDeflateLevel);
  BODYLOOM_CHECK(status == Z_OK, "FBX: zlib's status ", status, " for an array of ", size, " bytes");
  packed.resize(packed_size);
  properties_.push_back(type);
  AppendFbxU32(count, &properties_);
  AppendFbxU32(1, &properties_);
  AppendFbxU32(packed.size(), &properties_);
  properties_ += packed;
  ++num_properties_;
  return *this;
}

FbxNode& FbxNode::Bool(bool value) {
  const char byte = value ? 1 : 0;
  return AddProperty('C', &byte, 1);
}
FbxNode& FbxNode::Int(int32_t value) { return AddProperty('I', &value, sizeof value); }
FbxNode& FbxNode::Long(int64_t value) { return AddProperty('L', &value, sizeof value); }
FbxNode& FbxNode::Double(double value) { return AddProperty('D', &value, sizeof value); }
FbxNode& FbxNode::Text(const std::string& text) { return AddProperty('S', text.data(), text.size()); }
FbxNode& FbxNode::Bytes(const std::string& bytes) { return AddProperty('R', bytes.data(), bytes.size()); }
FbxNode& FbxNode::Ints(std::span<const int32_t> values) {
  return AddArray('i', values.size(), values.data(), values.size_bytes());
}
FbxNode& FbxNode::Longs(std::span<const int64_t> values) {
  return AddArray('l', values.size(), values.data(), values.size_bytes());
}
FbxNode& FbxNode::Floats(std::span<const float> values) {
  return AddArray('f', values.size(), values.data(), values.size_bytes());
}
FbxNode& FbxNode::Doubles(std::span<const double> values) {
  return AddArray('d', values.size(), values.data(), values.size_bytes());
}

FbxNode& FbxNode::Add(FbxNode node) {
  nodes_.push_back(std::move(node));
  return *this;
}

FbxNode& FbxNode::MarkAsBlock() {
  block_ = true;
  return *this;
}

void FbxNode::AppendTo(std::string* file) const {
  const size_t start = file->size();
  AppendFbxU32(0, file);  // the end, known below
  AppendFbxU32(num_properties_, file);
  AppendFbxU32(properties_.size(), file);
  file->push_back(static_cast<char>(name_.size()));
  *file += name_ + properties_;
  for (const FbxNode& node : nodes_) node.AppendTo(file);
  if (block_ || !nodes_.empty()) file->append(kFbxNullRecord, '\0');
  const uint32_t end = U32(file->size());
  file->replace(start, sizeof end, reinterpret_cast<const char*>(&end), sizeof end);
}

FbxNode FbxProperty(const std::string& name, const std::string& type, const std::string& label,
                    const std::string& flags) {
  FbxNode node("P");
  node.Text(name).Text(type).Text(label).Text(flags);
  return node;
}

FbxNode FbxInt(const std::string& name, int32_t value, const std::string& type) {
  return FbxProperty(name, type, type == "int" ? "Integer" : "", "").Int(value);
}

FbxNode FbxDouble(const std::string& name, double value, const std::string& type) {
  return FbxProperty(name, type, type == "double" ? "Number" : "", type == "double" ? "" : "A").Double(value);
}

FbxNode FbxVector(const std::string& name, const std::string& type, std::initializer_list<double> xyz) {
  FbxNode node = FbxProperty(name, type, "", "A");
  for (const double value : xyz) node.Double(value);
  return node;
}

FbxNode FbxProperties(std::initializer_list<FbxNode> values) {
  FbxNode node("Properties70");
  node.MarkAsBlock();
  for (const FbxNode& value : values) node.Add(value);
  return node;
}

std::string FbxBytes(const std::vector<FbxNode>& nodes) {
  std::string bytes("Kaydara FBX Binary  \0\x1a\0", 23);
  AppendFbxU32(kFbxVersion, &bytes);
  for (const FbxNode& node : nodes) node.AppendTo(&bytes);
  bytes.append(kFbxNullRecord, '\0');
  bytes.append(kFbxFooterId, 16);
  bytes.append(4, '\0');
  bytes.append(16 - bytes.size() % 16, '\0');
  AppendFbxU32(kFbxVersion, &bytes);
  bytes.append(120, '\0');
  bytes.append(kFbxFooterEnd, 16);
  return bytes;
}

}  // namespace bodyloom
