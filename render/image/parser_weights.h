// SPDX-License-Identifier: Apache-2.0
/// Weights of the clothes parser, a small convolutional network that labels each pixel of a person in a photo as top,
/// bottom, face, hair, skin or shoes. neural/parser trains it, render/photo_avatar runs it. Evaluation:
/// docs/lab/clothes_parser.md.
///
/// Input: the planes of PersonPlane (render/image/person_layers.h): the photo's colours, 0 off the person, the person's
/// mask as alpha, and normals and rest positions of the fitted bare body where it covers the mask. Output: one score
/// per class; the largest one gives the class.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "geometry/math/arrays.h"
#include "render/image/person_layers.h"

namespace bodyloom {

// Architecture and weights of a small U-Net that maps planes of an image to planes of the same size. The clothes parser
// is one; neural/networks/image_unet_module.h trains them, tracking/detection/inference/image_unet_runner.h runs them
// without LibTorch.
//
// P input planes, Q outputs. Space-to-depth by 2×2 first: in(y, x, (2r + s)·P + c) = plane c at (2y + r, 2x + s); the
// output of 4Q channels is rearranged back in the same way. In between, 3×3 convolutions with bias and relu6, zero
// padding:
//   enter 4P→32, first 32→32                                      half the image's size
//   down1 32→48 (stride 2), second 48→48                          a quarter
//   down2 48→64 (stride 2), third 64→64                           an eighth
//   down3 64→96 (stride 2), fourth 96→96                          a sixteenth
//   up2 (96+64)→64, merge2 64→64; up1 (64+48)→48, merge1 48→48; up0 (48+32)→32, merge0 32→32
//   leave 32→4Q, without relu6
// "up" concatenates the coarser level, upsampled bilinearly (pixel centres aligned), and the level's own features. A
// stride of 2 reads rows and columns 2y … 2y + 2. No normalisation layers, so that distant pixels do not interact.
// Source: Ronneberger et al., "U-Net", MICCAI 2015.

/// Numbers of input and output planes of a network.
struct ImageUnetPlanes {
  int in = 0, out = 0;
};

struct ImageUnetLayer {
  const char* name;
  int in, out, stride;
  bool relu6;
};

constexpr std::array<ImageUnetLayer, 15> ImageUnetLayers(ImageUnetPlanes planes) {
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

/// Sides of the network's input must be multiples of this.
inline constexpr int kImageUnetMultiple = 16;

/// Factor by which an image with a person of `pixels_per_metre` is scaled for a network trained on people of `known`:
/// 1, unless the person is more than a quarter larger; then known / pixels_per_metre.
constexpr double ImageUnetScale(double pixels_per_metre, double known) {
  constexpr double kLarger = 1.25;
  return pixels_per_metre > kLarger * known ? known / pixels_per_metre : 1;
}

struct ImageUnetWeights {
  struct Convolution {
    RowMatrixXf kernel;    ///< out × 9·in: columns (3·row + column)·in + channel
    Eigen::VectorXf bias;  ///< out
  };
  std::vector<Convolution> convolutions;  ///< in the order of ImageUnetLayers()

  /// True if sizes are those of ImageUnetLayers() and all numbers finite; `why` may be nullptr.
  bool IsValid(ImageUnetPlanes planes, std::string* why) const;
  [[nodiscard]] size_t num_parameters() const;
};

/// Classes in the order of PersonLabel (geometry/scene/person_label.h), from kTop to kShoes.
inline constexpr int kParserClasses = 6;
inline constexpr ImageUnetPlanes kParserPlanes = {PersonPlane::kCount, kParserClasses};

struct ParserWeights {
  ImageUnetWeights network;       ///< of kParserPlanes
  double pixels_per_metre = 250;  ///< size of people in the training images, median
  std::string recipe;             ///< training configuration, JSON

  /// True if the network is valid and pixels_per_metre positive; `why` may be nullptr.
  bool IsValid(std::string* why) const;
};

}  // namespace bodyloom
