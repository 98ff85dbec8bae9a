// SPDX-License-Identifier: Apache-2.0
/// Labels of all texels of a person made from photos, propagated from the photos' labels to unseen texels.
///
/// A vertex takes the most frequent label of the seen texels of which it is the nearest corner; a vertex without any
/// takes that of the nearest labelled vertex by (|x| − |x'|)² + (y − y')² + (z − z')²/10 at rest (T-pose): the other
/// side, or the back, of a limb or the trunk at the same height. Hair and face occur on the head only. Unseen texels of
/// the scalp are hair if hair is seen anywhere. A seen texel keeps its label if a corner of its face has it, else it
/// takes its nearest corner's, as unseen ones do. A loose garment's texels are "bottom" if none of it is seen.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geometry/body/body_model.h"
#include "geometry/math/arrays.h"
#include "geometry/scene/camera.h"
#include "geometry/uv_maps/uv_texels.h"
#include "render/texture/body_regions.h"
#include "render/texture/texture_extract.h"

namespace bodyloom {

/// The labels (PersonLabel) of one photo, one per pixel.
struct PhotoLabels {
  int width = 0, height = 0;
  std::vector<uint8_t> labels;
};

/// One label per texel of the texture, row-major; 0 where the atlas is empty. `photos`: indexed by
/// Texture::source_frame. `rest_vertices`: V×3, metres; `regions`: one per vertex. Throws std::invalid_argument when
/// sizes do not fit.
std::vector<uint8_t> TexelLabels(const BodyModel& body, const UvTexelTable& table, const MatrixX3d& rest_vertices,
                                 std::span<const BodyRegion> regions, const Texture& seen,
                                 std::span<const PhotoLabels> photos);

/// Body parts visible in an image.
/// DensePose's parts 1 to 24, one per pixel of the camera's image; 0 off the body. `vertices_in_camera`: V×3, metres.
std::vector<uint8_t> PartsInImage(const BodyModel& body, const MatrixX3d& vertices_in_camera, const Camera& camera,
                                  int num_threads);

}  // namespace bodyloom
