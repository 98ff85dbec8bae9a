// SPDX-License-Identifier: Apache-2.0
#include "data_tools/export/markers.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <limits>

#include "data_tools/formats/atomic_file.h"
#include "geometry/base/check.h"

namespace bodyloom {
namespace {

static_assert(std::endian::native == std::endian::little, "the file says that it is little-endian");

constexpr size_t kC3dBlock = 512;
constexpr double kMillimetres = 1000;

template <typename T>
void AppendValue(T value, std::string* bytes) {
  bytes->append(reinterpret_cast<const char*>(&value), sizeof value);
}

void FillBlock(std::string* bytes) { bytes->append((kC3dBlock - bytes->size() % kC3dBlock) % kC3dBlock, '\0'); }

/// The parameter section: groups and their parameters, one after another.
class Parameters {
 public:
  void Group(const std::string& name) {
    ++group_;
    bytes_ += static_cast<char>(name.size());
    bytes_ += static_cast<char>(-group_);
    bytes_ += name;
    AppendValue<int16_t>(3, &bytes_);  // over itself and the length of a description, to the next record
    bytes_ += '\0';
  }
  void Number(const std::string& name, int16_t value) { Record(name, 2, {}, BytesOf({value})); }
  void Numbers(const std::string& name, const std::vector<int16_t>& values) {
    Record(name, 2, {static_cast<uint8_t>(values.size())}, BytesOf(values));
  }
  void Real(const std::string& name, float value) {
    std::string data;
    AppendValue(value, &data);
    Record(name, 4, {}, data);
  }
  void Nothing(const std::string& name, int8_t type, const std::vector<uint8_t>& dimensions) {
    Record(name, type, dimensions, "");
  }
  void Text(const std::string& name, const std::string& text) {
    Record(name, -1, {static_cast<uint8_t>(text.size())}, text);
  }
  void Texts(const std::string& name, const std::vector<std::string>& texts) {
    size_t longest = 1;
    for (const std::string& text : texts) longest = std::max(longest, text.size());
    std::string data;
    for (const std::string& text : texts) data += text + std::string(longest - text.size(), ' ');
    Record(name, -1, {static_cast<uint8_t>(longest), static_cast<uint8_t>(texts.size())}, data);
  }
  [[nodiscard]] const std::string& bytes() const { return bytes_; }

 private:
  static std::string BytesOf(const std::vector<int16_t>& values) {
    std::string data;
    for (const int16_t value : values) AppendValue(value, &data);
    return data;
  }
  void Record(const std::string& name, int8_t type, const std::vector<uint8_t>& dimensions, const std::string& data) {
    bytes_ += static_cast<char>(name.size());
    bytes_ += static_cast<char>(group_);
    bytes_ += name;
    AppendValue(static_cast<int16_t>(2 + 1 + 1 + dimensions.size() + data.size() + 1), &bytes_);
    bytes_ += static_cast<char>(type);
    bytes_ += static_cast<char>(dimensions.size());
    bytes_.append(dimensions.begin(), dimensions.end());
    bytes_ += data;
    bytes_ += '\0';  // no description
  }

  std::string bytes_;
  int group_ = 0;
};

Parameters ParametersOf(const MarkerTrajectories& markers, int16_t data_start) {
  const auto M = static_cast<int16_t>(markers.names.size());
  Parameters p;
  p.Group("POINT");
  p.Number("USED", M);
  p.Real("SCALE", -1);
  p.Real("RATE", static_cast<float>(markers.fps));
  p.Number("DATA_START", data_start);
  p.Number("FRAMES", static_cast<int16_t>(static_cast<uint16_t>(markers.positions.size())));
  p.Texts("LABELS", markers.names);
  p.Texts("DESCRIPTIONS", markers.names);
  p.Text("UNITS", "mm");
  p.Text("X_SCREEN", "+Z");
  p.Text("Y_SCREEN", "+Y");
  p.Group("ANALOG");
  p.Number("USED", 0);
  p.Nothing("LABELS", -1, {0, 0});
  p.Nothing("DESCRIPTIONS", -1, {0, 0});
  p.Real("GEN_SCALE", 1);
  p.Nothing("SCALE", 4, {0});
  p.Nothing("OFFSET", 2, {0});
  p.Nothing("UNITS", -1, {0, 0});
  p.Real("RATE", 0);
  p.Group("FORCE_PLATFORM");
  p.Number("USED", 0);
  p.Nothing("TYPE", 2, {0});
  p.Numbers("ZERO", {1, 0});
  p.Nothing("CORNERS", 4, {3, 4, 0});
  p.Nothing("ORIGIN", 4, {3, 0});
  p.Nothing("CHANNEL", 2, {6, 0});
  p.Group("TRIAL");
  p.Numbers("ACTUAL_START_FIELD", {1, 0});
  p.Numbers("ACTUAL_END_FIELD", {static_cast<int16_t>(static_cast<uint16_t>(markers.positions.size())), 0});
  return p;
}

using Eigen::RowVector3d;

/// Landmark of the body behind each marker; "" for Hip, Neck and Head.
const std::vector<std::string>& LandmarksOfMarkers() {
  static const std::vector<std::string> names = {
      "",          "right_hip", "right_knee",     "right_ankle",  "right_big_toe",  "right_small_toe", "right_heel",
      "left_hip",  "left_knee", "left_ankle",     "left_big_toe", "left_small_toe", "left_heel",       "",
      "",          "nose",      "right_shoulder", "right_elbow",  "right_wrist",    "left_shoulder",   "left_elbow",
      "left_wrist"};
  return names;
}

constexpr int kHipMarker = 0, kRightHipMarker = 1, kLeftHipMarker = 7, kNeckMarker = 13, kHeadMarker = 14,
              kRightShoulderMarker = 16, kLeftShoulderMarker = 19;

/// The highest vertex of the T-pose: the top of the skull.
int TopVertex(const ExportPerson& person) {
  Eigen::Index top = 0;
  ShapeVertices(*person.body, person.betas).col(1).maxCoeff(&top);
  return static_cast<int>(top);
}

}  // namespace

const std::vector<std::string>& HalpeMarkerNames() {
  static const std::vector<std::string> names = {"Hip",    "RHip",      "RKnee",  "RAnkle", "RBigToe",   "RSmallToe",
                                                 "RHeel",  "LHip",      "LKnee",  "LAnkle", "LBigToe",   "LSmallToe",
                                                 "LHeel",  "Neck",      "Head",   "Nose",   "RShoulder", "RElbow",
                                                 "RWrist", "LShoulder", "LElbow", "LWrist"};
  return names;
}

MarkerTrajectories HalpeMarkers(const ExportScene& scene, const ExportPerson& person) {
  std::vector<std::string> landmarks;
  for (const std::string& name : LandmarksOfMarkers()) {
    if (name.empty()) continue;
    BODYLOOM_CHECK(person.body->FindLandmark(name) >= 0, "markers: the body '", person.body->name(),
                   "' does not say where its ", name, " is");
    landmarks.push_back(name);
  }
  MarkerTrajectories markers;
  markers.names = HalpeMarkerNames();
  markers.fps = scene.fps;
  const auto T = static_cast<int>(std::lround(scene.duration_s * scene.fps)) + 1;
  const auto M = static_cast<Eigen::Index>(markers.names.size());
  markers.positions.assign(size_t(T), MatrixX3d::Constant(M, 3, std::numeric_limits<double>::quiet_NaN()));
  for (int t = 0; t < T; ++t) markers.seconds.push_back(t / scene.fps);
  const std::vector<int> top = {TopVertex(person)};
  for (size_t i = 0; i < person.poses.size(); ++i) {
    const auto t = static_cast<size_t>(std::lround(person.seconds[i] * scene.fps));
    if (t >= markers.positions.size()) continue;
    const MatrixX3d seen = PoseLandmarks(*person.body, person.betas, person.poses[i], landmarks);
    MatrixX3d& at = markers.positions[t];
    Eigen::Index next = 0;
    for (Eigen::Index m = 0; m < M; ++m) {
      if (!LandmarksOfMarkers()[size_t(m)].empty()) at.row(m) = seen.row(next++);
    }
    at.row(kHipMarker) = 0.5 * (at.row(kRightHipMarker) + at.row(kLeftHipMarker));
    at.row(kNeckMarker) = 0.5 * (at.row(kRightShoulderMarker) + at.row(kLeftShoulderMarker));
    at.row(kHeadMarker) = PoseVertices(*person.body, person.betas, person.poses[i], top).row(0);
  }
  return markers;
}

std::string TrcText(const std::string& name, const MarkerTrajectories& markers) {
  const size_t T = markers.positions.size(), M = markers.names.size();
  BODYLOOM_CHECK(T > 0 && M > 0 && markers.seconds.size() == T, "TRC: ", T, " frames of ", M, " markers at ",
                 markers.seconds.size(), " times");
  char text[256];
  std::string out = "PathFileType\t4\t(X/Y/Z)\t" + name + "\n" +
                    "DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate\tOrigDataStartFrame\t"
                    "OrigNumFrames\n";
  std::snprintf(text, sizeof text, "%.6g\t%.6g\t%zu\t%zu\tm\t%.6g\t0\t%zu\n", markers.fps, markers.fps, T, M,
                markers.fps, T);
  out += text;
  out += "Frame#\tTime\t";
  for (const std::string& marker : markers.names) out += marker + "\t\t\t";
  out += "\n\t\t";
  for (size_t m = 1; m <= M; ++m) {
    const std::string number = std::to_string(m);
    out += "X" + number + "\tY" + number + "\tZ" + number + "\t";
  }
  out += "\n";
  for (size_t t = 0; t < T; ++t) {
    BODYLOOM_CHECK(markers.positions[t].rows() == Eigen::Index(M), "TRC: frame ", t, " has ",
                   markers.positions[t].rows(), " markers, expected ", M);
    std::snprintf(text, sizeof text, "%zu\t%.7f", t, markers.seconds[t]);
    out += text;
    for (Eigen::Index m = 0; m < Eigen::Index(M); ++m) {
      const Eigen::RowVector3d p = markers.positions[t].row(m);
      if (p.allFinite()) {
        std::snprintf(text, sizeof text, "\t%.7f\t%.7f\t%.7f", p.x(), p.y(), p.z());
        out += text;
      } else {
        out += "\t\t\t";
      }
    }
    out += "\n";
  }
  return out;
}

void WriteTrc(const std::string& path, const MarkerTrajectories& markers) {
  WriteFileAtomically(path, TrcText(std::filesystem::path(path).filename().string(), markers));
}

std::string C3dBytes(const MarkerTrajectories& markers) {
  const size_t T = markers.positions.size(), M = markers.names.size();
  BODYLOOM_CHECK(T > 0 && M > 0 && T <= 65535 && M <= 255, "C3D: ", T, " frames of ", M,
                 " markers, expected at most 65535 of 255");
  const size_t parameter_bytes = 4 + ParametersOf(markers, 0).bytes().size() + 2;
  const size_t blocks = (parameter_bytes + kC3dBlock - 1) / kC3dBlock;
  const auto data_start = static_cast<int16_t>(2 + blocks);
  std::string bytes = "\x02\x50";
  AppendValue(static_cast<uint16_t>(M), &bytes);
  AppendValue<uint16_t>(0, &bytes);  // analog samples a frame
  AppendValue<uint16_t>(1, &bytes);
  AppendValue(static_cast<uint16_t>(T), &bytes);
  AppendValue<uint16_t>(0, &bytes);  // longest gap that was interpolated
  AppendValue<float>(-1, &bytes);    // below 0: points are floats
  AppendValue(static_cast<uint16_t>(data_start), &bytes);
  AppendValue<uint16_t>(0, &bytes);
  AppendValue(static_cast<float>(markers.fps), &bytes);
  FillBlock(&bytes);
  bytes += std::string("\x01\x50", 2) + static_cast<char>(blocks) + static_cast<char>(84);  // 84: little-endian
  bytes += ParametersOf(markers, data_start).bytes();
  FillBlock(&bytes);
  for (size_t t = 0; t < T; ++t) {
    BODYLOOM_CHECK(markers.positions[t].rows() == Eigen::Index(M), "C3D: frame ", t, " has ",
                   markers.positions[t].rows(), " markers, expected ", M);
    for (Eigen::Index m = 0; m < Eigen::Index(M); ++m) {
      const Eigen::RowVector3d p = kMillimetres * markers.positions[t].row(m);
      const bool known = p.allFinite();
      for (int k = 0; k < 3; ++k) AppendValue(known ? static_cast<float>(p[k]) : 0.0F, &bytes);
      AppendValue(known ? 0.0F : -1.0F, &bytes);
    }
  }
  FillBlock(&bytes);
  return bytes;
}

void WriteC3d(const std::string& path, const MarkerTrajectories& markers) {
  WriteFileAtomically(path, C3dBytes(markers));
}

}  // namespace bodyloom
