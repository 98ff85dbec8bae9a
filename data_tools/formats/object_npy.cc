// SPDX-License-Identifier: Apache-2.0
#include "data_tools/formats/object_npy.h"

#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include "data_tools/formats/printable.h"
#include "data_tools/formats/zip.h"
#include "geometry/base/check.h"

namespace bodyloom {
namespace {

using Kind = PickleValue::Kind;

constexpr size_t kMaxScalarBytes = size_t{64} << 10, kMaxNpzBytes = size_t{1} << 32;

/// Bytes before the pickle: magic, version, header length, header; 0 when this is no .npy with an object dtype.
size_t ObjectNpyHeaderSize(std::string_view bytes) {
  if (bytes.size() < 12 || bytes.substr(0, 6) != "\x93NUMPY") return 0;
  const auto byte = [&](size_t i) { return size_t{static_cast<unsigned char>(bytes[i])}; };
  const bool is_version_1 = bytes[6] == 1;
  const size_t begin = is_version_1 ? 10 : 12;
  const size_t length = byte(8) + (byte(9) << 8) + (is_version_1 ? 0 : (byte(10) << 16) + (byte(11) << 24));
  if (length > bytes.size() - begin || length > 65536) return 0;
  return bytes.substr(begin, length).find("'|O'") == std::string_view::npos ? 0 : begin + length;
}

}  // namespace

bool IsObjectNpy(std::string_view bytes) { return ObjectNpyHeaderSize(bytes) > 0; }

PicklePtr ReadObjectNpy(std::string_view bytes, const std::string& where) {
  const size_t header = ObjectNpyHeaderSize(bytes);
  if (header == 0) ThrowFileError(where, "not a .npy file of Python objects");
  PicklePtr value = ReadPickle(std::string(bytes.substr(header)), where);
  while (value->kind == Kind::kList && value->items.size() == 1) value = value->items[0];  // the array itself
  return value;
}

PicklePtr ReadObjectOfNpz(const std::string& bytes, const std::string& name, const std::string& where) {
  for (const ZipMember& member : ReadZip(bytes, where, kMaxNpzBytes)) {
    if (member.name == name + ".npy") return ReadObjectNpy(member.bytes, where + ": '" + PrintableText(name) + "'");
  }
  ThrowFileError(where, "no array '" + PrintableText(name) + "'");
}

std::optional<NdArray> ScalarOfObjectNpy(std::string_view bytes) {
  if (bytes.size() > kMaxScalarBytes) return std::nullopt;
  try {
    const PicklePtr value = ReadObjectNpy(bytes, "object");
    if (value->kind == Kind::kString || value->kind == Kind::kBytes) return NdArray::FromString(value->text);
    const double number = NumberOf(value.get());
    if (std::isnan(number)) return std::nullopt;
    return NdArray::FromDouble(number);
  } catch (const std::runtime_error&) {
    return std::nullopt;
  }
}

double NumberOf(const PickleValue* value) {
  if (value == nullptr) return std::numeric_limits<double>::quiet_NaN();
  if (value->kind == Kind::kInt) return static_cast<double>(value->integer);
  if (value->kind == Kind::kFloat) return value->real;
  if (value->kind == Kind::kArray && value->array.is_number() && value->array.num_elements() == 1) {
    return value->array.ToDoubles()[0];
  }
  return std::numeric_limits<double>::quiet_NaN();
}

}  // namespace bodyloom
