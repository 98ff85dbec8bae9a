// SPDX-License-Identifier: Apache-2.0
#include "pipelines/gaussian_avatar/avatar_clip.h"

#include <stdexcept>

#include "data_tools/motion/track_io.h"
#include "data_tools/observations/part_labels.h"
#include "data_tools/video/video_reader.h"
#include "geometry/base/check.h"
#include "geometry/base/parallel.h"
#include "pipelines/body_of_track.h"
#include "pipelines/files.h"

namespace bodyloom {
namespace {

constexpr double kSearchShare = 0.35;  ///< of the body's longer side: as far from it a mask still is this person's
constexpr int kFramesAtOnce = 16;      ///< of a dataset, between two reports

}  // namespace

AvatarClip::AvatarClip(const AvatarClipRequest& request) : request_(request) {
  RequireReadable(request.data, "data");
  RequireReadable(request.track, "track");
  RequireReadable(request.mask, "mask");
  if (IsSinglePersonDataset(request.data)) {
    set_.emplace(request.data);
    if (!set_->info().has.labels)
      throw std::runtime_error(request.data + ": a dataset without labels, which say where the person is");
    track_ = request.track.empty() ? set_->track() : ReadTrack(request.track);
    CheckSize(request.data, set_->info().num_frames, set_->info().width, set_->info().height);
  } else {
    OpenVideo();
  }
  body_ = BodyOfTrack(request.body, track_);
  camera_of_file_ = track_.camera;
  if (track_.camera.HasDistortion()) {
    lens_.emplace(track_.camera);
    track_.camera = lens_->ideal();
  }
  const std::string& tracked = request.track.empty() ? request.data : request.track;
  try {
    posed_ = std::make_unique<PosedAvatar>(*body_, track_, std::vector<double>(), 1, request.threads, tracked);
  } catch (const std::invalid_argument& error) {
    throw std::runtime_error(tracked + ": " + error.what());
  }
}

void AvatarClip::OpenVideo() {
  if (request_.track.empty() || request_.mask.empty()) {
    throw RequestError(request_.data +
                       ": no person.json there, so it is taken for a video, which needs --track and --mask");
  }
  track_ = ReadTrack(request_.track);
  mask_ = ReadPartLabels(request_.mask);
  CheckSize(request_.mask, mask_->num_frames(), mask_->image_width, mask_->image_height);
  const VideoReader video(request_.data, track_.playback.turn_deg);
  const VideoInfo& info = video.info();
  CheckSize(request_.data, info.num_frames > 0 ? info.num_frames : track_.num_frames(), info.width, info.height);
}

void AvatarClip::Wear(std::vector<GarmentBones> runs) {
  BODYLOOM_CHECK(!runs.empty(), "a garment to wear: no run of its simulation");
  posed_->Wear(std::move(runs[0]));
  runs.erase(runs.begin());
  other_runs_ = std::move(runs);
}

void AvatarClip::CheckSize(const std::string& file, int num_frames, int width, int height) const {
  const std::string track = request_.track.empty() ? request_.data + "/track.npz" : request_.track;
  if (num_frames < track_.num_frames()) {
    throw std::runtime_error(Concatenate(track, ": ", track_.num_frames(), " frames, ", file, " has ", num_frames,
                                         "; give the track of this very clip"));
  }
  if (width != track_.camera.width || height != track_.camera.height) {
    throw std::runtime_error(Concatenate(track, ": made for images of ", track_.camera.width, "x", track_.camera.height,
                                         ", ", file, " has ", width, "x", height));
  }
}

uint8_t AvatarClip::PersonOf(const PersonAt& person_in_file, int x, int y) const {
  if (!lens_) return person_in_file(x, y);
  const std::optional<ImagePixel> source = lens_->SourceOf(x, y);
  return source ? person_in_file(source->x, source->y) : 0;
}

TrainingView AvatarClip::CutView(int t, const Image& image, const PersonAt& person_in_file, int margin,
                                 bool with_body) const {
  const PixelBox body = with_body ? posed_->BoxAt(t, 0) : PixelBox();
  const auto person_at = [&](int x, int y) { return PersonOf(person_in_file, x, y); };
  TrainingView view =
      CutTrainingView(lens_ ? lens_->Corrected(image) : image, person_at, posed_->BoxAt(t, kSearchShare), body, margin);
  if (view.window.empty()) return view;
  view.time = t;
  view.camera = posed_->CameraAt(t);
  posed_->MakeFrame(t, &view.frame);
  for (const GarmentBones& run : other_runs_) view.other_cloth.push_back(posed_->SeenCloth(t, run));
  return view;
}

LabelImage AvatarClip::MaskAt(int t) const {
  const PixelBox box = posed_->BoxAt(t, kSearchShare);
  LabelImage mask;
  mask.x_begin = box.x_begin, mask.y_begin = box.y_begin;
  mask.width = box.width(), mask.height = box.height();
  mask.labels.reserve(box.area());
  PersonFrame frame;
  if (set_) frame = set_->Read(t, {true, false, false, false});
  const LabelImage parts = set_ ? LabelImage() : mask_->PartsOf(t);
  const auto in_file = [&](int x, int y) {
    const bool is_person = set_ ? frame.labels.pixel(x, y)[0] != 0 : parts.At(x, y) != PartLabelSequence::kBackground;
    return is_person ? 1 : 0;
  };
  for (int y = box.y_begin; y < box.y_end; ++y) {
    for (int x = box.x_begin; x < box.x_end; ++x) mask.labels.push_back(PersonOf(in_file, x, y));
  }
  return mask;
}

std::vector<TrainingView> AvatarClip::ReadViews(const std::vector<int>& frames, int margin, bool with_body,
                                                const PipelineCallbacks& callbacks) const {
  std::vector<TrainingView> views(frames.size());
  if (set_) {
    for (size_t begin = 0; begin < frames.size(); begin += kFramesAtOnce) {
      callbacks.Update("reading", 0);
      const size_t count = std::min<size_t>(kFramesAtOnce, frames.size() - begin);
      ParallelFor(static_cast<int>(count), request_.threads, [&](int k) {
        const int t = frames[begin + k];
        if (!posed_->HasResult(t)) return;
        const PersonFrame frame = set_->Read(t, {true, false, false, false});
        const auto label_at = [&](int x, int y) { return frame.labels.pixel(x, y)[0]; };
        views[begin + k] = CutView(t, frame.rgb, label_at, margin, with_body);
      });
    }
    return views;
  }
  VideoReader video(request_.data, track_.playback.turn_deg);
  Image image;
  for (size_t k = 0; k < frames.size(); ++k) {
    const int t = frames[k];
    callbacks.Update("reading", 0);
    video.Skip(t - video.next_frame());
    if (!video.Read(&image)) {
      throw std::runtime_error(
          Concatenate(request_.data, ": ends before frame ", t, ", the track has ", track_.num_frames(), " frames"));
    }
    if (!posed_->HasResult(t)) continue;
    const LabelImage parts = mask_->PartsOf(t);
    const auto in_mask = [&](int x, int y) { return parts.At(x, y) != PartLabelSequence::kBackground ? 1 : 0; };
    views[k] = CutView(t, image, in_mask, margin, with_body);
  }
  return views;
}

}  // namespace bodyloom
