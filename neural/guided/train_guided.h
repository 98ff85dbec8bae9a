// SPDX-License-Identifier: Apache-2.0
/// Trains the pose-guided renderer on pictures of many people.
///
///   L_Sil = mean |S − S_true|,   L_Gar = cross entropy of the labels (or the paper's mean |G − G_true|),
///   L_Render = L1 + λ_1 L_VGG + λ_2 L_CX + λ_3 L_cAdv + λ_4 L_KL        (Yoon et al., CVPR 2021, Section 3.1)
/// L_VGG: mean absolute differences of VGG-16's conv 1-2, 2-2, 3-2 and 4-2; L_CX: contextual loss on conv 3-2; L_cAdv:
/// a patch discriminator's judgement beside the true labels; L_KL: a number of the code's share of the divergence. The
/// λ come from loss_balance.h: in the first `balance_steps` steps RenderNet learns by L1 alone. Without SilNet and
/// GarNet the silhouette that RenderNet draws itself learns by L1 too.
///
/// The three networks learn side by side, each from true inputs (guided_batches.h says what is hidden of the target),
/// which is the same as one after the other; from share `predicted_from` of the steps on RenderNet sees the silhouette
/// and the labels that the other two predict, as it will at work.
///
/// Writes into run_dir: checkpoint.bin and metrics.csv. A run that goes on from a checkpoint ends with the same bytes
/// as one that was never interrupted (same binary, machine and threads).
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "neural/guided/coherent_maps.h"
#include "neural/guided/guided_config.h"
#include "neural/metrics/person_scores.h"
#include "neural/networks/named_weights.h"
#include "neural/training/training_run.h"
#include "render/texture/photo_frame.h"

namespace bodyloom {

/// One validated picture: what was known, what was made of it, and the truth.
struct GuidedPreview {
  int person = 0, frame = 0;
  PhotoFrame source, truth;
  PseudoPicture pseudo;
  PersonPicture picture;
};

struct TrainGuidedOptions : TrainingRun {
  GuidedConfig config;
  PhotoSource validation;  ///< people who are not trained on; nobody: no validation
  /// The six virtual views of a person's body (complete_maps.h); without it validation warps the source as it is.
  std::function<std::vector<PhotoFrame>(int person)> validation_views;
  int validation_people = 8, validation_frames = 4;  ///< at most; frames beside the photo (choose_photos.h)
  int batch = 8;
  double learning_rate = 2e-4, discriminator_rate = 2e-4;  ///< falling to 0 over the last half
  bool labels_by_cross_entropy = true;
  int balance_steps = 200;
  double perceptual_share = 1, contextual_share = 1, gan_share = 1;  ///< of the balanced λ
  /// At its balanced weight the divergence is driven to 0 within 300 steps and the code holds nothing of the source.
  double kl_share = 0.01;
  double predicted_from = 2.0 / 3;  ///< 1: never
  int reach = 0;      ///< pixels that clothes reach beyond the body (0: not known, validates on whole windows)
  WeightsFrom vgg16;  ///< empty: a seeded random-feature substitute
  LikenessWeights score_weights;  ///< of the last validation
  std::function<void(int step, const std::vector<GuidedPreview>&)> preview;
  [[nodiscard]] bool IsValid(std::string* why) const;
};

struct TrainGuidedSummary : RendererTraining {
  PersonScores scores;
  std::vector<double> loss_weights;  ///< λ of VGG, contextual, adversarial, KL; empty while they are not set
};

/// Throws std::invalid_argument for options that are not valid, std::runtime_error for files that cannot be used.
TrainGuidedSummary TrainGuided(const PhotoSource& people, const TrainGuidedOptions& options);

}  // namespace bodyloom
