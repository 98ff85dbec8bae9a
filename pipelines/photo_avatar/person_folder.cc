// SPDX-License-Identifier: Apache-2.0
#include "pipelines/photo_avatar/person_folder.h"

#include <filesystem>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "data_tools/body/body_io.h"
#include "data_tools/body/builtin_body.h"
#include "data_tools/datasets/single_person_dataset.h"
#include "data_tools/formats/atomic_file.h"
#include "data_tools/formats/json_reader.h"
#include "data_tools/motion/track_io.h"
#include "data_tools/video/image_file.h"
#include "geometry/base/check.h"
#include "geometry/cloth/body_with_garment.h"
#include "pipelines/body_of_track.h"
#include "pipelines/photo_avatar/make_photo_person.h"
#include "pipelines/report_json.h"
#include "render/garment/person_cloth.h"

namespace bodyloom {
namespace {

std::string FileIn(const std::string& folder, const std::string& name) {
  return (std::filesystem::path(folder) / name).string();
}

std::string PhotoTrackFile(const std::string& folder, size_t photo) {
  return FileIn(folder, Concatenate("photo_", photo, ".npz"));
}

/// Fields of person.json that are read back.
struct KeptFacts {
  LooseGarmentOptions cut = {.length_m = 0};  ///< of the garment; length 0 where there is none
  ShownLight light;                           ///< even where the file says nothing of it
};

KeptFacts ReadKeptFacts(const std::string& path) {
  KeptFacts facts;
  if (!std::filesystem::exists(path)) return facts;
  const nlohmann::json json = ReadJsonFile(path);
  const JsonNode root(json, path);
  if (root.Has("light")) {
    const std::vector<double> values = root.At("light").Numbers(27);
    for (int k = 0; k < 27; ++k) facts.light.coefficients(k / 9, k % 9) = values[k];
  }
  if (root.Has("garment")) {
    const JsonNode garment = root.At("garment");
    facts.cut.waist_y_m = garment.At("waist_y_m").Number();
    facts.cut.length_m = garment.At("length_m").Number();
    facts.cut.fullness = garment.At("fullness").Number();
    facts.cut.spacing_m = garment.At("spacing_m").Number();
    facts.cut.columns = garment.At("columns").Int();
  }
  return facts;
}

/// A file of a person who was kept there before would be taken for this one's.
void WriteOrRemove(const std::string& path, const Image& image) {
  if (image.empty()) {
    std::filesystem::remove(path);
  } else {
    WriteImage(path, image);
  }
}

/// One a texel; none where there is no such file.
std::vector<uint8_t> LabelsIn(const std::string& path, const Image& texture) {
  std::vector<uint8_t> labels;
  if (!std::filesystem::exists(path)) return labels;
  const Image numbers = ReadImage(path);
  if (numbers.width != texture.width || numbers.height != texture.height) {
    throw std::runtime_error(Concatenate(path, ": is ", numbers.width, "x", numbers.height, ", the texture ",
                                         texture.width, "x", texture.height));
  }
  labels.reserve(numbers.bgr.size() / 3);
  for (size_t i = 0; i < numbers.bgr.size(); i += 3) {
    if (numbers.bgr[i] >= kNumPersonLabels) {
      throw std::runtime_error(Concatenate(path, ": label ", int{numbers.bgr[i]}, ", expected 0 to ",
                                           kNumPersonLabels - 1, " as `bodyloom parse` numbers them"));
    }
    labels.push_back(numbers.bgr[i]);
  }
  return labels;
}

}  // namespace

std::vector<std::string> PhotoPersonFiles(const std::string& folder, int num_photos) {
  std::vector<std::string> files = {FileIn(folder, "body.npz"), FileIn(folder, "texture.png"),
                                    FileIn(folder, "sources.png"), FileIn(folder, "labels.png")};
  for (int i = 0; i < num_photos; ++i) files.push_back(PhotoTrackFile(folder, static_cast<size_t>(i)));
  files.push_back(FileIn(folder, "person.json"));
  return files;
}

void WritePhotoPerson(const std::string& folder, const PhotoPerson& person) {
  SaveBodyCompact(FileIn(folder, "body.npz"), person.body->data());
  WriteImage(FileIn(folder, "texture.png"), person.texture);
  WriteOrRemove(FileIn(folder, "sources.png"), person.sources);
  const int width = person.texture.width, height = person.texture.height;
  WriteOrRemove(FileIn(folder, "labels.png"),
                person.labels.empty() ? Image() : NumbersImage(person.labels, width, height));
  for (size_t i = 0; i < person.tracks.size(); ++i) WriteTrack(PhotoTrackFile(folder, i), person.tracks[i]);
  WriteFileAtomically(FileIn(folder, "person.json"), ToJson(person));
}

PhotoPerson ReadPhotoPerson(const std::string& folder, const std::string& bare_body) {
  PhotoPerson person;
  const std::string file = FileIn(folder, "body.npz");
  person.body = std::make_shared<const BodyModel>(LoadBody(file));
  person.bare = BodyOfJoints(bare_body, person.body->num_joints());
  if (person.body->num_vertices() < person.bare->num_vertices() ||
      person.body->num_joints() != person.bare->num_joints() || !person.body->has_uv()) {
    throw std::runtime_error(Concatenate(file, ": has ", person.body->num_vertices(), " vertices and ",
                                         person.body->num_joints(), " joints, the body it was made with (--body) ",
                                         person.bare->num_vertices(), " and ", person.bare->num_joints()));
  }
  const KeptFacts facts = ReadKeptFacts(FileIn(folder, "person.json"));
  person.cut = facts.cut, person.light = facts.light;
  person.clothed = person.body;
  if (person.cut.length_m > 0) {
    try {
      person.clothed = std::make_shared<const BodyModel>(BodyWithoutGarment(*person.body, person.bare->num_vertices()));
      person.garment = CutGarment(*person.clothed, &person.cut);
    } catch (const std::invalid_argument& error) {
      throw std::runtime_error(Concatenate(FileIn(folder, "person.json"), ": garment: ", error.what()));
    }
  }
  const int expected = person.bare->num_vertices() + static_cast<int>(person.garment.drawn_from.size());
  if (person.body->num_vertices() != expected) {
    throw std::runtime_error(Concatenate(file, ": has ", person.body->num_vertices(),
                                         " vertices, with the garment of person.json expected ", expected));
  }
  person.texture = ReadImage(FileIn(folder, "texture.png"));
  const std::string sources = FileIn(folder, "sources.png");
  if (std::filesystem::exists(sources)) person.sources = ReadImage(sources);
  person.labels = LabelsIn(FileIn(folder, "labels.png"), person.texture);
  person.tracks.push_back(ReadTrack(PhotoTrackFile(folder, 0)));
  person.betas = person.tracks[0].motion.betas;
  return person;
}

std::string ToJson(const PhotoPerson& person) {
  const PhotoPersonReport& report = person.report;
  nlohmann::ordered_json photos = nlohmann::ordered_json::array();
  for (const PhotoPersonReport::Photo& photo : report.photos) {
    photos.push_back({{"image", photo.image},
                      {"picture", {photo.width, photo.height}},
                      {"people_found", photo.people},
                      {"contour_vertices_measured", photo.rim_measured},
                      {"texels_seen_share", photo.texels_seen}});
  }
  nlohmann::ordered_json json = {{"photos", photos},
                                 {"texture_shares",
                                  {{"seen", report.seen},
                                   {"mirrored", report.mirrored},
                                   {"behind", report.behind},
                                   {"hair", report.hair},
                                   {"limb_neighbour", report.limb_neighbour},
                                   {"smooth_fill", report.smooth_fill}}},
                                 {"clothes_median_m", report.clothes_median_m},
                                 {"clothes_max_m", report.clothes_max_m},
                                 {"mask_error_tight", report.mask_error_tight},
                                 {"mask_error_with_garment", report.mask_error_with_garment},
                                 {"seconds", ToJson(report.seconds)}};
  for (Eigen::Index c = 0; c < 3; ++c) {
    for (Eigen::Index k = 0; k < 9; ++k) json["light"].push_back(person.light.coefficients(c, k));
  }
  if (person.cut.length_m > 0) {
    json["garment"] = {{"waist_y_m", person.cut.waist_y_m},
                       {"length_m", person.cut.length_m},
                       {"fullness", person.cut.fullness},
                       {"spacing_m", person.cut.spacing_m},
                       {"columns", person.cut.columns}};
  }
  return json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

}  // namespace bodyloom
