// SPDX-License-Identifier: Apache-2.0
#include "data_tools/export/fbx_skin.h"

#include <array>
#include <utility>

#include "geometry/base/check.h"

namespace bodyloom {
namespace {

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

}  // namespace

std::vector<double> FbxTranslation(const Eigen::Vector3d& place_m) {
  const Eigen::Vector3d p = kFbxPerMetre * place_m;
  return {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, p.x(), p.y(), p.z(), 1};
}

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

}  // namespace bodyloom
