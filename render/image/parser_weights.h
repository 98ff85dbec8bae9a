// SPDX-License-Identifier: Apache-2.0
/// The clothes parser: a small convolutional network that says of each pixel of a person in a photo what it shows: top,
/// bottom, face, hair, skin or shoes. These are its numbers; neural/parser trains it, render/photo_avatar runs it. What
/// it brings: docs/lab/clothes_parser.md.
///
/// It reads the planes of PersonPlane (render/image/person_layers.h): the photo's colours, 0 where the person
/// is not, the person's mask as alpha, and of the bare body that was fitted, where it covers the mask, the normal and
/// the place at rest. It answers with a number a class; the largest is the class.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "geometry/math/arrays.h"
#include "render/image/person_layers.h"

namespace bodyloom {

// A small U-Net that reads planes of a picture and answers with planes of the same size: its shape and its numbers. The
// clothes parser (render/image/parser_weights.h) is one; neural/networks/picture_unet_module.h learns,
// tracking/detection/inference/picture_unet_runner.h runs without LibTorch.
//
// Of P planes and Q outputs. Pixels are taken 2×2 together first: in(y, x, (2r + s)·P + c) = plane c at
// (2y + r, 2x + s); the answer of 4Q channels is laid out again the same way. Between, 3×3 convolutions with bias and
// relu6, zeros beyond the border:
// enter 4P→32, first 32→32                                      half the picture's size
// down1 32→48 (stride 2), second 48→48                          a quarter
// down2 48→64 (stride 2), third 64→64                           an eighth
// down3 64→96 (stride 2), fourth 96→96                          a sixteenth
// up2 (96+64)→64, merge2 64→64; up1 (64+48)→48, merge1 48→48; up0 (48+32)→32, merge0 32→32
// leave 32→4Q, without relu6
// "up" reads the coarser level, enlarged bilinearly (pixel centres aligned), then the level's own features. A stride of
// 2 reads rows and columns 2y … 2y + 2. No normalisation: a picture's colours are not other pixels' business.
// Source: Ronneberger et al., "U-Net", MICCAI 2015.

/// What a network reads and answers with.
struct PictureUnetPlanes {
  int in = 0, out = 0;
};

struct PictureUnetLayer {
  const char* name;
  int in, out, stride;
  bool relu6;
};

constexpr std::array<PictureUnetLayer, 15> PictureUnetLayers(PictureUnetPlanes planes) {
  return {{{"enter", 4 * planes.in, 32, 1, true},
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
           {"leave", 32, 4 * planes.out, 1, false}}};
}

/// The network reads pictures whose sides are multiples of this.
inline constexpr int kPictureUnetMultiple = 16;

/// The size, as a share, of the picture in which a person of `pixels_per_metre` is shown to a network that learned from
/// people of `known`: 1, unless the person is more than a quarter larger; then known / pixels_per_metre. A network
/// knows no other size.
constexpr double PictureUnetScale(double pixels_per_metre, double known) {
  constexpr double kLarger = 1.25;
  return pixels_per_metre > kLarger * known ? known / pixels_per_metre : 1;
}

struct PictureUnetWeights {
  struct Convolution {
    RowMatrixXf kernel;    ///< out × 9·in: columns (3·row + column)·in + channel
    Eigen::VectorXf bias;  ///< out
  };
  std::vector<Convolution> convolutions;  ///< in the order of PictureUnetLayers()

  /// Whether sizes are those of PictureUnetLayers() and all numbers finite; `why` may be nullptr.
  bool IsValid(PictureUnetPlanes planes, std::string* why) const;
  [[nodiscard]] size_t num_parameters() const;
};

/// Classes in the order of PersonLabel (geometry/scene/person_label.h), from kTop to kShoes.
inline constexpr int kParserClasses = 6;
inline constexpr PictureUnetPlanes kParserPlanes = {PersonPlane::kCount, kParserClasses};

struct ParserWeights {
  PictureUnetWeights network;     ///< of kParserPlanes
  double pixels_per_metre = 250;  ///< how large people were that it learned from, the median picture
  std::string recipe;             ///< how they were learned, JSON

  /// Whether the network is valid and people had a size; `why` may be nullptr.
  bool IsValid(std::string* why) const;
};

}  // namespace bodyloom
