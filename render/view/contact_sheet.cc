// SPDX-License-Identifier: Apache-2.0
#include "render/view/contact_sheet.h"

#include <algorithm>
#include <cmath>

#include "geometry/base/check.h"

namespace bodyloom {

Image ContactSheet(const std::vector<Image>& images, const ContactSheetOptions& options) {
  BODYLOOM_CHECK(!images.empty(), "contact sheet: no images");
  BODYLOOM_CHECK(options.cell_height_px > 0 && options.gap_px >= 0 && options.columns >= 0, "contact sheet: cells of ",
                 options.cell_height_px, " px, gap of ", options.gap_px, " px, ", options.columns, " columns");
  std::vector<Image> cells;
  int cell_width = 1;
  for (const Image& image : images) {
    BODYLOOM_CHECK(!image.empty(), "contact sheet: an image is empty");
    const double scale = double(options.cell_height_px) / image.height;
    const int width = std::max(1, static_cast<int>(std::lround(image.width * scale)));
    cells.push_back(Resized(image, width, options.cell_height_px));
    cell_width = std::max(cell_width, width);
  }
  const int n = static_cast<int>(cells.size());
  int columns = options.columns;
  if (columns == 0) {
    columns = static_cast<int>(std::ceil(std::sqrt(double(n) * options.cell_height_px / cell_width)));
  }
  columns = std::clamp(columns, 1, n);
  const int rows = (n + columns - 1) / columns, gap = options.gap_px;
  Image sheet(columns * (cell_width + gap) + gap, rows * (options.cell_height_px + gap) + gap, options.background);
  for (int i = 0; i < n; ++i) {
    Paste(cells[i], gap + (i % columns) * (cell_width + gap) + (cell_width - cells[i].width) / 2,
          gap + (i / columns) * (options.cell_height_px + gap), &sheet);
  }
  return sheet;
}

std::vector<int> EvenlySpreadFrames(int num_frames, int count) {
  BODYLOOM_CHECK(num_frames >= 0 && count >= 0, "spread of ", count, " over ", num_frames, " frames");
  count = std::min(count, num_frames);
  std::vector<int> frames;
  frames.reserve(count);
  for (int i = 0; i < count; ++i) {
    frames.push_back(count == 1 ? (num_frames - 1) / 2
                                : static_cast<int>(std::lround(double(i) * (num_frames - 1) / (count - 1))));
  }
  return frames;
}

}  // namespace bodyloom
