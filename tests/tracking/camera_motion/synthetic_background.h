// SPDX-License-Identifier: Apache-2.0
/// Background points as a tracker would follow them, of a scene of points and a camera whose path is known.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <vector>

#include "geometry/math/rotation.h"
#include "geometry/scene/background_tracks.h"
#include "geometry/scene/camera.h"

namespace bodyloom {

struct SyntheticBackground {
  int width = 1280, height = 720, frames = 90;
  double focal_px = 1000, fps = 30;
  std::function<CameraPose(double)> pose = [](double) { return CameraPose(); };  ///< camera from scene, by seconds
  std::function<double(double)> zoom = [](double) { return 1.0; };
  double nearest_m = 1e6, farthest_m = 1e6;  ///< from the first camera; equal: a sphere
  bool flat = false;  ///< all that is before the first camera on a wall across its view, at nearest_m
  double noise_px = 0.2;
  double noise_lasts_s = 0;  ///< time constant of a point's noise; 0: independent from frame to frame
  double wanderers = 0;      ///< share of the points that move by themselves
  double overlay = 0;        ///< share of the points that stay in place in the picture
  int points = 3000;         ///< over the whole sphere
  int frames_of_anchor = 1000;
  uint64_t seed = 1;
};

inline BackgroundTracks TracksOf(const SyntheticBackground& scene) {
  std::mt19937_64 random(scene.seed);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform;
  struct Point {
    Eigen::Vector3d at;
    Eigen::Vector2d overlay, wander;
    bool is_overlay, wanders;
    Eigen::Vector2d noise;
    double noise_s = -1e9;  ///< time of the noise
  };
  std::vector<Point> points;
  for (int i = 0; i < scene.points; ++i) {
    Point& point = points.emplace_back();
    const double x = normal(random), y = normal(random), z = normal(random);
    const double distance = scene.nearest_m + (scene.farthest_m - scene.nearest_m) * uniform(random);
    point.at = distance * Eigen::Vector3d(x, y, z).normalized();
    if (scene.flat && point.at.z() > 0.2 * distance) point.at *= scene.nearest_m / point.at.z();
    point.is_overlay = uniform(random) < scene.overlay;
    point.wanders = uniform(random) < scene.wanderers;
    const double along = normal(random), across = normal(random);
    point.wander = 60 * Eigen::Vector2d(along, across);
  }
  const auto project = [&](Point& point, double t, Eigen::Vector2d* pixel) {
    const CameraPose pose = scene.pose(t);
    const Eigen::Vector3d p = pose.camera_from_world_rotation * point.at + pose.camera_from_world_translation;
    if (!(p.z() > 0.1)) return false;
    const Eigen::Vector2d centre(0.5 * (scene.width - 1), 0.5 * (scene.height - 1));
    *pixel = centre + scene.focal_px * scene.zoom(t) * p.head<2>() / p.z();
    if (point.wanders) *pixel += point.wander * std::sin(2 * t + point.at.normalized().x());
    const double noise_x = normal(random), noise_y = normal(random);
    const Eigen::Vector2d fresh(noise_x, noise_y);
    if (scene.noise_lasts_s > 0) {
      const double kept = std::exp(-(t - point.noise_s) / scene.noise_lasts_s);
      point.noise =
          point.noise_s < 0 ? fresh : Eigen::Vector2d(kept * point.noise + std::sqrt(1 - kept * kept) * fresh);
      point.noise_s = t;
    } else {
      point.noise = fresh;
    }
    *pixel += scene.noise_px * point.noise;
    return pixel->x() > 0 && pixel->y() > 0 && pixel->x() < scene.width - 1 && pixel->y() < scene.height - 1;
  };
  BackgroundTracks tracks;
  tracks.width = scene.width;
  tracks.height = scene.height;
  std::vector<size_t> chosen;
  for (int t = 0; t < scene.frames; ++t) {
    tracks.timestamps.push_back(t / scene.fps);
    if (!tracks.anchors.empty()) {
      BackgroundTracks::Anchor& anchor = tracks.anchors.back();
      BackgroundTracks::Sight& sight = anchor.sights.emplace_back();
      sight.frame = t;
      for (size_t i = 0; i < chosen.size(); ++i) {
        Eigen::Vector2d pixel;
        const bool seen = project(points[chosen[i]], tracks.timestamps.back(), &pixel);
        if (points[chosen[i]].is_overlay) {
          sight.pixels.push_back(anchor.pixels[i]);
        } else {
          constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
          sight.pixels.push_back(seen ? pixel.cast<float>() : Eigen::Vector2f(kNaN, kNaN));
        }
      }
    }
    if (t % scene.frames_of_anchor != 0) continue;
    BackgroundTracks::Anchor& anchor = tracks.anchors.emplace_back();
    anchor.frame = t;
    // Points that the former anchor sees in this frame live on, where they are seen.
    std::vector<size_t> living;
    if (tracks.anchors.size() > 1) {
      const BackgroundTracks::Anchor& former = tracks.anchors[tracks.anchors.size() - 2];
      for (size_t i = 0; i < chosen.size(); ++i) {
        if (!former.sights.back().pixels[i].allFinite()) continue;
        living.push_back(chosen[i]);
        anchor.pixels.push_back(former.sights.back().pixels[i]);
      }
    }
    chosen = living;
    for (size_t i = 0; i < points.size() && chosen.size() < 150; ++i) {
      Eigen::Vector2d pixel;
      if (std::find(living.begin(), living.end(), i) != living.end()) continue;
      if (!project(points[i], tracks.timestamps.back(), &pixel)) continue;
      chosen.push_back(i);
      anchor.pixels.push_back(pixel.cast<float>());
    }
    for (const size_t i : chosen) anchor.points.push_back(static_cast<int>(i));
  }
  return tracks;
}

/// A tremor of the hand: sines about each axis.
inline CameraPose Tremor(double t, double degrees) {
  const double radians = degrees * M_PI / 180;
  const Eigen::Vector3d w(std::sin(2.1 * t) + 0.5 * std::sin(5.3 * t), std::sin(1.7 * t + 1) + 0.5 * std::sin(4.1 * t),
                          std::sin(2.9 * t + 2));
  const Eigen::Vector3d first(0, std::sin(1.0), std::sin(2.0));
  return {RotationFromAxisAngle(radians * w) * RotationFromAxisAngle(radians * first).transpose(),
          Eigen::Vector3d::Zero()};
}

}  // namespace bodyloom
