// SPDX-License-Identifier: Apache-2.0
/// Segmentation of the tracked person in a window of a photo, with clothing classes, where there are no labels.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "data_tools/datasets/single_person_dataset.h"
#include "render/image/image.h"

namespace bodyloom {

/// What of `labels` (size × size, 0 background) belongs to the person of `parts` (0 off the body): pixels that a path
/// through labelled pixels, no longer than a twelfth of the body's extent, joins to the body. Others become 0: there
/// may be several people in a picture, and the track says which one is meant. Returns the share that was left out.
double KeepPerson(std::span<const uint8_t> parts, int size, std::vector<uint8_t>* labels);

struct PersonSegmentation {
  std::vector<uint8_t> labels;  ///< size × size, of the nearest part of the body
  std::string note;             ///< how the outline was found, half a sentence for the user
};

/// By GrabCut from the tracked body (data_tools/datasets/photo_segmentation.h), in the part of the window that lies
/// inside the picture; outside of it all is background. `alpha` (size × size or empty): the file's own transparency,
/// which is then cut instead of the colours. Throws std::invalid_argument when the body is not in the picture.
PersonSegmentation SegmentPerson(const Image& window, std::span<const uint8_t> inside_picture,
                                 std::span<const uint8_t> alpha, std::span<const uint8_t> parts);

// Score of a person composited over a single-person dataset's backgrounds, against the dataset's own pictures.

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
