// SPDX-License-Identifier: Apache-2.0
/// Score of a person composited over a single-person dataset's backgrounds, against the dataset's own pictures.
#pragma once

#include <string>

#include "bodyloom/data_tools/datasets/single_person_dataset.h"
#include "bodyloom/render/image.h"

namespace bodyloom {

/// Whole pictures, person and background, against those of a single-person dataset. Says something where the person was
/// laid over the dataset's own backgrounds.
class CompositeScore {
 public:
  static constexpr int kRimPixels = 3;

  /// The dataset's pictures are brought to width × height. Throws std::runtime_error when the dataset cannot be read.
  CompositeScore(const std::string& set, int width, int height) : set_(set), width_(width), height_(height) {}

  /// The picture of the dataset's frame t.
  void Add(int t, const Image& composed);

  /// Mean over frames of the PSNR of the whole picture, dB.
  [[nodiscard]] double psnr_db() const { return whole_.Mean(); }
  /// Of the pixels within kRimPixels of the true person's contour (RimOf()); NaN where the dataset has no labels.
  [[nodiscard]] double rim_psnr_db() const { return rim_.Mean(); }

 private:
  struct Sum {
    double total = 0;
    int count = 0;
    void Add(double value);
    [[nodiscard]] double Mean() const;
  };
  SinglePersonDataset set_;
  int width_, height_;
  Sum whole_, rim_;
};

}  // namespace bodyloom
