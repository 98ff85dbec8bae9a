// SPDX-License-Identifier: Apache-2.0
#include "data_tools/observations/rig_io.h"

#include <filesystem>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>

#include "data_tools/formats/atomic_file.h"
#include "data_tools/formats/json_reader.h"
#include "data_tools/observations/camera_json.h"
#include "data_tools/observations/load_cameras.h"
#include "geometry/base/check.h"

namespace bodyloom {
namespace {

constexpr int kRigVersion = 1;
constexpr double kNotKnown = std::numeric_limits<double>::quiet_NaN();

/// Keys and fields of the standard deviations.
constexpr std::pair<const char*, double RigCamera::*> kRigSigmas[] = {
    {"rotation_sigma_rad", &RigCamera::rotation_sigma_rad},
    {"translation_sigma_m", &RigCamera::translation_sigma_m},
    {"focal_log_sigma", &RigCamera::focal_log_sigma},
    {"offset_sigma_s", &RigCamera::offset_sigma_s},
    {"rate_sigma", &RigCamera::rate_sigma}};

/// The number of a key; `fallback` where it is missing or null.
double RigNumber(const JsonNode& node, const char* key, double fallback) {
  return node.Has(key) && !node.At(key).is_null() ? node.At(key).Number() : fallback;
}

void ReadClockAndSigmas(const JsonNode& node, RigCamera* camera) {
  camera->offset_s = RigNumber(node, "offset_s", kNotKnown);
  camera->rate = RigNumber(node, "rate", 0);
  camera->middle_s = RigNumber(node, "middle_s", 0);
  if (!(camera->rate > -1)) node.At("rate").Fail("a rate above -1: clocks run forwards");
  for (const auto& [key, field] : kRigSigmas) {
    camera->*field = RigNumber(node, key, kNotKnown);
    if (camera->*field < 0) node.At(key).Fail("a standard deviation, 0 or more");
  }
}

std::vector<RigCamera> RigFromJson(const JsonNode& document) {
  if (!document.Has("rig")) document.Fail("an object with the key 'rig', as track writes it for several views");
  if (document.At("rig").Integer() != kRigVersion) document.At("rig").Fail("1, the version of the form");
  const std::vector<NamedCamera> cameras = CamerasFromJson(document);
  std::vector<RigCamera> rig;
  for (size_t i = 0; i < cameras.size(); ++i) {
    const JsonNode node = document.At("cameras").At(i);
    if (!cameras[i].has_pose) node.Fail("a camera with a pose: 'rotation' and 'translation'");
    if (cameras[i].camera.model != CameraModel::kPinhole) node.Fail("a pinhole camera");
    RigCamera& camera = rig.emplace_back();
    camera.name = cameras[i].name;
    camera.camera = cameras[i].camera;
    camera.camera_from_rig = cameras[i].pose;
    ReadClockAndSigmas(node, &camera);
  }
  return rig;
}

}  // namespace

void WriteRig(const std::string& path, const std::vector<RigCamera>& rig) {
  BODYLOOM_CHECK(!rig.empty(), "a rig without cameras");
  std::vector<NamedCamera> cameras;
  for (const RigCamera& camera : rig) {
    BODYLOOM_CHECK(camera.camera.model == CameraModel::kPinhole && camera.camera.width > 0 && camera.camera.height > 0,
                   "rig: a ", ToString(camera.camera.model), " camera of ", camera.camera.width, "x",
                   camera.camera.height, " pixels, expected a pinhole camera with the size of its images");
    NamedCamera& named = cameras.emplace_back();
    named.name = camera.name;
    named.camera = camera.camera;
    named.pose = camera.camera_from_rig;
  }
  nlohmann::json list = CamerasToJson(cameras);
  for (size_t i = 0; i < rig.size(); ++i) {  // a number that is not finite is written as null
    list[i]["offset_s"] = rig[i].offset_s;
    list[i]["rate"] = rig[i].rate;
    list[i]["middle_s"] = rig[i].middle_s;
    for (const auto& [key, field] : kRigSigmas) list[i][key] = rig[i].*field;
  }
  WriteFileAtomically(path, nlohmann::json{{"rig", kRigVersion}, {"cameras", list}}.dump(2) + "\n");
}

std::vector<RigCamera> RigFromText(const std::string& text, const std::string& where) {
  const nlohmann::json json = ParseJson(text, where);
  return RigFromJson(JsonNode(json, where));
}

std::vector<RigCamera> ReadRig(const std::string& path) {
  const nlohmann::json json = ReadJsonFile(path);
  return RigFromJson(JsonNode(json, path));
}

bool IsRigFile(const std::string& path) {
  std::error_code ignored;
  if (!path.ends_with(".json") || std::filesystem::is_directory(path, ignored)) return false;
  const nlohmann::json json = ReadJsonFile(path);
  return json.is_object() && json.contains("rig");
}

}  // namespace bodyloom
