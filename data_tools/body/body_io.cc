// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/data_tools/body/body_io.h"

#include <stdexcept>
#include <utility>

#include "bodyloom/data_tools/body/body_compact.h"
#include "bodyloom/data_tools/body/body_smpl.h"
#include "bodyloom/data_tools/formats/atomic_file.h"
#include "bodyloom/data_tools/formats/zip.h"

namespace bodyloom {
namespace {

BodyModelData ParseBody(const std::string& bytes, const std::string& where, const LoadBodyOptions& options) {
  if (bytes.empty()) throw std::runtime_error(where + ": an empty file, expected a body model (.npz or .pkl)");
  if (!LooksLikeZip(bytes)) {
    const PicklePtr pickle = ReadPickle(bytes, where);
    return BodyFromArrays(NamedArrays(*pickle, where), options);
  }
  const NpzArrays arrays = ReadNpzBytes(bytes, where);
  if (IsCompactBody(arrays)) return BodyFromCompact(arrays, where, options);
  return BodyFromArrays(NamedArrays(arrays, where), options);
}

}  // namespace

BodyModel LoadBodyBytes(const std::string& bytes, const std::string& where, const LoadBodyOptions& options) {
  BodyModelData data = ParseBody(bytes, where, options);
  try {
    return BodyModel(std::move(data));
  } catch (const std::invalid_argument& error) {
    throw std::runtime_error(where + ": " + error.what());
  }
}

BodyModel LoadBody(const std::string& path, const LoadBodyOptions& options) {
  return LoadBodyBytes(ReadFileBytes(path), path, options);
}

BodyModelData LoadBodyData(const std::string& path, const LoadBodyOptions& options) {
  return LoadBody(path, options).data();
}

void SaveBodyCompact(const std::string& path, const BodyModelData& body) {
  WriteNpz(path, CompactFromBody(BodyModel(body).data()));
}

}  // namespace bodyloom
