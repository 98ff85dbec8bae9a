// SPDX-License-Identifier: Apache-2.0
/// Reads Python pickles (protocols 0–5) without running anything.
///
/// An opcode machine that builds inert values. Only the globals on a fixed list are understood (pickle_node.cc:
/// numpy arrays, dtypes and scalars, scipy.sparse csc/csr matrices, chumpy's Ch and Select, collections.OrderedDict and
/// defaultdict, joblib's arrays, _codecs.encode, object reconstruction); any other global is refused by name and
/// offset, and nothing is ever executed. What becomes what: sparse matrices and chumpy objects arrive as plain arrays,
/// numpy scalars as numbers or text, object arrays and sets as lists, whole numbers beyond 64 bits as the nearest
/// float; of a repeated key the last value counts. Python-2 strings (STRING, BINSTRING) are their latin-1 bytes.
/// Limits, checked before memory is taken: bytes in all (also at most 64 MiB + 256 times the file), number of values,
/// nesting; values that contain themselves are refused.
///
/// joblib.dump (0.10 and later) writes a pickle in which an array is an object NumpyArrayWrapper, and behind the opcode
/// that ends that object lie the array's raw bytes, from joblib 1.2 after a byte n and n bytes of padding. The file may
/// be a zlib (compress=1..9) or gzip stream as a whole; its bz2, lzma, xz and lz4 are not read. Arrays of Python
/// objects in it are refused.
/// Sources: CPython Lib/pickletools.py for the opcodes; numpy's _reconstruct and ndarray.__setstate__; joblib's
/// numpy_pickle.py.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "data_tools/formats/ndarray.h"

namespace bodyloom {

struct PickleValue;
using PicklePtr = std::shared_ptr<const PickleValue>;

/// A value of a pickle. Dictionaries keep insertion order; keys are text or integers (as text).
struct PickleValue {
  enum class Kind { kNone, kBool, kInt, kFloat, kString, kBytes, kList, kTuple, kDict, kArray, kObject };
  Kind kind = Kind::kNone;
  bool boolean = false;
  int64_t integer = 0;
  double real = 0;
  std::string text;                                     ///< kString, kBytes; class name for kObject
  std::vector<PicklePtr> items;                         ///< kList, kTuple
  std::vector<std::pair<std::string, PicklePtr>> dict;  ///< kDict; attributes of kObject
  NdArray array;                                        ///< kArray

  /// The entry of a dictionary or attribute of an object; nullptr when absent.
  [[nodiscard]] const PickleValue* Find(const std::string& key) const;
};

/// The array of numbers that `file` has under this key. Throws std::runtime_error with `where` when there is none.
const NdArray& RequireNumbers(const PickleValue& file, const std::string& key, const std::string& where);

struct PickleLimits {
  size_t max_bytes = size_t{1} << 31;  ///< of all arrays and strings together
  int max_depth = 200;
  size_t max_items = 20'000'000;
};

/// Parses one pickle. `where` names the file in messages. Throws std::runtime_error with `where`, byte offset, what was
/// found and what was expected.
PicklePtr ReadPickle(const std::string& bytes, const std::string& where, const PickleLimits& limits = {});
PicklePtr ReadPickleFile(const std::string& path, const PickleLimits& limits = {});

/// Which globals a pickle may name: the list above, or those of torch.save's files.
enum class PickleDialect { kPlain, kTorch };

constexpr const char* kPicklePersistentId = "persistent id";

/// One of several pickles that follow each other: starts at *offset and moves it behind the STOP mark.
/// kTorch understands collections.OrderedDict, torch.*Storage, torch._utils._rebuild_tensor, _rebuild_tensor_v2 and
/// _rebuild_parameter, torch.nn.parameter.Parameter, and persistent ids (opcode BINPERSID), nothing else. A storage
/// class arrives as kObject whose text is its full name ("torch.FloatStorage"); a call as kObject whose text is the
/// function's name and whose items are the arguments; a persistent id as kObject kPicklePersistentId with the id's
/// items. Attributes of an OrderedDict (_metadata) are dropped.
PicklePtr ReadPickleAt(PickleDialect dialect, std::string_view bytes, size_t* offset, const std::string& where,
                       const PickleLimits& limits = {});

}  // namespace bodyloom
