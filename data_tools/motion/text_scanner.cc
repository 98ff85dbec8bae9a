// SPDX-License-Identifier: Apache-2.0
#include "data_tools/motion/text_scanner.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <stdexcept>

#include "data_tools/formats/atomic_file.h"
#include "data_tools/formats/inflate.h"
#include "data_tools/formats/printable.h"

namespace bodyloom {
namespace {

bool IsSpace(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == '\f' || c == '\v'; }

bool AreEqual(std::string_view a, std::string_view b, bool ignores_case) {
  const auto same = [](char x, char y) {
    return std::tolower(static_cast<unsigned char>(x)) == std::tolower(static_cast<unsigned char>(y));
  };
  return ignores_case ? std::equal(a.begin(), a.end(), b.begin(), b.end(), same) : a == b;
}

}  // namespace

std::string ReadTextFile(const std::string& path, size_t max_bytes) {
  std::string bytes = ReadFileBytes(path, max_bytes);
  if (LooksLikeGzip(bytes)) return Inflate(bytes, path, max_bytes);
  return bytes;
}

std::string_view TextScanner::Peek() {
  if (!peeked_.empty()) return peeked_;
  while (next_ < text_.size()) {
    const char c = text_[next_];
    if (c == '\n') ++line_;
    if (IsSpace(c)) {
      ++next_;
    } else if (comment_ != '\0' && c == comment_) {
      while (next_ < text_.size() && text_[next_] != '\n') ++next_;
    } else {
      break;
    }
  }
  size_t end = next_;
  while (end < text_.size() && !IsSpace(text_[end])) ++end;
  peeked_ = text_.substr(next_, end - next_);
  return peeked_;
}

std::string_view TextScanner::Word(const std::string& expected) {
  const std::string_view word = Peek();
  if (word.empty()) Fail("the file ends, expected " + expected);
  next_ += word.size();
  peeked_ = {};
  return word;
}

void TextScanner::Expect(std::string_view word) {
  if (!AreEqual(Peek(), word, ignores_case_)) {
    const std::string found = PrintableText(Peek());
    Fail(found.empty() ? "the file ends, expected '" + std::string(word) + "'"
                       : "found '" + found + "', expected '" + std::string(word) + "'");
  }
  Word("");
}

bool TextScanner::Accept(std::string_view word) {
  if (!AreEqual(Peek(), word, ignores_case_)) return false;
  Word("");
  return true;
}

bool TextScanner::AcceptPrefix(std::string_view prefix) {
  if (!AreEqual(Peek().substr(0, prefix.size()), prefix, ignores_case_)) return false;
  next_ += prefix.size();
  peeked_ = {};
  return true;
}

size_t TextScanner::CountWords() const {
  size_t count = 0;
  bool in_word = false;
  for (size_t i = next_; i < text_.size(); ++i) {
    const bool is_word = !IsSpace(text_[i]);
    count += is_word && !in_word ? 1 : 0;
    in_word = is_word;
  }
  return count;
}

bool TextScanner::EndsInWord() const { return !text_.empty() && !IsSpace(text_.back()); }

double TextScanner::Number(const std::string& expected) {
  const std::string_view word = Word(expected);
  const char* begin = word.data();
  const char* end = begin + word.size();
  if (begin != end && *begin == '+') ++begin;
  double value = 0;
  const auto [stop, error] = std::from_chars(begin, end, value);
  // 1e-400 is zero; from_chars does not set the value and does not distinguish overflow from underflow.
  const bool is_tiny = error == std::errc::result_out_of_range && word.find_first_of("eE") != std::string_view::npos &&
                       word[word.find_first_of("eE") + 1] == '-';
  if ((error != std::errc() && !is_tiny) || stop != end || !std::isfinite(value)) {
    Fail("found '" + PrintableText(word) + "', expected " + expected);
  }
  return is_tiny ? 0 : value;
}

int TextScanner::Integer(const std::string& expected, int low, int high) {
  const double value = Number(expected);
  if (value != std::floor(value) || value < low || value > high) {
    Fail("found " + std::to_string(value) + ", expected " + expected + " from " + std::to_string(low) + " to " +
         std::to_string(high));
  }
  return static_cast<int>(value);
}

void TextScanner::Fail(const std::string& message) const {
  throw std::runtime_error(where_ + ": line " + std::to_string(line_) + ": " + message);
}

}  // namespace bodyloom
