// SPDX-License-Identifier: Apache-2.0
#include "pipelines/neural/photo/people_data.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <map>
#include <mutex>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "data_tools/body/builtin_body.h"
#include "data_tools/datasets/multi_person_dataset.h"
#include "data_tools/datasets/single_person_dataset.h"
#include "data_tools/learned/parser_weights_io.h"
#include "data_tools/motion/track_io.h"
#include "data_tools/synthesis/clips/perturbed_motion.h"
#include "geometry/base/check.h"
#include "geometry/base/hash_random.h"
#include "geometry/scene/track_edits.h"
#include "pipelines/animate/person_segmentation.h"
#include "pipelines/body_of_track.h"
#include "pipelines/neural/photo/photo_input.h"
#include "tracking/detection/clothes_parser.h"

namespace bodyloom {
namespace {

namespace fs = std::filesystem;

/// A clip's track: the true one, or another of the same frames.
Track TrackOfClip(const SinglePersonDataset& set, const std::string& name, const BodyModel& body) {
  Track own = set.track();
  if (name.empty()) return own;
  const std::string path = (fs::path(set.path()) / name).string();
  Track track = TrackOnBody(body, ReadTrack(path));
  if (track.num_frames() != own.num_frames() || track.camera.width != own.camera.width ||
      track.camera.height != own.camera.height) {
    throw std::runtime_error(Concatenate(path, ": ", track.num_frames(), " frames of ", track.camera.width, "x",
                                         track.camera.height, ", its clip has ", own.num_frames(), " of ",
                                         own.camera.width, "x", own.camera.height));
  }
  return track;
}

constexpr double kMinError_px = 0.1;  ///< below: none

Track WithBodyError(const BodyModel& body, Track track, double error_px, uint64_t seed) {
  if (error_px < kMinError_px) return track;
  track.motion = PerturbMotion(body, track.CameraAt(0), track.motion, error_px, PerturbationOptions(), seed, 1).motion;
  return track;
}

}  // namespace

std::string ToText(const GivenOfPeople& given) {
  if (given.IsTrue()) return kGivenOfPeople;
  return std::string(given.estimated_labels ? "estimated" : "true") + " labels, " +
         (given.track.empty() ? "true bodies" : "bodies of " + given.track) + (given.iuv ? ", IUV images" : "");
}

class PeopleData::Impl {
 public:
  explicit Impl(const PeopleDataRequest& request) : request_(request), body_(BodyOrBuiltin(request.body)) {
    if (IsSinglePersonDataset(request.data)) {
      if (!request.test) AddPerson("", {request.data});
    } else {
      const MultiPersonDataset set = ReadMultiPersonDataset(request.data);
      for (const DatasetPerson& person : set.people) {
        if (person.test != request.test) continue;
        AddPerson(set.path, person.clips);
      }
    }
    if (people_.empty()) {
      throw std::runtime_error(request.data + (request.test ? ": nobody is kept for testing" : ": nobody to train on") +
                               " in people.json");
    }
    source_.size = request.size, source_.texture_size = request.texture_size;
    for (const auto& frames : people_) source_.num_frames.push_back(static_cast<int>(frames.size()));
    source_.texel_parts = PartsOfTexels(*body_, *texels_);
    source_.texel_places = PlacesOfTexels(*body_, *texels_);
    source_.fill = [this](int person, int frame, PhotoFrame* photo) { Fill(people_.at(person).at(frame), photo); };
  }

  [[nodiscard]] const PhotoSource& source() const { return source_; }

  PhotoFrame PhotoOf(int person, int frame) {
    const FrameOfPerson& from = people_.at(person).at(frame);
    PhotoFrame photo;
    Fill(from, &photo);
    if (!request_.given.estimated_labels) return photo;
    const CutPhoto& truth = CutAt(from);
    const Track& track = from.clip->track;
    Image everywhere(track.camera.width, track.camera.height);
    std::fill(everywhere.bgr.begin(), everywhere.bgr.end(), uint8_t{1});
    try {
      const std::vector<uint8_t> inside = CutLabels(everywhere, from.clip->maps->window(), from.t);
      std::vector<uint8_t> labels = SegmentPerson(truth.image, inside, {}, photo.parts).labels;
      if (!request_.labels_of_body) {
        const Track body = BodyOf(person, frame);
        labels = ClothesParser(BuiltinParser()).Labels(truth.image, labels, *body_, body, body.camera, 1);
      }
      FillImage({truth.image, std::move(labels)}, &photo);
    } catch (const std::invalid_argument& error) {
      throw std::runtime_error(Concatenate(from.clip->set.path(), ", frame ", from.t, ": ", error.what()));
    }
    return photo;
  }

  [[nodiscard]] Track BodyOf(int person, int frame) const {
    const FrameOfPerson& from = people_.at(person).at(frame);
    Track body = FramesInOrder(from.clip->track, std::array{from.t});
    body.camera = CameraInWindow(body.CameraAt(0), from.clip->maps->window(), from.t);
    return body;
  }
  [[nodiscard]] const std::shared_ptr<const BodyModel>& body() const { return body_; }

 private:
  /// A single-person dataset's clip and the maps of its frames.
  struct Clip {
    SinglePersonDataset set;
    Track track;
    std::optional<PhotoMaps> maps;
    std::vector<std::optional<CutPhoto>> cut;

    explicit Clip(const std::string& path) : set(path), cut(set.info().num_frames) {}
  };

  struct FrameOfPerson {
    Clip* clip = nullptr;
    int t = 0;
  };

  /// `clips`: below `folder`.
  void AddPerson(const std::string& folder, const std::vector<std::string>& clips) {
    std::vector<FrameOfPerson> frames;
    std::map<std::pair<std::string, int>, int> poses;  // numbers by action and frame
    std::map<std::string, int> views;
    std::vector<ImagePlace>& places = source_.places.emplace_back();
    for (const std::string& name : clips) {
      const std::string path = (fs::path(folder) / name).string();
      const ClipPlace place = PlaceOfClip(name);
      const int view = views.emplace(place.view, static_cast<int>(views.size())).first->second;
      const uint64_t hash = Mix(Mix(request_.seed) ^ clips_.size());
      clips_.push_back(std::make_unique<Clip>(path));
      Clip& clip = *clips_.back();
      clip.track = TrackOfClip(clip.set, request_.given.track, *body_);
      clip.track = WithBodyError(*body_, std::move(clip.track), request_.body_error_px * UniformOf(hash), Mix(hash));
      if (!clip.set.info().has.labels) throw std::runtime_error(path + ": has no labels, which training needs");
      PhotoMapsOptions options;
      options.size = request_.size, options.texture_size = request_.texture_size, options.texels = texels_;
      if (request_.given.iuv) {
        options.estimated = std::make_shared<const EstimatedPixels>(*body_, path + "/iuv", clip.set.info().num_frames);
      }
      try {
        clip.maps.emplace(*body_, clip.track, options);
      } catch (const std::invalid_argument& error) {
        throw std::runtime_error(path + ": " + error.what());
      }
      texels_ = clip.maps->texels();
      for (int t = 0; t < clip.set.info().num_frames; ++t) {
        frames.push_back({&clip, t});
        const int pose = poses.emplace(std::pair(place.action, t), static_cast<int>(poses.size())).first->second;
        places.push_back({pose, view});
      }
    }
    people_.push_back(std::move(frames));
  }

  void Fill(const FrameOfPerson& from, PhotoFrame* photo) {
    Clip& clip = *from.clip;
    FillMaps(clip.maps->At(from.t), request_.size, request_.texture_size, photo);
    FillImage(CutAt(from), photo);
  }

  const CutPhoto& CutAt(const FrameOfPerson& from) {
    Clip& clip = *from.clip;
    const std::lock_guard lock(mutex_);
    if (!clip.cut[from.t]) {
      const PersonFrame image = clip.set.Read(from.t, {true, false, false, false});
      clip.cut[from.t] = {CutWindow(image.rgb, clip.maps->window(), from.t),
                          CutLabels(image.labels, clip.maps->window(), from.t)};
    }
    return *clip.cut[from.t];
  }

  PeopleDataRequest request_;
  std::shared_ptr<const BodyModel> body_;
  std::shared_ptr<const UvTexelTable> texels_;
  std::vector<std::unique_ptr<Clip>> clips_;
  std::vector<std::vector<FrameOfPerson>> people_;
  std::mutex mutex_;
  PhotoSource source_;
};

PeopleData::PeopleData(const PeopleDataRequest& request) : impl_(std::make_unique<Impl>(request)) {}
PeopleData::~PeopleData() = default;
const PhotoSource& PeopleData::source() const { return impl_->source(); }
PhotoFrame PeopleData::PhotoOf(int person, int frame) const { return impl_->PhotoOf(person, frame); }
Track PeopleData::BodyOf(int person, int frame) const { return impl_->BodyOf(person, frame); }
const std::shared_ptr<const BodyModel>& PeopleData::body() const { return impl_->body(); }

bool HasTestPeople(const std::string& data) {
  if (IsSinglePersonDataset(data)) return false;
  const MultiPersonDataset set = ReadMultiPersonDataset(data);
  return std::any_of(set.people.begin(), set.people.end(), [](const DatasetPerson& person) { return person.test; });
}

TrainingPeople::TrainingPeople(const std::string& data, const std::string& body, int size, int texture_size)
    : train({data, body, size, texture_size, false, {}}) {
  if (!HasTestPeople(data)) return;
  test = std::make_unique<PeopleData>(PeopleDataRequest{data, body, size, texture_size, true, {}});
}

std::vector<int> Everybody(const PhotoSource& source) {
  std::vector<int> persons(source.num_frames.size());
  std::iota(persons.begin(), persons.end(), 0);
  return persons;
}

}  // namespace bodyloom
