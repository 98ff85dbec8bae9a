// SPDX-License-Identifier: Apache-2.0
#include "pipelines/neural/photo/photo_input.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <map>
#include <stdexcept>
#include <utility>

#include "data_tools/body/builtin_body.h"
#include "data_tools/datasets/photo_segmentation.h"
#include "data_tools/datasets/single_person_dataset.h"
#include "data_tools/learned/parser_weights_io.h"
#include "data_tools/motion/track_io.h"
#include "data_tools/observations/part_labels.h"
#include "geometry/base/callbacks.h"
#include "geometry/base/check.h"
#include "geometry/scene/track_edits.h"
#include "pipelines/animate/person_segmentation.h"
#include "pipelines/animate/read_photos.h"
#include "pipelines/body_of_track.h"
#include "render/texture/complete/partial_texture.h"
#include "render/uv_maps/posed_track.h"
#include "tracking/detection/clothes_parser.h"

namespace bodyloom {
namespace {

namespace fs = std::filesystem;

constexpr double kWhole = 0.99;   ///< minimum share of the body's points in the image without a note
constexpr double kOthers = 0.02;  ///< maximum share of labels of other people without a note

/// The track's frame alone.
Track TrackOfFrame(const Track& track, const std::string& path, int frame) {
  const int t = track.num_frames() == 1 ? 0 : frame;
  if (t >= track.num_frames()) {
    throw std::runtime_error(Concatenate(path, ": ", track.num_frames(), " frames, requested frame ", frame));
  }
  if (!track.HasResult(t)) {
    throw std::runtime_error(Concatenate(path, ": frame ", t, " has no result; choose another by the frame's number"));
  }
  return FramesInOrder(track, std::array{t});
}

/// Files that several photos share.
struct Files {
  std::shared_ptr<const BodyModel> body;
  std::map<std::string, Track> tracks;

  const Track& TrackOf(const std::string& path) {
    const auto [place, is_new] = tracks.try_emplace(path);
    if (is_new) place->second = TrackOnBody(*body, ReadTrack(path));
    return place->second;
  }
};

/// An image with its labels, if any.
struct Shown {
  PhotoFile file;
  Image labels;
};

Shown FromSinglePersonDataset(const PhotoRequest& request) {
  const SinglePersonDataset set(request.image);
  if (request.frame >= set.info().num_frames) {
    throw std::runtime_error(
        Concatenate(request.image, ": ", set.info().num_frames, " frames, requested frame ", request.frame));
  }
  PersonFrame frame = set.Read(request.frame, {true, false, false, false});
  Shown shown;
  shown.file.image = std::move(frame.rgb);
  shown.labels = std::move(frame.labels);
  return shown;
}

/// Grey values as an image, for cropping and resizing.
Image AsGreyImage(const std::vector<uint8_t>& values, int width, int height) {
  Image grey(width, height);
  for (size_t i = 0; i < values.size(); ++i) std::fill_n(&grey.bgr[3 * i], 3, values[i]);
  return grey;
}

std::vector<uint8_t> FirstChannel(const Image& grey) {
  std::vector<uint8_t> values(grey.bgr.size() / 3);
  for (size_t i = 0; i < values.size(); ++i) values[i] = grey.bgr[3 * i];
  return values;
}

/// The pixels at the size that the track was made for, if it only was resized since.
void BringToTrackSize(const std::string& image, const std::string& track_path, const Camera& camera, Shown* shown) {
  Image& pixels = shown->file.image;
  const int w = pixels.width, h = pixels.height;
  if (w == camera.width && h == camera.height) return;
  const double scale = double(w) / camera.width;
  const bool same_shape = std::abs(h - scale * camera.height) <= std::max(1.0, scale);
  if (!same_shape || !shown->labels.empty()) {
    throw std::runtime_error(Concatenate(track_path, ": made for images of ", camera.width, "x", camera.height, ", ",
                                         image, " has ", w, "x", h, "; give the pixels that was tracked"));
  }
  shown->file.notes.push_back(
      Concatenate(w, "x", h, " pixels: resized to the ", camera.width, "x", camera.height, " of its track"));
  if (!shown->file.alpha.empty()) {
    shown->file.alpha = FirstChannel(Resized(AsGreyImage(shown->file.alpha, w, h), camera.width, camera.height));
  }
  pixels = Resized(pixels, camera.width, camera.height);
}

/// Share of the body's vertices inside the image.
double ShareInside(const BodyModel& body, const Track& track) {
  const MatrixX3d vertices = PosedTrack(body, track).Vertices(0);
  const Camera camera = track.CameraAt(0);
  int inside = 0;
  for (Eigen::Index i = 0; i < vertices.rows(); ++i) {
    Eigen::Vector2d pixel;
    inside += camera.Project(vertices.row(i).transpose(), &pixel) && pixel.x() >= -0.5 && pixel.y() >= -0.5 &&
              pixel.x() < camera.width - 0.5 && pixel.y() < camera.height - 0.5;
  }
  return inside / std::max(1.0, double(vertices.rows()));
}

/// DensePose parts of the clip as labels of the image.
Image LabelsOfParts(const PhotoRequest& request, const Image& image) {
  const PartLabelSequence parts = ReadPartLabels(request.labels);
  if (parts.image_width != image.width || parts.image_height != image.height || request.frame >= parts.num_frames()) {
    throw std::runtime_error(Concatenate(request.labels, ": ", parts.num_frames(), " frames of ", parts.image_width,
                                         "x", parts.image_height, ", requested frame ", request.frame, " of ",
                                         image.width, "x", image.height));
  }
  return LabelsAsImage(parts.frames[request.frame].Unpacked(), image.width, image.height);
}

}  // namespace

void FillMaps(PhotoMap&& map, int size, int texture_size, PhotoFrame* frame) {
  frame->size = size;
  frame->uv = std::move(map.uv);
  frame->parts = std::move(map.parts);
  frame->texture_size = texture_size;
  frame->texel_pixels = std::move(map.texel_pixels);
  frame->texel_cosine = std::move(map.texel_cosine);
  frame->image.clear();
  frame->labels.clear();
}

void FillImage(const CutPhoto& cut, PhotoFrame* frame) {
  const size_t area = cut.labels.size();
  frame->labels = cut.labels;
  frame->image.assign(3 * area, 0);
  for (size_t i = 0; i < area; ++i) {
    if (cut.labels[i] == 0) continue;
    for (int c = 0; c < 3; ++c) frame->image[area * c + i] = static_cast<float>(cut.image.bgr[3 * i + 2 - c]) / 255;
  }
}

namespace {

Photo MakePhoto(const PhotoRequest& request, Shown shown, int size, int texture_size, Files* files) {
  Photo photo;
  photo.body = files->body;
  const std::string name = request.image + (request.frame > 0 ? Concatenate(", frame ", request.frame) : "");
  const auto note = [&](const std::string& text) { photo.notes += name + ": " + text + "\n"; };
  std::string track_path = request.track;
  if (track_path.empty()) {
    if (!IsSinglePersonDataset(request.image)) {
      throw std::runtime_error(request.image + ": no single-person dataset, so its track must be given");
    }
    track_path = (fs::path(request.image) / "track.npz").string();
  }
  const Track& whole = files->TrackOf(track_path);
  BringToTrackSize(request.image, track_path, whole.camera, &shown);
  for (const std::string& text : shown.file.notes) note(text);
  photo.image = std::move(shown.file.image);
  photo.track = TrackOfFrame(whole, track_path, request.frame);
  const auto nobody = [&](const char* what) {
    return std::runtime_error(Concatenate(track_path, ": ", what, " ", request.image, " (frame ", request.frame,
                                          "); is it this image's track?"));
  };
  double inside = 0;
  try {
    inside = ShareInside(*photo.body, photo.track);
    if (inside == 0) throw nobody("its body lies outside");
    PhotoMapsOptions options;
    options.size = size, options.texture_size = texture_size;
    if (!request.iuv.empty()) {
      options.estimated = std::make_shared<const EstimatedPixels>(*photo.body, request.iuv, 1, request.frame);
    }
    const PhotoMaps maps(*photo.body, photo.track, options);
    photo.window = maps.window();
    FillMaps(maps.At(0), size, texture_size, &photo.frame);
  } catch (const std::invalid_argument& error) {
    throw std::runtime_error(track_path + ": " + error.what());
  }
  if (inside < kWhole) {
    note(Concatenate(std::lround(100 * (1 - inside)), " % of the body lies outside the image: made up"));
  }
  Image labels = std::move(shown.labels);
  bool of_parts = false;
  if (labels.empty() && !request.labels.empty()) {
    labels = LabelsOfParts(request, photo.image);
    note("body parts stand in for a parsing of the clothes");
    of_parts = true;
  }
  CutPhoto cut;
  cut.image = CutWindow(photo.image, photo.window, 0);
  if (labels.empty()) {
    const auto cut_values = [&](const std::vector<uint8_t>& values) {
      return CutLabels(AsGreyImage(values, photo.image.width, photo.image.height), photo.window, 0);
    };
    const std::vector<uint8_t>& alpha = shown.file.alpha;
    const std::vector<uint8_t> everywhere(photo.image.bgr.size() / 3, 1);
    try {
      const PersonSegmentation segmentation =
          SegmentPerson(cut.image, cut_values(everywhere), alpha.empty() ? std::vector<uint8_t>() : cut_values(alpha),
                        photo.frame.parts);
      cut.labels = ClothesParser(BuiltinParser())
                       .Labels(cut.image, segmentation.labels, *photo.body, photo.track,
                               CameraInWindow(photo.track.CameraAt(0), photo.window, 0), 1);
      note(segmentation.note + ", clothes are told apart by the parser");
    } catch (const std::invalid_argument&) {
      throw nobody("its body is not to be seen in");
    }
  } else {
    cut.labels = CutLabels(labels, photo.window, 0);
    if (of_parts && KeepPerson(photo.frame.parts, size, &cut.labels) > kOthers) {
      note("there is more than one person: the one of the track counts");
    }
  }
  if (std::all_of(cut.labels.begin(), cut.labels.end(), [](uint8_t label) { return label == 0; })) {
    throw std::runtime_error(request.image + ": its labels show nobody where the track has the body");
  }
  FillImage(cut, &photo.frame);
  const PartialTexture texture = PartialTextureOf(photo.frame);
  if (std::find(texture.visible.begin(), texture.visible.end(), 1) == texture.visible.end()) {
    throw nobody("nothing of its body is to be seen in");
  }
  // The window's labels at their position in the image.
  photo.person.assign(size_t(photo.image.width) * photo.image.height, 0);
  for (int y = 0; y < photo.image.height; ++y) {
    for (int x = 0; x < photo.image.width; ++x) {
      const int column = static_cast<int>(x * photo.window.scale_x) - photo.window.corner[0].x();
      const int row = static_cast<int>(y * photo.window.scale_y) - photo.window.corner[0].y();
      if (column < 0 || row < 0 || column >= size || row >= size) continue;
      photo.person[size_t(y) * photo.image.width + x] = cut.labels[size_t(row) * size + column] != 0 ? 1 : 0;
    }
  }
  return photo;
}

}  // namespace

std::vector<Photo> LoadPhotos(std::span<const PhotoRequest> requests, int size, int texture_size) {
  BODYLOOM_CHECK(!requests.empty(), "photos: none requested");
  Files files;
  files.body = BodyOrBuiltin(requests[0].body);
  std::vector<ImageRequest> images;
  for (const PhotoRequest& request : requests) {
    if (!IsSinglePersonDataset(request.image)) images.push_back({request.image, request.frame});
  }
  std::vector<PhotoFile> read = ReadImages(images);
  std::vector<Photo> photos;
  size_t next = 0;
  for (const PhotoRequest& request : requests) {
    Shown shown;
    if (IsSinglePersonDataset(request.image)) {
      shown = FromSinglePersonDataset(request);
    } else {
      shown.file = std::move(read[next++]);
    }
    photos.push_back(MakePhoto(request, std::move(shown), size, texture_size, &files));
    RequireBodyOf(photos.front(), photos.back().track, request.track.empty() ? request.image : request.track);
  }
  return photos;
}

void RequireBodyOf(const Photo& photo, const Track& track, const std::string& path) {
  if (track.motion.body == photo.track.motion.body) return;
  throw std::runtime_error(Concatenate(path, ": a track of the body \"", track.motion.body, "\", the photo's is of \"",
                                       photo.track.motion.body, "\"; fit both with the same --body"));
}

PhotoRequest ParsePhotoRequest(const std::string& text, const std::string& option, const PhotoRequest& like) {
  PhotoRequest request = like;
  const size_t first = text.find(':'), second = first == std::string::npos ? first : text.find(':', first + 1);
  request.image = text.substr(0, first);
  request.track = first == std::string::npos
                      ? ""
                      : text.substr(first + 1, second == std::string::npos ? second : second - first - 1);
  request.frame = 0;
  request.labels.clear(), request.iuv.clear();
  if (second != std::string::npos) {
    const std::string number = text.substr(second + 1);
    const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), request.frame);
    if (error != std::errc() || end != number.data() + number.size() || request.frame < 0) {
      throw RequestError(option + " " + text + ": expected IMAGE:TRACK or IMAGE:TRACK:FRAME");
    }
  }
  if (request.image.empty()) throw RequestError(option + " " + text + ": expected IMAGE:TRACK or IMAGE:TRACK:FRAME");
  return request;
}

}  // namespace bodyloom
