// SPDX-License-Identifier: Apache-2.0
/// An FBX document: objects with numbers, connections among them, and the settings of the scene. Centimetres, FBX's own
/// unit (UnitScaleFactor 1), y up, right-handed, front +z.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace bodyloom {

// Records of a binary FBX file, version 7.4. A record has a name, typed properties, and nested records:
//
//   head             u32 offset of its end from the file's start, u32 number of properties, u32 their bytes, u8 length
//                    of the name, name
//   properties       a letter for the type, then the value: C bool, I int32, L int64, D double; S text and R bytes
//                    with u32 length; arrays i, l, f, d: u32 count, u32 1, u32 bytes, values as a zlib stream
//   nested records   and 13 zeros; nothing if there are none, unless MarkAsBlock()
// All little-endian.
// Source: Blender developers' blog, "FBX binary file format specification"; the footer as in Assimp's FBXExporter.cpp.

class FbxNode {
 public:
  explicit FbxNode(std::string name) : name_(std::move(name)) {}

  // Appends a property; returns *this.
  FbxNode& Bool(bool value);
  FbxNode& Int(int32_t value);
  FbxNode& Long(int64_t value);
  FbxNode& Double(double value);
  FbxNode& Text(const std::string& text);
  FbxNode& Bytes(const std::string& bytes);
  FbxNode& Ints(std::span<const int32_t> values);
  FbxNode& Longs(std::span<const int64_t> values);
  FbxNode& Floats(std::span<const float> values);
  FbxNode& Doubles(std::span<const double> values);

  /// Appends a nested record; returns *this.
  FbxNode& Add(FbxNode node);
  /// Makes the record end with zeros even if nothing is nested; returns *this.
  FbxNode& MarkAsBlock();

  [[nodiscard]] const std::string& name() const { return name_; }
  /// Appends the record to the bytes of a file, which begin with the file's first.
  void AppendTo(std::string* file) const;

 private:
  FbxNode& AddProperty(char type, const void* value, size_t size);
  FbxNode& AddArray(char type, size_t count, const void* values, size_t size);

  std::string name_, properties_;
  uint32_t num_properties_ = 0;
  bool block_ = false;
  std::vector<FbxNode> nodes_;
};

/// A value of "Properties70": P: name, type, label, flags ("A": can be animated; "U": the user's), values.
FbxNode FbxProperty(const std::string& name, const std::string& type, const std::string& label,
                    const std::string& flags);
FbxNode FbxInt(const std::string& name, int32_t value, const std::string& type = "int");
FbxNode FbxDouble(const std::string& name, double value, const std::string& type = "double");
/// Three numbers, which can be animated, as "Lcl Translation".
FbxNode FbxVector(const std::string& name, const std::string& type, std::initializer_list<double> xyz);
/// Properties70 with these values.
FbxNode FbxProperties(std::initializer_list<FbxNode> values);

/// The file of these top-level records. Throws std::invalid_argument above 4 GiB.
std::string FbxBytes(const std::vector<FbxNode>& nodes);

constexpr double kFbxPerMetre = 100;

/// FBX's clock counts 1/46186158000 s.
int64_t FbxTime(double seconds);

class FbxDocument {
 public:
  /// Adds an object of a kind ("Model", "Geometry", …) with the nested records of `content`; `class_name` and
  /// `subclass` are, for example, "Model" and "LimbNode". Returns its number.
  int64_t Add(const std::string& kind, const std::string& name, const std::string& class_name,
              const std::string& subclass, const std::vector<FbxNode>& content);
  /// Attaches an object to another, 0: the scene; with a property's name to this property of it.
  void Connect(int64_t child, int64_t parent, const std::string& property = "");

  /// The file, with the frame rate and the length of the scene and the name of its only animation. It bears no date, so
  /// that the same scene gives the same bytes. Throws std::invalid_argument above 4 GiB.
  [[nodiscard]] std::string Bytes(double fps, double duration_s, const std::string& animation) const;

 private:
  int64_t last_number_ = 1'000'000;
  FbxNode objects_ = FbxNode("Objects"), connections_ = FbxNode("Connections");
  std::map<std::string, int> count_;  ///< of objects, by kind
};

}  // namespace bodyloom
