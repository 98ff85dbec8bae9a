// SPDX-License-Identifier: Apache-2.0
#include "data_tools/formats/zip.h"

#include <zlib.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <memory>
#include <optional>
#include <set>
#include <stdexcept>
#include <utility>

#include "data_tools/formats/printable.h"
#include "geometry/base/check.h"

namespace bodyloom {
namespace {

constexpr uint32_t kLocalHeader = 0x04034b50, kDirectoryEntry = 0x02014b50, kEndOfDirectory = 0x06054b50;
constexpr uint32_t kZip64Locator = 0x07064b50, kZip64End = 0x06064b50;
constexpr uint16_t kZip64Extra = 1, kStored = 0, kDeflated = 8;
constexpr size_t kEndSize = 22, kEntrySize = 46, kLocalSize = 30, kLocatorSize = 20, kZip64EndSize = 56;
constexpr size_t kMaxRatio = 1100;
constexpr uint64_t kIn64 = 0xFFFFFFFF;  // a 32-bit field that says "see the zip64 record"

/// Little-endian fields of the archive; reading past the end is a truncated file.
class ArchiveBytes {
 public:
  ArchiveBytes(std::string_view bytes, const std::string& where) : bytes_(bytes), where_(where) {}

  [[nodiscard]] size_t size() const { return bytes_.size(); }
  [[nodiscard]] uint64_t U16(size_t at) const { return Unsigned(at, 2); }
  [[nodiscard]] uint64_t U32(size_t at) const { return Unsigned(at, 4); }
  [[nodiscard]] uint64_t U64(size_t at) const { return Unsigned(at, 8); }
  [[nodiscard]] std::string_view Text(size_t at, size_t length) const {
    if (at > bytes_.size() || length > bytes_.size() - at) {
      Fail(Concatenate("the archive ends at byte ", bytes_.size(), ", expected ", length, " bytes at ", at,
                       " (the file is truncated or damaged)"));
    }
    return bytes_.substr(at, length);
  }
  [[noreturn]] void Fail(const std::string& message) const { throw std::runtime_error(where_ + ": " + message); }

 private:
  [[nodiscard]] uint64_t Unsigned(size_t at, size_t length) const {
    const std::string_view text = Text(at, length);
    uint64_t value = 0;
    for (size_t i = length; i-- > 0;) value = (value << 8) | static_cast<unsigned char>(text[i]);
    return value;
  }
  std::string_view bytes_;
  const std::string& where_;
};

struct Directory {
  uint64_t offset = 0, size = 0, entries = 0;
};

struct DirectoryEntry {
  std::string name;
  uint64_t flags = 0, method = 0, crc = 0, packed_size = 0, size = 0, header = 0;
};

Directory FindDirectory(const ArchiveBytes& in) {
  if (in.size() < kEndSize) in.Fail(Concatenate(in.size(), " bytes, expected a zip archive (at least 22)"));
  const size_t lowest = in.size() - std::min<size_t>(in.size(), kEndSize + 65535);
  size_t end = in.size() - kEndSize + 1;
  do {
    if (end == lowest)
      in.Fail("no end of directory, expected a zip archive (the file is truncated or of another kind)");
    --end;
  } while (in.U32(end) != kEndOfDirectory || in.U16(end + 20) != in.size() - end - kEndSize);
  Directory directory{in.U32(end + 16), in.U32(end + 12), in.U16(end + 10)};
  if (end >= kLocatorSize && in.U32(end - kLocatorSize) == kZip64Locator) {
    const uint64_t at = in.U64(end - kLocatorSize + 8);
    if (at > in.size() || in.size() - at < kZip64EndSize || in.U32(at) != kZip64End) {
      in.Fail(Concatenate("no zip64 directory at byte ", at));
    }
    directory = {in.U64(at + 48), in.U64(at + 40), in.U64(at + 32)};
  }
  if (directory.offset > end || directory.size > end - directory.offset) {
    in.Fail(Concatenate("the directory is said to take ", directory.size, " bytes at ", directory.offset,
                        ", outside the archive of ", in.size(), " bytes"));
  }
  if (directory.entries > directory.size / kEntrySize) {
    in.Fail(Concatenate("the directory promises ", directory.entries, " members in ", directory.size, " bytes"));
  }
  return directory;
}

/// Replaces the fields that say kIn64 by those of the entry's zip64 record.
void ApplyZip64(const ArchiveBytes& in, size_t extra, size_t extra_size, DirectoryEntry* entry) {
  const size_t end = extra + extra_size;
  while (extra + 4 <= end) {
    const uint64_t id = in.U16(extra), size = in.U16(extra + 2);
    extra += 4;
    if (size > end - extra) in.Fail("member '" + PrintableText(entry->name) + "': its extra field is cut off");
    if (id == kZip64Extra) {
      size_t at = extra;
      for (uint64_t* field : {&entry->size, &entry->packed_size, &entry->header}) {
        if (*field != kIn64) continue;
        if (at + 8 > extra + size) in.Fail("member '" + PrintableText(entry->name) + "': its zip64 record is cut off");
        *field = in.U64(at);
        at += 8;
      }
    }
    extra += size;
  }
}

std::vector<DirectoryEntry> ReadDirectory(const ArchiveBytes& in, const Directory& directory) {
  std::vector<DirectoryEntry> entries;
  std::set<std::string> names;
  size_t at = directory.offset;
  for (uint64_t i = 0; i < directory.entries; ++i) {
    if (in.U32(at) != kDirectoryEntry) in.Fail(Concatenate("byte ", at, ": expected directory entry ", i));
    const size_t name_size = in.U16(at + 28), extra_size = in.U16(at + 30), comment_size = in.U16(at + 32);
    DirectoryEntry entry;
    entry.flags = in.U16(at + 8);
    entry.method = in.U16(at + 10);
    entry.crc = in.U32(at + 16);
    entry.packed_size = in.U32(at + 20);
    entry.size = in.U32(at + 24);
    entry.header = in.U32(at + 42);
    entry.name = std::string(in.Text(at + kEntrySize, name_size));
    ApplyZip64(in, at + kEntrySize + name_size, extra_size, &entry);
    at += kEntrySize + name_size + extra_size + comment_size;
    if (!names.insert(entry.name).second) in.Fail("member '" + PrintableText(entry.name) + "' occurs twice");
    entries.push_back(std::move(entry));
  }
  return entries;
}

/// Offset of a member's packed bytes, after its own header.
size_t PackedBegin(const ArchiveBytes& in, const DirectoryEntry& entry, uint64_t directory_offset) {
  const std::string member = "member '" + PrintableText(entry.name) + "': ";
  if ((entry.flags & 1) != 0) in.Fail(member + "is encrypted, expected a plain archive");
  if (entry.method != kStored && entry.method != kDeflated) {
    in.Fail(Concatenate(member, "compression method ", entry.method, ", expected 0 (stored) or 8 (deflated)"));
  }
  if (entry.header > directory_offset || in.U32(entry.header) != kLocalHeader) {
    in.Fail(Concatenate(member, "no member header at byte ", entry.header));
  }
  const size_t begin = entry.header + kLocalSize + in.U16(entry.header + 26) + in.U16(entry.header + 28);
  if (begin > directory_offset || entry.packed_size > directory_offset - begin) {
    in.Fail(Concatenate(member, "promises ", entry.packed_size, " packed bytes at ", begin, ", outside the archive of ",
                        in.size(), " bytes"));
  }
  if (entry.method == kStored && entry.size != entry.packed_size) {
    in.Fail(Concatenate(member, "stored, but promises ", entry.size, " bytes out of ", entry.packed_size));
  }
  if (entry.size / kMaxRatio > entry.packed_size) {
    in.Fail(Concatenate(member, "promises ", entry.size, " bytes out of ", entry.packed_size,
                        " packed ones, more than deflate can give"));
  }
  return begin;
}

std::string Unpack(const ArchiveBytes& in, const DirectoryEntry& entry, std::string_view packed) {
  std::string bytes;
  if (entry.method == kStored) {
    bytes = std::string(packed);
  } else {
    bytes.resize(entry.size);
    z_stream stream{};
    if (inflateInit2(&stream, -MAX_WBITS) != Z_OK) throw std::bad_alloc();
    int result = Z_OK;
    size_t taken = 0, given = 0;
    constexpr size_t kStep = size_t{1} << 30;  // zlib counts in 32 bits
    char overflow = 0;                         // one byte beyond the stated size detects a stream that is too long
    while (result == Z_OK) {
      const size_t in_step = std::min(kStep, packed.size() - taken), room = std::min(kStep, bytes.size() - given);
      stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data() + taken));
      stream.avail_in = static_cast<uInt>(in_step);
      stream.next_out = reinterpret_cast<Bytef*>(room > 0 ? bytes.data() + given : &overflow);
      stream.avail_out = static_cast<uInt>(std::max<size_t>(room, 1));
      const size_t out_step = stream.avail_out;
      result = inflate(&stream, Z_NO_FLUSH);
      taken += in_step - stream.avail_in;
      given += out_step - stream.avail_out;
      if (given > bytes.size()) break;
    }
    inflateEnd(&stream);
    if (result != Z_STREAM_END || given != bytes.size() || taken != packed.size()) {
      in.Fail(Concatenate("member '", PrintableText(entry.name), "': its compressed bytes are damaged (", given, " of ",
                          entry.size, " bytes unpacked)"));
    }
  }
  if (crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()) != entry.crc) {
    in.Fail("member '" + PrintableText(entry.name) + "': checksum mismatch, the file is damaged");
  }
  return bytes;
}

size_t SizeOf(std::span<const std::string_view> pieces) {
  size_t size = 0;
  for (const std::string_view piece : pieces) size += piece.size();
  return size;
}

/// The pieces, one after the other, packed; nullopt when that is not smaller. Grows with the output, as the pieces may
/// take most of the memory.
std::optional<std::string> Deflate(std::span<const std::string_view> pieces, int level) {
  z_stream stream{};
  if (deflateInit2(&stream, level, Z_DEFLATED, -MAX_WBITS, 9, Z_DEFAULT_STRATEGY) != Z_OK) throw std::bad_alloc();
  const std::unique_ptr<z_stream, int (*)(z_stream*)> end(&stream, deflateEnd);
  std::vector<char> room(size_t{1} << 18);
  std::string packed;
  const size_t size = SizeOf(pieces);
  const auto deflate_piece = [&](std::string_view piece, int flush) {
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(piece.data()));
    stream.avail_in = static_cast<uInt>(piece.size());
    do {
      stream.next_out = reinterpret_cast<Bytef*>(room.data());
      stream.avail_out = static_cast<uInt>(room.size());
      deflate(&stream, flush);
      packed.append(room.data(), room.size() - stream.avail_out);
    } while (stream.avail_out == 0 && packed.size() < size);
    return packed.size() < size;
  };
  for (const std::string_view piece : pieces) {
    if (!deflate_piece(piece, Z_NO_FLUSH)) return std::nullopt;
  }
  if (!deflate_piece({}, Z_FINISH)) return std::nullopt;
  return packed;
}

void Put(uint64_t value, int length, std::string* out) {
  for (int i = 0; i < length; ++i, value >>= 8) out->push_back(static_cast<char>(value));
}

/// The fields shared by a member's header and its directory entry, from "version needed" to "extra length".
void PutCommon(const DirectoryEntry& entry, std::string* out) {
  Put(20, 2, out);
  Put(0, 2, out);
  Put(entry.method, 2, out);
  Put(0, 2, out);
  Put(0x21, 2, out);  // 1980-01-01, the first date there is
  Put(entry.crc, 4, out);
  Put(entry.packed_size, 4, out);
  Put(entry.size, 4, out);
  Put(entry.name.size(), 2, out);
  Put(0, 2, out);
}

}  // namespace

bool LooksLikeZip(std::string_view bytes) {
  return bytes.substr(0, 4) == "PK\x03\x04" || bytes.substr(0, 4) == "PK\x05\x06";
}

std::vector<ZipMember> ReadZip(std::string_view archive, const std::string& where, size_t max_bytes) {
  const ArchiveBytes in(archive, where);
  const Directory directory = FindDirectory(in);
  const std::vector<DirectoryEntry> entries = ReadDirectory(in, directory);
  std::vector<std::pair<size_t, size_t>> extents;  // packed bytes [begin, end) of each member
  size_t total = 0;
  for (const DirectoryEntry& entry : entries) {
    const size_t begin = PackedBegin(in, entry, directory.offset);
    extents.emplace_back(begin, begin + entry.packed_size);
    if (entry.size > max_bytes - total) {
      in.Fail(Concatenate("member '", PrintableText(entry.name), "': ", entry.size, " bytes, at most ", max_bytes,
                          " are read from one archive"));
    }
    total += entry.size;
  }
  std::vector<std::pair<size_t, size_t>> sorted = extents;
  std::sort(sorted.begin(), sorted.end());
  for (size_t i = 1; i < sorted.size(); ++i) {
    if (sorted[i].first < sorted[i - 1].second) in.Fail("two members overlap, expected an ordinary archive");
  }
  std::vector<ZipMember> members;
  for (size_t i = 0; i < entries.size(); ++i) {
    const std::string_view packed = in.Text(extents[i].first, extents[i].second - extents[i].first);
    members.push_back({entries[i].name, Unpack(in, entries[i], packed)});
  }
  return members;
}

void ZipBuilder::Add(const std::string& name, std::span<const std::string_view> pieces, int level) {
  const size_t size = SizeOf(pieces);
  BODYLOOM_CHECK(size < kIn64 && name.size() <= std::numeric_limits<uint16_t>::max(), "zip member '", name, "' of ",
                 size, " bytes, expected less than 4 GiB");
  const std::optional<std::string> packed = Deflate(pieces, level);
  DirectoryEntry entry;
  entry.name = name;
  entry.method = packed ? kDeflated : kStored;
  for (const std::string_view piece : pieces) {
    entry.crc = static_cast<uint32_t>(crc32_z(entry.crc, reinterpret_cast<const Bytef*>(piece.data()), piece.size()));
  }
  entry.packed_size = packed ? packed->size() : size;
  entry.size = size;
  entry.header = archive_.size();
  Put(kLocalHeader, 4, &archive_);
  PutCommon(entry, &archive_);
  archive_ += entry.name;
  if (packed) {
    archive_ += *packed;
  } else {
    for (const std::string_view piece : pieces) archive_ += piece;
  }
  Put(kDirectoryEntry, 4, &directory_);
  Put(20, 2, &directory_);
  PutCommon(entry, &directory_);
  Put(0, 10, &directory_);  // comment length, disk, attributes
  Put(entry.header, 4, &directory_);
  directory_ += entry.name;
  ++num_members_;
}

std::string ZipBuilder::Finish() && {
  BODYLOOM_CHECK(archive_.size() + directory_.size() < kIn64 && num_members_ < 0xFFFF, "zip archive of ",
                 archive_.size(), " bytes and ", num_members_, " members, expected less than 4 GiB and 65535");
  const size_t directory_offset = archive_.size();
  archive_ += directory_;
  Put(kEndOfDirectory, 4, &archive_);
  Put(0, 4, &archive_);
  Put(num_members_, 2, &archive_);
  Put(num_members_, 2, &archive_);
  Put(directory_.size(), 4, &archive_);
  Put(directory_offset, 4, &archive_);
  Put(0, 2, &archive_);
  return std::move(archive_);
}

std::string MakeZip(const std::vector<ZipMember>& members, int level) {
  ZipBuilder zip;
  for (const ZipMember& member : members) {
    const std::string_view bytes = member.bytes;
    zip.Add(member.name, {&bytes, 1}, level);
  }
  return std::move(zip).Finish();
}

}  // namespace bodyloom
