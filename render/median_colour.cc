// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/render/median_colour.h"

#include <algorithm>
#include <cstddef>
#include <vector>

#include "bodyloom/geometry/base/check.h"

namespace bodyloom {

ChannelTriple MedianColour(std::span<const ChannelTriple> colours) {
  BODYLOOM_CHECK(!colours.empty(), "median colour: of no colour");
  ChannelTriple median{};
  std::vector<float> values(colours.size());
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  for (size_t c = 0; c < median.size(); ++c) {
    std::transform(colours.begin(), colours.end(), values.begin(), [c](const ChannelTriple& v) { return v[c]; });
    std::nth_element(values.begin(), middle, values.end());
    median[c] = *middle;
    if (values.size() % 2 == 0) median[c] = (median[c] + *std::max_element(values.begin(), middle)) / 2;
  }
  return median;
}

std::optional<ChannelTriple> MedianColourOfMany(std::span<const ChannelTriple> colours, size_t fewest) {
  if (colours.size() < fewest) return std::nullopt;
  return MedianColour(colours);
}

}  // namespace bodyloom
