// SPDX-License-Identifier: Apache-2.0
/// What each texel of a person made from photos shows: the labels of the photos, carried to what no photo shows.
///
/// A vertex has the label that most seen texels have of which it is the nearest corner; a vertex without any that of
/// the nearest vertex with one, by (|x| − |x'|)² + (y − y')² + (z − z')²/10 at rest (T-pose): the other side and the
/// back of a limb or of the trunk at the same height. Off the head nothing is hair or face. Of the scalp what is not
/// seen is hair where hair is seen anywhere. A seen texel keeps its label where one of its face's corners has it, else
/// it takes its nearest corner's, as all others do. A loose garment's texels are "bottom" where none of it is seen.
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

/// The labels (PersonLabel) of one photo, one a pixel.
struct PhotoLabels {
  int width = 0, height = 0;
  std::vector<uint8_t> labels;
};

/// One a texel of the texture, row by row; 0 where the atlas is empty. `photos`: by Texture::source_frame.
/// `rest_vertices`: V×3, metres; `regions`: one a vertex. Throws std::invalid_argument when sizes do not fit.
std::vector<uint8_t> TexelLabels(const BodyModel& body, const UvTexelTable& table, const MatrixX3d& rest_vertices,
                                 std::span<const BodyRegion> regions, const Texture& seen,
                                 std::span<const PhotoLabels> photos);

}  // namespace bodyloom
