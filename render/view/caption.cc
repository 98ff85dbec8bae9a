// SPDX-License-Identifier: Apache-2.0
#include "render/view/caption.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <opencv2/imgproc.hpp>
#include <string>
#include <tuple>

#include "render/image/image_mat.h"
#include "render/image/palette.h"

namespace bodyloom {
namespace {

constexpr int kFont = cv::FONT_HERSHEY_SIMPLEX;
constexpr int kFine = 4;             // supersampling of letters: OpenCV's small strokes are rough
constexpr double kCapHeight = 21.0;  // of a capital letter at font scale 1, pixels

std::string Printable(std::string text) {
  for (char& c : text) {
    if (c < ' ' || c > '~') c = '?';
  }
  return text;
}

/// Moves `target` towards a colour by a mask of 0..255 times alpha.
void Tint(const cv::Mat& mask, const Colour& colour, double alpha, cv::Mat target) {
  const std::array<double, 3> wanted = {double(colour.blue), double(colour.green), double(colour.red)};
  const auto tinted = [&wanted, alpha](uint8_t value, uint8_t share, size_t channel) {
    const double a = alpha * share / 255;
    return cv::saturate_cast<uint8_t>(value * (1 - a) + wanted[channel] * a);
  };
  std::array<std::array<uint8_t, 256>, 3> whole;  // where the mask is full, which is nearly everywhere that it is not 0
  for (size_t channel = 0; channel < 3; ++channel) {
    for (size_t value = 0; value < 256; ++value) whole[channel][value] = tinted(uint8_t(value), 255, channel);
  }
  for (int y = 0; y < target.rows; ++y) {
    const uint8_t* share = mask.ptr<uint8_t>(y);
    uint8_t* pixel = target.ptr<uint8_t>(y);
    for (int x = 0; x < target.cols; ++x, pixel += 3) {
      if (share[x] == 0) continue;
      for (size_t channel = 0; channel < 3; ++channel) {
        uint8_t& value = pixel[channel];
        value = share[x] == 255 ? whole[channel][value] : tinted(value, share[x], channel);
      }
    }
  }
}

/// Masks that were drawn lately by this thread: captions are the same from frame to frame but for a number.
template <typename Key>
class RecentMasks {
 public:
  template <typename Draw>
  const cv::Mat& Get(const Key& key, const Draw& draw) {
    constexpr size_t kMany = 64;
    if (masks_.size() >= kMany && !masks_.contains(key)) masks_.clear();
    cv::Mat& mask = masks_[key];
    if (mask.empty()) mask = draw();
    return mask;
  }

 private:
  std::map<Key, cv::Mat> masks_;
};

cv::Mat Shrunk(const cv::Mat& fine) {
  cv::Mat result;
  cv::resize(fine, result, {fine.cols / kFine, fine.rows / kFine}, 0, 0, cv::INTER_AREA);
  return result;
}

/// A rounded rectangle of the given size as a mask.
cv::Mat PanelMask(int width, int height, int radius) {
  cv::Mat fine(height * kFine, width * kFine, CV_8UC1, cv::Scalar(0));
  const int w = fine.cols - 1, h = fine.rows - 1, r = radius * kFine;
  cv::rectangle(fine, {r, 0}, {w - r, h}, 255, cv::FILLED);
  cv::rectangle(fine, {0, r}, {w, h - r}, 255, cv::FILLED);
  for (const cv::Point& centre : {cv::Point(r, r), cv::Point(w - r, r), cv::Point(r, h - r), cv::Point(w - r, h - r)}) {
    cv::circle(fine, centre, r, 255, cv::FILLED);
  }
  return Shrunk(fine);
}

}  // namespace

double WidthOfWords(const std::string& text, double cap_px) {
  int baseline = 0;
  const double width = cv::getTextSize(Printable(text), kFont, cap_px * kFine / kCapHeight, 1, &baseline).width;
  return width / kFine;
}

void DrawWords(const std::string& text, int x, int baseline, double cap_px, Colour colour, Image* image) {
  // An image of the words with room for descenders, and the part of it inside the target.
  const int above = static_cast<int>(std::ceil(1.4 * cap_px)), below = static_cast<int>(std::ceil(0.6 * cap_px));
  const cv::Rect words(x - 2, baseline - above, static_cast<int>(std::ceil(WidthOfWords(text, cap_px))) + 6,
                       above + below);
  const cv::Rect seen = words & cv::Rect(0, 0, image->width, image->height);
  if (seen.empty()) return;
  thread_local RecentMasks<std::tuple<std::string, double>> recent;
  const cv::Mat& mask = recent.Get({text, cap_px}, [&] {
    cv::Mat letters(words.height * kFine, words.width * kFine, CV_8UC1, cv::Scalar(0));
    cv::putText(letters, Printable(text), {2 * kFine, above * kFine}, kFont, cap_px * kFine / kCapHeight, 255,
                std::max(1, int(std::lround(cap_px * kFine / 7.5))), cv::LINE_AA);
    return Shrunk(letters);
  });
  Tint(mask(seen - words.tl()), colour, 1, MatOf(image)(seen));
}

void DrawCaption(const std::vector<CaptionLine>& lines, Corner corner, double height_px, Image* image) {
  if (lines.empty() || image->empty()) return;
  double cap = height_px > 0 ? height_px : std::max(9.0, std::min(image->width, image->height) / 45.0);
  const auto line_width = [&](const CaptionLine& line, double cap_px) {
    return WidthOfWords(line.text, cap_px) + (line.mark != CaptionLine::Mark::kNone ? 1.5 * cap_px : 0.0);
  };
  double widest = 0;
  for (const CaptionLine& line : lines) widest = std::max(widest, line_width(line, cap));
  const double room = image->width - 4.4 * cap;
  if (room <= 0) return;
  if (widest > room) {
    cap *= room / widest;
    widest = room;
  }

  const int padding = static_cast<int>(std::lround(0.9 * cap)), margin = static_cast<int>(std::lround(1.1 * cap));
  const int step = static_cast<int>(std::lround(1.85 * cap));
  const int width = static_cast<int>(std::ceil(widest)) + 2 * padding;
  const int height = static_cast<int>(lines.size() - 1) * step + static_cast<int>(std::lround(1.1 * cap)) + 2 * padding;
  if (width + margin > image->width || height + margin > image->height) return;
  const bool right = corner == Corner::kTopRight || corner == Corner::kBottomRight;
  const bool bottom = corner == Corner::kBottomLeft || corner == Corner::kBottomRight;
  const cv::Rect panel(right ? image->width - margin - width : margin,
                       bottom ? image->height - margin - height : margin, width, height);
  cv::Mat target = MatOf(image)(panel);
  const int radius = std::max(2, static_cast<int>(0.55 * cap));
  thread_local RecentMasks<std::tuple<int, int, int>> panels;
  Tint(panels.Get({width, height, radius}, [&] { return PanelMask(width, height, radius); }), kInkColour, 0.72, target);

  for (size_t i = 0; i < lines.size(); ++i) {
    const int baseline = padding + static_cast<int>(i) * step + static_cast<int>(std::lround(cap));
    int x = padding;
    if (lines[i].mark != CaptionLine::Mark::kNone) {
      const int top = baseline - static_cast<int>(std::ceil(1.2 * cap)), side = static_cast<int>(std::ceil(1.6 * cap));
      const cv::Rect around = cv::Rect(x - 2, top, side, side) & cv::Rect(0, 0, width, height);
      cv::Mat dot(around.height * kFine, around.width * kFine, CV_8UC1, cv::Scalar(0));
      const cv::Point centre(int((x + 0.45 * cap) * kFine), int((baseline - 0.5 * cap) * kFine));
      cv::circle(dot, centre - around.tl() * kFine, static_cast<int>(0.42 * cap * kFine), 255,
                 lines[i].mark == CaptionLine::Mark::kDisc ? int{cv::FILLED}
                                                           : std::max(1, static_cast<int>(0.16 * cap * kFine)));
      Tint(Shrunk(dot), lines[i].colour, 1, target(around));
      x += static_cast<int>(std::lround(1.5 * cap));
    }
    DrawWords(lines[i].text, panel.x + x, panel.y + baseline, cap, kPaperColour, image);
  }
}

}  // namespace bodyloom
