// SPDX-License-Identifier: Apache-2.0
/// Completes the texture of a person seen in photos: every unseen texel is guessed, and its source recorded
/// (TexelSource).
///
///   seen      confidence at least `trust` times the 90th percentile of all (low throughout for small people). On
///             hands, whose fitted fingers are often misplaced, only colours near the face's median, or near the hands'
///             own where less than a fifth is. Never under a loose garment, where mostly its hem is seen
///   mirror, behind, mirrored back    the colour at the counterpart (texel_counterparts.h) of highest confidence,
///             weighted 1, 0.7 and 0.5; a face is not used as a counterpart from behind, and colours are not exchanged
///             between a loose garment and the body
///   hair      unseen texels of the scalp: the median of its seen texels that differ from the face's median colour by
///             more than `hair_contrast`, or of all where fewer than a tenth do
///   limb neighbour    the nearest colour around the limb (texel_counterparts.h), on trunk and limbs; under a loose
///             garment the median colour of the shins seen below it
///   smooth fill       all others: smoothly from the surroundings (render/texture/complete/uv_fill.h)
///
/// Guesses g are blended with the seen surface and each other: the colours x of all unseen texels minimise, over the
/// graph of texels (UvGraph, render/texture/complete/uv_fill.h),
///   Σ_edges ((x_i − x_j) − (g_i − g_j))² + Σ_guessed (x_i − g_i)² / reach²
/// with g_i − g_j = 0 if one of the two is not guessed, they are guessed in different ways, or both around a limb
/// (extended lines blend). Edges are left out at boundaries between materials: between texels seen or guessed in
/// different ways that differ by more than `largest_step`, and between guesses around a limb that differ by more than
/// image noise. The screening is 16 times stronger for hair and 4 times weaker around a limb. Solved by at most a
/// hundred steps of conjugate gradients.
/// Source: Pérez, Gangnet, Blake, "Poisson Image Editing", 2003, with the screening of Bhat et al., 2008.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geometry/body/body_model.h"
#include "geometry/math/arrays.h"
#include "geometry/uv_maps/uv_texels.h"
#include "render/texture/body_regions.h"
#include "render/texture/texture_extract.h"

namespace bodyloom {

enum class TexelSource : uint8_t { kEmpty, kSeen, kMirror, kBehind, kMirroredBack, kHair, kLimbNeighbour, kSmoothFill };

struct WholeTextureOptions {
  double trust = 0.05;
  double hair_contrast = 0.12;  ///< colour difference, maximum over channels, 0 to 1
  double reach = 0.03;          ///< distance over which a step is blended, as a share of the texture's side
  double largest_step = 0.25;   ///< colour difference, maximum over channels
  double hand_contrast = 0.25;  ///< maximum difference of a hand's seen texels from its median colour
};

struct WholeTexture {
  std::vector<float> bgr;            ///< three planes, 0 to 1, including the gutter
  std::vector<TexelSource> sources;  ///< H·W; kEmpty off the atlas and in the gutter
};

/// `rest_vertices`: the body at rest, V×3 metres; `regions`: one per vertex. Throws std::invalid_argument when sizes do
/// not fit, std::runtime_error when no texel was seen.
WholeTexture MakeWholeTexture(const BodyModel& body, const UvTexelTable& table, const MatrixX3d& rest_vertices,
                              std::span<const BodyRegion> regions, const Texture& seen,
                              const WholeTextureOptions& options = {});

}  // namespace bodyloom
