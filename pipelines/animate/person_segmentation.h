// SPDX-License-Identifier: Apache-2.0
/// Segments the tracked person in a window of a photo, with clothing classes, where no labels are given.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "data_tools/datasets/single_person_dataset.h"
#include "render/image/image.h"

namespace bodyloom {

/// Sets those of `labels` (size × size, 0 background) to 0 that do not belong to the person of `parts` (0 off the
/// body): pixels not joined to the body by a path through labelled pixels of at most a twelfth of the body's extent. An
/// image may show several people; the track says which one is meant. Returns the share of labelled pixels removed.
double KeepPerson(std::span<const uint8_t> parts, int size, std::vector<uint8_t>* labels);

struct PersonSegmentation {
  std::vector<uint8_t> labels;  ///< size × size, of the nearest part of the body
  std::string note;             ///< how the outline was found, half a sentence for the user
};

/// Segments by GrabCut from the tracked body (data_tools/datasets/photo_segmentation.h), in the part of the window
/// inside the image; everything outside is background. `alpha` (size × size or empty): the file's own transparency,
/// which then replaces the colours. Throws std::invalid_argument when the body is not in the image.
PersonSegmentation SegmentPerson(const Image& window, std::span<const uint8_t> inside_image,
                                 std::span<const uint8_t> alpha, std::span<const uint8_t> parts);

// Score of a person composited over a single-person dataset's backgrounds, against the dataset's own images.

/// Compares whole images, person and background, with those of a single-person dataset. Meaningful where the person was
/// composited over the dataset's own backgrounds.
class CompositeScore {
 public:
  static constexpr int kRimPixels = 3;

  /// The dataset's images are resized to width × height. Throws std::runtime_error when the dataset cannot be read.
  CompositeScore(const std::string& set, int width, int height) : set_(set), width_(width), height_(height) {}

  /// Adds the image composed for the dataset's frame t.
  void Add(int t, const Image& composed);

  /// Mean over frames of the PSNR of the whole image, dB.
  [[nodiscard]] double psnr_db() const { return whole_.Mean(); }
  /// The same over the pixels within kRimPixels of the true person's contour (RimOf()); NaN where the dataset has no
  /// labels.
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
