// SPDX-License-Identifier: Apache-2.0
/// Draws text on pictures: a few lines on a translucent panel in a corner.
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

/// Draws the lines, left aligned, letters about height_px high (0: 1/45 of the image's smaller side, at least 9 px).
/// Lines too long for the image are drawn smaller. An empty list draws nothing.
void DrawCaption(const std::vector<CaptionLine>& lines, Corner corner, double height_px, Image* image);

/// Draws one line without a panel: letters cap_px high on `baseline`, starting at x. Clipped at the image's borders.
void DrawWords(const std::string& text, int x, int baseline, double cap_px, Colour colour, Image* image);
/// Width of the line drawn by DrawWords, pixels.
double WidthOfWords(const std::string& text, double cap_px);

}  // namespace bodyloom
