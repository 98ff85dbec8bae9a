// SPDX-License-Identifier: Apache-2.0
#include "geometry/scene/observations.h"

namespace bodyloom {

std::array<uint8_t, 256> PartLabelSequence::Identity() {
  std::array<uint8_t, 256> result;
  for (int i = 0; i < 256; ++i) result[i] = static_cast<uint8_t>(i);
  return result;
}

LabelImage PartLabelSequence::PartsOf(int frame) const {
  LabelImage parts = frames[static_cast<size_t>(frame)].Unpacked();
  for (uint8_t& label : parts.labels) label = part_of_label[label];
  return parts;
}

void PartLabelSequence::Merge(uint8_t part, uint8_t into) {
  for (uint8_t& p : part_of_label) p = p == part ? into : p;
  for (uint8_t& p : part_of_chart) p = p == part ? into : p;
}

void PartLabelSequence::AsMask() {
  part_of_label.fill(1);
  part_of_label[kBackground] = kBackground;
  part_of_label[kUnknown] = kUnknown;
  part_of_chart.fill(1);
}

}  // namespace bodyloom
