// SPDX-License-Identifier: Apache-2.0
/// Pictures to learn from, made person by person on several threads.
#pragma once

#include <functional>
#include <vector>

#include "bodyloom/neural/pictures/packed_picture.h"
#include "bodyloom/pipelines/callbacks.h"

namespace bodyloom {

/// Texels a side of a dataset's maps where nobody reads them.
inline constexpr int kMapSizeNobodyReads = 64;

/// pictures_of(person) of all people, in their order, for any number of threads. Throws what it throws, Cancelled; the
/// stage of `callbacks` is `stage`.
std::vector<PackedPicture> PicturesByPerson(int num_people, int threads, const char* stage,
                                            const PipelineCallbacks& callbacks,
                                            const std::function<std::vector<PackedPicture>(int)>& pictures_of);

/// The median of people's sizes, pixels a metre; of at least one picture.
double MedianPersonSize(const std::vector<PackedPicture>& pictures);

}  // namespace bodyloom
