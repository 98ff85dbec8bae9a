// SPDX-License-Identifier: Apache-2.0
#include "data_tools/estimates/estimate_readers.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "data_tools/body/body_landmarks.h"
#include "data_tools/estimates/estimate_arrays.h"
#include "data_tools/formats/printable.h"
#include "geometry/base/check.h"

namespace bodyloom {
namespace {

using Kind = PickleValue::Kind;

constexpr double kFocalAtCrop = 5000, kCrop = 256;

const std::vector<PicklePtr>& RequireList(const PickleValue& frame, const std::string& key, size_t at_least,
                                          const std::string& place) {
  const PickleValue* value = frame.Find(key);
  if (value == nullptr || (value->kind != Kind::kList && value->kind != Kind::kTuple)) {
    ThrowFileError(place, key, "expected a list of one entry a track");
  }
  if (value->items.size() < at_least) {
    ThrowFileError(place, key, Concatenate(value->items.size(), " entries, expected those of ", at_least, " tracks"));
  }
  return value->items;
}

int64_t WholeNumber(const PickleValue* value, const std::string& place, const std::string& key) {
  const double number = RequireCount(value, 1, place, key)[0];
  if (number != std::floor(number) || std::abs(number) > 1e9) ThrowFileError(place, key, "expected a whole number");
  return static_cast<int64_t>(number);
}

/// A person while the frames are gone through.
struct OpenPerson {
  std::vector<int> frames;
  std::vector<Eigen::RowVectorXd> poses, trans, betas;
  std::vector<Camera> cameras;
};

Eigen::RowVectorXd PoseOf(const PickleValue& smpl, const std::string& place) {
  Eigen::RowVectorXd pose(72);
  const Eigen::RowVectorXd root = RequireCount(smpl.Find("global_orient"), 9, place, "global_orient");
  const Eigen::RowVectorXd body = RequireCount(smpl.Find("body_pose"), 207, place, "body_pose");
  pose.head<3>() = AxisAngleFromRows(root, place, "global_orient").transpose();
  for (int j = 0; j < 23; ++j) {
    pose.segment<3>(3 + 3 * j) = AxisAngleFromRows(body.segment<9>(9 * j), place, "body_pose").transpose();
  }
  return pose;
}

PersonEstimate Close(int64_t id, OpenPerson&& open) {
  PersonEstimate person;
  const auto n = static_cast<Eigen::Index>(open.frames.size());
  person.name = std::to_string(id);
  person.frames = std::move(open.frames);
  person.cameras = std::move(open.cameras);
  person.poses.resize(n, 72);
  person.trans.resize(n, 3);
  person.betas = Eigen::VectorXd::Zero(10);
  for (Eigen::Index i = 0; i < n; ++i) {
    person.poses.row(i) = open.poses[static_cast<size_t>(i)];
    person.trans.row(i) = open.trans[static_cast<size_t>(i)];
    person.betas += open.betas[static_cast<size_t>(i)].transpose() / static_cast<double>(n);
  }
  return person;
}

}  // namespace

bool IsPhalp(const PickleValue& file) {
  if (file.dict.empty()) return false;
  const PickleValue& frame = *file.dict.front().second;
  return frame.Find("tid") != nullptr && frame.Find("smpl") != nullptr && frame.Find("camera") != nullptr;
}

BodyEstimate PhalpFromPickle(const PickleValue& file, const std::string& where, int image_width, int image_height) {
  BodyEstimate estimate;
  estimate.system = "PHALP";
  estimate.body = "smpl";
  estimate.rest_pelvis = MeanPelvis(estimate.body);
  std::map<int64_t, OpenPerson> people;
  for (const auto& [name, frame] : file.dict) {
    const std::string place = where + ": frame " + PrintableText(name);
    const int64_t number = WholeNumber(frame->Find("time"), place, "time");
    if (number < 0 || number >= kMaxEstimateFrames) ThrowFileError(place, "time", "expected the number of a frame");
    const std::vector<PicklePtr>& ids = RequireList(*frame, "tid", 0, place);
    const std::vector<PicklePtr>& ages = RequireList(*frame, "tracked_time", ids.size(), place);
    const std::vector<PicklePtr>& bodies = RequireList(*frame, "smpl", ids.size(), place);
    const std::vector<PicklePtr>& cameras = RequireList(*frame, "camera", ids.size(), place);
    const bool has_size = frame->Find("size") != nullptr;
    for (size_t i = 0; i < ids.size(); ++i) {
      if (WholeNumber(ages[i].get(), place, "tracked_time") != 0) continue;
      int width = image_width, height = image_height;
      if (has_size) {
        const Eigen::RowVectorXd size =
            RequireCount(RequireList(*frame, "size", ids.size(), place)[i].get(), 2, place, "size");
        if (!(size.minCoeff() >= 1) || size.maxCoeff() > 1e6)
          ThrowFileError(place, "size", "expected height and width");
        height = static_cast<int>(size[0]);
        width = static_cast<int>(size[1]);
      }
      if (width <= 0 || height <= 0) {
        ThrowFileError(place, "size", "is not there, and the image size is not known; give --video or --image-size");
      }
      OpenPerson& person = people[WholeNumber(ids[i].get(), place, "tid")];
      person.frames.push_back(static_cast<int>(number));
      person.poses.push_back(PoseOf(*bodies[i], place));
      person.betas.push_back(RequireCount(bodies[i]->Find("betas"), 10, place, "betas"));
      person.trans.push_back(RequireCount(cameras[i].get(), 3, place, "camera"));
      person.cameras.push_back(CentredCamera(width, height, kFocalAtCrop / kCrop * std::max(width, height)));
    }
  }
  for (auto& [id, person] : people) estimate.people.push_back(Close(id, std::move(person)));
  SortEstimate(where, &estimate);
  return estimate;
}

}  // namespace bodyloom
