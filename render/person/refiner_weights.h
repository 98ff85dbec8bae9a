// SPDX-License-Identifier: Apache-2.0
/// The picture refiner: a small convolutional network that reads what was drawn of a person made from photos
/// (render/person/person_layers.h) and says how colour and alpha should change. This is its shape and its numbers;
/// neural/refiner trains it, pipelines/person runs it.
///
/// Pixels are taken 2×2 together first: in(y, x, (2r + s)·12 + c) = plane c at (2y + r, 2x + s); the answer of 16
/// channels is laid out again the same way with 4 planes. Between, a U-Net of 3×3 convolutions with bias and relu6,
/// zeros beyond the border:
///   enter 48→32, first 32→32                                     half the picture's size
///   down1 32→48 (stride 2), second 48→48                          a quarter
///   down2 48→64 (stride 2), third 64→64                           an eighth
///   down3 64→96 (stride 2), fourth 96→96                          a sixteenth
///   up2 (96+64)→64, merge2 64→64; up1 (64+48)→48, merge1 48→48; up0 (48+32)→32, merge0 32→32
///   leave 32→16, without relu6
/// "up" reads the coarser level, enlarged bilinearly (pixel centres aligned), then the level's own features. A stride of 2
/// reads rows and columns 2y … 2y + 2. No normalisation: a picture's colours are not other pixels' business.
/// Source: Ronneberger et al., "U-Net", MICCAI 2015. What it brings: docs/lab/picture_refiner.md.
#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "bodyloom/geometry/arrays.h"
#include "bodyloom/render/person/person_layers.h"

namespace bodyloom {

struct RefinerShape {
  const char* name;
  int in, out, stride;
  bool relu6;
};

inline constexpr std::array<RefinerShape, 15> kRefinerShapes = {{{"enter", 4 * PersonPlane::kCount, 32, 1, true},
                                                                 {"first", 32, 32, 1, true},
                                                                 {"down1", 32, 48, 2, true},
                                                                 {"second", 48, 48, 1, true},
                                                                 {"down2", 48, 64, 2, true},
                                                                 {"third", 64, 64, 1, true},
                                                                 {"down3", 64, 96, 2, true},
                                                                 {"fourth", 96, 96, 1, true},
                                                                 {"up2", 160, 64, 1, true},
                                                                 {"merge2", 64, 64, 1, true},
                                                                 {"up1", 112, 48, 1, true},
                                                                 {"merge1", 48, 48, 1, true},
                                                                 {"up0", 80, 32, 1, true},
                                                                 {"merge0", 32, 32, 1, true},
                                                                 {"leave", 32, 16, 1, false}}};

/// The network reads pictures whose sides are multiples of this.
inline constexpr int kRefinerMultiple = 16;
static_assert(kLayersMultiple % kRefinerMultiple == 0);

struct RefinerWeights {
  struct Convolution {
    RowMatrixXf kernel;    ///< out × 9·in: columns (3·row + column)·in + channel
    Eigen::VectorXf bias;  ///< out
  };
  std::vector<Convolution> convolutions;  ///< in the order of kRefinerShapes
  double pixels_per_metre = 250;          ///< how large people were that it learned from, the median picture
  std::string recipe;                     ///< how they were learned, JSON

  /// Whether sizes are those of kRefinerShapes, all numbers finite and people of a size; `why` may be nullptr.
  bool IsValid(std::string* why) const;
  [[nodiscard]] size_t num_parameters() const;
};

}  // namespace bodyloom
