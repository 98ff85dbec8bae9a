// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/pipelines/avatar/learned_avatar.h"

#include <filesystem>
#include <stdexcept>

#include "bodyloom/data_tools/body/body_or_builtin.h"
#include "bodyloom/geometry/base/check.h"
#include "bodyloom/pipelines/avatar/train_avatar.h"

namespace bodyloom {

LearnedAvatar ReadLearnedAvatar(const std::string& run, const std::string& body) {
  const std::string path = std::filesystem::is_directory(run) ? AvatarPath(run) : run;
  LearnedAvatar avatar{run, ReadAvatar(path), BodyOrBuiltin(body)};
  const AvatarFile& file = avatar.file;
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
