// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/pipelines/person/person_folder.h"

#include <filesystem>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "bodyloom/data_tools/body/body_io.h"
#include "bodyloom/data_tools/body/body_or_builtin.h"
#include "bodyloom/data_tools/formats/atomic_file.h"
#include "bodyloom/data_tools/motion/track_io.h"
#include "bodyloom/data_tools/video/image_file.h"
#include "bodyloom/geometry/base/check.h"
#include "bodyloom/pipelines/report_json.h"

namespace bodyloom {
namespace {

std::string FileIn(const std::string& folder, const std::string& name) {
  return (std::filesystem::path(folder) / name).string();
}

std::string PhotoFile(const std::string& folder, size_t photo) {
  return FileIn(folder, Concatenate("photo_", photo, ".npz"));
}

}  // namespace

std::vector<std::string> PhotoPersonFiles(const std::string& folder, int num_photos) {
  std::vector<std::string> files = {FileIn(folder, "body.npz"), FileIn(folder, "texture.png"),
                                    FileIn(folder, "sources.png")};
  for (int i = 0; i < num_photos; ++i) files.push_back(PhotoFile(folder, static_cast<size_t>(i)));
  files.push_back(FileIn(folder, "person.json"));
  return files;
}

void WritePhotoPerson(const std::string& folder, const PhotoPerson& person) {
  SaveBodyCompact(FileIn(folder, "body.npz"), person.body->data());
  WriteImage(FileIn(folder, "texture.png"), person.texture);
  if (!person.sources.empty()) WriteImage(FileIn(folder, "sources.png"), person.sources);
  for (size_t i = 0; i < person.tracks.size(); ++i) WriteTrack(PhotoFile(folder, i), person.tracks[i]);
  WriteFileAtomically(FileIn(folder, "person.json"), ToJson(person.report));
}

PhotoPerson ReadPhotoPerson(const std::string& folder, const std::string& bare_body) {
  PhotoPerson person;
  person.bare = BodyOrBuiltin(bare_body);
  const std::string file = FileIn(folder, "body.npz");
  person.body = std::make_shared<const BodyModel>(LoadBody(file));
  if (person.body->num_vertices() != person.bare->num_vertices() ||
      person.body->num_joints() != person.bare->num_joints() || !person.body->has_uv()) {
    throw std::runtime_error(Concatenate(file, ": has ", person.body->num_vertices(), " vertices and ",
                                         person.body->num_joints(), " joints, the body it was made with (--body) ",
                                         person.bare->num_vertices(), " and ", person.bare->num_joints()));
  }
  person.texture = ReadImage(FileIn(folder, "texture.png"));
  person.tracks.push_back(ReadTrack(PhotoFile(folder, 0)));
  person.betas = person.tracks[0].motion.betas;
  return person;
}

std::string ToJson(const PhotoPersonReport& report) {
  nlohmann::ordered_json photos = nlohmann::ordered_json::array();
  for (const PhotoPersonReport::Photo& photo : report.photos) {
    photos.push_back({{"image", photo.image},
                      {"picture", {photo.width, photo.height}},
                      {"people_found", photo.people},
                      {"contour_vertices_measured", photo.rim_measured},
                      {"texels_seen_share", photo.texels_seen}});
  }
  const nlohmann::ordered_json json = {{"photos", photos},
                                       {"texture_shares",
                                        {{"seen", report.seen},
                                         {"mirrored", report.mirrored},
                                         {"behind", report.behind},
                                         {"hair", report.hair},
                                         {"around", report.around},
                                         {"spread", report.spread}}},
                                       {"clothes_median_m", report.clothes_median_m},
                                       {"clothes_max_m", report.clothes_max_m},
                                       {"seconds", ToJson(report.seconds)}};
  return json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

}  // namespace bodyloom
