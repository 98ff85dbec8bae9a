// SPDX-License-Identifier: Apache-2.0
/// Residuals of a part map (or a mask) of one frame: contours that should coincide, and pixels that should
/// be covered. Everything is per *part* (PartLabelSequence says what that is); the silhouette is the contour of all
/// parts together.
///
/// The detection gives, once: the signed distance field φ of the silhouette and of each part (distance_field.h),
/// samples of their boundaries, and some pixels inside each part. A round, at its starting state, rasterises the body
/// and sets up:
///   contour → field     samples x of the body's own contour (it meets the background, or a part that is not nearer,
///                       in the visibility buffer): r = φ(π(x)) / σ, both ways: the contour has to lie on the boundary
///   boundary → contour  samples y of the detected boundary: the nearest sample x of the body's contour between the
///                       same two parts, r = W (π(x) − y), W = (n nᵀ + τ² t tᵀ)/σ with n = ∇φ(y): across the
///                       boundary, and hardly (τ = 0.2) along it. So the body fills the mask
///   pixel → part        samples y inside part p where the body shows another part or nothing: the vertex of p that
///                       faces the camera and projects nearest, r = (π(x) − y)/(3σ)
/// σ = sigma_share × the person's height in the image. The silhouette of a mask takes clothes_sigma_share for σ across
/// the boundary wherever the body is inside (φ < 0, or n·(π(x) − y) < 0): clothes and hair reach beyond the body, the
/// body never beyond them. Both costs and their derivatives are continuous where the body crosses. Correspondences (x
/// and y) stay during a round, φ and π are evaluated at every state. Each of the two terms counts as kSilhouetteCount
/// or kPartCount observations at most, however many samples it has: neighbouring pixels err together.
/// Unknown pixels and pixels beyond the image give no boundary. Pieces of the person or of a part below kSpeckShare of
/// the largest are unknown (part_map.h); parts of fewer than kMinPartPixels pixels are left out.
#pragma once

#include <Eigen/Core>
#include <array>
#include <map>
#include <memory>
#include <vector>

#include "geometry/scene/observations.h"
#include "tracking/problem/frame_layout.h"
#include "tracking/problem/frame_term.h"
#include "tracking/problem/track_options.h"
#include "tracking/problem/visible_surface.h"
#include "tracking/terms/part_labels/distance_field.h"
#include "tracking/terms/part_labels/part_map.h"

namespace bodyloom {

class PartLabelMatches {
 public:
  static constexpr int kMinPartPixels = 30;
  static constexpr double kSilhouetteCount = 40, kPartCount = 60, kSpeckShare = 0.1;

  /// A surface point that should appear at a pixel.
  struct Target {
    int face = 0;
    Eigen::Vector3d barycentric;
    Eigen::Vector2d pixel;
    Eigen::Vector2d outward = Eigen::Vector2d::Zero();  ///< n; zero where no direction is across the boundary
    Eigen::Matrix2d whitening;                          ///< of a point outside the boundary or on it
    Eigen::Matrix2d whitening_inside;                   ///< of a point inside
    double weight = 0;
    bool is_silhouette = false;
    [[nodiscard]] const Eigen::Matrix2d& WhiteningAt(const Eigen::Vector2d& at) const {
      return outward.dot(at - pixel) < 0 ? whitening_inside : whitening;
    }
  };
  /// A surface point that should appear where the field is offset_px.
  struct ContourPoint {
    int face = 0;
    Eigen::Vector3d barycentric;
    const DistanceField* field = nullptr;
    double offset_px = 0, inverse_sigma = 0, inverse_sigma_inside = 0, weight = 0;
    bool is_silhouette = false;
    [[nodiscard]] double InverseSigmaAt(double distance) const {
      return distance < 0 ? inverse_sigma_inside : inverse_sigma;
    }
  };

  /// Reads frame t of the labels, which must be in order (TrackSequence checks them). `skinner` poses all vertices.
  PartLabelMatches(const PartLabelSequence& labels, int t, std::shared_ptr<const Skinner> skinner,
                   const PartLabelOptions& options);

  /// Starts a round. `person_height_px` sets σ, `kernel` is c in σ.
  void Correspond(const FrameLayout& layout, const FrameState& state, const Eigen::VectorXd& betas, double log_focal,
                  double person_height_px, double kernel, VisibleSurface* surface);

  [[nodiscard]] const std::vector<Target>& targets() const { return targets_; }
  [[nodiscard]] const std::vector<ContourPoint>& contour() const { return contour_; }
  [[nodiscard]] int num_rows() const { return static_cast<int>(2 * targets_.size() + contour_.size()); }
  [[nodiscard]] double kernel() const { return kernel_; }
  /// Detected boundaries and pixels that found nothing on the body in this round.
  [[nodiscard]] int silhouette_unmatched() const { return silhouette_unmatched_; }
  [[nodiscard]] int part_unmatched() const { return part_unmatched_; }
  /// Pixels that show the person.
  [[nodiscard]] int num_person_pixels() const { return num_person_pixels_; }
  /// Of a part, or of the silhouette (0); null where there are too few pixels.
  [[nodiscard]] const DistanceField* Field(uint8_t part) const;

 private:
  struct BoundarySample {
    Eigen::Vector2d pixel;  ///< half way between two pixels
    uint8_t a = 0, b = 0;   ///< parts on both sides, a < b; 0 is the background
  };
  struct Inside {
    int x, y;
    uint8_t part;
  };
  /// A visible pixel of the body at the edge of its part.
  struct Edge {
    int x, y, face;
    uint8_t part, other;  ///< 0: the background
  };
  /// σ in pixels: of a contour, and of the silhouette where the body is inside it.
  struct Sigmas {
    double contour_px, clothes_px;
  };
  void FindBoxes(const PartMap& map);
  void AddField(const PartMap& map, uint8_t part);
  void SampleBoundary(const PartMap& map);
  void SampleInside(const PartMap& map);
  [[nodiscard]] std::vector<Edge> EdgesOfBody(const std::vector<uint8_t>& part_of_face,
                                              const VisibilityBuffer& buffer) const;
  void AddContour(const std::vector<Edge>& edges, const BodyModel& model, const VisibleSurface& surface,
                  const Camera& camera, const Sigmas& sigmas);
  void AddBoundary(const std::vector<Edge>& edges, const BodyModel& model, const VisibleSurface& surface,
                   const Camera& camera, const Sigmas& sigmas, double reach_px);
  void AddInside(const std::vector<uint8_t>& part_of_face, const BodyModel& model, const VisibleSurface& surface,
                 const Camera& camera, double sigma_px);
  void Weigh();
  /// Part of each face; unknown for charts that are never labelled.
  [[nodiscard]] std::vector<uint8_t> PartOfFaces(const BodyModel& model) const;

  const PartLabelSequence& labels_;
  int t_;
  std::shared_ptr<const Skinner> skinner_;
  PartLabelOptions options_;
  int num_person_pixels_ = 0;
  int cell_px_ = 1;
  std::array<PixelBox, 256> boxes_;  ///< box of each part; the person's at 0
  std::array<int, 256> pixels_of_part_{};
  std::map<uint8_t, DistanceField> fields_;  ///< field of each part; the silhouette's at 0
  std::vector<BoundarySample> boundary_;
  std::vector<Inside> inside_;
  std::vector<Target> targets_;
  std::vector<ContourPoint> contour_;
  double kernel_ = 4;
  int silhouette_unmatched_ = 0, part_unmatched_ = 0;
};

class PartLabelTerm : public CopyableTerm<PartLabelTerm> {
 public:
  const PartLabelMatches* term = nullptr;  ///< borrowed; null: none

  [[nodiscard]] std::string name() const override { return "silhouette and parts"; }
  [[nodiscard]] int num_rows() const override { return term == nullptr ? 0 : term->num_rows(); }
  [[nodiscard]] bool is_compressed() const override { return true; }
  void Add(FrameAccumulator* sums) const override;
};

}  // namespace bodyloom
