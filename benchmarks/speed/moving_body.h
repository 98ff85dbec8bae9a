// SPDX-License-Identifier: Apache-2.0
/// A motion that is known in closed form, for benchmarks of what comes after tracking.
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

/// Every joint swings at its own phase, the body walks and turns: smooth, at most `hz`.
BodyPose PoseAt(const BodyModel& body, double time, double hz);

/// T frames of it before a camera of 640×640, with noise on every joint's rotation (`noise`, radians) and on the place.
Track TrackOf(const BodyModel& body, int T, double fps, double hz, double noise);

// Rows of a benchmark as lines of a Markdown table: median and least time beside the error.

struct Milliseconds {
  double median = 0, least = 0;
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
  std::printf("| %-58s | %8.3f | %8.3f | %s |\n", what.c_str(), ms.median, ms.least, error.c_str());
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

/// Between two directions, well conditioned for small angles.
inline double AngleBetweenDeg(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b)) * 180 / M_PI;
}

// The sections of bodyloom_bench_descriptors. Each prints its own table; `folder` takes files.

void BenchNormals(const BodyModel& body);
void BenchVelocities(const BodyModel& body);
/// Jitter of a track and, with a truth at a finer rate that has frames at the track's times (`truth` empty: none), the
/// error of every velocity scheme against it, in camera and body axes.
void BenchTracked(const BodyModel& body, const std::string& track, const std::string& truth);
void BenchBake(const BodyModel& body);
/// Error of bilinear lookups in a baked map of normals, next to seams and away from them.
void BenchSeams(const BodyModel& body);
void BenchStream(const BodyModel& body, const std::string& folder);
void BenchTexture(const BodyModel& body, const std::string& folder);

}  // namespace bodyloom
