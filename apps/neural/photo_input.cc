// SPDX-License-Identifier: Apache-2.0
#include "apps/neural/photo_input.h"

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <stdexcept>

#include "apps/exit_code.h"
#include "apps/track_inputs.h"
#include "data_tools/motion/motion_tools.h"
#include "data_tools/observations/part_labels.h"
#include "data_tools/people/label_of_part.h"
#include "data_tools/people/person_set.h"
#include "data_tools/people/photo_segmentation.h"
#include "data_tools/track_io.h"
#include "data_tools/video/image_file.h"
#include "data_tools/video/video_reader.h"
#include "geometry/check.h"

namespace bodyloom {
namespace {

namespace fs = std::filesystem;

bool IsPersonSet(const std::string& path) { return fs::exists(fs::path(path) / "person.json"); }

/// Frame `frame` of a still, a folder or a video; a still has one for every number.
Image PictureAt(const std::string& path, int frame) {
  if (fs::is_directory(path)) {
    const std::vector<std::string> files = ImageFilesOf(path);
    if (frame >= static_cast<int>(files.size())) {
      throw std::runtime_error(Concatenate(path, ": ", files.size(), " pictures, asked for number ", frame));
    }
    return ReadImage(files[frame]);
  }
  try {
    return ReadImage(path);
  } catch (const std::runtime_error&) {
    // Not a still: a video, or nothing at all, which its reader will say.
  }
  VideoReader video(path);
  Image picture;
  for (int t = 0; t <= frame; ++t) {
    if (!video.Read(&picture)) {
      throw std::runtime_error(Concatenate(path, ": ", t, " frames, asked for frame ", frame));
    }
  }
  return picture;
}

/// The track's frame alone.
Track TrackOfFrame(const Track& track, const std::string& path, int frame) {
  const int t = track.num_frames() == 1 ? 0 : frame;
  if (t >= track.num_frames()) {
    throw std::runtime_error(Concatenate(path, ": ", track.num_frames(), " frames, asked for frame ", frame));
  }
  if (!track.HasResult(t)) {
    throw std::runtime_error(Concatenate(path, ": frame ", t, " has no result; choose another by the frame's number"));
  }
  Track one = track;
  one.motion = TakeFrames(track.motion, t, 1);
  one.frame_status = {track.frame_status[t]};
  const auto keep = [t](auto* values) {
    if (!values->empty()) *values = {(*values)[t]};
  };
  keep(&one.joints), keep(&one.coco17);
  if (one.joint_sigma.rows() > 0) one.joint_sigma = RowMatrixXd(track.joint_sigma.row(t));
  if (one.weak_camera.rows() > 0) one.weak_camera = MatrixX3d(track.weak_camera.row(t));
  return one;
}

}  // namespace

void FillMaps(PhotoMap&& map, int size, int texture_size, PhotoFrame* frame) {
  frame->size = size;
  frame->uv = std::move(map.uv);
  frame->parts = std::move(map.parts);
  frame->texture_size = texture_size;
  frame->texel_pixels = std::move(map.texel_pixels);
  frame->texel_seen = std::move(map.texel_seen);
  frame->image.clear();
  frame->labels.clear();
}

void FillPicture(const CutPhoto& cut, PhotoFrame* frame) {
  const size_t area = cut.labels.size();
  frame->labels = cut.labels;
  frame->image.assign(3 * area, 0);
  for (size_t i = 0; i < area; ++i) {
    if (cut.labels[i] == 0) continue;
    for (int c = 0; c < 3; ++c) frame->image[area * c + i] = static_cast<float>(cut.image.bgr[3 * i + 2 - c]) / 255;
  }
}

Photo LoadPhoto(const PhotoRequest& request, int size, int texture_size) {
  Photo photo;
  photo.body = BodyOrBuiltin(request.body);
  Image labels;
  std::string track_path = request.track;
  if (IsPersonSet(request.image)) {
    const PersonSet set(request.image);
    if (request.frame >= set.info().num_frames) {
      throw std::runtime_error(
          Concatenate(request.image, ": ", set.info().num_frames, " frames, asked for frame ", request.frame));
    }
    const PersonFrame picture = set.Read(request.frame, {true, false, false, false});
    photo.picture = picture.rgb;
    labels = picture.labels;
    if (track_path.empty()) track_path = (fs::path(request.image) / "track.npz").string();
  } else {
    photo.picture = PictureAt(request.image, request.frame);
  }
  if (track_path.empty()) throw std::runtime_error(request.image + ": no person set, so its track must be given");
  const Track whole = ReadTrack(track_path);
  if (whole.camera.width != photo.picture.width || whole.camera.height != photo.picture.height) {
    throw std::runtime_error(Concatenate(track_path, ": made for pictures of ", whole.camera.width, "x",
                                         whole.camera.height, ", ", request.image, " has ", photo.picture.width, "x",
                                         photo.picture.height));
  }
  photo.track = TrackOfFrame(whole, track_path, request.frame);
  PhotoMapsOptions options;
  options.size = size, options.texture_size = texture_size;
  try {
    const PhotoMaps maps(*photo.body, photo.track, options);
    photo.window = maps.window();
    FillMaps(maps.At(0), size, texture_size, &photo.frame);
  } catch (const std::invalid_argument& error) {
    throw std::runtime_error(track_path + ": " + error.what());
  }
  if (labels.empty() && !request.labels.empty()) {
    const PartLabelSequence parts = ReadPartLabels(request.labels);
    if (parts.image_width != photo.picture.width || parts.image_height != photo.picture.height ||
        request.frame >= parts.num_frames()) {
      throw std::runtime_error(Concatenate(request.labels, ": ", parts.num_frames(), " frames of ", parts.image_width,
                                           "x", parts.image_height, ", asked for frame ", request.frame, " of ",
                                           photo.picture.width, "x", photo.picture.height));
    }
    labels = LabelPicture(parts.frames[request.frame], photo.picture.width, photo.picture.height);
    photo.notes += "body parts stand in for a parsing of the clothes\n";
  }
  CutPhoto cut;
  cut.image = CutWindow(photo.picture, photo.window, 0);
  if (labels.empty()) {
    cut.labels = LabelsFromBody(cut.image, photo.frame.parts);
    photo.notes += "no labels: the outline is found by GrabCut from the tracked body, classes are its parts'\n";
  } else {
    cut.labels = CutLabels(labels, photo.window, 0);
  }
  if (std::all_of(cut.labels.begin(), cut.labels.end(), [](uint8_t label) { return label == 0; })) {
    throw std::runtime_error(request.image + ": its labels show nobody where the track has the body");
  }
  FillPicture(cut, &photo.frame);
  // The window's labels where they are in the picture.
  photo.person.assign(size_t(photo.picture.width) * photo.picture.height, 0);
  for (int y = 0; y < photo.picture.height; ++y) {
    for (int x = 0; x < photo.picture.width; ++x) {
      const int column = static_cast<int>(x * photo.window.scale_x) - photo.window.corner[0].x();
      const int row = static_cast<int>(y * photo.window.scale_y) - photo.window.corner[0].y();
      if (column < 0 || row < 0 || column >= size || row >= size) continue;
      photo.person[size_t(y) * photo.picture.width + x] = cut.labels[size_t(row) * size + column] != 0 ? 1 : 0;
    }
  }
  return photo;
}

PhotoRequest ParsePhotoRequest(const std::string& text, const std::string& option, const PhotoRequest& like) {
  PhotoRequest request = like;
  const size_t first = text.find(':'), second = first == std::string::npos ? first : text.find(':', first + 1);
  request.image = text.substr(0, first);
  request.track = first == std::string::npos
                      ? ""
                      : text.substr(first + 1, second == std::string::npos ? second : second - first - 1);
  request.frame = 0;
  request.labels.clear();
  if (second != std::string::npos) {
    const std::string number = text.substr(second + 1);
    const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), request.frame);
    if (error != std::errc() || end != number.data() + number.size() || request.frame < 0) {
      throw UsageError(option + " " + text + ": expected IMAGE:TRACK or IMAGE:TRACK:FRAME");
    }
  }
  if (request.image.empty()) throw UsageError(option + " " + text + ": expected IMAGE:TRACK or IMAGE:TRACK:FRAME");
  return request;
}

}  // namespace bodyloom
