// SPDX-License-Identifier: Apache-2.0
#include "neural/parser/packed_image.h"

#include "geometry/base/check.h"
#include "render/image/parser_weights.h"

namespace bodyloom {

bool IsValidImageTraining(const ImageTraining& t, std::string* why) {
  const InRange in_range(why);
  if (t.crop % kImageUnetMultiple != 0) {
    if (why != nullptr) *why = Concatenate("crop is ", t.crop, ", expected a multiple of ", kImageUnetMultiple);
    return false;
  }
  return IsValidRun(t, why) && in_range("crop", t.crop, kImageUnetMultiple, 4096) &&
         in_range("batch", t.batch, 1, 4096) && in_range("learning_rate", t.learning_rate, 0, 1) &&
         in_range("warmup_steps", t.warmup_steps, 0, 1e8) && in_range("weight_decay", t.weight_decay, 0, 1) &&
         in_range("average_share", t.average_share, 1e-6, 0.5) && in_range("light_strength", t.light_strength, 0, 1);
}

}  // namespace bodyloom
