// SPDX-License-Identifier: Apache-2.0
/// Scanner for whitespace-separated words and numbers of a text file, plain or gzipped, with line numbers in errors.
/// Used by the text formats of motions (BVH, ASF, AMC).
#pragma once

#include <string>
#include <string_view>
#include <utility>

#include "data_tools/formats/printable.h"

namespace bodyloom {

/// Contents of a file; a gzip file (by its first bytes, not its name) is inflated. Throws std::runtime_error naming the
/// path for a damaged or truncated stream and for more than max_bytes.
std::string ReadTextFile(const std::string& path, size_t max_bytes = size_t{1} << 30);

/// Errors are std::runtime_error "where: line N: found 'x', expected y".
class TextScanner {
 public:
  /// `text` must outlive the scanner; a byte-order mark at its start is passed over. A word that starts with `comment`
  /// makes the rest of its line a comment ('\0': none).
  TextScanner(std::string_view text, std::string where, char comment = '\0')
      : text_(WithoutByteOrderMark(text)), where_(std::move(where)), comment_(comment) {}

  /// From now on Expect(), Accept() and AcceptPrefix() take small letters for capitals and the reverse.
  void IgnoreCase() { ignores_case_ = true; }

  /// Returns the next word without taking it; empty at the end.
  [[nodiscard]] std::string_view Peek();
  /// Takes a word; the end of the text is an error that names what was expected.
  std::string_view Word(const std::string& expected);
  /// Takes exactly this word.
  void Expect(std::string_view word);
  /// Takes the next word if it is this one.
  bool Accept(std::string_view word);
  /// Takes this beginning of the next word, if it has it.
  bool AcceptPrefix(std::string_view prefix);
  /// Takes a finite number.
  double Number(const std::string& expected);
  /// Takes a number that is an integer in [low, high].
  int Integer(const std::string& expected, int low, int high);
  [[nodiscard]] bool AtEnd() { return Peek().empty(); }
  /// Number of words not yet taken (comments count as words).
  [[nodiscard]] size_t CountWords() const;
  /// Returns true if the text ends in a word, without a line break or blank behind it.
  [[nodiscard]] bool EndsInWord() const;
  [[noreturn]] void Fail(const std::string& message) const;

 private:
  std::string_view text_;
  std::string where_;
  char comment_;
  bool ignores_case_ = false;
  size_t next_ = 0;
  size_t line_ = 1;
  std::string_view peeked_;
};

}  // namespace bodyloom
