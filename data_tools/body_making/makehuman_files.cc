// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/data_tools/body_making/makehuman_files.h"

#include <zlib.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>
#include <string_view>

#include "bodyloom/data_tools/formats/atomic_file.h"
#include "bodyloom/data_tools/formats/json_reader.h"
#include "bodyloom/data_tools/formats/obj.h"
#include "bodyloom/data_tools/formats/printable.h"
#include "bodyloom/geometry/base/check.h"
#include "bodyloom/geometry/base/refuse.h"

namespace bodyloom {
namespace {

namespace fs = std::filesystem;

constexpr size_t kMaxMeshBytes = size_t{64} << 20;
constexpr size_t kMaxTargetBytes = size_t{16} << 20;
constexpr size_t kMaxTargets = 5000;
constexpr size_t kMaxBones = 1000;

/// The group ("g NAME") of each face in the order of the file.
std::vector<std::string> GroupOfFaces(std::string_view text) {
  std::vector<std::string> groups;
  std::string group;
  while (!text.empty()) {
    const size_t end = std::min(text.find('\n'), text.size());
    std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    if (line.starts_with("g ")) group = std::string(line.substr(2));
    if (line.starts_with("f ") || line.starts_with("f\t")) groups.push_back(group);
  }
  return groups;
}

void ReadMesh(const std::string& path, MakeHumanFiles* files) {
  const std::string text = ReadFileBytes(path, kMaxMeshBytes);
  const ObjMesh mesh = ReadObjBytes(text, path);
  const std::vector<std::string> groups = GroupOfFaces(text);
  if (static_cast<int>(groups.size()) != mesh.num_faces())
    Refuse(path, "indented faces, expected lines that start with f");
  files->vertices_dm = mesh.positions;
  files->uv = mesh.uv;
  std::set<int> body_vertices;
  std::map<std::string, std::set<int>> cubes;
  for (int f = 0; f < mesh.num_faces(); ++f) {
    const int first = mesh.face_begin[f], corners = mesh.face_begin[f + 1] - first;
    if (groups[f].starts_with("joint-")) {
      cubes[groups[f]].insert(&mesh.corner_position[first], &mesh.corner_position[first] + corners);
    }
    if (groups[f] != "body") continue;
    if (corners != 4) Refuse(path, Concatenate("a body face of ", corners, " corners, expected quads"));
    Quad quad, quad_uv;
    for (int k = 0; k < 4; ++k) {
      quad[k] = mesh.corner_position[first + k];
      quad_uv[k] = mesh.corner_uv[first + k];
      if (quad_uv[k] < 0) Refuse(path, "a body face without texture coordinates");
      body_vertices.insert(quad[k]);
    }
    files->quads.push_back(quad);
    files->quads_uv.push_back(quad_uv);
  }
  if (files->quads.empty()) Refuse(path, "no faces in group 'body', expected MakeHuman's base mesh (hm08)");
  files->num_body_vertices = static_cast<int>(body_vertices.size());
  if (*body_vertices.rbegin() + 1 != files->num_body_vertices) {
    Refuse(path, Concatenate("the body uses ", body_vertices.size(), " vertices up to number ",
                             *body_vertices.rbegin() + 1, ", expected the body's vertices first and without gaps"));
  }
  for (const auto& [name, vertices] : cubes) files->joint_cubes[name].assign(vertices.begin(), vertices.end());
}

std::vector<int> ReadBoneEnd(const JsonNode& end, const MakeHumanFiles& files) {
  if (end.At("strategy").Text() == "CUBE") {
    const JsonNode name = end.At("cube_name");
    const auto cube = files.joint_cubes.find(name.Text());
    if (cube == files.joint_cubes.end())
      name.Fail("a joint cube of base.obj, found '" + PrintableText(name.Text()) + "'");
    return cube->second;
  }
  std::vector<int> vertices;
  const JsonNode indices = end.At("vertex_indices");
  for (size_t i = 0; i < indices.size(); ++i) {
    const int64_t vertex = indices.At(i).Integer();
    if (vertex < 0 || vertex >= files.vertices_dm.rows()) {
      indices.At(i).Fail("a vertex 0.." + std::to_string(files.vertices_dm.rows() - 1));
    }
    vertices.push_back(static_cast<int>(vertex));
  }
  if (vertices.empty()) indices.Fail("at least one vertex");
  return vertices;
}

void ReadRig(const std::string& path, MakeHumanFiles* files) {
  const nlohmann::json document = ReadJsonFile(path);
  const JsonNode rig(document, path);
  if (!rig.is_object() || rig.size() == 0 || rig.size() > kMaxBones) rig.Fail("an object of 1 to 1000 bones");
  // JSON keys are in alphabetical order: take the bones whose parent is placed until none is left.
  std::vector<std::string> waiting = rig.Keys();
  while (!waiting.empty()) {
    std::vector<std::string> later;
    for (const std::string& name : waiting) {
      const JsonNode bone = rig.At(name);
      const std::string parent = bone.At("parent").Text();
      const int parent_index = files->FindBone(parent);
      if (!parent.empty() && parent_index < 0) {
        later.push_back(name);
        continue;
      }
      files->bones.push_back(
          {name, parent_index, ReadBoneEnd(bone.At("head"), *files), ReadBoneEnd(bone.At("tail"), *files)});
    }
    if (later.size() == waiting.size()) {
      rig.At(later.front()).At("parent").Fail("a bone that leads to the root");
    }
    waiting = later;
  }
}

void ReadWeights(const std::string& path, MakeHumanFiles* files) {
  const nlohmann::json document = ReadJsonFile(path);
  const JsonNode weights = JsonNode(document, path).At("weights");
  std::vector<Eigen::Triplet<double>> entries;
  Eigen::VectorXd sums = Eigen::VectorXd::Zero(files->num_body_vertices);
  for (size_t b = 0; b < files->bones.size(); ++b) {
    if (!weights.Has(files->bones[b].name)) continue;
    const JsonNode list = weights.At(files->bones[b].name);
    for (size_t i = 0; i < list.size(); ++i) {
      const std::vector<double> pair = list.At(i).Numbers(2);
      const double vertex = pair[0], weight = pair[1];
      if (vertex != std::floor(vertex) || vertex < 0 || vertex >= static_cast<double>(files->vertices_dm.rows()) ||
          weight < 0 || weight > 1) {
        list.At(i).Fail("[vertex, weight] with a vertex 0.." + std::to_string(files->vertices_dm.rows() - 1) +
                        " and a weight 0..1");
      }
      if (vertex >= files->num_body_vertices) continue;  // helper geometry
      entries.emplace_back(static_cast<int>(vertex), static_cast<int>(b), weight);
      sums[static_cast<int>(vertex)] += weight;
    }
  }
  for (int v = 0; v < files->num_body_vertices; ++v) {
    if (!(sums[v] > 1e-3)) Refuse(path, Concatenate("body vertex ", v, " has no weights"));
  }
  for (auto& entry : entries) entry = {entry.row(), entry.col(), entry.value() / sums[entry.row()]};
  files->bone_weights.resize(files->num_body_vertices, static_cast<Eigen::Index>(files->bones.size()));
  files->bone_weights.setFromTriplets(entries.begin(), entries.end());
}

MakeHumanTarget ParseTarget(std::string_view text, const std::string& path, Eigen::Index num_vertices) {
  MakeHumanTarget target;
  std::vector<float> offsets;
  int line_number = 0;
  while (!text.empty()) {
    const size_t end = std::min(text.find('\n'), text.size());
    std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    ++line_number;
    line = line.substr(0, line.find('#'));
    double values[4];
    int count = 0;
    for (size_t begin = line.find_first_not_of(" \t\r"); begin != std::string_view::npos;
         begin = line.find_first_not_of(" \t\r", begin)) {
      const size_t stop = std::min(line.find_first_of(" \t\r", begin), line.size());
      double value = 0;
      const auto [last, error] = std::from_chars(line.data() + begin, line.data() + stop, value);
      if (count == 4 || error != std::errc() || last != line.data() + stop || !(std::abs(value) <= 1e6)) {
        Refuse(path, Concatenate("line ", line_number, ": '", PrintableText(line), "', expected: vertex dx dy dz"));
      }
      values[count++] = value;
      begin = stop;
    }
    if (count == 0) continue;
    if (count != 4 || values[0] != std::floor(values[0]) || values[0] < 0 ||
        values[0] >= static_cast<double>(num_vertices)) {
      Refuse(path, Concatenate("line ", line_number, ": '", PrintableText(line),
                               "', expected: vertex dx dy dz with a vertex 0..", num_vertices - 1));
    }
    target.vertices.push_back(static_cast<int>(values[0]));
    for (int c = 1; c < 4; ++c) offsets.push_back(static_cast<float>(values[c]));
  }
  target.offsets_dm = Eigen::Map<const MatrixX3f>(offsets.data(), static_cast<Eigen::Index>(target.vertices.size()), 3);
  return target;
}

void ReadTargets(const std::string& folder, MakeHumanFiles* files) {
  if (!fs::is_directory(folder)) Refuse(folder, "no such folder, expected MakeHuman's macro targets");
  std::vector<fs::path> paths;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file() && entry.path().filename().string().ends_with(".target.gz"))
      paths.push_back(entry.path());
    if (paths.size() > kMaxTargets) Refuse(folder, "more than 5000 targets");
  }
  for (const fs::path& path : paths) {
    std::string name = path.filename().string();
    name.resize(name.size() - std::string(".target.gz").size());
    files->targets[name] =
        ParseTarget(ReadGzip(path.string(), kMaxTargetBytes), path.string(), files->vertices_dm.rows());
  }
}

}  // namespace

int MakeHumanFiles::FindBone(const std::string& name) const {
  const auto it =
      std::find_if(bones.begin(), bones.end(), [&](const MakeHumanBone& bone) { return bone.name == name; });
  return it == bones.end() ? -1 : static_cast<int>(it - bones.begin());
}

std::string ReadGzip(const std::string& path, size_t max_bytes) {
  const std::string packed = ReadFileBytes(path, max_bytes);
  z_stream stream{};
  if (inflateInit2(&stream, 15 + 16) != Z_OK) Refuse(path, "zlib cannot start");
  std::string out;
  std::string buffer(size_t{1} << 16, '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data()));
  stream.avail_in = static_cast<uInt>(packed.size());
  int state = Z_OK;
  while (state == Z_OK && out.size() <= max_bytes) {
    stream.next_out = reinterpret_cast<Bytef*>(buffer.data());
    stream.avail_out = static_cast<uInt>(buffer.size());
    state = inflate(&stream, Z_NO_FLUSH);
    out.append(buffer, 0, buffer.size() - stream.avail_out);
  }
  const size_t position = stream.total_in;
  inflateEnd(&stream);
  if (out.size() > max_bytes) Refuse(path, Concatenate("holds more than ", max_bytes, " bytes"));
  if (state != Z_STREAM_END) Refuse(path, Concatenate("byte ", position, ": the gzip stream is damaged or cut short"));
  return out;
}

MakeHumanFiles ReadMakeHuman(const std::string& folder) {
  MakeHumanFiles files;
  ReadMesh(folder + "/base.obj", &files);
  ReadRig(folder + "/rigs/standard/rig.game_engine.json", &files);
  ReadWeights(folder + "/rigs/standard/weights.game_engine.json", &files);
  ReadTargets(folder + "/targets/macrodetails", &files);
  return files;
}

}  // namespace bodyloom
