// SPDX-License-Identifier: Apache-2.0
#include "data_tools/formats/csv_lines.h"

#include <algorithm>
#include <charconv>
#include <limits>
#include <utility>

#include "data_tools/formats/printable.h"
#include "geometry/base/check.h"

namespace bodyloom {

CsvLines::CsvLines(std::string_view text, std::string where)
    : rest_(WithoutByteOrderMark(text)), where_(std::move(where)) {}

bool CsvLines::Next(CsvCells* cells) {
  constexpr size_t kMaxCells = 100'000;
  std::string_view line;
  while (line.empty()) {
    if (rest_.empty()) return false;
    const size_t end = rest_.find('\n');
    line = rest_.substr(0, end);
    rest_ = end == std::string_view::npos ? std::string_view() : rest_.substr(end + 1);
    if (line.ends_with('\r')) line.remove_suffix(1);
    ++line_;
  }
  cells->clear();
  for (size_t begin = 0; begin <= line.size() && cells->size() <= kMaxCells;) {
    const size_t end = std::min(line.find(',', begin), line.size());
    cells->push_back(line.substr(begin, end - begin));
    begin = end + 1;
  }
  if (cells->size() > kMaxCells) Fail(Concatenate("expected at most ", kMaxCells, " cells"));
  return true;
}

double CsvLines::Number(std::string_view cell) const {
  if (cell.empty() || cell == "nan" || cell == "NaN") return std::numeric_limits<double>::quiet_NaN();
  double value = 0;
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  if (error != std::errc() || end != cell.data() + cell.size()) {
    Fail("found '" + PrintableText(cell) + "', expected a number or nothing");
  }
  return value;
}

void CsvLines::Fail(const std::string& message) const {
  ThrowFileError(where_, Concatenate("line ", line_, ": ", message));
}

}  // namespace bodyloom
