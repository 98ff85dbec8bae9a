// SPDX-License-Identifier: Apache-2.0
#include "render/garment/clip_clothes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <utility>

#include "geometry/base/parallel.h"
#include "geometry/base/percentile.h"
#include "geometry/scene/track_edits.h"
#include "render/garment/fit_clothes.h"
#include "render/garment/person_cloth.h"
#include "render/garment/person_silhouette.h"
#include "render/view/overlay.h"

namespace bodyloom {
namespace {

constexpr int kMaxPieces = 5, kPieceFrames = 40;
constexpr int kFramesForPiece = 20;  ///< frames of the clip per piece
constexpr int kMasksAPiece = 5, kAskedAPiece = 2;
constexpr double kSearchSpacing_m = 0.04;  ///< of the garment's vertices during the search; the result is cut finer
constexpr double kMinShare = 1.0 / 3;      ///< of the frames fitted independently; coats are found in half of theirs
constexpr int kHalvings = 2;
constexpr double kLengthStep_m = 0.04, kFullnessStep = 0.08, kWaistStep_m = 0.04;
constexpr double kShortest_m = 0.25, kFullest = 0.9;
constexpr int kJointsOfSmpl = 24;

/// Consecutive frames, at a few of which masks are compared.
struct Piece {
  Track track;
  std::vector<int> looked_at;  ///< frames of the piece with masks, ascending
  std::vector<PersonSilhouette> silhouettes;
};

/// Waist (relative to the initial one), length and fullness in steps: integers, so that tried measures are recognised.
using Measures = std::array<int, 3>;

class ClipClothesFit {
 public:
  ClipClothesFit(const BodyModel& body, const Track& track, int num_threads, const PipelineCallbacks& callbacks)
      : body_(body), track_(track), num_threads_(num_threads), callbacks_(callbacks) {}

  ClipClothes Run(const std::vector<int>& frames, const MaskOfFrame& mask_of) {
    std::vector<int> usable;
    std::copy_if(frames.begin(), frames.end(), std::back_inserter(usable), [&](int t) { return track_.HasResult(t); });
    if (usable.empty() || body_.num_joints() < kJointsOfSmpl) return {};
    std::vector<FittedClothes> asked;
    const int count = std::clamp(static_cast<int>(usable.size()) / kFramesForPiece, 1, kMaxPieces);
    for (int k = 0; k < count && MayBeEnough(asked, count); ++k) {
      const size_t end = (k + 1) * usable.size() / count;
      AddPiece(usable, static_cast<int>(end) - 1, mask_of, &asked);
    }
    ClipClothes clothes;
    clothes.frames = static_cast<int>(asked.size());
    if (!Begin(asked, &clothes)) return clothes;
    Search();
    if (std::isfinite(MaskError(best_))) clothes.mask_error_with_garment = MaskError(best_);
    if (clothes.mask_error_tight - clothes.mask_error_with_garment >= options_.min_gain) {
      clothes.garment = Cut(best_);
      clothes.offsets_m = offsets_;
    }
    return clothes;
  }

 private:
  static int FoundIn(const std::vector<FittedClothes>& asked) {
    return static_cast<int>(std::count_if(asked.begin(), asked.end(),
                                          [](const FittedClothes& fitted) { return fitted.garment.length_m > 0; }));
  }

  /// True if the frames of so many pieces suffice for a garment.
  static bool MayBeEnough(const std::vector<FittedClothes>& asked, int pieces) {
    const int all = pieces * kAskedAPiece, without = static_cast<int>(asked.size()) - FoundIn(asked);
    return all - without >= kMinShare * all;
  }

  /// Adds the piece that ends with usable[last] and fits its last masks independently.
  void AddPiece(const std::vector<int>& usable, int last, const MaskOfFrame& mask_of,
                std::vector<FittedClothes>* asked) {
    const int end = usable[last], begin = std::max(0, end - kPieceFrames + 1);
    const auto first = std::lower_bound(usable.begin(), usable.begin() + last, begin);
    const auto count = static_cast<int>(usable.begin() + last + 1 - first);
    std::vector<int> run(end - begin + 1);
    std::iota(run.begin(), run.end(), begin);
    Piece piece;
    piece.track = FramesInOrder(track_, run);
    for (size_t i = 0; i < run.size(); ++i) piece.track.motion.timestamps[i] = track_.motion.timestamps[run[i]];
    const int masks = std::min(count, kMasksAPiece);
    for (int i = 0; i < masks; ++i) {
      const int t = first[static_cast<ptrdiff_t>(i + 1) * count / masks - 1];
      callbacks_.Update("looking for a garment", 0);
      const LabelImage mask = mask_of(t);
      PersonSilhouette silhouette(track_.CameraAt(t), mask, options_.compared_height_px);
      if (silhouette.area() == 0) continue;
      piece.looked_at.push_back(t - begin);
      piece.silhouettes.push_back(std::move(silhouette));
      if (i + kAskedAPiece < masks) continue;
      FitClothesOptions options = options_;
      options.num_threads = num_threads_;
      asked->push_back(FitClothes(body_, FramesInOrder(track_, std::vector<int>{t}), mask, options));
    }
    if (!piece.looked_at.empty()) pieces_.push_back(std::move(piece));
  }

  /// Initialises the search. False if too few frames show a garment.
  bool Begin(const std::vector<FittedClothes>& asked, ClipClothes* clothes) {
    std::vector<const FittedClothes*> found;
    std::vector<double> waists;
    double hem = 0, fullness = 0;
    for (const FittedClothes& fitted : asked) {
      clothes->mask_error_tight += fitted.mask_error_tight / static_cast<double>(asked.size());
      if (fitted.garment.length_m <= 0) continue;
      found.push_back(&fitted);
      waists.push_back(fitted.garment.waist_y_m);
      hem += fitted.garment.waist_y_m - fitted.garment.length_m;
      fullness += fitted.garment.fullness;
    }
    clothes->found_in = FoundIn(asked);
    clothes->mask_error_with_garment = clothes->mask_error_tight;
    if (found.empty() || clothes->found_in < kMinShare * clothes->frames) return false;
    // A silhouette hardly shows where cloth on the body begins. Too high does little harm, as the cloth there follows
    // the body; too low lets held cloth swing.
    constexpr double kWaistPercentile = 75;
    const auto count = static_cast<double>(found.size());
    begun_ = found.front()->garment;
    begun_.waist_y_m = Percentile(waists, kWaistPercentile);
    begun_.length_m = begun_.waist_y_m - hem / count;
    begun_.fullness = fullness / count;
    offsets_.resize(body_.num_vertices());
    for (size_t v = 0; v < offsets_.size(); ++v) {
      std::vector<double> metres;
      metres.reserve(found.size());
      for (const FittedClothes* fitted : found) metres.push_back(fitted->offsets.metres[v]);
      offsets_[v] = Percentile(metres, 50);
    }
    clothed_.emplace(BakeShape(body_, track_.motion.betas, offsets_));
    for (Piece& piece : pieces_) piece.track = OfBakedBody(std::move(piece.track));
    return true;
  }

  /// Garment of these measures; the hem stays in place when the waist moves.
  [[nodiscard]] LooseGarmentOptions Cut(const Measures& steps) const {
    constexpr double kFinest = 1 << (kHalvings - 1);
    LooseGarmentOptions cut = begun_;
    cut.waist_y_m += steps[0] * kWaistStep_m / kFinest;
    cut.length_m += steps[0] * kWaistStep_m / kFinest + steps[1] * kLengthStep_m / kFinest;
    cut.fullness += steps[2] * kFullnessStep / kFinest;
    return cut;
  }

  void Search() {
    for (int step = 1 << (kHalvings - 1); step >= 1; step /= 2) {
      for (const int measure : {1, 0, 2}) {
        for (const int sign : {1, -1}) {
          while (Improves(measure, sign * step)) {
          }
        }
      }
    }
  }

  /// Changes a measure by `by` if that lowers E. Returns true if it did.
  bool Improves(int measure, int by) {
    Measures there = best_;
    there[measure] += by;
    const LooseGarmentOptions cut = Cut(there);
    if (cut.length_m < kShortest_m || cut.fullness < 0 || cut.fullness > kFullest) return false;
    if (!(MaskError(there) < MaskError(best_))) return false;
    best_ = there;
    return true;
  }

  double MaskError(const Measures& steps) {
    const auto known = unlike_.find(steps);
    if (known != unlike_.end()) return known->second;
    callbacks_.Update("fitting the garment", 0);
    std::vector<double> sums(pieces_.size(), 0);
    LooseGarmentOptions cut = Cut(steps);
    cut.spacing_m = std::max(cut.spacing_m, kSearchSpacing_m);
    LooseGarment garment;
    try {
      garment = CutGarment(*clothed_, &cut);
    } catch (const std::invalid_argument&) {  // the waist is off the body
      return unlike_[steps] = std::numeric_limits<double>::infinity();
    }
    ParallelFor(static_cast<int>(pieces_.size()), num_threads_,
                [&](int p) { sums[p] = UnlikeIn(pieces_[p], garment); });
    size_t looked_at = 0;
    for (const Piece& piece : pieces_) looked_at += piece.looked_at.size();
    return unlike_[steps] = std::accumulate(sums.begin(), sums.end(), 0.0) / static_cast<double>(looked_at);
  }

  /// Sum of E over the frames compared.
  [[nodiscard]] double UnlikeIn(const Piece& piece, const LooseGarment& garment) const {
    PersonCloth cloth(*clothed_, garment, piece.track);
    VisibilityBuffer body;
    double sum = 0;
    for (size_t i = 0; i < piece.looked_at.size(); ++i) {
      const PersonSilhouette& silhouette = piece.silhouettes[i];
      const int t = piece.looked_at[i];
      body.Render(TrackVertices(*clothed_, piece.track, t), clothed_->data().faces, silhouette.camera());
      const VisibilityBuffer seen = SeeGarment(garment, cloth.At(t), silhouette.camera());
      sum += static_cast<double>(UnlikePixels(silhouette, body, seen)) / silhouette.area();
    }
    return sum;
  }

  const BodyModel& body_;
  const Track& track_;
  const int num_threads_;
  const PipelineCallbacks& callbacks_;
  const FitClothesOptions options_;
  std::vector<Piece> pieces_;
  LooseGarmentOptions begun_;
  std::vector<double> offsets_;
  std::optional<BodyModel> clothed_;
  Measures best_{};
  std::map<Measures, double> unlike_;
};

}  // namespace

ClipClothes FitClipClothes(const BodyModel& body, const Track& track, const std::vector<int>& frames,
                           const MaskOfFrame& mask_of, int num_threads, const PipelineCallbacks& callbacks) {
  return ClipClothesFit(body, track, num_threads, callbacks).Run(frames, mask_of);
}

}  // namespace bodyloom
