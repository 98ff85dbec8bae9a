// SPDX-License-Identifier: Apache-2.0
#include "data_tools/formats/weights_file.h"

#include <algorithm>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <stdexcept>
#include <utility>
#include <vector>

#include "data_tools/formats/atomic_file.h"
#include "data_tools/formats/element_type.h"
#include "data_tools/formats/printable.h"
#include "data_tools/formats/torch_weights.h"
#include "geometry/base/check.h"

namespace bodyloom {

WeightsFile WeightsFromBytes(const std::string& bytes, const std::string& where, const ReadWeightsOptions& options) {
  WeightsFile file = LooksLikeTorch(bytes) ? TorchWeightsFromBytes(bytes, where, options.max_bytes)
                                           : SafetensorsFromBytes(bytes, where);
  if (!options.widen_halves) return file;
  for (auto& [name, tensor] : file.tensors) {
    if (tensor.dtype != DType::kF16 && tensor.dtype != DType::kBF16) continue;
    tensor = NdArray::FromFloats(tensor.ToFloats().data(), tensor.shape);
  }
  return file;
}

WeightsFile ReadWeights(const std::string& path, const ReadWeightsOptions& options) {
  return WeightsFromBytes(ReadFileBytes(path, options.max_bytes), path, options);
}

namespace {

using nlohmann::json;

constexpr size_t kMaxTensorHeader = 100'000'000;
constexpr size_t kLengthBytes = 8;
constexpr const char* kMetadata = "__metadata__";

struct TypeName {
  const char* name;
  DType dtype;
  size_t item_size;
};
constexpr TypeName kTypes[] = {{"BOOL", DType::kBool, 1}, {"U8", DType::kU8, 1},   {"I8", DType::kI8, 1},
                               {"I16", DType::kI16, 2},   {"F16", DType::kF16, 2}, {"BF16", DType::kBF16, 2},
                               {"I32", DType::kI32, 4},   {"F32", DType::kF32, 4}, {"I64", DType::kI64, 8},
                               {"F64", DType::kF64, 8}};

/// Builds the header's JSON and refuses what the format does not allow: nesting beyond three levels, duplicate keys.
class HeaderGuard {
 public:
  explicit HeaderGuard(const std::string& where) : where_(where) {}

  bool operator()(int depth, json::parse_event_t event, const json& parsed) {
    if (depth > 3) throw std::runtime_error(where_ + ": header: nested deeper than tensors are");
    if (event == json::parse_event_t::object_start) keys_.emplace_back();
    if (event == json::parse_event_t::object_end) keys_.pop_back();
    if (event == json::parse_event_t::key && !keys_.back().insert(parsed.get<std::string>()).second) {
      throw std::runtime_error(where_ + ": header: '" + PrintableText(parsed.get<std::string>()) + "' occurs twice");
    }
    return true;
  }

 private:
  const std::string& where_;
  std::vector<std::set<std::string>> keys_;
};

json ParseHeader(std::string_view text, const std::string& where) {
  if (text.empty() || text.front() != '{') throw std::runtime_error(where + ": header: expected '{' at its start");
  try {
    return json::parse(text, HeaderGuard(where));
  } catch (const json::exception& error) {
    throw std::runtime_error(where + ": header: damaged JSON (" + PrintableText(error.what()) + ")");
  }
}

struct TensorEntry {
  std::string name;
  const TypeName* type = nullptr;
  std::vector<int64_t> shape;
  uint64_t begin = 0, end = 0;
};

/// The whole numbers of an array of the header; nullopt when it is anything else.
std::optional<std::vector<int64_t>> WholeNumbers(const json& entry, const char* key) {
  const auto it = entry.find(key);
  if (it == entry.end() || !it->is_array()) return std::nullopt;
  std::vector<int64_t> numbers;
  for (const json& value : *it) {
    if (!value.is_number_unsigned() || value.get<uint64_t>() > uint64_t{INT64_MAX}) return std::nullopt;
    numbers.push_back(value.get<int64_t>());
  }
  return numbers;
}

TensorEntry ParseEntry(const std::string& name, const json& value, uint64_t data_bytes, const std::string& where) {
  const std::string place = where + ": tensor '" + PrintableText(name) + "': ";
  const auto fail = [&](const std::string& message) { throw std::runtime_error(place + message); };
  if (!value.is_object()) fail("expected an object with dtype, shape and data_offsets");
  TensorEntry entry;
  entry.name = name;
  const auto dtype = value.find("dtype");
  if (dtype == value.end() || !dtype->is_string()) fail("expected its dtype as text");
  const std::string type_name = dtype->get<std::string>();
  const auto type =
      std::find_if(std::begin(kTypes), std::end(kTypes), [&](const auto& t) { return type_name == t.name; });
  if (type == std::end(kTypes)) {
    fail("dtype '" + PrintableText(type_name) + "', expected BOOL, U8, I8, I16, I32, I64, F16, BF16, F32 or F64");
  }
  entry.type = type;
  const auto shape = WholeNumbers(value, "shape");
  if (!shape) fail("expected its shape as an array of whole numbers");
  const auto offsets = WholeNumbers(value, "data_offsets");
  if (!offsets || offsets->size() != 2) fail("expected data_offsets as two whole numbers");
  entry.shape = *shape;
  entry.begin = static_cast<uint64_t>((*offsets)[0]);
  entry.end = static_cast<uint64_t>((*offsets)[1]);
  if (entry.begin > entry.end || entry.end > data_bytes) {
    fail(Concatenate("bytes ", entry.begin, " to ", entry.end, ", the file holds ", data_bytes, " after its header"));
  }
  const std::optional<size_t> bytes = ArrayBytes(entry.shape, entry.type->item_size);
  if (!bytes || *bytes != entry.end - entry.begin) {
    NdArray shape_only;
    shape_only.shape = entry.shape;
    fail(Concatenate("shape ", shape_only.ShapeText(), " of ", entry.type->name, " needs ",
                     bytes ? std::to_string(*bytes) : "too many", " bytes, its data_offsets hold ",
                     entry.end - entry.begin));
  }
  return entry;
}

/// In the order of their bytes; throws unless they lie one behind the other from the first byte to the last.
void RequireCover(std::vector<TensorEntry>* entries, uint64_t data_bytes, const std::string& where) {
  std::sort(entries->begin(), entries->end(), [](const TensorEntry& a, const TensorEntry& b) {
    return std::pair(a.begin, a.end) < std::pair(b.begin, b.end);
  });
  uint64_t at = 0;
  for (const TensorEntry& entry : *entries) {
    if (entry.begin != at) {
      throw std::runtime_error(Concatenate(where, ": tensor '", PrintableText(entry.name), "': starts at byte ",
                                           entry.begin, " of the data, expected ", at, " (",
                                           entry.begin < at ? "tensors overlap" : "a gap", ")"));
    }
    at = entry.end;
  }
  if (at != data_bytes) {
    throw std::runtime_error(Concatenate(where, ": ", data_bytes - at, " bytes after the last tensor, expected none"));
  }
}

}  // namespace

WeightsFile SafetensorsFromBytes(std::string_view bytes, const std::string& where) {
  const auto fail = [&](const std::string& message) { throw std::runtime_error(where + ": " + message); };
  if (bytes.size() < kLengthBytes) fail(Concatenate(bytes.size(), " bytes, expected a safetensors file (at least 8)"));
  uint64_t length = 0;
  for (size_t i = kLengthBytes; i-- > 0;) length = (length << 8) | static_cast<unsigned char>(bytes[i]);
  if (length > kMaxTensorHeader || length > bytes.size() - kLengthBytes) {
    fail(Concatenate("a header of ", length, " bytes, expected at most ",
                     std::min<size_t>(kMaxTensorHeader, bytes.size() - kLengthBytes),
                     " (the file is truncated or not of safetensors)"));
  }
  const json header = ParseHeader(bytes.substr(kLengthBytes, length), where);
  const std::string_view data = bytes.substr(kLengthBytes + length);
  WeightsFile file;
  std::vector<TensorEntry> entries;
  for (const auto& [name, value] : header.items()) {
    if (name != kMetadata) {
      entries.push_back(ParseEntry(name, value, data.size(), where));
      continue;
    }
    if (!value.is_object()) fail("__metadata__: expected text by text");
    for (const auto& [key, text] : value.items()) {
      if (!text.is_string()) fail("__metadata__: '" + PrintableText(key) + "': expected text");
      file.metadata[key] = text.get<std::string>();
    }
  }
  RequireCover(&entries, data.size(), where);
  for (TensorEntry& entry : entries) {
    const ElementType type{entry.type->dtype, entry.type->item_size, false};
    file.tensors[entry.name] =
        ArrayFromBytes(type, std::move(entry.shape), false, data.substr(entry.begin, entry.end - entry.begin));
  }
  return file;
}

WeightsFile ReadSafetensors(const std::string& path, size_t max_bytes) {
  return SafetensorsFromBytes(ReadFileBytes(path, max_bytes), path);
}

std::string SafetensorsBytes(const std::map<std::string, NdArray>& tensors,
                             const std::map<std::string, std::string>& metadata) {
  std::vector<std::pair<const std::string*, const NdArray*>> order;
  order.reserve(tensors.size());
  for (const auto& [name, tensor] : tensors) order.emplace_back(&name, &tensor);
  std::stable_sort(order.begin(), order.end(),
                   [](const auto& a, const auto& b) { return a.second->item_size > b.second->item_size; });
  nlohmann::ordered_json header = nlohmann::ordered_json::object();
  if (!metadata.empty()) header[kMetadata] = metadata;
  std::string data;
  for (const auto& [name, tensor] : order) {
    BODYLOOM_CHECK(*name != kMetadata, "a tensor named ", kMetadata, ", expected another name");
    const auto type = std::find_if(std::begin(kTypes), std::end(kTypes),
                                   [dtype = tensor->dtype](const auto& t) { return dtype == t.dtype; });
    BODYLOOM_CHECK(type != std::end(kTypes), "tensor '", *name,
                   "': a type that safetensors lacks, expected BOOL, U8, I8, I16, I32, I64, F16, BF16, F32 or F64");
    const std::optional<size_t> expected = ArrayBytes(tensor->shape, type->item_size);
    BODYLOOM_CHECK(expected && *expected == tensor->bytes.size(), "tensor '", *name, "' of ", tensor->bytes.size(),
                   " bytes, its shape ", tensor->ShapeText(), " needs another number");
    const size_t begin = data.size();
    data += tensor->bytes;
    header[*name] = {{"dtype", type->name}, {"shape", tensor->shape}, {"data_offsets", {begin, data.size()}}};
  }
  std::string text;
  try {
    text = header.dump();
  } catch (const json::exception& error) {
    BODYLOOM_CHECK(false, "names and metadata of tensors: ", error.what(), ", expected UTF-8");
  }
  text.append((kLengthBytes - text.size() % kLengthBytes) % kLengthBytes, ' ');
  BODYLOOM_CHECK(text.size() <= kMaxTensorHeader, "a header of ", text.size(), " bytes, expected at most ",
                 kMaxTensorHeader);
  std::string bytes;
  bytes.reserve(kLengthBytes + text.size() + data.size());
  for (size_t i = 0; i < kLengthBytes; ++i) bytes.push_back(static_cast<char>(text.size() >> (8 * i)));
  return bytes + text + data;
}

void WriteSafetensors(const std::string& path, const std::map<std::string, NdArray>& tensors,
                      const std::map<std::string, std::string>& metadata) {
  WriteFileAtomically(path, SafetensorsBytes(tensors, metadata));
}

}  // namespace bodyloom
