// SPDX-License-Identifier: Apache-2.0
/// How often colours are seen, as a density over the cube of 256³ levels: a histogram of 16³ bins, a tenth of it spread evenly
/// because not everything has been seen.
#pragma once

#include <cstdint>
#include <vector>

namespace bodyloom {

class ColourDensity {
 public:
  void Add(const uint8_t* bgr) { ++counts_[Bin(bgr)], ++total_; }
  /// Per level³, above 0; of nothing seen 1/256³ everywhere.
  [[nodiscard]] double At(const uint8_t* bgr) const {
    constexpr double kEven = 0.1, kLevels = 256.0 * 256 * 256;
    if (total_ == 0) return 1 / kLevels;
    return kEven / kLevels + (1 - kEven) * double(counts_[Bin(bgr)]) / double(total_) / 4096;
  }

 private:
  static int Bin(const uint8_t* bgr) { return (bgr[0] >> 4) << 8 | (bgr[1] >> 4) << 4 | bgr[2] >> 4; }
  std::vector<int64_t> counts_ = std::vector<int64_t>(4096, 0);
  int64_t total_ = 0;
};

}  // namespace bodyloom
