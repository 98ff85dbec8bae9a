// SPDX-License-Identifier: Apache-2.0
#include "data_tools/observations/load_cameras.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>

#include <Eigen/LU>

#include "data_tools/formats/atomic_file.h"
#include "data_tools/formats/json_reader.h"
#include "data_tools/formats/printable.h"
#include "data_tools/observations/camera_json.h"
#include "data_tools/observations/pose2sim_toml.h"
#include "geometry/base/check.h"
#include "geometry/base/units.h"
#include "geometry/math/rotation.h"

namespace bodyloom {
namespace {

namespace fs = std::filesystem;

constexpr double kRotationTolerance = 1e-3;
/// Skew attributed to rounding, as a share of the focal length.
constexpr double kMaxSkew = 1e-6;
constexpr double kHuman36mUnit_m = 1e-3;
constexpr const char* kAffineFile = "video_to_calib_affine.json";

void SetSize(const JsonNode& node, double width, double height, Camera* camera) {
  if (!(width >= 1 && height >= 1 && width <= 100000 && height <= 100000) || width != std::floor(width) ||
      height != std::floor(height)) {
    throw std::runtime_error(node.place() + ": image size " + std::to_string(width) + " x " + std::to_string(height) +
                             ", expected pixels");
  }
  camera->width = static_cast<int>(width);
  camera->height = static_cast<int>(height);
}

void SetK(const JsonNode& node, Camera* camera) {
  const std::vector<double> K = node.Numbers(9);
  const bool is_bottom_row = K[6] == 0 && K[7] == 0 && K[8] == 1;
  if (!is_bottom_row || K[3] != 0 || std::abs(K[1]) > kMaxSkew * std::abs(K[0])) {
    throw std::runtime_error(node.place() + ": not [fx 0 cx; 0 fy cy; 0 0 1] (skew is not supported)");
  }
  camera->fx = K[0], camera->fy = K[4], camera->cx = K[2], camera->cy = K[5];
}

void SetDistortion(const JsonNode& node, Camera* camera) {
  const std::vector<double> values = node.Numbers();
  if (values.size() > camera->distortion.size()) {
    throw std::runtime_error(node.place() + ": " + std::to_string(values.size()) +
                             " coefficients, expected at most 8 (k1 k2 p1 p2 k3 k4 k5 k6)");
  }
  std::copy(values.begin(), values.end(), camera->distortion.begin());
}

void SetPose(const JsonNode& rotation, const JsonNode& translation, double unit, CameraPose* pose) {
  const std::vector<double> r = rotation.Numbers(), t = translation.Numbers(3);
  if (r.size() == 3) {
    pose->camera_from_world_rotation = RotationFromAxisAngle({r[0], r[1], r[2]});
  } else if (r.size() == 9) {
    const Eigen::Matrix3d R = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(r.data());
    if (!((R * R.transpose() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() < kRotationTolerance) ||
        !(R.determinant() > 0)) {
      throw std::runtime_error(rotation.place() + ": not a rotation (R·Rᵀ ≠ I or a mirror)");
    }
    pose->camera_from_world_rotation = NearestRotation(R);
  } else {
    throw std::runtime_error(rotation.place() + ": " + std::to_string(r.size()) +
                             " numbers, expected 3 (Rodrigues) or 9 (matrix)");
  }
  pose->camera_from_world_translation = Eigen::Vector3d(t[0], t[1], t[2]) * unit;
}

void CheckCamera(const JsonNode& node, const Camera& camera) {
  const bool is_pinhole = camera.model == CameraModel::kPinhole;
  if (is_pinhole && !(camera.fx > 0 && camera.fy > 0)) {
    throw std::runtime_error(node.place() + ": focal length " + std::to_string(camera.fx) + ", " +
                             std::to_string(camera.fy) + " px, expected positive");
  }
  if (!is_pinhole && !(camera.scale > 0)) {
    throw std::runtime_error(node.place() + ": scale " + std::to_string(camera.scale) +
                             " px a metre, expected positive");
  }
  // A principal point far outside the image means that the matrix belongs to another image size.
  if (std::abs(camera.cx - camera.width / 2.0) > 2.0 * camera.width ||
      std::abs(camera.cy - camera.height / 2.0) > 2.0 * camera.height) {
    throw std::runtime_error(node.place() + ": principal point (" + std::to_string(camera.cx) + ", " +
                             std::to_string(camera.cy) + ") px does not belong to an image of " +
                             std::to_string(camera.width) + "x" + std::to_string(camera.height));
  }
}

NamedCamera AistCamera(const JsonNode& node) {
  NamedCamera named;
  named.name = node.At("name").Text();
  const std::vector<double> size = node.At("size").Numbers(2);
  SetSize(node.At("size"), size[0], size[1], &named.camera);
  SetK(node.At("matrix"), &named.camera);
  SetDistortion(node.At("distortions"), &named.camera);
  SetPose(node.At("rotation"), node.At("translation"), kCentimetre, &named.pose);
  named.has_pose = true;
  return named;
}

NamedCamera Pose2SimCamera(const JsonNode& node) {
  NamedCamera named;
  named.name = node.At("name").Text();
  const std::vector<double> size = node.At("size").Numbers(2);
  SetSize(node.At("size"), size[0], size[1], &named.camera);
  SetK(node.At("K"), &named.camera);
  SetDistortion(node.At("dist_k1k2p1p2"), &named.camera);
  SetPose(node.At("rvec"), node.At("tvec_m"), 1, &named.pose);
  named.has_pose = true;
  return named;
}

/// Entry `name` of Human3.6M's file.
NamedCamera Human36mCamera(const JsonNode& node, const std::string& name) {
  NamedCamera named;
  named.name = name;
  const std::vector<double> f = node.At("f").Numbers(2), c = node.At("c").Numbers(2);
  named.camera.fx = f[0], named.camera.fy = f[1], named.camera.cx = c[0], named.camera.cy = c[1];
  SetSize(node, 1000, name == "1" || name == "4" ? 1002 : 1000, &named.camera);
  SetPose(node.At("R"), node.At("t"), kHuman36mUnit_m, &named.pose);
  named.has_pose = true;
  const auto shows = [&](const Eigen::Vector3d& origin) {
    Eigen::Vector2d pixel;
    return named.camera.Project(origin, &pixel) && pixel.minCoeff() >= 0 && pixel.x() < named.camera.width &&
           pixel.y() < named.camera.height;
  };
  Eigen::Vector3d& translation = named.pose.camera_from_world_translation;
  const Eigen::Vector3d of_centre = -named.pose.camera_from_world_rotation * translation;
  if (!(f[0] > 0 && f[1] > 0) || (!shows(translation) && !shows(of_centre))) {
    node.Fail("a camera that shows the origin of Human3.6M's world");
  }
  if (!shows(translation)) translation = of_centre;
  return named;
}

bool IsHuman36m(const JsonNode& document) {
  return document.is_object() && document.Has("1") && document.At("1").Has("R") && document.At("1").Has("f");
}

NamedCamera OwnCamera(const JsonNode& node) {
  NamedCamera named;
  Camera& camera = named.camera;
  const auto number_or = [&](const char* key, double fallback) {
    return node.Has(key) ? node.At(key).Number() : fallback;
  };
  if (node.Has("name")) named.name = node.At("name").Text();
  if (node.Has("model")) {
    const std::string model = node.At("model").Text();
    if (model != "pinhole" && model != "weak") {
      throw std::runtime_error(node.place() + ": model '" + PrintableText(model) + "', expected 'pinhole' or 'weak'");
    }
    camera.model = CameraModelFromString(model);
  }
  const double width = node.At("width").Number(), height = node.At("height").Number();
  SetSize(node, width, height, &camera);
  camera.cx = number_or("cx", (camera.width - 1) / 2.0);
  camera.cy = number_or("cy", (camera.height - 1) / 2.0);
  if (camera.model == CameraModel::kWeakPerspective) {
    camera.scale = node.At("scale").Number();
    camera.tx = number_or("tx", 0);
    camera.ty = number_or("ty", 0);
  } else if (node.Has("K")) {
    SetK(node.At("K"), &camera);
  } else {
    camera.fx = node.At("fx").Number();
    camera.fy = number_or("fy", camera.fx);
  }
  if (node.Has("distortion")) SetDistortion(node.At("distortion"), &camera);
  named.has_pose = node.Has("rotation");
  if (named.has_pose) SetPose(node.At("rotation"), node.At("translation"), 1, &named.pose);
  return named;
}

/// "cam_01", "cam01", "Cam01" are one name.
std::string Plain(const std::string& name) {
  std::string plain;
  for (const char c : name) {
    if (std::isalnum(static_cast<unsigned char>(c)) != 0) plain += static_cast<char>(std::tolower(c));
  }
  return plain;
}

/// {"cam01": {"video_to_calib_affine": 2×3}}: inverted, because the camera is known in the calibration's pixels.
void ReadAffines(const std::string& path, std::vector<NamedCamera>* cameras) {
  const nlohmann::json json = ReadJsonFile(path);
  const JsonNode document(json, path);
  for (const std::string& key : document.Keys()) {
    for (NamedCamera& camera : *cameras) {
      if (Plain(camera.name) != Plain(key)) continue;
      const JsonNode node = document.At(key).At("video_to_calib_affine");
      const std::vector<double> a = node.Numbers(6);
      Eigen::Matrix2d A;
      A << a[0], a[1], a[3], a[4];
      if (!(std::abs(A.determinant()) > 1e-6)) throw std::runtime_error(node.place() + ": the map has no inverse");
      const Eigen::Matrix2d inverse = A.inverse();
      camera.video_px_from_camera_px.leftCols<2>() = inverse;
      camera.video_px_from_camera_px.col(2) = -inverse * Eigen::Vector2d(a[2], a[5]);
    }
  }
}

/// "gBR_sBM_c01_d06_mBR2_ch06.mp4" → "gBR_sBM_cAll_d06_mBR2_ch06", as mapping.txt spells it.
std::string SequenceName(const std::string& name) {
  std::string stem = fs::path(name).stem().string();
  for (size_t i = 0; i + 4 < stem.size(); ++i) {
    const bool is_camera = stem[i] == '_' && stem[i + 1] == 'c' && std::isdigit(stem[i + 2]) != 0 &&
                           std::isdigit(stem[i + 3]) != 0 && stem[i + 4] == '_';
    if (is_camera) return stem.replace(i + 2, 2, "All");
  }
  return stem;
}

std::vector<NamedCamera> AistFolder(const std::string& folder, const std::string& mapping,
                                    const std::string& sequence) {
  if (sequence.empty()) {
    throw std::runtime_error(mapping + ": a folder of camera settings needs the name of the sequence");
  }
  const std::string wanted = SequenceName(sequence);
  std::istringstream lines(ReadFileBytes(mapping, size_t{64} << 20));
  std::string name, setting;
  while (lines >> name >> setting) {
    if (name != wanted) continue;
    if (setting.find('/') != std::string::npos) {
      throw std::runtime_error(mapping + ": setting '" + PrintableText(setting) + "' of " + wanted +
                               ": expected a plain name");
    }
    const std::string path = (fs::path(folder) / (setting + ".json")).string();
    const nlohmann::json json = ReadJsonFile(path);
    return CamerasFromJson(JsonNode(json, path));
  }
  throw std::runtime_error(mapping + ": no sequence '" + wanted + "', expected a line '" + wanted + " <setting>'");
}

}  // namespace

Camera CameraFromJson(const JsonNode& node) {
  const NamedCamera named = OwnCamera(node);
  CheckCamera(node, named.camera);
  return named.camera;
}

CameraPose PoseFromJson(const JsonNode& rotation, const JsonNode& translation) {
  CameraPose pose;
  SetPose(rotation, translation, 1, &pose);
  return pose;
}

std::vector<NamedCamera> CamerasFromJson(const JsonNode& document) {
  std::vector<NamedCamera> cameras;
  if (IsHuman36m(document)) {
    for (const std::string& name : document.Keys()) cameras.push_back(Human36mCamera(document.At(name), name));
    return cameras;
  }
  const bool is_one = document.is_object() && !document.Has("cameras");
  const JsonNode list = document.Has("cameras") ? document.At("cameras") : document;
  if (!is_one && (!list.is_array() || list.size() == 0)) list.Fail("a list of cameras");
  for (size_t i = 0; i < (is_one ? 1 : list.size()); ++i) {
    const JsonNode node = is_one ? document : list.At(i);
    if (!node.is_object()) node.Fail("a camera");
    cameras.push_back(node.Has("matrix") ? AistCamera(node)
                      : node.Has("rvec") ? Pose2SimCamera(node)
                                         : OwnCamera(node));
    CheckCamera(node, cameras.back().camera);
  }
  return cameras;
}

std::vector<NamedCamera> CamerasFromText(const std::string& text, const std::string& where) {
  const nlohmann::json json = ParseJson(text, where);
  return CamerasFromJson(JsonNode(json, where));
}

std::vector<NamedCamera> LoadCameras(const std::string& path, const std::string& sequence) {
  std::error_code ignored;
  std::string file = path;
  if (fs::is_directory(path, ignored)) {
    const std::string mapping = (fs::path(path) / "mapping.txt").string();
    if (fs::exists(mapping, ignored)) return AistFolder(path, mapping, sequence);
    file = (fs::path(path) / "calib_refined.json").string();
    if (!fs::exists(file, ignored)) {
      throw std::runtime_error(path +
                               ": a folder without mapping.txt (AIST++) or calib_refined.json (Pose2Sim); "
                               "expected one of them, or the camera file itself");
    }
  }
  const nlohmann::json json =
      file.ends_with(".toml") ? CamerasOfPose2SimToml(ReadFileBytes(file), file) : ReadJsonFile(file);
  std::vector<NamedCamera> cameras = CamerasFromJson(JsonNode(json, file));
  const std::string affines = (fs::path(file).parent_path() / kAffineFile).string();
  if (json.is_object() && json.contains("cameras") && fs::exists(affines, ignored)) ReadAffines(affines, &cameras);
  return cameras;
}

const NamedCamera& FindCamera(const std::vector<NamedCamera>& cameras, const std::string& view,
                              const std::string& where) {
  if (view.empty() && cameras.size() == 1) return cameras[0];
  std::vector<std::string> present;
  for (const NamedCamera& camera : cameras) {
    if (camera.name == view || (!view.empty() && Plain(camera.name) == Plain(view))) return camera;
    present.push_back(camera.name);
  }
  throw std::runtime_error(where + ": " + (view.empty() ? "no view chosen" : "no camera '" + view + "'") +
                           "; the file has " + PrintableList(present));
}

nlohmann::json CamerasToJson(const std::vector<NamedCamera>& cameras) {
  nlohmann::json list = nlohmann::json::array();
  for (const NamedCamera& named : cameras) {
    const Camera& camera = named.camera;
    nlohmann::json entry = {{"model", ToString(camera.model)},
                            {"width", camera.width},
                            {"height", camera.height},
                            {"cx", camera.cx},
                            {"cy", camera.cy}};
    if (!named.name.empty()) entry["name"] = named.name;
    if (camera.model == CameraModel::kPinhole) {
      entry["fx"] = camera.fx;
      entry["fy"] = camera.fy;
      if (camera.HasDistortion()) entry["distortion"] = camera.distortion;
    } else {
      entry["scale"] = camera.scale;
      entry["tx"] = camera.tx;
      entry["ty"] = camera.ty;
    }
    nlohmann::json rotation = nlohmann::json::array();
    for (int r = 0; r < 3; ++r) {
      const Eigen::RowVector3d row = named.pose.camera_from_world_rotation.row(r);
      rotation.push_back({row[0], row[1], row[2]});
    }
    const Eigen::Vector3d& t = named.pose.camera_from_world_translation;
    entry["rotation"] = rotation;
    entry["translation"] = {t[0], t[1], t[2]};
    list.push_back(entry);
  }
  return list;
}

void WriteCameras(const std::string& path, const std::vector<NamedCamera>& cameras) {
  WriteFileAtomically(path, nlohmann::json{{"cameras", CamerasToJson(cameras)}}.dump(2) + "\n");
}

}  // namespace bodyloom
