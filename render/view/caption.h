// SPDX-License-Identifier: Apache-2.0
/// Text on pictures: a few lines on a translucent panel in a corner.
#pragma once

#include <string>
#include <vector>

#include "render/image/image.h"

namespace bodyloom {

enum class Corner { kTopLeft, kTopRight, kBottomLeft, kBottomRight };

/// A line of a caption, with an optional coloured mark before it (a legend's key).
struct CaptionLine {
  enum class Mark { kNone, kDisc, kRing };
  std::string text;  ///< ASCII; other bytes are drawn as '?'
  Mark mark = Mark::kNone;
  Colour colour = {};
};

/// Draws the lines, left aligned, letters about height_px high (0: 1/45 of the image's smaller side, at least 9 px). A
/// line that is too long for the image is made smaller. Nothing is drawn for an empty list.
void DrawCaption(const std::vector<CaptionLine>& lines, Corner corner, double height_px, Image* image);

/// One line without a panel: letters cap_px high standing on `baseline`, the first at x. What falls outside is left
/// out.
void DrawWords(const std::string& text, int x, int baseline, double cap_px, Colour colour, Image* image);
/// How wide that is, pixels.
double WidthOfWords(const std::string& text, double cap_px);

}  // namespace bodyloom
