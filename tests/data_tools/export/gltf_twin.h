// SPDX-License-Identifier: Apache-2.0
/// A simple glTF reader that shares no code with the writer: it parses the file by the specification and poses its
/// skins.
#pragma once

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cstring>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace bodyloom {

class GltfTwin {
 public:
  explicit GltfTwin(const std::string& bytes) {
    EXPECT_EQ(bytes.substr(0, 4), "glTF");
    EXPECT_EQ(Word(bytes, 4), 2U);
    EXPECT_EQ(Word(bytes, 8), bytes.size());
    const size_t json_length = Word(bytes, 12);
    EXPECT_EQ(bytes.substr(16, 4), "JSON");
    EXPECT_EQ(json_length % 4, 0U);
    json = nlohmann::json::parse(bytes.substr(20, json_length));
    const size_t at = 20 + json_length;
    EXPECT_EQ(bytes.substr(at + 4, 4), std::string("BIN\0", 4));
    EXPECT_EQ(at + 8 + Word(bytes, at), bytes.size());
    binary_ = bytes.substr(at + 8);
    EXPECT_LE(json["buffers"][0]["byteLength"].get<size_t>(), binary_.size());
    EXPECT_GT(json["buffers"][0]["byteLength"].get<size_t>() + 4, binary_.size());
  }

  /// Values of an accessor, one row an element.
  [[nodiscard]] Eigen::MatrixXd Read(int accessor) const {
    const nlohmann::json& a = json["accessors"][size_t(accessor)];
    const nlohmann::json& view = json["bufferViews"][a["bufferView"].get<size_t>()];
    const std::string type = a["type"];
    const int n = type == "SCALAR" ? 1 : type == "MAT4" ? 16 : type[3] - '0';
    const int component = a["componentType"];
    const int size = component == 5121 ? 1 : component == 5123 ? 2 : 4;
    const size_t offset = view["byteOffset"];
    EXPECT_EQ(offset % 4, 0U);
    Eigen::MatrixXd values(a["count"].get<int>(), n);
    EXPECT_EQ(view["byteLength"].get<size_t>(), size_t(values.size() * size));
    for (Eigen::Index i = 0; i < values.rows(); ++i) {
      for (int k = 0; k < n; ++k) {
        const char* at = binary_.data() + offset + size_t(i * n + k) * size_t(size);
        if (component == 5126) {
          float f = 0;
          std::memcpy(&f, at, 4);
          values(i, k) = f;
        } else {
          uint32_t u = 0;
          std::memcpy(&u, at, size_t(size));
          values(i, k) = u;
        }
      }
    }
    if (a.contains("min")) {
      for (int k = 0; k < n; ++k) {
        EXPECT_EQ(a["min"][size_t(k)].get<double>(), values.col(k).minCoeff());
        EXPECT_EQ(a["max"][size_t(k)].get<double>(), values.col(k).maxCoeff());
      }
    }
    return values;
  }

  [[nodiscard]] int Node(const std::string& name) const {
    for (size_t i = 0; i < json["nodes"].size(); ++i) {
      if (json["nodes"][i]["name"] == name) return int(i);
    }
    ADD_FAILURE() << "no node " << name;
    return -1;
  }

  /// Seconds of the keys of a node's channel; empty without one.
  [[nodiscard]] Eigen::MatrixXd Keys(int node, const std::string& path, bool values) const {
    for (const nlohmann::json& channel : json["animations"][0]["channels"]) {
      if (channel["target"]["node"] != node || channel["target"]["path"] != path) continue;
      const nlohmann::json& sampler = json["animations"][0]["samplers"][channel["sampler"].get<size_t>()];
      return Read(sampler[values ? "output" : "input"]);
    }
    return {};
  }

  /// The skinned vertices of a node at key k of the animation, in the world.
  [[nodiscard]] Eigen::MatrixXd Pose(int node, int key) const {
    const nlohmann::json& mesh = json["meshes"][json["nodes"][size_t(node)]["mesh"].get<size_t>()]["primitives"][0];
    const nlohmann::json& skin = json["skins"][json["nodes"][size_t(node)]["skin"].get<size_t>()];
    Eigen::MatrixXd rest = Read(mesh["attributes"]["POSITION"]);
    if (mesh.contains("targets")) {
      const size_t n = mesh["targets"].size();
      const Eigen::MatrixXd weights = Keys(node, "weights", true);
      for (size_t k = 0; k < n; ++k)
        rest += weights(key * Eigen::Index(n) + Eigen::Index(k), 0) * Read(mesh["targets"][k]["POSITION"]);
    }
    const Eigen::MatrixXd inverse = Read(skin["inverseBindMatrices"]);
    std::vector<Eigen::Matrix4d> joints;
    for (size_t j = 0; j < skin["joints"].size(); ++j) {
      const Eigen::VectorXd flat = inverse.row(Eigen::Index(j)).transpose();
      joints.push_back(Global(skin["joints"][j], key) * Eigen::Map<const Eigen::Matrix4d>(flat.data()));
    }
    const Eigen::MatrixXd index = Read(mesh["attributes"]["JOINTS_0"]), weight = Read(mesh["attributes"]["WEIGHTS_0"]);
    Eigen::MatrixXd posed = Eigen::MatrixXd::Zero(rest.rows(), 3);
    for (Eigen::Index v = 0; v < rest.rows(); ++v) {
      for (int k = 0; k < 4; ++k) {
        const Eigen::Vector4d p = joints[size_t(index(v, k))] * Eigen::Vector4d(rest(v, 0), rest(v, 1), rest(v, 2), 1);
        posed.row(v) += weight(v, k) * p.head<3>().transpose();
      }
    }
    return posed;
  }

  /// A node's transform to the world at key k.
  [[nodiscard]] Eigen::Matrix4d Global(int node, int key) const {
    const nlohmann::json& n = json["nodes"][size_t(node)];
    Eigen::Affine3d local = Eigen::Affine3d::Identity();
    Eigen::MatrixXd values = json.contains("animations") ? Keys(node, "translation", true) : Eigen::MatrixXd();
    if (values.size() > 0) {
      local.translation() = values.row(key).transpose();
    } else if (n.contains("translation")) {
      for (size_t k = 0; k < 3; ++k) local.translation()[Eigen::Index(k)] = n["translation"][k];
    }
    values = json.contains("animations") ? Keys(node, "rotation", true) : Eigen::MatrixXd();
    Eigen::Vector4d q(0, 0, 0, 1);
    if (values.size() > 0) {
      q = values.row(key).transpose();
    } else if (n.contains("rotation")) {
      for (size_t k = 0; k < 4; ++k) q[Eigen::Index(k)] = n["rotation"][k];
    }
    EXPECT_NEAR(q.norm(), 1, 1e-6);
    local.linear() = Eigen::Quaterniond(q[3], q[0], q[1], q[2]).toRotationMatrix();
    for (size_t i = 0; i < json["nodes"].size(); ++i) {
      if (!json["nodes"][i].contains("children")) continue;
      for (const nlohmann::json& child : json["nodes"][i]["children"]) {
        if (child == node) return Global(int(i), key) * local.matrix();
      }
    }
    return local.matrix();
  }

  nlohmann::json json;

 private:
  static uint32_t Word(const std::string& bytes, size_t at) {
    uint32_t word = 0;
    std::memcpy(&word, bytes.data() + at, 4);
    return word;
  }
  std::string binary_;
};

}  // namespace bodyloom
