// SPDX-License-Identifier: Apache-2.0
/// Estimates the skirt, dress or coat of the person in a clip from masks.
///
/// Some frames are fitted independently (render/garment/fit_clothes.h). If at least a third of them show a garment, the
/// upper quartile of their waists and the means of their hems and fullnesses initialise a coordinate search with
/// halving steps: the garment is simulated along the motion of short pieces of the clip, and its measures minimise
///   E = pixels in which mask and dressed body differ / pixels of the mask, mean over the frames compared.
/// The garment is kept if E is by FitClothesOptions::min_gain below that of clothes close to the skin.
#pragma once

#include <functional>
#include <vector>

#include "geometry/base/callbacks.h"
#include "geometry/body/body_model.h"
#include "geometry/cloth/loose_garment.h"
#include "geometry/scene/observations.h"
#include "geometry/scene/track.h"

namespace bodyloom {

struct ClipClothes {
  LooseGarmentOptions garment = {.length_m = 0};  ///< length_m 0: none
  std::vector<double> offsets_m;                  ///< V: of the clothes close to the skin; empty without a garment
  int frames = 0, found_in = 0;                   ///< fitted independently; of these, with a garment
  double mask_error_tight = 0, mask_error_with_garment = 0;  ///< E of clothes close to the skin, and with the garment
};

/// Mask of the person in a frame of the clip: 0 off the person.
using MaskOfFrame = std::function<LabelImage(int t)>;

/// `frames`: frames of the track to use, ascending; those without a result are left out. The result does not depend on
/// the number of threads. `mask_of` is called by one thread. Throws what `mask_of` throws, and Cancelled.
ClipClothes FitClipClothes(const BodyModel& body, const Track& track, const std::vector<int>& frames,
                           const MaskOfFrame& mask_of, int num_threads, const PipelineCallbacks& callbacks);

}  // namespace bodyloom
