// SPDX-License-Identifier: Apache-2.0
/// Files of a person of Gaussians: the person, and a training that can go on.
///
/// One .npz. N Gaussians (render/avatar/gaussian_body.h says what the numbers mean) on a body of J joints, V vertices
/// and F faces:
///   format 'bodyloom avatar'   version 2              body_size int32 [J, V, F]    betas B, float64
///   parameters N×23 float32    joints N×6 int32       kinds N uint8 (GaussianKind) light 27 float32
///   anchor_face N int32        anchor_barycentric N×3 float32                      anchor_factor N float32
/// with a network of the motion (render/avatar/motion/motion_network.h), whose maps are pipelines/avatar/motion_maps.h's,
///   motion_network int32 [side, maps, embedding, width]    motion_parameters P float32    motion_fps float64
/// with a garment of K nodes (render/avatar/avatar_garment.h), which joints J to J + K − 1 name,
///   garment_cut float64 [waist, length, fullness, spacing, nodes' spacing]   garment_offsets V float32   garment_nodes K×3 float32
/// and, in a training's checkpoint (render/avatar/learning/avatar_trainer.h):
///   adam_first, adam_second N×23 float32   adam_steps N int32    pull N float32    step, seconds float64
///   light_first, light_second 27 float32   light_steps 27 int32  options text: what the training was begun with
/// with a network of the motion also motion_first, motion_second P×1 float32 and motion_steps P int32,
/// where frames held out were judged (render/avatar/learning/held_out_curve.h) also
///   held_out K float64 (losses)            held_out_landing float64 [step, progress]; 0, 0: it does not land
///   best_…: the person that is kept, keys as above with best_ before them      best_step, best_loss float64
/// where it refines the poses of a clip of T frames (render/avatar/learning/pose_refiner.h) also
///   pose_values, pose_mean T×(3J + 3) float32     pose_square T float32     pose_steps T int32
/// All numbers are finite. Files of version 1, which have is_loose (0, 1) in place of kinds and no garment, are read too.
#pragma once

#include <optional>
#include <string>

#include <Eigen/Core>

#include "bodyloom/data_tools/formats/npz.h"
#include "bodyloom/render/avatar/avatar_garment.h"
#include "bodyloom/render/avatar/gaussian_body.h"
#include "bodyloom/render/avatar/learning/avatar_trainer.h"
#include "bodyloom/render/avatar/motion/motion_network.h"

namespace bodyloom {

/// The network of the motion that a person learned.
struct AvatarMotionFile {
  MotionNetworkOptions options;
  FloatColumns parameters;
  double fps = 30;  ///< frames a second of the maps that it learned from
};

struct AvatarFile {
  GaussianBody body;
  std::optional<AvatarMotionFile> motion;
  std::optional<AvatarGarment> garment;
  Eigen::VectorXd betas;
  int num_joints = 0, num_vertices = 0, num_faces = 0;  ///< of the parametric body
  /// With the garment's nodes.
  [[nodiscard]] int num_bones() const { return num_joints + (garment ? garment->num_nodes() : 0); }
};

struct AvatarCheckpoint {
  AvatarFile avatar;  ///< its body stays empty, and so do the motion's parameters: the state's count
  AvatarTrainingState state;
  std::string options;
};

/// Whole or not at all. Throw std::runtime_error naming the path when it cannot be written, std::invalid_argument when
/// tables do not fit each other.
void WriteAvatar(const std::string& path, const AvatarFile& avatar);
void WriteAvatarCheckpoint(const std::string& path, const AvatarCheckpoint& checkpoint);

/// Throw std::runtime_error naming file, key, what was found and what was expected.
AvatarFile ReadAvatar(const std::string& path);
AvatarFile AvatarFromArrays(const NpzArrays& arrays, const std::string& where);
AvatarCheckpoint ReadAvatarCheckpoint(const std::string& path);
AvatarCheckpoint AvatarCheckpointFromArrays(const NpzArrays& arrays, const std::string& where);

}  // namespace bodyloom
