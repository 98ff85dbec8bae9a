// SPDX-License-Identifier: Apache-2.0
#include "data_tools/formats/npy_stream.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/uio.h>
#include <unistd.h>
#include <algorithm>

#include <cerrno>
#include <cstring>
#include <limits>
#include <optional>
#include <stdexcept>
#include <utility>

#include "data_tools/formats/element_type.h"
#include "data_tools/formats/npy_header.h"
#include "data_tools/formats/printable.h"
#include "geometry/base/check.h"

namespace bodyloom {
namespace {

size_t ItemSize(DType dtype) {
  switch (dtype) {
    case DType::kU8:
      return 1;
    case DType::kF16:
      return 2;
    case DType::kF32:
      return 4;
    case DType::kF64:
      return 8;
    default:
      throw std::invalid_argument("npy stream: element type not supported, expected u8, f16, f32 or f64");
  }
}

}  // namespace

NpyStream::NpyStream(const std::string& path, DType dtype, std::vector<int64_t> shape) : path_(path), file_(path) {
  BODYLOOM_CHECK(!shape.empty(), "npy stream: a scalar has no records");
  NdArray whole;
  whole.dtype = dtype;
  whole.item_size = ItemSize(dtype);
  whole.shape = shape;
  const std::optional<size_t> data_bytes = ArrayBytes(shape, whole.item_size);
  BODYLOOM_CHECK(data_bytes && *data_bytes < size_t{1} << 62, "npy stream: an array of ", whole.ShapeText(),
                 " elements is too large");
  const std::string header = NpyHeaderText(whole);
  header_bytes_ = header.size();
  num_records_ = shape[0];
  record_bytes_ = num_records_ > 0 ? *data_bytes / static_cast<size_t>(num_records_) : 0;

  descriptor_ = ::open(file_.temporary().c_str(), O_RDWR | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  const auto fail = [&](const std::string& action) {
    const std::string reason = std::strerror(errno);
    if (descriptor_ >= 0) ::close(descriptor_);
    throw std::runtime_error(path_ + ": cannot " + action + ": " + reason);
  };
  if (descriptor_ < 0) fail("open for writing");
  const auto size = static_cast<off_t>(header_bytes_ + *data_bytes);
  if (::fallocate(descriptor_, 0, 0, size) != 0) {
    if (errno != EOPNOTSUPP && errno != ENOSYS) fail("reserve " + std::to_string(size) + " bytes");
    if (::ftruncate(descriptor_, size) != 0) fail("grow to " + std::to_string(size) + " bytes");
  }
  for (size_t done = 0; done < header.size();) {
    const ssize_t n = ::pwrite(descriptor_, header.data() + done, header.size() - done, static_cast<off_t>(done));
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) fail("write the header");
    done += static_cast<size_t>(n);
  }
}

NpyStream::~NpyStream() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

void NpyStream::Write(int64_t index, std::span<const std::span<const char>> pieces) {
  BODYLOOM_CHECK(index >= 0 && index < num_records_, "npy stream: record ", index, " of ", num_records_);
  std::vector<iovec> left;
  size_t bytes = 0;
  for (const std::span<const char>& piece : pieces) {
    if (!piece.empty()) left.push_back({const_cast<char*>(piece.data()), piece.size()});
    bytes += piece.size();
  }
  BODYLOOM_CHECK(bytes == record_bytes_, "npy stream: a record of ", bytes, " bytes, expected ", record_bytes_);
  const size_t begin = header_bytes_ + static_cast<size_t>(index) * record_bytes_;
  size_t offset = begin;
  for (size_t first = 0; first < left.size();) {
    const int count = static_cast<int>(std::min<size_t>(left.size() - first, 1000));
    ssize_t n = ::pwritev(descriptor_, left.data() + first, count, static_cast<off_t>(offset));
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) {
      throw std::runtime_error(Concatenate(path_, ": cannot write (record ", index, " of ", num_records_,
                                           "): ", n == 0 ? "no space left" : std::strerror(errno)));
    }
    offset += static_cast<size_t>(n);
    while (n > 0) {
      iovec& piece = left[first];
      if (static_cast<size_t>(n) < piece.iov_len) {
        piece.iov_base = static_cast<char*>(piece.iov_base) + n;
        piece.iov_len -= static_cast<size_t>(n);
        break;
      }
      n -= static_cast<ssize_t>(piece.iov_len);
      ++first;
    }
  }
  // Starts writing to disk now, while the next record is computed; a hint, so failure does not matter.
  ::sync_file_range(descriptor_, static_cast<off_t>(begin), static_cast<off_t>(record_bytes_), SYNC_FILE_RANGE_WRITE);
  ++num_written_;
}

void NpyStream::Finish() {
  BODYLOOM_CHECK(num_written_ == num_records_, "npy stream: ", num_written_.load(), " of ", num_records_,
                 " records were written");
  const int descriptor = std::exchange(descriptor_, -1);
  if (::close(descriptor) != 0) throw std::runtime_error(path_ + ": cannot close: " + std::strerror(errno));
  file_.Commit();
}

MappedNpy::MappedNpy(const std::string& path, DType dtype) {
  const auto fail = [&](const std::string& why) { throw std::runtime_error(path + ": " + why); };
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) fail(std::string("cannot be opened: ") + std::strerror(errno));
  struct stat info {};
  const bool some = ::fstat(descriptor, &info) == 0 && S_ISREG(info.st_mode) && info.st_size > 0;
  const auto bytes = static_cast<size_t>(info.st_size);
  void* map = some ? ::mmap(nullptr, bytes, PROT_READ, MAP_SHARED, descriptor, 0) : MAP_FAILED;
  const std::string reason = some ? std::strerror(errno) : "not a file with anything in it";
  ::close(descriptor);
  if (map == MAP_FAILED) fail("cannot be mapped: " + reason);
  map_.reset(map, [bytes](void* at) { ::munmap(at, bytes); });
  const auto* text = static_cast<const char*>(map);
  NpyHeader header = ParseNpyHeader({text, std::min(bytes, kMaxNpyHeaderBytes)}, bytes, path);
  if (!header.type || header.type->dtype != dtype || header.type->big_endian || header.fortran_order ||
      header.data_begin % header.type->item_size != 0) {
    NdArray expected;
    expected.dtype = dtype;
    expected.item_size = header.type ? header.type->item_size : expected.item_size;
    fail(Concatenate("elements of type '", PrintableText(header.descr), header.fortran_order ? "', Fortran order" : "'",
                     ", expected '", ElementTypeText(expected), "', C order, on multiples of their size"));
  }
  shape_ = std::move(header.shape);
  values_ = {text + header.data_begin, bytes - header.data_begin};
}

}  // namespace bodyloom
