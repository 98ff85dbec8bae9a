// SPDX-License-Identifier: Apache-2.0
#include "data_tools/formats/npy_header.h"

#include <cctype>
#include <stdexcept>

#include "data_tools/formats/printable.h"
#include "geometry/base/check.h"

namespace bodyloom {
namespace {

constexpr std::string_view kMagic("\x93NUMPY", 6);
constexpr size_t kLongestMark = 12;  ///< with version and the header's length
constexpr size_t kMaxHeader = kMaxNpyHeaderBytes - kLongestMark;

/// Parses the header's Python dictionary literal: exactly the keys descr (text), fortran_order (True/False) and shape
/// (a tuple of integers), in any order.
class HeaderParser {
 public:
  HeaderParser(std::string_view text, const std::string& where) : text_(text), where_(where) {}

  void Parse(NpyHeader* header) {
    bool seen[3] = {false, false, false};
    Expect('{');
    while (!Take('}')) {
      const std::string key = Text("a key");
      Expect(':');
      const int index = key == "descr" ? 0 : key == "fortran_order" ? 1 : key == "shape" ? 2 : -1;
      if (index < 0 || seen[index])
        Fail("the keys descr, fortran_order and shape, once each; found '" + PrintableText(key) + "'");
      seen[index] = true;
      if (index == 0) header->descr = Take('[') ? "structure" + Bracketed() : Text("an element type such as '<f8'");
      if (index == 1) header->fortran_order = Boolean();
      if (index == 2) header->shape = Tuple();
      if (!Take(',')) {
        Expect('}');
        break;
      }
    }
    SkipSpace();
    if (at_ != text_.size()) Fail("nothing after the dictionary");
    if (!seen[0] || !seen[1] || !seen[2]) Fail("the keys descr, fortran_order and shape");
  }

 private:
  [[noreturn]] void Fail(const std::string& expected) const {
    throw std::runtime_error(Concatenate(where_, ": .npy header, character ", at_, ": expected ", expected));
  }
  void SkipSpace() {
    while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\n' || text_[at_] == '\t')) ++at_;
  }
  bool Take(char c) {
    SkipSpace();
    if (at_ >= text_.size() || text_[at_] != c) return false;
    ++at_;
    return true;
  }
  void Expect(char c) {
    if (!Take(c)) Fail(std::string("'") + c + "'");
  }
  std::string Text(const char* what) {
    SkipSpace();
    if (at_ >= text_.size() || (text_[at_] != '\'' && text_[at_] != '"')) Fail(what);
    const size_t end = text_.find(text_[at_], at_ + 1);
    if (end == std::string_view::npos) Fail("a closing quote");
    std::string text(text_.substr(at_ + 1, end - at_ - 1));
    at_ = end + 1;
    return text;
  }
  /// The rest of a list up to its closing bracket (the description of a structured type, which is only skipped).
  std::string Bracketed() {
    const size_t begin = at_ - 1;
    for (int depth = 1; depth > 0; ++at_) {
      if (at_ >= text_.size()) Fail("']'");
      if (text_[at_] == '[') ++depth;
      if (text_[at_] == ']') --depth;
    }
    return std::string(text_.substr(begin, at_ - begin));
  }
  bool Boolean() {
    SkipSpace();
    for (const std::string_view word : {std::string_view("True"), std::string_view("False")}) {
      if (text_.substr(at_, word.size()) != word) continue;
      at_ += word.size();
      return word == "True";
    }
    Fail("True or False");
  }
  std::vector<int64_t> Tuple() {
    std::vector<int64_t> values;
    Expect('(');
    while (!Take(')')) {
      SkipSpace();
      int64_t value = 0;
      const size_t begin = at_;
      while (at_ < text_.size() && std::isdigit(static_cast<unsigned char>(text_[at_])) != 0) {
        if (at_ - begin == 18) Fail("a dimension below 10^18");
        value = 10 * value + (text_[at_++] - '0');
      }
      if (at_ == begin) Fail("a whole number");
      Take('L');  // Python 2 wrote long integers so
      values.push_back(value);
      if (!Take(',')) {
        Expect(')');
        break;
      }
    }
    return values;
  }

  std::string_view text_;
  const std::string& where_;
  size_t at_ = 0;
};

}  // namespace

NpyHeader ParseNpyHeader(std::string_view head, size_t file_bytes, const std::string& where) {
  const auto fail = [&](const std::string& message) { throw std::runtime_error(where + ": " + message); };
  if (head.size() < 10 || head.substr(0, 6) != kMagic) fail("not a .npy array (no NUMPY mark at its start)");
  const auto byte = [&](size_t i) { return static_cast<size_t>(static_cast<unsigned char>(head[i])); };
  const size_t version = byte(6);
  if (version < 1 || version > 3) fail(Concatenate(".npy version ", version, ", expected 1, 2 or 3"));
  const size_t begin = version == 1 ? 10 : 12;
  if (head.size() < begin) fail("the file ends inside its header");
  const size_t header_size =
      version == 1 ? byte(8) | byte(9) << 8 : byte(8) | byte(9) << 8 | byte(10) << 16 | byte(11) << 24;
  if (header_size > kMaxHeader) fail(Concatenate("header of ", header_size, " bytes, expected at most ", kMaxHeader));
  if (header_size > head.size() - begin) fail("the file ends inside its header");
  NpyHeader header;
  HeaderParser(head.substr(begin, header_size), where).Parse(&header);
  header.data_begin = begin + header_size;
  header.type = ParseElementType(header.descr);
  if (!header.type) return header;
  const size_t data_bytes = file_bytes - header.data_begin;
  const std::optional<size_t> expected = ArrayBytes(header.shape, header.type->item_size);
  if (!expected || *expected != data_bytes) {
    NdArray shape_only;
    shape_only.shape = header.shape;
    fail(Concatenate("the header promises ", shape_only.ShapeText(), " elements of '", header.descr, "'",
                     expected ? " (" + std::to_string(*expected) + " bytes)" : std::string(), ", the file holds ",
                     data_bytes, " bytes"));
  }
  return header;
}

std::string NpyHeaderText(const NdArray& array) {
  BODYLOOM_CHECK(array.dtype != DType::kOther, "an array of elements '", array.bytes, "' has no contents to write");
  BODYLOOM_CHECK(array.dtype != DType::kBF16, "numpy has no bfloat16, expected float32 or another of its types");
  std::string header = "{'descr': '" + ElementTypeText(array) + "', 'fortran_order': False, 'shape': (";
  for (size_t d = 0; d < array.shape.size(); ++d) {
    header += std::to_string(array.shape[d]) + (d + 1 < array.shape.size() ? ", " : "");
  }
  header += array.shape.size() == 1 ? ",), }" : "), }";
  // The data starts at a multiple of 64 bytes so that it can be mapped; the padding ends in a line break.
  header.append(63 - (kMagic.size() + 4 + header.size()) % 64, ' ');
  header.push_back('\n');
  BODYLOOM_CHECK(header.size() < kMaxHeader, "array of rank ", array.shape.size(), ", expected at most 32");
  std::string mark(kMagic);
  mark += {'\x01', '\x00', static_cast<char>(header.size() & 255), static_cast<char>(header.size() >> 8)};
  return mark + header;
}

}  // namespace bodyloom
