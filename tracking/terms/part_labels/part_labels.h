// SPDX-License-Identifier: Apache-2.0
/// The terms of silhouette and part labels over a clip (residuals: part_label_term.h), and the rounds in which their
/// correspondences are found.
///
/// Correspondences are found at the start of a round and fixed during its solve; the kernel narrows from round to round
/// (PartLabelOptions::start_kernel to kernel). Runs when the input has labels or masks; parts only for a body with
/// charts.
///
/// Masks beside 2D joints are used in the coarse frames only, as outlines of frames that are closer say the same
/// (docs/lab/run_speed.md); each counts for all the frames from one to the next.
///
/// The matches of a frame take 100 KB. In a clip that is solved in windows (ClipTerm::BeginRounds()) a round notes the
/// states at which it starts, a frame's matches are computed when they are asked for, and of more than kKeptMatches
/// those that were computed first are forgotten: the same bits, and few are computed twice. Where few frames of a
/// window have masks fewer are kept.
#pragma once

#include <array>
#include <deque>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "tracking/problem/clip_term.h"
#include "tracking/terms/part_labels/part_label_term.h"

namespace bodyloom {

struct PlanEntry;
struct TrackSequenceInput;
struct TrackSequenceOptions;

/// The reason why a term does not run; empty if it does.
std::string WhyNoSilhouette(const TrackSequenceInput& input, const TrackSequenceOptions& options);
std::string WhyNoParts(const TrackSequenceInput& input, const TrackSequenceOptions& options);
std::vector<PlanEntry> PlanPartLabels(const TrackSequenceInput& input, const TrackSequenceOptions& options);
std::unique_ptr<ClipTerm> MakePartLabelRounds(const ClipTermInput& clip);

/// Number of frames whose matches are kept where all have masks: a window of the solve and a tenth.
inline constexpr size_t kKeptMatches = 1100;

/// Matches in the order in which they were computed.
class KeptMatches {
 public:
  explicit KeptMatches(size_t capacity) : capacity_(capacity) {}
  void SetCapacity(size_t capacity);
  /// Null: they were forgotten.
  std::shared_ptr<PartLabelMatches> Find(const std::shared_ptr<PartLabelMatches>& slot);
  /// Puts them into the slot of their frame, and empties those of the first computed ones that are too many.
  void Add(std::shared_ptr<PartLabelMatches> matches, std::shared_ptr<PartLabelMatches>* slot);

 private:
  /// Takes the surplus out of their slots; called with the lock, freed by the caller without it.
  std::vector<std::shared_ptr<PartLabelMatches>> Forget();

  size_t capacity_;
  std::mutex mutex_;
  std::deque<std::shared_ptr<PartLabelMatches>*> slots_;
};

/// A frame with labels, and its matches of the current round.
class LabelledFrame : public PartLabelSource {
 public:
  /// The start of a round (PartLabelMatches::Correspond()).
  struct Round {
    FrameState state;
    Eigen::VectorXd betas;
    double log_focal = 0, person_height_px = 0, kernel = 4, weight = 1;
  };
  /// All are borrowed but the skinner.
  LabelledFrame(const PartLabelSequence& labels, int t, std::shared_ptr<const Skinner> skinner,
                const PartLabelOptions& options, KeptMatches* kept)
      : labels_(labels), t_(t), skinner_(std::move(skinner)), options_(options), kept_(*kept) {}

  /// `later`: their matches are computed when they are asked for; of masks only.
  void StartRound(const FrameLayout& layout, Round round, bool later);
  [[nodiscard]] int num_rows(bool of_silhouette) const override { return num_rows_[of_silhouette]; }
  [[nodiscard]] int num_person_pixels() const override { return num_person_pixels_; }
  [[nodiscard]] std::shared_ptr<const PartLabelMatches> Get(const FrameLayout& layout) const override;

 private:
  void Correspond(const FrameLayout& layout, PartLabelMatches* matches) const;

  const PartLabelSequence& labels_;
  int t_;
  std::shared_ptr<const Skinner> skinner_;
  const PartLabelOptions& options_;
  KeptMatches& kept_;
  Round round_;
  mutable std::shared_ptr<PartLabelMatches> matches_;
  mutable std::array<int, 2> num_rows_ = {0, 0};
  mutable int num_person_pixels_ = 0;
};

class PartLabelRounds : public ClipTerm {
 public:
  /// `max_kept`: number of frames whose matches are kept.
  explicit PartLabelRounds(const ClipTermInput& clip, size_t max_kept = kKeptMatches);

  void Observe(SequenceProblem* problem) override;
  [[nodiscard]] std::vector<char> SparseFrames() const override;
  [[nodiscard]] Rounds rounds() const override { return {options_.rounds, options_.max_iterations, "fit part labels"}; }
  void BeginRounds(const std::vector<int>& coarse_frames, bool in_windows) override;
  void StartRound(int round, const std::vector<int>& frames, SequenceProblem* problem) override;

 private:
  /// The largest number of frames with masks in a window of the solve.
  [[nodiscard]] size_t MostUsedInWindow(const std::vector<int>& frames) const;

  const PartLabelSequence& labels_;
  PartLabelOptions options_;
  std::shared_ptr<const Skinner> skinner_;
  int num_threads_;
  double stature_m_;
  bool is_thinned_;            ///< the coarse frames only
  std::vector<char> is_used_;  ///< T; empty before the first round
  double weight_ = 1;
  bool later_ = false;  ///< matches are computed when they are asked for
  size_t max_kept_;
  KeptMatches kept_;
  std::vector<std::unique_ptr<LabelledFrame>> frames_;  ///< T; null in frames that are not used
};

}  // namespace bodyloom
