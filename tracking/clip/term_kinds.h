// SPDX-License-Identifier: Apache-2.0
/// List of the tracker's terms, to which a new term is added.
///
/// Cost of a frame, in the order in which terms are summed; each formula is explained in the term's header:
///   ½ Σ ρ(‖(π(x_k) − y_k)/σ_k‖²)              2D joints (terms/landmarks.h), L_f of paper A
/// + ½ Σ ρ(‖W_k (π(x_k) − y_k)‖²)              dense keypoints (terms/dense/dense.h), L_f
/// + ½ λ_r Σ ρ(‖r_uv‖²)                        dense keypoints in UV (terms/rendered_uv/rendered_uv_term.h), L_r
/// + ½ Σ w ρ(‖r‖²)                             silhouette, part labels (terms/part_labels/part_label_term.h)
/// + ½ λ_d Σ ρ(‖W (x − x_hips − y)‖²)          the lifter (terms/lifted/lifted_pose.h), L_d
/// + ½ Σ ρ(‖W (x − a)‖²)                       standing feet (terms/ground_contact/ground_contact.h)
/// + ½ w min_k (‖L_k (x − μ_k)‖² + e_k)        pose prior (terms/pose_prior/pose_prior.h)
/// + ½ Σ (excess over joint limits / σ)²       joint limits (terms/joint_limits.h)
/// + ½ w ρ((n·u)² / σ²)                        upright trunk (terms/upright.h)
/// + ½ w² Σ ρ(θ²)                              straight knees (terms/straight_knees.h)
/// + ½ λ_d (‖log(R̄ᵀR)‖²/σ_R² + ‖t − t̄‖²/σ_t²)  initialiser (terms/initialiser.h), L_d
/// + ½ Σ ρ(‖r‖²)                               a user's own (tracking/problem/user_term.h)
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "tracking/problem/clip_term.h"

namespace bodyloom {

struct PlanEntry;

struct TermKind {
  /// True if the term runs, with the reason; one entry for each part that is switched separately.
  std::vector<PlanEntry> (*plan)(const TrackSequenceInput&, const TrackSequenceOptions&);
  /// Makes the term; null if the clip does not need it.
  std::unique_ptr<ClipTerm> (*make)(const ClipTermInput&);
};

std::span<const TermKind> TermKinds();

}  // namespace bodyloom
