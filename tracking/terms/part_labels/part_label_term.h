// SPDX-License-Identifier: Apache-2.0
/// Residuals of a part map (or a mask) of one frame: distances between the contours of body and detection, and pixels
/// of a part that the body does not cover. All are by *part* (PartLabelSequence); the silhouette is the contour of all
/// parts together.
///
/// Computed once from the detection: the signed distance field φ of the silhouette and of each part (distance_field.h),
/// samples of their boundaries, and some pixels inside each part. A round, at its starting state, rasterises the body
/// and finds:
///   contour → field     samples x of the body's own contour (it meets the background, or a part that is not nearer,
///                       in the visibility buffer): r = φ(π(x)) / σ, both ways: the contour has to lie on the boundary
///   boundary → contour  samples y of the detected boundary: the nearest sample x of the body's contour between the
///                       same two parts, r = W (π(x) − y), W = (n nᵀ + τ² t tᵀ)/σ with n = ∇φ(y): across the
///                       boundary, and weakly (τ = 0.2) along it, so that the body fills the mask
///   pixel → part        samples y inside part p where the body shows another part or nothing: the vertex of p that
///                       faces the camera and projects nearest, r = (π(x) − y)/(3σ)
/// σ = sigma_share × the person's height in the image. The silhouette of a mask uses clothes_sigma_share for σ across
/// the boundary where the body is inside (φ < 0, or n·(π(x) − y) < 0): clothes and hair extend beyond the body, but the
/// body never beyond them. Both costs and their derivatives are continuous at the boundary. Correspondences (x and y)
/// are fixed during a round, φ and π are evaluated at every state. Each of the two terms counts as at most
/// kSilhouetteCount or kPartCount observations, because the errors of neighbouring pixels are correlated.
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

class PartLabelMatches;

/// The matches of one frame, which may be kept or computed when they are asked for.
class PartLabelSource {
 public:
  virtual ~PartLabelSource() = default;
  /// Number of rows of the silhouette, or of the parts; an upper bound before the matches are known.
  [[nodiscard]] virtual int num_rows(bool of_silhouette) const = 0;
  /// Number of pixels that show the person.
  [[nodiscard]] virtual int num_person_pixels() const = 0;
  /// Called from several threads, for one frame by one at a time.
  [[nodiscard]] virtual std::shared_ptr<const PartLabelMatches> Get(const FrameLayout& layout) const = 0;
};

class PartLabelMatches : public PartLabelSource {
 public:
  static constexpr int kMinPartPixels = 30;
  static constexpr double kSilhouetteCount = 40, kPartCount = 60, kSpeckShare = 0.1;

  /// A surface point that should appear at a pixel.
  struct Target {
    int face = 0;
    Eigen::Vector3d barycentric;
    Eigen::Vector2d pixel;
    Eigen::Vector2d outward = Eigen::Vector2d::Zero();  ///< n; zero where it is not defined
    Eigen::Matrix2d whitening;                          ///< of a point outside the boundary or on it
    Eigen::Matrix2d whitening_inside;                   ///< of a point inside
    double weight = 0;
    bool is_silhouette = false;
    [[nodiscard]] const Eigen::Matrix2d& WhiteningAt(const Eigen::Vector2d& at) const {
      return outward.dot(at - pixel) < 0 ? whitening_inside : whitening;
    }
  };
  /// A surface point whose projection should have the distance offset_px in the field.
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
  /// `weight` is a factor of the options' weights.
  void Correspond(const FrameLayout& layout, const FrameState& state, const Eigen::VectorXd& betas, double log_focal,
                  double person_height_px, double kernel, double weight, VisibleSurface* surface);

  [[nodiscard]] const std::vector<Target>& targets() const { return targets_; }
  [[nodiscard]] const std::vector<ContourPoint>& contour() const { return contour_; }
  [[nodiscard]] int num_rows(bool of_silhouette) const override { return num_rows_[of_silhouette]; }
  [[nodiscard]] double kernel() const { return kernel_; }
  /// Number of detected boundary samples and pixels without a correspondence on the body in this round.
  [[nodiscard]] int silhouette_unmatched() const { return silhouette_unmatched_; }
  [[nodiscard]] int part_unmatched() const { return part_unmatched_; }
  [[nodiscard]] int num_person_pixels() const override { return num_person_pixels_; }
  /// This object, which the caller keeps.
  [[nodiscard]] std::shared_ptr<const PartLabelMatches> Get(const FrameLayout& /*layout*/) const override {
    return {std::shared_ptr<const PartLabelMatches>(), this};
  }
  /// The largest number of rows that a mask has.
  static int MaxMaskRows();
  /// Field of a part, or of the silhouette (0); null if there are too few pixels.
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
  /// The nearest of edges in the order of rows within `reach_px` of a pixel; null: none.
  static const Edge* Nearest(const std::vector<const Edge*>& edges, const Eigen::Vector2d& pixel, double reach_px);
  void AddBoundary(const std::vector<Edge>& edges, const BodyModel& model, const VisibleSurface& surface,
                   const Camera& camera, const Sigmas& sigmas, double reach_px);
  void AddInside(const std::vector<uint8_t>& part_of_face, const BodyModel& model, const VisibleSurface& surface,
                 const Camera& camera, double sigma_px);
  void Weigh(double factor);
  /// Part of each face; unknown for charts that are never labelled.
  [[nodiscard]] std::vector<uint8_t> PartOfFaces(const BodyModel& model) const;

  const PartLabelSequence& labels_;
  int t_;
  std::shared_ptr<const Skinner> skinner_;
  PartLabelOptions options_;
  int num_person_pixels_ = 0;
  int cell_px_ = 1;
  std::vector<PixelBox> boxes_;  ///< box of each part, the person's at 0; while the frame is read
  std::vector<int> pixels_of_part_;
  std::map<uint8_t, DistanceField> fields_;  ///< field of each part; the silhouette's at 0
  std::vector<BoundarySample> boundary_;
  std::vector<Inside> inside_;
  std::vector<Target> targets_;
  std::vector<ContourPoint> contour_;
  double kernel_ = 4;
  std::array<int, 2> num_rows_ = {0, 0};  ///< of the parts, of the silhouette
  int silhouette_unmatched_ = 0, part_unmatched_ = 0;
};

/// True for one part for the whole person, which includes clothes and hair.
bool IsMask(const PartLabelSequence& labels);

/// Adds the residuals of the silhouette, or of the parts.
void AddMatches(const PartLabelSource& source, bool of_silhouette, FrameAccumulator* sums);

template <bool kOfSilhouette>
class OutlineTerm : public CopyableTerm<OutlineTerm<kOfSilhouette>> {
 public:
  const PartLabelSource* matches = nullptr;  ///< borrowed; null: none

  [[nodiscard]] std::string name() const override { return kOfSilhouette ? "silhouette" : "part labels"; }
  [[nodiscard]] int num_rows() const override { return matches == nullptr ? 0 : matches->num_rows(kOfSilhouette); }
  [[nodiscard]] bool is_compressed() const override { return true; }
  void Add(FrameAccumulator* sums) const override {
    if (matches != nullptr) AddMatches(*matches, kOfSilhouette, sums);
  }
};

using SilhouetteTerm = OutlineTerm<true>;
using PartLabelTerm = OutlineTerm<false>;

}  // namespace bodyloom
