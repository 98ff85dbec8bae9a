// SPDX-License-Identifier: Apache-2.0
/// Trains a person of Gaussians on frames, one frame per step.
///
/// A step poses and renders the frame's Gaussians, computes the loss to the truth over a random background colour
/// (render/gaussian_avatar/learning/image_loss.h), backpropagates, adds the regularisation (GaussianCost), and updates
/// visible Gaussians and the light by Adam (adam.h). Scales are clamped to their limits, quaternions and normals
/// normalised. Every `relocate_every` steps, up to relocate_until of the training, dead Gaussians are relocated to
/// where derivatives on the screen are large (RelocateGaussians()).
///
/// Gaussians hidden in a frame are not updated by its loss: Adam would turn tiny derivatives, transmitted through
/// surfaces in front, into full steps and fill unseen sides with noise. Hidden Gaussians of skin and cloth stay; hidden
/// loose ones get the regularisation alone, so that those never seen fade. A Gaussian is hidden if |d loss / d colour|,
/// summed over the channels, is below min_seen times the value of an unoccluded one from the absolute differences of
/// its pixels (ImageLoss::ByPixel).
///
/// With a PoseRefiner the frame's pose is refined too (pose_refiner.h), from refine_from of the training on, by the
/// derivatives of the same image. Without learn_person Gaussians and light are fixed and only poses are refined.
///
/// With SetValidationViews() the loss of held-out frames is evaluated periodically, and training stops early when it no
/// longer improves (early_stopping.h).
///
/// Frames are shuffled every epoch. Random numbers depend only on the seed and the step, so training resumed from a
/// saved state gives the same bytes as without interruption (if its length is given in steps), for any number of
/// threads and any instruction set.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "geometry/base/stopwatch.h"
#include "render/gaussian_avatar/avatar_painter.h"
#include "render/gaussian_avatar/gaussian_body.h"
#include "render/gaussian_avatar/learning/adam.h"
#include "render/gaussian_avatar/learning/early_stopping.h"
#include "render/gaussian_avatar/learning/pose_refiner.h"
#include "render/gaussian_avatar/learning/training_view.h"

namespace bodyloom {

// Relocates invisible Gaussians to where the image is wrong. Their number, and hence the rendering time, stays.
//
// A Gaussian with opacity below `dead_opacity` becomes a copy of another, sampled with probability proportional to
// `pull`, at a position sampled from that one's distribution. Original and copy get the opacity 1 − sqrt(1 − o), so
// that together they have the former opacity, and 0.8 times the size.

struct RelocateOptions {
  float dead_opacity = 0.015F;
  uint64_t seed = 1;
};

/// Returns the relocated rows, ascending; none without pull (all 0, or not finite). `pull`: by row; negative values and
/// those not finite count as 0. Deterministic. Throws std::invalid_argument unless there is one pull per row.
std::vector<int> RelocateGaussians(std::span<const float> pull, const RelocateOptions& options, GaussianBody* body);

// Regularisation that removes Gaussians which no image needs:
//   cost = (Σ_i (by_opacity + by_distance (1 − φ_i)) o_i + by_scale Σ_i Σ_k e^(s_ik)) / N,   scales in metres
// with φ_i the anchor's factor, 1 on the skin and 0 from 6 cm off it. There is no opacity cost for cloth, which is
// opaque with a known position. by_distance removes floaters between arm and trunk, which a clip in which the arms are
// never raised leaves and other poses reveal.
// Source: Kheradmand et al., "3D Gaussian Splatting as Markov Chain Monte Carlo", NeurIPS 2024, section 4.3.

struct GaussianCost {
  float by_opacity = 1e-2F, by_scale = 1e-2F, by_distance = 0.3F;
};

/// Adds the derivatives to those of a loss (columns of GaussianBody::parameters); returns the cost. Throws
/// std::invalid_argument for a table of another size.
double AddGaussianCost(const GaussianBody& body, const GaussianCost& cost, FloatColumns* gradient);

/// Adam's learning rates; 0 fixes a parameter. The rate of positions decays exponentially from `position` to position ·
/// position_at_end. Those of all other parameters of a Gaussian are, after n steps at `progress` p,
///   rate · others_at_end^max(0, 2p − 1) / sqrt(1 + n/settle_steps)
/// Adam's steps do not shrink with the derivatives, so poorly observed parameters (a normal in shade, weights of skin
/// seen in one pose) perform a random walk: of size rate · sqrt(n) at a constant rate, which other poses reveal, but
/// sqrt(log n) with this decay.
struct AvatarRates {
  float position = 3e-4F, position_at_end = 0.03F;  ///< metres
  float quaternion = 4e-3F, log_scale = 6e-3F, opacity_logit = 3e-2F, albedo = 8e-3F, normal = 1e-2F;
  float weight_logit = 1e-2F;
  float others_at_end = 0.03F;  ///< above 0, at most 1
  float settle_steps = 3000;    ///< 1 to 1e9
  float light = 2e-3F;
  [[nodiscard]] bool IsValid(std::string* why) const;
  /// Rates by column of GaussianBody::parameters, `progress` in [0, 1] of the training, `step` from 0.
  [[nodiscard]] std::array<float, GaussianBody::kNumParameters> At(double progress, int64_t step) const;
};

struct AvatarTrainerOptions {
  int64_t steps = 6000;  ///< 1 to 1e8
  /// Above 0: time limit; progress is then the larger of the shares of steps and time, and results depend on the
  /// machine.
  double seconds = 0;
  uint64_t seed = 1;
  AvatarRates rates;
  GaussianCost cost;
  ScaleLimits scales;
  int relocate_every = 200;     ///< steps; 0: never
  double relocate_until = 0.9;  ///< of the training
  float dead_opacity = 0.015F;
  /// Gaussians with a smaller visible share are hidden in a frame (see above). 0: none are.
  double min_seen = 0.1;
  double refine_from = 0.15;  ///< share of the training before which pose corrections stay fixed
  bool learn_person = true;
  EarlyStoppingOptions held_out;
  int num_threads = 1;  ///< 1 to 1024
  [[nodiscard]] bool IsValid(std::string* why) const;
};

/// Snapshot of the person during training.
struct KeptAvatar {
  GaussianBody body;
  int64_t step = 0;  ///< steps done
  double loss = 0;   ///< of the frames held out
};

/// Complete state of a training, for resuming it.
struct AvatarTrainingState {
  GaussianBody body;
  AdamState adam;           ///< of body.parameters
  AdamState light_adam;     ///< of body.light, one row per coefficient
  std::vector<float> pull;  ///< by row: sum of |d loss / d mean on the screen| since the last relocation
  PoseCorrections poses;    ///< of every frame of the clip; no rows: none are refined
  EarlyStopping held_out;
  std::optional<KeptAvatar> kept;  ///< with the minimum held-out loss, if evaluated
  int64_t step = 0;                ///< steps done
  double seconds = 0;              ///< spent in steps and in validation

  /// Initial state.
  static AvatarTrainingState Of(GaussianBody body);
  /// Result of the training: the snapshot if there is one, else the current person.
  [[nodiscard]] const GaussianBody& ResultBody() const { return kept ? kept->body : body; }
};

struct AvatarStep {
  double loss = 0;  ///< of the image; not finite: nothing was updated
  double cost = 0;
  int view = 0;
  int drawn = 0;  ///< Gaussians in the image
  int relocated = 0;
};

class AvatarTrainer {
 public:
  /// Ignores views without a person. Throws std::invalid_argument when options are not valid or no view is left.
  /// `faces`, `views` and `refiner` (null: poses stay) must outlive it.
  AvatarTrainer(const MatrixX3i& faces, std::span<const TrainingView> views, const AvatarTrainerOptions& options,
                const PoseRefiner* refiner = nullptr);

  /// Sets held-out frames for validation, which must outlive this; those without a person are ignored.
  void SetValidationViews(std::span<const TrainingView> held_out);

  /// Progress of the training in [0, 1].
  [[nodiscard]] double Progress(const AvatarTrainingState& state) const;
  [[nodiscard]] bool IsDone(const AvatarTrainingState& state) const { return Progress(state) >= 1; }

  /// Performs one step. Throws std::invalid_argument when the state's tables do not fit each other or the faces.
  AvatarStep Step(AvatarTrainingState* state);

  /// Seconds of all steps by stage: drawing, loss, derivatives, moving.
  [[nodiscard]] const StageSeconds& stage_seconds() const { return clock_.seconds(); }

 private:
  int ViewAt(int64_t step);
  /// The view's frame in the corrected pose, with the cloth of the current simulation run.
  const AvatarFrame& FrameOf(const TrainingView& view, const AvatarTrainingState& state);
  void MovePose(const TrainingView& view, double progress, AvatarTrainingState* state) const;
  void LearnPerson(double progress, AvatarTrainingState* state, AvatarStep* done);
  int ChooseMovers(AvatarTrainingState* state);
  void Move(AvatarTrainingState* state, double progress);
  void MoveLight(AvatarTrainingState* state);
  int Relocate(AvatarTrainingState* state, double progress);
  /// Poses and draws the view with the current state.
  AvatarView Draw(const TrainingView& view, const AvatarFrame& frame, const AvatarTrainingState& state);
  void Validate(AvatarTrainingState* state);

  const MatrixX3i& faces_;
  std::span<const TrainingView> views_;
  std::vector<int> usable_, order_;
  std::vector<const TrainingView*> held_out_;
  int64_t order_of_ = -1;  ///< current epoch
  AvatarTrainerOptions options_;
  const PoseRefiner* refiner_;
  AvatarFrame in_other_cloth_, corrected_;
  AvatarPainter painter_;
  ImageLoss loss_;
  ImageTruth truth_;
  FloatColumns by_planes_;
  AvatarGradient gradient_;
  std::vector<uint8_t> moves_;
  StageClock clock_;
};

}  // namespace bodyloom
