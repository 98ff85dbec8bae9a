// SPDX-License-Identifier: Apache-2.0
#include "data_tools/formats/mat_headers.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include "geometry/base/check.h"

namespace bodyloom {
namespace {

constexpr size_t kFileHeader = 128, kVersion = 124, kSignature = 126, kTag = 8;
constexpr uint32_t kMatrix = 14, kCompressed = 15, kUint32 = 6, kInt32 = 5, kInt8 = 1;  // data types
constexpr uint32_t kFirstNumericClass = 6, kLastNumericClass = 15;
constexpr uint32_t kMaxDimensions = 16, kMaxName = 63;
/// Tag of the matrix, its flags, dimensions, and the tag of its name.
constexpr size_t kLongestHead = kTag + 2 * kTag + kTag + 4 * kMaxDimensions + kTag;

class HeaderWords {
 public:
  HeaderWords(const unsigned char* bytes, size_t size, bool swapped) : bytes_(bytes), size_(size), swapped_(swapped) {}
  [[nodiscard]] bool Has(size_t at, size_t n) const { return at <= size_ && n <= size_ - at; }
  [[nodiscard]] uint32_t At(size_t at) const {
    uint32_t word;
    std::memcpy(&word, bytes_ + at, sizeof(word));
    return swapped_ ? __builtin_bswap32(word) : word;
  }
  [[nodiscard]] const unsigned char* bytes(size_t at) const { return bytes_ + at; }

 private:
  const unsigned char* bytes_;
  size_t size_;
  bool swapped_;
};

/// The first bytes of a compressed variable; fewer when it is shorter or damaged.
size_t Inflate(const unsigned char* bytes, size_t size, std::array<unsigned char, kLongestHead>* head) {
  z_stream stream{};
  stream.next_in = const_cast<unsigned char*>(bytes);  // zlib does not write there
  stream.avail_in = static_cast<uInt>(size);
  stream.next_out = head->data();
  stream.avail_out = static_cast<uInt>(head->size());
  if (inflateInit(&stream) != Z_OK) throw std::bad_alloc();
  inflate(&stream, Z_SYNC_FLUSH);
  inflateEnd(&stream);
  return head->size() - stream.avail_out;
}

/// Describes the fault in the head of a matrix; empty: none.
std::string Fault(const HeaderWords& head) {
  if (!head.Has(0, 4 * kTag)) return "a variable that is cut short";
  if (head.At(0) != kMatrix) return Concatenate("data of type ", head.At(0), ", expected a matrix");
  if (head.At(kTag) != kUint32 || head.At(kTag + 4) != 8) return "a matrix without flags";
  const uint32_t matrix_class = head.At(2 * kTag) & 0xFF;
  if (matrix_class < kFirstNumericClass || matrix_class > kLastNumericClass) {
    return Concatenate("a variable of class ", matrix_class, ", expected a matrix of numbers");
  }
  const uint32_t dimension_bytes = head.At(3 * kTag + 4);
  if (head.At(3 * kTag) != kInt32 || dimension_bytes < 8 || dimension_bytes > 4 * kMaxDimensions ||
      dimension_bytes % 4 != 0) {
    return Concatenate("a matrix whose sizes take ", dimension_bytes, " bytes, expected 4 for each of two to ",
                       kMaxDimensions, " dimensions");
  }
  const size_t name = 4 * kTag + (dimension_bytes + 7) / 8 * 8;
  if (!head.Has(name, kTag)) return "a variable that is cut short";
  const uint32_t short_length = head.At(name) >> 16;  // names of up to four characters share their tag
  const uint32_t length = short_length != 0 ? short_length : head.At(name + 4);
  if ((head.At(name) & 0xFFFF) != kInt8 || length > kMaxName) {
    return Concatenate("a variable whose name takes ", length, " bytes, expected 1 to ", kMaxName);
  }
  return "";
}

}  // namespace

void CheckMatHeaders(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw std::runtime_error(path + ": cannot be opened, expected a MATLAB file");
  const std::string bytes((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  using namespace std::string_literals;
  const std::string signature = bytes.size() < kFileHeader ? "" : bytes.substr(kSignature, 2);
  const bool swapped = signature == "MI";
  const std::string version = bytes.size() < kFileHeader ? "" : bytes.substr(kVersion, 2);
  // libmatio reads anything other than 5 and 7.3 as version 4, whose headers claim sizes too.
  if ((signature != "IM" && !swapped) || version != (swapped ? "\1\0"s : "\0\1"s)) {
    throw std::runtime_error(path + ": not a MATLAB version 5 file, expected one saved with -v6 or -v7");
  }
  const HeaderWords words(reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size(), swapped);
  size_t at = kFileHeader;
  while (at < bytes.size()) {
    const auto fail = [&](const std::string& what) {
      throw std::runtime_error(Concatenate(path, ": byte ", at, ": ", what));
    };
    if (!words.Has(at, kTag)) fail("a variable that is cut short");
    const uint32_t type = words.At(at), size = words.At(at + 4);
    if (!words.Has(at + kTag, size)) fail(Concatenate("a variable of ", size, " bytes, beyond the end of the file"));
    std::string fault;
    if (type == kCompressed) {
      std::array<unsigned char, kLongestHead> head{};
      const size_t n = Inflate(words.bytes(at + kTag), size, &head);
      fault = Fault(HeaderWords(head.data(), n, swapped));
    } else {
      fault = Fault(HeaderWords(words.bytes(at), kTag + size, swapped));
    }
    if (!fault.empty()) fail(fault);
    at += kTag + size;
  }
}

}  // namespace bodyloom
