// SPDX-License-Identifier: Apache-2.0
#include "pipelines/page/report_page.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>

#include "geometry/base/check.h"

namespace bodyloom {
namespace {

constexpr const char* kStyle = R"(
body { font: 16px/1.5 system-ui, sans-serif; color: #1a202c; background: #f8f9fb; margin: 0; }
main { max-width: 980px; margin: 0 auto; padding: 32px 20px 60px; }
h1 { margin: 0; font-size: 30px; } h2 { margin: 36px 0 10px; font-size: 20px; }
p.sub { color: #4a5568; margin: 4px 0 24px; }
.figures { display: flex; flex-wrap: wrap; gap: 14px; margin: 18px 0; }
.figures div { background: #fff; border: 1px solid #e2e8f0; border-radius: 8px; padding: 12px 18px; }
.figures b { display: block; font-size: 24px; color: #2b6cb0; } .figures span { color: #4a5568; font-size: 14px; }
table { border-collapse: collapse; background: #fff; margin: 10px 0; }
th, td { border: 1px solid #e2e8f0; padding: 5px 12px; text-align: left; font-size: 15px; }
th { background: #edf2f7; } td.n { text-align: right; font-variant-numeric: tabular-nums; }
figure { margin: 16px 0; } figure img, figure video, figure svg { max-width: 100%; border-radius: 6px; background: #fff; }
pre { background: #edf2f7; padding: 12px; border-radius: 6px; white-space: pre-wrap; font-size: 14px; }
figcaption { color: #4a5568; font-size: 14px; }
)";

std::string Number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}

std::string Figure(const std::string& content, const std::string& caption) {
  return "<figure>" + content + "<figcaption>" + EscapeHtml(caption) + "</figcaption></figure>\n";
}

/// The smallest of 1, 2, 5 × a power of ten that is not below `value` (positive).
double RoundUp(double value) {
  const double power = std::pow(10.0, std::floor(std::log10(value)));
  for (const double step : {1.0, 2.0, 5.0}) {
    if (value <= step * power) {
      return step * power;
    }
  }
  return 10 * power;
}

}  // namespace

std::string Base64(const std::string& bytes) {
  static constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (size_t i = 0; i < bytes.size(); i += 3) {
    const size_t n = std::min<size_t>(3, bytes.size() - i);
    uint32_t group = 0;
    for (size_t k = 0; k < 3; ++k) {
      group = group << 8 | (k < n ? static_cast<uint8_t>(bytes[i + k]) : 0);
    }
    for (size_t k = 0; k < 4; ++k) {
      text += k <= n ? kDigits[group >> (18 - 6 * k) & 63] : '=';
    }
  }
  return text;
}

std::string EscapeHtml(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    switch (c) {
      case '&':
        escaped += "&amp;";
        break;
      case '<':
        escaped += "&lt;";
        break;
      case '>':
        escaped += "&gt;";
        break;
      case '"':
        escaped += "&quot;";
        break;
      case '\'':
        escaped += "&#39;";
        break;
      default:
        escaped += c;
    }
  }
  return escaped;
}

std::string DataScript(const std::string& id, const std::string& type, const std::string& text) {
  return "<script id=\"" + id + "\" type=\"" + type + "\">" + text + "</script>\n";
}

std::string CodeScript(const unsigned char* begin, const unsigned char* end) {
  return "<script>" + std::string(begin, end) + "</script>\n";
}

ReportPage::ReportPage(const std::string& title, const std::string& subtitle) : title_(title) {
  body_ = "<h1>" + EscapeHtml(title) + "</h1>\n";
  if (!subtitle.empty()) {
    body_ += "<p class=\"sub\">" + EscapeHtml(subtitle) + "</p>\n";
  }
}

void ReportPage::AddHeading(const std::string& text) { body_ += "<h2>" + EscapeHtml(text) + "</h2>\n"; }

void ReportPage::AddParagraph(const std::string& text) { body_ += "<p>" + EscapeHtml(text) + "</p>\n"; }

void ReportPage::AddCode(const std::vector<std::string>& lines) {
  body_ += "<pre>";
  for (const std::string& line : lines) {
    body_ += EscapeHtml(line) + "\n";
  }
  body_ += "</pre>\n";
}

void ReportPage::AddFigures(const std::vector<std::pair<std::string, std::string>>& figures) {
  body_ += "<div class=\"figures\">";
  for (const auto& [value, meaning] : figures) {
    body_ += "<div><b>" + EscapeHtml(value) + "</b><span>" + EscapeHtml(meaning) + "</span></div>";
  }
  body_ += "</div>\n";
}

void ReportPage::AddTable(const std::vector<std::vector<std::string>>& rows) {
  body_ += "<table>\n";
  for (size_t r = 0; r < rows.size(); ++r) {
    body_ += "<tr>";
    for (const std::string& cell : rows[r]) {
      const bool is_number = !cell.empty() && cell.find_first_not_of("0123456789.-+e") == std::string::npos;
      const std::string tag = r == 0 ? "th" : "td";
      body_ += "<" + tag + (r > 0 && is_number ? " class=\"n\"" : "") + ">" + EscapeHtml(cell) + "</" + tag + ">";
    }
    body_ += "</tr>\n";
  }
  body_ += "</table>\n";
}

void ReportPage::AddImage(const std::string& bytes, const std::string& mime_type, const std::string& caption) {
  body_ += Figure(
      "<img alt=\"" + EscapeHtml(caption) + "\" src=\"data:" + mime_type + ";base64," + Base64(bytes) + "\">", caption);
}

void ReportPage::AddVideo(const std::string& file_name, const std::string& caption) {
  body_ +=
      Figure("<video controls loop muted autoplay playsinline src=\"" + EscapeHtml(file_name) + "\"></video>", caption);
}

void ReportPage::AddHtml(const std::string& html) { body_ += html; }

void ReportPage::AddCurve(const std::vector<double>& x, const std::vector<double>& y, const std::string& x_label,
                          const std::string& y_label) {
  BODYLOOM_CHECK(x.size() == y.size() && !x.empty(), "a curve has ", x.size(), " x and ", y.size(),
                 " y values, expected as many of each and at least one");
  constexpr double kWidth = 920, kHeight = 220, kLeft = 60, kBottom = 40, kTop = 14, kRight = 12;
  double y_max = 0;
  for (const double value : y) {
    y_max = std::isfinite(value) ? std::max(y_max, value) : y_max;
  }
  y_max = y_max > 0 ? RoundUp(y_max) : 1;
  const double x_min = x.front(), x_span = x.back() > x.front() ? x.back() - x.front() : 1;
  const auto at_x = [&](double value) { return kLeft + (kWidth - kLeft - kRight) * (value - x_min) / x_span; };
  const auto at_y = [&](double value) { return kTop + (kHeight - kTop - kBottom) * (1 - value / y_max); };
  const auto text = [](double px, double py, const std::string& anchor, const std::string& words) {
    return "<text x=\"" + Number(px) + "\" y=\"" + Number(py) + "\" text-anchor=\"" + anchor +
           "\" font-size=\"13\" fill=\"#4a5568\">" + EscapeHtml(words) + "</text>";
  };
  std::string svg = "<svg viewBox=\"0 0 " + Number(kWidth) + " " + Number(kHeight) + "\" role=\"img\">";
  for (const double part : {0.0, 0.5, 1.0}) {
    const std::string py = Number(at_y(part * y_max));
    svg += "<line x1=\"" + Number(kLeft) + "\" x2=\"" + Number(kWidth - kRight) + "\" y1=\"" + py + "\" y2=\"" + py +
           "\" stroke=\"#e2e8f0\"/>" + text(kLeft - 8, at_y(part * y_max) + 4, "end", Number(part * y_max)) +
           text(at_x(x_min + part * x_span), kHeight - kBottom + 18,
                part == 0   ? "start"
                : part == 1 ? "end"
                            : "middle",
                Number(x_min + part * x_span));
  }
  std::string path;
  bool pen_down = false;
  for (size_t i = 0; i < x.size(); ++i) {
    if (!std::isfinite(y[i])) {
      pen_down = false;
      continue;
    }
    path += (pen_down ? "L" : "M") + Number(at_x(x[i])) + " " + Number(at_y(y[i]));
    pen_down = true;
  }
  svg += "<path d=\"" + path + "\" fill=\"none\" stroke=\"#2b6cb0\" stroke-width=\"1.6\"/></svg>";
  body_ += Figure(svg, y_label + " over " + x_label);
}

std::string ReportPage::ToHtml() const {
  return "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">"
         "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"><title>" +
         EscapeHtml(title_) + "</title><style>" + kStyle + "</style></head>\n<body><main>\n" + body_ +
         "</main></body></html>\n";
}

}  // namespace bodyloom
