// SPDX-License-Identifier: Apache-2.0
/// Nodes of the pickle machine: values under construction, their memory budget, and the few globals that are
/// understood. Internal to pickle.cc and pickle_node.cc.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "data_tools/formats/pickle.h"

namespace bodyloom {

enum class PickleGlobal {
  kNone,
  kNdarray,
  kReconstruct,  ///< numpy.core.multiarray._reconstruct
  kScalar,       ///< numpy.core.multiarray.scalar
  kFromBuffer,   ///< numpy.core.numeric._frombuffer (protocol 5)
  kDtype,
  kSparseColumns,  ///< scipy.sparse csc
  kSparseRows,     ///< scipy.sparse csr
  kChumpyArray,    ///< chumpy.ch.Ch: its array x
  kChumpySelect,   ///< chumpy.reordering.Select: a.ravel()[idxs].reshape(preferred_shape)
  kOrderedDict,
  kDefaultDict,
  kDict,
  kJoblibArray,    ///< joblib's NumpyArrayWrapper: an array whose bytes follow its state
  kEncode,         ///< _codecs.encode: how protocols 0–2 of Python 3 write bytes
  kReconstructor,  ///< copy_reg._reconstructor
  kObject,
  kBytes,
  kSet,
  kTorchStorage,    ///< torch.*Storage: a name, never called
  kTorchRebuild,    ///< torch._utils._rebuild_*: a call is kept unevaluated
  kTorchParameter,  ///< torch.nn.parameter.Parameter: its arguments, then its state
};

struct PickleNode : PickleValue {
  std::string_view view;  ///< text still in the file (then `text` is empty); copied when the result needs it
  PickleGlobal global = PickleGlobal::kNone;  ///< global of a class or function, or of an instance's class
  bool is_callable = false;                   ///< the class or function itself, not an instance
  bool is_open = false;                       ///< an array whose state has not been read yet
  uint8_t visit = 0;                          ///< 0 new, 1 on the path, 2 done
  int height = 0;                             ///< levels below and including this one

  [[nodiscard]] std::string_view Text() const { return view.data() != nullptr ? view : std::string_view(text); }
};
using PickleNodePtr = std::shared_ptr<PickleNode>;

/// All nodes are made by PickleContext::New, so every PicklePtr inside the machine is a PickleNode.
inline const PickleNode& AsNode(const PicklePtr& value) { return static_cast<const PickleNode&>(*value); }

/// Position of the machine and its remaining budget.
class PickleContext {
 public:
  PickleContext(PickleDialect dialect, std::string where, size_t budget, size_t max_items)
      : dialect_(dialect), where_(std::move(where)), budget_(budget), max_items_(max_items) {}

  [[nodiscard]] PickleDialect dialect() const { return dialect_; }

  size_t offset = 0;                 ///< of the current opcode
  std::vector<PickleNodePtr> nodes;  ///< everything made so far

  /// Throws std::runtime_error "where: byte offset: message".
  [[noreturn]] void Fail(const std::string& message) const;
  /// Deducts `bytes` from the budget before they are allocated.
  void Charge(size_t bytes);
  PickleNodePtr New(PickleValue::Kind kind);

 private:
  PickleDialect dialect_;
  std::string where_;
  size_t budget_, max_items_;
};

/// kNone for everything that is not on the dialect's list.
PickleGlobal FindPickleGlobal(PickleDialect dialect, std::string_view name);

/// Builds the value of `callable(*args)`; args is a tuple.
PickleNodePtr CallPickleGlobal(PickleContext* context, const PickleNode& callable, const PickleNode& args);

/// Gives `object` its state (opcode BUILD). Sparse matrices and chumpy objects become plain arrays here.
void SetPickleState(PickleContext* context, PickleNode* object, const PicklePtr& state);

/// Turns joblib's NumpyArrayWrapper, with its state, into the array whose bytes follow at `rest`. Returns the number of
/// bytes consumed: one for the length of the padding (joblib from 1.2), the padding, the elements.
size_t TakeJoblibArray(PickleContext* context, PickleNode* wrapper, std::string_view rest);

}  // namespace bodyloom
