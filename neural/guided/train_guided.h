// SPDX-License-Identifier: Apache-2.0
/// Trains the pose-guided renderer on images of many people.
///
///   L_Sil = mean |S − S_true|,   L_Gar = cross entropy of the labels (or the paper's mean |G − G_true|),
///   L_Render = L1 + λ_1 L_VGG + λ_2 L_CX + λ_3 L_cAdv + λ_4 L_KL        (Yoon et al., CVPR 2021, Section 3.1)
/// L_VGG: mean absolute differences of VGG-16's conv 1-2, 2-2, 3-2 and 4-2; L_CX: contextual loss on conv 3-2; L_cAdv:
/// the loss of a patch discriminator conditioned on the true labels; L_KL: the divergence per element of the code. The
/// λ come from image_losses.h: in the first `balance_steps` steps RenderNet is trained by L1 alone. Without SilNet and
/// GarNet the silhouette of RenderNet is trained by L1 too.
///
/// The three networks are trained simultaneously, each on true inputs (masking of the target: guided_batches.h), which
/// is equivalent to one after the other; from share `predicted_from` of the steps on RenderNet uses the silhouette and
/// labels predicted by the other two, as in inference.
///
/// Writes into run_dir: checkpoint.bin and metrics.csv. A run resumed from a checkpoint ends with the same bytes as an
/// uninterrupted one (same binary, machine and threads).
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

/// One validated image: inputs, result and truth.
struct GuidedPreview {
  int person = 0, frame = 0;
  PhotoFrame source, truth;
  PseudoImage pseudo;
  RenderedPerson rendered;
};

struct TrainGuidedOptions : TrainingRun {
  GuidedConfig config;
  PhotoSource validation;  ///< people not in the training set; without people: no validation
  /// The six virtual views of a person's body (complete_maps.h); without them validation only warps the source.
  std::function<std::vector<PhotoFrame>(int person)> validation_views;
  int validation_people = 8, validation_frames = 4;  ///< maximum numbers; frames besides the photo (choose_photos.h)
  int batch = 8;
  double learning_rate = 2e-4, discriminator_rate = 2e-4;  ///< decaying to 0 over the last half
  bool labels_by_cross_entropy = true;
  int balance_steps = 200;
  double perceptual_share = 1, contextual_share = 1, gan_share = 1;  ///< factors of the balanced λ
  /// At the balanced weight the divergence vanishes within 300 steps and the code carries no information.
  double kl_share = 0.01;
  double predicted_from = 2.0 / 3;  ///< 1: never
  int reach = 0;      ///< reach of clothes beyond the body, pixels (0: not known, validates on whole windows)
  WeightsFrom vgg16;  ///< empty: a seeded random-feature substitute
  LikenessWeights score_weights;  ///< of the last validation
  std::function<void(int step, const std::vector<GuidedPreview>&)> preview;
  [[nodiscard]] bool IsValid(std::string* why) const;
};

struct TrainGuidedSummary : RendererTraining {
  PersonScores scores;
  std::vector<double> loss_weights;  ///< λ of VGG, contextual, adversarial, KL; empty until they are set
};

/// Throws std::invalid_argument for options that are not valid, std::runtime_error for files that cannot be used.
TrainGuidedSummary TrainGuided(const PhotoSource& people, const TrainGuidedOptions& options);

}  // namespace bodyloom
