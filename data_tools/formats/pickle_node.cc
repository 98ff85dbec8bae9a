// SPDX-License-Identifier: Apache-2.0
#include "data_tools/formats/pickle_node.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <optional>
#include <span>
#include <utility>

#include "data_tools/formats/element_type.h"
#include "data_tools/formats/printable.h"
#include "geometry/base/check.h"

namespace bodyloom {
namespace {

using Kind = PickleValue::Kind;

struct NamedGlobal {
  std::string_view name;
  PickleGlobal global;
};

constexpr NamedGlobal kGlobals[] = {
    {"numpy.ndarray", PickleGlobal::kNdarray},
    {"numpy.dtype", PickleGlobal::kDtype},
    {"numpy.core.multiarray._reconstruct", PickleGlobal::kReconstruct},
    {"numpy._core.multiarray._reconstruct", PickleGlobal::kReconstruct},
    {"numpy.core.multiarray.scalar", PickleGlobal::kScalar},
    {"numpy._core.multiarray.scalar", PickleGlobal::kScalar},
    {"numpy.core.numeric._frombuffer", PickleGlobal::kFromBuffer},
    {"numpy._core.numeric._frombuffer", PickleGlobal::kFromBuffer},
    {"scipy.sparse.csc.csc_matrix", PickleGlobal::kSparseColumns},
    {"scipy.sparse._csc.csc_matrix", PickleGlobal::kSparseColumns},
    {"scipy.sparse._csc.csc_array", PickleGlobal::kSparseColumns},
    {"scipy.sparse.csr.csr_matrix", PickleGlobal::kSparseRows},
    {"scipy.sparse._csr.csr_matrix", PickleGlobal::kSparseRows},
    {"scipy.sparse._csr.csr_array", PickleGlobal::kSparseRows},
    {"chumpy.ch.Ch", PickleGlobal::kChumpyArray},
    {"chumpy.reordering.Select", PickleGlobal::kChumpySelect},
    {"collections.OrderedDict", PickleGlobal::kOrderedDict},
    {"collections.defaultdict", PickleGlobal::kDefaultDict},
    {"__builtin__.dict", PickleGlobal::kDict},
    {"builtins.dict", PickleGlobal::kDict},
    {"joblib.numpy_pickle.NumpyArrayWrapper", PickleGlobal::kJoblibArray},
    {"_codecs.encode", PickleGlobal::kEncode},
    {"copy_reg._reconstructor", PickleGlobal::kReconstructor},
    {"copyreg._reconstructor", PickleGlobal::kReconstructor},
    {"__builtin__.object", PickleGlobal::kObject},
    {"builtins.object", PickleGlobal::kObject},
    {"__builtin__.bytes", PickleGlobal::kBytes},
    {"builtins.bytes", PickleGlobal::kBytes},
    {"__builtin__.set", PickleGlobal::kSet},
    {"builtins.set", PickleGlobal::kSet},
    {"__builtin__.frozenset", PickleGlobal::kSet},
    {"builtins.frozenset", PickleGlobal::kSet},
};

constexpr NamedGlobal kTorchGlobals[] = {
    {"collections.OrderedDict", PickleGlobal::kOrderedDict},
    {"torch._utils._rebuild_tensor", PickleGlobal::kTorchRebuild},
    {"torch._utils._rebuild_tensor_v2", PickleGlobal::kTorchRebuild},
    {"torch._utils._rebuild_parameter", PickleGlobal::kTorchRebuild},
    {"torch.nn.parameter.Parameter", PickleGlobal::kTorchParameter},
    {"torch.DoubleStorage", PickleGlobal::kTorchStorage},
    {"torch.FloatStorage", PickleGlobal::kTorchStorage},
    {"torch.HalfStorage", PickleGlobal::kTorchStorage},
    {"torch.BFloat16Storage", PickleGlobal::kTorchStorage},
    {"torch.LongStorage", PickleGlobal::kTorchStorage},
    {"torch.IntStorage", PickleGlobal::kTorchStorage},
    {"torch.ShortStorage", PickleGlobal::kTorchStorage},
    {"torch.CharStorage", PickleGlobal::kTorchStorage},
    {"torch.ByteStorage", PickleGlobal::kTorchStorage},
    {"torch.BoolStorage", PickleGlobal::kTorchStorage},
};

bool IsText(const PickleNode& node) { return node.kind == Kind::kString || node.kind == Kind::kBytes; }

const PickleNode& Argument(const PickleContext& context, const PickleNode& args, size_t i, const char* what) {
  if (i >= args.items.size()) {
    context.Fail(Concatenate(what, " called with ", args.items.size(), " arguments, expected more"));
  }
  return AsNode(args.items[i]);
}

/// A tuple of sizes.
std::vector<int64_t> ShapeOf(const PickleContext& context, const PickleNode& node) {
  if (node.kind != Kind::kTuple) context.Fail("array shape: expected a tuple");
  std::vector<int64_t> shape;
  for (const PicklePtr& item : node.items) {
    if (item->kind != Kind::kInt || item->integer < 0) context.Fail("array shape: expected sizes of at least 0");
    shape.push_back(item->integer);
  }
  return shape;
}

std::string DescrOf(const PickleContext& context, const PickleNode& node) {
  if (node.kind != Kind::kObject || node.global != PickleGlobal::kDtype || node.is_callable) {
    context.Fail("array: expected a numpy.dtype");
  }
  return node.text;
}

NdArray MakeArray(PickleContext* context, const std::string& descr, std::vector<int64_t> shape, bool fortran_order,
                  std::string_view bytes) {
  const std::optional<ElementType> type = ParseElementType(descr);
  if (!type) context->Fail("array of element type '" + PrintableText(descr) + "', expected numbers or text");
  const std::optional<size_t> expected = ArrayBytes(shape, type->item_size);
  if (!expected || *expected != bytes.size()) {
    context->Fail(Concatenate("the array's shape needs ", expected ? std::to_string(*expected) : "too many",
                              " bytes, the file holds ", bytes.size()));
  }
  context->Charge(bytes.size());
  return ArrayFromBytes(*type, std::move(shape), fortran_order, bytes);
}

/// (version, shape, dtype, is_fortran, data), or without the version as old numpy wrote it.
void SetArrayState(PickleContext* context, PickleNode* array, const PickleNode& state) {
  const size_t n = state.items.size();
  if (state.kind != Kind::kTuple || (n != 4 && n != 5)) context->Fail("array state: expected a tuple of 5");
  const std::vector<int64_t> shape = ShapeOf(*context, AsNode(state.items[n - 4]));
  const std::string descr = DescrOf(*context, AsNode(state.items[n - 3]));
  const PickleNode& order = AsNode(state.items[n - 2]);
  const PickleNode& data = AsNode(state.items[n - 1]);
  const bool fortran_order = order.boolean || order.integer != 0;
  array->is_open = false;
  if (data.kind == Kind::kList) {  // an array of objects: its elements
    context->Charge(data.items.size() * sizeof(PicklePtr));
    array->kind = Kind::kList;
    array->items = data.items;
    return;
  }
  if (!IsText(data)) context->Fail("array state: expected its bytes");
  array->array = MakeArray(context, descr, shape, fortran_order, data.Text());
}

/// (version, byte order, subtype, field names, …): only the byte order matters for plain types.
void SetDtypeState(const PickleContext& context, PickleNode* dtype, const PickleNode& state) {
  if (state.kind != Kind::kTuple || state.items.size() < 5) context.Fail("dtype state: expected a tuple");
  for (const size_t i : {2, 3}) {
    if (state.items[i]->kind != Kind::kNone) context.Fail("dtype: structured types are not read");
  }
  const std::string_view order = AsNode(state.items[1]).Text();
  if (order != "<" && order != ">" && order != "|" && order != "=") context.Fail("dtype: expected a byte order");
  if (!dtype->text.empty() && std::strchr("<>|=", dtype->text[0]) != nullptr) dtype->text.erase(0, 1);
  dtype->text.insert(0, order);
}

PickleNodePtr NewDtype(PickleContext* context, const PickleNode& args) {
  const PickleNode& descr = Argument(*context, args, 0, "numpy.dtype");
  if (!IsText(descr)) context->Fail("numpy.dtype: expected the name of a type");
  if (descr.Text().size() > 64)
    context->Fail("numpy.dtype: a name of " + std::to_string(descr.Text().size()) + " bytes");
  PickleNodePtr dtype = context->New(Kind::kObject);
  dtype->global = PickleGlobal::kDtype;
  dtype->text = std::string(descr.Text());
  return dtype;
}

PickleNodePtr NewScalar(PickleContext* context, const PickleNode& args) {
  const std::string descr = DescrOf(*context, Argument(*context, args, 0, "numpy scalar"));
  const PickleNode& data = Argument(*context, args, 1, "numpy scalar");
  if (!IsText(data)) context->Fail("numpy scalar: expected its bytes");
  const NdArray array = MakeArray(context, descr, {}, false, data.Text());
  PickleNodePtr scalar = context->New(Kind::kFloat);
  if (array.is_text()) {
    scalar->kind = array.dtype == DType::kBytes ? Kind::kBytes : Kind::kString;
    scalar->text = array.ToStrings().front();
    return scalar;
  }
  scalar->real = array.ToDoubles().front();
  if (array.dtype == DType::kBool) {
    scalar->kind = Kind::kBool;
    scalar->boolean = scalar->real != 0;
  } else if (array.dtype != DType::kF16 && array.dtype != DType::kF32 && array.dtype != DType::kF64 &&
             scalar->real < 9.2e18) {
    scalar->kind = Kind::kInt;
    scalar->integer = array.ToInts().front();
  }
  return scalar;
}

PickleNodePtr NewFromBuffer(PickleContext* context, const PickleNode& args) {
  const char* what = "numpy _frombuffer";
  const PickleNode& data = Argument(*context, args, 0, what);
  if (!IsText(data)) context->Fail("numpy _frombuffer: expected bytes");
  const std::string descr = DescrOf(*context, Argument(*context, args, 1, what));
  const std::vector<int64_t> shape = ShapeOf(*context, Argument(*context, args, 2, what));
  const bool fortran_order = Argument(*context, args, 3, what).Text() == "F";
  PickleNodePtr array = context->New(Kind::kArray);
  array->array = MakeArray(context, descr, shape, fortran_order, data.Text());
  return array;
}

/// UTF-8 text back to the latin-1 bytes it stands for.
PickleNodePtr EncodeLatin1(PickleContext* context, const PickleNode& args) {
  const PickleNode& text = Argument(*context, args, 0, "_codecs.encode");
  const std::string_view encoding = Argument(*context, args, 1, "_codecs.encode").Text();
  if (text.kind != Kind::kString || (encoding != "latin1" && encoding != "latin-1" && encoding != "iso-8859-1")) {
    context->Fail("_codecs.encode: expected text and 'latin1', found '" + PrintableText(encoding) + "'");
  }
  const std::string_view utf8 = text.Text();
  context->Charge(utf8.size());
  PickleNodePtr bytes = context->New(Kind::kBytes);
  bytes->text.reserve(utf8.size());
  for (size_t i = 0; i < utf8.size(); ++i) {
    const auto c = static_cast<unsigned char>(utf8[i]);
    if (c < 0x80) {
      bytes->text.push_back(utf8[i]);
    } else if ((c == 0xC2 || c == 0xC3) && i + 1 < utf8.size()) {
      bytes->text.push_back(static_cast<char>(((c & 3) << 6) | (static_cast<unsigned char>(utf8[++i]) & 63)));
    } else {
      context->Fail("_codecs.encode: a character outside latin-1");
    }
  }
  return bytes;
}

/// An OrderedDict from the list of its [key, value] pairs (as Python 2 wrote it).
PickleNodePtr NewOrderedDict(PickleContext* context, const PickleNode& args) {
  PickleNodePtr dict = context->New(Kind::kDict);
  dict->global = PickleGlobal::kOrderedDict;
  if (args.items.empty()) return dict;
  for (const PicklePtr& pair : args.items[0]->items) {
    if (pair->items.size() != 2 || !IsText(AsNode(pair->items[0]))) {
      context->Fail("collections.OrderedDict: expected pairs of text and value");
    }
    const std::string_view key = AsNode(pair->items[0]).Text();
    context->Charge(key.size() + sizeof(dict->dict[0]));
    dict->dict.emplace_back(std::string(key), pair->items[1]);
  }
  return dict;
}

/// A set from the list of its members, as a list.
PickleNodePtr NewSet(PickleContext* context, const PickleNode& args) {
  PickleNodePtr set = context->New(Kind::kList);
  if (args.items.empty()) return set;
  if (args.items[0]->kind != Kind::kList) context->Fail("set: expected the list of its members");
  context->Charge(args.items[0]->items.size() * sizeof(PicklePtr));
  set->items = args.items[0]->items;
  return set;
}

PickleNodePtr NewInstance(PickleContext* context, const PickleNode& cls) {
  PickleNodePtr object = context->New(Kind::kObject);
  object->global = cls.global;
  object->text = cls.text;
  return object;
}

const NdArray& ArrayAttribute(const PickleContext& context, const PickleNode& state, const std::string& class_name,
                              const std::string& key) {
  const PickleValue* value = state.Find(key);
  if (value == nullptr || value->kind != Kind::kArray || !value->array.is_number()) {
    context.Fail(class_name + ": expected an array of numbers '" + key + "'");
  }
  return value->array;
}

/// The whole numbers of an index array.
std::vector<int64_t> Indices(PickleContext* context, const NdArray& array) {
  context->Charge(static_cast<size_t>(array.num_elements()) * sizeof(int64_t));
  try {
    return array.ToInts();
  } catch (const std::invalid_argument& error) {
    context->Fail(error.what());
  }
}

NdArray DenseFromSparse(PickleContext* context, const PickleNode& state, bool by_columns) {
  const std::string name = by_columns ? "scipy.sparse csc matrix" : "scipy.sparse csr matrix";
  const PickleValue* shape_value = state.Find("_shape");
  if (shape_value == nullptr) shape_value = state.Find("shape");
  if (shape_value == nullptr) context->Fail(name + ": no shape");
  const std::vector<int64_t> shape = ShapeOf(*context, static_cast<const PickleNode&>(*shape_value));
  const std::optional<size_t> dense_bytes = ArrayBytes(shape, sizeof(double));
  if (shape.size() != 2 || !dense_bytes) context->Fail(name + ": expected two sizes");
  const NdArray& data = ArrayAttribute(*context, state, name, "data");
  const std::vector<int64_t> begin = Indices(context, ArrayAttribute(*context, state, name, "indptr"));
  const std::vector<int64_t> index = Indices(context, ArrayAttribute(*context, state, name, "indices"));
  const int64_t outer_size = by_columns ? shape[1] : shape[0], inner_size = by_columns ? shape[0] : shape[1];
  const auto stored = static_cast<int64_t>(std::min<size_t>(index.size(), static_cast<size_t>(data.num_elements())));
  if (static_cast<int64_t>(begin.size()) - 1 != outer_size || begin.front() != 0 || begin.back() > stored ||
      !std::is_sorted(begin.begin(), begin.end())) {
    context->Fail(Concatenate(name, " of ", shape[0], "x", shape[1], ": indptr does not fit its ", stored, " entries"));
  }
  context->Charge(*dense_bytes + static_cast<size_t>(data.num_elements()) * sizeof(double));
  const std::vector<double> values = data.ToDoubles();
  std::vector<double> dense(static_cast<size_t>(shape[0] * shape[1]), 0.0);
  for (int64_t outer = 0; outer < outer_size; ++outer) {
    for (int64_t k = begin[outer]; k < begin[outer + 1]; ++k) {
      const int64_t inner = index[k];
      if (inner < 0 || inner >= inner_size) {
        context->Fail(Concatenate(name, ": index ", inner, ", expected 0..", inner_size - 1));
      }
      dense[by_columns ? inner * shape[1] + outer : outer * shape[1] + inner] += values[k];
    }
  }
  return NdArray::FromDoubles(dense.data(), shape);
}

NdArray Select(PickleContext* context, const PickleNode& state) {
  const std::string name = "chumpy.reordering.Select";
  const NdArray& source = ArrayAttribute(*context, state, name, "a");
  const std::vector<int64_t> index = Indices(context, ArrayAttribute(*context, state, name, "idxs"));
  NdArray result;
  result.dtype = source.dtype;
  result.item_size = source.item_size;
  result.shape = {static_cast<int64_t>(index.size())};
  const PickleValue* shape = state.Find("preferred_shape");
  if (shape != nullptr && shape->kind == Kind::kTuple) {
    result.shape = ShapeOf(*context, static_cast<const PickleNode&>(*shape));
    const std::optional<size_t> bytes = ArrayBytes(result.shape, 1);
    if (!bytes || *bytes != index.size()) context->Fail(name + ": preferred_shape does not fit its indices");
  }
  context->Charge(index.size() * result.item_size);
  result.bytes.resize(index.size() * result.item_size);
  const int64_t n = source.num_elements();
  for (size_t i = 0; i < index.size(); ++i) {
    if (index[i] < 0 || index[i] >= n) context->Fail(Concatenate(name, ": index ", index[i], ", expected 0..", n - 1));
    std::memcpy(result.bytes.data() + i * result.item_size, source.bytes.data() + index[i] * result.item_size,
                result.item_size);
  }
  return result;
}

NdArray ChumpyArray(PickleContext* context, const PickleNode& state) {
  const PickleValue* x = state.Find("x");
  if (x != nullptr && (x->kind == Kind::kFloat || x->kind == Kind::kInt)) {
    return NdArray::FromDouble(x->kind == Kind::kFloat ? x->real : static_cast<double>(x->integer));
  }
  const NdArray& array = ArrayAttribute(*context, state, "chumpy.ch.Ch", "x");
  context->Charge(array.bytes.size());
  return array;
}

}  // namespace

PickleGlobal FindPickleGlobal(PickleDialect dialect, std::string_view name) {
  const bool torch = dialect == PickleDialect::kTorch;
  for (const NamedGlobal& known : torch ? std::span<const NamedGlobal>(kTorchGlobals) : kGlobals) {
    if (known.name == name) return known.global;
  }
  return PickleGlobal::kNone;
}

PickleNodePtr CallPickleGlobal(PickleContext* context, const PickleNode& callable, const PickleNode& args) {
  if (!callable.is_callable || args.kind != Kind::kTuple) {
    context->Fail("a call of something that is neither class nor function, or without a tuple of arguments");
  }
  switch (callable.global) {
    case PickleGlobal::kReconstruct:
    case PickleGlobal::kNdarray: {
      PickleNodePtr array = context->New(Kind::kArray);
      array->array.shape = {0};
      array->is_open = true;
      return array;
    }
    case PickleGlobal::kScalar:
      return NewScalar(context, args);
    case PickleGlobal::kFromBuffer:
      return NewFromBuffer(context, args);
    case PickleGlobal::kDtype:
      return NewDtype(context, args);
    case PickleGlobal::kOrderedDict:
      return NewOrderedDict(context, args);
    case PickleGlobal::kDefaultDict:  // its argument is the factory of defaults
      return context->New(Kind::kDict);
    case PickleGlobal::kDict:
      if (!args.items.empty()) context->Fail("dict called with arguments, expected none");
      return context->New(Kind::kDict);
    case PickleGlobal::kEncode:
      return EncodeLatin1(context, args);
    case PickleGlobal::kBytes:
      if (!args.items.empty()) context->Fail("bytes called with arguments, expected none");
      return context->New(Kind::kBytes);
    case PickleGlobal::kSet:
      return NewSet(context, args);
    case PickleGlobal::kReconstructor: {
      const PickleNode& cls = Argument(*context, args, 0, "copy_reg._reconstructor");
      if (!cls.is_callable) context->Fail("copy_reg._reconstructor: expected a class");
      return NewInstance(context, cls);
    }
    case PickleGlobal::kTorchRebuild:
    case PickleGlobal::kTorchParameter: {
      PickleNodePtr call = NewInstance(context, callable);
      context->Charge(args.items.size() * sizeof(PicklePtr));
      call->items = args.items;
      return call;
    }
    case PickleGlobal::kSparseColumns:
    case PickleGlobal::kSparseRows:
    case PickleGlobal::kChumpyArray:
    case PickleGlobal::kChumpySelect:
    case PickleGlobal::kJoblibArray:
    case PickleGlobal::kObject:
      return NewInstance(context, callable);
    case PickleGlobal::kTorchStorage:
    case PickleGlobal::kNone:
      break;
  }
  context->Fail("a call of '" + PrintableText(callable.text) + "', which builds no data");
}

void SetPickleState(PickleContext* context, PickleNode* object, const PicklePtr& state_value) {
  const PickleNode& state = AsNode(state_value);
  if (object->kind == Kind::kArray && object->is_open) return SetArrayState(context, object, state);
  if (object->kind == Kind::kDict && object->global == PickleGlobal::kOrderedDict && state.kind == Kind::kDict) {
    return;  // attributes of the dictionary itself, not entries
  }
  if (object->kind != Kind::kObject || object->is_callable) {
    context->Fail("a state for something that takes none");
  }
  if (object->global == PickleGlobal::kDtype) return SetDtypeState(*context, object, state);
  if (object->global == PickleGlobal::kTorchParameter && state.kind == Kind::kTuple) {
    context->Charge(state.items.size() * sizeof(PicklePtr));
    object->items.insert(object->items.end(), state.items.begin(), state.items.end());
    return;
  }
  if (state.kind != Kind::kDict) {
    context->Fail("the state of a '" + PrintableText(object->text) + "': expected a dictionary");
  }
  switch (object->global) {
    case PickleGlobal::kSparseColumns:
      object->array = DenseFromSparse(context, state, true);
      break;
    case PickleGlobal::kSparseRows:
      object->array = DenseFromSparse(context, state, false);
      break;
    case PickleGlobal::kChumpyArray:
      object->array = ChumpyArray(context, state);
      break;
    case PickleGlobal::kChumpySelect:
      object->array = Select(context, state);
      break;
    default:
      context->Charge(state.dict.size() * sizeof(state.dict[0]));
      for (const auto& [key, value] : state.dict) context->Charge(key.size());
      object->dict = state.dict;
      return;
  }
  object->kind = Kind::kArray;
  object->text.clear();
}

size_t TakeJoblibArray(PickleContext* context, PickleNode* wrapper, std::string_view rest) {
  const auto attribute = [&](const char* key) -> const PickleNode& {
    const PickleValue* value = wrapper->Find(key);
    if (value == nullptr) context->Fail(Concatenate("joblib array: no '", key, "'"));
    return static_cast<const PickleNode&>(*value);
  };
  if (attribute("subclass").global != PickleGlobal::kNdarray) context->Fail("joblib array: expected a numpy.ndarray");
  const std::vector<int64_t> shape = ShapeOf(*context, attribute("shape"));
  const std::string descr = DescrOf(*context, attribute("dtype"));
  const bool fortran_order = attribute("order").Text() == "F";
  size_t padding = 0;
  const PickleValue* alignment = wrapper->Find("numpy_array_alignment_bytes");
  if (alignment != nullptr && alignment->kind != Kind::kNone) {
    padding = rest.empty() ? 1 : 1 + static_cast<unsigned char>(rest[0]);
    if (padding > rest.size()) context->Fail("joblib array: the file is cut off in its padding");
  }
  const std::optional<ElementType> type = ParseElementType(descr);
  const std::optional<size_t> bytes = type ? ArrayBytes(shape, type->item_size) : std::nullopt;
  if (type && (!bytes || *bytes > rest.size() - padding)) {
    context->Fail(Concatenate("joblib array: its shape needs ", bytes ? std::to_string(*bytes) : "too many",
                              " bytes, the file holds ", rest.size() - padding));
  }
  const size_t taken = bytes.value_or(0);
  wrapper->array = MakeArray(context, descr, shape, fortran_order, rest.substr(padding, taken));
  wrapper->kind = Kind::kArray;
  wrapper->global = PickleGlobal::kNone;
  wrapper->text.clear();
  wrapper->dict.clear();
  return padding + taken;
}

}  // namespace bodyloom
