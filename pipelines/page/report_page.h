// SPDX-License-Identifier: Apache-2.0
/// A one-page report as a single HTML file: text, tables, curves and pictures inside it, nothing fetched from
/// elsewhere.
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
  /// Lines as they are typed.
  void AddCode(const std::vector<std::string>& lines);
  /// Big numbers in a row: (value with unit, what it is).
  void AddFigures(const std::vector<std::pair<std::string, std::string>>& figures);
  /// A table; the first row is its head. Cells that are numbers are set to the right.
  void AddTable(const std::vector<std::vector<std::string>>& rows);
  /// An encoded picture ("image/png", "image/jpeg") becomes part of the page.
  void AddPicture(const std::string& bytes, const std::string& mime_type, const std::string& caption);
  /// A video that lies beside the page, by its file name.
  void AddVideo(const std::string& file_name, const std::string& caption);
  /// HTML as it is: whoever calls has escaped what needs it.
  void AddHtml(const std::string& html);
  /// A curve of y over x (same length; points that are not finite leave a gap), from y = 0 up.
  void AddCurve(const std::vector<double>& x, const std::vector<double>& y, const std::string& x_label,
                const std::string& y_label);

  [[nodiscard]] std::string ToHtml() const;

 private:
  std::string title_, body_;
};

/// RFC 4648, with padding.
std::string Base64(const std::string& bytes);

/// Text that a script of the page reads by its id; it must not hold "</script".
std::string DataScript(const std::string& id, const std::string& type, const std::string& text);

/// A script that the program carries (cmake/BodyloomEmbed.cmake).
std::string CodeScript(const unsigned char* begin, const unsigned char* end);

/// & < > " ' replaced.
std::string EscapeHtml(const std::string& text);

}  // namespace bodyloom
