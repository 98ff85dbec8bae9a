// SPDX-License-Identifier: Apache-2.0
#include "neural/training/checkpoint_file.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <set>
#include <stdexcept>

#include "geometry/base/check.h"
#include "neural/training/run_files.h"

namespace bodyloom {
namespace {

static_assert(std::endian::native == std::endian::little, "checkpoints are little endian");

constexpr std::array<char, 8> kMagic = {'B', 'L', 'O', 'O', 'M', 'C', 'P', '1'};
constexpr uint64_t kFixedBytes = kMagic.size() + 2 * sizeof(uint64_t);
constexpr uint32_t kMaxName = 4096;
constexpr int kMaxDims = 8;

/// Element types by their number in the file.
constexpr std::array<torch::ScalarType, 10> kTypes = {torch::kFloat, torch::kDouble, torch::kHalf,  torch::kBFloat16,
                                                      torch::kLong,  torch::kInt,    torch::kShort, torch::kChar,
                                                      torch::kByte,  torch::kBool};

/// FNV-1a over words of eight bytes, with the high bits folded back so that every bit affects all others.
class Checksum {
 public:
  void Add(const void* bytes, size_t size) {
    const char* next = static_cast<const char*>(bytes);
    while (size > 0) {
      const size_t taken = std::min(size, sizeof(word_) - filled_);
      std::memcpy(reinterpret_cast<char*>(&word_) + filled_, next, taken);
      filled_ += taken;
      next += taken;
      size -= taken;
      if (filled_ == sizeof(word_)) Mix();
    }
  }
  [[nodiscard]] uint64_t Value() const {
    Checksum last = *this;
    last.Mix();
    return last.hash_;
  }

 private:
  void Mix() {
    hash_ = (hash_ ^ word_) * 0x100000001b3ULL;
    hash_ ^= hash_ >> 29;
    word_ = 0;
    filled_ = 0;
  }
  uint64_t hash_ = 0xcbf29ce484222325ULL, word_ = 0;
  size_t filled_ = 0;
};

uint8_t TypeNumber(torch::ScalarType type) {
  const auto found = std::find(kTypes.begin(), kTypes.end(), type);
  BODYLOOM_CHECK(found != kTypes.end(), "checkpoint: a tensor of type ", type);
  return static_cast<uint8_t>(found - kTypes.begin());
}

uint64_t RecordBytes(const std::string& name, const torch::Tensor& tensor) {
  return sizeof(uint32_t) + name.size() + 2 + sizeof(int64_t) * tensor.dim() + tensor.nbytes();
}

/// Reads within the file's bounds and updates the checksum; failures are reported in one line with the path.
class Reader {
 public:
  explicit Reader(const std::string& path) : path_(path), file_(path, std::ios::binary) {
    if (std::filesystem::is_directory(path)) Fail("a folder, expected a checkpoint");
    if (!file_) Fail(std::string("cannot be opened: ") + std::strerror(errno));
    file_.seekg(0, std::ios::end);
    size_ = left_ = static_cast<uint64_t>(file_.tellg());
    file_.seekg(0);
  }
  [[noreturn]] void Fail(const std::string& what) const { throw std::runtime_error(path_ + ": " + what); }

  void Read(void* bytes, uint64_t size) {
    if (size > left_) Fail("damaged: a record reaches beyond the end of the file");
    file_.read(static_cast<char*>(bytes), static_cast<std::streamsize>(size));
    if (!file_) Fail("cannot be read");
    checksum_.Add(bytes, size);
    left_ -= size;
  }
  template <class T>
  T Read() {
    T value;
    Read(&value, sizeof value);
    return value;
  }
  [[nodiscard]] uint64_t size() const { return size_; }
  [[nodiscard]] uint64_t left() const { return left_; }
  [[nodiscard]] uint64_t checksum() const { return checksum_.Value(); }

 private:
  std::string path_;
  std::ifstream file_;
  uint64_t size_ = 0, left_ = 0;
  Checksum checksum_;
};

std::pair<std::string, torch::Tensor> ReadRecord(Reader* reader) {
  const auto length = reader->Read<uint32_t>();
  if (length == 0 || length > kMaxName) reader->Fail(Concatenate("damaged: a name of ", length, " characters"));
  std::string name(length, ' ');
  reader->Read(name.data(), length);
  const auto type = reader->Read<uint8_t>(), dims = reader->Read<uint8_t>();
  if (type >= kTypes.size() || dims > kMaxDims) reader->Fail("damaged: a tensor of an unknown kind");
  std::vector<int64_t> shape;
  uint64_t bytes = c10::elementSize(kTypes[type]);
  for (int i = 0; i < dims; ++i) {
    shape.push_back(reader->Read<int64_t>());
    if (shape.back() < 0 || (shape.back() > 0 && bytes > reader->left() / static_cast<uint64_t>(shape.back()))) {
      reader->Fail("damaged: a tensor larger than the file");
    }
    bytes *= static_cast<uint64_t>(shape.back());
  }
  torch::Tensor tensor = torch::empty(shape, kTypes[type]);
  if (bytes > 0) reader->Read(tensor.data_ptr(), bytes);
  return {name, tensor};
}

}  // namespace

void WriteTensorFile(const std::string& path, const NamedTensors& tensors) {
  uint64_t total = kFixedBytes;
  for (const auto& [name, tensor] : tensors) {
    BODYLOOM_CHECK(!name.empty() && name.size() <= kMaxName && tensor.defined() && tensor.dim() <= kMaxDims,
                   "checkpoint: the tensor \"", name, "\" has no name, no values or too many dimensions");
    TypeNumber(tensor.scalar_type());
    total += RecordBytes(name, tensor);
  }
  RunFile file(path);
  Checksum checksum;
  const auto write = [&](const void* bytes, size_t size) {
    file.Write(bytes, size);
    checksum.Add(bytes, size);
  };
  write(kMagic.data(), kMagic.size());
  write(&total, sizeof total);
  for (const auto& [name, tensor] : tensors) {
    const auto length = static_cast<uint32_t>(name.size());
    const std::array<uint8_t, 2> kind = {TypeNumber(tensor.scalar_type()), static_cast<uint8_t>(tensor.dim())};
    write(&length, sizeof length);
    write(name.data(), name.size());
    write(kind.data(), kind.size());
    write(tensor.sizes().data(), sizeof(int64_t) * tensor.dim());
    const torch::Tensor values = tensor.detach().to(torch::kCPU).contiguous();
    write(values.data_ptr(), values.nbytes());
  }
  const uint64_t sum = checksum.Value();
  file.Write(&sum, sizeof sum);
  file.Commit();
}

NamedTensors ReadTensorFile(const std::string& path) {
  Reader reader(path);
  std::array<char, 8> magic{};
  if (reader.size() >= kMagic.size()) reader.Read(magic.data(), magic.size());
  if (magic != kMagic) reader.Fail("not a checkpoint of this program");
  const uint64_t claimed = reader.size() >= kFixedBytes ? reader.Read<uint64_t>() : 0;
  if (claimed != reader.size()) {
    reader.Fail(Concatenate("cut off or damaged: ", reader.size(), " bytes",
                            claimed == 0 ? "" : Concatenate(", expected ", claimed)));
  }
  NamedTensors tensors;
  std::set<std::string> names;
  while (reader.left() > sizeof(uint64_t)) {
    tensors.push_back(ReadRecord(&reader));
    if (!names.insert(tensors.back().first).second) reader.Fail("damaged: a name appears twice");
  }
  const uint64_t expected = reader.checksum();
  if (reader.left() != sizeof(uint64_t) || reader.Read<uint64_t>() != expected) {
    reader.Fail("damaged: the checksum does not match");
  }
  return tensors;
}

}  // namespace bodyloom
