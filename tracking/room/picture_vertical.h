// SPDX-License-Identifier: Apache-2.0
/// The vertical, and where the picture tells it the focal length, from straight lines of one or more pictures: walls,
/// doors, furniture, poles. Lines that are vertical in the room meet in the picture's vertical vanishing point.
///
/// Pixels are those of an ideal pinhole, about its principal point: p = f (X/Z, Y/Z) of a ray (X, Y, Z); lens
/// distortion of a known camera is removed first. A direction d has the vanishing point f (d_x/d_z, d_y/d_z). For a
/// segment from a to b with middle m and unit direction s the residual is an angle in the picture,
///   r(d) = ∠(s, v),   v = f (d_x, d_y) − d_z m   (towards or away from the vanishing point),  r in (−90°, 90°].
/// It depends on d and f by the vanishing point alone. So this point is what is found, and the vertical follows for
/// every focal length: up(f) ∝ (x, y, z f / f₀) for up(f₀) = (x, y, z) (PictureVertical::Up).
///
/// 1. Candidates: segments within 35° of the direction to the vanishing point of the expected up.
/// 2. Hypotheses d = n_i × n_j, n = a × b of rays (the plane through the camera and the segment), of all pairs of the
///    100 longest candidates, within 35° of the expected up. Score: Σ L (1 − (r / 1°)²) over |r| < 1°, L: length.
/// 3. Refinement by Gauss–Newton of Σ L ρ(r), ρ: Tukey's biweight, c = 1.5°. Without a random number: the same
///    segments give the same answer, in any order.
/// 4. Covariance: sandwich H⁻¹ (Σ (w r / (1 − h))² j jᵀ) H⁻¹, H = Σ w j jᵀ, j = dr/dd, w = L × Tukey's weight,
///    leverage h = w jᵀ H⁻¹ j (HC3, MacKinnon & White 1985), plus (1.5°)² in every direction: what the vertical lines
///    of a room, the principal point and the lens are off together (docs/lab/picture_vertical.md).
/// Found when inliers (|r| < 1°) have at least 0.3 of the candidates' length, are at least 8, and σ is at most 8°. The
/// share in pictures without vertical lines is below 0.2.
///
/// Focal length. Directions along walls and floors are level, and mostly at right angles. For each of 41 focal lengths
/// over ±ln 3 around the camera's, and each direction that one of the 100 longest other segments would have if it were
/// level, the score of 2. counts segments that point to this vanishing point or to that at a right angle, both level.
/// The best is refined with the vertical by Gauss–Newton over (d, heading, log f), with the same covariance. For log f
/// 0.08² is added, and the square of half the width over which the score is above 0.9 of the best. Found when the
/// agreeing segments are at least 8 with 0.3 of the others' length, σ is at most 0.25, and no focal length farther off
/// than 0.25 has more than 0.85 of the score.
///
/// Several pictures of a camera that turns or moves: parallel lines stay so wherever they are seen from, so that the
/// segments of all pictures are taken together. d is a direction of the scene, and r(R d) of each picture, whose
/// rotation is R. An edge of the room is seen in one picture after the other, with the same error of its own: a segment
/// is of the edge that a longer one of another picture shows when its ends lie within 0.3° of that one's plane and its
/// middle between that one's ends. Hypotheses and their scores are of each edge's longest segment, refinement is of all
/// segments, in 4. the rows of an edge are added up before they are squared (cluster-robust: Liang & Zeger 1986),
///   H⁻¹ (Σ_e g_e g_eᵀ) H⁻¹,   g_e = Σ_{i∈e} w r j / (1 − h_e),   h_e = Σ_{i∈e} h_i,
/// and 8 edges must agree. So a σ shrinks with the edges and not with the pictures. After a camera that goes somewhere
/// an edge is another one; errors of the rotations are not in σ. These pictures tell no focal length: their rotations
/// do, and better.
///
/// Source: vanishing points of Manhattan rooms, Coughlan & Yuille 1999; residual of a segment's middle, Denis et al.
/// 2008; f from orthogonal vanishing points, Caprile & Torre 1990.
#pragma once

#include <Eigen/Core>
#include <span>
#include <string>
#include <vector>

#include "geometry/scene/camera.h"
#include "geometry/scene/line_segment.h"
#include "tracking/problem/camera_knowledge.h"

namespace bodyloom {

/// The vertical of a picture, or of several in one scene. Directions are unit, in camera axes (x right, y down, z
/// forward), or in the scene.
struct PictureVertical {
  bool found = false;
  std::string why;                                 ///< the evidence in a few words, or the reason why none was found
  Eigen::Vector3d up = Eigen::Vector3d(0, -1, 0);  ///< for the focal length `focal_px`
  double focal_px = 1;                             ///< of the camera given
  /// Of `up`, rad², with `focal_px` as the truth; rank 2: across `up`.
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  double share = 0;      ///< of the candidates' length that agrees
  int num_segments = 0;  ///< that agree; of several pictures: edges
  /// A: for another focal length `up` is (I − A + A f/f₀) up. Of one picture z zᵀ; of several with optical axes a
  /// H⁻¹ Σ w j jᵀ a aᵀ.
  Eigen::Matrix3d along_axes = Eigen::Vector3d::UnitZ() * Eigen::RowVector3d::UnitZ();

  bool has_focal = false;
  double log_focal = 0, log_focal_sigma = 0;  ///< of the focal length that the lines tell, pixels

  /// Up if the focal length is `focal`, pixels > 0.
  [[nodiscard]] Eigen::Vector3d Up(double focal) const;
  /// d Up / d log f, across Up: |.| = sin θ cos θ for a picture that looks θ up or down.
  [[nodiscard]] Eigen::Vector3d UpByLogFocal(double focal) const;
  /// Covariance of Up(focal) when log focal has a standard deviation of `log_sigma`, rad², rank 2.
  [[nodiscard]] Eigen::Matrix3d CovarianceAt(double focal, double log_sigma) const;
  /// Root mean square of the standard deviation over the directions across `up`, rad.
  [[nodiscard]] double Sigma() const;
  /// "31 of 52 lines agree, 62 % of their length: camera looks up 12.3°, rolled 0.4°, σ 1.9°"; `why` if not found.
  [[nodiscard]] std::string BriefReport() const;
};

/// Finds the vertical of `segments`, pixels of `camera` (pinhole; where its focal length is not known: a guess).
/// `expected_up`: unit, roughly (35°) known. Segments that are not finite, have no length or lie outside the lens's
/// field of view are ignored. Throws std::invalid_argument for weak perspective, a focal length that is not a positive
/// number and an `expected_up` that is not unit.
PictureVertical FindPictureVertical(std::span<const LineSegment> segments, const Camera& camera,
                                    const Eigen::Vector3d& expected_up = Eigen::Vector3d(0, -1, 0));

/// Segments of one picture of a camera that turns or moves.
struct TurnedPicture {
  std::vector<LineSegment> segments;                                ///< pixels
  Eigen::Matrix3d camera_from_scene = Eigen::Matrix3d::Identity();  ///< rotation
};

/// Finds the vertical that the lines of all `pictures` share, in the scene; it is expected above the middle of their
/// cameras. Otherwise as above.
PictureVertical FindSharedVertical(std::span<const TurnedPicture> pictures, const Camera& camera);

/// A direction measured in two ways.
struct JoinedVertical {
  Eigen::Vector3d up = Eigen::Vector3d(0, -1, 0);
  double sigma_rad = 0;  ///< per direction across `up`, root mean square
  bool used = false;     ///< the lines were
  double angle_deg = 0;  ///< of the lines' up to the other
};

/// Largest angle of the lines' vertical to another estimate; beyond it the lines are something else.
inline constexpr double kMaxPictureVerticalAngleDeg = 25;

/// Joins `up` (unit, standard deviation `sigma_rad` in each direction across it) with the lines by their information
/// matrices, in the plane across `up`. Not used: lines not found, or farther off than kMaxPictureVerticalAngleDeg;
/// then `up` and `sigma_rad` as given.
JoinedVertical JoinVerticals(const Eigen::Vector3d& up, double sigma_rad, const PictureVertical& lines, double focal_px,
                             double log_focal_sigma);

/// `prior` and the lines' focal length as two measurements of log f: 1/s² = Σ 1/s_i², mean by 1/s_i². `prior` where the
/// lines tell none.
FocalPrior JoinFocalPrior(const FocalPrior& prior, const PictureVertical& lines);

}  // namespace bodyloom
