// SPDX-License-Identifier: Apache-2.0
#include "data_tools/formats/mapped_npy.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <utility>

#include "data_tools/formats/element_type.h"
#include "data_tools/formats/npy_header.h"
#include "data_tools/formats/printable.h"
#include "geometry/base/check.h"

namespace bodyloom {

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
