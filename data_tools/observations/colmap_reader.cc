// SPDX-License-Identifier: Apache-2.0
#include "data_tools/observations/colmap_reader.h"

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <iterator>
#include <sstream>
#include <stdexcept>

#include "data_tools/formats/atomic_file.h"
#include "data_tools/formats/printable.h"
#include "geometry/base/check.h"

namespace bodyloom {
namespace {

namespace fs = std::filesystem;

constexpr double kColmapCorner = 0.5;
constexpr double kQuaternionTolerance = 1e-2;
constexpr size_t kMaxColmapName = 4096;
constexpr uint64_t kBytesOfPoint = 24;

struct ColmapModelKind {
  const char* name;
  int num_params;
};
/// By COLMAP's numbers.
constexpr std::array<ColmapModelKind, 18> kColmapModels = {{{"SIMPLE_PINHOLE", 3},
                                                            {"PINHOLE", 4},
                                                            {"SIMPLE_RADIAL", 4},
                                                            {"RADIAL", 5},
                                                            {"OPENCV", 8},
                                                            {"OPENCV_FISHEYE", 8},
                                                            {"FULL_OPENCV", 12},
                                                            {"FOV", 5},
                                                            {"SIMPLE_RADIAL_FISHEYE", 4},
                                                            {"RADIAL_FISHEYE", 5},
                                                            {"THIN_PRISM_FISHEYE", 12},
                                                            {"RAD_TAN_THIN_PRISM_FISHEYE", 16},
                                                            {"SIMPLE_DIVISION", 4},
                                                            {"DIVISION", 5},
                                                            {"SIMPLE_FISHEYE", 3},
                                                            {"FISHEYE", 4},
                                                            {"EUCM", 6},
                                                            {"EQUIRECTANGULAR", 0}}};

[[noreturn]] void FailColmap(const std::string& place, const std::string& message) {
  throw std::runtime_error(place + ": " + message);
}

ColmapCamera MakeColmapCamera(const std::string& place, const std::string& model, double width, double height,
                              const std::vector<double>& params) {
  const ColmapModelKind* kind = nullptr;
  for (const ColmapModelKind& known : kColmapModels) {
    if (model == known.name) kind = &known;
  }
  if (kind == nullptr) FailColmap(place, "model '" + PrintableText(model) + "', expected one of COLMAP's");
  if (static_cast<int>(params.size()) != kind->num_params) {
    FailColmap(place, Concatenate(params.size(), " parameters of a ", model, ", expected ", kind->num_params));
  }
  if (!(width >= 1 && height >= 1 && width <= 100000 && height <= 100000)) {
    FailColmap(place, Concatenate("image size ", width, "x", height, ", expected pixels"));
  }
  for (const double p : params) {
    if (!std::isfinite(p)) FailColmap(place, "a parameter that is no finite number");
  }
  ColmapCamera result;
  result.model = model;
  Camera& camera = result.camera;
  camera.width = static_cast<int>(width);
  camera.height = static_cast<int>(height);
  const bool two_focals = model == "PINHOLE" || model == "OPENCV" || model == "FULL_OPENCV";
  const bool one_focal = model == "SIMPLE_PINHOLE" || model == "SIMPLE_RADIAL" || model == "RADIAL";
  if (!one_focal && !two_focals) return result;
  result.is_pinhole = true;
  const size_t at = two_focals ? 2 : 1;
  camera.fx = params[0];
  camera.fy = params[at - 1];
  if (!(camera.fx > 0 && camera.fy > 0)) {
    FailColmap(place, Concatenate("focal length ", camera.fx, ", ", camera.fy, " px, expected positive"));
  }
  camera.cx = params[at] - kColmapCorner;
  camera.cy = params[at + 1] - kColmapCorner;
  for (size_t i = at + 2; i < params.size(); ++i) camera.distortion[i - at - 2] = params[i];
  return result;
}

ColmapImage MakeColmapImage(const std::string& place, const std::array<double, 7>& q_t, uint32_t camera_id,
                            const std::string& name) {
  ColmapImage image;
  image.name = name;
  image.camera_id = camera_id;
  const Eigen::Quaterniond q(q_t[0], q_t[1], q_t[2], q_t[3]);
  if (!(std::abs(q.norm() - 1) <= kQuaternionTolerance)) {
    FailColmap(place, Concatenate("a quaternion of length ", q.norm(), ", expected 1"));
  }
  image.pose.camera_from_world_rotation = q.normalized().toRotationMatrix();
  image.pose.camera_from_world_translation = {q_t[4], q_t[5], q_t[6]};
  if (!image.pose.camera_from_world_translation.allFinite()) FailColmap(place, "a translation that is not finite");
  if (name.empty() || name.size() > kMaxColmapName || !IsOneLine(name)) FailColmap(place, "an image without a name");
  return image;
}

/// Lines of a text that are not comments, with their numbers.
class ColmapLines {
 public:
  ColmapLines(const std::string& text, std::string where) : stream_(text), where_(std::move(where)) {}

  /// The next line; with `may_be_empty` false, the next non-empty one.
  bool Next(bool may_be_empty) {
    while (std::getline(stream_, line_)) {
      ++number_;
      if (!line_.empty() && line_.back() == '\r') line_.pop_back();
      const size_t first = line_.find_first_not_of(" \t");
      if (first != std::string::npos && line_[first] == '#') continue;
      if (first != std::string::npos || may_be_empty) return true;
    }
    return false;
  }
  [[nodiscard]] const std::string& line() const { return line_; }
  [[nodiscard]] std::string place() const { return where_ + ": line " + std::to_string(number_); }

 private:
  std::istringstream stream_;
  std::string where_, line_;
  int number_ = 0;
};

/// Little-endian numbers of a byte string.
class ColmapBytes {
 public:
  ColmapBytes(const std::string& bytes, const std::string& where) : bytes_(bytes), where_(where) {}

  template <typename T>
  T Take() {
    if (bytes_.size() - at_ < sizeof(T)) Ends();
    T value;
    std::memcpy(&value, bytes_.data() + at_, sizeof(T));
    at_ += sizeof(T);
    return value;
  }
  std::string TakeName() {
    const size_t end = bytes_.find('\0', at_);
    if (end == std::string::npos) Ends();
    std::string name = bytes_.substr(at_, end - at_);
    at_ = end + 1;
    return name;
  }
  void Skip(uint64_t count, uint64_t size) {
    if (count > (bytes_.size() - at_) / size) Ends();
    at_ += count * size;
  }
  [[nodiscard]] std::string place() const { return Concatenate(where_, ": byte ", at_); }

 private:
  [[noreturn]] void Ends() const {
    FailColmap(place(), Concatenate("the file ends, it has ", bytes_.size(), " bytes"));
  }

  const std::string& bytes_;
  const std::string& where_;
  size_t at_ = 0;
};

void AddColmapCamera(const std::string& place, uint32_t id, ColmapCamera camera,
                     std::map<uint32_t, ColmapCamera>* cameras) {
  if (!cameras->emplace(id, std::move(camera)).second) FailColmap(place, Concatenate("camera ", id, " comes twice"));
}

}  // namespace

std::map<uint32_t, ColmapCamera> ColmapCamerasFromText(const std::string& text, const std::string& where) {
  std::map<uint32_t, ColmapCamera> cameras;
  ColmapLines lines(text, where);
  while (lines.Next(false)) {
    std::istringstream line(lines.line());
    uint32_t id = 0;
    std::string model;
    double width = 0, height = 0, value = 0;
    if (!(line >> id >> model >> width >> height)) FailColmap(lines.place(), "expected CAMERA_ID MODEL WIDTH HEIGHT");
    std::vector<double> params;
    while (line >> value) params.push_back(value);
    if (!line.eof()) FailColmap(lines.place(), "a parameter that is no number");
    AddColmapCamera(lines.place(), id, MakeColmapCamera(lines.place(), model, width, height, params), &cameras);
  }
  return cameras;
}

std::map<uint32_t, ColmapCamera> ColmapCamerasFromBytes(const std::string& bytes, const std::string& where) {
  std::map<uint32_t, ColmapCamera> cameras;
  ColmapBytes reader(bytes, where);
  const auto count = reader.Take<uint64_t>();
  for (uint64_t i = 0; i < count; ++i) {
    const std::string place = reader.place();
    const auto id = reader.Take<uint32_t>();
    const auto model = reader.Take<int32_t>();
    const auto width = static_cast<double>(reader.Take<uint64_t>());
    const auto height = static_cast<double>(reader.Take<uint64_t>());
    if (model < 0 || model >= static_cast<int>(kColmapModels.size())) {
      FailColmap(place, Concatenate("camera model ", model, ", expected 0 to ", kColmapModels.size() - 1));
    }
    const ColmapModelKind& kind = kColmapModels[size_t(model)];
    std::vector<double> params;
    params.reserve(static_cast<size_t>(kind.num_params));
    for (int p = 0; p < kind.num_params; ++p) params.push_back(reader.Take<double>());
    AddColmapCamera(place, id, MakeColmapCamera(place, kind.name, width, height, params), &cameras);
  }
  return cameras;
}

std::vector<ColmapImage> ColmapImagesFromText(const std::string& text, const std::string& where) {
  std::vector<ColmapImage> images;
  ColmapLines lines(text, where);
  while (lines.Next(false)) {
    std::istringstream line(lines.line());
    uint32_t id = 0, camera_id = 0;
    std::array<double, 7> q_t{};
    line >> id;
    for (double& value : q_t) line >> value;
    std::string name;
    if (!(line >> camera_id) || !std::getline(line >> std::ws, name)) {
      FailColmap(lines.place(), "expected IMAGE_ID QW QX QY QZ TX TY TZ CAMERA_ID NAME");
    }
    images.push_back(MakeColmapImage(lines.place(), q_t, camera_id, name));
    if (!lines.Next(true)) continue;
    // Without this check, a file without those lines would have every second image read as points.
    std::istringstream points(lines.line());
    const auto words = std::distance(std::istream_iterator<std::string>(points), {});
    if (words % 3 != 0) {
      FailColmap(lines.place(),
                 Concatenate(words, " words, expected the image's points X Y POINT3D_ID, or an empty line"));
    }
  }
  return images;
}

std::vector<ColmapImage> ColmapImagesFromBytes(const std::string& bytes, const std::string& where) {
  std::vector<ColmapImage> images;
  ColmapBytes reader(bytes, where);
  const auto count = reader.Take<uint64_t>();
  for (uint64_t i = 0; i < count; ++i) {
    const std::string place = reader.place();
    reader.Take<uint32_t>();
    std::array<double, 7> q_t{};
    for (double& value : q_t) value = reader.Take<double>();
    const auto camera_id = reader.Take<uint32_t>();
    const std::string name = reader.TakeName();
    reader.Skip(reader.Take<uint64_t>(), kBytesOfPoint);
    images.push_back(MakeColmapImage(place, q_t, camera_id, name));
  }
  return images;
}

bool IsColmapFolder(const std::string& path) {
  std::error_code ignored;
  return fs::exists(fs::path(path) / "images.bin", ignored) || fs::exists(fs::path(path) / "images.txt", ignored);
}

ColmapModel ReadColmapModel(const std::string& folder_or_images) {
  std::error_code ignored;
  fs::path images(folder_or_images);
  if (fs::is_directory(images, ignored)) {
    const fs::path binary = images / "images.bin";
    images = fs::exists(binary, ignored) ? binary : images / "images.txt";
  }
  const bool is_binary = images.extension() == ".bin";
  const std::string bytes = ReadFileBytes(images.string());
  ColmapModel model;
  model.images =
      is_binary ? ColmapImagesFromBytes(bytes, images.string()) : ColmapImagesFromText(bytes, images.string());
  if (model.images.empty()) FailColmap(images.string(), "no image, expected the poses of a clip's images");
  const fs::path cameras = images.parent_path() / (is_binary ? "cameras.bin" : "cameras.txt");
  if (!fs::exists(cameras, ignored)) return model;
  const std::string camera_bytes = ReadFileBytes(cameras.string());
  model.cameras = is_binary ? ColmapCamerasFromBytes(camera_bytes, cameras.string())
                            : ColmapCamerasFromText(camera_bytes, cameras.string());
  return model;
}

}  // namespace bodyloom
