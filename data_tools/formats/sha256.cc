// SPDX-License-Identifier: Apache-2.0
#include "data_tools/formats/sha256.h"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <new>
#include <stdexcept>
#include <system_error>
#include <vector>

#include "data_tools/formats/atomic_file.h"

extern "C" {
#include <libavutil/mem.h>
#include <libavutil/sha.h>
}

namespace bodyloom {

struct Sha256::State {
  AVSHA* sha = av_sha_alloc();
  ~State() { av_free(sha); }
};

Sha256::Sha256() : state_(std::make_unique<State>()) {
  if (state_->sha == nullptr) throw std::bad_alloc();
  av_sha_init(state_->sha, 256);
}

Sha256::~Sha256() = default;

void Sha256::Add(std::string_view bytes) {
  av_sha_update(state_->sha, reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size());
}

void Sha256::AddField(std::string_view text) {
  std::array<char, 8> length;
  uint64_t rest = text.size();
  for (char& byte : length) {
    byte = static_cast<char>(rest & 0xFF);
    rest >>= 8;
  }
  Add({length.data(), length.size()});
  Add(text);
}

std::string Sha256::Hex() {
  std::array<uint8_t, 32> digest;
  av_sha_final(state_->sha, digest.data());
  constexpr const char* kDigits = "0123456789abcdef";
  std::string text;
  for (const uint8_t byte : digest) {
    text += kDigits[byte >> 4];
    text += kDigits[byte & 15];
  }
  return text;
}

std::string Sha256OfFile(const std::string& path) {
  const int fd = ::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  Sha256 sha;
  std::vector<char> piece(size_t{1} << 16);
  ssize_t n = fd < 0 ? -1 : 0;
  while (fd >= 0 && ((n = ::read(fd, piece.data(), piece.size())) > 0 || (n < 0 && errno == EINTR))) {
    if (n > 0) sha.Add({piece.data(), static_cast<size_t>(n)});
  }
  const int reason = errno;
  if (fd >= 0) ::close(fd);
  if (n < 0) throw std::system_error(reason, std::generic_category(), path + ": cannot read");
  return sha.Hex();
}

std::string Sha256OfTree(const std::string& path) {
  std::error_code unreadable;  // reported by the read below
  if (!std::filesystem::is_directory(path, unreadable)) return Sha256OfFile(path);
  Sha256 sha;
  for (const std::string& file : FilesBelow(path)) {
    sha.AddField(std::filesystem::path(file).lexically_relative(path).generic_string());
    sha.AddField(Sha256OfFile(file));
  }
  return sha.Hex();
}

}  // namespace bodyloom
