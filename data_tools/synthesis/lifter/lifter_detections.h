// SPDX-License-Identifier: Apache-2.0
/// Simulates detections of a lifter's training scene: confidences that depend on occlusion, noise that depends on them,
/// missing points and left–right swaps.
///
/// Confidence: the typical value of the landmark (face: by the direction of the head), × 0.16 where the trunk (three
/// capsules between shoulders and hips, radius 9–13 cm) or a leg (radius 7 cm) lies more than 9 cm in front of it,
/// softened over 3 cm; × 0.85 for a shoulder or hip that is turned away by more than 10 cm; plus its slow drift. Noise:
/// data_tools/synthesis/clips/detection_noise.h, in person heights (1.3 Lref) at the person's distance. Then swaps, the
/// detector's own scale of confidence, points that it does not have or report, and the image border.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "data_tools/synthesis/lifter/lifter_body.h"
#include "data_tools/synthesis/lifter/lifter_window_options.h"
#include "geometry/base/hash_random.h"

namespace bodyloom {

// Ground truth of a training window: a person who moves in front of a camera, before detection.

/// Metres, camera frame of each frame (x right, y down, z forward).
struct LifterScene {
  int num_frames = 0;
  std::vector<Eigen::Vector3f> points;    ///< T·21 landmarks
  std::vector<Eigen::Vector3f> detected;  ///< T·21 the same as defined by this window's detector
  std::vector<Eigen::Vector3f> up;        ///< T unit vectors
  std::vector<float> contact;             ///< T·2 left, right foot: 1 on the ground and still, else 0
  float reference_length = 0;             ///< Lref
  float size = 1;                         ///< Lref over the mean body's
};

/// Landmarks in the world (y up), placed on the floor: with a floor, each frame is moved vertically so that the lowest
/// point of the body has the height `poses.clearance` (0 on the floor), also after changes to the poses.
///
/// Contact of a foot, with h the height of its toe's or heel's sole above the floor and v the speed of that landmark
/// (central differences over two frames of the window): with a floor h < 4 cm and v < 0.35 m/s; without one, h is
/// counted from the lowest point of the body in that frame and v < 0.25 m/s. Toe or heel suffices. Lengths are of the
/// mean body and scale with the person.
struct WorldMotion {
  std::vector<Eigen::Vector3f> points, detected;  ///< T·21, y up
  std::vector<float> contact;                     ///< T·2
};
WorldMotion PoseInWorld(const LifterBody& body, const LifterPerson& person, const PoseSequence& poses, double rate);

/// Places a random camera with the person in front of it in every frame.
LifterScene FilmPerson(const WorldMotion& motion, const LifterPerson& person, const LifterWindowOptions& options,
                       HashRandom random);

/// Rays by the true focal length; focal_known is left false. The same seed draws the same confidences for every
/// options.noise.
LifterFrames DetectScene(const LifterScene& scene, const LifterWindowOptions& options, uint64_t seed);

}  // namespace bodyloom
