// SPDX-License-Identifier: Apache-2.0
/// One hand over a clip as a ceres::Problem with named parameter blocks, to inspect, change and solve.
///
/// The body's track is known. Unknown are, in every frame that is not lost, the fingers' coordinates, the wrist, the
/// forearm's twist and the place of the hand seen, and for the clip its size: the parameter blocks of hand_costs.h.
/// Residuals, as standard deviations:
///   points       pixels of the 21 points by their σ, Geman–McClure
///   bones        directions of the 20 bones by those of the network's points in metres, whose axes are turned from the
///                camera's by the viewing ray of the wrist; Geman–McClure. They tell flexion from extension, which the
///                pixels do not
///   limits       angles beyond their ranges
///   the rest     fingers near the prior, wrist and forearm near the body's own, the place near the body's wrist: each
///                a process over time (steady_prior.h); the logarithm of the size near 0
/// Observations of a frame count by IndependentShare().
#pragma once

#include <ceres/problem.h>

#include <memory>
#include <string>
#include <vector>

#include "geometry/body/body_model.h"
#include "geometry/body/posed_body.h"
#include "geometry/scene/hands_and_face.h"
#include "geometry/scene/track.h"
#include "tracking/hands/hand_costs.h"
#include "tracking/hands/steady_prior.h"

namespace bodyloom {

struct HandFitOptions {
  /// Of a bone's direction, one axis, and how long errors last: measured between two cameras (docs/lab/hands.md).
  double bone_sigma = 0.3, errors_last_s = 0.15;
  double kernel = 3;                                      ///< of points and bones, in standard deviations
  double fingers_last_s = 0.5;                            ///< length of the fingers' process, whose σ is the prior's
  SteadyPrior wrist = {.sigma = 0.45, .length_s = 0.4};   ///< radians
  SteadyPrior forearm = {.sigma = 0.7, .length_s = 0.4};  ///< radians
  SteadyPrior place = {.sigma = 0.04, .length_s = 0.4};   ///< metres
  double log_size_sigma = 0.2;
  double min_confidence = 0.2;  ///< of points whose σ is not known; others are not used
  /// Of a hand's wrist from the body's, in lengths of the hand from wrist to middle knuckle; farther ones are not used:
  /// the detector took left for right there, or somebody else's hand.
  double max_wrist_lengths = 2;
  double min_length_px = 8;  ///< of a hand from wrist to middle knuckle, by the body; smaller ones are not used
  int max_iterations = 25;
  /// A solve takes 80 KB a frame (docs/lab/run_speed.md, "Memory"). Tracks of more than max_frames frames are fitted
  /// in windows, each with all frames within context_s of it, after which the processes above have forgotten. The
  /// hand's size is fitted before, to stretches of 50 frames all over the clip.
  int max_frames = 2000, window_frames = 600;
  double context_s = 3;
};

class HandProblem {
 public:
  /// `seen` has the track's frames. `cut_before`: T flags, or empty. `used`: T flags of the problem's frames,
  /// the others are as if lost; empty: all. Nothing is kept of the arguments. Throws std::invalid_argument when sizes
  /// differ.
  HandProblem(const BodyModel& body, const HandSkeleton& hand, const Track& track, const HandsAndFaceSequence& seen,
              const std::vector<char>& cut_before, const HandFitOptions& options, const std::vector<char>& used = {});
  ~HandProblem();
  HandProblem(const HandProblem&) = delete;
  HandProblem& operator=(const HandProblem&) = delete;

  [[nodiscard]] ceres::Problem& problem();
  /// The blocks; null in a lost frame.
  [[nodiscard]] double* fingers(int t);
  [[nodiscard]] double* wrist(int t);
  [[nodiscard]] double* forearm(int t);
  [[nodiscard]] double* place(int t);
  [[nodiscard]] double* log_size();
  /// "fingers of l_wrist, frame 12"; empty for a pointer that is no block of this problem.
  [[nodiscard]] std::string NameOf(const double* block) const;

  [[nodiscard]] const HandKinematics& kinematics() const;
  /// Lengths of the hand in the frames begin ≤ t < end in which it was found, pixels.
  [[nodiscard]] std::vector<double> LengthsPx(int begin, int end) const;
  /// Distances of the points of these frames from where they were found, at the parameters' values, pixels.
  [[nodiscard]] std::vector<double> ErrorsPx(int begin, int end) const;

  /// Solves with Ceres on one thread. Returns "", or the reason why the values are not usable. `iterations` may be
  /// null.
  std::string Solve(int max_iterations, int* iterations = nullptr);

  /// Standard deviations at the parameters' values by the Gauss–Newton matrix.
  struct Sigma {
    Eigen::Matrix<double, Eigen::Dynamic, kFingerCoordinates> angles;  ///< T: of FreeHandAngles(), radians
    Eigen::Matrix<double, Eigen::Dynamic, kHandJoints>
        joints_m;  ///< T: of the joints' places about the wrist, one axis
  };
  /// NaN in lost frames, and everywhere when the matrix is singular.
  [[nodiscard]] Sigma FindSigma();

  /// Rotations of elbow, wrist and finger joints at the parameters' values; those of `pose` in a lost frame.
  void SetPose(int t, BodyPose* pose) const;

 private:
  struct Memory;
  std::unique_ptr<Memory> memory_;
};

}  // namespace bodyloom
