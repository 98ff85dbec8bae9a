// SPDX-License-Identifier: Apache-2.0
/// A contact sheet of a single-person dataset: evenly spread frames as columns; image, labels in colours, normals and
/// IUV as rows.
#pragma once

#include <vector>

#include "bodyloom/data_tools/datasets/single_person_dataset.h"
#include "bodyloom/render/image.h"

namespace bodyloom {

/// The colour a label is shown in.
Colour PersonLabelColour(PersonLabel label);

/// Labels (indices in all channels) as colours.
Image PersonLabelPicture(const Image& labels);

/// Takes frames as they come, in order, and keeps those that are shown.
class PersonSheet {
 public:
  explicit PersonSheet(int num_frames, int columns = 8);
  void Take(int t, const PersonFrame& frame);
  /// Throws std::invalid_argument when no frame was taken.
  [[nodiscard]] Image Picture(int cell_height_px = 200) const;

 private:
  std::vector<int> wanted_;
  std::vector<PersonFrame> frames_;
};

}  // namespace bodyloom
