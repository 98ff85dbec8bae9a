// SPDX-License-Identifier: Apache-2.0
/// A one-page report as a single self-contained HTML file: text, tables, curves and images.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace bodyloom {

class ReportPage {
 public:
  explicit ReportPage(const std::string& title, const std::string& subtitle = "");

  void AddHeading(const std::string& text);
  void AddParagraph(const std::string& text);
  /// Lines in a monospaced block.
  void AddCode(const std::vector<std::string>& lines);
  /// A row of large numbers: (value with unit, label).
  void AddFigures(const std::vector<std::pair<std::string, std::string>>& figures);
  /// A table; the first row is its header. Numeric cells are right-aligned.
  void AddTable(const std::vector<std::vector<std::string>>& rows);
  /// Embeds an encoded image ("image/png", "image/jpeg").
  void AddImage(const std::string& bytes, const std::string& mime_type, const std::string& caption);
  /// Links a video in the page's folder by its file name.
  void AddVideo(const std::string& file_name, const std::string& caption);
  /// Raw HTML; the caller is responsible for escaping.
  void AddHtml(const std::string& html);
  /// Plots y over x (same length; points that are not finite leave a gap), starting at y = 0.
  void AddCurve(const std::vector<double>& x, const std::vector<double>& y, const std::string& x_label,
                const std::string& y_label);

  [[nodiscard]] std::string ToHtml() const;

 private:
  std::string title_, body_;
};

/// Base64 encoding (RFC 4648) with padding.
std::string Base64(const std::string& bytes);

/// Script element with data that the page's scripts read by its id; `text` must not contain "</script".
std::string DataScript(const std::string& id, const std::string& type, const std::string& text);

/// Script element with code embedded in the program (cmake/BodyloomEmbed.cmake).
std::string CodeScript(const unsigned char* begin, const unsigned char* end);

/// Escapes & < > " '.
std::string EscapeHtml(const std::string& text);

}  // namespace bodyloom
