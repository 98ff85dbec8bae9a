// SPDX-License-Identifier: Apache-2.0
/// Whitespace-separated words and numbers of a text file, with line numbers in every error; and the file itself,
/// gzipped or not. Used by the motion formats that are text (BVH, ASF, AMC).
#pragma once

#include <string>
#include <string_view>

namespace bodyloom {

/// Contents of a file; a gzip file (by its first bytes, not its name) is inflated. Throws std::runtime_error naming the
/// path for a damaged or truncated stream and for more than max_bytes.
std::string ReadTextFile(const std::string& path, size_t max_bytes = size_t{1} << 30);

/// Errors are std::runtime_error "where: line N: found 'x', expected y".
class TextScanner {
 public:
  /// `text` must outlive the scanner. A word that starts with `comment` hides the rest of its line ('\0': none).
  TextScanner(std::string_view text, std::string where, char comment = '\0')
      : text_(text), where_(std::move(where)), comment_(comment) {}

  /// The next word without taking it; empty at the end.
  [[nodiscard]] std::string_view Peek();
  /// Takes a word; at the end of the text this is an error naming what was expected.
  std::string_view Word(const std::string& expected);
  /// Takes exactly this word.
  void Expect(std::string_view word);
  /// Takes the next word if it is this one.
  bool Accept(std::string_view word);
  /// Takes a finite number.
  double Number(const std::string& expected);
  /// Takes a number that is an integer in [low, high].
  int Integer(const std::string& expected, int low, int high);
  [[nodiscard]] bool AtEnd() { return Peek().empty(); }
  /// Bytes not yet taken, an upper bound for what can follow.
  [[nodiscard]] size_t remaining_bytes() const { return text_.size() - next_; }
  [[noreturn]] void Fail(const std::string& message) const;

 private:
  std::string_view text_;
  std::string where_;
  char comment_;
  size_t next_ = 0;
  size_t line_ = 1;
  std::string_view peeked_;
};

}  // namespace bodyloom
