// SPDX-License-Identifier: Apache-2.0
/// Files of Gaussian avatars: the finished avatar, or a checkpoint from which training can resume.
///
/// One .npz. N Gaussians (values: render/gaussian_avatar/gaussian_body.h) on a body of J joints, V vertices and F
/// faces:
///   format 'bodyloom avatar'   version 2              body_size int32 [J, V, F]    betas B, float64
///   parameters N×23 float32    joints N×6 int32       kinds N uint8 (GaussianKind) light 27 float32
///   anchor_face N int32        anchor_barycentric N×3 float32                      anchor_factor N float32
/// with a garment of K nodes (render/gaussian_avatar/avatar_frame.h), numbered as joints J to J + K − 1,
///   garment_cut float64 [waist, length, fullness, spacing, nodes' spacing]   garment_offsets V float32   garment_nodes
///   K×3 float32
/// and, in a training's checkpoint (render/gaussian_avatar/learning/avatar_trainer.h):
///   adam_first, adam_second N×23 float32   adam_steps N int32    pull N float32    step, seconds float64
///   light_first, light_second 27 float32   light_steps 27 int32  options text: the options at the start of training
/// if frames were held out for validation (render/gaussian_avatar/learning/early_stopping.h) also
///   held_out K float64 (losses)            held_out_landing float64 [step, progress]; 0, 0: no cooldown yet
///   best_…: the best avatar so far, keys as above after the prefix best_      best_step, best_loss float64
/// if the poses of a clip of T frames are refined (render/gaussian_avatar/learning/pose_refiner.h) also
///   pose_values, pose_mean T×(3J + 3) float32     pose_square T float32     pose_steps T int32
/// All numbers are finite. Files of version 1, which have is_loose (0, 1) in place of kinds and no garment, are read
/// too, and so are files with a motion network (motion_network, motion_parameters, …) of earlier versions, which is
/// ignored.
#pragma once

#include <optional>
#include <string>

#include <Eigen/Core>

#include "data_tools/formats/npz.h"
#include "render/gaussian_avatar/avatar_frame.h"
#include "render/gaussian_avatar/gaussian_body.h"
#include "render/gaussian_avatar/learning/avatar_trainer.h"
#include "render/splat/camera_gaussians.h"

namespace bodyloom {

struct AvatarFile {
  GaussianBody body;
  std::optional<AvatarGarment> garment;
  Eigen::VectorXd betas;
  int num_joints = 0, num_vertices = 0, num_faces = 0;  ///< of the parametric body
  bool had_network = false;                             ///< a motion network was in the file and was ignored
  /// Joints and the garment's nodes.
  [[nodiscard]] int num_bones() const { return num_joints + (garment ? garment->num_nodes() : 0); }
};

struct AvatarCheckpoint {
  AvatarFile avatar;  ///< its body stays empty: counts of the state
  AvatarTrainingState state;
  std::string options;
};

/// Written atomically. Throw std::runtime_error naming the path when it cannot be written, std::invalid_argument when
/// tables do not fit each other.
void WriteAvatar(const std::string& path, const AvatarFile& avatar);
void WriteAvatarCheckpoint(const std::string& path, const AvatarCheckpoint& checkpoint);

/// Throw std::runtime_error naming file, key, what was found and what was expected.
AvatarFile ReadAvatar(const std::string& path);
AvatarFile AvatarFromArrays(const NpzArrays& arrays, const std::string& where);
AvatarCheckpoint ReadAvatarCheckpoint(const std::string& path);
AvatarCheckpoint AvatarCheckpointFromArrays(const NpzArrays& arrays, const std::string& where);

// Writes Gaussians as a .ply file for 3D Gaussian Splatting viewers.
//
// Binary, little endian, one element `vertex` of float32: x y z (metres, in the Gaussians' frame), nx ny nz (zeros),
// f_dc_0 f_dc_1 f_dc_2 = (colour − 0.5)/0.28209479, opacity = ln(o/(1 − o)), scale_0..2 = ln of standard deviations in
// metres, largest first, rot_0..3 = w x y z of the rotation to their axes. Source: Kerbl et al., "3D Gaussian
// Splatting", SIGGRAPH 2023, scene/gaussian_model.py of its code.

/// The file's bytes. Rows with non-finite numbers are left out. Opacities are clamped to [1e-6, 1 − 1e-6], standard
/// deviations to at least 1e-7 m.
std::string GaussianPlyBytes(const CameraGaussians& gaussians);

/// Written atomically. Throws std::runtime_error naming the path.
void WriteGaussianPly(const std::string& path, const CameraGaussians& gaussians);

}  // namespace bodyloom
