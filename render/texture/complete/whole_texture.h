// SPDX-License-Identifier: Apache-2.0
/// A whole texture from what photos show of a person: every texel that was not seen is guessed, and says from what.
///
///   seen     confidence at least `trust` times the 90th percentile of all (a small person's is low everywhere): kept.
///   Of hands, whose fingers are seldom where a fit has them, only
///            what is near the face's median colour, or, where less than a fifth is, the hands' own. Nothing
///            of what a loose garment hides: beside its hem the hem is seen more often
///   mirror, behind, across    the colour at its counterpart (texel_counterparts.h), the counterpart that was seen best
///            after the preferences 1, 0.7 and 0.5; a face is nobody's counterpart from behind, and a loose garment
///            lends nothing to the body nor the body to it
///   hair     of the scalp, not seen: the hair's colour, the median of the seen texels of the scalp that are further
///   from
///            the face's median colour than `hair_contrast`; of all seen texels of the scalp where fewer than a tenth
///            are
///   around, too: of what a loose garment hides, the median colour of the shins that are seen below it
///   around   the nearest colour around the limb (texel_counterparts.h), on the trunk and the limbs
///   spread   what is left: smoothly from its surroundings (render/texture/complete/uv_fill.h)
///
/// Guesses g meet the seen surface, and each other, without a step: the colours x of all texels that were not seen
/// minimise, over the graph of texels (render/texture/complete/uv_fill.h),
///   Σ_edges ((x_i − x_j) − (g_i − g_j))² + Σ_guessed (x_i − g_i)² / reach²
/// with g_i − g_j taken as 0 where one of the two is not guessed, or in another way, or around a limb (lines that were
/// carried run into each other). Two texels that were seen or guessed in different ways and differ by more than
/// `largest_step` are where one thing ends: their edge is left out; so is that of two guesses around a limb which
/// differ by more than a picture's noise. Hair is held 16 times as firmly, what is around a limb a quarter as firmly.
/// Solved by conjugate gradients, a hundred steps at most.
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

enum class TexelSource : uint8_t { kNowhere, kSeen, kMirror, kBehind, kAcross, kHair, kAround, kSpread };

struct WholeTextureOptions {
  double trust = 0.05;
  double hair_contrast = 0.12;  ///< of colours, largest channel, 0 to 1
  double reach = 0.03;          ///< how far a step is spread over guesses, as a share of the texture's side
  double largest_step = 0.25;   ///< of colours, largest channel
  double hand_contrast = 0.25;  ///< seen texels of a hand further from the hand's median colour are not trusted
};

struct WholeTexture {
  std::vector<float> bgr;            ///< three planes, 0 to 1; the gutter too
  std::vector<TexelSource> sources;  ///< H·W; kNowhere where the atlas is empty, and in the gutter
};

/// `rest_vertices`: the body at rest, V×3 metres; `regions`: one a vertex. Throws std::invalid_argument when sizes do
/// not fit, std::runtime_error when no texel was seen.
WholeTexture MakeWholeTexture(const BodyModel& body, const UvTexelTable& table, const MatrixX3d& rest_vertices,
                              std::span<const BodyRegion> regions, const Texture& seen,
                              const WholeTextureOptions& options = {});

}  // namespace bodyloom
