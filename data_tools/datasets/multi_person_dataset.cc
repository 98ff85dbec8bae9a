// SPDX-License-Identifier: Apache-2.0
#include "data_tools/datasets/multi_person_dataset.h"

#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>
#include <vector>

#include "data_tools/datasets/single_person_dataset.h"
#include "data_tools/formats/atomic_file.h"
#include "data_tools/formats/json_reader.h"
#include "geometry/base/check.h"
#include "render/view/contact_sheet.h"

namespace bodyloom {
namespace {

namespace fs = std::filesystem;

constexpr const char* kMultiPersonFormat = "bodyloom people set";
constexpr int kMultiPersonVersion = 1;

std::string FileOf(const std::string& path) { return (fs::path(path) / "people.json").string(); }

/// Returns the path of a folder, which must lie below the dataset.
bool StaysInside(const fs::path& clip) {
  if (clip.empty() || clip.is_absolute()) return false;
  for (const fs::path& step : clip) {
    if (step == ".." || step == ".") return false;
  }
  return true;
}

DatasetPerson ReadPerson(const JsonNode& node, const std::string& path) {
  DatasetPerson person;
  person.name = node.At("name").Text();
  const std::string split = node.At("split").Text();
  if (split != "train" && split != "test") node.At("split").Fail("\"train\" or \"test\"");
  person.test = split == "test";
  const JsonNode clips = node.At("clips");
  if (!clips.is_array() || clips.size() == 0) clips.Fail("a list of at least one folder");
  for (size_t i = 0; i < clips.size(); ++i) {
    const std::string clip = clips.At(i).Text();
    if (!StaysInside(clip)) clips.At(i).Fail("a folder below the dataset");
    std::error_code error;
    if (!fs::exists(fs::path(path) / clip / "person.json", error)) {
      throw std::runtime_error(Concatenate((fs::path(path) / clip / "person.json").string(),
                                           ": not there, expected it as people.json names the clip"));
    }
    person.clips.push_back(clip);
  }
  return person;
}

}  // namespace

MultiPersonDataset ReadMultiPersonDataset(const std::string& path) {
  const std::string file = FileOf(path);
  if (fs::is_directory(path) && !fs::exists(file)) {
    throw std::runtime_error(file + ": not there, expected it in a finished multi-person dataset (it is written last)");
  }
  const nlohmann::json document = ReadJsonFile(file, {.max_bytes = 64 << 20, .max_depth = 16});
  const JsonNode root(document, file);
  if (root.At("format").Text() != kMultiPersonFormat)
    root.At("format").Fail(std::string("\"") + kMultiPersonFormat + "\"");
  if (root.At("version").Integer() != kMultiPersonVersion) root.At("version").Fail(std::to_string(kMultiPersonVersion));
  MultiPersonDataset set;
  set.path = path;
  const int64_t size = root.At("size").Integer();
  if (size < 1 || size > 16384) root.At("size").Fail("1 to 16384 pixels");
  set.size = static_cast<int>(size);
  const JsonNode people = root.At("people");
  if (!people.is_array() || people.size() == 0) people.Fail("a list of at least one person");
  std::set<std::string> names;
  for (size_t i = 0; i < people.size(); ++i) {
    set.people.push_back(ReadPerson(people.At(i), path));
    if (!names.insert(set.people.back().name).second) people.At(i).At("name").Fail("a name that nobody else has");
  }
  if (root.Has("seed") && document["seed"].is_number_unsigned()) set.seed = document["seed"].get<uint64_t>();
  if (root.Has("command") && root.At("command").is_string()) set.command = root.At("command").Text();
  return set;
}

ClipPlace PlaceOfClip(const std::string& clip) {
  const size_t at = clip.rfind("_v");
  const bool numbered = at != std::string::npos && at > 0 && at + 2 < clip.size() &&
                        clip.find_first_not_of("0123456789", at + 2) == std::string::npos;
  return numbered ? ClipPlace{clip.substr(0, at), clip.substr(at + 1)} : ClipPlace{clip, clip};
}

void WriteMultiPersonDataset(const MultiPersonDataset& set) {
  nlohmann::ordered_json json = {{"format", kMultiPersonFormat}, {"version", kMultiPersonVersion}, {"size", set.size}};
  json["people"] = nlohmann::ordered_json::array();
  for (const DatasetPerson& person : set.people) {
    json["people"].push_back(
        {{"name", person.name}, {"split", person.test ? "test" : "train"}, {"clips", person.clips}});
  }
  json["seed"] = set.seed, json["command"] = set.command;
  const auto replace = nlohmann::ordered_json::error_handler_t::replace;  // a path may hold any bytes
  WriteFileAtomically(FileOf(set.path), json.dump(2, ' ', false, replace) + "\n");
}

Image PeopleSheet(const std::string& dataset, int rows, int columns, int cell_height_px) {
  const MultiPersonDataset set = ReadMultiPersonDataset(dataset);
  std::vector<Image> cells;
  for (const int p : EvenlySpreadFrames(static_cast<int>(set.people.size()), rows)) {
    const std::vector<std::string>& clips = set.people[p].clips;
    for (int column = 0; column < columns; ++column) {
      // Clips in turn, and through each of them from its first image to its last.
      const SinglePersonDataset clip((std::filesystem::path(set.path) / clips[column % clips.size()]).string());
      const int round = column / static_cast<int>(clips.size());
      const int rounds = (columns + static_cast<int>(clips.size()) - 1) / static_cast<int>(clips.size());
      cells.push_back(clip.Read(round * clip.info().num_frames / rounds, {false, false, false, false}).rgb);
    }
  }
  return ContactSheet(cells, {.columns = columns, .cell_height_px = cell_height_px, .gap_px = 3});
}

}  // namespace bodyloom
