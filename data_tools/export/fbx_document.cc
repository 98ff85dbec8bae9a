// SPDX-License-Identifier: Apache-2.0
#include "data_tools/export/fbx_document.h"

#include <zlib.h>
#include <bit>
#include <cmath>
#include <iterator>
#include <limits>

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

// Marks of a file without a date, which go with each other and with the footer (Assimp's FBXExporter.cpp).
constexpr char kFbxDate[] = "1970-01-01 10:00:00:000";
constexpr char kFbxFileId[] = "\x28\xb3\x2a\xeb\xb6\x24\xcc\xc2\xbf\xc8\xb0\x2a\xa9\x2b\xfc\xf1";
constexpr double kTicksPerSecond = 46186158000;

/// FBX's number of a frame rate (FbxTime::EMode); 14: given beside it.
int TimeModeOf(double fps) {
  struct Mode {
    int number;
    double fps;
  };
  constexpr Mode kModes[] = {{1, 120}, {2, 100}, {3, 60}, {4, 50}, {5, 48}, {6, 30}, {10, 25}, {11, 24}};
  for (const Mode& mode : kModes) {
    if (std::abs(mode.fps - fps) < 1e-6) return mode.number;
  }
  return 14;
}

FbxNode FbxHeader() {
  FbxNode stamp("CreationTimeStamp");
  stamp.Add(FbxNode("Version").Int(1000)).Add(FbxNode("Year").Int(1970)).Add(FbxNode("Month").Int(1));
  stamp.Add(FbxNode("Day").Int(1)).Add(FbxNode("Hour").Int(10)).Add(FbxNode("Minute").Int(0));
  stamp.Add(FbxNode("Second").Int(0)).Add(FbxNode("Millisecond").Int(0));
  FbxNode header("FBXHeaderExtension");
  header.Add(FbxNode("FBXHeaderVersion").Int(1003)).Add(FbxNode("FBXVersion").Int(7400));
  header.Add(FbxNode("EncryptionType").Int(0)).Add(stamp).Add(FbxNode("Creator").Text("Bodyloom"));
  return header;
}

FbxNode FbxSettings(double fps, int64_t end) {
  FbxNode settings("GlobalSettings");
  settings.Add(FbxNode("Version").Int(1000));
  settings.Add(FbxProperties(
      {FbxInt("UpAxis", 1), FbxInt("UpAxisSign", 1), FbxInt("FrontAxis", 2), FbxInt("FrontAxisSign", 1),
       FbxInt("CoordAxis", 0), FbxInt("CoordAxisSign", 1), FbxInt("OriginalUpAxis", 1), FbxInt("OriginalUpAxisSign", 1),
       FbxDouble("UnitScaleFactor", 1), FbxDouble("OriginalUnitScaleFactor", 1),
       FbxProperty("DefaultCamera", "KString", "", "").Text("camera"), FbxInt("TimeMode", TimeModeOf(fps), "enum"),
       FbxProperty("TimeSpanStart", "KTime", "Time", "").Long(0),
       FbxProperty("TimeSpanStop", "KTime", "Time", "").Long(end), FbxDouble("CustomFrameRate", fps)}));
  return settings;
}

FbxNode FbxDocuments(const std::string& animation) {
  FbxNode document("Document");
  document.Long(1'000'000).Text("").Text("Scene");
  document.Add(FbxProperties({FbxProperty("SourceObject", "object", "", ""),
                              FbxProperty("ActiveAnimStackName", "KString", "", "").Text(animation)}));
  document.Add(FbxNode("RootNode").Long(0));
  FbxNode documents("Documents");
  documents.Add(FbxNode("Count").Int(1)).Add(document);
  return documents;
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

int64_t FbxTime(double seconds) { return std::llround(seconds * kTicksPerSecond); }

int64_t FbxDocument::Add(const std::string& kind, const std::string& name, const std::string& class_name,
                         const std::string& subclass, const std::vector<FbxNode>& content) {
  FbxNode object(kind);
  object.Long(++last_number_).Text(name + std::string("\0\1", 2) + class_name).Text(subclass).MarkAsBlock();
  for (const FbxNode& node : content) object.Add(node);
  objects_.Add(std::move(object));
  ++count_[kind];
  return last_number_;
}

void FbxDocument::Connect(int64_t child, int64_t parent, const std::string& property) {
  FbxNode connection("C");
  connection.Text(property.empty() ? "OO" : "OP").Long(child).Long(parent);
  if (!property.empty()) connection.Text(property);
  connections_.Add(std::move(connection));
}

std::string FbxDocument::Bytes(double fps, double duration_s, const std::string& animation) const {
  FbxNode definitions("Definitions");
  int total = 1;
  for (const auto& [kind, count] : count_) total += count;
  definitions.Add(FbxNode("Version").Int(100)).Add(FbxNode("Count").Int(total));
  const auto define = [&](const std::string& kind, int count) {
    FbxNode type("ObjectType");
    type.Text(kind).Add(FbxNode("Count").Int(count));
    definitions.Add(type);
  };
  define("GlobalSettings", 1);
  for (const auto& [kind, count] : count_) define(kind, count);
  FbxNode takes("Takes");
  takes.Add(FbxNode("Current").Text(animation));
  return FbxBytes({FbxHeader(), FbxNode("FileId").Bytes(std::string(kFbxFileId, 16)),
                   FbxNode("CreationTime").Text(kFbxDate), FbxNode("Creator").Text("Bodyloom"),
                   FbxSettings(fps, FbxTime(duration_s)), FbxDocuments(animation), FbxNode("References").MarkAsBlock(),
                   definitions, objects_, connections_, takes});
}

}  // namespace bodyloom
