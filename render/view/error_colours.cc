// SPDX-License-Identifier: Apache-2.0
#include "render/view/error_colours.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <opencv2/imgproc.hpp>

#include "render/image/image.h"
#include "render/image/palette.h"
#include "render/view/caption.h"

namespace bodyloom {
namespace {

constexpr int kShades = 256;

std::array<Colour, kShades> Viridis() {
  cv::Mat ramp(1, kShades, CV_8UC1), colours;
  for (int i = 0; i < kShades; ++i) ramp.at<uint8_t>(0, i) = static_cast<uint8_t>(i);
  cv::applyColorMap(ramp, colours, cv::COLORMAP_VIRIDIS);
  std::array<Colour, kShades> result;
  for (int i = 0; i < kShades; ++i) {
    const cv::Vec3b c = colours.at<cv::Vec3b>(0, i);
    result[i] = {c[2], c[1], c[0]};
  }
  return result;
}

/// Shortest decimal form: "50", "0.5".
std::string ShortNumber(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}

void FillBox(int x, int y, int width, int height, Colour colour, double alpha, Image* image) {
  const auto blend = [&](uint8_t* p, uint8_t to) { *p = NearestByte(*p + alpha * (to - *p)); };
  for (int j = std::max(0, y); j < std::min(image->height, y + height); ++j) {
    for (int i = std::max(0, x); i < std::min(image->width, x + width); ++i) {
      uint8_t* p = image->pixel(i, j);
      blend(p, colour.blue), blend(p + 1, colour.green), blend(p + 2, colour.red);
    }
  }
}

}  // namespace

std::string ErrorScale::ToText() const {
  return what + ": violet 0, yellow " + ShortNumber(maximum) + " " + unit + " and more";
}

Colour ErrorColour(double share) {
  static const std::array<Colour, kShades> kColours = Viridis();
  if (std::isnan(share)) return {150, 150, 150};
  return kColours[static_cast<size_t>(std::lround((kShades - 1) * std::clamp(share, 0.0, 1.0)))];
}

int ErrorLegendHeight(double cap_px) { return static_cast<int>(std::lround(6.6 * cap_px)); }

void DrawErrorLegend(const ErrorScale& scale, int x, int y, int width, double cap_px, Image* image) {
  FillBox(x, y, width, ErrorLegendHeight(cap_px), kInkColour, 0.72, image);
  const int padding = static_cast<int>(std::lround(0.9 * cap_px)), bar_x = x + padding,
            bar_width = std::max(2, width - 2 * padding);
  const auto below = [&](double caps) { return y + static_cast<int>(std::lround(caps * cap_px)); };
  const auto say = [&](const std::string& text, double share, int baseline) {
    const double room = bar_width, wide = WidthOfWords(text, cap_px);
    const double letters = wide > room ? cap_px * room / wide : cap_px;
    const double left = share * (bar_width - WidthOfWords(text, letters));
    DrawWords(text, bar_x + static_cast<int>(std::lround(left)), baseline, letters, kPaperColour, image);
  };
  say(scale.what, 0, below(1.9));
  const int bar_y = below(2.6), bar_height = std::max(2, static_cast<int>(std::lround(1.5 * cap_px)));
  for (int i = 0; i < bar_width; ++i) {
    FillBox(bar_x + i, bar_y, 1, bar_height, ErrorColour(i / (bar_width - 1.0)), 1, image);
  }
  const std::string maximum = ">= " + ShortNumber(scale.maximum) + " " + scale.unit;
  say("0", 0, below(5.7));
  // Omitted where it would overlap the maximum.
  const std::string half = ShortNumber(scale.maximum / 2);
  if (0.5 * bar_width + WidthOfWords(half, cap_px) + WidthOfWords(maximum, cap_px) < bar_width) {
    say(half, 0.5, below(5.7));
  }
  say(maximum, 1, below(5.7));
}

}  // namespace bodyloom
