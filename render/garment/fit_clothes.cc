// SPDX-License-Identifier: Apache-2.0
#include "render/garment/fit_clothes.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "geometry/base/parallel.h"
#include "geometry/body/posed_body.h"
#include "geometry/body/skinning.h"
#include "geometry/cloth/body_obstacles.h"
#include "geometry/cloth/cloth_body.h"
#include "geometry/cloth/cloth_run.h"
#include "geometry/scene/track_edits.h"
#include "render/garment/person_silhouette.h"
#include "render/raster/visibility_buffer.h"
#include "render/view/floor.h"
#include "render/view/overlay.h"

namespace bodyloom {
namespace {

constexpr std::array<double, 3> kPinnedHeights = {0.4, 1, 2};  ///< from the pelvis to spine1, and on to spine2
constexpr std::array<double, 5> kFullness = {0.06, 0.22, 0.38, 0.54, 0.72};
constexpr std::array<double, 4> kSwings_rad = {-0.5, -0.25, 0.25, 0.5};
constexpr size_t kTriedAgain = 5, kSwung = 3;
constexpr double kCoarseSpacing_m = 0.05, kFinerFullness = 0.08;
constexpr uint64_t kSeed = 1;
constexpr int kSmplJoints = 24;

class ClothesFit {
 public:
  ClothesFit(const BodyModel& body, const Track& photo, const LabelImage& mask, const FitClothesOptions& options)
      : body_(body),
        photo_(photo),
        mask_(mask),
        options_(options),
        betas_(photo.motion.betas),
        rest_(ShapeVertices(body, betas_)),
        vertices_(TrackVertices(body, photo, 0)),
        silhouette_(photo.CameraAt(0), mask, options.compared_height_px) {}

  FittedClothes Run() {
    FittedClothes close;
    close.offsets = FitOffsets({});
    if (!options_.loose || body_.num_joints() < kSmplJoints || silhouette_.area() == 0) return close;
    FittedClothes closest = close;
    for (double& offset : closest.offsets.metres) offset = std::min(offset, options_.close_m);
    close.mask_error_tight = close.mask_error_with_garment = MaskError(closest);
    FittedClothes loose = close;
    const Candidate best = BestGarment();
    if (best.cut.length_m <= 0) return close;
    loose.garment = best.cut;
    loose.swing_rad = best.swing_rad;
    loose.offsets = FitOffsets(CoveredByGarment(body_, rest_, loose.garment));
    close.mask_error_with_garment = loose.mask_error_with_garment = MaskError(loose);
    return close.mask_error_tight - loose.mask_error_with_garment >= options_.min_gain ? loose : close;
  }

 private:
  ClothesOffsets FitOffsets(const std::vector<uint8_t>& covered) const {
    return FitClothesOffsets(body_, rest_, vertices_, photo_.CameraAt(0), mask_, options_.offsets, covered);
  }

  /// A garment, and the person's pixels beside the bare body that it covers minus the background pixels.
  struct Candidate {
    LooseGarmentOptions cut;
    double swing_rad = 0;
    int pixels = 0;
  };

  /// The garment that covers most of the person beside the bare body; length 0: none covers any. Cloth that reaches the
  /// ankles hangs closer than cloth that ends at the knee, so the best of full length are cut and simulated again.
  Candidate BestGarment() const {
    const MatrixX3d joints = body_.RestJoints(betas_);
    const double pelvis = joints(0, 1), spine1 = joints(3, 1), spine2 = joints(6, 1);
    const double ankle = 0.5 * (joints(7, 1) + joints(8, 1));
    const ClothCollisionBody wearer(body_, betas_, {});
    VisibilityBuffer bare;
    bare.Render(vertices_, body_.data().faces, silhouette_.camera());
    std::vector<Candidate> candidates;
    for (const double height : kPinnedHeights) {
      LooseGarmentOptions cut;
      cut.waist_y_m = height <= 1 ? pelvis + height * (spine1 - pelvis) : spine1 + (height - 1) * (spine2 - spine1);
      cut.length_m = cut.waist_y_m - ankle;
      cut.spacing_m = kCoarseSpacing_m;
      if (cut.length_m < options_.shortest_m) continue;
      for (const double fullness : kFullness) {
        cut.fullness = fullness;
        candidates.push_back({cut});
      }
    }
    TryOn(wearer, bare, &candidates);
    std::stable_sort(candidates.begin(), candidates.end(),
                     [](const Candidate& a, const Candidate& b) { return a.pixels > b.pixels; });
    // Without enough person pixels beside the bare body no garment can reach min_gain.
    const double minimum = options_.min_gain * silhouette_.area();
    std::erase_if(candidates, [&](const Candidate& candidate) { return candidate.pixels < minimum; });
    if (candidates.size() > kTriedAgain) candidates.resize(kTriedAgain);
    for (size_t i = 0; i < std::min(kSwung, candidates.size()); ++i) {
      for (const double swing : kSwings_rad) candidates.push_back({candidates[i].cut, swing});
    }
    TryOn(wearer, bare, &candidates);
    Candidate best = BestOf(candidates);
    if (best.pixels <= 0) return best;
    candidates = {best, best};
    candidates[0].cut.fullness = std::max(0.0, best.cut.fullness - kFinerFullness);
    candidates[1].cut.fullness = best.cut.fullness + kFinerFullness;
    TryOn(wearer, bare, &candidates);
    candidates.push_back(best);
    best = BestOf(candidates);
    best.cut.spacing_m = options_.spacing_m;
    return best;
  }

  static Candidate BestOf(const std::vector<Candidate>& candidates) {
    Candidate best;
    best.cut.length_m = 0;
    for (const Candidate& candidate : candidates) {
      if (candidate.pixels > best.pixels) best = candidate;
    }
    return best;
  }

  /// Simulates garments on the body and keeps for each the length that covers most.
  void TryOn(const ClothCollisionBody& wearer, const VisibilityBuffer& bare, std::vector<Candidate>* candidates) const {
    ParallelFor(static_cast<int>(candidates->size()), options_.num_threads,
                [&](int i) { (*candidates)[i] = AsLongAsItCoversMost(wearer, bare, (*candidates)[i]); });
  }

  /// The garment after simulation, cut at the row down to which it covers most.
  Candidate AsLongAsItCoversMost(ClothCollisionBody wearer, const VisibilityBuffer& bare,
                                 const Candidate& tried) const {
    wearer.Wear(wearer.Cut(tried.cut, kSeed));
    const LooseGarment& garment = wearer.garment();
    const VisibilityBuffer seen = SeeGarment(
        garment, ClothRun(wearer, photo_.motion, HangingCloth(photo_, tried.swing_rad)).Next(), silhouette_.camera());
    const std::vector<int> covered = CoveredBeside(silhouette_, bare, seen, garment);
    const double path = tried.cut.length_m / (garment.rings - 1);
    Candidate best = tried;
    best.pixels = 0;
    int sum = 0;
    for (int r = 0; r < static_cast<int>(covered.size()); ++r) {
      sum += covered[r];
      if ((r + 1) * path < options_.shortest_m || sum <= best.pixels) continue;
      best.pixels = sum;
      best.cut.length_m = (r + 1) * path;
    }
    return best;
  }

  /// E of the dressed body.
  double MaskError(const FittedClothes& clothes) const {
    const BodyModel clothed(BakeShape(body_, betas_, clothes.offsets.metres));
    const Track track = OfBakedBody(photo_);
    VisibilityBuffer body, cloth;
    body.Render(TrackVertices(clothed, track, 0), clothed.data().faces, silhouette_.camera());
    if (clothes.garment.length_m > 0) {
      ClothCollisionBody wearer(clothed, track.motion.betas, {});
      LooseGarmentOptions coarse = clothes.garment;
      coarse.spacing_m = std::min(kCoarseSpacing_m, coarse.length_m);
      wearer.Wear(wearer.Cut(coarse, kSeed));
      cloth =
          SeeGarment(wearer.garment(), ClothRun(wearer, track.motion, HangingCloth(photo_, clothes.swing_rad)).Next(),
                     silhouette_.camera());
    }
    return double(UnlikePixels(silhouette_, body, cloth)) / silhouette_.area();
  }

  const BodyModel& body_;
  const Track& photo_;
  const LabelImage& mask_;
  const FitClothesOptions& options_;
  const Eigen::VectorXd betas_;
  const MatrixX3d rest_, vertices_;
  const PersonSilhouette silhouette_;
};

}  // namespace

FittedClothes FitClothes(const BodyModel& body, const Track& photo, const LabelImage& mask,
                         const FitClothesOptions& options) {
  return ClothesFit(body, photo, mask, options).Run();
}

std::vector<uint8_t> CoveredByGarment(const BodyModel& body, const MatrixX3d& rest_vertices,
                                      const LooseGarmentOptions& garment) {
  const std::vector<int> strongest = StrongestJoints(body);
  std::vector<uint8_t> covered(strongest.size(), 0);
  for (size_t v = 0; v < covered.size(); ++v) {
    const double y = rest_vertices(static_cast<Eigen::Index>(v), 1);
    const bool between = y < garment.waist_y_m && y > garment.waist_y_m - garment.length_m;
    covered[v] = between && IsOfTrunkOrLegs(strongest[v]) ? 1 : 0;
  }
  return covered;
}

Eigen::Vector3d SwungUp(const Track& track, double swing_rad) {
  return Eigen::AngleAxisd(swing_rad, Eigen::Vector3d::UnitZ()) * WorldOfTracks({&track}, track.joints).up_in_camera();
}

ClothRunOptions HangingCloth(const Track& photo, double swing_rad) {
  ClothRunOptions options;
  options.up = SwungUp(photo, swing_rad);
  options.tick_s = 0.1;
  options.move_in_s = 0.5;
  options.settle_s = 0.5;
  options.cloth.substep_s = 1.0 / 160;
  return options;
}

}  // namespace bodyloom
