// SPDX-License-Identifier: Apache-2.0
#include "data_tools/export/glb_writer.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "data_tools/export/glb_buffer.h"
#include "data_tools/formats/atomic_file.h"
#include "geometry/base/check.h"
#include "geometry/scene/camera_path.h"

namespace bodyloom {
namespace {

using Eigen::Matrix3d;
using Eigen::Quaternionf;
using Eigen::Vector3d;
using GltfJson = nlohmann::ordered_json;

constexpr double kGroundHalf_m = 3;

/// Unit in float, and continued from the one before.
Quaternionf QuaternionAfter(const Matrix3d& rotation, const Quaternionf* before) {
  Quaternionf q = Eigen::Quaterniond(rotation).normalized().cast<float>();
  q.normalize();
  if (before != nullptr ? q.dot(*before) < 0 : q.w() < 0) q.coeffs() *= -1;
  return q;
}

GltfJson Numbers(const Vector3d& v) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}
GltfJson Numbers(const Quaternionf& q) { return {q.x(), q.y(), q.z(), q.w()}; }

class SceneWriter {
 public:
  SceneWriter(const ExportScene& scene, const GlbOptions& options) : scene_(scene), options_(options) {
    for (size_t i = 0; i < scene.people.size(); ++i) AddPerson(i);
    AddCamera();
    if (options.ground) AddGround();
  }
  [[nodiscard]] GltfJson Json() {
    GltfJson json = {{"asset",
                      {{"version", "2.0"},
                       {"generator", "Bodyloom"},
                       {"extras",
                        {{"world", ToString(scene_.world.source)},
                         {"vertical_sigma_deg", scene_.world.vertical_sigma_deg},
                         {"height_sigma_m", scene_.world.height_sigma_m},
                         {"clip_start_s", scene_.start_s},
                         {"fps", scene_.fps}}}}},
                     {"scene", 0},
                     {"scenes", GltfJson::array({GltfJson{{"name", "scene"}, {"nodes", roots_}}})},
                     {"nodes", nodes_},
                     {"meshes", meshes_},
                     {"skins", skins_},
                     {"materials", materials_}};
    if (!cameras_.empty()) json["cameras"] = cameras_;
    if (!images_.empty()) {
      json["images"] = images_;
      json["samplers"] =
          GltfJson::array({GltfJson{{"magFilter", 9729}, {"minFilter", 9987}, {"wrapS", 33071}, {"wrapT", 33071}}});
      json["textures"] = textures_;
    }
    if (!channels_.empty()) {
      json["animations"] =
          GltfJson::array({GltfJson{{"name", "motion"}, {"channels", channels_}, {"samplers", samplers_}}});
    }
    json["accessors"] = buffer_.Accessors();
    json["bufferViews"] = buffer_.Views();
    json["buffers"].push_back({{"byteLength", buffer_.bytes().size()}});
    return json;
  }
  [[nodiscard]] const std::string& binary() const { return buffer_.bytes(); }
  [[nodiscard]] const SkinSummary& summary() const { return summary_; }

 private:
  int AddNode(GltfJson node, bool root = false) {
    nodes_.push_back(std::move(node));
    const int index = static_cast<int>(nodes_.size()) - 1;
    if (root) roots_.push_back(index);
    return index;
  }

  void AddChannel(int times, int values, int node, const char* path, const char* interpolation = "LINEAR") {
    samplers_.push_back({{"input", times}, {"output", values}, {"interpolation", interpolation}});
    channels_.push_back({{"sampler", samplers_.size() - 1}, {"target", {{"node", node}, {"path", path}}}});
  }

  void AddPerson(size_t number) {
    const ExportPerson& person = scene_.people[number];
    const SkinnedMesh mesh = MakeSkinnedMesh(person, options_.correctives);
    const int first = AddSkeleton(person);
    AddSkin(person, first);
    AddMesh(person, mesh, AddMaterial(number));
    GltfJson body = {{"name", person.name + "_body"}, {"mesh", meshes_.size() - 1}, {"skin", skins_.size() - 1}};
    if (!mesh.shapes.empty()) body["weights"] = FirstWeights(mesh);
    const int body_node = AddNode(std::move(body), true);
    AddMotion(person, mesh, first, body_node);
    summary_.AddPerson(mesh.rms_error_m, mesh.max_error_m, mesh.shapes.size());
    summary_.influences = kSkinInfluences;
    summary_.reduced_vertices += mesh.reduced_vertices;
  }

  static GltfJson FirstWeights(const SkinnedMesh& mesh) {
    GltfJson weights = GltfJson::array();
    for (Eigen::Index k = 0; k < mesh.shape_weights.cols(); ++k) weights.push_back(float(mesh.shape_weights(0, k)));
    return weights;
  }

  /// The first joint's node; joint j is the j-th after it. They hang on a node of their own.
  int AddSkeleton(const ExportPerson& person) {
    const BodyModel& body = *person.body;
    const int group = AddNode({{"name", person.name}}, true);
    const int first = group + 1;
    nodes_[size_t(group)]["children"].push_back(first);
    for (int j = 0; j < body.num_joints(); ++j) {
      const int parent = body.parents()[j];
      const Vector3d offset = parent < 0
                                  ? Vector3d(person.rest_joints.row(0).transpose() + person.poses[0].trans)
                                  : Vector3d((person.rest_joints.row(j) - person.rest_joints.row(parent)).transpose());
      GltfJson node = {{"name", body.data().joint_names[j]},
                       {"rotation", Numbers(QuaternionAfter(person.poses[0].rotations[j], nullptr))},
                       {"translation", Numbers(offset)}};
      AddNode(std::move(node));
      if (parent >= 0) nodes_[size_t(first) + size_t(parent)]["children"].push_back(first + j);
    }
    return first;
  }

  void AddSkin(const ExportPerson& person, int first) {
    std::vector<float> inverse;
    GltfJson joints = GltfJson::array();
    for (int j = 0; j < person.body->num_joints(); ++j) {
      Eigen::Matrix4f matrix = Eigen::Matrix4f::Identity();
      matrix.topRightCorner<3, 1>() = -person.rest_joints.row(j).transpose().cast<float>();
      inverse.insert(inverse.end(), matrix.data(), matrix.data() + 16);
      joints.push_back(first + j);
    }
    skins_.push_back({{"name", person.name},
                      {"inverseBindMatrices", buffer_.AddFloats(inverse, "MAT4")},
                      {"skeleton", first},
                      {"joints", joints}});
  }

  int AddMaterial(size_t number) {
    GltfJson surface = {{"metallicFactor", 0}, {"roughnessFactor", 0.8}};
    if (number < options_.textures.size() && !options_.textures[number].empty()) {
      const std::string& png = options_.textures[number];
      BODYLOOM_CHECK(png.starts_with("\x89PNG"), "glTF: a texture that is no PNG file");
      images_.push_back({{"bufferView", buffer_.AddView(png)}, {"mimeType", "image/png"}});
      textures_.push_back({{"sampler", 0}, {"source", images_.size() - 1}});
      surface["baseColorTexture"] = {{"index", textures_.size() - 1}};
    } else {
      const Vector3d c = PersonColour(number);
      surface["baseColorFactor"] = {c[0], c[1], c[2], 1};
    }
    materials_.push_back({{"name", scene_.people[number].name}, {"pbrMetallicRoughness", surface}});
    return static_cast<int>(materials_.size()) - 1;
  }

  void AddMesh(const ExportPerson& person, const SkinnedMesh& mesh, int material) {
    const MatrixX3f positions = mesh.positions.cast<float>();
    const auto floats = [](const auto& m) { return std::span<const float>(m.data(), size_t(m.size())); };
    GltfJson attributes = {{"POSITION", buffer_.AddFloats(floats(positions), "VEC3", GlbBuffer::kVertices, true)},
                           {"NORMAL", buffer_.AddFloats(floats(mesh.normals), "VEC3", GlbBuffer::kVertices)}};
    if (mesh.uv.rows() > 0) {
      MatrixX2f uv = mesh.uv;
      uv.col(1) = 1 - uv.col(1).array();
      attributes["TEXCOORD_0"] = buffer_.AddFloats(floats(uv), "VEC2", GlbBuffer::kVertices);
    }
    AddInfluences(person, mesh, &attributes);
    std::vector<uint32_t> indices(mesh.faces.data(), mesh.faces.data() + mesh.faces.size());
    GltfJson primitive = {{"attributes", attributes},
                          {"indices", buffer_.AddIndices(indices, static_cast<int>(mesh.positions.rows()))},
                          {"material", material}};
    GltfJson json = {{"name", person.name + "_body"}};
    GltfJson names = GltfJson::array();
    for (size_t k = 0; k < mesh.shapes.size(); ++k) {
      primitive["targets"].push_back(
          {{"POSITION", buffer_.AddFloats(floats(mesh.shapes[k]), "VEC3", GlbBuffer::kVertices, true)}});
      names.push_back("corrective_" + std::to_string(k));
    }
    json["primitives"].push_back(std::move(primitive));
    if (!mesh.shapes.empty()) json["extras"] = {{"targetNames", names}};
    meshes_.push_back(std::move(json));
  }

  void AddInfluences(const ExportPerson& person, const SkinnedMesh& mesh, GltfJson* attributes) {
    std::vector<uint16_t> joints;
    std::vector<float> weights;
    for (size_t i = 0; i < mesh.joints.size(); ++i) {
      for (int k = 0; k < kSkinInfluences; ++k) {
        joints.push_back(mesh.weights[i][k] > 0 ? static_cast<uint16_t>(mesh.joints[i][k]) : 0);
        weights.push_back(mesh.weights[i][k]);
      }
    }
    if (person.body->num_joints() <= 255) {
      const std::vector<uint8_t> bytes(joints.begin(), joints.end());
      (*attributes)["JOINTS_0"] = buffer_.AddBytes4(bytes);
    } else {
      (*attributes)["JOINTS_0"] = buffer_.AddShorts4(joints);
    }
    (*attributes)["WEIGHTS_0"] = buffer_.AddFloats(weights, "VEC4", GlbBuffer::kVertices);
  }

  void AddMotion(const ExportPerson& person, const SkinnedMesh& mesh, int first, int body_node) {
    const size_t T = person.poses.size();
    const std::vector<float> times(person.seconds.begin(), person.seconds.end());
    const int input = buffer_.AddFloats(times, "SCALAR", GlbBuffer::kNone, true);
    std::vector<float> values;
    const Vector3d pelvis = person.rest_joints.row(0).transpose();
    for (const BodyPose& pose : person.poses) {
      const Eigen::Vector3f place = (pelvis + pose.trans).cast<float>();
      values.insert(values.end(), place.data(), place.data() + 3);
    }
    AddChannel(input, buffer_.AddFloats(values, "VEC3"), first, "translation");
    for (int j = 0; j < person.body->num_joints(); ++j) {
      bool moves = false;
      Quaternionf before = QuaternionAfter(person.poses[0].rotations[j], nullptr);
      values.clear();
      for (size_t t = 0; t < T; ++t) {
        const Quaternionf q = QuaternionAfter(person.poses[t].rotations[j], &before);
        moves = moves || !q.coeffs().isApprox(before.coeffs(), 0);
        before = q;
        values.insert(values.end(), q.coeffs().data(), q.coeffs().data() + 4);
      }
      if (moves) AddChannel(input, buffer_.AddFloats(values, "VEC4"), first + j, "rotation");
    }
    if (!mesh.shapes.empty()) {
      const Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> weights =
          mesh.shape_weights.cast<float>();
      AddChannel(input, buffer_.AddFloats({weights.data(), size_t(weights.size())}, "SCALAR"), body_node, "weights");
    }
    AddPresence(person, first);
  }

  /// Scale 0 for people who are absent.
  void AddPresence(const ExportPerson& person, int first) {
    const std::vector<PresenceKey> keys = scene_.PresenceOf(person);
    if (keys.empty()) return;
    std::vector<float> times, scales;
    for (const PresenceKey& key : keys) {
      times.push_back(static_cast<float>(key.seconds));
      scales.insert(scales.end(), 3, key.present ? 1.0F : 0.0F);
    }
    const int input = buffer_.AddFloats(times, "SCALAR", GlbBuffer::kNone, true);
    AddChannel(input, buffer_.AddFloats(scales, "VEC3"), first, "scale", "STEP");
  }

  void AddCamera() {
    const Camera& camera = scene_.camera;
    if (camera.model != CameraModel::kPinhole || camera.width <= 0 || camera.height <= 0) return;
    cameras_.push_back({{"type", "perspective"},
                        {"name", "camera"},
                        {"perspective",
                         {{"yfov", 2 * std::atan(camera.height / (2 * camera.fy))},
                          {"aspectRatio", (camera.width / camera.fx) / (camera.height / camera.fy)},
                          {"znear", 0.01}}},
                        {"extras",
                         {{"image_size", {camera.width, camera.height}},
                          {"K", {{camera.fx, 0, camera.cx}, {0, camera.fy, camera.cy}, {0, 0, 1}}},
                          {"distortion", camera.distortion}}}});
    const Matrix3d rotation = scene_.world.rotation * Vector3d(1, -1, -1).asDiagonal();
    const int node = AddNode({{"name", "camera"},
                              {"camera", cameras_.size() - 1},
                              {"rotation", Numbers(QuaternionAfter(rotation, nullptr))},
                              {"translation", Numbers(scene_.world.translation)}},
                             true);
    if (!scene_.camera_keys.empty()) AddCameraMotion(node);
  }

  void AddCameraMotion(int node) {
    std::vector<float> times, places, rotations;
    Quaternionf before = Quaternionf::Identity();
    for (const ExportCameraKey& key : scene_.camera_keys) {
      const CameraPose world_from_camera = Inverse(key.camera_from_world);
      const Matrix3d rotation = world_from_camera.camera_from_world_rotation * Vector3d(1, -1, -1).asDiagonal();
      before = QuaternionAfter(rotation, times.empty() ? nullptr : &before);
      times.push_back(static_cast<float>(key.seconds));
      rotations.insert(rotations.end(), before.coeffs().data(), before.coeffs().data() + 4);
      const Eigen::Vector3f place = world_from_camera.camera_from_world_translation.cast<float>();
      places.insert(places.end(), place.data(), place.data() + 3);
    }
    const int input = buffer_.AddFloats(times, "SCALAR", GlbBuffer::kNone, true);
    AddChannel(input, buffer_.AddFloats(places, "VEC3"), node, "translation");
    AddChannel(input, buffer_.AddFloats(rotations, "VEC4"), node, "rotation");
  }

  void AddGround() {
    Vector3d centre = Vector3d::Zero();
    const ExportPerson& person = scene_.people[0];
    for (const BodyPose& pose : person.poses) centre += pose.trans / double(person.poses.size());
    const auto h = static_cast<float>(kGroundHalf_m);
    const std::vector<float> positions = {-h, 0, -h, -h, 0, h, h, 0, h, h, 0, -h};
    const std::vector<float> normals = {0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0};
    const std::vector<uint32_t> indices = {0, 1, 2, 0, 2, 3};
    materials_.push_back({{"name", "ground"},
                          {"pbrMetallicRoughness",
                           {{"baseColorFactor", {0.35, 0.36, 0.38, 1}}, {"metallicFactor", 0}, {"roughnessFactor", 1}}},
                          {"doubleSided", true}});
    GltfJson primitive = {{"attributes",
                           {{"POSITION", buffer_.AddFloats(positions, "VEC3", GlbBuffer::kVertices, true)},
                            {"NORMAL", buffer_.AddFloats(normals, "VEC3", GlbBuffer::kVertices)}}},
                          {"indices", buffer_.AddIndices(indices, 4)},
                          {"material", materials_.size() - 1}};
    GltfJson mesh = {{"name", "ground"}};
    mesh["primitives"].push_back(std::move(primitive));
    meshes_.push_back(std::move(mesh));
    AddNode({{"name", "ground"},
             {"mesh", meshes_.size() - 1},
             {"translation", Numbers(Vector3d(centre.x(), 0, centre.z()))}},
            true);
  }

  const ExportScene& scene_;
  const GlbOptions& options_;
  GlbBuffer buffer_;
  SkinSummary summary_;
  GltfJson roots_ = GltfJson::array(), nodes_ = GltfJson::array(), meshes_ = GltfJson::array();
  GltfJson skins_ = GltfJson::array(), materials_ = GltfJson::array(), cameras_ = GltfJson::array();
  GltfJson images_ = GltfJson::array(), textures_ = GltfJson::array();
  GltfJson channels_ = GltfJson::array(), samplers_ = GltfJson::array();
};

}  // namespace

std::string GlbText(const ExportScene& scene, const GlbOptions& options, SkinSummary* summary) {
  BODYLOOM_CHECK(!scene.people.empty(), "glTF: nobody to write");
  SceneWriter writer(scene, options);
  std::string bytes = GlbBytes(writer.Json(), writer.binary());
  *summary = writer.summary();
  summary->bytes = bytes.size();
  return bytes;
}

SkinSummary WriteGlb(const std::string& path, const ExportScene& scene, const GlbOptions& options) {
  SkinSummary summary;
  WriteFileAtomically(path, GlbText(scene, options, &summary));
  return summary;
}

}  // namespace bodyloom
