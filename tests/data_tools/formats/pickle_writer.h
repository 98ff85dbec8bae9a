// SPDX-License-Identifier: Apache-2.0
/// Emits pickle byte streams by hand, so that the tests need no Python: the protocol-2 forms of Python 2 (as SMPL's
/// official files use them) and the protocol-4 forms of today's numpy.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace bodyloom::pickle_writer {

using Items = std::vector<std::pair<std::string, std::string>>;

inline std::string LittleEndian(uint64_t value, int bytes) {
  std::string text;
  for (int i = 0; i < bytes; ++i) text.push_back(static_cast<char>(value >> (8 * i)));
  return text;
}

inline std::string Pickle(int protocol, const std::string& body) {
  return std::string("\x80", 1) + static_cast<char>(protocol) + body + ".";
}
inline std::string Int(int32_t value) { return "J" + LittleEndian(static_cast<uint32_t>(value), 4); }
/// A Python-2 str (bytes read as latin-1).
inline std::string Str2(const std::string& text) {
  return text.size() < 256 ? "U" + LittleEndian(text.size(), 1) + text : "T" + LittleEndian(text.size(), 4) + text;
}
inline std::string Unicode(const std::string& text) { return "X" + LittleEndian(text.size(), 4) + text; }
inline std::string Bytes3(const std::string& text) { return "B" + LittleEndian(text.size(), 4) + text; }
inline std::string Global(const std::string& module, const std::string& name) {
  return "c" + module + "\n" + name + "\n";
}
inline std::string Tuple(const std::vector<std::string>& items) {
  std::string text = "(";
  for (const std::string& item : items) text += item;
  return text + "t";
}
/// Dictionary; keys and values are already opcodes.
inline std::string Dict(const Items& items) {
  std::string text = "}(";
  for (const auto& [key, value] : items) text += key + value;
  return text + "u";
}
inline std::string Dtype2(const std::string& name, char order) {
  return Global("numpy", "dtype") + Tuple({Str2(name), Int(0), Int(1)}) + "R" +
         Tuple({Int(3), Str2(std::string(1, order)), "N", "N", "N", Int(-1), Int(-1), Int(0)}) + "b";
}
inline std::string Shape(const std::vector<int>& shape) {
  std::vector<std::string> sizes;
  sizes.reserve(shape.size());
  for (const int n : shape) sizes.push_back(Int(n));
  return Tuple(sizes);
}
/// numpy.core.multiarray._reconstruct and its state.
inline std::string Array2(const std::string& dtype, char order, const std::vector<int>& shape, bool fortran_order,
                          const std::string& data, const std::string& module = "numpy.core.multiarray") {
  return Global(module, "_reconstruct") + Tuple({Global("numpy", "ndarray"), Tuple({Int(0)}), Str2("b")}) + "R" +
         Tuple({Int(1), Shape(shape), Dtype2(dtype, order), fortran_order ? "\x88" : "\x89", Str2(data)}) + "b";
}
template <typename T>
std::string RawOf(const std::vector<T>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}
inline std::string Doubles2(const std::vector<double>& values, const std::vector<int>& shape) {
  return Array2("f8", '<', shape, false, RawOf(values));
}
/// A new-style Python-2 object: class, object.__new__ by copy_reg, attribute dictionary.
inline std::string Object2(const std::string& module, const std::string& name, const Items& attributes) {
  return Global("copy_reg", "_reconstructor") + Tuple({Global(module, name), Global("__builtin__", "object"), "N"}) +
         "R" + Dict(attributes) + "b";
}

}  // namespace bodyloom::pickle_writer
