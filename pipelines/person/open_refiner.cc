// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/pipelines/person/open_refiner.h"

#include "bodyloom/data_tools/learned/refiner_weights_io.h"

namespace bodyloom {

std::unique_ptr<PictureRefiner> OpenRefiner(const std::string& name) {
  if (name == kNoRefiner) return nullptr;
  return std::make_unique<PictureRefiner>(ReadRefinerWeights(name));
}

}  // namespace bodyloom
