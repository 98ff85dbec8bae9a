// SPDX-License-Identifier: Apache-2.0
#include "pipelines/neural/motion/motion_data.h"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <vector>

#include "data_tools/body/builtin_body.h"
#include "data_tools/datasets/body_truth.h"
#include "data_tools/datasets/single_person_dataset.h"
#include "data_tools/motion/motion_tools.h"
#include "data_tools/motion/track_io.h"
#include "data_tools/observations/part_labels.h"
#include "data_tools/video/video_reader.h"
#include "geometry/base/check.h"
#include "pipelines/body_of_track.h"
#include "render/uv_maps/posed_track.h"

namespace bodyloom {
/// The window's part of a frame's images.
struct MotionTruthFrame {
  Image image, normals;
  std::vector<uint8_t> labels;
};

namespace {

void FillTruth(const MotionTruthFrame& cut, MotionFrame* frame) {
  const size_t area = size_t(frame->width) * frame->height;
  frame->labels = cut.labels;
  frame->image.assign(3 * area, 0);
  frame->normals.assign(cut.normals.empty() ? 0 : 3 * area, 0);
  for (size_t i = 0; i < area; ++i) {
    if (!cut.labels.empty() && cut.labels[i] == 0) continue;
    for (int c = 0; c < 3; ++c) frame->image[area * c + i] = static_cast<float>(cut.image.bgr[3 * i + 2 - c]) / 255;
    if (cut.normals.empty()) continue;
    Eigen::Vector3d n;
    for (int c = 0; c < 3; ++c) n[c] = NormalOfCode(cut.normals.bgr[3 * i + 2 - c]);
    // Shrunk normals are shorter than one, and those of the background point nowhere.
    if (cut.normals.bgr[3 * i] + cut.normals.bgr[3 * i + 1] + cut.normals.bgr[3 * i + 2] == 0 || n.norm() < 0.3)
      continue;
    for (int c = 0; c < 3; ++c) frame->normals[area * c + i] = static_cast<float>(n[c] / n.norm());
  }
}

}  // namespace

void FillMotion(const PersonFrames& frames, const DenseHistory* dense, const EstimatedPixels* estimated, int t,
                MotionFrame* frame) {
  const PersonWindow& window = frames.window();
  *frame = {};
  frame->width = window.width;
  frame->height = window.height;
  if (t > 0) {
    const Eigen::Vector2i moved = window.corner[t - 1] - window.corner[t];
    frame->before_x = moved.x();
    frame->before_y = moved.y();
  }
  const size_t area = size_t(window.width) * window.height, side = frames.options().uv_size;
  if (dense != nullptr) {
    frame->dense.resize(dense->channels() * area);
    dense->Maps(t, frame->dense);
  } else {
    frame->motion.resize(frames.channels() * side * side);
    frames.MotionMaps(t, frame->motion);
  }
  frame->uv.resize(2 * area);
  frame->body.resize(area);
  if (estimated != nullptr) {
    estimated->BodyMaps(window, t, frame->uv, frame->body);
  } else {
    frames.BodyMaps(t, frame->uv, frame->body);
  }
}

class MotionData::Impl {
 public:
  Impl(const MotionDataRequest& request, const MotionProfile& profile, int multiple) {
    if (IsSinglePersonDataset(request.data)) {
      set_.emplace(request.data);
      track_ = request.track.empty() ? set_->track() : ReadTrack(request.track);
      CheckSizes(request, set_->info().num_frames, set_->info().width, set_->info().height);
      if (!request.part_labels.empty() || !request.mask.empty()) {
        notes_ += "--mask and --part-labels are not used: the dataset has labels of its own\n";
      }
    } else {
      if (request.track.empty()) {
        throw std::runtime_error(request.data +
                                 ": no person.json there, so it is taken for a video, which needs --track");
      }
      track_ = ReadTrack(request.track);
    }
    body_ = BodyOfTrack(request.body, track_);
    PersonFramesOptions options;
    options.uv_size = profile.uv_size;
    options.motion = request.motion;
    options.window.max_side = profile.image_size;
    options.window.multiple = multiple;
    options.num_threads = std::max(1, request.num_threads);
    const double size = bodyloom::PixelsPerMetre(*body_, track_);
    if (request.pixels_per_metre > 0 && size > 0) options.window.scale = ScaleToSize(request.pixels_per_metre, size);
    try {
      frames_.emplace(*body_, track_, options);
    } catch (const std::invalid_argument& error) {
      throw std::runtime_error((request.track.empty() ? request.data : request.track) + ": " + error.what());
    }
    OpenIuv(request);
    if (request.descriptor == MotionDescriptor::kDense2d) {
      dense_.emplace(*frames_, options.past, estimated_ ? &*estimated_ : nullptr);
    }
    cut_.resize(track_.num_frames());
    if (!set_) CutVideo(request);
  }

  void Fill(int t, bool with_truth, MotionFrame* frame) {
    FillMotion(*frames_, dense_ ? &*dense_ : nullptr, estimated_ ? &*estimated_ : nullptr, t, frame);
    if (with_truth) FillTruth(CutAt(t), frame);
  }

  [[nodiscard]] const PersonFrames& frames() const { return *frames_; }
  [[nodiscard]] const Track& track() const { return track_; }
  [[nodiscard]] double PixelsPerMetre() const {
    return frames_->window().scale_y * bodyloom::PixelsPerMetre(*body_, track_);
  }
  [[nodiscard]] bool has_normals() const { return set_ ? set_->info().has.normals : has_outline_; }
  [[nodiscard]] const std::string& notes() const { return notes_; }
  [[nodiscard]] bool has_labels() const { return set_ ? set_->info().has.labels : has_outline_; }

 private:
  void OpenIuv(const MotionDataRequest& request) {
    if (request.iuv.empty()) return;
    if (request.iuv == kOwnIuv && !(set_ && set_->info().has.iuv)) {
      throw std::runtime_error(request.data + ": has no IUV images of its own");
    }
    const std::string folder = request.iuv == kOwnIuv ? request.data + "/iuv" : request.iuv;
    try {
      estimated_.emplace(*body_, folder, track_.num_frames());
    } catch (const std::invalid_argument& error) {
      throw std::runtime_error(folder + ": " + error.what());
    }
  }

  void CheckSizes(const MotionDataRequest& request, int num_frames, int width, int height) {
    const std::string track = request.track.empty() ? request.data + "/track.npz" : request.track;
    if (num_frames < track_.num_frames()) {
      throw std::runtime_error(Concatenate(track, ": ", track_.num_frames(), " frames, ", request.data, " has ",
                                           num_frames, "; give the track of this very clip"));
    }
    if (num_frames > track_.num_frames()) {
      notes_ += Concatenate(request.data, " has ", num_frames, " frames, the track ", track_.num_frames(),
                            ": the later ones are not used\n");
    }
    if (width != track_.camera.width || height != track_.camera.height) {
      throw std::runtime_error(Concatenate(track, ": made for images of ", track_.camera.width, "x",
                                           track_.camera.height, ", ", request.data, " has ", width, "x", height));
    }
  }

  /// A mask or DensePose's parts of the clip; nothing where there is no such file.
  [[nodiscard]] std::optional<PartLabelSequence> ReadOutlines(const std::string& path) const {
    if (path.empty()) return std::nullopt;
    PartLabelSequence outlines = ReadPartLabels(path);
    if (outlines.num_frames() < track_.num_frames()) {
      throw std::runtime_error(
          Concatenate(path, ": ", outlines.num_frames(), " frames, the track ", track_.num_frames()));
    }
    if (outlines.image_width != track_.camera.width || outlines.image_height != track_.camera.height) {
      throw std::runtime_error(Concatenate(path, ": labels of ", outlines.image_width, "x", outlines.image_height,
                                           ", the track was made for ", track_.camera.width, "x",
                                           track_.camera.height));
    }
    return outlines;
  }

  /// The parts that frame t's window shows.
  [[nodiscard]] std::vector<uint8_t> PartsIn(const PartLabelSequence& parts, int t) const {
    const LabelImage shown = parts.PartsOf(t);
    Image image(parts.image_width, parts.image_height);
    for (int y = 0; y < image.height; ++y) {
      for (int x = 0; x < image.width; ++x) image.pixel(x, y)[0] = shown.At(x, y);
    }
    return CutLabels(image, frames_->window(), t);
  }

  /// Videos are read from the beginning: all windows are cut at once.
  void CutVideo(const MotionDataRequest& request) {
    const std::optional<PartLabelSequence> mask = ReadOutlines(request.mask), parts = ReadOutlines(request.part_labels);
    has_outline_ = mask || parts;
    if (parts) notes_ += "body parts stand in for a parsing of the clothes\n";
    if (mask && !parts) notes_ += "the tracked body's parts, within the mask, stand in for a parsing of the clothes\n";
    if (has_outline_) notes_ += "the tracked body's normals stand in for those of the clothes\n";
    VideoReader video(request.data, track_.playback.turn_deg);
    Image image;
    int t = 0;
    for (; t < track_.num_frames() && video.Read(&image); ++t) {
      const int promised = video.info().num_frames;  // 0 where the container does not say: counted below
      if (t == 0) CheckSizes(request, promised > 0 ? promised : track_.num_frames(), image.width, image.height);
      MotionTruthFrame cut;
      cut.image = CutWindow(image, frames_->window(), t);
      if (has_outline_) {
        const std::vector<uint8_t> shown = parts ? PartsIn(*parts, t) : std::vector<uint8_t>();
        BodyTruth truth = BodyTruthOf(frames_->Surface(t), mask ? PartsIn(*mask, t) : shown, shown);
        cut.labels = std::move(truth.labels), cut.normals = std::move(truth.normals);
      }
      cut_[t] = std::move(cut);
    }
    if (t < track_.num_frames()) CheckSizes(request, t, track_.camera.width, track_.camera.height);
  }

  const MotionTruthFrame& CutAt(int t) {
    const std::lock_guard lock(mutex_);
    if (!cut_.at(t)) {
      const PersonFrame image = set_->Read(t, {true, true, false, false});
      MotionTruthFrame cut;
      cut.image = CutWindow(image.rgb, frames_->window(), t);
      if (!image.labels.empty()) cut.labels = CutLabels(image.labels, frames_->window(), t);
      if (!image.normals.empty()) cut.normals = CutWindow(image.normals, frames_->window(), t);
      cut_[t] = std::move(cut);
    }
    return *cut_[t];
  }

  std::shared_ptr<const BodyModel> body_;
  std::optional<SinglePersonDataset> set_;
  Track track_;
  std::optional<PersonFrames> frames_;
  std::optional<EstimatedPixels> estimated_;
  std::optional<DenseHistory> dense_;
  std::mutex mutex_;
  std::vector<std::optional<MotionTruthFrame>> cut_;
  bool has_outline_ = false;
  std::string notes_;
};

MotionData::MotionData(const MotionDataRequest& request, const MotionProfile& profile, int multiple)
    : impl_(std::make_unique<Impl>(request, profile, multiple)) {}
MotionData::~MotionData() = default;
const PersonFrames& MotionData::frames() const { return impl_->frames(); }
const Track& MotionData::track() const { return impl_->track(); }
double MotionData::PixelsPerMetre() const { return impl_->PixelsPerMetre(); }
bool MotionData::has_labels() const { return impl_->has_labels(); }
bool MotionData::has_normals() const { return impl_->has_normals(); }
std::string MotionData::notes() const { return impl_->notes(); }
void MotionData::Fill(int t, bool with_truth, MotionFrame* frame) { impl_->Fill(t, with_truth, frame); }

namespace {

constexpr double kTolerance = 0.01;

}  // namespace

bool IsAtRate(const Track& track, double fps) {
  const double own = FrameRateWithoutGaps(track.motion);
  return own <= 0 || std::abs(own / fps - 1) <= kTolerance;
}

std::string RateText(const Track& track) {
  return Concatenate(std::round(100 * FrameRateWithoutGaps(track.motion)) / 100, " frames a second");
}

void RequireRate(const Track& track, double fps, const std::string& data, const std::string& what_helps) {
  if (IsAtRate(track, fps)) return;
  throw std::runtime_error(
      Concatenate(data, ": images at ", RateText(track), ", expected ", fps, " as in training; ", what_helps));
}

}  // namespace bodyloom
