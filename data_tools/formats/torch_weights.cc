// SPDX-License-Identifier: Apache-2.0
#include "data_tools/formats/torch_weights.h"

#include <algorithm>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <stdexcept>
#include <unordered_set>
#include <utility>
#include <vector>

#include "data_tools/formats/atomic_file.h"
#include "data_tools/formats/element_type.h"
#include "data_tools/formats/pickle.h"
#include "data_tools/formats/printable.h"
#include "data_tools/formats/zip.h"
#include "geometry/base/check.h"

namespace bodyloom {
namespace {

using Kind = PickleValue::Kind;

/// torch.save's magic number 0x1950a86a20f9469cfc6c as pickle protocol 2 writes it.
constexpr std::string_view kLegacyMagic("\x80\x02\x8a\x0a\x6c\xfc\x9c\x46\xf9\x20\x6a\xa8\x50\x19.", 15);
constexpr int64_t kLegacyProtocol = 1001;
constexpr size_t kMaxEntries = 200'000;
constexpr size_t kMaxTensorName = 1024;
constexpr size_t kMaxRank = 32;

struct StorageType {
  std::string_view name;
  ElementType type;
};
constexpr StorageType kStorageTypes[] = {
    {"torch.DoubleStorage", {DType::kF64, 8, false}}, {"torch.FloatStorage", {DType::kF32, 4, false}},
    {"torch.HalfStorage", {DType::kF16, 2, false}},   {"torch.BFloat16Storage", {DType::kBF16, 2, false}},
    {"torch.LongStorage", {DType::kI64, 8, false}},   {"torch.IntStorage", {DType::kI32, 4, false}},
    {"torch.ShortStorage", {DType::kI16, 2, false}},  {"torch.CharStorage", {DType::kI8, 1, false}},
    {"torch.ByteStorage", {DType::kU8, 1, false}},    {"torch.BoolStorage", {DType::kBool, 1, false}}};

/// Meaning of a persistent id: a range of elements in a keyed storage.
struct StorageId {
  std::string key;
  ElementType type;
  uint64_t num_elements = 0;  ///< of the whole storage
  uint64_t view_begin = 0, view_size = 0;
};

bool IsCall(const PickleValue& value, std::string_view name) {
  return value.kind == Kind::kObject && value.text == name && !value.items.empty();
}

bool IsTensor(const PickleValue& value) {
  return IsCall(value, "torch._utils._rebuild_tensor_v2") || IsCall(value, "torch._utils._rebuild_tensor");
}

/// Collects tensors out of the object's tree.
class TensorCollector {
 public:
  TensorCollector(const std::string& where, size_t file_size, size_t max_bytes) : where_(where) {
    constexpr size_t kFloor = size_t{64} << 20, kPerByte = 16;
    budget_ = std::min(max_bytes, kFloor + kPerByte * file_size);
  }

  std::map<std::string, std::string_view> storages;  ///< raw bytes by key

  void Collect(const std::string& name, const PickleValue& value) {
    if (++entries_ > kMaxEntries) Fail(name, Concatenate("more than ", kMaxEntries, " entries"));
    if (name.size() > kMaxTensorName) Fail(name, Concatenate("a name of ", name.size(), " bytes"));
    if (value.kind == Kind::kDict) {
      for (const auto& [key, entry] : value.dict) Collect(name.empty() ? key : name + "." + key, *entry);
      return;
    }
    if (const PickleValue* tensor = TensorOf(value)) {
      const std::string own_name = name.empty() ? "tensor" : name;
      if (!file_.tensors.emplace(own_name, Tensor(own_name, *tensor)).second)
        Fail(own_name, "two tensors of this name");
      return;
    }
    file_.ignored.push_back(name);
  }

  WeightsFile Take() {
    std::sort(file_.ignored.begin(), file_.ignored.end());
    return std::move(file_);
  }

  StorageId ParseId(const std::string& name, const PickleValue& id) const {
    if (!IsCall(id, kPicklePersistentId) || id.items.size() < 5 || id.items[0]->text != "storage") {
      Fail(name, "expected a storage");
    }
    StorageId storage;
    const auto type = std::find_if(std::begin(kStorageTypes), std::end(kStorageTypes),
                                   [&](const StorageType& t) { return t.name == id.items[1]->text; });
    if (type == std::end(kStorageTypes)) Fail(name, "expected the class of its storage");
    storage.type = type->type;
    if (id.items[2]->kind != Kind::kString) Fail(name, "expected the key of its storage as text");
    storage.key = id.items[2]->text;
    storage.num_elements = storage.view_size = Size(name, *id.items[4]);
    if (id.items.size() > 5 && id.items[5]->kind != Kind::kNone) {  // (key of the view, offset, size)
      const PickleValue& view = *id.items[5];
      if (view.kind != Kind::kTuple || view.items.size() != 3) Fail(name, "expected a view of its storage");
      storage.view_begin = Size(name, *view.items[1]);
      storage.view_size = Size(name, *view.items[2]);
      if (storage.view_begin > storage.num_elements || storage.view_size > storage.num_elements - storage.view_begin) {
        Fail(name, "a view outside its storage");
      }
    }
    return storage;
  }

  [[noreturn]] void Fail(const std::string& name, const std::string& message) const {
    throw std::runtime_error(where_ + ": '" + PrintableText(name) + "': " + message);
  }

 private:
  /// Returns the tensor of a value or of the parameter that wraps it; nullptr for anything else.
  static const PickleValue* TensorOf(const PickleValue& value) {
    if (IsTensor(value)) return &value;
    if (!IsCall(value, "torch._utils._rebuild_parameter") && !IsCall(value, "torch.nn.parameter.Parameter")) {
      return nullptr;
    }
    return IsTensor(*value.items[0]) ? value.items[0].get() : nullptr;
  }

  uint64_t Size(const std::string& name, const PickleValue& value) const {
    if (value.kind != Kind::kInt || value.integer < 0) Fail(name, "expected a whole number of at least 0");
    return static_cast<uint64_t>(value.integer);
  }
  std::vector<int64_t> Sizes(const std::string& name, const PickleValue& value) const {
    if (value.kind != Kind::kTuple || value.items.size() > kMaxRank) Fail(name, "expected a tuple of at most 32 sizes");
    std::vector<int64_t> sizes;
    for (const PicklePtr& item : value.items) sizes.push_back(static_cast<int64_t>(Size(name, *item)));
    return sizes;
  }

  NdArray Tensor(const std::string& name, const PickleValue& call) {
    if (call.items.size() < 4) Fail(name, "expected storage, offset, size and stride");
    const StorageId id = ParseId(name, *call.items[0]);
    const uint64_t offset = Size(name, *call.items[1]);
    std::vector<int64_t> shape = Sizes(name, *call.items[2]);
    const std::vector<int64_t> stride = Sizes(name, *call.items[3]);
    if (shape.size() != stride.size()) Fail(name, "expected as many strides as sizes");
    const auto storage = storages.find(id.key);
    if (storage == storages.end()) Fail(name, "its storage '" + PrintableText(id.key) + "' is not in the file");
    if (storage->second.size() / id.type.item_size != id.num_elements ||
        storage->second.size() % id.type.item_size != 0) {
      Fail(name, Concatenate("its storage of ", storage->second.size(), " bytes, expected ", id.num_elements,
                             " elements of ", id.type.item_size, " bytes"));
    }
    const std::string_view elements =
        storage->second.substr(id.view_begin * id.type.item_size, id.view_size * id.type.item_size);
    const std::optional<size_t> bytes = ArrayBytes(shape, id.type.item_size);
    if (!bytes || *bytes > budget_) Fail(name, "needs more memory than is allowed for a file of its size");
    budget_ -= *bytes;
    RequireInside(name, offset, shape, stride, id.view_size, *bytes == 0);
    if (*bytes == 0) return ArrayFromBytes(id.type, std::move(shape), false, {});
    if (IsContiguous(shape, stride)) {
      return ArrayFromBytes(id.type, std::move(shape), false, elements.substr(offset * id.type.item_size, *bytes));
    }
    const std::string gathered = Gather(elements, offset, shape, stride, id.type.item_size, *bytes);
    return ArrayFromBytes(id.type, std::move(shape), false, gathered);
  }

  /// The last element of the view, offset + Σ (size − 1) stride, must be one of the storage.
  void RequireInside(const std::string& name, uint64_t offset, const std::vector<int64_t>& shape,
                     const std::vector<int64_t>& stride, uint64_t num_elements, bool is_empty) const {
    if (is_empty) return;
    uint64_t last = offset;
    bool inside = offset < num_elements;
    for (size_t d = 0; d < shape.size() && inside; ++d) {
      const auto steps = static_cast<uint64_t>(shape[d] - 1), step = static_cast<uint64_t>(stride[d]);
      inside = step == 0 || steps <= (num_elements - 1 - last) / step;
      if (inside) last += steps * step;
    }
    if (!inside) {
      NdArray shape_only;
      shape_only.shape = shape;
      Fail(name, Concatenate("a view of ", shape_only.ShapeText(), " from element ", offset,
                             " reaches beyond its storage of ", num_elements, " elements"));
    }
  }

  static bool IsContiguous(const std::vector<int64_t>& shape, const std::vector<int64_t>& stride) {
    int64_t expected = 1;
    for (size_t d = shape.size(); d-- > 0;) {
      if (shape[d] != 1 && stride[d] != expected) return false;
      expected *= shape[d];
    }
    return true;
  }

  static std::string Gather(std::string_view elements, uint64_t offset, const std::vector<int64_t>& shape,
                            const std::vector<int64_t>& stride, size_t item_size, size_t bytes) {
    std::string gathered(bytes, '\0');
    std::vector<int64_t> index(shape.size(), 0);
    auto at = static_cast<int64_t>(offset);
    for (size_t out = 0; out < bytes; out += item_size) {
      std::copy_n(elements.data() + static_cast<size_t>(at) * item_size, item_size, gathered.data() + out);
      for (size_t d = shape.size(); d-- > 0;) {
        at += stride[d];
        if (++index[d] < shape[d]) break;
        at -= stride[d] * shape[d];
        index[d] = 0;
      }
    }
    return gathered;
  }

  const std::string& where_;
  size_t budget_ = 0, entries_ = 0;
  WeightsFile file_;
};

/// Every persistent id of a tree, each once.
std::vector<const PickleValue*> PersistentIds(const PickleValue& root) {
  std::vector<const PickleValue*> ids, open = {&root};
  std::unordered_set<const PickleValue*> seen = {&root};
  while (!open.empty()) {
    const PickleValue* value = open.back();
    open.pop_back();
    if (IsCall(*value, kPicklePersistentId)) ids.push_back(value);
    for (const PicklePtr& item : value->items) {
      if (seen.insert(item.get()).second) open.push_back(item.get());
    }
    for (const auto& [key, entry] : value->dict) {
      if (seen.insert(entry.get()).second) open.push_back(entry.get());
    }
  }
  return ids;
}

WeightsFile FromLegacy(const std::string& bytes, const std::string& where, size_t max_bytes) {
  size_t offset = kLegacyMagic.size();
  const auto next = [&] { return ReadPickleAt(PickleDialect::kTorch, bytes, &offset, where); };
  const PicklePtr protocol = next();
  if (protocol->kind != Kind::kInt || protocol->integer != kLegacyProtocol) {
    throw std::runtime_error(where + ": legacy PyTorch file of another protocol, expected 1001");
  }
  const PicklePtr system = next();
  const PickleValue* little_endian = system->Find("little_endian");
  if (little_endian == nullptr || !little_endian->boolean) {
    throw std::runtime_error(where + ": legacy PyTorch file of a big-endian machine, expected a little-endian one");
  }
  const PicklePtr object = next();
  const PicklePtr keys = next();
  if (keys->kind != Kind::kList) throw std::runtime_error(where + ": expected the list of its storages' keys");

  TensorCollector collector(where, bytes.size(), max_bytes);
  std::map<std::string, StorageId> ids;
  for (const PickleValue* id : PersistentIds(*object)) {
    const StorageId storage = collector.ParseId("a storage", *id);
    ids.emplace(storage.key, storage);
  }
  for (const PicklePtr& key : keys->items) {
    const auto id = ids.find(key->text);
    const std::string place = where + ": storage '" + PrintableText(key->text) + "': ";
    if (key->kind != Kind::kString || id == ids.end()) throw std::runtime_error(place + "no tensor names it");
    if (bytes.size() - offset < 8) throw std::runtime_error(place + "the file is cut off before its element count");
    uint64_t count = 0;
    for (size_t i = 8; i-- > 0;) count = (count << 8) | static_cast<unsigned char>(bytes[offset + i]);
    offset += 8;
    const size_t item_size = id->second.type.item_size;
    if (count != id->second.num_elements || count > (bytes.size() - offset) / item_size) {
      throw std::runtime_error(Concatenate(place, count, " elements of ", item_size, " bytes, expected ",
                                           id->second.num_elements, "; the file holds ", bytes.size() - offset,
                                           " more bytes"));
    }
    if (!collector.storages.emplace(key->text, std::string_view(bytes).substr(offset, count * item_size)).second) {
      throw std::runtime_error(place + "occurs twice");
    }
    offset += count * item_size;
  }
  collector.Collect("", *object);
  return collector.Take();
}

WeightsFile FromZip(const std::string& bytes, const std::string& where, size_t max_bytes) {
  const std::vector<ZipMember> members = ReadZip(bytes, where, max_bytes);
  constexpr std::string_view kObject = "data.pkl";
  const ZipMember* object = nullptr;
  for (const ZipMember& member : members) {
    if (!member.name.ends_with(kObject)) continue;
    const size_t folder = member.name.size() - kObject.size();
    if (folder == 0 || member.name.find('/') == folder - 1) object = &member;
  }
  if (object == nullptr)
    throw std::runtime_error(where + ": no data.pkl in the archive, expected a file of torch.save");
  const std::string prefix = object->name.substr(0, object->name.size() - kObject.size());
  TensorCollector collector(where, bytes.size(), max_bytes);
  for (const ZipMember& member : members) {
    if (member.name == prefix + "constants.pkl") {
      throw std::runtime_error(where + ": a TorchScript archive, expected torch.save of a model's state_dict()");
    }
    if (member.name == prefix + "byteorder" && member.bytes != "little") {
      throw std::runtime_error(where + ": byte order '" + PrintableText(member.bytes) + "', expected 'little'");
    }
    if (member.name.starts_with(prefix + "data/")) {
      collector.storages.emplace(member.name.substr(prefix.size() + 5), member.bytes);
    }
  }
  size_t offset = 0;
  const PicklePtr value =
      ReadPickleAt(PickleDialect::kTorch, object->bytes, &offset, where + ": " + PrintableText(object->name));
  collector.Collect("", *value);
  return collector.Take();
}

}  // namespace

bool LooksLikeTorch(std::string_view bytes) {
  return LooksLikeZip(bytes) || bytes.substr(0, kLegacyMagic.size()) == kLegacyMagic;
}

WeightsFile TorchWeightsFromBytes(const std::string& bytes, const std::string& where, size_t max_bytes) {
  if (LooksLikeZip(bytes)) return FromZip(bytes, where, max_bytes);
  if (!LooksLikeTorch(bytes)) {
    throw std::runtime_error(where +
                             ": neither a zip archive nor torch.save's legacy magic number, expected a file of "
                             "torch.save");
  }
  return FromLegacy(bytes, where, max_bytes);
}

WeightsFile ReadTorchWeights(const std::string& path, size_t max_bytes) {
  return TorchWeightsFromBytes(ReadFileBytes(path, max_bytes), path, max_bytes);
}

}  // namespace bodyloom
