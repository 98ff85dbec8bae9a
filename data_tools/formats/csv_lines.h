// SPDX-License-Identifier: Apache-2.0
/// Text of comma-separated cells, line by line. Quotes have no meaning.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace bodyloom {

/// The cells refer to the text, which must outlive them.
using CsvCells = std::vector<std::string_view>;

class CsvLines {
 public:
  /// A byte-order mark at the start is passed over. `where` names the file in messages.
  CsvLines(std::string_view text, std::string where);

  /// Takes the next line, without its line break; blank lines are passed over. Returns false at the end. Throws
  /// std::runtime_error for more than 100,000 cells.
  bool Next(CsvCells* cells);
  /// Returns the number of a cell of the line taken last, NaN if the cell is empty or says so. Throws
  /// std::runtime_error for anything else.
  [[nodiscard]] double Number(std::string_view cell) const;
  /// Throws std::runtime_error "where: line N: message".
  [[noreturn]] void Fail(const std::string& message) const;

 private:
  std::string_view rest_;
  std::string where_;
  size_t line_ = 0;
};

}  // namespace bodyloom
