// SPDX-License-Identifier: Apache-2.0
#include "data_tools/export/fbx_writer.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <utility>

#include "data_tools/export/fbx_animation.h"
#include "data_tools/export/fbx_document.h"
#include "data_tools/export/rigged_mesh.h"
#include "data_tools/formats/atomic_file.h"
#include "geometry/base/check.h"
#include "geometry/body/body_model.h"
#include "geometry/scene/camera_path.h"

namespace bodyloom {
namespace {

// The skinned mesh of a person in an FBX document: geometry, clusters of the joints, shapes, material.

struct FbxSkin {
  int64_t model = 0;                    ///< of the mesh; to be attached to its parent
  std::vector<int64_t> shape_channels;  ///< whose "DeformPercent" is animated
};

/// Shorter displacements of a shape are left out.
constexpr float kShortestDisplacement_m = 1e-7F;

std::vector<double> CentimetresOf(const MatrixX3d& points_m) {
  std::vector<double> values(points_m.data(), points_m.data() + points_m.size());
  for (double& value : values) value *= kFbxPerMetre;
  return values;
}

FbxNode FbxLayerElement(const std::string& kind, const std::string& name, const std::string& mapping,
                        const std::string& reference) {
  FbxNode layer(kind);
  layer.Int(0).Add(FbxNode("Version").Int(kind == "LayerElementSmoothing" ? 102 : 101)).Add(FbxNode("Name").Text(name));
  layer.Add(FbxNode("MappingInformationType").Text(mapping));
  layer.Add(FbxNode("ReferenceInformationType").Text(reference));
  return layer;
}

/// Corners of the faces; the last of each face is stored as −index − 1.
std::vector<int32_t> PolygonIndices(const MatrixX3i& faces) {
  std::vector<int32_t> indices(faces.data(), faces.data() + faces.size());
  for (size_t i = 2; i < indices.size(); i += 3) indices[i] = -indices[i] - 1;
  return indices;
}

std::vector<FbxNode> GeometryNodes(const BodyModelData& body, const RiggedMesh& mesh) {
  FbxNode normals = FbxLayerElement("LayerElementNormal", "", "ByVertice", "Direct");
  const std::vector<double> normal_values(mesh.normals.data(), mesh.normals.data() + mesh.normals.size());
  normals.Add(FbxNode("Normals").Doubles(normal_values));
  FbxNode smoothing = FbxLayerElement("LayerElementSmoothing", "", "ByPolygon", "Direct");
  smoothing.Add(FbxNode("Smoothing").Ints(std::vector<int32_t>(size_t(body.faces.rows()), 1)));
  FbxNode material = FbxLayerElement("LayerElementMaterial", "", "AllSame", "IndexToDirect");
  material.Add(FbxNode("Materials").Ints(std::array<int32_t, 1>{0}));
  std::vector<FbxNode> nodes = {FbxProperties({}),
                                FbxNode("GeometryVersion").Int(124),
                                FbxNode("Vertices").Doubles(CentimetresOf(mesh.positions)),
                                FbxNode("PolygonVertexIndex").Ints(PolygonIndices(body.faces)),
                                std::move(normals),
                                std::move(smoothing),
                                std::move(material)};
  std::vector<std::string> kinds = {"LayerElementNormal", "LayerElementSmoothing", "LayerElementMaterial"};
  if (body.ft.rows() == body.faces.rows() && body.ft.rows() > 0) {
    FbxNode uv = FbxLayerElement("LayerElementUV", "UVMap", "ByPolygonVertex", "IndexToDirect");
    uv.Add(FbxNode("UV").Doubles(std::vector<double>(body.vt.data(), body.vt.data() + body.vt.size())));
    uv.Add(FbxNode("UVIndex").Ints({body.ft.data(), size_t(body.ft.size())}));
    nodes.push_back(std::move(uv));
    kinds.emplace_back("LayerElementUV");
  }
  FbxNode layer("Layer");
  layer.Int(0).Add(FbxNode("Version").Int(100));
  for (const std::string& kind : kinds) {
    FbxNode element("LayerElement");
    element.Add(FbxNode("Type").Text(kind)).Add(FbxNode("TypedIndex").Int(0));
    layer.Add(std::move(element));
  }
  nodes.push_back(std::move(layer));
  return nodes;
}

/// 16 numbers, by columns, of a translation to centimetres: a transform of the rest pose, whose axes are the world's.
std::vector<double> FbxTranslation(const Eigen::Vector3d& place_m) {
  const Eigen::Vector3d p = kFbxPerMetre * place_m;
  return {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, p.x(), p.y(), p.z(), 1};
}

/// One cluster for each joint that moves a vertex.
void AddClusters(const BodyModel& body, const RiggedMesh& mesh, std::span<const int64_t> joint_models, int64_t skin,
                 FbxDocument* document) {
  std::vector<std::vector<int32_t>> vertices(size_t(body.num_joints()));
  std::vector<std::vector<double>> weights(size_t(body.num_joints()));
  for (int v = 0; v < body.num_vertices(); ++v) {
    for (int i = body.influence_begin()[v]; i < body.influence_begin()[v + 1]; ++i) {
      if (!(body.influence_weight()[i] > 0)) continue;
      vertices[size_t(body.influence_joint()[i])].push_back(v);
      weights[size_t(body.influence_joint()[i])].push_back(body.influence_weight()[i]);
    }
  }
  for (size_t j = 0; j < vertices.size(); ++j) {
    if (vertices[j].empty()) continue;
    const Eigen::Vector3d place = mesh.joints.row(Eigen::Index(j)).transpose();
    // Transform: the mesh, which rests at the origin, as its joint sees it.
    const int64_t cluster = document->Add(
        "Deformer", body.data().joint_names[j], "SubDeformer", "Cluster",
        {FbxNode("Version").Int(100), FbxNode("UserData").Text("").Text(""), FbxNode("Indexes").Ints(vertices[j]),
         FbxNode("Weights").Doubles(weights[j]), FbxNode("Transform").Doubles(FbxTranslation(-place)),
         FbxNode("TransformLink").Doubles(FbxTranslation(place))});
    document->Connect(cluster, skin);
    document->Connect(joint_models[j], cluster);
  }
}

int64_t AddShape(const std::string& name, const MatrixX3f& displacements_m, FbxDocument* document) {
  std::vector<int32_t> indices;
  std::vector<double> values;
  for (Eigen::Index v = 0; v < displacements_m.rows(); ++v) {
    if (!(displacements_m.row(v).norm() > kShortestDisplacement_m)) continue;
    indices.push_back(static_cast<int32_t>(v));
    for (int k = 0; k < 3; ++k) values.push_back(kFbxPerMetre * double(displacements_m(v, k)));
  }
  // Normals of shapes are differences to the mesh's; none are computed.
  const std::vector<double> normals(values.size());
  const int64_t shape = document->Add("Geometry", name, "Geometry", "Shape",
                                      {FbxProperties({}), FbxNode("Version").Int(100), FbxNode("Indexes").Ints(indices),
                                       FbxNode("Vertices").Doubles(values), FbxNode("Normals").Doubles(normals)});
  const int64_t channel = document->Add(
      "Deformer", name, "SubDeformer", "BlendShapeChannel",
      {FbxProperties({FbxProperty("DeformPercent", "Number", "", "A").Double(0)}), FbxNode("Version").Int(100),
       FbxNode("DeformPercent").Double(0), FbxNode("FullWeights").Doubles(std::array<double, 1>{100})});
  document->Connect(shape, channel);
  return channel;
}

int64_t AddMaterial(const std::string& person, const std::string& png, const Eigen::Vector3d& colour,
                    FbxDocument* document) {
  const int64_t material = document->Add(
      "Material", person, "Material", "",
      {FbxNode("Version").Int(102), FbxNode("ShadingModel").Text("phong"), FbxNode("MultiLayer").Int(0),
       FbxProperties({FbxVector("DiffuseColor", "Color", {colour.x(), colour.y(), colour.z()}),
                      FbxDouble("DiffuseFactor", 1, "Number"), FbxVector("SpecularColor", "Color", {0.2, 0.2, 0.2}),
                      FbxDouble("SpecularFactor", 0, "Number"), FbxDouble("ShininessExponent", 10, "Number")})});
  if (png.empty()) return material;
  BODYLOOM_CHECK(png.starts_with("\x89PNG"), "FBX: a texture that is no PNG file");
  const std::string file = person + ".png";
  const int64_t video = document->Add(
      "Video", person, "Video", "Clip",
      {FbxNode("Type").Text("Clip"), FbxProperties({FbxProperty("Path", "KString", "XRefUrl", "").Text(file)}),
       FbxNode("UseMipMap").Int(0), FbxNode("Filename").Text(file), FbxNode("RelativeFilename").Text(file),
       FbxNode("Content").Bytes(png)});
  const int64_t texture = document->Add("Texture", person, "Texture", "",
                                        {FbxNode("Type").Text("TextureVideoClip"), FbxNode("Version").Int(202),
                                         FbxNode("TextureName").Text(person + std::string("\0\1Texture", 9)),
                                         FbxProperties({FbxProperty("UVSet", "KString", "", "").Text("UVMap"),
                                                        FbxProperty("UseMaterial", "bool", "", "").Int(1)}),
                                         FbxNode("Media").Text(person + std::string("\0\1Video", 7)),
                                         FbxNode("FileName").Text(file), FbxNode("RelativeFilename").Text(file)});
  document->Connect(video, texture);
  document->Connect(texture, material, "DiffuseColor");
  return material;
}

/// Adds the mesh, skinned to the models of the joints (J), with the positions of the mesh's rest pose. `png`: an image
/// file's bytes, or empty: `colour`. Throws std::invalid_argument for a texture that is no PNG.
FbxSkin AddFbxSkin(const std::string& person, const BodyModel& body, const RiggedMesh& mesh,
                   std::span<const int64_t> joint_models, const std::string& png, const Eigen::Vector3d& colour,
                   FbxDocument* document) {
  const std::string name = person + "_body";
  FbxSkin result;
  const int64_t geometry = document->Add("Geometry", name, "Geometry", "Mesh", GeometryNodes(body.data(), mesh));
  result.model = document->Add("Model", name, "Model", "Mesh",
                               {FbxNode("Version").Int(232), FbxProperties({FbxInt("DefaultAttributeIndex", 0)}),
                                FbxNode("Shading").Bool(true), FbxNode("Culling").Text("CullingOff")});
  document->Connect(geometry, result.model);
  document->Connect(AddMaterial(person, png, colour, document), result.model);
  const int64_t skin = document->Add("Deformer", person, "Deformer", "Skin",
                                     {FbxNode("Version").Int(101), FbxNode("Link_DeformAcuracy").Double(50)});
  document->Connect(skin, geometry);
  AddClusters(body, mesh, joint_models, skin, document);
  if (mesh.shapes.empty()) return result;
  const int64_t shapes = document->Add("Deformer", person, "Deformer", "BlendShape", {FbxNode("Version").Int(100)});
  document->Connect(shapes, geometry);
  for (size_t k = 0; k < mesh.shapes.size(); ++k) {
    const int64_t channel = AddShape("corrective_" + std::to_string(k), mesh.shapes[k], document);
    document->Connect(channel, shapes);
    result.shape_channels.push_back(channel);
  }
  return result;
}

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr char kFbxAnimationName[] = "motion";
constexpr double kFilmWidth_mm = 36, kMillimetresPerInch = 25.4;
/// Between a key of presence and the one before it: who goes is gone within this share of a frame.
constexpr double kPresenceRamp = 0.25;

/// Columns: FBX's cameras look along their x, with y up.
Matrix3d FbxCameraRotation(const Matrix3d& world_from_camera) {
  Matrix3d rotation;
  rotation << world_from_camera.col(2), -world_from_camera.col(1), world_from_camera.col(0);
  return rotation;
}

class FbxSceneWriter {
 public:
  FbxSceneWriter(const ExportScene& scene, const FbxOptions& options)
      : scene_(scene), options_(options), animation_(&document_, kFbxAnimationName, scene.duration_s) {
    for (size_t i = 0; i < scene.people.size(); ++i) AddPerson(i);
    AddCamera();
  }
  [[nodiscard]] std::string Bytes() const { return document_.Bytes(scene_.fps, scene_.duration_s, kFbxAnimationName); }
  [[nodiscard]] const SkinSummary& summary() const { return summary_; }

 private:
  /// A model with an attribute that says what it is.
  int64_t AddModel(const std::string& name, const std::string& subclass, const Vector3d& translation_m,
                   const Vector3d& rotation_deg, std::vector<FbxNode> attribute, int64_t parent) {
    const Vector3d t = kFbxPerMetre * translation_m, &r = rotation_deg;
    const int64_t model =
        document_.Add("Model", name, "Model", subclass,
                      {FbxNode("Version").Int(232),
                       FbxProperties({FbxInt("InheritType", 1, "enum"), FbxInt("DefaultAttributeIndex", 0),
                                      FbxVector("Lcl Translation", "Lcl Translation", {t.x(), t.y(), t.z()}),
                                      FbxVector("Lcl Rotation", "Lcl Rotation", {r.x(), r.y(), r.z()}),
                                      FbxVector("Lcl Scaling", "Lcl Scaling", {1, 1, 1})}),
                       FbxNode("Shading").Bool(true), FbxNode("Culling").Text("CullingOff")});
    document_.Connect(document_.Add("NodeAttribute", name, "NodeAttribute", subclass, attribute), model);
    document_.Connect(model, parent);
    return model;
  }

  void AddPerson(size_t number) {
    const ExportPerson& person = scene_.people[number];
    const RigSkeleton rig = RigSkeletonOf(options_.rig, *person.body);
    const RiggedMesh mesh = MakeRiggedMesh(person, rig, options_.correctives);
    const int64_t group =
        AddModel(person.name, "Null", Vector3d::Zero(), Vector3d::Zero(), {FbxNode("TypeFlags").Text("Null")}, 0);
    const std::vector<int64_t> joints = AddSkeleton(person, mesh.joints, group);
    const std::string png = number < options_.textures.size() ? options_.textures[number] : std::string();
    const FbxSkin skin = AddFbxSkin(person.name, *person.body, mesh, joints, png, PersonColour(number), &document_);
    document_.Connect(skin.model, group);
    AddBindPose(person.name, mesh.joints, joints, {group, skin.model});
    AddMotion(person, rig, joints);
    const FbxKeys keys(person.seconds);
    for (size_t k = 0; k < skin.shape_channels.size(); ++k) {
      const Eigen::VectorXf percent = (100 * mesh.shape_weights.col(Eigen::Index(k))).cast<float>();
      animation_.AddNumber(skin.shape_channels[k], "DeformPercent", keys, {percent.data(), size_t(percent.size())});
    }
    summary_.AddPerson(mesh.rms_error_m, mesh.max_error_m, mesh.shapes.size());
  }

  std::vector<int64_t> AddSkeleton(const ExportPerson& person, const MatrixX3d& rest, int64_t group) {
    const std::vector<std::string> names = FbxJointNames(options_.rig, *person.body);
    std::vector<int64_t> models;
    for (int j = 0; j < person.body->num_joints(); ++j) {
      const int parent = person.body->parents()[j];
      Vector3d offset = rest.row(j).transpose();
      if (parent >= 0) offset -= rest.row(parent).transpose();
      models.push_back(AddModel(names[size_t(j)], "LimbNode", offset, Vector3d::Zero(),
                                {FbxNode("TypeFlags").Text("Skeleton")}, parent < 0 ? group : models[size_t(parent)]));
    }
    return models;
  }

  /// `at_origin`: models that stand at the origin.
  void AddBindPose(const std::string& name, const MatrixX3d& rest, const std::vector<int64_t>& joints,
                   const std::vector<int64_t>& at_origin) {
    std::vector<FbxNode> nodes = {FbxNode("Type").Text("BindPose"), FbxNode("Version").Int(100),
                                  FbxNode("NbPoseNodes").Int(static_cast<int32_t>(joints.size() + at_origin.size()))};
    const auto add = [&](int64_t model, const Vector3d& place) {
      FbxNode node("PoseNode");
      node.Add(FbxNode("Node").Long(model)).Add(FbxNode("Matrix").Doubles(FbxTranslation(place)));
      nodes.push_back(std::move(node));
    };
    for (const int64_t model : at_origin) add(model, Vector3d::Zero());
    for (size_t j = 0; j < joints.size(); ++j) add(joints[j], rest.row(Eigen::Index(j)).transpose());
    document_.Add("Pose", name, "Pose", "BindPose", nodes);
  }

  void AddMotion(const ExportPerson& person, const RigSkeleton& rig, const std::vector<int64_t>& joints) {
    const FbxKeys keys(person.seconds);
    const auto T = static_cast<Eigen::Index>(person.poses.size());
    const Vector3d pelvis = person.rest_joints.row(0).transpose();
    MatrixX3d places(T, 3);
    for (Eigen::Index t = 0; t < T; ++t)
      places.row(t) = kFbxPerMetre * (pelvis + person.poses[size_t(t)].trans).transpose();
    animation_.AddVector(joints[0], "Lcl Translation", keys, places, kFbxPerMetre * pelvis);
    std::vector<Matrix3d> rotations(person.poses.size());
    for (int j = 0; j < person.body->num_joints(); ++j) {
      for (size_t t = 0; t < rotations.size(); ++t) rotations[t] = rig.FromRest(*person.body, person.poses[t], j);
      animation_.AddVector(joints[size_t(j)], "Lcl Rotation", keys, ContinuousEulerXyz_deg(rotations),
                           Vector3d::Zero());
    }
    AddPresence(person, joints[0]);
  }

  /// Each change has a key just before it, since some programs take all keys for linear ones.
  void AddPresence(const ExportPerson& person, int64_t pelvis) {
    std::vector<double> seconds, scales;
    for (const PresenceKey& key : scene_.PresenceOf(person)) {
      if (!seconds.empty()) {
        seconds.push_back(key.seconds - kPresenceRamp / scene_.fps);
        scales.push_back(scales.back());
      }
      seconds.push_back(key.seconds);
      scales.push_back(key.present ? 1 : 0);
    }
    if (seconds.empty()) return;
    const Eigen::Map<const Eigen::VectorXd> column(scales.data(), Eigen::Index(scales.size()));
    animation_.AddVector(pelvis, "Lcl Scaling", FbxKeys(seconds), column.replicate(1, 3), Vector3d::Ones());
  }

  void AddCamera() {
    const Camera& camera = scene_.camera;
    if (camera.model != CameraModel::kPinhole || camera.width <= 0 || camera.height <= 0) return;
    const double mm_per_px = kFilmWidth_mm / camera.width, inch_per_px = mm_per_px / kMillimetresPerInch;
    // Pixels need not be square: on the film they are as high as they are wide in the lens' angle.
    const double height_in = inch_per_px * camera.height * camera.fx / camera.fy;
    const double right_in = inch_per_px * (0.5 * (camera.width - 1) - camera.cx);
    const double up_in = inch_per_px * (camera.cy - 0.5 * (camera.height - 1)) * camera.fx / camera.fy;
    constexpr int kApertureFromFocalLength = 3, kFixedResolution = 2;
    std::vector<FbxNode> attribute = {
        FbxProperties({FbxDouble("FocalLength", camera.fx * mm_per_px, "Number"),
                       FbxDouble("FilmWidth", inch_per_px * camera.width), FbxDouble("FilmHeight", height_in),
                       FbxDouble("FilmAspectRatio", inch_per_px * camera.width / height_in),
                       FbxDouble("FilmOffsetX", right_in, "Number"), FbxDouble("FilmOffsetY", up_in, "Number"),
                       FbxInt("ApertureMode", kApertureFromFocalLength, "enum"),
                       FbxInt("AspectRatioMode", kFixedResolution, "enum"), FbxDouble("AspectWidth", camera.width),
                       FbxDouble("AspectHeight", camera.height), FbxDouble("NearPlane", 1),
                       FbxDouble("FarPlane", 1e5)}),
        FbxNode("TypeFlags").Text("Camera"), FbxNode("GeometryVersion").Int(124)};
    std::vector<double> seconds;
    std::vector<Matrix3d> rotations;
    MatrixX3d places(Eigen::Index(scene_.camera_keys.size()), 3);
    for (const ExportCameraKey& key : scene_.camera_keys) {
      const CameraPose world_from_camera = Inverse(key.camera_from_world);
      places.row(Eigen::Index(seconds.size())) =
          kFbxPerMetre * world_from_camera.camera_from_world_translation.transpose();
      seconds.push_back(key.seconds);
      rotations.push_back(FbxCameraRotation(world_from_camera.camera_from_world_rotation));
    }
    const std::array<Matrix3d, 1> still = {FbxCameraRotation(scene_.world.rotation)};
    const Vector3d angles_deg = ContinuousEulerXyz_deg(still).row(0).transpose();
    const int64_t model = AddModel("camera", "Camera", scene_.world.translation, angles_deg, std::move(attribute), 0);
    if (seconds.empty()) return;
    const FbxKeys keys(seconds);
    animation_.AddVector(model, "Lcl Translation", keys, places, kFbxPerMetre * scene_.world.translation);
    animation_.AddVector(model, "Lcl Rotation", keys, ContinuousEulerXyz_deg(rotations), angles_deg);
  }

  const ExportScene& scene_;
  const FbxOptions& options_;
  FbxDocument document_;
  FbxAnimation animation_;
  SkinSummary summary_;
};

}  // namespace

std::vector<std::string> FbxJointNames(AnimationRig rig, const BodyModel& body) {
  std::vector<std::string> names = RigSkeletonOf(rig, body).names;
  if (rig == AnimationRig::kMixamo) {
    for (std::string& name : names) name.insert(0, "mixamorig:");
  }
  names.insert(names.end(), body.data().joint_names.begin() + std::ptrdiff_t(names.size()),
               body.data().joint_names.end());
  return names;
}

std::string FbxText(const ExportScene& scene, const FbxOptions& options, SkinSummary* summary) {
  BODYLOOM_CHECK(!scene.people.empty(), "FBX: nobody to write");
  const FbxSceneWriter writer(scene, options);
  std::string bytes = writer.Bytes();
  *summary = writer.summary();
  summary->bytes = bytes.size();
  return bytes;
}

SkinSummary WriteFbx(const std::string& path, const ExportScene& scene, const FbxOptions& options) {
  SkinSummary summary;
  WriteFileAtomically(path, FbxText(scene, options, &summary));
  return summary;
}

}  // namespace bodyloom
