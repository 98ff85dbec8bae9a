// SPDX-License-Identifier: Apache-2.0
/// A MakeHuman-like folder made by code: one box of eight vertices for each of the 53 bones of the game-engine rig, a
/// cube at every joint, and a handful of macro targets.
#pragma once

#include <zlib.h>

#include <Eigen/Geometry>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

namespace bodyloom {

class MiniMakeHuman {
 public:
  explicit MiniMakeHuman(std::string folder) : folder_(std::move(folder)) {
    PlaceCubes();
    ListBones();
    MakeMesh();
    files_["base.obj"] = obj_;
    files_["rigs/standard/rig.game_engine.json"] = RigJson();
    files_["rigs/standard/weights.game_engine.json"] = WeightsJson();
    // Men are taller and broader, weight makes everybody thicker.
    AddTarget("universal-male-young-averagemuscle-averageweight", {1.05, 1.06, 1.05});
    AddTarget("universal-male-old-averagemuscle-averageweight", {1.07, 1.05, 1.05});
    AddTarget("universal-female-young-averagemuscle-maxweight", {1.1, 1, 1.3});
    AddTarget("universal-male-young-averagemuscle-maxweight", {1.12, 1, 1.3});
    AddTarget("female-young-averagemuscle-averageweight-minheight", {0.95, 0.93, 0.95});
    AddTarget("male-young-averagemuscle-averageweight-minheight", {0.95, 0.93, 0.95});
  }

  /// Path relative to the folder → contents (targets unpacked). Change before Write().
  std::map<std::string, std::string>& files() { return files_; }
  [[nodiscard]] const std::string& folder() const { return folder_; }
  static constexpr int kNumBones = 53;

  void Write() const {
    std::filesystem::remove_all(folder_);
    for (const auto& [name, text] : files_) {
      const std::filesystem::path path = std::filesystem::path(folder_) / name;
      std::filesystem::create_directories(path.parent_path());
      if (name.ends_with(".gz")) {
        gzFile file = gzopen(path.c_str(), "wb9");
        gzwrite(file, text.data(), static_cast<unsigned>(text.size()));
        gzclose(file);
      } else {
        std::ofstream(path, std::ios::binary) << text;
      }
    }
  }

 private:
  using Vector = Eigen::Vector3d;
  struct Bone {
    std::string name, parent, head, tail;
  };

  void Place(const std::string& name, const Vector& at) { cubes_["joint-" + name] = at; }
  void PlaceBoth(const std::string& name, const Vector& at) {
    Place("l-" + name, at);
    Place("r-" + name, {-at.x(), at.y(), at.z()});
  }

  void PlaceCubes() {
    Place("ground", {0, -9.3, 0});
    Place("pelvis", {0, -0.4, 0});
    Place("spine-4", {0, 0.6, 0});
    Place("spine-3", {0, 1.6, 0});
    Place("spine-2", {0, 2.9, 0});
    Place("spine-1", {0, 4.2, 0});
    Place("neck", {0, 5.4, 0.1});
    Place("head", {0, 6.2, 0.3});
    Place("head-2", {0, 8, 0.3});
    PlaceBoth("eye", {0.3, 7, 1.2});
    PlaceBoth("clavicle", {0.3, 5, 0.2});
    PlaceBoth("shoulder", {1.7, 4.9, 0});
    const Vector elbow(3.4, 3.1, -0.1), hand(5, 1.5, 0.2), along = Vector(1, -1, 0.1).normalized();
    PlaceBoth("elbow", elbow);
    PlaceBoth("hand", hand);
    PlaceBoth("hand-3", hand + along);
    for (int finger = 1; finger <= 5; ++finger) {
      const Vector base = hand + (finger == 1 ? 0.3 : 0.9) * along + Vector(0, 0, 0.25 * (3.5 - finger));
      for (int i = 1; i <= 4; ++i) {
        PlaceBoth("finger-" + std::to_string(finger) + "-" + std::to_string(i), base + 0.3 * (i - 1) * along);
      }
    }
    PlaceBoth("upper-leg", {1.1, -0.6, 0});
    PlaceBoth("knee", {1.3, -4.6, 0.2});
    PlaceBoth("ankle", {1.4, -8.4, -0.1});
    PlaceBoth("foot-1", {1.6, -9, 1});
    PlaceBoth("toe-2-4", {1.7, -9, 1.7});
  }

  void ListBones() {
    bones_ = {{"Root", "", "ground", "pelvis"},
              {"pelvis", "Root", "pelvis", "spine-4"},
              {"spine_01", "pelvis", "spine-4", "spine-3"},
              {"spine_02", "spine_01", "spine-3", "spine-2"},
              {"spine_03", "spine_02", "spine-2", "spine-1"},
              {"neck_01", "spine_03", "neck", "head"},
              {"head", "neck_01", "head", "head-2"}};
    for (const std::string side : {"l", "r"}) {
      const std::string s = "_" + side, c = side + "-";
      const auto add = [&](const std::string& name, const std::string& parent, const std::string& head,
                           const std::string& tail) {
        bones_.push_back(
            {name + s, parent.starts_with("spine") || parent == "pelvis" ? parent : parent + s, c + head, c + tail});
      };
      add("clavicle", "spine_03", "clavicle", "shoulder");
      add("upperarm", "clavicle", "shoulder", "elbow");
      add("lowerarm", "upperarm", "elbow", "hand");
      add("hand", "lowerarm", "hand", "hand-3");
      const char* fingers[] = {"thumb", "index", "middle", "ring", "pinky"};
      for (int finger = 1; finger <= 5; ++finger) {
        for (int i = 1; i <= 3; ++i) {
          const std::string name = fingers[finger - 1], cube = "finger-" + std::to_string(finger) + "-";
          add(name + "_0" + std::to_string(i), i == 1 ? "hand" : name + "_0" + std::to_string(i - 1),
              cube + std::to_string(i), cube + std::to_string(i + 1));
        }
      }
      add("thigh", "pelvis", "upper-leg", "knee");
      add("calf", "thigh", "knee", "ankle");
      add("foot", "calf", "ankle", "foot-1");
      add("ball", "foot", "foot-1", "toe-2-4");
    }
  }

  /// Appends the eight corners and six outward quads of a box to the mesh.
  void AddBox(const Vector& from, const Vector& to, double radius, bool with_uv, std::ostringstream* faces) {
    const Vector axis = (to - from).normalized();
    const Vector side = axis.unitOrthogonal(), third = axis.cross(side);
    const size_t first = vertices_.size() + 1;
    for (const Vector& end : {from, to}) {
      for (const auto& [a, b] : {std::pair{1, 1}, {-1, 1}, {-1, -1}, {1, -1}}) {
        vertices_.push_back(end + radius * (a * side + b * third));
      }
    }
    const int quads[6][4] = {{3, 2, 1, 0}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}};
    for (const auto& quad : quads) {
      *faces << "f";
      for (int k = 0; k < 4; ++k) {
        *faces << ' ' << first + quad[k];
        if (with_uv) *faces << '/' << k + 1;
      }
      *faces << '\n';
    }
  }

  void MakeMesh() {
    std::ostringstream faces;
    faces << "g body\n";
    for (const Bone& bone : bones_) {
      if (bone.name == "Root") continue;
      const double radius = bone.name.find("_0") == std::string::npos ? 0.4
                            : bone.name.starts_with("spine")          ? 0.9
                                                                      : 0.08;
      AddBox(cubes_.at("joint-" + bone.head), cubes_.at("joint-" + bone.tail), radius, true, &faces);
    }
    for (const auto& [name, at] : cubes_) {
      faces << "g " << name << "\n";
      AddBox(at - Vector(0, 0.05, 0), at + Vector(0, 0.05, 0), 0.05, true, &faces);
    }
    std::ostringstream out;
    out << "# a body of boxes\n";
    for (const Vector& v : vertices_) out << "v " << v.x() << ' ' << v.y() << ' ' << v.z() << '\n';
    out << "vt 0.1 0.1\nvt 0.9 0.1\nvt 0.9 0.9\nvt 0.1 0.9\nvt 0 0\n" << faces.str();
    obj_ = out.str();
  }

  [[nodiscard]] std::string RigJson() const {
    std::ostringstream out;
    const auto end = [](const std::string& cube) {
      return R"({"strategy": "CUBE", "cube_name": "joint-)" + cube + "\"}";
    };
    for (const Bone& bone : bones_) {
      out << (out.tellp() == 0 ? "{" : ",\n") << '"' << bone.name << R"(": {"parent": ")" << bone.parent
          << R"(", "head": )" << end(bone.head) << R"(, "tail": )" << end(bone.tail) << "}";
    }
    return out.str() + "}\n";
  }

  [[nodiscard]] std::string WeightsJson() const {
    std::ostringstream out;
    out << R"({"weights": {"Root": [])";
    int vertex = 0;
    for (const Bone& bone : bones_) {
      if (bone.name == "Root") continue;
      out << ",\n\"" << bone.name << "\": [";
      for (int k = 0; k < 8; ++k) out << (k > 0 ? ", " : "") << "[" << vertex++ << ", 1.0]";
      out << "]";
    }
    return out.str() + "}}\n";
  }

  /// A target that scales the rest pose about the origin.
  void AddTarget(const std::string& name, const Vector& scale) {
    std::ostringstream out;
    for (size_t i = 0; i < vertices_.size(); ++i) {
      const Vector offset = (scale - Vector::Ones()).cwiseProduct(vertices_[i]);
      out << i << ' ' << offset.x() << ' ' << offset.y() << ' ' << offset.z() << '\n';
    }
    files_["targets/macrodetails/" + name + ".target.gz"] = out.str();
  }

  std::string folder_, obj_;
  std::map<std::string, Vector> cubes_;
  std::vector<Bone> bones_;
  std::vector<Vector> vertices_;
  std::map<std::string, std::string> files_;
};

}  // namespace bodyloom
