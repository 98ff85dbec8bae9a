// SPDX-License-Identifier: Apache-2.0
#include "tracking/detection/inference/flatbuffer.h"

#include <stdexcept>

#include "data_tools/formats/printable.h"
#include "geometry/base/check.h"

namespace bodyloom {
namespace {

constexpr size_t kListHead = 4;  // bytes of the list, bytes of the table

/// The number at a place that has been checked.
template <typename T>
T NumberAt(std::string_view file, size_t at) {
  T value;
  std::memcpy(&value, file.data() + at, sizeof(T));
  return value;
}

}  // namespace

FlatTable FlatTable::Root(std::string_view file, std::string_view identifier, const std::string& name) {
  const size_t head = sizeof(uint32_t) + identifier.size();
  const std::string_view found = file.size() < head ? "" : file.substr(sizeof(uint32_t), identifier.size());
  if (found != identifier) {
    throw std::runtime_error(Concatenate(name, ": ", file.size(), " bytes with '", PrintableText(found),
                                         "' at byte 4, expected '", identifier, "'"));
  }
  return {file, NumberAt<uint32_t>(file, 0), name};
}

FlatTable::FlatTable(std::string_view file, size_t at, const std::string& name) : file_(file), name_(&name), at_(at) {
  const auto fail = [&](const std::string& message) {
    throw std::runtime_error(Concatenate(name, ": ", Place(), ": ", message));
  };
  if (at > file.size() || file.size() - at < sizeof(int32_t)) {
    fail(Concatenate("begins behind the file's ", file.size(), " bytes"));
  }
  const int64_t fields = static_cast<int64_t>(at) - NumberAt<int32_t>(file, at);
  if (fields < 0 || fields > static_cast<int64_t>(file.size() - kListHead)) {
    fail(Concatenate("its fields are listed at byte ", fields, " of ", file.size()));
  }
  fields_ = static_cast<size_t>(fields);
  const size_t bytes = NumberAt<uint16_t>(file, fields_);
  if (bytes < kListHead || bytes > file.size() - fields_) {
    fail(Concatenate("a list of fields of ", bytes, " bytes, expected 4 to ", file.size() - fields_));
  }
  num_fields_ = (bytes - kListHead) / sizeof(uint16_t);
}

std::string FlatTable::Place() const { return Concatenate("table at byte ", at_); }

void FlatTable::Fail(int field, const std::string& message) const {
  throw std::runtime_error(Concatenate(*name_, ": ", Place(), ", field ", field, ": ", message));
}

size_t FlatTable::FieldAt(int field, size_t bytes) const {
  if (static_cast<size_t>(field) >= num_fields_) return 0;
  const size_t within = NumberAt<uint16_t>(file_, fields_ + kListHead + static_cast<size_t>(field) * sizeof(uint16_t));
  if (within == 0) return 0;
  const size_t at = at_ + within;
  if (at > file_.size() || file_.size() - at < bytes) {
    Fail(field, Concatenate("lies at byte ", at, ", the file holds ", file_.size()));
  }
  return at;
}

size_t FlatTable::Follow(size_t at, int field) const {
  const size_t to = at + NumberAt<uint32_t>(file_, at);
  if (to == at || to > file_.size() || file_.size() - to < sizeof(uint32_t)) {
    Fail(field, Concatenate("leads to byte ", to, ", expected one between ", at, " and ", file_.size()));
  }
  return to;
}

std::optional<FlatTable> FlatTable::Table(int field) const {
  const size_t at = FieldAt(field, sizeof(uint32_t));
  if (at == 0) return std::nullopt;
  return FlatTable(file_, Follow(at, field), *name_);
}

std::string_view FlatTable::Vector(int field, size_t element_bytes) const {
  const size_t at = FieldAt(field, sizeof(uint32_t));
  if (at == 0) return {};
  const size_t to = Follow(at, field), begin = to + sizeof(uint32_t);
  const size_t count = NumberAt<uint32_t>(file_, to);
  if (count > (file_.size() - begin) / element_bytes) {
    Fail(field, Concatenate(count, " elements of ", element_bytes, " bytes, the file holds ", file_.size() - begin,
                            " bytes behind them"));
  }
  return file_.substr(begin, count * element_bytes);
}

std::vector<FlatTable> FlatTable::Tables(int field, size_t max_count) const {
  const std::string_view offsets = Vector(field, sizeof(uint32_t));
  const size_t count = offsets.size() / sizeof(uint32_t);
  if (count > max_count) Fail(field, Concatenate(count, " tables, expected at most ", max_count));
  std::vector<FlatTable> tables;
  tables.reserve(count);
  for (size_t i = 0; i < count; ++i) {
    const auto at = static_cast<size_t>(offsets.data() - file_.data()) + i * sizeof(uint32_t);
    tables.push_back(FlatTable(file_, Follow(at, field), *name_));
  }
  return tables;
}

}  // namespace bodyloom
