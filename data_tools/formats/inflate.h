// SPDX-License-Identifier: Apache-2.0
/// Inflates files that are a single zlib or gzip stream: gzipped text, compressed joblib pickles.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace bodyloom {

/// True for the first bytes of a gzip stream (RFC 1952).
bool LooksLikeGzip(std::string_view bytes);
/// True for the first two bytes of a zlib stream with a 32 KiB window (RFC 1950), the only window that Python writes.
bool LooksLikeZlib(std::string_view bytes);

/// The contents of a gzip or zlib stream. Throws std::runtime_error naming `where` for a damaged or truncated stream
/// and for contents of more than max_bytes; memory grows with the inflated size.
std::string Inflate(std::string_view bytes, const std::string& where, size_t max_bytes);

}  // namespace bodyloom
