// SPDX-License-Identifier: Apache-2.0
/// A motion in closed form for benchmarks of the steps after tracking, and utilities shared by their sections.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <functional>
#include <string>
#include <vector>

#include "geometry/body/body_model.h"
#include "geometry/body/posed_body.h"
#include "geometry/scene/track.h"

namespace bodyloom {

/// Pose in which every joint swings with its own phase and the body walks and turns; smooth, with frequencies up to
/// `hz`.
BodyPose PoseAt(const BodyModel& body, double time, double hz);

/// A track of T frames of this motion before a camera of 640×640, with noise on every joint's rotation (`noise`,
/// radians) and on the position.
Track TrackOf(const BodyModel& body, int T, double fps, double hz, double noise);

// Output of a benchmark as rows of a Markdown table: median and minimum time, and the error.

struct Milliseconds {
  double median = 0, minimum = 0;
};

inline Milliseconds Time(int repetitions, const std::function<void()>& work) {
  std::vector<double> ms;
  work();
  for (int i = 0; i < repetitions; ++i) {
    const auto start = std::chrono::steady_clock::now();
    work();
    ms.push_back(1e3 * std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }
  std::sort(ms.begin(), ms.end());
  return {ms[ms.size() / 2], ms.front()};
}

inline void Print(const std::string& what, Milliseconds ms, const std::string& error) {
  std::printf("| %-58s | %8.3f | %8.3f | %s |\n", what.c_str(), ms.median, ms.minimum, error.c_str());
  std::fflush(stdout);
}

inline void Title(const std::string& text) {
  std::printf("\n## %s\n\n| what | median ms | least ms | error |\n|---|---|---|---|\n", text.c_str());
}

inline std::string Format(const char* format, double a, double b = 0) {
  char text[160];
  std::snprintf(text, sizeof text, format, a, b);
  return text;
}

/// Angle between two directions, well conditioned for small angles.
inline double AngleBetweenDeg(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b)) * 180 / M_PI;
}

// Sections of bodyloom_bench_descriptors. Each prints its own table; `folder` is for files.

void BenchNormals(const BodyModel& body);
void BenchVelocities(const BodyModel& body);
/// Jitter of a track, and the error of every velocity scheme in camera and body axes against a truth at a finer rate
/// that has frames at the track's times (`truth` empty: none).
void BenchTracked(const BodyModel& body, const std::string& track, const std::string& truth);
void BenchBake(const BodyModel& body);
/// Error of bilinear samples of a baked map of normals, next to seams and away from them.
void BenchSeams(const BodyModel& body);
void BenchStream(const BodyModel& body, const std::string& folder);
void BenchTexture(const BodyModel& body, const std::string& folder);

}  // namespace bodyloom
