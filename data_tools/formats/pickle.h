// SPDX-License-Identifier: Apache-2.0
/// Reads Python pickles (protocols 0–5) without executing code.
///
/// An opcode machine that builds inert values. Only the globals on a fixed list are understood (pickle_node.cc:
/// numpy arrays, dtypes and scalars, scipy.sparse csc/csr matrices, chumpy's Ch and Select, collections.OrderedDict and
/// defaultdict, joblib's arrays, _codecs.encode, object reconstruction); any other global is refused by name and
/// offset, and nothing is ever executed. Conversions: sparse matrices and chumpy objects become plain arrays, numpy
/// scalars numbers or text, object arrays and sets lists, integers beyond 64 bits the nearest float; of a repeated key
/// the last value counts. Python-2 strings (STRING, BINSTRING) are their latin-1 bytes. Limits, checked before memory
/// is allocated: total bytes (also at most 64 MiB + 256 times the file), number of values, nesting; values that contain
/// themselves are refused.
///
/// joblib.dump (0.10 and later) writes a pickle in which an array is an object NumpyArrayWrapper, followed by the
/// array's raw bytes, from joblib 1.2 after a byte n and n bytes of padding. The file may be a zlib (compress=1..9) or
/// gzip stream as a whole; its bz2, lzma, xz and lz4 are not read. Arrays of Python objects in it are refused.
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

  /// Returns the entry of a dictionary or attribute of an object; nullptr when absent.
  [[nodiscard]] const PickleValue* Find(const std::string& key) const;
};

/// Returns the array of numbers under this key of `file`. Throws std::runtime_error with `where` if there is none.
const NdArray& RequireNumbers(const PickleValue& file, const std::string& key, const std::string& where);

struct PickleLimits {
  size_t max_bytes = size_t{1} << 31;  ///< total of all arrays and strings
  int max_depth = 200;
  size_t max_items = 20'000'000;
};

/// Parses one pickle. `where` names the file in messages. Throws std::runtime_error with `where`, byte offset, what was
/// found and what was expected.
PicklePtr ReadPickle(const std::string& bytes, const std::string& where, const PickleLimits& limits = {});
PicklePtr ReadPickleFile(const std::string& path, const PickleLimits& limits = {});

/// Set of globals that a pickle may name: the list above, or those of torch.save's files.
enum class PickleDialect { kPlain, kTorch };

constexpr const char* kPicklePersistentId = "persistent id";

/// Parses one of several consecutive pickles: starts at *offset and moves it behind the STOP mark.
/// kTorch understands collections.OrderedDict, torch.*Storage, torch._utils._rebuild_tensor, _rebuild_tensor_v2 and
/// _rebuild_parameter, torch.nn.parameter.Parameter, and persistent ids (opcode BINPERSID), nothing else. A storage
/// class becomes a kObject whose text is its full name ("torch.FloatStorage"); a call a kObject whose text is the
/// function's name and whose items are the arguments; a persistent id a kObject kPicklePersistentId with the id's
/// items. Attributes of an OrderedDict (_metadata) are dropped.
PicklePtr ReadPickleAt(PickleDialect dialect, std::string_view bytes, size_t* offset, const std::string& where,
                       const PickleLimits& limits = {});

}  // namespace bodyloom
