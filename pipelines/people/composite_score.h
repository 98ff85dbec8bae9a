// SPDX-License-Identifier: Apache-2.0
/// How well a person laid over a person set's backgrounds fits the set's own pictures.
#pragma once

#include <string>

#include "bodyloom/data_tools/datasets/person_set.h"
#include "bodyloom/render/image.h"

namespace bodyloom {

/// Whole pictures, person and background, against those of a person set. Says something where the person was laid over
/// the set's own backgrounds.
class CompositeScore {
 public:
  static constexpr int kRimPixels = 3;

  /// The set's pictures are brought to width × height. Throws std::runtime_error when the set cannot be read.
  CompositeScore(const std::string& set, int width, int height) : set_(set), width_(width), height_(height) {}

  /// The picture of the set's frame t.
  void Add(int t, const Image& composed);

  /// Mean over frames of the PSNR of the whole picture, dB.
  [[nodiscard]] double psnr_db() const { return whole_.Mean(); }
  /// Of the pixels within kRimPixels of the true person's contour (RimOf()); NaN where the set has no labels.
  [[nodiscard]] double rim_psnr_db() const { return rim_.Mean(); }

 private:
  struct Sum {
    double total = 0;
    int count = 0;
    void Add(double value);
    [[nodiscard]] double Mean() const;
  };
  PersonSet set_;
  int width_, height_;
  Sum whole_, rim_;
};

}  // namespace bodyloom
