// SPDX-License-Identifier: Apache-2.0
/// A simple reader of binary FBX that shares no code with the writer: it parses records by the published description of
/// the format, checking every offset and size, and poses skins by connections and curves.
#pragma once

#include <gtest/gtest.h>
#include <zlib.h>

#include <Eigen/Geometry>
#include <cstring>
#include <map>
#include <string>
#include <vector>

namespace bodyloom {

struct FbxTwinProperty {
  char type = 0;
  double number = 0;            ///< C, I, D; also L if below 2^53
  int64_t whole = 0;            ///< C, I, L
  std::string text;             ///< S, R
  std::vector<double> numbers;  ///< arrays
};

struct FbxTwinNode {
  std::string name;
  std::vector<FbxTwinProperty> properties;
  std::vector<FbxTwinNode> nodes;

  [[nodiscard]] const FbxTwinNode* Find(const std::string& child) const {
    for (const FbxTwinNode& node : nodes) {
      if (node.name == child) return &node;
    }
    return nullptr;
  }
  [[nodiscard]] const FbxTwinNode& At(const std::string& child) const {
    const FbxTwinNode* node = Find(child);
    static const FbxTwinNode kNone;
    EXPECT_NE(node, nullptr) << name << " has no " << child;
    return node == nullptr ? kNone : *node;
  }
  [[nodiscard]] const std::vector<double>& Numbers(const std::string& child) const {
    static const std::vector<double> kNone;
    const FbxTwinNode& node = At(child);
    EXPECT_EQ(node.properties.size(), 1U) << child;
    return node.properties.empty() ? kNone : node.properties[0].numbers;
  }
  /// Values of a property of Properties70; none if it is not there.
  [[nodiscard]] std::vector<double> Property(const std::string& property) const {
    std::vector<double> values;
    const FbxTwinNode* all = Find("Properties70");
    if (all == nullptr) return values;
    for (const FbxTwinNode& p : all->nodes) {
      EXPECT_EQ(p.name, "P");
      if (p.properties.at(0).text != property) continue;
      for (size_t i = 4; i < p.properties.size(); ++i) values.push_back(p.properties[i].number);
    }
    return values;
  }
};

class FbxTwin {
 public:
  explicit FbxTwin(std::string bytes) : bytes_(std::move(bytes)) {
    EXPECT_EQ(bytes_.substr(0, 23), std::string("Kaydara FBX Binary  \0\x1a\0", 23));
    EXPECT_EQ(Word(23), 7400U);
    at_ = 27;
    root.nodes = Nodes();
    const size_t end = at_;
    // Footer: 16 bytes, 4 zeros, zeros up to a multiple of 16 (at least one), version, 120 zeros, 16 bytes.
    EXPECT_EQ(bytes_.size() % 16, 12U) << "136 + 4 bytes after a multiple of 16";
    const size_t version = bytes_.size() - 140;
    EXPECT_EQ(Word(version), 7400U);
    EXPECT_EQ(version % 16, 0U);
    EXPECT_GE(version, end + 21);
    EXPECT_LE(version, end + 36);
    for (size_t i = end + 16; i < version; ++i) EXPECT_EQ(bytes_[i], '\0');
    for (size_t i = version + 4; i < version + 124; ++i) EXPECT_EQ(bytes_[i], '\0');
    Index();
  }

  FbxTwinNode root;
  struct Link {
    int64_t from = 0, to = 0;
    std::string property;
  };
  std::vector<Link> links;
  std::map<int64_t, const FbxTwinNode*> objects;

  /// The object with a name and class ("Model", "Geometry", …); 0 without one.
  [[nodiscard]] int64_t Find(const std::string& name, const std::string& class_name) const {
    for (const auto& [id, node] : objects) {
      if (node->properties[1].text == name + std::string("\0\1", 2) + class_name) return id;
    }
    ADD_FAILURE() << "no " << class_name << ' ' << name;
    return 0;
  }
  /// Objects of a kind and subclass that hang on another.
  [[nodiscard]] std::vector<int64_t> Children(int64_t parent, const std::string& kind,
                                              const std::string& subclass = "") const {
    std::vector<int64_t> children;
    for (const Link& link : links) {
      if (link.to != parent || !link.property.empty() || !objects.contains(link.from)) continue;
      const FbxTwinNode& node = *objects.at(link.from);
      if (node.name == kind && (subclass.empty() || node.properties[2].text == subclass)) children.push_back(link.from);
    }
    return children;
  }
  [[nodiscard]] int64_t ParentModel(int64_t model) const {
    for (const Link& link : links) {
      if (link.from == model && link.property.empty() && objects.contains(link.to) &&
          objects.at(link.to)->name == "Model")
        return link.to;
    }
    return 0;
  }

  /// A curve's values and times (seconds), of "Lcl Rotation" and "d|X", say; empty without one.
  struct Curve {
    std::vector<double> seconds, values;
  };
  [[nodiscard]] Curve CurveOf(int64_t object, const std::string& property, const std::string& channel) const {
    for (const Link& link : links) {
      if (link.to != object || link.property != property) continue;
      for (const Link& inner : links) {
        if (inner.to != link.from || inner.property != channel) continue;
        const FbxTwinNode& node = *objects.at(inner.from);
        Curve curve{node.Numbers("KeyTime"), node.Numbers("KeyValueFloat")};
        for (double& s : curve.seconds) s /= 46186158000.0;
        EXPECT_EQ(curve.seconds.size(), curve.values.size());
        EXPECT_EQ(node.Numbers("KeyAttrRefCount"), std::vector<double>{double(curve.values.size())});
        EXPECT_EQ(int64_t(node.Numbers("KeyAttrFlags").at(0)) & 4, 4) << "linear";
        return curve;
      }
    }
    return {};
  }

  /// Local transform of a model at key k (−1: without animation), centimetres.
  [[nodiscard]] Eigen::Affine3d Local(int64_t model, int key) const {
    const auto value = [&](const std::string& property) {
      const std::vector<double> own = objects.at(model)->Property(property);
      Eigen::Vector3d v(own.at(0), own.at(1), own.at(2));
      for (int k = 0; k < 3 && key >= 0; ++k) {
        const Curve curve = CurveOf(model, property, std::string("d|") + "XYZ"[k]);
        if (!curve.values.empty()) v[k] = curve.values.at(size_t(key));
      }
      return v;
    };
    const Eigen::Vector3d angles = value("Lcl Rotation") * (M_PI / 180);
    return Eigen::Translation3d(value("Lcl Translation")) * Eigen::AngleAxisd(angles.z(), Eigen::Vector3d::UnitZ()) *
           Eigen::AngleAxisd(angles.y(), Eigen::Vector3d::UnitY()) *
           Eigen::AngleAxisd(angles.x(), Eigen::Vector3d::UnitX());
  }
  [[nodiscard]] Eigen::Affine3d Global(int64_t model, int key) const {
    const int64_t parent = ParentModel(model);
    return parent == 0 ? Local(model, key) : Global(parent, key) * Local(model, key);
  }

  /// The skinned vertices of a geometry at key k, centimetres.
  [[nodiscard]] Eigen::MatrixXd Pose(int64_t geometry, int key) const {
    Eigen::MatrixXd rest = Points(objects.at(geometry)->Numbers("Vertices"));
    for (const int64_t shapes : Children(geometry, "Deformer", "BlendShape")) {
      for (const int64_t channel : Children(shapes, "Deformer", "BlendShapeChannel")) {
        const double weight = CurveOf(channel, "DeformPercent", "d|DeformPercent").values.at(size_t(key)) / 100;
        const FbxTwinNode& shape = *objects.at(Children(channel, "Geometry", "Shape").at(0));
        const Eigen::MatrixXd moves = Points(shape.Numbers("Vertices"));
        const std::vector<double>& indices = shape.Numbers("Indexes");
        for (size_t i = 0; i < indices.size(); ++i)
          rest.row(Eigen::Index(indices[i])) += weight * moves.row(Eigen::Index(i));
      }
    }
    Eigen::MatrixXd posed = Eigen::MatrixXd::Zero(rest.rows(), 3);
    for (const int64_t cluster : Children(Children(geometry, "Deformer", "Skin").at(0), "Deformer", "Cluster")) {
      const FbxTwinNode& node = *objects.at(cluster);
      const Eigen::Matrix4d transform = Matrix(node.Numbers("Transform")), link = Matrix(node.Numbers("TransformLink"));
      EXPECT_TRUE((link * transform).isIdentity(1e-12)) << "the mesh rests at the origin";
      const Eigen::Matrix4d motion = Global(Children(cluster, "Model", "LimbNode").at(0), key).matrix() * transform;
      const std::vector<double>&indices = node.Numbers("Indexes"), &weights = node.Numbers("Weights");
      EXPECT_EQ(indices.size(), weights.size());
      for (size_t i = 0; i < indices.size(); ++i) {
        const auto v = Eigen::Index(indices[i]);
        posed.row(v) +=
            weights[i] *
            (motion.topLeftCorner<3, 3>() * rest.row(v).transpose() + motion.topRightCorner<3, 1>()).transpose();
      }
    }
    return posed;
  }

 private:
  static Eigen::MatrixXd Points(const std::vector<double>& values) {
    return Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>>(
        values.data(), Eigen::Index(values.size() / 3), 3);
  }
  static Eigen::Matrix4d Matrix(const std::vector<double>& values) {
    EXPECT_EQ(values.size(), 16U);
    return Eigen::Map<const Eigen::Matrix4d>(values.data());  // by columns
  }

  [[nodiscard]] uint32_t Word(size_t at) const {
    uint32_t word = 0;
    EXPECT_LE(at + 4, bytes_.size());
    if (at + 4 <= bytes_.size()) std::memcpy(&word, bytes_.data() + at, 4);
    return word;
  }
  template <typename T>
  T Take() {
    T value{};
    if (at_ + sizeof(T) > bytes_.size()) throw std::runtime_error("truncated");
    std::memcpy(&value, bytes_.data() + at_, sizeof(T));
    at_ += sizeof(T);
    return value;
  }
  std::string TakeBytes(size_t size) {
    if (size > bytes_.size() - at_) throw std::runtime_error("truncated");
    at_ += size;
    return bytes_.substr(at_ - size, size);
  }

  /// Records up to the one of 13 zeros.
  std::vector<FbxTwinNode> Nodes() {
    std::vector<FbxTwinNode> nodes;
    while (true) {
      const size_t end = Take<uint32_t>(), count = Take<uint32_t>(), size = Take<uint32_t>();
      FbxTwinNode node;
      node.name = TakeBytes(Take<uint8_t>());
      if (end == 0) {
        EXPECT_TRUE(count == 0 && size == 0 && node.name.empty());
        return nodes;
      }
      const size_t begin = at_;
      for (size_t i = 0; i < count; ++i) node.properties.push_back(TakeProperty());
      EXPECT_EQ(at_ - begin, size) << node.name;
      if (at_ < end) node.nodes = Nodes();
      EXPECT_EQ(at_, end) << node.name;
      nodes.push_back(std::move(node));
    }
  }

  FbxTwinProperty TakeProperty() {
    FbxTwinProperty p;
    p.type = Take<char>();
    switch (p.type) {
      case 'C':
        p.whole = Take<int8_t>();
        break;
      case 'I':
        p.whole = Take<int32_t>();
        break;
      case 'L':
        p.whole = Take<int64_t>();
        break;
      case 'D':
        p.number = Take<double>();
        return p;
      case 'S':
      case 'R':
        p.text = TakeBytes(Take<uint32_t>());
        return p;
      case 'i':
        p.numbers = TakeArray<int32_t>();
        return p;
      case 'l':
        p.numbers = TakeArray<int64_t>();
        return p;
      case 'f':
        p.numbers = TakeArray<float>();
        return p;
      case 'd':
        p.numbers = TakeArray<double>();
        return p;
      default:
        throw std::runtime_error(std::string("type ") + p.type);
    }
    p.number = double(p.whole);
    return p;
  }

  template <typename T>
  std::vector<double> TakeArray() {
    const size_t count = Take<uint32_t>(), encoding = Take<uint32_t>();
    const std::string packed = TakeBytes(Take<uint32_t>());
    EXPECT_EQ(encoding, 1U);
    std::vector<T> values(count + 1);  // room for one more, which must not come
    uLongf size = values.size() * sizeof(T);
    EXPECT_EQ(uncompress(reinterpret_cast<Bytef*>(values.data()), &size, reinterpret_cast<const Bytef*>(packed.data()),
                         packed.size()),
              Z_OK);
    EXPECT_EQ(size, count * sizeof(T));
    return {values.begin(), values.end() - 1};
  }

  void Index() {
    for (const FbxTwinNode& node : root.At("Objects").nodes) {
      EXPECT_TRUE(objects.emplace(node.properties.at(0).whole, &node).second) << "two objects of one number";
    }
    for (const FbxTwinNode& node : root.At("Connections").nodes) {
      links.push_back({node.properties.at(1).whole, node.properties.at(2).whole,
                       node.properties.size() > 3 ? node.properties[3].text : ""});
      EXPECT_EQ(node.properties[0].text, links.back().property.empty() ? "OO" : "OP");
      EXPECT_TRUE(objects.contains(links.back().from));
      EXPECT_TRUE(links.back().to == 0 || objects.contains(links.back().to));
    }
  }

  std::string bytes_;
  size_t at_ = 0;
};

}  // namespace bodyloom
