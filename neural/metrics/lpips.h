// SPDX-License-Identifier: Apache-2.0
/// LPIPS v0.1: perceptual distance of two images in network features calibrated on human judgements.
///
/// RGB in [−1, 1]; (x − shift)/scale with shift (−.030, −.088, −.188) and scale (.458, .448, .450); features of AlexNet
/// (relu1 … relu5) or VGG-16 (relu1_2, 2_2, 3_3, 4_3, 5_3); each position's channels divided by their norm + 1e-10;
/// squared differences weighted by the channel weights of "lin{k}.model.1.weight" (1×C×1×1), averaged over positions,
/// summed over layers. Whole images, no crop or mask (set the background of both to black to exclude it); 0 for equal
/// images; tables often print 100 or 1000 times the value.
/// Source: Zhang et al., "The Unreasonable Effectiveness of Deep Features as a Perceptual Metric", CVPR 2018, and
/// version 0.1 of its code.
///
/// Without the trained weights a random-feature substitute is used (neural/networks/vgg.h, channel weights 1); its
/// values are marked and not comparable with published ones.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "neural/networks/named_weights.h"
#include "render/image/image.h"

namespace bodyloom {

enum class LpipsTrunk { kAlexNet, kVgg16 };

struct LpipsOptions {
  LpipsTrunk trunk = LpipsTrunk::kAlexNet;
  int random_features_divisor = 1;  ///< of the substitute's channels, for speed; trained weights need 1
  uint64_t random_features_seed = 1;
};

struct LpipsValue {
  double value = 0;
  bool random_features = true;  ///< not comparable with other programs' figures
};

/// The network's features of one image, for several comparisons.
class LpipsFeatures {
 private:
  friend class Lpips;
  struct Impl;
  std::shared_ptr<const Impl> impl_;
};

class Lpips {
 public:
  /// Starts as a random-feature substitute until Load is called.
  explicit Lpips(const LpipsOptions& options = {});
  ~Lpips();
  Lpips(Lpips&&) noexcept;
  Lpips& operator=(Lpips&&) noexcept;

  /// `trunk`: torchvision's weights ("features.0.weight", …); `heads`: LPIPS' own ("lin0.model.1.weight", …). Throws
  /// std::runtime_error naming source and tensor when one does not fit (then the substitute stays),
  /// std::invalid_argument for a divisor other than 1.
  void Load(const NamedWeights& trunk, const std::string& trunk_source, const NamedWeights& heads,
            const std::string& heads_source);

  [[nodiscard]] bool has_random_features() const;

  /// Computes the features of an image of at least 31 pixels a side (VGG-16: 16); std::invalid_argument otherwise. They
  /// become invalid when other weights are loaded.
  [[nodiscard]] LpipsFeatures Features(const Image& image) const;
  /// Distance of images of the same size; std::invalid_argument otherwise, and for features from other weights.
  [[nodiscard]] LpipsValue Distance(const LpipsFeatures& a, const LpipsFeatures& b) const;
  [[nodiscard]] LpipsValue Distance(const Image& a, const Image& b) const;

 private:
  struct Network;
  std::unique_ptr<Network> network_;
};

/// LPIPS on AlexNet with these weights; the substitute when either is empty. Throws as Lpips::Load.
Lpips LpipsFrom(const WeightsFrom& alexnet, const WeightsFrom& heads);

/// Name of a figure by the features used: NAME_alex or NAME_random_features.
std::string LpipsName(const char* name, bool random_features);

// Computes LPIPS and tLPIPS of a video frame by frame; each frame's features are computed once.
//
// tLPIPS of frame t = |LPIPS(s_t, s_{t−1}) − LPIPS(g_t, g_{t−1})| with result s and truth g: the difference between
// the changes of result and truth. Windows that follow a person are aligned first (Shifted,
// neural/base/image_tensor.h), so that a jump of the window is not a change. A video's value is the mean over its
// frames except the first (of every cut). Tables print 100 times that. Source: Chu et al., "Learning Temporal
// Coherence via Self-Supervision for GAN-based Video Generation", 2020 (which crops and drops two frames at each end;
// this does not), as used by Yoon et al., CVPR 2022.

/// | d(s_t, s_{t−1}) − d(g_t, g_{t−1}) | from the four images' features, with the distance d of `lpips`.
double TemporalLpipsOf(const Lpips& lpips, const LpipsFeatures& result, const LpipsFeatures& result_before,
                       const LpipsFeatures& truth, const LpipsFeatures& truth_before);

struct TemporalLpipsMean {
  int frames = 0;
  double lpips = 0;   ///< mean over frames
  double tlpips = 0;  ///< mean over frames with a predecessor; 0 if there are none
  int pairs = 0;      ///< of them
  bool random_features = true;
};

class TemporalLpips {
 public:
  struct Frame {
    double lpips = 0;
    std::optional<double> tlpips;  ///< none for the first frame
    bool random_features = true;
  };

  /// `lpips` must outlive this.
  explicit TemporalLpips(const Lpips& lpips) : lpips_(lpips) {}

  /// Adds the next frame. The previous frame's images lie at (before_x, before_y) in the current ones; pixels outside
  /// them are black. Throws std::invalid_argument when the images differ in size, from each other or from the previous
  /// frame.
  Frame Add(const Image& result, const Image& truth, int before_x = 0, int before_y = 0);

  /// Starts a new sequence: the next frame has no tLPIPS.
  void Restart() { follows_ = false; }

  [[nodiscard]] TemporalLpipsMean Mean() const;

 private:
  /// A frame's image, for shifting, and its features without shift.
  struct Seen {
    Image image;
    LpipsFeatures features;
  };
  /// Features of an image shifted by (x, y).
  [[nodiscard]] LpipsFeatures Moved(const Seen& seen, int x, int y) const;

  const Lpips& lpips_;
  Seen last_result_, last_truth_;
  bool follows_ = false;
  int frames_ = 0, pairs_ = 0;
  double sum_lpips_ = 0, sum_tlpips_ = 0;
};

}  // namespace bodyloom
