// SPDX-License-Identifier: Apache-2.0
/// Learns a person of Gaussians from frames, one frame a step.
///
/// A step poses and draws the frame's Gaussians, compares them with the truth over a random colour
/// (render/gaussian_avatar/learning/picture_loss.h), goes back through all of it, adds what Gaussians cost
/// (avatar_trainer.h), and lets Adam (adam.h) move those that are in the picture, and the light. Scales are brought
/// within their limits, quaternions and normals back to unit length. Every `relocate_every` steps, up to relocate_until
/// of the training, dead Gaussians move to where derivatives on the screen are large (relocate_gaussians.h).
///
/// What is hidden in a frame learns nothing from it: Adam would make steps of full length out of the thousandth part of
/// a colour that comes through what lies in front, and the person's unseen sides would fill with noise. Hidden on the
/// skin or of cloth stays as it is; hidden and loose feels its cost alone, and so goes where no frame shows it. A
/// Gaussian counts as hidden when |d loss / d its colour|, summed over the channels, is below least_seen times what as
/// many pixels as it covers alone would give by their absolute difference (PictureLoss::ByPixel).
///
/// With a PoseRefiner the frame's pose is corrected too (pose_refiner.h), from refine_from of the training on, by the
/// derivatives of the same picture. Without learn_person the Gaussians and the light stay and the poses alone move.
///
/// With Watch() the loss of frames that are not learned from is taken now and then, and where more steps no longer help
/// them the training comes to its end (held_out_curve.h).
///
/// Frames come in a new random order each time round. All that is random follows from the seed and the step's number,
/// so a state that was kept goes on exactly as if training had never been left, as far as its length is given by steps:
/// the same bytes for any number of threads and any instruction set.
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
#include "render/gaussian_avatar/learning/held_out_curve.h"
#include "render/gaussian_avatar/learning/pose_refiner.h"
#include "render/gaussian_avatar/learning/relocate_gaussians.h"
#include "render/gaussian_avatar/learning/training_view.h"

namespace bodyloom {

// What Gaussians cost by being there: without it, those that no picture needs would stay.
// cost = (Σ_i (by_opacity + by_distance (1 − φ_i)) o_i + by_scale Σ_i Σ_k e^(s_ik)) / N,   scales in metres
// with φ_i the anchor's factor, 1 on the skin and 0 from 6 cm off it. Cloth has a place of its own and is opaque: its
// opacity costs nothing. The second term takes away what a clip in which the
// arms are never raised leaves between arm and trunk: in other poses it would float about as shreds.
// Source: Kheradmand et al., "3D Gaussian Splatting as Markov Chain Monte Carlo", NeurIPS 2024, section 4.3.

struct GaussianCost {
  float by_opacity = 1e-2F, by_scale = 1e-2F, by_distance = 0.3F;
};

/// Adds the derivatives to those of a loss (columns of GaussianBody::parameters); returns the cost. Throws
/// std::invalid_argument for a table of another size.
double AddGaussianCost(const GaussianBody& body, const GaussianCost& cost, FloatColumns* gradient);

// How far each number of a person of Gaussians moves in a step of training.

/// Adam's rates; those of a parameter that is to stay are 0. Places become finer in the course of training: theirs goes
/// exponentially from `position` to position · position_at_end. All other numbers of a Gaussian settle: after n steps,
/// at `progress` p, theirs are
///   rate · others_at_end^max(0, 2p − 1) / sqrt(1 + n/settle_steps)
/// Adam's steps are as long where a picture hardly says anything as where it says all, so what no picture asks for (a
/// normal in shade, the weights of skin that is seen in one pose) wanders: by rate · sqrt(n) at a rate that stays,
/// which other poses then show, by the root of the logarithm of n at this one.
struct AvatarRates {
  float position = 3e-4F, position_at_end = 0.03F;  ///< metres
  float quaternion = 4e-3F, log_scale = 6e-3F, opacity_logit = 3e-2F, albedo = 8e-3F, normal = 1e-2F;
  float weight_logit = 1e-2F;
  float others_at_end = 0.03F;  ///< above 0, at most 1
  float settle_steps = 3000;    ///< 1 to 1e9
  float light = 2e-3F;
  [[nodiscard]] bool IsValid(std::string* why) const;
  /// By column of GaussianBody::parameters, `progress` in [0, 1] of the training, `step` from 0 on.
  [[nodiscard]] std::array<float, GaussianBody::kNumParameters> At(double progress, int64_t step) const;
};

struct AvatarTrainerOptions {
  int64_t steps = 6000;  ///< 1 to 1e8
  /// Above 0: training also ends after so long, and rates follow the larger of both shares. What comes out then depends
  /// on the machine.
  double seconds = 0;
  uint64_t seed = 1;
  AvatarRates rates;
  GaussianCost cost;
  ScaleLimits scales;
  int relocate_every = 200;     ///< steps; 0: never
  double relocate_until = 0.9;  ///< of the training
  float dead_opacity = 0.015F;
  /// A Gaussian of which a frame shows a smaller share is hidden there (see above). 0: none is.
  double least_seen = 0.1;
  double refine_from = 0.15;  ///< of the training: before, poses stay as the corrections are
  bool learn_person = true;
  HeldOutOptions held_out;
  int num_threads = 1;  ///< 1 to 1024
  [[nodiscard]] bool IsValid(std::string* why) const;
};

/// The person at one moment of a training.
struct KeptAvatar {
  GaussianBody body;
  int64_t step = 0;  ///< steps done
  double loss = 0;   ///< of the frames held out
};

/// All that goes on.
struct AvatarTrainingState {
  GaussianBody body;
  AdamState adam;           ///< of body.parameters
  AdamState light_adam;     ///< of body.light, a row a coefficient
  std::vector<float> pull;  ///< by row: sum since the last move of |d loss / d mean on the screen|
  PoseCorrections poses;    ///< of every frame of the clip; without rows: none are refined
  HeldOutCurve held_out;
  std::optional<KeptAvatar> kept;  ///< whose loss of the frames held out was least, where they were judged
  int64_t step = 0;                ///< steps done
  double seconds = 0;              ///< spent in steps and in judging frames held out

  /// Before the first step.
  static AvatarTrainingState Of(GaussianBody body);
  /// What the training leaves: what was kept, else the person as it is.
  [[nodiscard]] const GaussianBody& ResultBody() const { return kept ? kept->body : body; }
};

struct AvatarStep {
  double loss = 0;  ///< of the picture; not finite: nothing was moved
  double cost = 0;
  int view = 0;
  int drawn = 0;  ///< Gaussians in the picture
  int relocated = 0;
};

class AvatarTrainer {
 public:
  /// Views without a person are left out. Throws std::invalid_argument when options are not valid or no view is left.
  /// `faces`, `views` and `refiner` (null: poses stay) must outlive it.
  AvatarTrainer(const MatrixX3i& faces, std::span<const TrainingView> views, const AvatarTrainerOptions& options,
                const PoseRefiner* refiner = nullptr);

  /// From now on the training is judged by these frames as well, which must outlive it; those without a person are
  /// left out.
  void Watch(std::span<const TrainingView> held_out);

  /// Done so far, in [0, 1].
  [[nodiscard]] double Progress(const AvatarTrainingState& state) const;
  [[nodiscard]] bool IsDone(const AvatarTrainingState& state) const { return Progress(state) >= 1; }

  /// One step. Throws std::invalid_argument when the state's tables do not fit each other or the faces.
  AvatarStep Step(AvatarTrainingState* state);

  /// Where the time of all steps went: drawing, loss, derivatives, moving.
  [[nodiscard]] const StageSeconds& stage_seconds() const { return clock_.seconds(); }

 private:
  int ViewAt(int64_t step);
  /// The view's frame in the corrected pose, in the cloth of the run whose turn it is.
  const AvatarFrame& FrameOf(const TrainingView& view, const AvatarTrainingState& state);
  void MovePose(const TrainingView& view, double progress, AvatarTrainingState* state) const;
  void LearnPerson(double progress, AvatarTrainingState* state, AvatarStep* done);
  int ChooseMovers(AvatarTrainingState* state);
  void Move(AvatarTrainingState* state, double progress);
  void MoveLight(AvatarTrainingState* state);
  int Relocate(AvatarTrainingState* state, double progress);
  /// Poses and draws the view with all that the state has learned.
  AvatarView Draw(const TrainingView& view, const AvatarFrame& frame, const AvatarTrainingState& state);
  void JudgeHeldOut(AvatarTrainingState* state);

  const MatrixX3i& faces_;
  std::span<const TrainingView> views_;
  std::vector<int> usable_, order_;
  std::vector<const TrainingView*> held_out_;
  int64_t order_of_ = -1;  ///< which time round
  AvatarTrainerOptions options_;
  const PoseRefiner* refiner_;
  AvatarFrame in_other_cloth_, corrected_;
  AvatarPainter painter_;
  PictureLoss loss_;
  PictureTruth truth_;
  FloatColumns by_planes_;
  AvatarGradient gradient_;
  std::vector<uint8_t> moves_;
  StageClock clock_;
};

}  // namespace bodyloom
