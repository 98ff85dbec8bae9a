// SPDX-License-Identifier: Apache-2.0
/// Rows of a benchmark as lines of a Markdown table: median and least time beside the error.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <functional>
#include <string>
#include <vector>

namespace bodyloom {

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

}  // namespace bodyloom
