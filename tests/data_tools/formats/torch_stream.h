// SPDX-License-Identifier: Apache-2.0
/// Builds torch.save streams byte by byte, for tests without PyTorch.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "data_tools/formats/zip.h"
#include "tests/data_tools/formats/pickle_writer.h"

namespace bodyloom::torch_stream {

using namespace pickle_writer;  // NOLINT(google-build-using-namespace): opcodes read like the stream they build

/// ('storage', torch.TYPE, KEY, 'cpu', count[, None]) as a persistent id; the legacy format has the sixth item.
inline std::string StorageId(const std::string& type, const std::string& key, int count, bool legacy) {
  std::vector<std::string> items = {Unicode("storage"), Global("torch", type), Unicode(key), Unicode("cpu"),
                                    Int(count)};
  if (legacy) items.push_back("N");
  return Tuple(items) + "Q";
}

inline std::string Tensor(const std::string& storage_id, int offset, const std::vector<int>& shape,
                          const std::vector<int>& stride) {
  return Global("torch._utils", "_rebuild_tensor_v2") +
         Tuple({storage_id, Int(offset), Shape(shape), Shape(stride), "\x89",
                Global("collections", "OrderedDict") + ")R"}) +
         "R";
}

inline std::string Parameter(const std::string& tensor) {
  return Global("torch._utils", "_rebuild_parameter") +
         Tuple({tensor, "\x88", Global("collections", "OrderedDict") + ")R"}) + "R";
}

/// An OrderedDict with the attribute _metadata, as state_dict() returns it.
inline std::string StateDict(const Items& items) {
  std::string entries = "(";
  for (const auto& [key, value] : items) entries += key + value;
  return Global("collections", "OrderedDict") + ")R" + entries + "u}" + Unicode("_metadata") +
         Global("collections", "OrderedDict") + ")Rsb";
}

struct RawStorage {
  std::string key, bytes;
  uint64_t count = 0;
};

inline std::string Legacy(const std::string& object, const std::vector<RawStorage>& storages) {
  std::string keys = "](";
  for (const RawStorage& storage : storages) keys += Unicode(storage.key);
  std::string bytes("\x80\x02\x8a\x0a\x6c\xfc\x9c\x46\xf9\x20\x6a\xa8\x50\x19.", 15);
  bytes += Pickle(2, "M\xe9\x03") +
           Pickle(2, Dict({{Unicode("protocol_version"), "M\xe9\x03"}, {Unicode("little_endian"), "\x88"}})) +
           Pickle(2, object) + Pickle(2, keys + "e");
  for (const RawStorage& storage : storages) bytes += LittleEndian(storage.count, 8) + storage.bytes;
  return bytes;
}

inline std::string Archive(const std::string& object, const std::vector<RawStorage>& storages,
                           const std::vector<ZipMember>& more = {}) {
  std::vector<ZipMember> members = {{"net/data.pkl", Pickle(2, object)}};
  for (const RawStorage& storage : storages) members.push_back({"net/data/" + storage.key, storage.bytes});
  members.push_back({"net/version", "3\n"});
  members.insert(members.end(), more.begin(), more.end());
  return MakeZip(members);
}

/// A small model with every supported case: a matrix, its transpose and a window of it in one storage, a parameter, an
/// expanded scalar, every element type, a nested dictionary, and entries that are not tensors.
struct SmallModel {
  std::string object;
  std::vector<RawStorage> storages;
};

inline SmallModel MakeSmallModel(bool legacy) {
  SmallModel model;
  const auto add = [&](const std::string& type, const std::string& bytes, int count) {
    const std::string key = std::to_string(model.storages.size());
    model.storages.push_back({key, bytes, static_cast<uint64_t>(count)});
    return StorageId(type, key, count, legacy);
  };
  std::vector<float> matrix;
  matrix.reserve(12);
  for (int i = 0; i < 12; ++i) matrix.push_back(static_cast<float>(i));
  const std::string twelve = add("FloatStorage", RawOf(matrix), 12);
  Items items = {{Unicode("a.weight"), Tensor(twelve, 0, {3, 4}, {4, 1})},
                 {Unicode("a.transposed"), Tensor(twelve, 0, {4, 3}, {1, 4})},
                 {Unicode("a.window"), Tensor(twelve, 5, {2, 2}, {4, 1})},
                 {Unicode("a.expanded"), Tensor(twelve, 7, {2, 3}, {0, 0})},
                 {Unicode("a.empty"), Tensor(twelve, 12, {0, 4}, {4, 1})},
                 {Unicode("p"), Parameter(Tensor(add("DoubleStorage", RawOf<double>({1, -2}), 2), 0, {2}, {1}))},
                 {Unicode("scalar"), Tensor(add("LongStorage", RawOf<int64_t>({-7}), 1), 0, {}, {})}};
  const std::vector<std::pair<std::string, std::string>> others = {
      {"HalfStorage", RawOf<uint16_t>({0x3E00, 0xC000})},
      {"BFloat16Storage", RawOf<uint16_t>({0x3FC0, 0xC000})},
      {"IntStorage", RawOf<int32_t>({1, -1})},
      {"ShortStorage", RawOf<int16_t>({1, -1})},
      {"CharStorage", RawOf<int8_t>({1, -1})},
      {"ByteStorage", RawOf<uint8_t>({1, 255})},
      {"BoolStorage", RawOf<uint8_t>({1, 0})}};
  for (const auto& [type, raw] : others) items.emplace_back(Unicode(type), Tensor(add(type, raw, 2), 0, {2}, {1}));
  const std::string in_list = "](" + Tensor(add("FloatStorage", RawOf<float>({9}), 1), 0, {1}, {1}) + "e";
  model.object =
      Dict({{Unicode("state_dict"), StateDict(items)}, {Unicode("epoch"), Int(3)}, {Unicode("list"), in_list}});
  return model;
}

}  // namespace bodyloom::torch_stream
