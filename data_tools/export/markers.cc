// SPDX-License-Identifier: Apache-2.0
#include "data_tools/export/markers.h"

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <limits>

#include "data_tools/formats/atomic_file.h"
#include "geometry/base/check.h"

namespace bodyloom {
namespace {

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

}  // namespace bodyloom
