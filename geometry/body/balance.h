// SPDX-License-Identifier: Apache-2.0
/// Balance of a body in a clip: its zero-moment point against what supports it.
///
/// The centre of mass c and its acceleration a are those of the parabola fitted by least squares to the places of c
/// within 0.15 s before and after a frame, and at least at its two neighbours (up to 0.25 s away: clips of 4 frames a
/// second and more). A frame is measured if neither a gap nor the clip's end cuts that window short, the body touches
/// the ground, and it is slow: |a| < 1.5 m/s². Faster ones are left out, because the zero-moment point leaves out
/// angular momentum (on recorded dances it is right to a few centimetres in slow frames and off by decimetres in fast
/// ones).
///   d = max(0, distance of p from the convex hull of the contacts − 4 cm)
/// with p of geometry/body/centre_of_mass.h; 0 inside. The 4 cm are what a sole is wider than its lowest vertices.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace bodyloom {

/// One frame in a world whose y is up, ground y = 0, metres.
struct SupportedFrame {
  double seconds = 0;
  Eigen::Vector3d centre_of_mass = Eigen::Vector3d::Zero();
  std::vector<Eigen::Vector2d> contacts;  ///< (x, z) of what touches the ground; empty: nothing does
  bool continues = false;                 ///< comes right after the frame before it
};

struct Balance {
  int frames = 0;            ///< measured
  double outside_share = 0;  ///< of them, those with d > 5 cm; NaN: none was measured
  double outside_p95_m = 0;  ///< 95th percentile of d; NaN: none was measured
};

/// The convex hull of points of the plane, counter-clockwise, without points on its edges. Fewer than three different
/// points, or points on a line, give those at its ends.
std::vector<Eigen::Vector2d> ConvexHull(std::vector<Eigen::Vector2d> points);

/// Distance of a point from a convex polygon (ConvexHull()); 0 inside. Throws std::invalid_argument when it is empty.
double DistanceOutside(const std::vector<Eigen::Vector2d>& hull, const Eigen::Vector2d& point);

/// The frames in order of time.
Balance MeasureBalance(const std::vector<SupportedFrame>& frames);

}  // namespace bodyloom
