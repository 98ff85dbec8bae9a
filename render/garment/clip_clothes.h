// SPDX-License-Identifier: Apache-2.0
/// The skirt, dress or coat of the person in a clip, from masks.
///
/// Of some frames each is asked for itself (render/garment/fit_clothes.h). Where at least a third of them show a
/// garment, the upper quartile of their waists and the means of their hems and fullnesses begin a search: the garment
/// is run along the motion of short pieces of the clip, and moved by steps that halve, one measure after the other, to
/// where the dressed body's outline is most like the masks, with
///   E = pixels in which mask and dressed body differ / pixels of the mask, mean over the frames looked at.
/// It is kept if E is by FitClothesOptions::least_gain below that of clothes close to the skin.
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
  int frames = 0, found_in = 0;                   ///< asked for themselves; that show a garment
  double unlike_close = 0, unlike_loose = 0;      ///< E of clothes close to the skin, and with the garment
};

/// Where the person is in a frame of the clip: 0 where not.
using MaskOfFrame = std::function<LabelImage(int t)>;

/// `frames`: of the track that may be looked at, rising; those without a result are left out. The same for any number
/// of threads. Throws what `mask_of` throws, which is called by one thread; Cancelled.
ClipClothes FitClipClothes(const BodyModel& body, const Track& track, const std::vector<int>& frames,
                           const MaskOfFrame& mask_of, int num_threads, const PipelineCallbacks& callbacks);

}  // namespace bodyloom
