// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/data_tools/datasets/person_sheet.h"

#include <algorithm>
#include <array>

#include "bodyloom/geometry/base/check.h"
#include "bodyloom/render/contact_sheet.h"

namespace bodyloom {

Colour PersonLabelColour(PersonLabel label) {
  static const std::array<Colour, kNumPersonLabels> kColours = {
      {{24, 26, 32}, {230, 120, 60}, {70, 130, 220}, {250, 215, 165}, {120, 70, 30}, {225, 160, 150}, {90, 190, 100}}};
  return kColours[static_cast<size_t>(label)];
}

Image PersonLabelPicture(const Image& labels) {
  Image picture(labels.width, labels.height);
  for (int y = 0; y < labels.height; ++y) {
    for (int x = 0; x < labels.width; ++x) {
      const Colour c = PersonLabelColour(PersonLabel(std::min<int>(labels.pixel(x, y)[0], kNumPersonLabels - 1)));
      uint8_t* const p = picture.pixel(x, y);
      p[0] = c.blue, p[1] = c.green, p[2] = c.red;
    }
  }
  return picture;
}

PersonSheet::PersonSheet(int num_frames, int columns) : wanted_(EvenlySpreadFrames(num_frames, columns)) {}

void PersonSheet::Take(int t, const PersonFrame& frame) {
  if (std::binary_search(wanted_.begin(), wanted_.end(), t)) frames_.push_back(frame);
}

Image PersonSheet::Picture(int cell_height_px) const {
  BODYLOOM_CHECK(!frames_.empty(), "person sheet: no frame was taken");
  std::vector<Image> cells;
  for (const auto picture : {&PersonFrame::rgb, &PersonFrame::labels, &PersonFrame::normals, &PersonFrame::iuv}) {
    if ((frames_.front().*picture).empty()) continue;
    for (const PersonFrame& frame : frames_) {
      cells.push_back(picture == &PersonFrame::labels ? PersonLabelPicture(frame.labels) : frame.*picture);
    }
  }
  return ContactSheet(cells,
                      {.columns = static_cast<int>(frames_.size()), .cell_height_px = cell_height_px, .gap_px = 3});
}

}  // namespace bodyloom
