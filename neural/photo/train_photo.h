// SPDX-License-Identifier: Apache-2.0
/// Trains the one-photo renderer on pairs of images of the same person.
///
///   L_G = 10 L_p + 5 L_face + L_tex + L_adv + L_α       (Sarkar et al., ECCV 2020, Section 3.5)
/// L_p: mean absolute differences of VGG-19's features relu1_1, 2_1, 3_1, 4_1, 5_1, unweighted; L_face, L_tex:
/// neural/photo/photo_batch.h, for heads facing the camera; L_adv: binary cross entropy of a multi-scale discriminator
/// conditioned on the feature image R (without gradient through it), used and updated in every step from `gan_from` on;
/// L_α, not in the paper: binary cross entropy of alpha against the labels' foreground. Adam 2e-4, β₁ 0.5, linear decay
/// over the last half, for generator and discriminator.
///
/// The variant kInpaint trains FeatureNet by L_tex alone for `inpaint_steps` steps, then fixes it and trains RenderNet
/// for `steps` steps; steps are numbered across both stages.
///
/// Without VGG's weights a random-feature substitute is used; without SphereFace's L_face is left out (listed in
/// `losses_off`). Writes into run_dir: checkpoint.bin and metrics.csv. A run resumed from a checkpoint ends with the
/// same bytes as an uninterrupted one (same binary, machine and threads).
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "neural/metrics/person_scores.h"
#include "neural/networks/named_weights.h"
#include "neural/photo/photo_config.h"
#include "neural/training/photo_partner.h"
#include "neural/training/training_run.h"
#include "render/texture/photo_frame.h"

namespace bodyloom {

/// A validated pair.
struct PhotoPreview {
  PhotoPair pair;
  PhotoFrame source, target;
  RenderedPerson rendered;
  std::vector<float> partial_texture, completed_texture;  ///< planar 3 × U × U in [0, 1]
};

struct TrainPhotoOptions : TrainingRun {
  PhotoConfig config;
  std::vector<int> train, validation;              ///< persons; validation may be empty
  const PhotoSource* validation_source = nullptr;  ///< source of the persons in `validation`; nullptr: the same
  int validation_pairs = 2;                        ///< per person, the same in every run
  int inpaint_steps = 0;                           ///< steps of kInpaint's first stage; 0: as many as `steps`
  int batch = 4;
  double learning_rate = 2e-4;
  double perceptual_weight = 10, face_weight = 5, texture_weight = 1, gan_weight = 1, alpha_weight = 1;
  /// Share of `steps` after which the discriminator is used: 0: from the first step, as in the paper; 1: never. From an
  /// untrained start it worsens all figures for hundreds of steps, from which a short run does not recover.
  double gan_from = 0.5;
  int reach = 0;                     ///< of clothes beyond the body, pixels (neural/photo/photo_window.h)
  WeightsFrom vgg19;                 ///< empty: a seeded random-feature substitute
  WeightsFrom sphereface;            ///< empty: no face loss
  WeightsFrom alexnet, lpips_heads;  ///< empty: validation's LPIPS is a random-feature substitute
  ImageSimilarity ssim;              ///< of validation; may be empty
  int preview_pairs = 4;
  std::function<void(int step, const std::vector<PhotoPreview>&)> preview;

  /// Number of steps of both stages.
  [[nodiscard]] int TotalSteps() const;
  /// The first step (over both stages, from 0) that uses the discriminator; TotalSteps() if none does.
  [[nodiscard]] int FirstJudgedStep() const;
  [[nodiscard]] bool IsValid(std::string* why) const;
};

struct TrainPhotoSummary : RendererTraining {
  PersonScores scores;
};

/// Throws std::invalid_argument for options that are not valid or do not fit the source, std::runtime_error for files
/// that cannot be used.
TrainPhotoSummary TrainPhoto(const PhotoSource& source, const TrainPhotoOptions& options);

}  // namespace bodyloom
