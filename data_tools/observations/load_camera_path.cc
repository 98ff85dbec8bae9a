// SPDX-License-Identifier: Apache-2.0
#include "data_tools/observations/load_camera_path.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <numeric>
#include <set>
#include <stdexcept>

#include "data_tools/formats/atomic_file.h"
#include "data_tools/formats/json_reader.h"
#include "data_tools/observations/colmap_reader.h"
#include "data_tools/observations/load_cameras.h"
#include "geometry/base/check.h"

namespace bodyloom {
namespace {

namespace fs = std::filesystem;

constexpr int kPathVersion = 1;
constexpr int kMaxPathFrame = 100'000'000;
constexpr double kUnitTolerance = 1e-2;

// ---- COLMAP ----

/// The last run of digits in an image's name without its extension; −1: there is none, or it is not a frame number.
int NumberInName(const std::string& name) {
  const std::string stem = fs::path(name).stem().string();
  const auto is_digit = [](char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; };
  size_t end = stem.size();
  while (end > 0 && !is_digit(stem[end - 1])) --end;
  size_t begin = end;
  while (begin > 0 && is_digit(stem[begin - 1])) --begin;
  if (begin == end || end - begin > 9) return -1;
  const int number = std::stoi(stem.substr(begin, end - begin));
  return number <= kMaxPathFrame ? number : -1;
}

void TakeColmapCamera(const ColmapModel& model, RecordedCameraPath* path) {
  std::set<uint32_t> used;
  for (const ColmapImage& image : model.images) used.insert(image.camera_id);
  const auto found = model.cameras.find(*used.begin());
  if (used.size() > 1) {
    path->why_no_camera = Concatenate("its images are of ", used.size(), " cameras");
  } else if (found == model.cameras.end()) {
    path->why_no_camera = "no cameras file beside it tells the intrinsics";
  } else if (!found->second.is_pinhole) {
    path->why_no_camera = "a camera of the model " + found->second.model + " is no pinhole's";
  } else {
    path->camera = found->second.camera;
  }
}

RecordedCameraPath FromColmap(const std::string& file) {
  ColmapModel model = ReadColmapModel(file);
  RecordedCameraPath path;
  path.is_metric = false;
  path.is_colmap = true;
  TakeColmapCamera(model, &path);
  std::sort(model.images.begin(), model.images.end(),
            [](const ColmapImage& a, const ColmapImage& b) { return a.name < b.name; });
  std::set<int> numbers;
  for (const ColmapImage& image : model.images) numbers.insert(NumberInName(image.name));
  path.by_sorted_name = numbers.size() != model.images.size() || *numbers.begin() < 0;
  if (!path.by_sorted_name) {
    std::sort(model.images.begin(), model.images.end(),
              [](const ColmapImage& a, const ColmapImage& b) { return NumberInName(a.name) < NumberInName(b.name); });
    path.frames.assign(numbers.begin(), numbers.end());
  } else {
    path.frames.resize(model.images.size());
    std::iota(path.frames.begin(), path.frames.end(), 0);
  }
  for (const ColmapImage& image : model.images) path.poses.push_back(image.pose);
  return path;
}

// ---- JSON ----

Eigen::Matrix3d RotationOfQuaternion(const JsonNode& node) {
  const std::vector<double> q = node.Numbers(4);
  const Eigen::Quaterniond quaternion(q[0], q[1], q[2], q[3]);
  if (!(std::abs(quaternion.norm() - 1) <= kUnitTolerance)) node.Fail("a unit quaternion [w, x, y, z]");
  return quaternion.normalized().toRotationMatrix();
}

RecordedCameraPath PathFromJson(const JsonNode& document) {
  if (!document.is_object() || !document.Has("camera_path")) document.Fail("an object with \"camera_path\": 1");
  const int version = document.At("camera_path").Int();
  if (version != kPathVersion) {
    throw std::runtime_error(
        Concatenate(document.place(), ": camera_path ", version, ", expected version ", kPathVersion));
  }
  RecordedCameraPath path;
  if (document.Has("fps")) {
    path.fps = document.At("fps").Number();
    if (!(path.fps > 0 && path.fps <= 1e5)) document.At("fps").Fail("frames a second");
  }
  if (document.Has("metric")) path.is_metric = document.At("metric").Flag();
  const JsonNode frames = document.At("frames");
  if (!frames.is_array() || frames.size() == 0) frames.Fail("a list of frames");
  const bool has_times = frames.At(size_t{0}).Has("time");
  for (size_t i = 0; i < frames.size(); ++i) {
    const JsonNode frame = frames.At(i);
    if (has_times) {
      const double seconds = frame.At("time").Number();
      if (i > 0 && !(seconds > path.seconds.back())) frame.At("time").Fail("rising times");
      path.seconds.push_back(seconds);
    } else {
      const int number = frame.At("frame").Int();
      if (number < 0 || number > kMaxPathFrame || (i > 0 && number <= path.frames.back())) {
        frame.At("frame").Fail("rising frame numbers from 0");
      }
      path.frames.push_back(number);
    }
    if (frame.Has("quaternion")) {
      const std::vector<double> t = frame.At("translation").Numbers(3);
      path.poses.push_back({RotationOfQuaternion(frame.At("quaternion")), {t[0], t[1], t[2]}});
    } else {
      path.poses.push_back(PoseFromJson(frame.At("rotation"), frame.At("translation")));
    }
  }
  if (document.Has("camera")) {
    path.camera = CameraFromJson(document.At("camera"));
  } else {
    path.why_no_camera = "it has no intrinsics";
  }
  return path;
}

}  // namespace

RecordedCameraPath CameraPathFromText(const std::string& text, const std::string& where) {
  const nlohmann::json json = ParseJson(text, where);
  return PathFromJson(JsonNode(json, where));
}

RecordedCameraPath LoadCameraPath(const std::string& path) {
  std::error_code ignored;
  if (fs::is_directory(path, ignored) && !IsColmapFolder(path)) {
    throw std::runtime_error(path + ": a folder without images.bin and images.txt, expected COLMAP's, or a JSON file");
  }
  const std::string name = fs::path(path).filename().string();
  if (fs::is_directory(path, ignored) || name.ends_with(".bin") || name.ends_with(".txt")) return FromColmap(path);
  return CameraPathFromText(ReadFileBytes(path, size_t{256} << 20), path);
}

void WriteCameraPath(const std::string& path, const CameraPath& camera_path, bool is_metric) {
  nlohmann::ordered_json frames = nlohmann::ordered_json::array();
  for (size_t i = 0; i < camera_path.poses.size(); ++i) {
    const CameraPose& pose = camera_path.poses[i];
    nlohmann::ordered_json rotation = nlohmann::ordered_json::array();
    for (int r = 0; r < 3; ++r) {
      const Eigen::RowVector3d row = pose.camera_from_world_rotation.row(r);
      rotation.push_back({row[0], row[1], row[2]});
    }
    const Eigen::Vector3d& t = pose.camera_from_world_translation;
    frames.push_back(
        {{"time", camera_path.timestamps[i]}, {"rotation", rotation}, {"translation", {t[0], t[1], t[2]}}});
  }
  nlohmann::ordered_json document = {{"camera_path", kPathVersion}};
  if (!is_metric) document["metric"] = false;
  document["frames"] = frames;
  WriteFileAtomically(path, document.dump(1) + "\n");
}

CameraPath CameraPathOnClock(const RecordedCameraPath& recorded, std::span<const double> clip_seconds,
                             const PlaceInTime& place, const std::string& where) {
  CameraPath path;
  if (recorded.frames.empty()) {
    path.poses = recorded.poses;
    path.timestamps = recorded.seconds;
    return path;
  }
  const bool counts_from_one = recorded.is_colmap && !recorded.by_sorted_name && recorded.frames.front() > 0;
  const int first = place.first >= 0 ? place.first : counts_from_one ? 1 : 0;
  const double fps = place.fps > 0 ? place.fps : recorded.fps;
  for (size_t i = 0; i < recorded.frames.size(); ++i) {
    const int frame = recorded.frames[i] - first;
    if (frame < 0 || (fps == 0 && frame >= static_cast<int>(clip_seconds.size()))) continue;
    path.timestamps.push_back(fps > 0 ? frame / fps : clip_seconds[size_t(frame)]);
    path.poses.push_back(recorded.poses[i]);
  }
  if (path.poses.empty()) {
    throw std::runtime_error(Concatenate(where, ": frames ", recorded.frames.front(), " to ", recorded.frames.back(),
                                         ", of which none is in the clip of ", clip_seconds.size(),
                                         " frames, counted from ", first));
  }
  return path;
}

}  // namespace bodyloom
