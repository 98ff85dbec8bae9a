// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/report/plot_svg.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>

namespace bodyloom {
namespace {

constexpr double kWidth = 640, kHeight = 420, kLeft = 70, kRight = 170, kTop = 40, kBottom = 55, kLegendText = 40;
constexpr std::array<const char*, 8> kColours = {"#1f6fb4", "#d1495b", "#2e8b57", "#8a5fbf",
                                                 "#c77800", "#00808a", "#b0307a", "#7a6a00"};

std::string Text(double x, double y, const char* anchor, const std::string& text, const char* more = "") {
  char buffer[160];
  std::snprintf(buffer, sizeof buffer, "<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"%s\" %s>", x, y, anchor, more);
  return buffer + text + "</text>\n";
}

constexpr const char* kLimitColour = "#4d4d4d";

/// One axis: data to [0, 1].
struct Axis {
  bool log = false;
  double low = std::numeric_limits<double>::infinity(), high = -std::numeric_limits<double>::infinity();
  [[nodiscard]] bool Shows(double v) const { return std::isfinite(v) && (!log || v > 0); }
  [[nodiscard]] double Value(double v) const { return log ? std::log10(v) : v; }
  void Include(double v) {
    low = std::min(low, Value(v));
    high = std::max(high, Value(v));
  }
  void Widen() {
    if (!(low <= high)) low = 0, high = 1;
    const double margin = std::max(0.04 * (high - low), log ? 0.03 : 1e-9);
    low -= margin;
    high += margin;
  }
  [[nodiscard]] double At(double v) const { return (Value(v) - low) / (high - low); }
  [[nodiscard]] std::vector<double> Ticks() const {
    std::vector<double> ticks;
    if (log) {
      // The coarsest steps that give four marks or more.
      for (const std::vector<double>& steps : {std::vector<double>{1},
                                               {1, 2, 5},
                                               {1, 2, 3, 4, 5, 6, 8},
                                               {1, 1.2, 1.4, 1.6, 1.8, 2, 2.5, 3, 3.5, 4, 4.5, 5, 6, 7, 8, 9}}) {
        ticks.clear();
        for (int e = static_cast<int>(std::floor(low)); e <= std::ceil(high); ++e) {
          for (double m : steps) {
            const double v = m * std::pow(10.0, e);
            if (Value(v) >= low && Value(v) <= high) ticks.push_back(v);
          }
        }
        if (ticks.size() >= 4) break;
      }
      return ticks;
    }
    const double raw = (high - low) / 5, unit = std::pow(10.0, std::floor(std::log10(raw)));
    const double step = raw / unit < 1.5 ? unit : raw / unit < 3.5 ? 2 * unit : raw / unit < 7.5 ? 5 * unit : 10 * unit;
    for (double v = std::ceil(low / step) * step; v <= high; v += step) ticks.push_back(std::abs(v) < 1e-12 ? 0 : v);
    return ticks;
  }
};

/// The longest name of the legend has to fit in, at some 7 pixels a letter.
double WholeWidth(const Plot& plot) {
  double width = kWidth;
  for (const PlotLine& line : plot.lines) {
    width = std::max(width, kWidth - kRight + kLegendText + 7 * static_cast<double>(line.name.size()));
  }
  return width;
}

}  // namespace

std::string PlotSvg(const Plot& plot) {
  Axis x, y;
  x.log = plot.log_x;
  y.log = plot.log_y;
  for (const PlotLine& line : plot.lines) {
    for (const auto& [px, py] : line.points) {
      if (!x.Shows(px) || !y.Shows(py)) continue;
      x.Include(px);
      y.Include(py);
    }
  }
  x.Widen();
  y.Widen();
  const auto across = [&](double v) { return kLeft + x.At(v) * (kWidth - kLeft - kRight); };
  const auto down = [&](double v) { return kHeight - kBottom - y.At(v) * (kHeight - kTop - kBottom); };
  const double width = WholeWidth(plot);
  char buffer[320];
  std::snprintf(buffer, sizeof buffer,
                "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %.0f %.0f\" width=\"%.0f\" height=\"%.0f\" "
                "font-family=\"sans-serif\" font-size=\"12\">\n<rect width=\"100%%\" height=\"100%%\" "
                "fill=\"#ffffff\"/>\n",
                width, kHeight, width, kHeight);
  std::string svg = buffer;
  svg += Text(kLeft, 24, "start", plot.title, "font-size=\"14\" font-weight=\"bold\"");
  for (double v : x.Ticks()) {
    std::snprintf(buffer, sizeof buffer, "<path d=\"M%.1f %.1fV%.1f\" stroke=\"#dddddd\"/>\n", across(v), kTop,
                  kHeight - kBottom);
    svg += buffer;
    std::snprintf(buffer, sizeof buffer, "%g", v);
    svg += Text(across(v), kHeight - kBottom + 17, "middle", buffer);
  }
  for (double v : y.Ticks()) {
    std::snprintf(buffer, sizeof buffer, "<path d=\"M%.1f %.1fH%.1f\" stroke=\"#dddddd\"/>\n", kLeft, down(v),
                  kWidth - kRight);
    svg += buffer;
    std::snprintf(buffer, sizeof buffer, "%g", v);
    svg += Text(kLeft - 6, down(v) + 4, "end", buffer);
  }
  svg += Text((kLeft + kWidth - kRight) / 2, kHeight - 14, "middle", plot.x_label);
  std::snprintf(buffer, sizeof buffer, "transform=\"rotate(-90 18 %.1f)\"", kHeight / 2);
  svg += Text(18, kHeight / 2, "middle", plot.y_label, buffer);
  for (size_t i = 0; i < plot.lines.size(); ++i) {
    const PlotLine& line = plot.lines[i];
    const char* colour = line.dashed ? kLimitColour : kColours[i % kColours.size()];
    std::string path, marks;
    double before = 0;
    for (const auto& [px, py] : line.points) {
      if (!x.Shows(px) || !y.Shows(py)) continue;
      if (line.stairs && !path.empty()) {
        std::snprintf(buffer, sizeof buffer, "L%.1f %.1f", across(px), before);
        path += buffer;
      }
      std::snprintf(buffer, sizeof buffer, "%s%.1f %.1f", path.empty() ? "M" : "L", across(px), down(py));
      path += buffer;
      before = down(py);
      if (line.dashed || line.stairs) continue;
      std::snprintf(buffer, sizeof buffer, "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"%d\" fill=\"%s\"/>\n", across(px),
                    down(py), line.points.size() == 1 ? 5 : 3, colour);
      marks += buffer;
    }
    std::snprintf(buffer, sizeof buffer, "\" fill=\"none\" stroke=\"%s\" stroke-width=\"1.8\"%s/>\n", colour,
                  line.dashed ? " stroke-dasharray=\"6 4\"" : "");
    svg += "<path d=\"" + path + buffer + marks;
    const double legend = kTop + 12 + 18 * static_cast<double>(i);
    std::snprintf(buffer, sizeof buffer, "<path d=\"M%.1f %.1fh22\" stroke=\"%s\" stroke-width=\"2.5\"%s/>\n",
                  kWidth - kRight + 12, legend - 4, colour, line.dashed ? " stroke-dasharray=\"6 4\"" : "");
    svg += buffer;
    svg += Text(kWidth - kRight + kLegendText, legend, "start", line.name);
  }
  return svg + "</svg>\n";
}

}  // namespace bodyloom
