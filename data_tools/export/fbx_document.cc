// SPDX-License-Identifier: Apache-2.0
#include "data_tools/export/fbx_document.h"

#include <cmath>
#include <iterator>

namespace bodyloom {
namespace {

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
