// SPDX-License-Identifier: Apache-2.0
#include "data_tools/formats/npz.h"

#include <cctype>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <utility>
#include <vector>

#include "data_tools/formats/atomic_file.h"
#include "data_tools/formats/element_type.h"
#include "data_tools/formats/printable.h"
#include "data_tools/formats/zip.h"
#include "geometry/check.h"

namespace bodyloom {
namespace {

constexpr std::string_view kMagic("\x93NUMPY", 6);
constexpr size_t kMaxHeader = size_t{1} << 16;

struct NpyHeader {
  std::string descr;
  bool fortran_order = false;
  std::vector<int64_t> shape;
};

/// Parses the header's Python dictionary literal: exactly the keys descr (text), fortran_order (True/False) and shape
/// (a tuple of integers), in any order.
class HeaderParser {
 public:
  HeaderParser(std::string_view text, const std::string& where) : text_(text), where_(where) {}

  NpyHeader Parse() {
    NpyHeader header;
    bool seen[3] = {false, false, false};
    Expect('{');
    while (!Take('}')) {
      const std::string key = Text("a key");
      Expect(':');
      const int index = key == "descr" ? 0 : key == "fortran_order" ? 1 : key == "shape" ? 2 : -1;
      if (index < 0 || seen[index])
        Fail("the keys descr, fortran_order and shape, once each; found '" + PrintableText(key) + "'");
      seen[index] = true;
      if (index == 0) header.descr = Take('[') ? "structure" + Bracketed() : Text("an element type such as '<f8'");
      if (index == 1) header.fortran_order = Boolean();
      if (index == 2) header.shape = Tuple();
      if (!Take(',')) {
        Expect('}');
        break;
      }
    }
    SkipSpace();
    if (at_ != text_.size()) Fail("nothing after the dictionary");
    if (!seen[0] || !seen[1] || !seen[2]) Fail("the keys descr, fortran_order and shape");
    return header;
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

NdArray ParseNpy(std::string_view bytes, const std::string& where) {
  const auto fail = [&](const std::string& message) { throw std::runtime_error(where + ": " + message); };
  if (bytes.size() < 10 || bytes.substr(0, 6) != kMagic) fail("not a .npy array (no NUMPY mark at its start)");
  const auto byte = [&](size_t i) { return static_cast<size_t>(static_cast<unsigned char>(bytes[i])); };
  const size_t version = byte(6);
  if (version < 1 || version > 3) fail(Concatenate(".npy version ", version, ", expected 1, 2 or 3"));
  const size_t begin = version == 1 ? 10 : 12;
  if (bytes.size() < begin) fail("the file ends inside its header");
  const size_t header_size =
      version == 1 ? byte(8) | byte(9) << 8 : byte(8) | byte(9) << 8 | byte(10) << 16 | byte(11) << 24;
  if (header_size > kMaxHeader) fail(Concatenate("header of ", header_size, " bytes, expected at most ", kMaxHeader));
  if (header_size > bytes.size() - begin) fail("the file ends inside its header");
  NpyHeader header = HeaderParser(bytes.substr(begin, header_size), where).Parse();
  const std::optional<ElementType> type = ParseElementType(header.descr);
  if (!type) {
    NdArray other;
    other.dtype = DType::kOther;
    other.item_size = 0;
    other.bytes = header.descr;
    other.shape = {0};
    return other;
  }
  const std::string_view data = bytes.substr(begin + header_size);
  const std::optional<size_t> expected = ArrayBytes(header.shape, type->item_size);
  if (!expected || *expected != data.size()) {
    NdArray shape_only;
    shape_only.shape = header.shape;
    fail(Concatenate("the header promises ", shape_only.ShapeText(), " elements of '", header.descr, "'",
                     expected ? " (" + std::to_string(*expected) + " bytes)" : std::string(), ", the file holds ",
                     data.size(), " bytes"));
  }
  return ArrayFromBytes(*type, std::move(header.shape), header.fortran_order, data);
}

void RequireReadable(const NdArray& array, const std::string& where) {
  if (array.dtype != DType::kOther) return;
  throw std::runtime_error(where + ": elements of type '" + PrintableText(array.bytes) +
                           "', expected numbers or text (pickled objects, structures, complex numbers and dates are "
                           "never read)");
}

}  // namespace

NpzArrays ReadNpzBytes(const std::string& bytes, const std::string& where, size_t max_bytes) {
  NpzArrays arrays;
  for (ZipMember& member : ReadZip(bytes, where, max_bytes)) {
    std::string name = member.name;
    if (name.size() < 4 || name.substr(name.size() - 4) != ".npy") continue;
    name.resize(name.size() - 4);
    arrays[name] = ParseNpy(member.bytes, where + ": '" + PrintableText(name) + "'");
    std::string().swap(member.bytes);  // so that packed, unpacked and parsed copies do not add up
  }
  return arrays;
}

NpzArrays ReadNpz(const std::string& path, size_t max_bytes) {
  return ReadNpzBytes(ReadFileBytes(path, max_bytes), path, max_bytes);
}

NdArray ReadNpyBytes(const std::string& bytes, const std::string& where) {
  NdArray array = ParseNpy(bytes, where);
  RequireReadable(array, where);
  return array;
}

NdArray ReadNpy(const std::string& path) { return ReadNpyBytes(ReadFileBytes(path), path); }

std::string NpzBytes(const NpzArrays& arrays) {
  std::vector<ZipMember> members;
  for (const auto& [name, array] : arrays) {
    members.push_back({name + ".npy", NpyBytes(array)});
  }
  return MakeZip(members);
}

void WriteNpz(const std::string& path, const NpzArrays& arrays) { WriteFileAtomically(path, NpzBytes(arrays)); }

std::string NpyBytes(const NdArray& array) {
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
  std::string bytes(kMagic);
  bytes += {'\x01', '\x00', static_cast<char>(header.size() & 255), static_cast<char>(header.size() >> 8)};
  return bytes + header + array.bytes;
}

void WriteNpy(const std::string& path, const NdArray& array) { WriteFileAtomically(path, NpyBytes(array)); }

const NdArray& RequireArray(const NpzArrays& arrays, const std::string& name, const std::string& where) {
  const auto it = arrays.find(name);
  if (it != arrays.end()) {
    RequireReadable(it->second, where + ": '" + name + "'");
    return it->second;
  }
  std::vector<std::string> names;
  for (const auto& [key, array] : arrays) names.push_back(key);
  throw std::runtime_error(where + ": no array '" + name + "'; it holds " + PrintableList(names));
}

}  // namespace bodyloom
