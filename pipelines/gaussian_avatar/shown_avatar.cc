// SPDX-License-Identifier: Apache-2.0
#include "pipelines/gaussian_avatar/shown_avatar.h"

#include <algorithm>
#include <filesystem>
#include <stdexcept>
#include <utility>

#include "data_tools/body/builtin_body.h"
#include "data_tools/motion/motion_tools.h"
#include "geometry/base/check.h"
#include "geometry/scene/rig.h"
#include "geometry/scene/track_edits.h"
#include "pipelines/animate/animation_limits.h"
#include "pipelines/body_of_track.h"
#include "pipelines/gaussian_avatar/train_avatar.h"
#include "render/gaussian_avatar/worn_garment.h"

namespace bodyloom {

ShownAvatar::ShownAvatar(const LearnedAvatar& avatar, ShownMotion motion, int num_threads,
                         const PipelineCallbacks& callbacks)
    : avatar_(avatar), threads_(num_threads) {
  if (avatar.file.had_network) {
    callbacks.Message(avatar.run +
                      ": learned a network of the motion, which this version no longer has; shown without it");
  }
  track_ = WithStillCamera(*avatar.body, motion.track);
  track_.camera.distortion = {};
  try {
    Pose(motion, callbacks);
  } catch (const RequestError&) {
    throw;
  } catch (const std::invalid_argument& error) {
    throw std::runtime_error(motion.where + ": " + error.what());
  }
  if (width() < 2 || height() < 2 || std::max(width(), height()) > kLongestImageSide) {
    throw std::runtime_error(Concatenate(motion.where, ": images of ", width(), "x", height(),
                                         ", expected sides of 2 to ", kLongestImageSide));
  }
}

void ShownAvatar::Pose(const ShownMotion& motion, const PipelineCallbacks& callbacks) {
  const BodyModel& body = *avatar_.body;
  if (!motion.keeps_shape) track_ = WithShape(body, track_, avatar_.file.betas);
  int first = 0, last = track_.num_frames() - 1;
  std::vector<int> shown;
  const Track moving = track_;  // in which no time stands still
  if (!motion.freeze.empty()) {
    const Freeze freeze = ReadFreeze(motion.freeze, track_.num_frames());
    shown = FrozenAt(track_.num_frames(), freeze.frame, freeze.count);
    track_ = FramesInOrder(track_, shown);
    first = freeze.frame, last = freeze.frame + freeze.count;
  }
  const int longer = std::max(track_.camera.width, track_.camera.height);
  const double scale = motion.size > 0 && longer > 0 ? static_cast<double>(motion.size) / longer : 1;
  posed_.emplace(body, track_, ViewAngles(motion.view_yaw, track_.num_frames(), first, last), scale, threads_,
                 motion.where);
  if (avatar_.file.garment) {
    posed_->Wear(CutAnew(body, avatar_.file.betas, *avatar_.file.garment, avatar_.run).Along(moving, callbacks), shown);
  }
}

const SplatImage& ShownAvatar::Draw(int t) {
  posed_->MakeFrame(t, &frame_);
  return Draw(frame_, posed_->ViewAt(t));
}

const SplatImage& ShownAvatar::Draw(const AvatarFrame& frame, const AvatarView& view) {
  painter_.Draw(avatar_.file.body, avatar_.body->data().faces, frame, view);
  return painter_.image();
}

std::vector<float> ShownAvatar::GarmentShare() {
  return avatar_.file.garment ? painter_.ShareOf(GaussianKind::kCloth, avatar_.file.body) : std::vector<float>();
}

LearnedAvatar ReadLearnedAvatar(const std::string& run, const std::string& body) {
  const std::string path = std::filesystem::is_directory(run) ? AvatarPath(run) : run;
  LearnedAvatar avatar{run, ReadAvatar(path), nullptr};
  const AvatarFile& file = avatar.file;
  avatar.body = BodyOfJoints(body, file.num_joints);
  const BodyModel& given = *avatar.body;
  if (file.num_joints != given.num_joints() || file.num_vertices != given.num_vertices() ||
      file.num_faces != given.num_faces()) {
    throw std::runtime_error(Concatenate(path, ": was learned on a body of ", file.num_joints, " joints, ",
                                         file.num_vertices, " vertices and ", file.num_faces,
                                         " faces, the one given (--body) has ", given.num_joints(), ", ",
                                         given.num_vertices(), " and ", given.num_faces()));
  }
  return avatar;
}

}  // namespace bodyloom
