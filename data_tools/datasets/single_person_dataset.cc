// SPDX-License-Identifier: Apache-2.0
#include "data_tools/datasets/single_person_dataset.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <stdexcept>
#include <utility>

#include "data_tools/formats/atomic_file.h"
#include "data_tools/formats/json_reader.h"
#include "data_tools/motion/track_io.h"
#include "data_tools/video/image_file.h"
#include "geometry/base/check.h"
#include "render/image/image_mat.h"
#include "render/view/contact_sheet.h"

namespace bodyloom {
namespace {

namespace fs = std::filesystem;

constexpr const char* kSinglePersonFormat = "bodyloom person set";
constexpr int kSinglePersonVersion = 1;
constexpr int kMaxFrames = 1'000'000;
constexpr int kMaxPixels = 16384;

/// A kind of image: its folder, its member of a frame, and its flag in datasets and requests.
struct FolderKind {
  const char* folder;
  const char* name;  ///< in "has"; null: always present
  Image PersonFrame::*image;
  bool RenderedPeople::*flag;
};

const std::array<FolderKind, 5> kKinds = {
    {{"images", nullptr, &PersonFrame::rgb, nullptr},
     {"labels", "labels", &PersonFrame::labels, &RenderedPeople::labels},
     {"normals", "normals", &PersonFrame::normals, &RenderedPeople::normals},
     {"iuv", "iuv", &PersonFrame::iuv, &RenderedPeople::iuv},
     {"backgrounds", "background", &PersonFrame::background, &RenderedPeople::background}}};

bool IsIn(const FolderKind& kind, const RenderedPeople& images) { return kind.flag == nullptr || images.*kind.flag; }

std::string FileOf(const std::string& path, const char* name) { return (fs::path(path) / name).string(); }

std::string FileOfFrame(const std::string& path, const FolderKind& kind, int t) {
  return FrameFile(fs::path(path) / kind.folder, t);
}

int IntegerIn(const JsonNode& node, int64_t low, int64_t high) {
  const int64_t value = node.Integer();
  if (value < low || value > high) {
    throw std::runtime_error(Concatenate(node.place(), ": found ", value, ", expected ", low, " to ", high));
  }
  return static_cast<int>(value);
}

SinglePersonDatasetInfo ReadInfo(const std::string& path) {
  const std::string file = FileOf(path, "person.json");
  if (fs::is_directory(path) && !fs::exists(file)) {
    throw std::runtime_error(file +
                             ": not there, expected it in a finished single-person dataset (it is written last)");
  }
  const nlohmann::json document = ReadJsonFile(file, {.max_bytes = 1 << 20, .max_depth = 16});
  const JsonNode root(document, file);
  if (root.At("format").Text() != kSinglePersonFormat)
    root.At("format").Fail(std::string("\"") + kSinglePersonFormat + "\"");
  IntegerIn(root.At("version"), kSinglePersonVersion, kSinglePersonVersion);
  SinglePersonDatasetInfo info;
  info.num_frames = IntegerIn(root.At("frames"), 1, kMaxFrames);
  info.width = IntegerIn(root.At("width"), 1, kMaxPixels);
  info.height = IntegerIn(root.At("height"), 1, kMaxPixels);
  info.fps = root.At("fps").Number();
  if (!(info.fps > 0)) root.At("fps").Fail("frames a second");
  const JsonNode labels = root.At("labels");
  for (size_t i = 0; i < size_t{kNumPersonLabels}; ++i) {
    if (!labels.is_array() || labels.size() != kNumPersonLabels) labels.Fail("a list of 7 names");
    if (labels.At(i).Text() != kPersonLabelNames[i]) labels.At(i).Fail(std::string("\"") + kPersonLabelNames[i] + "\"");
  }
  const JsonNode has = root.At("has");
  for (const FolderKind& kind : kKinds) {
    if (kind.flag != nullptr) info.has.*kind.flag = has.At(kind.name).Flag();
  }
  if (root.Has("seed") && document["seed"].is_number_unsigned()) info.seed = document["seed"].get<uint64_t>();
  const auto text = [&](const char* name) {
    return root.Has(name) && root.At(name).is_string() ? root.At(name).Text() : std::string();
  };
  info.garment = text("garment"), info.motion = text("motion"), info.command = text("command");
  return info;
}

void CheckLabels(const std::string& file, const Image& labels) {
  for (int y = 0; y < labels.height; ++y) {
    for (int x = 0; x < labels.width; ++x) {
      if (const uint8_t* p = labels.pixel(x, y); p[0] >= kNumPersonLabels || p[1] != p[0] || p[2] != p[0]) {
        throw std::runtime_error(Concatenate(file, ": pixel (", x, ", ", y, "): found ", int(p[0]), ", ", int(p[1]),
                                             ", ", int(p[2]), ", expected one label 0 to ", kNumPersonLabels - 1));
      }
    }
  }
}

/// PNG bytes; labels as one channel. Low compression level: level 6 takes three times as long for 7 % fewer bytes.
std::string PngOf(const Image& image, bool one_channel) {
  cv::Mat pixels = MatOf(image);
  if (one_channel) {
    pixels.create(image.height, image.width, CV_8UC1);
    for (int y = 0; y < image.height; ++y) {
      for (int x = 0; x < image.width; ++x) pixels.at<uchar>(y, x) = image.pixel(x, y)[0];
    }
  }
  std::vector<uchar> bytes;
  cv::imencode(".png", pixels, bytes, {cv::IMWRITE_PNG_COMPRESSION, 2});
  return {bytes.begin(), bytes.end()};
}

void MakeFolder(const std::string& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw std::runtime_error(folder + ": cannot make the folder: " + error.message());
}

/// Returns true if a file is named like a frame of a dataset: six digits (or more) and .png.
bool IsFrameName(const std::string& name) {
  return name.size() >= 10 && name.ends_with(".png") &&
         std::all_of(name.begin(), name.end() - 4, [](char c) { return c >= '0' && c <= '9'; });
}

void TakeApart(const std::string& path) {
  std::error_code error;
  if (!fs::exists(FileOf(path, "person.json"), error)) return;
  fs::remove(FileOf(path, "person.json"), error);
  if (error) throw std::runtime_error(FileOf(path, "person.json") + ": cannot remove: " + error.message());
  for (const FolderKind& kind : kKinds) {
    std::vector<fs::path> frames;
    for (fs::directory_iterator it(fs::path(path) / kind.folder, error), end; !error && it != end;
         it.increment(error)) {
      if (IsFrameName(it->path().filename().string())) frames.push_back(it->path());
    }
    for (const fs::path& frame : frames) fs::remove(frame, error);
  }
}

}  // namespace

bool IsSinglePersonDataset(const std::string& path) { return fs::exists(FileOf(path, "person.json")); }

uint8_t NormalCode(double component) {
  return static_cast<uint8_t>(std::lround(127.5 * (std::clamp(component, -1.0, 1.0) + 1)));
}

SinglePersonDataset::SinglePersonDataset(const std::string& path) : path_(path), info_(ReadInfo(path)) {
  std::error_code error;
  for (const FolderKind& kind : kKinds) {
    if (!IsIn(kind, info_.has)) continue;
    for (int t = 0; t < info_.num_frames; ++t) {
      if (const std::string file = FileOfFrame(path_, kind, t); !fs::exists(file, error)) {
        throw std::runtime_error(
            Concatenate(file, ": not there, expected as person.json promises ", info_.num_frames, " frames"));
      }
    }
  }
}

Track SinglePersonDataset::track() const {
  const std::string file = FileOf(path_, "track.npz");
  Track track = ReadTrack(file);
  if (track.num_frames() != info_.num_frames) {
    throw std::runtime_error(Concatenate(file, ": found ", track.num_frames(), " frames, expected ", info_.num_frames,
                                         " as in person.json"));
  }
  if (track.camera.width != info_.width || track.camera.height != info_.height) {
    throw std::runtime_error(Concatenate(file, ": found image_size ", track.camera.width, "x", track.camera.height,
                                         ", expected ", info_.width, "x", info_.height, " as in person.json"));
  }
  return track;
}

PersonFrame SinglePersonDataset::Read(int t, const RenderedPeople& wanted) const {
  BODYLOOM_CHECK(t >= 0 && t < info_.num_frames, path_, ": frame ", t, ", expected 0 to ", info_.num_frames - 1);
  PersonFrame frame;
  for (const FolderKind& kind : kKinds) {
    if (!IsIn(kind, info_.has) || !IsIn(kind, wanted)) continue;
    const std::string file = FileOfFrame(path_, kind, t);
    Image image = ReadImage(file);
    if (image.width != info_.width || image.height != info_.height) {
      throw std::runtime_error(Concatenate(file, ": found ", image.width, "x", image.height, " pixels, expected ",
                                           info_.width, "x", info_.height, " as in person.json"));
    }
    if (kind.image == &PersonFrame::labels) CheckLabels(file, image);
    frame.*kind.image = std::move(image);
  }
  return frame;
}

SinglePersonDatasetWriter::SinglePersonDatasetWriter(std::string path, const SinglePersonDatasetInfo& info,
                                                     const Track& track)
    : path_(std::move(path)), info_(info) {
  BODYLOOM_CHECK(info.num_frames >= 1 && info.num_frames <= kMaxFrames && track.num_frames() == info.num_frames, path_,
                 ": ", info.num_frames, " frames, ", track.num_frames(), " in the track");
  BODYLOOM_CHECK(info.width >= 1 && info.height >= 1 && info.width <= kMaxPixels && info.height <= kMaxPixels &&
                     track.camera.width == info.width && track.camera.height == info.height,
                 path_, ": size ", info.width, "x", info.height, ", ", track.camera.width, "x", track.camera.height,
                 " in the track");
  BODYLOOM_CHECK(std::isfinite(info.fps) && info.fps > 0, path_, ": ", info.fps, " frames a second");
  TakeApart(path_);
  for (const FolderKind& kind : kKinds) {
    if (IsIn(kind, info_.has)) MakeFolder(FileOf(path_, kind.folder));
  }
  WriteTrack(FileOf(path_, "track.npz"), track);
}

void SinglePersonDatasetWriter::Write(int t, const PersonFrame& frame) const {
  BODYLOOM_CHECK(t >= 0 && t < info_.num_frames, path_, ": frame ", t, ", expected 0 to ", info_.num_frames - 1);
  for (const FolderKind& kind : kKinds) {
    if (!IsIn(kind, info_.has)) continue;
    const Image& image = frame.*kind.image;
    BODYLOOM_CHECK(image.width == info_.width && image.height == info_.height, FileOfFrame(path_, kind, t), ": ",
                   image.width, "x", image.height, " pixels to write, expected ", info_.width, "x", info_.height);
    WriteFileAtomically(FileOfFrame(path_, kind, t), PngOf(image, kind.image == &PersonFrame::labels));
  }
}

void SinglePersonDatasetWriter::Finish() const {
  nlohmann::ordered_json json = {{"format", kSinglePersonFormat}, {"version", kSinglePersonVersion},
                                 {"frames", info_.num_frames},    {"width", info_.width},
                                 {"height", info_.height},        {"fps", info_.fps},
                                 {"labels", kPersonLabelNames}};
  for (const FolderKind& kind : kKinds) {
    if (kind.flag != nullptr) json["has"][kind.name] = info_.has.*kind.flag;
    for (int t = 0; t < info_.num_frames && IsIn(kind, info_.has); ++t) {
      if (const std::string file = FileOfFrame(path_, kind, t); !fs::exists(file)) {
        throw std::runtime_error(file + ": never written, expected before person.json");
      }
    }
  }
  json["seed"] = info_.seed, json["garment"] = info_.garment;
  json["motion"] = info_.motion, json["command"] = info_.command;
  const auto replace = nlohmann::ordered_json::error_handler_t::replace;  // a path may hold any bytes
  WriteFileAtomically(FileOf(path_, "person.json"), json.dump(2, ' ', false, replace) + "\n");
}

Colour PersonLabelColour(PersonLabel label) {
  static const std::array<Colour, kNumPersonLabels> kColours = {
      {{24, 26, 32}, {230, 120, 60}, {70, 130, 220}, {250, 215, 165}, {120, 70, 30}, {225, 160, 150}, {90, 190, 100}}};
  return kColours[static_cast<size_t>(label)];
}

Image PersonLabelImage(const Image& labels) {
  Image image(labels.width, labels.height);
  for (int y = 0; y < labels.height; ++y) {
    for (int x = 0; x < labels.width; ++x) {
      const Colour c = PersonLabelColour(PersonLabel(std::min<int>(labels.pixel(x, y)[0], kNumPersonLabels - 1)));
      uint8_t* const p = image.pixel(x, y);
      p[0] = c.blue, p[1] = c.green, p[2] = c.red;
    }
  }
  return image;
}

PersonSheet::PersonSheet(int num_frames, int columns) : wanted_(EvenlySpreadFrames(num_frames, columns)) {}

void PersonSheet::Take(int t, const PersonFrame& frame) {
  if (std::binary_search(wanted_.begin(), wanted_.end(), t)) frames_.push_back(frame);
}

Image PersonSheet::Draw(int cell_height_px) const {
  BODYLOOM_CHECK(!frames_.empty(), "person sheet: no frame was taken");
  std::vector<Image> cells;
  for (const auto image : {&PersonFrame::rgb, &PersonFrame::labels, &PersonFrame::normals, &PersonFrame::iuv}) {
    if ((frames_.front().*image).empty()) continue;
    for (const PersonFrame& frame : frames_) {
      cells.push_back(image == &PersonFrame::labels ? PersonLabelImage(frame.labels) : frame.*image);
    }
  }
  return ContactSheet(cells,
                      {.columns = static_cast<int>(frames_.size()), .cell_height_px = cell_height_px, .gap_px = 3});
}

}  // namespace bodyloom
